//! A gas at rest in a cube, the scene of most closed forms.

pub use corpuscle::study::verify::gas_box::*;
