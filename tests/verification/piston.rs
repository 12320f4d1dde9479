//! Laws of moving walls (docs/reference/accuracy.md): slow compression to half the volume leaves T V^(gamma-1)
//! alone within half a percent; a fast piston feels the pressure behind the shock that it drives (Rankine and Hugoniot);
//! nothing is lost, whatever meets a piston: particles in its corners, newborns, gas on both of its sides.

use corpuscle::output::AuditLimits;
use corpuscle::scene::Method;
use corpuscle::simulation::Options;
use corpuscle::study::verify::piston::{Piston, compressions, on_piston, shock_pressure, warming};

use crate::whole_run::{device, model, run};

#[test]
#[ignore = "a minute or two: scripts/test.sh --long; `corpuscle verify piston` runs the case too"]
fn slow_compression_is_adiabatic() {
    for method in [Method::ClosestApproach, Method::Cell, Method::HalfTurn] {
        let (ratio, error) = compressions(&device(), method, 800, 3).expect("runs");
        println!("{}: T V^(gamma-1): {ratio:.5} +- {error:.5}", method.name());
        assert!(error < 0.005 / 3.0, "{error}");
        assert!((ratio - 1.0).abs() < 0.005, "{ratio}");
        // The check can fail: gas that keeps its temperature is 24 % off.
        assert!((2f64.powf(-0.4) * ratio - 1.0).abs() > 0.2);
    }
}

#[test]
fn a_fast_piston_drives_a_shock() {
    for method in [Method::ClosestApproach, Method::Cell, Method::HalfTurn] {
        let piston = Piston::shock(16_000, 0.5).by(method);
        let run = piston.run(&device()).expect("a run");
        assert_eq!(run.outcome.audit.verdict(&AuditLimits::default()), Vec::<String>::new());
        let (pressure, error) = on_piston(&piston, &run);
        let expected = shock_pressure(0.5);
        println!("{}: p/p1 {pressure:.4} +- {error:.4} of {expected:.4}", method.name());
        assert!((pressure - expected).abs() < 4.0 * error && error < 0.04, "{pressure} of {expected}");
        // The check can fail: the pressure at rest, and that of sound waves alone, 1 + gamma u/a, are far off.
        assert!((expected - 1.0).abs() > 10.0 * error);
        assert!(warming(&run) > 1.05);
    }
}

/// Pulled out as far as it was pushed in the gas is as it was, but for what the speed costs; the account of energy,
/// momentum and particles closes though the work changes its sign on the way.
#[test]
fn what_is_pushed_in_comes_out_again() {
    let mut scene = Piston::slow(1000, 1).model().expect("a model").scene;
    let half = scene.end_time;
    scene.end_time = 0.4 * half;
    scene.motions[0].course = corpuscle::scene::Course::Displacement(corpuscle::scene::Curve {
        points: vec![[0.0, 0.0], [0.2 * half, 0.02], [0.4 * half, 0.0]],
    });
    let run = run(&corpuscle::simulation::Model::new(scene).expect("a model"), Options::default());
    let audit = &run.outcome.audit;
    assert_eq!(audit.verdict(&AuditLimits::default()), Vec::<String>::new());
    let most = run.rows.iter().map(|row| row.motions[0].work).fold(0.0, f64::max) / audit.energy_start;
    let back = audit.work_by_walls.expect("a moving wall") / audit.energy_start;
    println!("work {most:.4} of the energy, {back:.5} at the end");
    // 1.25^.4 - 1 = 9.3 %.
    assert!((most - 0.093).abs() < 0.01 && back.abs() < 0.015, "{most} {back}");
}

