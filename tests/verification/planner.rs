//! Law: a plan that was asked for an accuracy keeps it. Of each scene the true error (the root mean square over the rows and
//! over several seeds of a pressure less its limit of infinitely many particles, over the mean of the limit, of the worst
//! column) is at most what was asked, and the predicted one within a factor of two of it. So are the predicted particle-steps
//! (what of the cost is no matter of the machine).
//!
//! Of the first scenes two wishes and two formulas were changed after first results, so they are no blind test; those called
//! blind and the vessel in a room are.
//!
//! The limits are known without particles: gas at rest; a vessel in a room, whose hole is modelled, by the control volume of both; two chambers and a hole, a closed vessel that is filled and a tank
//! with an inflator by the control volume in the continuum; effusion by that of free flight; a vessel that vents by
//! isentropic flow; a shock tube by the exact Riemann solution, whose measure is that of the profile.
//!
//! Statistics: seeds are independent, so their scatter tells how well the true error itself is known; it must be known
//! to a fifth, and counts as kept or met within three of its standard errors, since each adapter draws another sample. The
//! forecast has no constant that was fitted to these scenes; the share of the accuracy that plans aim at was chosen by the smallest of its first
//! results.

use corpuscle::plan::{Forecast, worst};
use corpuscle::scene::{Method, ModelRequest};
use corpuscle::simulation::{Model, Options, Outcome, Row, reference};
use corpuscle::study::verify::tube::SOD;

use crate::whole_run::{model, run};

mod half_turn;

const REST: &str = "end_time = 2e-3\n[[wall]]\nname = \"box\"\nshape = \"box\"\nmin = [0.0, 0.0, 0.0]\n\
     max = [0.1, 0.1, 0.1]\ngas = \"inside\"\n[[chamber]]\nname = \"all\"\npressure = 1e5\ntemperature = 300.0\n\
     gas = \"nitrogen\"\n[[surface]]\nname = \"left\"\nwall = \"box\"\nface = \"-x\"\n[[surface]]\nname = \"right\"\n\
     wall = \"box\"\nface = \"+x\"\n";

// What is asked for is the gas that is left: a jet into near vacuum is not at rest, as the control volume takes it to be.
const TWO: &str = "end_time = 1.2e-3\n[[wall]]\nname = \"tank\"\nshape = \"box\"\nmin = [-0.02, -0.08, -0.08]\n\
     max = [0.36, 0.08, 0.08]\ngas = \"inside\"\n[[wall]]\nname = \"inner\"\nshape = \"box\"\nmin = [0.0, -0.06, -0.06]\n\
     max = [0.16, 0.06, 0.06]\nthickness = 0.002\n[[wall.hole]]\nname = \"hole\"\nface = \"+x\"\ncenter = [0.0, 0.0]\n\
     size = [0.04, 0.04]\n[[chamber]]\nname = \"inner\"\npressure = 1e6\ntemperature = 700.0\ngas = \"nitrogen\"\n\
     region = { box = { min = [0.0, -0.06, -0.06], max = [0.16, 0.06, 0.06] } }\n[[chamber]]\nname = \"tank\"\n\
     pressure = 2e3\ntemperature = 700.0\ngas = \"nitrogen\"\n[[probe]]\nname = \"left\"\n\
     region = { box = { min = [0.0, -0.06, -0.06], max = [0.16, 0.06, 0.06] } }\n";

// Without a surface: a face beside a jet has waves that no control volume knows.
const FILLED: &str = "end_time = 0.01\n[[wall]]\nname = \"box\"\nshape = \"box\"\nmin = [0.0, 0.0, 0.0]\n\
     max = [0.2, 0.2, 0.2]\ngas = \"inside\"\n[[chamber]]\nname = \"all\"\npressure = 1e5\ntemperature = 300.0\n\
     gas = \"nitrogen\"\n[[orifice]]\nname = \"inflator\"\nposition = [0.0, 0.1, 0.1]\ndirection = [1.0, 0.0, 0.0]\n\
     area = 0.005\ngas = \"nitrogen\"\ntemperature = 600.0\nmass_flow = [[0.0, 0.0], [0.004, 1.0], [0.01, 0.0]]\n";

