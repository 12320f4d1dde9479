//! Flow of gas that collides through resolved holes.

use crate::gas::{self, kinetics};
use crate::gpu::Device;
use crate::plan::FASTEST_PAIR;
use crate::scene::{DiameterCap, Scene};
use crate::simulation::{Model, Options, Row, reference};
use crate::study::StudyError;

use super::witness::model_from;
use super::{Check, Curves, Effort, Findings, Run, run, scene_of};

/// m3: the inner box.
pub const VOLUME: f64 = 0.16 * 0.12 * 0.12;
/// m, half the side of the hole, which is the radius 2 area / perimeter of a square one.
pub const RADIUS: f64 = 0.02;
/// m2, of that hole.
pub(super) const AREA: f64 = 4.0 * RADIUS * RADIUS;

/// A chamber with gas and one near vacuum around it, a square hole between them, for 1.2 ms.
///
/// # Errors
/// If no plan can be made for it.
pub fn emptying(particles: u64, knudsen: f64) -> Result<Model, StudyError> {
    emptying_until(1.2e-3, particles, knudsen)
}

fn emptying_until(end_time: f64, particles: u64, knudsen: f64) -> Result<Model, StudyError> {
    let mut scene = emptying_scene()?;
    scene.end_time = end_time;
    scene.model.particles = Some(particles);
    set_knudsen(&mut scene, particles as f64 / VOLUME, knudsen);
    model_from("orifice", scene)
}

/// Gives gas that is this dense at the start, 1/m3, a mean free path of so many radii of the hole, and a step for it. No diameter is
/// capped: the Knudsen number is that of the gas before the hole, which is denser than the mean.
pub(super) fn set_knudsen(scene: &mut Scene, density: f64, knudsen: f64) {
    let diameter = kinetics::diameter_of_path(density, knudsen * RADIUS);
    scene.model.diameter = Some(diameter);
    scene.model.diameter_cap = Some(DiameterCap::Off);
    scene.model.time_step = thin_gas_step(diameter, density, scene.chambers[0].temperature);
}

/// Isentropic flux at a ratio of pressures and a temperature (K) upstream, over the density upstream: m/s.
pub(super) fn isentropic_speed(ratio: f64, temperature: f64) -> f64 {
    gas::isentropic(1.4, ratio) * kinetics::thermal_square(temperature, 0.028).sqrt()
}

/// Where spheres are far smaller than their spacing, a step in which the fastest pairs close in by a diameter takes a
/// grid of thousands of cells for each particle. In this one, s, they close in by half the spacing: as by
/// a diameter at an occupancy of 0.065, while the gas collides the less often the thinner it is.
pub(super) fn thin_gas_step(diameter: f64, density: f64, temperature: f64) -> Option<f64> {
    let spacing = kinetics::mean_spacing(density);
    let fastest = FASTEST_PAIR * kinetics::thermal_square(temperature, 0.028).sqrt();
    (diameter < 0.25 * spacing).then(|| 0.5 * spacing / fastest)
}

/// The same with all that a plan decides left to it.
///
/// # Errors
/// If its text makes no scene.
pub fn emptying_scene() -> Result<Scene, StudyError> {
    let text = r#"
        end_time = 1.2e-3
        gas = [{ name = "nitrogen", molar_mass = 0.028, gamma = 1.4 }]
        output = { rows = 12, snapshots = 0 }
        [[wall]]
        name = "tank"
        shape = "box"
        min = [-0.02, -0.08, -0.08]
        max = [0.36, 0.08, 0.08]
        gas = "inside"
        [[wall]]
        name = "inner"
        shape = "box"
        min = [0.0, -0.06, -0.06]
        max = [0.16, 0.06, 0.06]
        thickness = 0.002
        hole = [{ name = "vent", face = "+x", center = [0.0, 0.0], size = [0.04, 0.04] }]
        [[chamber]]
        name = "inner"
        region = { box = { min = [0.0, -0.06, -0.06], max = [0.16, 0.06, 0.06] } }
        pressure = 1.0e6
        temperature = 700.0
        gas = "nitrogen"
        [[chamber]]
        name = "tank"
        pressure = 200.0
        temperature = 700.0
        gas = "nitrogen"
        "#;
    scene_of("orifice", text)
}

