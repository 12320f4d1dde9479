//! The method `control-volume`: a run, or the rest of one (`switch`), without particles (specification, section 6: right
//! where pressures are uniform).
//!
//! Each chamber is uniform; `reference` has its equations. A row has the state in the middle of its window, and what
//! surfaces received in it by Simpson's rule. A probe shows the chamber that its middle lies in; a surface is pressed
//! by the chambers that its parts face. No device, no ranks, no random numbers: a run takes milliseconds.

use glam::DVec3;

use crate::gas::{
    Beginning, FlowIntegral, Lost, State, Vented, flow_times_of_temperature, flow_times_temperature, thermo,
};
use crate::geometry::{Vessel, region_bounds};
use crate::output::Audit;
use crate::scene::{Scene, Surface};

use super::SimulationError;
use super::averages::{MotionState, Row, SurfaceState, VentState, WallState, ZoneState};
use super::model::{Model, chamber_of};
use super::observer::Observer;
use super::reference::{continued_with_losses, heated_walls, reference_with_losses};

/// Parts along each edge into which a triangle is cut to find what chambers it faces.
const PARTS: u32 = 8;
/// Parts of a row over which the work of moving walls is summed.
const WORK_PARTS: u32 = 32;

/// Emits the rows of the whole run and closes its account.
///
/// # Errors
/// If a probe or a surface lies in no chamber, or the observer stops the run.
pub fn run_uniform(model: &Model, observer: &mut dyn Observer) -> Result<Audit, SimulationError> {
    let rows = model.scene.output.rows.max(1);
    let bounds: Vec<f64> = (0..=rows).map(|row| model.plan.end_time * f64::from(row) / f64::from(rows)).collect();
    let solved = |times: &[f64]| reference_with_losses(model, times);
    let known = Known::of(&model.scene, &model.vessel)?;
    stretch(model, &known, &solved, &bounds, None, observer)
}

/// Goes on from a state that particles had and emits the rows that end at `ends`, s, which are after it. `last`: the row
/// before, whose totals go on. The audit is that of what follows.
///
/// # Errors
/// If the observer stops the run.
pub(super) fn continue_uniform(
    model: &Model,
    known: &Known,
    beginning: &Beginning,
    ends: &[f64],
    last: Option<&Row>,
    observer: &mut dyn Observer,
) -> Result<Audit, SimulationError> {
    let bounds = [&[beginning.time], ends].concat();
    let solved = |times: &[f64]| continued_with_losses(model, beginning, times);
    stretch(model, known, &solved, &bounds, last, observer)
}

/// A probe or a surface of which a control volume knows nothing.
#[derive(Debug, thiserror::Error, miette::Diagnostic)]
#[error("{what}, ({:.4}, {:.4}, {:.4}) m, is in no chamber: a control volume knows nothing there", point[0], point[1], point[2])]
#[diagnostic(help("move it into the gas, or leave it out"))]
pub struct NoChamber {
    what: String,
    point: [f64; 3],
}

/// Where a scene's probes and surfaces are: what a control volume must know of them.
pub(super) struct Known {
    /// The chamber of each probe.
    pub probes: Vec<usize>,
    /// The faces of each surface.
    pub surfaces: Vec<Vec<Face>>,
}

impl Known {
    /// # Errors
    /// If a probe or a surface lies in no chamber.
    pub fn of(scene: &Scene, vessel: &Vessel) -> Result<Known, NoChamber> {
        let surfaces = scene.surfaces.iter().map(|surface| facing(scene, vessel, surface)).collect::<Result<_, _>>()?;
        Ok(Known { probes: probes(scene, vessel)?, surfaces })
    }
}

/// States, and what has left since the start of the stretch, at times that ascend from it.
type Solved<'a> = &'a dyn Fn(&[f64]) -> Vec<(Vec<State>, Lost)>;