const VENTED: &str = "end_time = 0.006\n[[wall]]\nname = \"box\"\nshape = \"box\"\nmin = [0.0, 0.0, 0.0]\n\
     max = [0.1, 0.1, 0.1]\ngas = \"inside\"\n[[chamber]]\nname = \"all\"\npressure = 2e5\ntemperature = 400.0\n\
     gas = \"nitrogen\"\n[[vent]]\nname = \"pores\"\nwall = \"box\"\ndischarge = 0.015\nexternal_pressure = 0.0\n\
     [[surface]]\nname = \"side\"\nwall = \"box\"\nface = \"+x\"\n";

const TANK: &str = "end_time = 0.004\n[[wall]]\nname = \"tank\"\nshape = \"box\"\nmin = [-0.05, -0.1, -0.1]\n\
     max = [0.25, 0.1, 0.1]\ngas = \"inside\"\n[[wall]]\nname = \"inner\"\nshape = \"box\"\nmin = [0.0, -0.05, -0.05]\n\
     max = [0.1, 0.05, 0.05]\nthickness = 0.004\n[[wall.hole]]\nname = \"hole\"\nface = \"+x\"\ncenter = [0.0, 0.0]\n\
     size = [0.03, 0.03]\n[[chamber]]\nname = \"inner\"\npressure = 1e5\ntemperature = 300.0\ngas = \"nitrogen\"\n\
     region = { box = { min = [0.0, -0.05, -0.05], max = [0.1, 0.05, 0.05] } }\n[[chamber]]\nname = \"tank\"\n\
     pressure = 1e5\ntemperature = 300.0\ngas = \"nitrogen\"\n[[orifice]]\nname = \"inflator\"\nposition = [0.0, 0.0, 0.0]\n\
     direction = [1.0, 0.0, 0.0]\narea = 0.004\ngas = \"nitrogen\"\ntemperature = 600.0\n\
     mass_flow = [[0.0, 0.0], [0.003, 1.0], [0.01, 0.8]]\n";

// The next three were fixed before the first of their runs, when forecast and aim were final. So was what is asked of them,
// but for the two holes: of .05 the plan was 80 million particles.
const SLAB: &str = "end_time = 1.5e-3\n[[wall]]\nname = \"box\"\nshape = \"box\"\nmin = [0.0, 0.0, 0.0]\n\
     max = [0.3, 0.1, 0.05]\ngas = \"inside\"\n[[chamber]]\nname = \"all\"\npressure = 3e5\ntemperature = 600.0\n\
     gas = \"nitrogen\"\n[[probe]]\nname = \"end\"\nregion = { box = { min = [0.0, 0.0, 0.0], max = [0.05, 0.1, 0.05] } }\n\
     [[probe]]\nname = \"middle\"\nregion = { box = { min = [0.12, 0.02, 0.0], max = [0.18, 0.08, 0.05] } }\n";

const TWO_HOLES: &str = "end_time = 2e-3\n[[wall]]\nname = \"tank\"\nshape = \"box\"\nmin = [0.0, -0.08, -0.08]\n\
     max = [0.3, 0.08, 0.08]\ngas = \"inside\"\n[[wall]]\nname = \"inner\"\nshape = \"box\"\nmin = [0.06, -0.06, -0.06]\n\
     max = [0.2, 0.06, 0.06]\nthickness = 0.002\n[[wall.hole]]\nname = \"right\"\nface = \"+x\"\ncenter = [0.0, 0.0]\n\
     size = [0.03, 0.03]\n[[wall.hole]]\nname = \"left\"\nface = \"-x\"\ncenter = [0.0, 0.0]\nsize = [0.03, 0.03]\n\
     [[chamber]]\nname = \"inner\"\npressure = 3e5\ntemperature = 400.0\ngas = \"nitrogen\"\n\
     region = { box = { min = [0.06, -0.06, -0.06], max = [0.2, 0.06, 0.06] } }\n[[chamber]]\nname = \"tank\"\n\
     pressure = 1e5\ntemperature = 400.0\ngas = \"nitrogen\"\n";

