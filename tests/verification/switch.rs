//! Law: a run that goes on as a control volume keeps what it has. Mass and energy are those that the particles left and that
//! flowed in since, totals of the history go on, rows follow each other without a gap; and what follows is the course of the
//! control volume from there. It switches where it was asked to, and no sooner than pressures are uniform.

use corpuscle::simulation::{Options, Row, reference};

use crate::whole_run::{Run, model, run};

/// A chamber blows down into a larger one around it, with a probe in the first and all walls watched.
fn blow_down(switch: &str) -> String {
    format!(
        "end_time = 4e-3\n[[gas]]\nname = \"nitrogen\"\nmolar_mass = 0.028\ngamma = 1.4\n\
         [[wall]]\nname = \"tank\"\nshape = \"box\"\nmin = [-0.02, -0.08, -0.08]\nmax = [0.36, 0.08, 0.08]\ngas = \"inside\"\n\
         [[wall]]\nname = \"inner\"\nshape = \"box\"\nmin = [0.0, -0.06, -0.06]\nmax = [0.16, 0.06, 0.06]\nthickness = 0.002\n\
         [[wall.hole]]\nname = \"hole\"\nface = \"+x\"\ncenter = [0.0, 0.0]\nsize = [0.04, 0.04]\n\
         [[chamber]]\nname = \"inner\"\npressure = 1e6\ntemperature = 700.0\ngas = \"nitrogen\"\n\
         region = {{ box = {{ min = [0.0, -0.06, -0.06], max = [0.16, 0.06, 0.06] }} }}\n\
         [[chamber]]\nname = \"tank\"\npressure = 2e5\ntemperature = 700.0\ngas = \"nitrogen\"\n\
         [[surface]]\nname = \"walls\"\nwall = \"tank\"\n[[probe]]\nname = \"left\"\n\
         region = {{ box = {{ min = [0.0, -0.06, -0.06], max = [0.08, 0.06, 0.06] }} }}\n\
         [model]\nparticles = 8000\n{switch}\n[output]\nrows = 40\nsnapshots = 0\n"
    )
}

/// Where the one surface is a face of this area across x, its impulse grows by pressure, area and time.
fn follow_each_other(rows: &[Row], end: f64, face: Option<f64>) {
    assert_eq!(rows[0].window[0], 0.0);
    assert!((rows[rows.len() - 1].window[1] / end - 1.0).abs() < 1e-9);
    for pair in rows.windows(2) {
        assert!(
            (pair[1].window[0] - pair[0].window[1]).abs() < 1e-9 * end,
            "{:?} {:?}",
            pair[0].window,
            pair[1].window
        );
        let Some(area) = face else { continue };
        let [before, after] = [0, 1].map(|k| pair[k].surfaces[0]);
        let length = pair[1].window[1] - pair[1].window[0];
        let grown = (after.impulse[0] - before.impulse[0]).abs() / (after.pressure * area * length);
        assert!((grown - 1.0).abs() < 1e-3, "{:?}: {grown}", pair[1].window);
    }
}

/// Mass and energy at the start and at the end of all, and those after the particles.
fn kept(run: &Run) -> &corpuscle::simulation::Continued {
    let (particles, continued) = (&run.outcome.audit, run.outcome.continued.as_ref().expect("it switched"));
    let then = &continued.audit;
    assert!((then.mass_start / particles.mass_end - 1.0).abs() < 1e-12);
    assert!((then.energy_start / particles.energy_end - 1.0).abs() < 1e-9);
    assert!(then.mass_error().abs() < 1e-12 && then.energy_error().abs() < 1e-9, "{then:?}");
    continued
}