/// Discharge coefficient over the run and its standard error, with a mean free path of `knudsen` hole radii at the
/// start and `particles` in the chamber.
///
/// Over a window d ln N / dt = -Cd A / V .685 sqrt(R T / M). The n particles that leave are known to sqrt(n), and gas
/// that expands in a run of 1.2 ms is uniform to a few per cent.
///
/// # Errors
/// If the run fails.
pub fn discharge(device: &Device, particles: u64, knudsen: f64) -> Result<(f64, f64), StudyError> {
    let model = emptying(particles, knudsen)?;
    Ok(discharge_of(&run(device, &model, Options::default())?.rows))
}

/// The mean over so many seeds, and its standard error; `see` sees each run.
///
/// # Errors
/// If a run fails.
pub fn discharge_of_seeds(
    device: &Device,
    model: &mut Model,
    seeds: u64,
    mut see: impl FnMut(&Model, &Run),
) -> Result<(f64, f64), StudyError> {
    let (mut sum, mut square) = (0.0, 0.0f64);
    for seed in 1..=seeds {
        model.plan.seed = seed;
        let run = run(device, model, Options::default())?;
        let (found, error) = discharge_of(&run.rows);
        sum += found / seeds as f64;
        square += (error / seeds as f64).powi(2);
        see(model, &run);
    }
    Ok((sum, square.sqrt()))
}

/// Of the rows of such a run; there must be four.
pub fn discharge_of(rows: &[Row]) -> (f64, f64) {
    // The first two rows see the flow start.
    let window = &rows[2..];
    let number = |k: usize| window[k].chambers[0].particles[0];
    let passed: f64 = window
        .windows(2)
        .map(|pair| {
            let temperature = 0.5 * (pair[0].chambers[0].temperature + pair[1].chambers[0].temperature);
            (pair[1].time - pair[0].time) * isentropic_speed(0.0, temperature) * AREA / VOLUME
        })
        .sum();
    let (first, last) = (number(0), number(window.len() - 1));
    ((first / last).ln() / passed, (first / last).ln() / passed / (first - last).sqrt())
}

/// The prototype's (good to .02), whose Knudsen number is of the hole's radius.
const KNUDSEN: [f64; 4] = [0.1, 0.3, 10.0, 0.05];

/// Particles of a full run.
const FULL: u64 = 60_000;
/// One that so few particles cannot have, whatever their diameter (they are as viscous as gas of .11 radii: the floor of
/// .66 mean spacings, section 2).
const DENSE: f64 = 0.02;

/// m, of the plate with the hole; and K, of all gas.
const THICKNESS: f64 = 0.002;
const QUARTER_TEMPERATURE: f64 = 700.0;
/// m: sides of a quarter of a chamber, cut at two planes through the middle of its hole.
const QUARTER: f64 = 0.06;
/// s: when the flow is that of a hole in a wall without end, and until when: sound goes from its edge to the nearest wall and back.
const STEADY: [f64; 2] = [0.9e-4, 1.5e-4];

/// A quarter of a chamber with a square hole of the same size, cut at planes of symmetry, which are mirrors, and near vacuum behind it.
///
/// At an occupancy of .2 gas is as viscous as one of a mean free path of .69 spacings (method.md, "Collisions"), which
/// decides how many particles there are.
fn quarter(knudsen: f64) -> Result<Model, StudyError> {
    let spacing = knudsen * RADIUS / 0.69;
    let density = spacing.powi(-3);
    let (side, half, behind) = (QUARTER, 0.5 * THICKNESS, 2.0 * QUARTER + THICKNESS);
    let text = format!(
        r#"
        end_time = {end:e}
        gas = [{{ name = "nitrogen", molar_mass = 0.028, gamma = 1.4 }}]
        output = {{ rows = 15, snapshots = 0 }}
        [model]
        method = "closest-approach"
        particles = {particles:.0}
        diameter = {diameter:e}
        diameter_cap = "off"
        [[wall]]
        name = "tank"
        shape = "box"
        min = [0.0, 0.0, 0.0]
        max = [{behind}, {side}, {side}]
        gas = "inside"
        [[wall]]
        name = "plate"
        shape = "plane"
        center = [{middle}, 0.0, 0.0]
        normal = [1.0, 0.0, 0.0]
        u = [0.0, 1.0, 0.0]
        size = [{plate}, {plate}]
        thickness = {THICKNESS}
        hole = [{{ name = "vent", center = [0.0, 0.0], size = [{hole}, {hole}] }}]
        [[chamber]]
        name = "inner"
        region = {{ box = {{ min = [0.0, 0.0, 0.0], max = [{side}, {side}, {side}] }} }}
        pressure = 1.0e6
        temperature = {QUARTER_TEMPERATURE:e}
        gas = "nitrogen"
        [[chamber]]
        name = "tank"
        pressure = 200.0
        temperature = {QUARTER_TEMPERATURE:e}
        gas = "nitrogen"
        "#,
        end = STEADY[1],
        particles = density * side.powi(3),
        diameter = kinetics::diameter(density, 0.2),
        middle = side + half,
        plate = 2.5 * side,
        hole = 2.0 * RADIUS,
    );
    model_from("quarter", scene_of("quarter", &text)?)
}