// A small chamber that is filled, in a larger one, by little flow: what differs are the small differences of pressure through its hole.
const LOW: &str = "end_time = 0.02\n[[wall]]\nname = \"tank\"\nshape = \"box\"\nmin = [-0.15, -0.15, -0.15]\n\
     max = [0.25, 0.15, 0.15]\ngas = \"inside\"\n[[wall]]\nname = \"inner\"\nshape = \"box\"\nmin = [-0.1, -0.1, -0.1]\n\
     max = [0.1, 0.1, 0.1]\nthickness = 0.005\n[[wall.hole]]\nname = \"hole\"\nface = \"+x\"\ncenter = [0.0, 0.0]\n\
     size = [0.1, 0.1]\n[[chamber]]\nname = \"inner\"\npressure = 1e5\ntemperature = 300.0\ngas = \"nitrogen\"\n\
     region = { box = { min = [-0.1, -0.1, -0.1], max = [0.1, 0.1, 0.1] } }\n[[chamber]]\nname = \"outer\"\n\
     pressure = 1e5\ntemperature = 300.0\ngas = \"nitrogen\"\n[[orifice]]\nname = \"inflator\"\n\
     position = [-0.1, 0.0, 0.0]\ndirection = [1.0, 0.0, 0.0]\narea = 0.01\ngas = \"nitrogen\"\ntemperature = 300.0\n\
     mass_flow = [[0.0, 0.0], [0.0025, 0.1], [0.015, 0.1], [0.0175, 0.0]]\n";

const HOT: &str = "end_time = 0.02\n[[wall]]\nname = \"box\"\nshape = \"box\"\nmin = [0.0, 0.0, 0.0]\n\
     max = [0.4, 0.15, 0.15]\ngas = \"inside\"\n[[chamber]]\nname = \"all\"\npressure = 5e4\ntemperature = 300.0\n\
     gas = \"nitrogen\"\n[[orifice]]\nname = \"inflator\"\nposition = [0.2, 0.075, 0.0]\ndirection = [0.0, 0.0, 1.0]\n\
     area = 0.004\ngas = \"nitrogen\"\ntemperature = 900.0\nmass_flow = [[0.0, 0.8], [0.02, 0.2]]\n";

// A vessel that empties into the air of a room, of which no more than that is asked.
const ROOM: &str = "end_time = 0.004\n[[wall]]\nname = \"room\"\nshape = \"box\"\nmin = [-0.3, -0.3, -0.3]\n\
     max = [0.5, 0.3, 0.3]\ngas = \"inside\"\n[[wall]]\nname = \"vessel\"\nshape = \"box\"\nmin = [0.0, -0.06, -0.06]\n\
     max = [0.16, 0.06, 0.06]\nthickness = 0.002\n[[wall.hole]]\nname = \"hole\"\nface = \"+x\"\ncenter = [0.0, 0.0]\n\
     size = [0.03, 0.03]\nflow_only = true\n[[chamber]]\nname = \"vessel\"\npressure = 4e5\ntemperature = 400.0\n\
     gas = \"nitrogen\"\nregion = { box = { min = [0.0, -0.06, -0.06], max = [0.16, 0.06, 0.06] } }\n[[chamber]]\n\
     name = \"room\"\npressure = 1e5\ntemperature = 300.0\ngas = \"nitrogen\"\n[[probe]]\nname = \"all\"\n\
     region = { box = { min = [0.0, -0.06, -0.06], max = [0.16, 0.06, 0.06] } }\n";

