//! Vents and walls that exchange heat, before the run: how much flows at the start, and whether a probability of
//! passing can give it (docs/explanation/method.md, "Vents and leaks").

use super::limits::{Quantity, Warning};
use super::{Measured, MeasuredVent, VentPlan};
use crate::gas::vent::{LocalGas, flux, opens};
use crate::gas::wall_heat::accommodation;
use crate::gas::{Species, moles_at};
use crate::scene::{Method, Scene, SurfaceId, VentFlow};

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
            initial_mass_flow: if opens(vent, false, scene.chambers[place.chamber].pressure) { initial } else { 0.0 },
            largest_flux: largest_share(scene, species, index, place),
        }
    };
    places.map(plan).collect()
}

pub fn warnings(
    scene: &Scene,
    species: &[Species],
    method: Method,
    vents: &[VentPlan],
    measured: &Measured,
) -> Vec<String> {
    let of_vent = |vent: &VentPlan| {
        let table = |quantity, remedy: &str| {
            Warning::by_table(quantity, method, &format!("vent `{}`", vent.name), vent.largest_flux, remedy)
        };
        table(Quantity::VentHits, "spread its `area` over a larger place, or resolve the hole")
            .or_else(|| table(Quantity::VentFlux, "spread its `area` over a larger place"))
    };
    vents.iter().filter_map(of_vent).map(|warning| warning.text).chain(heat(scene, species, method, measured)).collect()
}

/// Walls whose coefficient is cut: by all methods alike.
pub fn heat(scene: &Scene, species: &[Species], method: Method, measured: &Measured) -> Vec<String> {
    let of_wall = |&(id, chamber): &(SurfaceId, usize)| {
        let heat = scene.surface_model(id).heat.as_ref()?;
        let share = accommodation(heat, species, &concentrations(scene, chamber), scene.chambers[chamber].temperature);
        let (surface, chamber) = (scene.surface_title(id), &scene.chambers[chamber].name);
        let subject = format!("{surface} at the start in chamber `{chamber}`");
        Warning::by_table(Quantity::Heat, method, &subject, share, "a smaller `heat_transfer`, or `accommodation`")
    };
    // A place on a wall can stand there beside its rest.
    let mut found: Vec<String> =
        measured.modelled_surfaces.iter().filter_map(of_wall).map(|warning| warning.text).collect();
    let mut told = std::collections::HashSet::new();
    found.retain(|text| told.insert(text.clone()));
    found
}
