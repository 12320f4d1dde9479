//! A tank that is filled with a gas of cp = a + b T + c T^2 (method.md, "Heat capacities"): U = U0 + integral h dm, and the
//! temperature that the integral of cv asks for. The curve is integrated here in closed form, without the solver's
//! partition function.

use crate::gpu::Device;
use crate::simulation::{Model, Options};
use crate::study::StudyError;

use super::gas_box::GAS_CONSTANT;
use super::statistics::mean_of_series;
use super::witness::model_of;
use super::{Check, Curves, Effort, Findings, Run, run};

/// Like carbon dioxide: cv grows from 26 to 48 J/(mol K) from 230 to 1000 K.
pub const CP: [f64; 3] = [23.0, 5.6e-2, -2.2e-5];
/// kg/mol.
pub const MOLAR_MASS: f64 = 0.044;
/// s, K, kg.
pub const END: f64 = 0.012;
pub const INFLOW: f64 = 800.0;
const MASS: f64 = 1.6e-3;
const START: f64 = 300.0;

/// The integral of cp from T0 to T, J/mol.
pub fn enthalpy_gain(from: f64, to: f64) -> f64 {
    let [a, b, c] = CP;
    let antiderivative = |t: f64| t * (a + t * (b / 2.0 + t * c / 3.0));
    antiderivative(to) - antiderivative(from)
}

/// J/(mol K).
pub fn cp(t: f64) -> f64 {
    CP[0] + t * (CP[1] + t * CP[2])
}

/// A litre of the gas at 300 K, filled at 800 K in 8 ms.
///
/// # Errors
/// If no plan can be made for it.
pub fn tank(particles: u64) -> Result<Model, StudyError> {
    let flow = MASS / 6e-3;
    let text = format!(
        "end_time = {END}\n[[gas]]\nname = \"curved\"\nmolar_mass = {MOLAR_MASS}\ncp = {CP:?}\n\
         [[wall]]\nname = \"box\"\nshape = \"box\"\nmin = [0.0, 0.0, 0.0]\nmax = [0.1, 0.1, 0.1]\ngas = \"inside\"\n\
         [[chamber]]\nname = \"tank\"\npressure = 1e5\ntemperature = {START}\ngas = \"curved\"\n\
         [[orifice]]\nname = \"inlet\"\nposition = [0.0, 0.05, 0.05]\ndirection = [1.0, 0.0, 0.0]\narea = 0.002\n\
         gas = \"curved\"\ntemperature = {INFLOW}\nmass_flow = [[0.0, 0.0], [0.002, {flow}], [0.006, {flow}], [0.008, 0.0]]\n\
         [model]\nmethod = \"closest-approach\"\nparticles = {particles}\n[output]\nrows = 60\nsnapshots = 0\n"
    );
    model_of("filling-curve", &text)
}

/// What the curve says of a run.
pub struct Balance {
    /// Energy at the end over U0 + integral h dm, less 1.
    pub energy_error: f64,
    /// n u(T) = U, K.
    pub temperature: f64,
    /// Mean of the last quarter and its standard error, K.
    pub found: (f64, f64),
}

/// # Panics
/// If the run has not the rows of [`tank`].
pub fn balance(model: &Model, run: &Run) -> Balance {
    let audit = &run.outcome.audit;
    let moles = |mass: f64| mass / MOLAR_MASS;
    // Both energies count from that of the gas at the start.
    let at_start = model.plan.gases[0].species.energy(1.0, START);
    let start = moles(audit.mass_start) * at_start;
    let brought = moles(audit.mass_injected) * (at_start + GAS_CONSTANT * START + enthalpy_gain(START, INFLOW));
    let excess = |t: f64| {
        moles(audit.mass_end) * (at_start + enthalpy_gain(START, t) - GAS_CONSTANT * (t - START)) - (start + brought)
    };
    // Halving between the two temperatures that it must lie between.
    let (mut low, mut high) = (START, 1100.0);
    for _ in 0..60 {
        let middle = 0.5 * (low + high);
        if excess(middle) > 0.0 { high = middle } else { low = middle }
    }
    let late: Vec<f64> = run.rows[45..].iter().map(|row| row.chambers[0].temperature).collect();
    Balance {
        energy_error: audit.energy_end / (start + brought) - 1.0,
        temperature: low,
        found: mean_of_series(&late, 5),
    }
}

pub(super) fn filling(device: &Device, effort: Effort) -> Result<Findings, StudyError> {
    let particles = if effort == Effort::Quick { 2500 } else { 20_000 };
    let model = tank(particles)?;
    let run = run(device, &model, Options::default())?;
    let Balance { energy_error, temperature, found } = balance(&model, &run);
    let of = |row: f64| row / temperature;
    let checks = vec![
        Check::of("energy over U0 + integral h dm, less 1", 0.0, (energy_error, 0.0), 1e-4),
        Check::of("T at the end over that of the curve", 1.0, (of(found.0), of(found.1)), 0.01),
    ];
    let times: Vec<f64> = run.rows.iter().map(|row| row.time).collect();
    let volume = crate::simulation::reference(&model, &times);
    let measured = run.rows.iter().map(|row| [1e3 * row.time, row.chambers[0].temperature]);
    let expected = times.iter().zip(&volume).map(|(time, state)| [1e3 * time, state[0].temperature]);
    let title = format!("A litre filled with a gas of cp(T), {particles} particles");
    let chart = Curves::new("filling-curve", title, "ms", "K")
        .line("particles", measured.collect())
        .reference("control volume", expected.collect());
    Ok(Findings { charts: vec![chart], ..checks.into() })
}
