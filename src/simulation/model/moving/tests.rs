use super::*;
use crate::simulation::model::error::ModelError;
use crate::simulation::{Model, run_uniform};

/// A box, 1 x 1 x 1 dm, with a plate at x = 4 cm that parts two chambers, and what is to be different.
fn text(motion: &str, more: &str) -> String {
    format!(
        "end_time = 1e-3\n[[gas]]\nname = \"air\"\nmolar_mass = 0.029\ngamma = 1.4\n\
         [[wall]]\nname = \"box\"\nshape = \"box\"\nmin = [0.0, 0.0, 0.0]\nmax = [0.1, 0.1, 0.1]\ngas = \"inside\"\n\
         [[wall]]\nname = \"plate\"\nshape = \"box\"\nmin = [0.039, -0.01, -0.01]\nmax = [0.041, 0.11, 0.11]\n\
         gas = \"outside\"\n[[motion]]\nwall = \"plate\"\ndirection = [1.0, 0.0, 0.0]\n{motion}\n\
         [[chamber]]\nname = \"left\"\nregion = {{ box = {{ min = [0.0, 0.0, 0.0], max = [0.04, 0.1, 0.1] }} }}\n\
         pressure = 1e5\ntemperature = 300.0\ngas = \"air\"\n\
         [[chamber]]\nname = \"right\"\npressure = 1e5\ntemperature = 300.0\ngas = \"air\"\n{more}\
         [model]\nparticles = 2000\n"
    )
}

fn model(motion: &str, more: &str) -> Result<Model, ModelError> {
    let scene = crate::scene::parse(&text(motion, more), "test.toml", std::path::Path::new("")).unwrap();
    Model::new(scene)
}

const TO_AND_FRO: &str = "displacement = [[0.0, 0.0], [4e-4, 0.02], [1e-3, -0.01]]";

/// The chambers have the room that the plate leaves them; what one loses the other gains.
#[test]
fn volumes_follow_a_plate() {
    let model = model(TO_AND_FRO, "").unwrap();
    let initial = model.vessel.chamber_volumes(&model.scene.chambers);
    for (time, x) in [(0.0, 0.0), (2e-4, 0.01), (4e-4, 0.02), (7e-4, 0.005), (1e-3, -0.01)] {
        let found = model.moving.volumes(&initial, time);
        for (found, expected) in found.iter().zip([0.01 * (0.039 + x), 0.01 * (0.059 - x)]) {
            assert!((found / expected - 1.0).abs() < 1e-3, "{time}: {found} {expected}");
        }
        let vessel = model.vessel_at(time);
        assert!(!vessel.is_gas([0.04 + x, 0.05, 0.05]) && vessel.is_gas([0.042 + x, 0.05, 0.05]));
    }
    // The left chamber's far side goes along, the right one's region is what is left.
    assert_eq!(model.moving.carried, [1 << 12, 0]);
}

/// Steps have the places at their starts, and velocities that lead to the next.
#[test]
fn steps_follow_the_course() {
    let model = model(TO_AND_FRO, "").unwrap();
    let grid = &model.plan.grid;
    let steps = model.moving.steps(grid, 1e-4, 1e-5, 32);
    assert_eq!(steps.len(), 32 * MOST_MOTIONS);
    let (first, late) = (steps[0], steps[31 * MOST_MOTIONS]);
    assert!((f64::from(first.moved[0]) * grid.quantum() - 0.005).abs() < grid.quantum());
    assert!((first.velocity[0] - 50.0).abs() < 1e-3 && (late.velocity[0] + 50.0).abs() < 1e-3);
    assert!((0..3).all(|axis| first.low[axis] <= first.high[axis] && first.high[axis] < grid.cells[axis]));
    let still = model.moving.at(grid, 1e-4);
    assert_eq!((still[0].moved, still[0].velocity), (first.moved, [0.0; 3]));
}