fn stretch(
    model: &Model,
    known: &Known,
    solved: Solved<'_>,
    bounds: &[f64],
    last: Option<&Row>,
    observer: &mut dyn Observer,
) -> Result<Audit, SimulationError> {
    let Model { plan, .. } = model;
    let rows = bounds.len() - 1;
    // Ends and middles of the windows.
    let half = |k: usize| 0.5 * (bounds[k / 2] + bounds[k.div_ceil(2)]);
    let times: Vec<f64> = (0..=2 * rows).map(half).collect();
    let states = solved(&times);
    let heated = heated_walls(model);
    let Known { probes, surfaces } = known;
    let mut received: Vec<[f64; 3]> = match last {
        Some(row) => row.surfaces.iter().map(|surface| surface.impulse).collect(),
        None => vec![[0.0; 3]; surfaces.len()],
    };
    let works = works(model, solved, bounds);
    let mut worked: Vec<f64> = last.map_or_else(Vec::new, |row| row.motions.iter().map(|motion| motion.work).collect());
    worked.resize(model.moving.count(), 0.0);
    let worked_before: f64 = worked.iter().sum();
    for row in 0..rows {
        let [before, middle, after] = [0, 1, 2].map(|k| &states[2 * row + k].0);
        let [lost_before, lost_after] = [0, 2].map(|k| &states[2 * row + k].1);
        let window = [times[2 * row], times[2 * row + 2]];
        let zones: Vec<ZoneState> =
            (0..plan.chambers.len()).map(|index| zone(model, index, times[2 * row + 1], &middle[index])).collect();
        let pressed = |chamber: usize| {
            (before[chamber].pressure + 4.0 * middle[chamber].pressure + after[chamber].pressure) / 6.0
        };
        let on_surfaces = surfaces.iter().zip(&mut received).map(|(faces, received)| {
            let mut force = DVec3::ZERO;
            let (mut sum, mut area) = (0.0, 0.0);
            for face in faces {
                let pressure = pressed(face.chamber);
                force += pressure * face.outward;
                sum += pressure * face.area;
                area += face.area;
            }
            for (total, own) in received.iter_mut().zip((force * (window[1] - window[0])).to_array()) {
                *total += own;
            }
            SurfaceState { pressure: sum / area, impulse: *received, hits: 0 }
        });
        let on_surfaces = on_surfaces.collect();
        let mut motions = Vec::new();
        for (index, [displacement, velocity]) in model.moving.courses(times[2 * row + 1]).into_iter().enumerate() {
            let own = works[row][index];
            worked[index] += own;
            let power = own / (window[1] - window[0]);
            motions.push(MotionState { displacement, velocity, work: worked[index], power });
        }
        observer.row(&Row {
            time: times[2 * row + 1],
            window,
            step: window[1] - window[0],
            particles: 0,
            probes: probes.iter().map(|&chamber| zones[chamber].clone()).collect(),
            chambers: zones,
            surfaces: on_surfaces,
            walls: walls(model, &heated, window, [lost_before, lost_after], last),
            vents: vents(window, [lost_before, lost_after], last),
            motions,
        })?;
        observer.progress(window[1], row as u64 + 1, 0);
    }
    let work = (!model.moving.is_empty()).then(|| worked.iter().sum::<f64>() - worked_before);
    let (end, lost) = &states[states.len() - 1];
    let heat = (!heated.is_empty()).then(|| lost.heat.iter().sum());
    Ok(Audit {
        work_by_walls: work,
        heat_to_walls: heat,
        mass_vented: lost.vented.iter().map(|vent| vent.mass).sum(),
        enthalpy_vented: lost.vented.iter().map(|vent| vent.enthalpy).sum(),
        ..audit(model, &states[0].0, end, [bounds[0], bounds[rows]])
    })
}

