//! What the plan needs to know of the geometry.

use super::error::PlanError;
use crate::geometry::Passage;
use crate::scene::{Opening, SurfaceId};

/// What the plan needs to know of the geometry.
#[derive(Debug, Clone, PartialEq)]
pub struct Measured {
    /// m3: of the vessel, or of bags that all gas is in.
    pub gas_volume: f64,
    /// m3, one per chamber of the scene.
    pub chamber_volumes: Vec<f64>,
    /// m, the box around all walls.
    pub bounds_min: [f64; 3],
    pub bounds_max: [f64; 3],
    /// The openings found from the holes of the walls; those declared in the scene are added.
    pub openings: Vec<Opening>,
    /// The narrowest passage of the gas between walls that face each other, where one was found.
    pub smallest_gap: Option<Passage>,
    /// The thinnest body with gas on both sides, m, where one was found.
    pub thinnest_body: Option<f64>,
    /// m2, of all walls.
    pub wall_area: f64,
    /// m3 of gas, one per probe of the scene.
    pub probe_volumes: Vec<f64>,
    /// Of each vent of the scene.
    pub vents: Vec<MeasuredVent>,
    /// Each surface that is no mirror or has vents, with the index of a chamber that it borders on.
    pub modelled_surfaces: Vec<(SurfaceId, usize)>,
    /// Where walls move.
    pub motion: Option<MeasuredMotion>,
    /// Box, area and volume of each wall of the scene.
    pub walls: Vec<MeasuredWall>,
    /// Whether gas space that is in no chamber lies beside a chamber without a wall between.
    pub open_to_empty: bool,
    /// Pairs of chambers between which a part of the border is neither wall nor a hole of one.
    pub touching: Vec<[usize; 2]>,
    /// Pairs of chambers that are open to each other beside walls and holes.
    pub open_sections: Vec<OpenSection>,
    /// Holes that join no two chambers, or only with a part of their areas.
    pub hindered: Vec<Hindered>,
    /// Gaps round walls that part two chambers, or that move.
    pub gaps_beside: Vec<GapBeside>,
    /// Of the walls that move.
    pub strokes: Vec<Stroke>,
    /// Walls that move and have no gas before them at any time, or from some time on.
    pub dry_motions: Vec<DryMotion>,
    /// Spaces that open behind walls that move, and that no gas reaches.
    pub pockets: Vec<Pocket>,
    /// Surfaces of the scene that have none.
    pub dry_surfaces: Vec<usize>,
    /// Vents with gas of the scene behind them, and its chamber.
    pub backed_vents: Vec<[usize; 2]>,
    /// The chamber that each orifice of the scene blows into, where there is one.
    pub sources: Vec<Option<usize>>,
    /// How many spaces of gas no gas flows between, where that is more than one and walls overlap.
    pub separate_spaces: Option<usize>,
    /// Chambers whose gas is in several of such spaces.
    pub split_chambers: Vec<SplitChamber>,
    /// Orifices with a wall right before them.
    pub facing_orifices: Vec<FacingOrifice>,
    /// m3, about what bags of elastic fabric hold when they are inflated, where all gas is in bags.
    pub inflated: Option<f64>,
    /// kg, the lightest node of elastic fabric that is free, where there is any.
    pub lightest_node: Option<f64>,
    /// 1/m3, the most nodes of a closed elastic surface over its area times the radius of a sphere of that.
    pub nodes_over_volume: Option<f64>,
}

impl Measured {
    /// m3 of all gas at the end of the run, of elastic bags about.
    pub(super) fn final_volume(&self) -> f64 {
        let moved = self.motion.map_or(self.gas_volume, |motion| motion.final_gas_volume);
        self.inflated.unwrap_or(moved)
    }

    /// m3 of gas space in no chamber.
    pub(super) fn empty_space(&self) -> f64 {
        self.gas_volume - self.chamber_volumes.iter().sum::<f64>()
    }

