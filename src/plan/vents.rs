//! Vents and walls that exchange heat, before the run: how much flows at the start, and whether a probability of
//! passing can give it (specification, section 4 "Modelled vent, porosity, leak").

use super::render::significant;
use super::{Measured, MeasuredVent, VentPlan};
use crate::gas::vent::{LocalGas, UNCLIPPED, flux};
use crate::gas::wall_heat::accommodation;
use crate::gas::{Species, moles_at};
use crate::scene::{Scene, VentFlow};

/// The most that a probability of one lets out over p / sqrt(R T / M): n cbar m / 4.
const KINETIC: f64 = 0.398_942_280_4;

/// Concentrations of the gas of a chamber at the start, mol/m3.
fn concentrations(scene: &Scene, chamber: usize) -> Vec<f64> {
    let asked = &scene.chambers[chamber];
    let total = moles_at(asked.pressure, 1.0, asked.temperature);
    let mut moles = vec![0.0; scene.gases.len()];
    for &(gas, fraction) in &asked.mixture.0 {
        moles[gas] += total * fraction;
    }
    moles
}

fn gas_of(scene: &Scene, species: &[Species], chamber: usize) -> Option<LocalGas> {
    LocalGas::new(species, &concentrations(scene, chamber), scene.chambers[chamber].temperature)
}

/// The largest flux that the vent can ask of this gas, over its place, in units of p / sqrt(R T / M): into vacuum at the
/// largest of its coefficients, or at the largest leak velocity.
fn largest_share(scene: &Scene, species: &[Species], index: usize, place: &MeasuredVent) -> f64 {
    let vent = &scene.vents[index];
    let Some(gas) = gas_of(scene, species, place.chamber) else { return 0.0 };
    let (VentFlow::Discharge(curve) | VentFlow::DischargeByPressure(curve) | VentFlow::LeakVelocity(curve)) =
        &vent.flow;
    let largest = curve.points.iter().map(|point| point[1]).fold(0.0, f64::max);
    let flux = match &vent.flow {
        VentFlow::LeakVelocity(_) => largest * gas.density(),
        VentFlow::Discharge(_) | VentFlow::DischargeByPressure(_) => largest * gas.isentropic_flux(0.0),
    };
    flux / gas.unit_flux() * vent.area.unwrap_or(place.area) / place.area
}

pub fn planned(scene: &Scene, species: &[Species], measured: &Measured) -> Vec<VentPlan> {
    let places = scene.vents.iter().zip(&measured.vents).enumerate();
    let plan = |(index, (vent, place)): (usize, (&crate::scene::Vent, &MeasuredVent))| {
        let area = vent.area.unwrap_or(place.area);
        let initial = gas_of(scene, species, place.chamber).map_or(0.0, |gas| area * flux(vent, &gas, 0.0));
        VentPlan {
            name: vent.name.clone(),
            chamber: place.chamber,
            area,
            place: place.area,
            initial_mass_flow: if vent.opening_pressure > 0.0 { 0.0 } else { initial },
            largest_flux: largest_share(scene, species, index, place),
        }
    };
    places.map(plan).collect()
}

pub fn warnings(scene: &Scene, species: &[Species], vents: &[VentPlan], measured: &Measured) -> Vec<String> {
    let mut warnings = Vec::new();
    for vent in vents {
        let what =
            format!("vent `{}` may have to pass {} p/sqrt(RT) of its place", vent.name, significant(vent.largest_flux));
        if vent.largest_flux > KINETIC {
            warnings.push(format!(
                "{what}, and all that hit it are {}: it cannot; spread its `area` over a larger place, or resolve the hole",
                significant(KINETIC)
            ));
        } else if vent.largest_flux > UNCLIPPED {
            warnings.push(format!(
                "{what}; from {UNCLIPPED} on probabilities are clipped, and what leaves takes less than its enthalpy: \
                 spread its `area` over a larger place"
            ));
        }
    }
    for &(wall, chamber) in &measured.heated {
        let Some(heat) = &scene.walls[wall].heat else { continue };
        let temperature = scene.chambers[chamber].temperature;
        let share = accommodation(heat, species, &concentrations(scene, chamber), temperature);
        if share > 1.0 {
            warnings.push(format!(
                "wall `{}`: its heat-transfer coefficient is {} times what all hits can carry at the start in chamber `{}`",
                scene.walls[wall].name,
                significant(share),
                scene.chambers[chamber].name
            ));
        }
    }
    warnings
}