/// Those that keep a temperature, in the order of the scene; `lost`: until the start and the end of the window.
fn walls(model: &Model, heated: &[usize], window: [f64; 2], lost: [&Lost; 2], last: Option<&Row>) -> Vec<WallState> {
    let of_wall = |(index, wall): (usize, usize)| {
        let earlier = last.map_or(0.0, |row| row.walls[index].heat);
        let own = heated.iter().enumerate().filter(|(_, of)| **of == wall).map(|(index, _)| index);
        let [before, after] = lost.map(|lost| own.clone().map(|index| lost.heat[index]).sum::<f64>());
        let coats = model.coats.coats.iter().filter(|coat| coat.wall == wall);
        let area: f64 = coats.map(|coat| coat.area).sum();
        WallState { heat: earlier + after, heat_flux: (after - before) / (area * (window[1] - window[0])) }
    };
    let kept = (0..model.scene.walls.len()).filter(|&wall| model.scene.walls[wall].heat.is_some());
    kept.enumerate().map(of_wall).collect()
}

/// What passes is what should: there is no particle that could not.
fn vents(window: [f64; 2], [before, after]: [&Lost; 2], last: Option<&Row>) -> Vec<VentState> {
    let of_vent = |(index, (before, after)): (usize, (&Vented, &Vented))| {
        let [earlier, enthalpy] = last.map_or([0.0; 2], |row| [row.vents[index].mass, row.vents[index].enthalpy]);
        let mass = after.mass - before.mass;
        let isentropic = after.isentropic - before.isentropic;
        let mass_flow = mass / (window[1] - window[0]);
        let discharge = if isentropic > 0.0 { mass / isentropic } else { 0.0 };
        VentState {
            mass_flow,
            wanted_mass_flow: mass_flow,
            discharge,
            wanted_discharge: discharge,
            mass: earlier + after.mass,
            enthalpy: enthalpy + after.enthalpy,
        }
    };
    before.vented.iter().zip(&after.vented).enumerate().map(of_vent).collect()
}

/// The work of each moving wall on the gas in each row, J: -p dV, by the mean of p between near times (and not by the
/// integration of the energy, which this is to check).
fn works(model: &Model, solved: Solved<'_>, bounds: &[f64]) -> Vec<Vec<f64>> {
    let moving = &model.moving;
    let rows = bounds.len() - 1;
    if moving.is_empty() {
        return vec![Vec::new(); rows];
    }
    let parts = bounds.windows(2).flat_map(|row| {
        (1..=WORK_PARTS).map(|part| row[0] + (row[1] - row[0]) * f64::from(part) / f64::from(WORK_PARTS))
    });
    let times: Vec<f64> = std::iter::once(bounds[0]).chain(parts).collect();
    let states = solved(&times);
    let mut works = vec![vec![0.0; moving.count()]; rows];
    for (k, (pair, around)) in states.windows(2).zip(times.windows(2)).enumerate() {
        for (work, swept) in works[k / WORK_PARTS as usize].iter_mut().zip(&moving.swept) {
            for (chamber, (before, after)) in pair[0].0.iter().zip(&pair[1].0).enumerate() {
                let growth = swept.change(chamber, around[1]) - swept.change(chamber, around[0]);
                *work -= 0.5 * (before.pressure + after.pressure) * growth;
            }
        }
    }
    works
}

fn zone(model: &Model, chamber: usize, time: f64, state: &State) -> ZoneState {
    let plan = &model.plan;
    let drawn = plan.chambers[chamber].volume;
    let volume = model.moving.swept.iter().fold(drawn, |volume, swept| volume + swept.change(chamber, time));
    let mass: f64 = state.moles.iter().zip(&plan.gases).map(|(n, gas)| n * gas.molar_mass).sum();
    ZoneState {
        pressure: state.pressure,
        temperature: state.temperature,
        density: mass / volume,
        volume,
        velocity: [0.0; 3],
        particles: state.moles.iter().map(|n| n / plan.moles_per_particle).collect(),
    }
}

