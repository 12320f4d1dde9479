//! Elastic fabric beside what moves whatever the gas does: held nodes that follow a course, fabric of a given motion, and walls that move.

use std::f64::consts::TAU;

use corpuscle::geometry::{MeshShape, Motion as NodeMotion, NodeFrames, TriangleMesh};
use corpuscle::scene::Method;
use corpuscle::simulation::Options;
use tempfile::TempDir;

use crate::scenes::{ALIKE, Scene, inside_and_outside, on_the_wrong_side};
use crate::sheets::sheet;
use crate::whole_run::{Run, device, model_in, run};

const THICKNESS: f64 = 6e-4;
/// By which a frame turns.
const ANGLE: f64 = 0.3;

fn material() -> String {
    format!("[fabric.material]\nthickness = {THICKNESS:e}\ndensity = 800.0\nyoung = 1e7\npoisson = 0.3\n")
}

fn thin() -> String {
    ALIKE.replace("1e5", "1.0")
}

/// From 0 to 1, at rest at both ends.
fn eased(share: f64) -> f64 {
    share - (TAU * share).sin() / TAU
}

/// What is left over of the account of the fabric, over what its supports did.
fn account_is_closed(run: &Run) {
    let account = run.outcome.audit.fabric.expect("elastic fabric");
    let off = account.missing() / account.from_supports;
    eprintln!("supports gave {} J, {off:.1e} of it is missing", account.from_supports);
    assert!(account.from_supports > 0.0 && off.abs() < 0.02, "{account:?}");
}

/// The frame of a sheet goes 5 mm along x by a file, or turns by a law: its nodes are where these say, and the rest of the sheet comes along.
#[test]
fn held_nodes_follow_their_course() {
    let mesh = sheet(0.05, [0.02, 0.08], 8);
    let mut taut = mesh.clone();
    taut.nodes.iter_mut().for_each(|place| *place = place.map(|x| 0.05 + 0.9 * (x - 0.05)));
    let end = 2e-3;
    let way = |time: f64| 5e-3 * eased(time / end);
    let times: Vec<f64> = (0..=200).map(|k| end * f64::from(k) / 200.0).collect();
    let frames = times.iter().map(|&t| mesh.nodes.iter().map(|&[x, y, z]| [x + way(t), y, z]).collect()).collect();
    let frames = NodeFrames::new(times, frames, mesh.triangles.clone()).expect("frames");
    let turn = format!(
        "[fabric.turn]\naxis = [0, 0, 1]\ncenter = [0.05, 0.05, 0.0]\nangle = [[0.0, 0.0], [{:e}, {ANGLE}]]\n",
        0.5 * end
    );
    let by_turn = |[x, y, z]: [f64; 3]| {
        let (sine, cosine) = f64::sin_cos(ANGLE);
        let [x, y] = [x - 0.05, y - 0.05];
        [0.05 + cosine * x - sine * y, 0.05 + sine * x + cosine * y, z]
    };
    let by_file = |[x, y, z]: [f64; 3]| [x + 5e-3, y, z];
    for (frames, turn) in [(Some(frames), String::new()), (None, turn)] {
        let expected: fn([f64; 3]) -> [f64; 3] = if frames.is_some() { by_file } else { by_turn };
        let scene = Scene {
            particles: 200,
            end,
            step: Some(8e-6),
            chambers: thin(),
            elastic: format!("fixed = \"edge\"\n{}{turn}", material()),
            reference: Some(taut.clone()),
            ..Scene::new(Method::None, mesh.clone(), frames)
        };
        let (model, run) = scene.run();
        let is_edge = |node: &[f64; 3]| node[1..].iter().any(|&x| (x - 0.05).abs() > 0.0299);
        let away = |(found, start): (&[f64; 3], &[f64; 3])| {
            let expected = expected(*start);
            (0..3).map(|axis| (found[axis] - expected[axis]).abs()).fold(0.0, f64::max)
        };
        let (mut edge, mut inner) = (0.0_f64, 0.0_f64);
        for (found, start) in run.outcome.fabric.nodes.iter().zip(&mesh.nodes) {
            let off = away((found, start));
            if is_edge(start) { edge = edge.max(off) } else { inner = inner.max(off) }
        }
        eprintln!("edge {edge:e} m off its course, other nodes up to {inner:e} m");
        assert!(edge < 2.0 * model.plan.grid.quantum() + 1e-8, "{edge:e} m");
        assert!((1e-5..4e-3).contains(&inner), "{inner:e} m: elastic, and taken along");
        account_is_closed(&run);
    }
}