#[test]
fn what_cannot_move_is_refused() {
    let told = |motion: &str, more: &str, what: &str| {
        let Err(error) = model(motion, more) else { panic!("{what} is accepted") };
        assert!(error.to_string().contains(what), "{error}");
    };
    told("velocity = 60.0", "", "chamber \"right\" is squeezed");
    told("velocity = -60.0", "", "chamber \"left\" is squeezed");
    let orifice = |x: f64| {
        format!(
            "[[orifice]]\nname = \"in\"\nposition = [{x}, 0.0, 0.05]\ndirection = [0.0, 1.0, 0.0]\narea = 1e-5\n\
             gas = \"air\"\ntemperature = 300.0\nmass_flow = [[0.0, 1e-3], [1e-3, 1e-3]]\n"
        )
    };
    told("velocity = 20.0", &orifice(0.05), "sweeps over orifice \"in\"");
    assert!(model("velocity = 20.0", &orifice(0.08)).is_ok());
    let vent = "[[vent]]\nname = \"out\"\nwall = \"box\"\nface = \"-y\"\nchamber = \"right\"\ndischarge = 0.1\n";
    told("velocity = 20.0", vent, "sweeps over vent \"out\"");
    // A place is a part of its wall, not the ball around its middle.
    let place = |face: &str, position: [f64; 3]| {
        format!(
            "[[vent]]\nname = \"out\"\nwall = \"box\"\nface = \"{face}\"\nchamber = \"right\"\ndischarge = 0.1\n\
             position = {position:?}\ndiameter = 0.09\n"
        )
    };
    assert!(model("velocity = 20.0", &place("+x", [0.1, 0.05, 0.05])).is_ok());
    told("velocity = 20.0", &place("-y", [0.1, 0.0, 0.05]), "sweeps over vent \"out\"");
}

/// Each wall is measured alone: that two may be where each other goes is told.
#[test]
fn walls_that_may_overlap_on_their_ways_are_told() {
    let told = |plate: f64| {
        let side = "[[wall]]\nname = \"side\"\nshape = \"box\"\nmin = [0.05, 0.02, -0.03]\nmax = [0.08, 0.08, 0.001]\n\
                    gas = \"outside\"\n[[motion]]\nwall = \"side\"\ndirection = [0.0, 0.0, 1.0]\nvelocity = 20.0\n";
        model(&format!("velocity = {plate:?}"), side).unwrap().notes()
    };
    let of_both = |notes: &[String]| notes.iter().any(|note| note.contains("`plate` and `side` sweep may overlap"));
    assert!(of_both(&told(20.0)) && !of_both(&told(-20.0)));
}

/// As a control volume: each chamber keeps p V^gamma, and the work of the plate is the gain of energy.
#[test]
fn uniform_chambers_are_compressed_isentropically() {
    let mut scene = model(TO_AND_FRO, "").unwrap().scene;
    scene.model.method = Some(crate::scene::Method::ControlVolume);
    let model = Model::new(scene).unwrap();
    #[derive(Default)]
    struct Rows(Vec<crate::simulation::Row>);
    impl crate::simulation::RowObserver for Rows {
        fn row(&mut self, row: &crate::simulation::Row) -> Result<(), crate::simulation::SimulationError> {
            self.0.push(row.clone());
            Ok(())
        }
    }
    let mut rows = Rows::default();
    let audit = run_uniform(&model, &mut rows).unwrap();
    assert!(audit.verdict(&crate::output::AuditLimits::default()).is_empty(), "{audit:?}");
    let start = &rows.0[0].chambers;
    for row in &rows.0 {
        for (state, start) in row.chambers.iter().zip(start) {
            let kept = state.pressure * state.volume.powf(1.4) / (start.pressure * start.volume.powf(1.4));
            assert!((kept - 1.0).abs() < 1e-6, "{kept}");
        }
    }
    let gained = audit.energy_end - audit.energy_start;
    assert!((audit.work_by_walls.unwrap() / gained - 1.0).abs() < 1e-3 && gained > 0.0, "{audit:?}");
    // The check can fail: without the work the energy is off.
    let forgotten = crate::output::Audit { work_by_walls: None, ..audit };
    assert!(!forgotten.verdict(&crate::output::AuditLimits::default()).is_empty());
}