/// The chamber of each.
fn probes(scene: &Scene, vessel: &Vessel) -> Result<Vec<usize>, NoChamber> {
    let chamber = |probe: &crate::scene::Probe| {
        let (low, high) = region_bounds(&probe.region);
        let middle = std::array::from_fn(|axis| 0.5 * (low[axis] + high[axis]));
        let what = || format!("the middle of probe \"{}\"", probe.name);
        chamber_of(scene, vessel, middle).ok_or_else(|| NoChamber { what: what(), point: middle })
    };
    scene.probes.iter().map(chamber).collect()
}

/// A part of a surface and the chamber whose gas presses it.
pub(super) struct Face {
    pub chamber: usize,
    /// m2.
    pub area: f64,
    /// Area times the unit normal away from the gas.
    outward: DVec3,
}

/// # Errors
/// If no gas lies before the surface.
pub(super) fn facing(scene: &Scene, vessel: &Vessel, surface: &Surface) -> Result<Vec<Face>, NoChamber> {
    let mut faces: Vec<Face> = Vec::new();
    let vertex = |index: u32| DVec3::from(vessel.vertices[index as usize]);
    let own = vessel.triangles.iter().filter(|triangle| {
        triangle.wall as usize == surface.wall && (surface.face.is_none() || triangle.face == surface.face)
    });
    for triangle in own {
        let [a, b, c] = triangle.vertices.map(vertex);
        // Twice the area, towards the gas.
        let cross = (b - a).cross(c - a);
        let share = 1.0 / f64::from(PARTS * PARTS);
        let lift = 1e-4 * cross.length().sqrt() * cross.normalize();
        for (u, v) in parts() {
            let point = (a + u * (b - a) + v * (c - a) + lift).to_array();
            // Where walls meet, a part may lie within another's solid: it is not pressed.
            let Some(chamber) = chamber_of(scene, vessel, point) else { continue };
            let (area, outward) = (0.5 * share * cross.length(), -0.5 * share * cross);
            match faces.iter_mut().find(|face| face.chamber == chamber) {
                Some(face) => {
                    face.area += area;
                    face.outward += outward;
                }
                None => faces.push(Face { chamber, area, outward }),
            }
        }
    }
    if faces.is_empty() {
        let point = vessel.bounds.0;
        return Err(NoChamber { what: format!("the gas before surface \"{}\"", surface.name), point });
    }
    Ok(faces)
}

/// The middles of the equal parts of a triangle, along two of its edges.
fn parts() -> impl Iterator<Item = (f64, f64)> {
    let place = |k: u32, third: f64| (f64::from(k) + third) / f64::from(PARTS);
    (0..PARTS).flat_map(move |i| {
        (0..PARTS - i).flat_map(move |j| {
            let upright = Some((place(i, 1.0 / 3.0), place(j, 1.0 / 3.0)));
            let turned = (i + j + 2 <= PARTS).then(|| (place(i, 2.0 / 3.0), place(j, 2.0 / 3.0)));
            upright.into_iter().chain(turned)
        })
    })
}