/// A scene of nitrogen with a wish; particles, since a control volume would do for most of these.
fn scene(text: &str, request: &str, rows: u32, seed: u64) -> String {
    // Keys of the top level come before the first table.
    format!(
        "seed = {seed}\n{text}[[gas]]\nname = \"nitrogen\"\nmolar_mass = 0.028\ngamma = 1.4\n\
         [model]\n{request}\n[output]\nrows = {rows}\nsnapshots = 0\n"
    )
}

/// Pressures of a row in the order of the forecast's columns.
fn pressures(row: &Row) -> Vec<f64> {
    let zones = |zones: &[corpuscle::simulation::ZoneState]| zones.iter().map(|z| z.pressure).collect::<Vec<_>>();
    let surfaces = row.surfaces.iter().map(|surface| surface.pressure).collect();
    [zones(&row.chambers), surfaces, zones(&row.probes)].concat()
}

/// Effusion of gas that does not collide from a chamber into the larger one around it, both mixed: of speed v a share
/// pi + (1 - pi) exp(-(1/V + 1/V') v A t / 4) is still there, pi = V/(V + V'). Fast particles leave first, so the gas is not
/// Maxwell's any more, as the control volume takes it to be. By the trapezoidal rule in units of sqrt(kT/m).
fn effusion_limit(model: &Model, times: &[f64]) -> Vec<Vec<f64>> {
    let [inner, outer] = [0, 1].map(|k| model.plan.chambers[k].volume);
    let [first, second] = [0, 1].map(|k| model.scene.chambers[k].pressure);
    let rate = 0.25 * model.plan.openings[0].area * (1.0 / inner + 1.0 / outer);
    let speed = (8.314462618 * model.scene.chambers[0].temperature / model.scene.gases[0].molar_mass).sqrt();
    let share = inner / (inner + outer);
    let at = |time: &f64| {
        let (mut stayed, mut all) = (0.0, 0.0);
        for k in 1..1200 {
            let u = 0.01 * f64::from(k);
            let weight = u.powi(4) * (-0.5 * u * u).exp();
            stayed += weight * (share + (1.0 - share) * (-rate * u * speed * time).exp());
            all += weight;
        }
        let stayed = stayed / all;
        // What the outer gas sends back of its own is as little as it is.
        vec![first * stayed, second + first * (1.0 - stayed) * inner / outer]
    };
    times.iter().map(at).collect()
}

/// The limit of every column at the times of the rows: chambers, then surfaces and probes of the first chamber.
fn limit(model: &Model, rows: &[Row]) -> Vec<Vec<f64>> {
    let times: Vec<f64> = rows.iter().map(|row| row.time).collect();
    if model.plan.method == Method::None {
        return effusion_limit(model, &times);
    }
    let states = if !model.scene.vents.is_empty() {
        reference(model, &times)
    } else {
        let mut scene = model.scene.clone();
        scene.model = ModelRequest { method: Some(Method::ControlVolume), ..ModelRequest::default() };
        reference(&Model::new(scene).expect("a control volume"), &times)
    };
    let of_row = |states: &Vec<corpuscle::gas::State>| {
        let others = model.scene.surfaces.len() + model.scene.probes.len();
        let others = std::iter::repeat_n(states[0].pressure, others);
        states.iter().map(|state| state.pressure).chain(others).collect()
    };
    states.iter().map(of_row).collect()
}

/// The particle-steps of a run are within a factor of two of the predicted ones.
fn pays(name: &str, predicted: f64, outcome: &Outcome) {
    let ratio = outcome.particle_steps as f64 / predicted;
    println!(
        "{name}: predicted {predicted:.3e} particle-steps, {:.3e} done, {ratio:.2} times as many",
        outcome.particle_steps
    );
    assert!(
        ratio > 0.5 && ratio < 2.0,
        "{name}: {predicted} particle-steps predicted, {} done",
        outcome.particle_steps
    );
}