/// A plate that is no mirror runs through gas that flows in: two chambers, two gases, corners, newborns.
fn crowded(method: &str) -> String {
    format!(
        "end_time = 6e-4\n[[gas]]\nname = \"air\"\nmolar_mass = 0.029\ngamma = 1.4\n\
         [[gas]]\nname = \"helium\"\nmolar_mass = 0.004\ngamma = 1.6667\n\
         [[wall]]\nname = \"box\"\nshape = \"box\"\nmin = [0.0, 0.0, 0.0]\nmax = [0.1, 0.06, 0.06]\ngas = \"inside\"\n\
         [[wall]]\nname = \"plate\"\nshape = \"plane\"\ncenter = [0.03, 0.03, 0.03]\nnormal = [1.0, 0.0, 0.0]\n\
         u = [0.0, 1.0, 0.0]\nsize = [0.064, 0.06]\nthickness = 0.002\ntemperature = 400.0\naccommodation = 0.5\n\
         [[motion]]\nwall = \"plate\"\ndirection = [1.0, 0.0, 0.0]\nvelocity = [[0.0, 0.0], [2e-4, 100.0]]\n\
         [[chamber]]\nname = \"behind\"\nregion = {{ box = {{ min = [0.0, 0.0, 0.0], max = [0.03, 0.06, 0.06] }} }}\n\
         pressure = 2e5\ntemperature = 300.0\ngas = {{ air = 0.5, helium = 0.5 }}\n\
         [[chamber]]\nname = \"before\"\npressure = 1e5\ntemperature = 300.0\ngas = \"air\"\n\
         [[orifice]]\nname = \"inlet\"\nposition = [0.0, 0.03, 0.03]\ndirection = [1.0, 0.0, 0.0]\narea = 0.001\n\
         gas = \"air\"\ntemperature = 300.0\nmass_flow = [[0.0, 0.3], [2e-3, 0.3]]\n\
         [[surface]]\nname = \"walls\"\nwall = \"box\"\n[[surface]]\nname = \"plate\"\nwall = \"plate\"\n\
         [model]\nmethod = \"{method}\"\nparticles = 2000\n[output]\nrows = 10\nsnapshots = 0\n"
    )
}

#[test]
fn nothing_passes_a_plate_that_moves() {
    for method in ["closest-approach", "hard-sphere", "cell", "none"] {
        let model = model(&crowded(method));
        let run = run(&model, Options::default());
        let audit = &run.outcome.audit;
        assert_eq!(audit.verdict(&AuditLimits::default()), Vec::<String>::new(), "{method}");
        let (first, last) = (&run.rows[0], &run.rows[9]);
        // Nobody changes sides: helium stays behind the plate, and air before it, in chambers that go along.
        assert_eq!(last.chambers[1].particles[1], 0.0, "{method}");
        let before: u64 = model.plan.chambers[1].particles.iter().sum();
        let counted: f64 = last.chambers[1].particles.iter().sum();
        assert!((counted - before as f64).abs() < 1e-9 * counted, "{method}: {counted} of {before}");
        assert!(last.chambers[1].volume < 0.5 * first.chambers[1].volume, "{method}");
        assert!(last.chambers[1].pressure > 2.0 * first.chambers[1].pressure, "{method}");
        println!("{method}: {} bounces, {:?} J", run.outcome.bounces, audit.work_by_walls);
    }
}

