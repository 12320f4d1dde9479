//! What a plan and its control volume say beforehand: small differences of pressure, round walls.

use corpuscle::scene::Scene;
use corpuscle::simulation::{Model, reference};

use crate::{input, outcome};

fn scene(name: &str) -> Scene {
    corpuscle::scene::load(&input(name)).unwrap()
}

/// A chamber that is filled at .3 kg/s, three quarters of which leave through a hole, stands 6.3 kPa above the other: as runs of some
/// 20,000 particles do (7.2 +- .3 kPa from 4 to 13.5 ms, one run). Of more particles, which creep less, the difference is less.
#[test]
fn a_filled_chamber_stands_above_the_one_behind_its_hole() {
    let difference = |particles: u64| {
        let mut scene = scene("held/iso0.3.toml");
        scene.model.particles = Some(particles);
        let times: Vec<f64> = (10..30).map(|k| 5e-4 * f64::from(k)).collect();
        let states = reference(&Model::new(scene).unwrap(), &times);
        states.iter().map(|row| row[0].pressure - row[1].pressure).sum::<f64>() / states.len() as f64
    };
    let found = difference(20_000);
    assert!((found / 6.3e3 - 1.0).abs() < 0.1, "{found} Pa");
    assert!(difference(137_000) < 0.75 * found, "{}", difference(137_000));
}

/// The plan of a wish knows that few particles make such a flow creep.
#[test]
fn a_wish_knows_small_differences() {
    let mut scene = scene("held/iso0.3.toml");
    scene.model.wish.accuracy = Some(0.05);
    let model = Model::new(scene).unwrap();
    // With 6,800, which were enough by a constant coefficient, the true error was 5.6 +- .5 %.
    assert!(model.plan.particles > 3 * 6800, "{}", model.plan.particles);
}

/// A sphere of 80 facets holds the 30 L of the round one, so no forecast has to know of it; how far it is from the surface is told.
#[test]
fn a_coarse_sphere_keeps_its_volume() {
    let name = "users/R7_sphere_facets.toml";
    let model = Model::new(scene(name)).unwrap();
    let round = 4.0 / 3.0 * std::f64::consts::PI * 0.192756f64.powi(3);
    assert!((model.plan.chambers[0].volume / round - 1.0).abs() < 1e-9, "{}", model.plan.chambers[0].volume);
    let (code, out, err) = outcome(&["plan", input(name).to_str().unwrap()]);
    assert_eq!(code, 0, "{err}");
    assert!(out.contains("80 facets") && out.contains("30 L"), "{out}");
    assert!(format!("{out}{err}").contains("wall `ball`: distance of facets"), "{out}{err}");
}

/// What the plan chooses by itself is not beyond the limits that it warns of: the cap of a large diameter, the cells of dense gas, the
/// particles of a probe. Where a budget is too small for that, a reason says so, and the error decides.
#[test]
fn a_wish_keeps_the_limits_that_plans_warn_of() {
    let scenes = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("scenes");
    let folder = tempfile::tempdir().unwrap();
    let told = |name: &str, model: &str, wish: [&str; 2]| {
        let text =
            std::fs::read_to_string(scenes.join(name)).unwrap().replace("method = \"closest-approach\"\n", model);
        let path = folder.path().join(name);
        std::fs::write(&path, text).unwrap();
        let (code, out, err) = outcome(&[&["plan", path.to_str().unwrap()], &wish[..]].concat());
        assert_eq!(code, 0, "{err}");
        let warned: Vec<String> = out.lines().filter(|line| line.starts_with("warning: ")).map(String::from).collect();
        (warned, out)
    };
    for (model, own) in [("", "particles in a collision cell"), ("method = \"cell\"\n", "mean free path")] {
        let (warned, out) = told("corner.toml", model, ["--particle-budget", "20000"]);
        // A thousandth of the pressure is the scene's own.
        let own = format!("chamber `rest` at the start: {own}");
        assert!(warned.len() == 1 && warned[0].contains(&own), "{warned:?}");
        assert!(!out.contains("limits not kept"));
    }
    let (warned, out) = told("tank.toml", "", ["--accuracy", "0.2"]);
    assert!(warned.is_empty() && out.contains("closest-approach"), "{warned:?}");
    let (warned, out) = told("tank.toml", "", ["--particle-budget", "5000"]);
    assert!(warned.iter().any(|text| text.contains("probe `vent jet`")), "{warned:?}");
    let reason = out.lines().find(|line| line.starts_with("limits not kept")).unwrap_or_default();
    assert!(reason.contains("particles in it") && out.contains("closest-approach"), "{out}");
}