/// Its discharge coefficient while the gas that flows is as at the start, and its standard error.
fn discharge_of_quarter(device: &Device, knudsen: f64) -> Result<(f64, f64), StudyError> {
    let model = quarter(knudsen)?;
    let rows = run(device, &model, Options::default())?.rows;
    let seen = |row: &&Row| row.window[0] >= STEADY[0];
    let (Some(first), Some(last)) = (rows.iter().find(seen), rows.last()) else { return Ok((f64::NAN, f64::NAN)) };
    let middle = |row: &Row| 0.5 * (row.window[0] + row.window[1]);
    let left = first.chambers[0].particles[0] - last.chambers[0].particles[0];
    let density = model.plan.chambers[0].particles[0] as f64 / QUARTER.powi(3);
    let passing = isentropic_speed(0.0, QUARTER_TEMPERATURE) * (middle(last) - middle(first));
    let expected = density * 0.25 * AREA * passing;
    Ok((left / expected, left.sqrt() / expected))
}

/// Nothing passes against what the prototype does not have.
fn figure(knudsen: f64) -> f64 {
    gas::specified(knudsen).unwrap_or(f64::NAN)
}

pub(super) fn discharges(device: &Device, effort: Effort) -> Result<Findings, StudyError> {
    let (count, particles) = if effort == Effort::Quick { (1, 32_000) } else { (KNUDSEN.len(), FULL) };
    let mut findings = Findings::default();
    let mut found = Vec::new();
    for &knudsen in &KNUDSEN[..count] {
        let coefficient = discharge(device, particles, knudsen)?;
        found.push([knudsen.log10(), coefficient.0]);
        // The table's own error, and the gas that is uniform to a few per cent.
        findings.checks.push(Check::of(format!("Cd, Kn = {knudsen}"), figure(knudsen), coefficient, 0.04));
    }
    if effort == Effort::Full {
        for knudsen in gas::BETWEEN {
            let coefficient = discharge(device, particles, knudsen)?;
            found.push([knudsen.log10(), coefficient.0]);
            findings.checks.push(Check::of(format!("Cd, Kn = {knudsen}"), gas::published(knudsen), coefficient, 0.04));
        }
        let coefficient = discharge_of_quarter(device, DENSE)?;
        let quantity = format!("Cd, Kn = {DENSE}, a quarter of a hole");
        findings.checks.push(Check::of(quantity, gas::published(DENSE), coefficient, 0.04));
        found.push([DENSE.log10(), coefficient.0]);
        let sorted = |mut points: Vec<[f64; 2]>| {
            points.sort_by(|a, b| a[0].total_cmp(&b[0]));
            points
        };
        let table = KNUDSEN.iter().map(|&knudsen| [knudsen.log10(), figure(knudsen)]);
        findings.notes.push(format!(
            "Kn 1 and 3 are held against published simulations of a thin orifice and a monatomic gas (Sharipov 2004), between \
             the limits of gamma 1.4. {particles} particles cannot be a gas of Kn = {DENSE}: its row is of a quarter of a chamber, \
             before sound comes back from the walls"
        ));
        findings.charts.push(
            Curves::new("orifice", "Discharge of a hole into near-vacuum".into(), "log10 Kn of the radius", "Cd")
                .line("found", sorted(found))
                .reference("prototype", sorted(table.collect()))
                .reference(
                    "published",
                    (-17..=10).map(|k| f64::from(k) / 10.0).map(|x| [x, gas::published(10f64.powf(x))]).collect(),
                ),
        );
    }
    Ok(findings)
}

pub(super) fn blow_down(device: &Device, effort: Effort) -> Result<Findings, StudyError> {
    emptied(device, if effort == Effort::Quick { 6000 } else { 60_000 }, |_| ())
}