/// A ball that a file shrinks, with or without an elastic sheet beside it.
fn shrinking(beside: bool) -> (corpuscle::simulation::Model, Run) {
    let folder = TempDir::new().expect("a folder");
    let mesh = MeshShape::Sphere { radius: 0.03, subdivisions: 2 }.mesh([0.05; 3]).expect("a sphere");
    let end = 1e-3;
    let frames = NodeMotion::Scale { factor: 0.9 }.frames(&mesh, 21, end).expect("frames");
    let mut other = String::new();
    if beside {
        sheet(0.09, [0.03, 0.07], 4).write(&folder.path().join("sheet.obj"), 1.0).expect("a mesh file");
        other = format!("[[fabric]]\nname = \"sheet\"\nfile = \"sheet.obj\"\n{}", material());
    }
    let scene = Scene {
        end,
        step: Some(4e-6),
        particles: 6000,
        chambers: inside_and_outside(3e5, 1e5) + &other,
        ..Scene::new(Method::HalfTurn, mesh, Some(frames))
    };
    let model = model_in(&scene.text(&folder), folder.path());
    let run = run(&model, Options::default());
    (model, run)
}

/// Fabric of a given motion goes the same way and does the same to the gas beside elastic fabric.
#[test]
fn fabric_of_a_given_motion_stands_beside_elastic_fabric() {
    let (_, alone) = shrinking(false);
    let (model, beside) = shrinking(true);
    for (one, other) in alone.rows.iter().zip(&beside.rows) {
        let [one, other] = [one, other].map(|row| row.fabrics[0]);
        // (Means over other moments: in a step of 4 us it shrinks by 1.2e-3.)
        assert!((other.volume / one.volume - 1.0).abs() < 1e-3, "{} and {} m3", one.volume, other.volume);
    }
    let places = [&alone, &beside].map(|run| &run.outcome.fabric.nodes);
    let off =
        places[0].iter().zip(places[1]).flat_map(|(one, other)| (0..3).map(|axis| (one[axis] - other[axis]).abs()));
    let off = off.fold(0.0, f64::max);
    assert!(off < 2.0 * model.plan.grid.quantum() + 1e-8, "{off:e} m");
    let [one, other] = [&alone, &beside].map(|run| run.rows.last().expect("rows"));
    let pressures = [one.chambers[0].pressure, other.chambers[0].pressure];
    eprintln!("{pressures:?} Pa");
    // 3e5 V^-1.4; of 9000 degrees of freedom of 3000 particles the energy is known to 1.5 %.
    assert!((pressures[1] / pressures[0] - 1.0).abs() < 0.03, "{pressures:?}");
    assert!((pressures[1] / (3e5 * (0.9f64).powf(-3.0 * 1.4)) - 1.0).abs() < 0.03, "{pressures:?}");
    let audit = &beside.outcome.audit;
    assert!(audit.energy_error().abs() < 1e-6, "{}", audit.energy_error());
    assert_eq!(audit.passed.map(|passed| passed.particles), Some(0));
    // What the ball did on the gas its course gave, and the sheet's part is small.
    let account = audit.fabric.expect("elastic fabric");
    let missing = account.missing() / account.from_supports;
    eprintln!("{account:?}: {missing:e}");
    assert!(account.from_supports > 0.0 && (account.from_supports / -account.from_gas - 1.0).abs() < 0.1);
    assert!(missing.abs() < 1e-3, "{missing:e}");
    assert!(beside.rows.last().expect("rows").fabrics[0].energies.expect("energies").kinetic == 0.0);
    assert!(!on_the_wrong_side(&model, &beside, 0.0).is_empty(), "it has moved");
}

/// A plate that moves with 20 m/s takes the sheet before it along.
#[test]
fn a_moving_wall_pushes_a_sheet() {
    let start = sheet(0.0415, [0.02, 0.08], 8);
    let pushed = |speed: f64| {
        let plate = format!(
            "[[wall]]\nname = \"plate\"\nshape = \"plane\"\ncenter = [0.0395, 0.05, 0.05]\nnormal = [1, 0, 0]\nu = [0, 1, 0]\n\
             size = [0.03, 0.03]\nthickness = 1e-3\n[[motion]]\nwall = \"plate\"\ndirection = [1, 0, 0]\nvelocity = {speed}\n"
        );
        let scene = Scene {
            particles: 200,
            end: 1e-3,
            step: Some(4e-6),
            chambers: plate + &thin(),
            elastic: material(),
            ..Scene::new(Method::None, start.clone(), None)
        };
        scene.run().1
    };
    let over = |node: &[f64; 3]| (1..3).all(|axis| (node[axis] - 0.05).abs() < 0.015 - 1e-4);
    let run = pushed(20.0);
    let face = 0.06 + 0.5 * THICKNESS;
    let nodes = run.outcome.fabric.nodes.iter().zip(&start.nodes).filter(|(_, start)| over(start));
    let found: Vec<f64> = nodes.map(|(node, _)| node[0] - face).collect();
    eprintln!("{found:?} m before the plate");
    assert!(found.len() == 9 && found.iter().all(|x| (-2e-6..3e-3).contains(x)), "{found:?}");
    account_is_closed(&run);
    let rest = pushed(0.0);
    assert!(rest.outcome.fabric.nodes.iter().all(|node| (node[0] - 0.0415).abs() < 1e-4));
}