    /// That all gas space has gas at the start: what flows into empty space no control volume knows, and no forecast.
    ///
    /// # Errors
    /// If chambers leave more of it out than holes have.
    pub(super) fn no_empty_space(&self, asked: &'static str) -> Result<(), PlanError> {
        let (chambers, gas) = (self.chamber_volumes.iter().sum::<f64>(), self.gas_volume);
        if self.empty_space() > IN_HOLES * gas {
            return Err(PlanError::EmptySpace { asked, chambers, gas });
        }
        Ok(())
    }
}

/// The part of the gas space that may be in no chamber, as the inside of holes is.
pub(super) const IN_HOLES: f64 = 0.01;

/// What moving walls do to the gas.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct MeasuredMotion {
    /// m3, of all gas at the end of the run.
    pub final_gas_volume: f64,
    /// The least volume of a chamber in the run, over that at the start.
    pub least_share: f64,
    /// m/s, of the fastest wall.
    pub fastest: f64,
}

/// A wall at the start of the run.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct MeasuredWall {
    /// m, the corners of the box around it.
    pub min: [f64; 3],
    pub max: [f64; 3],
    /// m2.
    pub area: f64,
    /// m3, what it encloses: gas in a cavity, else solid.
    pub volume: f64,
    pub cavity: bool,
    /// Of a solid: the share of its volume that lies outside of what encloses the gas.
    pub outside: f64,
    /// m3 without gas within a shell of gas that the wall encloses; 0 where there is none.
    pub hollow: f64,
}

/// Where two chambers meet and no wall lies between them.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct OpenSection {
    pub between: [usize; 2],
    /// The open share of the area over which they would meet without the walls that are in the gas.
    pub share: f64,
}

/// A hole that is no opening between two chambers, or not with all of its area.
#[derive(Debug, Clone, PartialEq)]
pub struct Hindered {
    pub name: String,
    pub wall: usize,
    /// m2, as drawn.
    pub area: f64,
    pub why: Hindrance,
}

#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Hindrance {
    /// The gas on both sides is that of one.
    OneChamber(usize),
    /// Of its area the share that is open at some time of the run, the wall that covers most of the rest, and whether its middle joins
    /// two chambers at the start.
    Covered { open: f64, by: usize, joins: bool },
}

/// A gap between the side of a wall and another wall.
#[derive(Debug, Clone, PartialEq)]
pub struct GapBeside {
    pub gap: Passage,
    pub wall: usize,
    /// The chambers that the wall parts; none of a wall that moves.
    pub chambers: Option<[usize; 2]>,
}

/// How far a wall moves in the whole run.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Stroke {
    /// Index of the motion.
    pub motion: usize,
    /// m, to and fro.
    pub way: f64,
    /// The chamber that is shortest along the motion, of those that the wall borders on, and its length, m.
    pub chamber: usize,
    pub length: f64,
}

/// A chamber whose gas is in several spaces that no gas flows between.
#[derive(Debug, Clone, PartialEq)]
pub struct SplitChamber {
    pub chamber: usize,
    /// m3 in each, the largest first.
    pub volumes: Vec<f64>,
}

/// A wall that moves without gas before it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct DryMotion {
    pub wall: usize,
    /// s; 0: at no time of the run.
    pub since: f64,
    /// Whether it would have gas before it if it moved the other way.
    pub other_way: bool,
}

/// A space that opens behind a wall that moves, without gas.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Pocket {
    pub wall: usize,
    /// s, when it opens.
    pub time: f64,
    /// m that the wall goes on after that, to its farthest place.
    pub further: f64,
}

/// An orifice whose jet meets a wall at once.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FacingOrifice {
    pub orifice: usize,
    pub wall: usize,
    /// m, to the wall, and of its disc.
    pub distance: f64,
    pub radius: f64,
}

/// Where a vent is.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct MeasuredVent {
    pub chamber: usize,
    /// m2 of wall.
    pub area: f64,
}