#[test]
fn at_a_time_the_control_volume_takes_over_what_is_there() {
    let switched = model(&blow_down("switch = 1e-3"));
    let found = run(&switched, Options::default());
    let continued = kept(&found);
    let time = found.outcome.time;
    assert!((1e-3..1.1e-3).contains(&time) && continued.until == 4e-3 && continued.why == "asked for");
    follow_each_other(&found.rows, 4e-3, None);
    let late: Vec<&Row> = found.rows.iter().filter(|row| row.window[0] >= time * (1.0 - 1e-9)).collect();
    assert!(late.len() >= 29 && late.iter().all(|row| row.particles == 0 && row.surfaces[0].hits == 0));
    // A control volume from the start: it differs by what the hole's Knudsen number and noise had done to the amounts.
    let times: Vec<f64> = late.iter().map(|row| row.time).collect();
    let mut whole = switched.scene.clone();
    (whole.model.method, whole.model.switch) = (Some(corpuscle::scene::Method::ControlVolume), None);
    let whole = reference(&corpuscle::simulation::Model::new(whole).expect("a control volume"), &times);
    for (row, states) in late.iter().zip(&whole) {
        for (chamber, state) in row.chambers.iter().zip(states) {
            let off = chamber.pressure / state.pressure - 1.0;
            assert!(off.abs() < 0.1, "{}: {off}", row.time);
        }
        assert_eq!(row.probes[0], row.chambers[0]);
    }
    // Amounts as the particles had them: less has passed through a hole that is not in the continuum.
    let [first, state] = [late[0].chambers[0].pressure, whole[0][0].pressure];
    assert!(first > 1.002 * state, "{first} {state}");
    let before = found.rows[found.rows.len() - late.len() - 1].chambers[0].pressure;
    assert!((0.9..1.01).contains(&(first / before)), "{before} {first}");
}

/// A fast jet flows in for 2 ms; there must be a millisecond of uniform pressure after it, and not much more.
#[test]
fn it_switches_once_pressures_are_uniform() {
    let text = "end_time = 0.02\n[[gas]]\nname = \"nitrogen\"\nmolar_mass = 0.028\ngamma = 1.4\n\
         [[wall]]\nname = \"box\"\nshape = \"box\"\nmin = [0.0, 0.0, 0.0]\nmax = [0.1, 0.1, 0.1]\ngas = \"inside\"\n\
         [[chamber]]\nname = \"all\"\npressure = 5e4\ntemperature = 300.0\ngas = \"nitrogen\"\n\
         [[orifice]]\nname = \"inlet\"\nposition = [0.0, 0.05, 0.05]\ndirection = [1.0, 0.0, 0.0]\narea = 0.002\n\
         jet = { mach = 5.0, cone_angle = 10.0 }\ngas = \"nitrogen\"\ntemperature = 300.0\nmass_flow = [[0.0, 0.4], [2e-3, 0.4]]\n\
         [[surface]]\nname = \"behind the jet\"\nwall = \"box\"\nface = \"-x\"\n[[probe]]\nname = \"corner\"\n\
         region = { box = { min = [0.0, 0.0, 0.0], max = [0.1, 0.03, 0.03] } }\n\
         [model]\nparticles = 6000\nswitch = \"when-uniform\"\nuniform_for = 1e-3\n[output]\nrows = 80\nsnapshots = 0\n";
    let found = run(&model(text), Options::default());
    let continued = kept(&found);
    println!("{:.4} ms: {}", 1e3 * found.outcome.time, continued.why);
    // A jet takes its momentum from the wall behind it: while it does, and a millisecond longer, nothing is uniform.
    assert!((3e-3..8e-3).contains(&found.outcome.time), "{}", found.outcome.time);
    assert!(continued.why.contains("within their noise"), "{}", continued.why);
    follow_each_other(&found.rows, 0.02, Some(0.01));
    let [particles, then] = [found.rows.iter().rfind(|row| row.particles > 0), found.rows.last()].map(Option::unwrap);
    let off = particles.chambers[0].pressure / then.chambers[0].pressure - 1.0;
    assert!(off.abs() < 0.01, "{off}");
}