/// A body that comes in through a wall compresses the gas around an elastic bag, and with it that inside.
#[test]
fn a_body_takes_room_beside_elastic_fabric() {
    let (end, way) = (4e-3, 0.015);
    let points: Vec<[f64; 2]> =
        (0..=20).map(|k| f64::from(k) / 20.0).map(|share| [end * share, way * eased(share)]).collect();
    let body = format!(
        "[[wall]]\nname = \"body\"\nshape = \"box\"\nmin = [-0.03, 0.02, 0.02]\nmax = [0.001, 0.08, 0.08]\ngas = \"outside\"\n\
         [[motion]]\nwall = \"body\"\ndirection = [1, 0, 0]\ndisplacement = {points:?}\n"
    );
    let mesh = MeshShape::Sphere { radius: 0.03, subdivisions: 2 }.mesh([0.05; 3]).expect("a sphere");
    for elastic in [material(), String::new()] {
        let scene = Scene {
            end,
            particles: 8000,
            rows: 20,
            chambers: body.clone() + &inside_and_outside(1e5, 1e5),
            elastic: elastic.clone(),
            ..Scene::new(Method::HalfTurn, mesh.clone(), None)
        };
        let (model, run) = scene.run();
        let [first, last] = [0, run.rows.len() - 1].map(|row| &run.rows[row]);
        let bag = model.vessel.bags[0].as_ref().expect("a bag").volume;
        let room = 1e-3 - 0.001 * 0.06 * 0.06;
        let taken = way * 0.06 * 0.06;
        let volumes = model.moving.volumes(&[bag, room - bag], end);
        assert!(
            (volumes[0] - bag).abs() < 1e-9 && (volumes[1] / (room - taken - bag) - 1.0).abs() < 1e-3,
            "{volumes:?}"
        );
        // A bag that gives way has the pressure around it; one at rest keeps its own.
        let law = |volume: f64| 1e5 * (volume / (volume - taken)).powf(1.4);
        let expected = if elastic.is_empty() { [1e5, law(room - bag)] } else { [law(room); 2] };
        for (chamber, expected) in last.chambers.iter().zip(expected) {
            eprintln!("{} Pa, by the law {expected}", chamber.pressure);
            assert!((chamber.pressure / expected - 1.0).abs() < 0.025, "{} {expected}", chamber.pressure);
        }
        assert!(first.chambers[1].pressure < 1.02e5, "{}", first.chambers[1].pressure);
        let audit = &run.outcome.audit;
        assert!(audit.energy_error().abs() < 1e-6, "{}", audit.energy_error());
        assert_eq!(audit.passed.map(|passed| passed.particles), Some(0));
        if let Some(account) = audit.fabric {
            let off = account.missing() / audit.energy_start;
            assert!(off.abs() < 1e-3, "{off}: {account:?}");
        }
    }
}

/// A solid in a bag takes room of its gas, wherever it goes in it; one that is on both sides cannot move.
#[test]
fn a_body_in_a_bag_takes_room_of_its_gas() {
    let mesh: TriangleMesh = MeshShape::Sphere { radius: 0.03, subdivisions: 3 }.mesh([0.05; 3]).expect("a sphere");
    let body = |low: f64, motion: &str| {
        format!(
            "[[wall]]\nname = \"body\"\nshape = \"box\"\nmin = [{low}, 0.045, 0.045]\nmax = [0.055, 0.055, 0.055]\ngas = \"outside\"\n{motion}"
        )
    };
    let motion = "[[motion]]\nwall = \"body\"\ndirection = [1, 0, 0]\nvelocity = 10.0\n";
    let scene = |body: String| Scene {
        chambers: body + &inside_and_outside(2e5, 1e5),
        elastic: material(),
        particles: 6000,
        ..Scene::new(Method::HalfTurn, mesh.clone(), None)
    };
    let (model, run) = scene(body(0.045, motion)).run();
    let bag = model.vessel.bags[0].as_ref().expect("a bag").volume;
    let chamber = &model.plan.chambers[0];
    assert!(((bag - chamber.volume) / 1e-6 - 1.0).abs() < 0.02, "{} of {bag} m3", chamber.volume);
    let around = model.plan.chambers[1].volume;
    assert!((around / (1e-3 - bag) - 1.0).abs() < 1e-5, "{around}");
    assert_eq!(run.outcome.audit.passed.map(|passed| passed.particles), Some(0));
    let grown = model.moving.volumes(&[1.0, 1.0], 1e-3);
    assert!(grown.iter().all(|volume| (volume - 1.0).abs() < 1e-8), "{grown:?}");
    assert!(refused(&scene(body(0.01, motion))).contains("wall \"body\" moves and is on both of its sides"));
}

