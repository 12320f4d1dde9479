use super::*;
use crate::scene::{Method, parse};
use crate::simulation::accounting::row::Row;
use crate::simulation::error::SimulationError;
use crate::simulation::model::build::Model;
use crate::simulation::model::facing::{PARTS, parts};

#[derive(Default)]
struct Rows(Vec<Row>);

impl RowObserver for Rows {
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
    let (model, rows, audit) = run(include_str!("../../../../scenes/tank.toml"));
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
    assert!((inner / expected - 1.0).abs() < 1e-3 && (tank / expected - 1.0).abs() < 1e-3, "{inner} {tank} {expected}");
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
        assert!((inner.pressure / pressure(row.time) - 1.0).abs() < 2e-3, "{} {}", inner.pressure, pressure(row.time));
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
    assert!(cube("", "", 600.0).2.heat_to_walls.is_none() && model.scene.has_heat());
    // One face by a part takes its share by a rate of its own, the other faces nothing.
    let face = format!("[[wall.part]]\nface = \"+y\"\ntemperature = 300.0\nheat_transfer = {:e}", 6.0 * coefficient);
    let (_, by_part, audit) = cube(&face, "", 600.0);
    assert!(audit.verdict(&crate::output::AuditLimits::default()).is_empty());
    let [part, whole] = [&by_part, &rows].map(|rows| rows[19].walls[0]);
    assert!((part.heat / whole.heat - 1.0).abs() < 1e-9 && by_part[19].walls.len() == 1, "{part:?} {whole:?}");
    assert!((part.heat_flux / (6.0 * whole.heat_flux) - 1.0).abs() < 1e-9, "{part:?} {whole:?}");

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