/// A chamber of which half empties through a hole of Kn = .1 at the start, run with a change, against the laws of the gas without it.
///
/// Gas that stays loses e kT with each molecule that leaves: d(N 5/2 kT) = e kT dN, so d lnT / d lnN = (2 e - 5)/5. What leaves
/// as a continuum takes its enthalpy, e = 3.5 and .4 = gamma - 1; what flies freely takes 2 kT of translation and kT of spin, e = 3 and
/// .2. A hole of this Kn is somewhere between, where no law is known: it is taken to be as far as its Cd of .78 is, to .03 (of few
/// particles .07). N particles show their temperature to sqrt(2/(3 N)).
///
/// # Errors
/// If the run fails.
pub fn emptied(device: &Device, particles: u64, change: impl Fn(&mut Scene)) -> Result<Findings, StudyError> {
    // Half of it has left by then.
    let model = emptying_until(6e-3, particles, 0.1)?;
    let mut scene = model.scene.clone();
    change(&mut scene);
    let rows = run(device, &model_from("blow-down", scene)?, Options::default())?.rows;
    let (start, density) = (model.scene.chambers[0].temperature, particles as f64 / VOLUME);
    let line = |of: &dyn Fn(f64, f64) -> f64| {
        rows.iter()
            .map(|row| {
                let (number, temperature) = inside(row);
                [1e3 * row.time, of(number, temperature)]
            })
            .collect()
    };
    let title = format!("A chamber that empties through a hole, {particles} particles");
    let chart = Curves::new("blow-down", title, "ms", "K")
        .line("particles", line(&|_, temperature| temperature))
        .reference("isentropic", line(&|number, _| start * (number / (density * VOLUME)).powf(0.4)));
    let tolerance = if particles < 60_000 { 0.07 } else { 0.03 };
    let quantity = "d lnT / d lnN of the gas that stays, Kn = 0.1";
    let check = Check::of(quantity, expected_slope(figure(KNUDSEN[0])), slope(&rows), tolerance);
    Ok(Findings { charts: vec![chart], ..vec![check, course(&model, &rows, particles)].into() })
}

/// Particles in the chamber and their temperature, K.
fn inside(row: &Row) -> (f64, f64) {
    (row.chambers[0].particles[0], row.chambers[0].temperature)
}

/// d lnT / d lnN of the gas in the chamber, and its standard error. Rows are means over their windows, of both alike.
pub(super) fn slope(rows: &[Row]) -> (f64, f64) {
    let first = rows.first().map_or((f64::NAN, f64::NAN), inside);
    let last = rows.last().map_or((f64::NAN, f64::NAN), inside);
    let slope = (last.1 / first.1).ln() / (last.0 / first.0).ln();
    (slope, (2.0 / (3.0 * last.0)).sqrt() / (first.0 / last.0).ln())
}

/// Where the hole has this discharge coefficient.
pub(super) fn expected_slope(coefficient: f64) -> f64 {
    let [free, continuum] = gas::COEFFICIENT_LIMITS;
    0.2 + 0.2 * (coefficient - free) / (continuum - free)
}

/// The particles that stay, against the isentropic balance of both chambers with the prototype's discharge coefficients at
/// the Knudsen number and pressures of the moment: the largest difference over the run, in those of the start.
///
/// The table is good to .02, which shifts ln N by as much of its way; and where half of the particles have left, chance
/// has let a root of N/4 more or fewer go.
pub(super) fn course(model: &Model, rows: &[Row], particles: u64) -> Check {
    let times: Vec<f64> = rows.iter().map(|row| row.time).collect();
    let states = reference(model, &times);
    let start = model.plan.chambers[0].particles[0] as f64;
    let expected = |k: usize| states[k][0].moles.iter().sum::<f64>() / model.plan.moles_per_particle / start;
    let offs = rows.iter().enumerate().map(|(k, row)| row.chambers[0].particles[0] / start - expected(k));
    let off = offs.fold(0.0, |most: f64, off| if off.abs() > most.abs() { off } else { most });
    let last = if rows.is_empty() { f64::NAN } else { expected(rows.len() - 1) };
    let of_table = 0.02 / figure(KNUDSEN[0]) * last * -last.ln();
    let error = (last * (1.0 - last) / particles as f64).sqrt();
    Check::of("N of the gas that stays, off the balance at most", 0.0, (off, error), of_table + 3.0 * error)
}

#[cfg(test)]
mod tests;