fn refused(scene: &Scene) -> String {
    let folder = TempDir::new().expect("a folder");
    let scene = corpuscle::scene::parse(&scene.text(&folder), "test.toml", folder.path()).expect("a scene");
    corpuscle::simulation::Model::new(scene).err().map(|error| error.to_string()).unwrap_or_default()
}

/// Whatever corners are where: a face through the middle of a bag, a rod through it, and what comes into a bag that does not give way.
#[test]
fn walls_stay_on_their_side_of_closed_fabric() {
    let mesh: TriangleMesh = MeshShape::Sphere { radius: 0.02, subdivisions: 3 }.mesh([0.05; 3]).expect("a sphere");
    let told = |low: [f64; 3], high: [f64; 3], elastic: String| {
        let body = format!(
            "[[wall]]\nname = \"body\"\nshape = \"box\"\nmin = {low:?}\nmax = {high:?}\ngas = \"outside\"\n\
             [[motion]]\nwall = \"body\"\ndirection = [1, 0, 0]\nvelocity = 10.0\n"
        );
        refused(&Scene {
            chambers: body + &inside_and_outside(2e5, 1e5),
            elastic,
            ..Scene::new(Method::HalfTurn, mesh.clone(), None)
        })
    };
    let both = "wall \"body\" moves and is on both of its sides at the start";
    let (piston, rod) = ([-0.02, -0.01, -0.01], [-0.03, 0.045, 0.045]);
    for elastic in [String::new(), material()] {
        let face = told(piston, [0.05, 0.11, 0.11], elastic.clone());
        assert!(face.contains(both), "{face}");
        let rod = told(rod, [0.08, 0.055, 0.055], elastic.clone());
        assert!(rod.contains(both), "{rod}");
        // 25 mm before the bag, 10 on its way.
        assert_eq!(told(piston, [0.005, 0.11, 0.11], elastic.clone()), "");
        // 5 mm before it: elastic fabric gives way.
        let comes = told(piston, [0.025, 0.11, 0.11], elastic.clone());
        assert_eq!(comes.contains("wall \"body\" moves and comes through it by"), elastic.is_empty(), "{comes}");
        assert!(elastic.is_empty() || comes.is_empty(), "{comes}");
    }
    let nowhere = "fixed = [{ sphere = { center = [0.0, 0.0, 0.0], radius = 0.01 } }]\n";
    for fixed in [nowhere, "fixed = \"edge\"\n"] {
        let told = told(piston, [0.005, 0.11, 0.11], format!("{fixed}{}", material()));
        assert!(told.contains("its `fixed` holds none of its nodes"), "{told}");
    }
}

/// A bag that what is around it presses together, until its sheets pass through each other.
#[test]
fn a_bag_without_an_inside_ends_the_run() {
    let mesh = MeshShape::Sphere { radius: 0.03, subdivisions: 2 }.mesh([0.05; 3]).expect("a sphere");
    let scene = Scene {
        particles: 200,
        end: 5e-3,
        step: Some(4e-6),
        chambers: "[[chamber]]\nname = \"in\"\ninside = \"bag\"\npressure = 1e3\ntemperature = 300.0\ngas = \"air\"\n\
                   [[vent]]\nname = \"vent\"\nfabric = \"bag\"\ndischarge = 1.0\n"
            .into(),
        elastic: format!("external_pressure = 1e4\n{}", material()),
        ..Scene::new(Method::None, mesh, None)
    };
    let told = corpuscle::study::verify::run(&device(), &scene.model(), Options::default()).err();
    let told = told.map(|error| error.to_string()).unwrap_or_default();
    assert!(told.contains("fabric \"bag\" has no inside left"), "{told}");
}