/// Mean squares of the error of each column in one run.
fn squares(model: &Model) -> Vec<f64> {
    squares_of(model, &run(model, Options::default()).rows)
}

/// The same of a run that is to cost what was predicted.
fn squares_at_cost(name: &str, predicted: &Forecast, model: &Model) -> Vec<f64> {
    let run = run(model, Options::default());
    pays(name, predicted.particle_steps, &run.outcome);
    squares_of(model, &run.rows)
}

/// The same of rows that are there.
fn squares_of(model: &Model, rows: &[Row]) -> Vec<f64> {
    squares_against(rows, &limit(model, rows))
}

fn squares_against(rows: &[Row], limit: &[Vec<f64>]) -> Vec<f64> {
    let count = rows.len() as f64;
    let of_column = |column: usize| {
        let mean = limit.iter().map(|row| row[column]).sum::<f64>() / count;
        let off = rows.iter().zip(limit).map(|(row, limit)| (pressures(row)[column] - limit[column]).powi(2));
        off.sum::<f64>() / count / (mean * mean)
    };
    (0..limit[0].len()).map(of_column).collect()
}

/// Root of the mean of squares, and its standard error from their scatter.
fn root(squares: &[f64]) -> (f64, f64) {
    let count = squares.len() as f64;
    let mean = squares.iter().sum::<f64>() / count;
    let scatter = squares.iter().map(|square| (square - mean).powi(2)).sum::<f64>() / (count - 1.0);
    (mean.sqrt(), 0.5 * (scatter / count / mean).sqrt())
}

/// The error of the worst column of those asked for, and its standard error.
fn true_error(runs: &[Vec<f64>], forecast: &Forecast) -> (f64, f64) {
    let of_column = |column: usize| root(&runs.iter().map(|run| run[column]).collect::<Vec<_>>());
    (0..runs[0].len())
        .filter(|column| forecast.columns[*column].asked)
        .map(of_column)
        .fold((0.0, 0.0), |worst, own| if own.0 > worst.0 { own } else { worst })
}

fn forecast(model: &Model) -> Forecast {
    model.explained().forecast.expect("a scene with a wish has a forecast")
}

fn holds(name: &str, asked: f64, predicted: f64, (found, error): (f64, f64)) {
    println!("{name}: asked {asked}, predicted {predicted:.4}, true {found:.4} +- {error:.4}");
    assert!(error < 0.2 * found, "{name}: the true error is not known: {found} +- {error}");
    let [least, most] = [found - 3.0 * error, found + 3.0 * error];
    assert!(least <= asked, "{name}: {found} +- {error}, asked {asked}");
    assert!(
        2.0 * predicted >= least && 0.5 * predicted <= most,
        "{name}: predicted {predicted}, true {found} +- {error}"
    );
}

/// A scene, what its plan is asked for, and how it is run.
struct Case<'a> {
    name: &'a str,
    text: &'a str,
    method: &'a str,
    asked: f64,
    rows: u32,
    seeds: u64,
}

/// Runs of several seeds of a scene, and whether the law holds.
fn check(case: &Case<'_>) -> Model {
    let &Case { name, text, method, asked, rows, seeds } = case;
    let request = format!("method = \"{method}\"\naccuracy = {asked}");
    let models: Vec<Model> = (1..=seeds).map(|seed| model(&scene(text, &request, rows, seed))).collect();
    let predicted = forecast(&models[0]);
    assert!(predicted.error <= asked);
    assert_eq!(predicted.error, worst(&predicted.columns).unwrap().error);
    let runs: Vec<Vec<f64>> = models.iter().map(|model| squares_at_cost(name, &predicted, model)).collect();
    holds(name, asked, predicted.error, true_error(&runs, &predicted));
    models.into_iter().next().unwrap()
}

