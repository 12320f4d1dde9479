//! The motion of a mesh's nodes as frames (`frames`): read and written (`files`) as a binary file (`binary`) or as a
//! series of VTK files (`series` of `vtk_frame`s, by `vtk_legacy` and `vtk_xml` of `xml`), checked (`checks`), and made to try it (`motion`).

mod binary;
mod checks;
mod error;
mod files;
mod frames;
mod motion;
mod series;
mod vtk_frame;
mod vtk_legacy;
mod vtk_xml;
mod xml;

pub use binary::Precision;
pub use checks::FrameNote;
pub use error::{FrameFault, NodeFramesError};
pub use frames::NodeFrames;
pub use motion::Motion;