/// Hot and cold gas on the two sides of a plate that goes to and fro: what each has in the end is what it had but for the
/// little that the speed costs, so no pair has met through the plate. The gas has no spin: its energy is its temperature's.
#[test]
fn no_heat_crosses_a_plate_that_moves() {
    let temperatures = |plate: &str, method: &str| {
        let text = format!(
            "end_time = 4e-4\n[[gas]]\nname = \"argon\"\nmolar_mass = 0.04\ngamma = 1.6667\n\
             [[wall]]\nname = \"box\"\nshape = \"box\"\nmin = [0.0, 0.0, 0.0]\nmax = [0.08, 0.04, 0.04]\n\
             gas = \"inside\"\n{plate}\
             [[chamber]]\nname = \"cold\"\nregion = {{ box = {{ min = [0.0, 0.0, 0.0], max = [0.04, 0.04, 0.04] }} }}\n\
             pressure = 1e5\ntemperature = 300.0\ngas = \"argon\"\n\
             [[chamber]]\nname = \"hot\"\npressure = 1e5\ntemperature = 900.0\ngas = \"argon\"\n\
             [model]\nmethod = \"{method}\"\nparticles = 3000\ntime_step = 1.25e-6\n[output]\nrows = 10\nsnapshots = 0\n"
        );
        let run = run(&model(&text), Options::default());
        assert_eq!(run.outcome.audit.verdict(&AuditLimits::default()), Vec::<String>::new(), "{method}");
        let last = run.rows.last().expect("a row");
        [0, 1].map(|chamber: usize| last.chambers[chamber].temperature)
    };
    let plate = "[[wall]]\nname = \"plate\"\nshape = \"plane\"\ncenter = [0.04, 0.02, 0.02]\nnormal = [1.0, 0.0, 0.0]\n\
                 u = [0.0, 1.0, 0.0]\nsize = [0.044, 0.044]\nthickness = 0.001\n\
                 [[motion]]\nwall = \"plate\"\ndirection = [1.0, 0.0, 0.0]\n\
                 displacement = [[0.0, 0.0], [1e-4, 0.003], [3e-4, -0.003], [4e-4, 0.0]]\n";
    for method in ["cell", "closest-approach"] {
        let [cold, hot] = temperatures(plate, method);
        println!("{method}: {cold:.1} K and {hot:.1} K");
        // Shocks of .1 of the speed of sound, to and fro, and the noise of the work, some 1/sqrt N of the .1 that is done.
        assert!((cold / 300.0 - 1.0).abs() < 0.05 && (hot / 900.0 - 1.0).abs() < 0.05, "{method}: {cold} {hot}");
    }
    // The check can fail: without the plate they mix.
    let [cold, hot] = temperatures("", "cell");
    println!("without it {cold:.1} K and {hot:.1} K");
    assert!(cold > 330.0 && hot < 810.0, "{cold} {hot}");
}

/// A round piston in a tilted cylinder, to a fifth of its length: corners everywhere on the grid, and volumes that no axis
/// follows.
#[test]
fn a_tilted_piston_is_tight() {
    for method in ["closest-approach", "cell"] {
        tilted(method);
    }
}

fn tilted(method: &str) {
    let model = model(&format!(
        "end_time = 8e-4\n[[gas]]\nname = \"air\"\nmolar_mass = 0.029\ngamma = 1.4\n\
         [[wall]]\nname = \"cylinder\"\nshape = \"cylinder\"\nbase = [0.0, 0.0, 0.0]\naxis = [2.0, 1.0, 2.0]\n\
         radius = 0.03\nheight = 0.1\nsegments = 24\ngas = \"inside\"\n\
         [[wall]]\nname = \"piston\"\nshape = \"cylinder\"\nbase = [-0.06, -0.03, -0.06]\naxis = [2.0, 1.0, 2.0]\n\
         radius = 0.034\nheight = 0.09\nsegments = 24\ngas = \"outside\"\n\
         [[motion]]\nwall = \"piston\"\ndirection = [2.0, 1.0, 2.0]\nvelocity = 100.0\n\
         [[chamber]]\nname = \"all\"\npressure = 1e5\ntemperature = 300.0\ngas = \"air\"\n\
         [[surface]]\nname = \"walls\"\nwall = \"cylinder\"\n\
         [model]\nmethod = \"{method}\"\nparticles = 1500\ntime_step = 1.25e-6\n[output]\nrows = 8\nsnapshots = 0\n",
    ));
    let run = run(&model, Options::default());
    assert_eq!(run.outcome.audit.verdict(&AuditLimits::default()), Vec::<String>::new());
    let [first, .., last] = &run.rows[..] else { panic!("no rows") };
    let ratio = first.chambers[0].volume / last.chambers[0].volume;
    // At 100 m/s; the tallies of a row lie up to half a dozen steps behind its middle.
    let left = |time: f64| 0.1 - 100.0 * time;
    assert!((ratio * left(last.time) / left(first.time) - 1.0).abs() < 0.04, "{ratio}");
    // Somewhat more than isentropic, for its shock.
    let pressure = last.chambers[0].pressure / first.chambers[0].pressure;
    println!("{ratio:.3} times as dense, p {pressure:.3} times as high");
    assert!(pressure > 0.93 * ratio.powf(1.4) && pressure < 1.4 * ratio.powf(1.4), "{pressure}");
}