#[test]
fn gas_at_rest() {
    let planned =
        check(&Case { name: "rest", text: REST, method: "closest-approach", asked: 0.05, rows: 20, seeds: 2 });
    // The check can fail: a sixteenth of the particles is four times as noisy, and the forecast knows that too. (In the
    // same steps: longer ones would have longer rows.)
    let few = format!(
        "method = \"closest-approach\"\nparticles = {}\ntime_step = {:e}\naccuracy = 0.5",
        planned.plan.particles / 16,
        planned.plan.time_step
    );
    let few = model(&scene(REST, &few, 20, 1));
    let predicted = forecast(&few);
    assert!(true_error(&[squares(&few), squares(&few)], &predicted).0 > 0.05);
    assert!(predicted.error > 3.0 * forecast(&planned).error);
}

/// Where the collision rate limits the step, the plan leaves room for blocks of the gas that are denser by chance: a run of uniform
/// gas takes the steps of its plan, not twice as many.
#[test]
fn uniform_gas_takes_the_steps_of_its_plan() {
    for rounds in [2, 4] {
        let request = format!("particles = 20000\nrounds = {rounds}");
        let model = model(&scene(REST, &request, 1, 1).replace("end_time = 2e-3", "end_time = 2e-4"));
        assert!(model.plan.reasons.iter().any(|reason| reason.why.contains("in the densest blocks")));
        let steps = (model.plan.end_time / model.plan.time_step).round() as u64;
        assert!(steps > 100, "{steps}");
        assert_eq!(run(&model, Options::default()).outcome.steps, steps, "{rounds} rounds");
        // The check can fail: without the room (three quarters of the limit leave none) the steps are halved.
        let mut limit = model;
        limit.plan.collision_limit *= 0.75;
        assert!(run(&limit, Options::default()).outcome.steps > steps + steps / 2);
    }
}

#[test]
#[ignore = "half a minute: scripts/test.sh --long"]
fn two_chambers_and_a_hole() {
    let planned =
        check(&Case { name: "two chambers", text: TWO, method: "closest-approach", asked: 0.05, rows: 12, seeds: 8 });
    assert!(planned.plan.openings[0].knudsen < 1.0, "{}", planned.plan.openings[0].knudsen);
}

#[test]
#[ignore = "half a minute: scripts/test.sh --long"]
fn effusion() {
    // The published scene, in half its time: a litre within 26 others.
    let text = include_str!("../../scenes/effusion.toml");
    let of_seed = |seed: u64| {
        let mut scene = corpuscle::scene::parse(text, "effusion.toml", std::path::Path::new("")).expect("a scene");
        (scene.seed, scene.end_time, scene.output.rows, scene.output.snapshots) = (seed, 0.004, 12, 0);
        scene.model.particles = None;
        scene.model.wish.accuracy = Some(0.1);
        Model::new(scene).expect("a plan")
    };
    let models: Vec<Model> = (1..=12).map(of_seed).collect();
    let predicted = forecast(&models[0]);
    let runs: Vec<Vec<f64>> = models.iter().map(|model| squares_at_cost("effusion", &predicted, model)).collect();
    holds("effusion", 0.1, predicted.error, true_error(&runs, &predicted));
}

#[test]
fn a_closed_vessel_is_filled() {
    check(&Case { name: "filling", text: FILLED, method: "closest-approach", asked: 0.02, rows: 20, seeds: 3 });
}

#[test]
#[ignore = "three minutes: scripts/test.sh --long"]
fn a_vessel_is_filled_by_little_flow() {
    check(&Case { name: "low flow", text: LOW, method: "closest-approach", asked: 0.05, rows: 20, seeds: 8 });
}

#[test]
fn a_vessel_vents() {
    check(&Case { name: "vent", text: VENTED, method: "closest-approach", asked: 0.06, rows: 20, seeds: 6 });
}