/// Of the time between two states.
fn audit(model: &Model, start: &[State], end: &[State], [from, until]: [f64; 2]) -> Audit {
    let Model { scene, plan, .. } = model;
    let species = plan.species();
    let mass = |moles: &[f64]| moles.iter().zip(&species).map(|(n, gas)| n * gas.molar_mass).sum::<f64>();
    let (mut injected, mut enthalpy) = (0.0, 0.0);
    // By the curves themselves, not by the integration that this is to check.
    for orifice in &scene.orifices {
        let molar_mass = thermo::molar_mass(&orifice.mixture, &species);
        let (flow, temperature) = (&orifice.mass_flow, &orifice.temperature);
        injected += FlowIntegral::new(flow, until).total() - FlowIntegral::new(flow, from).total();
        let by = |time: f64| {
            if thermo::is_constant(&orifice.mixture, &species) {
                let specific = thermo::molar_enthalpy(&orifice.mixture, &species, 1.0) / molar_mass;
                specific * flow_times_temperature(flow, temperature, time)
            } else {
                let specific = |t: f64| thermo::molar_enthalpy(&orifice.mixture, &species, t) / molar_mass;
                flow_times_of_temperature(flow, temperature, time, specific)
            }
        };
        enthalpy += by(until) - by(from);
    }
    Audit {
        mass_start: start.iter().map(|state| mass(&state.moles)).sum(),
        mass_injected: injected,
        mass_end: end.iter().map(|state| mass(&state.moles)).sum(),
        energy_start: start.iter().map(|state| state.energy).sum(),
        enthalpy_injected: enthalpy,
        energy_end: end.iter().map(|state| state.energy).sum(),
        ..Audit::default()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::{Method, parse};

    #[derive(Default)]
    struct Rows(Vec<Row>);

    impl Observer for Rows {
        fn row(&mut self, row: &Row) -> Result<(), SimulationError> {
            self.0.push(row.clone());
            Ok(())
        }
    }

    fn run(text: &str) -> (Model, Vec<Row>, Audit) {
        let mut scene = parse(text, "test.toml", std::path::Path::new("")).unwrap();
        scene.model.method = Some(Method::ControlVolume);
        let model = Model::new(scene).unwrap();
        let mut rows = Rows::default();
        let audit = run_uniform(&model, &mut rows).unwrap();
        (model, rows.0, audit)
    }

    #[test]
    fn the_parts_of_a_triangle_are_equal_and_fill_it() {
        let found: Vec<(f64, f64)> = parts().collect();
        assert_eq!(found.len(), (PARTS * PARTS) as usize);
        let mean = found.iter().fold([0.0; 2], |[a, b], (u, v)| [a + u, b + v]).map(|sum| sum / found.len() as f64);
        assert!(mean.iter().all(|mean| (mean - 1.0 / 3.0).abs() < 1e-12), "{mean:?}");
        assert!(found.iter().all(|(u, v)| *u > 0.0 && *v > 0.0 && u + v < 1.0));
    }

    /// The tank: mass and energy are those of the curves, and at the end one pressure is in both chambers, that of all
    /// gas with all its energy. The wall that it presses is in the tank, the probe too.
    #[test]
    fn a_filled_tank_has_the_gas_and_the_energy_that_came_in() {
        let (model, rows, audit) = run(include_str!("../../scenes/tank.toml"));
        assert!(audit.mass_error().abs() < 1e-12 && audit.energy_error().abs() < 1e-9, "{audit:?}");
        assert!(audit.verdict(&crate::output::AuditLimits::default()).is_empty());
        // The check can fail, though no particle is counted.
        let lost = Audit { energy_end: 0.999 * audit.energy_end, ..audit.clone() };
        assert_eq!(lost.verdict(&crate::output::AuditLimits::default()).len(), 1);
        assert_eq!(rows.len(), 100);
        let end = &rows[99];
        let [inner, tank] = [0, 1].map(|k| end.chambers[k].pressure);
        // p V = (gamma - 1) U, gamma 1.4 of both gases.
        let volume: f64 = model.plan.chambers.iter().map(|chamber| chamber.volume).sum();
        let expected = 0.4 * audit.energy_end / volume;
        assert!(
            (inner / expected - 1.0).abs() < 1e-3 && (tank / expected - 1.0).abs() < 1e-3,
            "{inner} {tank} {expected}"
        );
        let rising = &rows[8];
        assert!(rising.chambers[0].pressure > 1.02 * rising.chambers[1].pressure);
        assert!((rising.surfaces[0].pressure / rising.chambers[1].pressure - 1.0).abs() < 1e-3);
        assert_eq!(rising.probes[0], rising.chambers[1]);
        // Nitrogen in moles, counted in parts of all gas: as many as flowed in.
        let unit = model.plan.moles_per_particle;
        let nitrogen = end.chambers.iter().map(|chamber| chamber.particles[1]).sum::<f64>() * unit * 0.0280134;
        assert!((nitrogen / audit.mass_injected - 1.0).abs() < 1e-9);
        // The wall has received the pressure's time integral along its outward normal, +x.
        let [x, y, z] = end.surfaces[0].impulse;
        let received: f64 =
            rows.iter().map(|row| row.surfaces[0].pressure * (row.window[1] - row.window[0]) * 0.4 * 0.3785).sum();
        assert!((x / received - 1.0).abs() < 1e-3 && y.abs() < 1e-9 * x && z.abs() < 1e-9 * x);
    }

    const TWO: &str = "end_time = 0.02\n[[gas]]\nname = \"air\"\nmolar_mass = 0.029\ngamma = 1.4\n\
         [[wall]]\nname = \"box\"\nshape = \"box\"\nmin = [-1.0, -1.0, -1.0]\nmax = [1.0, 1.0, 1.0]\ngas = \"inside\"\n\
         [[wall]]\nname = \"inner\"\nshape = \"box\"\nmin = [-0.1, -0.1, -0.1]\nmax = [0.1, 0.1, 0.1]\nthickness = 0.005\n\
         [[wall.hole]]\nname = \"hole\"\nface = \"+x\"\ncenter = [0.0, 0.0]\ndiameter = 0.02\n\
         [[chamber]]\nname = \"inner\"\nregion = { box = { min = [-0.1, -0.1, -0.1], max = [0.1, 0.1, 0.1] } }\n\
         pressure = 4e5\ntemperature = 500.0\ngas = \"air\"\n\
         [[chamber]]\nname = \"outer\"\npressure = 1e3\ntemperature = 300.0\ngas = \"air\"\n\
         [output]\nrows = 20\nsnapshots = 0\n";

    /// Gas that is left behind by a choked flow has expanded isentropically, T ~ n^(gamma - 1), and its pressure falls as
    /// p/p0 = (1 + (gamma - 1)/2 k t)^(-2 gamma/(gamma - 1)), k = .84 A c0 / V ((gamma + 1)/2)^(-(gamma + 1)/2(gamma - 1)).
    #[test]
    fn a_chamber_that_blows_down_does_so_isentropically() {
        let (_, rows, audit) = run(TWO);
        assert!(audit.verdict(&crate::output::AuditLimits::default()).is_empty());
        let sound = (1.4 * 8.314462618 * 500.0 / 0.029f64).sqrt();
        // A circle stands as a polygon of its area.
        let area = std::f64::consts::PI * 1e-4;
        let rate =
            |gamma: f64| 0.84 * area * sound / 0.008 * (0.5 * (gamma + 1.0)).powf(-0.5 * (gamma + 1.0) / (gamma - 1.0));
        let pressure = |t: f64| 4e5 * (1.0 + 0.2 * rate(1.4) * t).powf(-7.0);
        for row in &rows {
            let inner = &row.chambers[0];
            let isentropic = 500.0 * (inner.pressure / 4e5).powf(0.4 / 1.4);
            assert!((inner.temperature / isentropic - 1.0).abs() < 1e-6, "{inner:?}");
            // The volume is measured by lines.
            assert!(
                (inner.pressure / pressure(row.time) - 1.0).abs() < 2e-3,
                "{} {}",
                inner.pressure,
                pressure(row.time)
            );
        }
        let last = &rows[19].chambers[0];
        assert!(last.pressure < 3.3e5, "enough has flowed out: {}", last.pressure);
        // The check can fail: isothermal gas would be at 500 K.
        assert!(last.temperature < 475.0);
    }

    /// Walls with a coefficient take the heat of an exponential, and pores the mass of choked isentropic flow; rows and audit
    /// have both.
    #[test]
    fn heat_and_gas_that_leave_are_in_the_rows_and_in_the_audit() {
        let cube = |wall: &str, vent: &str, temperature: f64| {
            run(&format!(
                "end_time = 0.005\n[[gas]]\nname = \"nitrogen\"\nmolar_mass = 0.028\ngamma = 1.4\n\
                 [[wall]]\nname = \"box\"\nshape = \"box\"\nmin = [0.0, 0.0, 0.0]\nmax = [0.1, 0.1, 0.1]\n\
                 gas = \"inside\"\n{wall}\n[[chamber]]\nname = \"all\"\npressure = 1e5\ntemperature = {temperature}\n\
                 gas = \"nitrogen\"\n{vent}[output]\nrows = 20\nsnapshots = 0\n"
            ))
        };
        let gas_constant = 8.314462618;
        // tau = n cv / (h A) of 2.5 ms.
        let coefficient = 1e5 * 1e-3 / (gas_constant * 600.0) * 2.5 * gas_constant / (0.06 * 2.5e-3);
        let (model, rows, audit) = cube(&format!("temperature = 300.0\nheat_transfer = {coefficient:e}"), "", 600.0);
        assert!(audit.verdict(&crate::output::AuditLimits::default()).is_empty());
        let capacity = coefficient * 0.06 * 2.5e-3;
        for row in &rows {
            let expected = 300.0 + 300.0 * (-row.time / 2.5e-3).exp();
            assert!((row.chambers[0].temperature / expected - 1.0).abs() < 1e-8, "{row:?}");
            let end = 300.0 + 300.0 * (-row.window[1] / 2.5e-3).exp();
            assert!((row.walls[0].heat / (capacity * (600.0 - end)) - 1.0).abs() < 1e-7, "{row:?}");
            let flux = row.walls[0].heat_flux * 0.06 * (row.window[1] - row.window[0]);
            assert!(flux > 0.0 && flux < row.walls[0].heat * (1.0 + 1e-12));
        }
        assert_eq!(audit.heat_to_walls, Some(rows[19].walls[0].heat));
        assert!((audit.energy_start - audit.energy_end - capacity * 300.0 * (1.0 - (-2.0f64).exp())).abs() < 1e-6);
        // The check can fail: walls without that are mirrors.
        assert!(cube("", "", 600.0).2.heat_to_walls.is_none() && model.scene.walls[0].heat.is_some());

        let pores = "[[vent]]\nname = \"pores\"\nwall = \"box\"\ndischarge = 0.02\nexternal_pressure = 0.0\n";
        let (_, rows, audit) = cube("", pores, 400.0);
        assert!(audit.verdict(&crate::output::AuditLimits::default()).is_empty());
        let choked = 1.4f64.sqrt() * (2.0 / 2.4f64).powi(3);
        let rate = 0.02 * 0.06 / 1e-3 * choked * (gas_constant * 400.0 / 0.028f64).sqrt();
        let left = |time: f64| (1.0 + 0.2 * rate * time).powi(-5);
        for row in &rows {
            assert!((row.vents[0].mass / audit.mass_start / (1.0 - left(row.window[1])) - 1.0).abs() < 1e-6, "{row:?}");
            assert!((row.vents[0].discharge - 0.02).abs() < 1e-9);
        }
        let vented = rows[19].vents[0];
        assert_eq!((audit.mass_vented, audit.enthalpy_vented), (vented.mass, vented.enthalpy));
        assert!(audit.mass_vented > 0.3 * audit.mass_start && audit.energy_error().abs() < 1e-12, "{audit:?}");
    }

    #[test]
    fn a_probe_in_a_wall_is_refused() {
        let text = format!(
            "{TWO}[[probe]]\nname = \"in the shell\"\nregion = {{ sphere = {{ center = [0.1025, 0.05, 0.05], radius = 0.02 }} }}\n"
        );
        let mut scene = parse(&text, "test.toml", std::path::Path::new("")).unwrap();
        scene.model.method = Some(Method::ControlVolume);
        let error = Model::new(scene).err().map(|error| error.to_string()).unwrap();
        assert!(error.contains("in the shell") && error.contains("no chamber"), "{error}");
    }
}
