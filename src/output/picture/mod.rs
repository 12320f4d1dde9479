//! Pictures of runs and of meshes, drawn by a device without a screen: particles as shaded balls, walls that let them
//! through, meshes with their folds and outlines, and beside them what the colours mean, a scale bar and the axes.
//!
//! What is on a picture ([`Picture`]) and from where it is seen ([`Camera`]) are plain data; a [`Studio`] draws them.

mod annotation;
mod camera;
mod colours;
mod error;
mod image;
mod ink;
mod lettering;
mod model;
mod run_pictures;
mod studio;
mod surface;

pub use annotation::frame;
pub use camera::{Camera, Frame, View};
pub use colours::{Colour, of_kind, viridis};
pub use error::PictureError;
pub use image::Image;
pub use model::{Key, LengthUnit, Pane, Picture, Scale};
pub use run_pictures::{Colouring, FabricLook, RunPictures, Series};
pub use studio::Studio;
pub use surface::Surface;
