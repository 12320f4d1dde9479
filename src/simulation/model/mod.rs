//! From a scene to what a run needs: the vessel, what was measured of it, the walls that move, surface models and the plan. Opens
//! no device.

mod behind;
pub(super) mod build;
mod clearances;
mod contact;
mod enclosed;
pub(super) mod error;
pub(super) mod fabric;
mod fabric_obstacles;
mod fabric_paths;
mod fabric_surfaces;
pub(super) mod facing;
pub(super) mod flow_only;
mod fronts;
mod holes;
pub(super) mod measure;
pub(super) mod membranes;
pub(super) mod moving;
pub(super) mod open_sections;
mod orifices;
pub(super) mod outlook;
pub(super) mod parting_planes;
pub(super) mod patches;
pub(super) mod placed_model;
pub(super) mod places;
pub(super) mod plane;
mod pockets;
mod separate;
mod sides_of_walls;
mod strokes;
pub(super) mod surface_models;
pub(super) mod turning;
pub(super) mod vent_places;
