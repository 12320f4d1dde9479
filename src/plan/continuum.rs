//! Where the method `half-turn` may be taken that nobody asked for: it has no mean free path, so the gas itself has to
//! be a continuum at the size of the vessel, and nothing asked for may be what it has not. Of a scene without a wish it
//! is the method where that holds, no wall moves, and no hole is narrower than a few spacings.

use super::amounts::Amounts;
use super::population::{openings, wanted};
use super::resolution::COLLISION_CELL;
use super::text::significant;
use super::{Measured, Reason};
use crate::gas::kinetics;
use crate::scene::{Method, ModelRequest, Scene};

/// Mean free path of the molecules over the smallest hole or chamber, below which rarefaction counts no longer.
const KNUDSEN: f64 = 0.01;
/// Mean spacings across the narrowest hole, at least: a narrower one passes no more than by `closest-approach` (method.md,
/// "What the plan decides, and why").
const SPACINGS_ACROSS: f64 = 4.0;

/// The method of a scene, and why.
pub fn method(scene: &Scene, measured: &Measured, amounts: &Amounts) -> (Method, Reason) {
    let because =
        |method: Method, why: String| (method, Reason { quantity: "method".into(), value: method.name().into(), why });
    if let Some(method) = scene.model.method {
        return because(method, "asked for".into());
    }
    let (particles, _) = wanted(scene, measured, amounts, Method::HalfTurn, 0.0);
    let spacing = kinetics::mean_spacing(particles as f64 / measured.gas_volume);
    match unfit_unasked(scene, measured, amounts, spacing) {
        Some(unfit) => because(
            Method::ClosestApproach,
            format!("right for jets and vents, with the ideal gas's pressure at any occupancy; not half-turn: {unfit}"),
        ),
        None => {
            let knudsen = significant(molecular_knudsen(scene, measured, amounts));
            let across = narrowest(scene, measured).map_or(String::new(), |(_, width)| {
                format!(", and its narrowest hole {} mean spacings wide", significant(width / spacing))
            });
            because(
                Method::HalfTurn,
                format!("the least viscous: the gas itself is a continuum, Kn {knudsen} of its molecules{across}"),
            )
        }
    }
}

/// Why it may not be without a wish, of particles of this mean spacing, m, at the end.
fn unfit_unasked(scene: &Scene, measured: &Measured, amounts: &Amounts, spacing: f64) -> Option<String> {
    if measured.motion.is_some() {
        return Some("walls move".into());
    }
    let narrow = || {
        let (name, width) = narrowest(scene, measured)?;
        (width < SPACINGS_ACROSS * spacing).then(|| {
            format!(
                "opening `{name}` is {} mean spacings wide, at least {SPACINGS_ACROSS}",
                significant(width / spacing)
            )
        })
    };
    unfit(scene, measured, amounts).or_else(narrow)
}

/// Why it may not be.
pub fn unfit(scene: &Scene, measured: &Measured, amounts: &Amounts) -> Option<String> {
    if let Some(key) = asked_of_others(&scene.model) {
        return Some(format!("it has no `{key}`"));
    }
    let knudsen = molecular_knudsen(scene, measured, amounts);
    (knudsen >= KNUDSEN).then(|| {
        format!("the gas itself is rarefied: Kn {} of molecules of 0.37 nm, at most {KNUDSEN}", significant(knudsen))
    })
}

/// The first key that the scene asks for which only other methods heed.
fn asked_of_others(model: &ModelRequest) -> Option<&'static str> {
    let asked = [
        ("diameter", model.diameter.is_some()),
        ("occupancy", model.occupancy.is_some()),
        ("diameter_cap", model.diameter_cap.is_some()),
        ("rounds", model.rounds.is_some()),
        ("collision_number", model.collision_number.is_some()),
    ];
    asked.into_iter().find_map(|(name, asked)| asked.then_some(name))
}

/// The narrowest hole: its name and its width, m, which is the diameter of a round one.
fn narrowest<'a>(scene: &'a Scene, measured: &'a Measured) -> Option<(&'a str, f64)> {
    let widths = openings(scene, measured).map(|opening| (opening.name.as_str(), 2.0 * opening.length));
    widths.min_by(|a, b| a.1.total_cmp(&b.1))
}

/// The largest of all chambers, by their sizes, and holes, by the denser gas beside them. (Of a chamber without gas
/// that of all gas at the end.)
fn molecular_knudsen(scene: &Scene, measured: &Measured, amounts: &Amounts) -> f64 {
    let at_end = kinetics::molecular_mean_free_path(amounts.total() / measured.gas_volume);
    let path = |chamber: usize| {
        let moles: f64 = amounts.initial[chamber].iter().sum();
        let own = kinetics::molecular_mean_free_path(moles / measured.chamber_volumes[chamber]);
        if moles > 0.0 { own } else { at_end }
    };
    let of_chambers =
        (0..scene.chambers.len()).map(|chamber| path(chamber) / libm::cbrt(measured.chamber_volumes[chamber]));
    let of_holes = openings(scene, measured).map(|opening| {
        let [a, b] = opening.between.map(path);
        a.min(b) / opening.length
    });
    of_chambers.chain(of_holes).fold(at_end / libm::cbrt(measured.gas_volume), f64::max)
}

/// Particles of which a collision cell is no longer than the radius of the smallest hole, at the mean density of the
/// end: five spacings across it. That is the guard of the smallest passage, and below it the flow through a hole was
/// not measured.
pub fn fewest(scene: &Scene, measured: &Measured) -> f64 {
    let smallest = openings(scene, measured).map(|opening| opening.length).fold(f64::INFINITY, f64::min);
    let across = COLLISION_CELL / smallest;
    measured.gas_volume * across * across * across
}