/// A hole of which only the flow matters is modelled. The limit is that of the whole scene, not of the part that is left.
#[test]
fn a_vessel_in_a_room() {
    let (asked, rows) = (0.04, 12);
    let planned = |text: &str, wish: &str, seed: u64| {
        model(&scene(text, &format!("method = \"closest-approach\"\n{wish}"), rows, seed))
    };
    let wish = format!("accuracy = {asked}");
    let models: Vec<Model> = (1..=3).map(|seed| planned(ROOM, &wish, seed)).collect();
    let predicted = forecast(&models[0]);
    assert_eq!((models[0].scene.chambers.len(), models[0].scene.vents.len()), (1, 1));
    let uniform = model(&scene(ROOM, "method = \"control-volume\"", rows, 1));
    let runs: Vec<Vec<f64>> = models
        .iter()
        .map(|model| {
            let run = run(model, Options::default());
            pays("room", predicted.particle_steps, &run.outcome);
            let times: Vec<f64> = run.rows.iter().map(|row| row.time).collect();
            let states = reference(&uniform, &times);
            let limit: Vec<Vec<f64>> = states.iter().map(|row| vec![row[0].pressure; 2]).collect();
            squares_against(&run.rows, &limit)
        })
        .collect();
    holds("room", asked, predicted.error, true_error(&runs, &predicted));
    // The check can fail: resolved, as many particles, most of which are then air of the room, are too few.
    let resolved = ROOM.replace("flow_only = true\n", "");
    let few = planned(&resolved, &format!("particles = {}\naccuracy = 0.5", models[0].plan.particles), 1);
    assert_eq!(few.scene.chambers.len(), 2);
    assert!(forecast(&few).error > 2.0 * asked, "{}", forecast(&few).error);
}

#[test]
fn a_small_tank() {
    check(&Case { name: "tank", text: TANK, method: "closest-approach", asked: 0.35, rows: 10, seeds: 3 });
}

#[test]
fn blind_a_slab_of_cells() {
    check(&Case { name: "slab", text: SLAB, method: "cell", asked: 0.04, rows: 15, seeds: 3 });
}

#[test]
#[ignore = "half a minute: scripts/test.sh --long"]
fn blind_two_holes() {
    check(&Case { name: "two holes", text: TWO_HOLES, method: "closest-approach", asked: 0.17, rows: 10, seeds: 3 });
}

#[test]
#[ignore = "half a minute: scripts/test.sh --long"]
fn blind_a_hot_inflow() {
    check(&Case { name: "hot inflow", text: HOT, method: "closest-approach", asked: 0.03, rows: 10, seeds: 3 });
}

/// The measure of a release: mean |rho - exact| over fiftieths of the length, over the mean density.
#[test]
fn a_release_in_a_tube() {
    let asked = 0.12;
    let planned = |seed: u64| {
        let mut scene = SOD.model().expect("a tube").scene;
        scene.seed = seed;
        scene.model = ModelRequest::default();
        scene.model.wish.accuracy = Some(asked);
        Model::new(scene).expect("a plan")
    };
    let first = planned(1);
    let mean = 0.5 * (1.0 + 0.1 / 0.8);
    let errors: Vec<f64> = (1..=2)
        .map(|seed| {
            let model = planned(seed);
            let outcome = run(&model, Options::default()).outcome;
            pays("release", forecast(&model).particle_steps, &outcome);
            let particles = outcome.particles;
            let tube = corpuscle::study::verify::tube::Tube { particles: model.plan.particles, ..SOD };
            (tube.errors(&model, tube.end, &particles).expect("an exact solution")[0] / mean).powi(2)
        })
        .collect();
    let predicted = forecast(&first);
    assert_eq!(worst(&predicted.columns).unwrap().name, "profile");
    holds("release", asked, predicted.error, root(&errors));
}

/// Gas at rest needs no particles, and nothing is wrong about it.
#[test]
fn a_control_volume_where_it_suffices() {
    let planned = model(&scene(REST, "accuracy = 0.01", 20, 1));
    assert_eq!((planned.plan.method, forecast(&planned).error), (Method::ControlVolume, 0.0));
}
