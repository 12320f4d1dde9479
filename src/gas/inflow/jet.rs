//! Jets: their state by Mach number or velocity, and the velocities of their particles.

use crate::gas::{Draws, Species, thermo};
use crate::scene::{GAS_CONSTANT, Jet, JetSpeed, Mixture};

/// The drift of a jet, m/s, and its static temperature, K: h(Ts) + u^2/2 = h(T0). `None` if a gas of that stagnation
/// temperature cannot be so fast.
pub fn jet_state(speed: JetSpeed, stagnation: f64, mixture: &Mixture, gases: &[Species]) -> Option<[f64; 2]> {
    let molar_mass = thermo::molar_mass(mixture, gases);
    match speed {
        JetSpeed::Mach(mach) => {
            let temperature = temperature_at_mach(stagnation, mach, mixture, gases);
            let gamma = thermo::heat_capacity_ratio(mixture, gases, temperature);
            Some([mach * (gamma * GAS_CONSTANT * temperature / molar_mass).sqrt(), temperature])
        }
        JetSpeed::Velocity(velocity) => {
            let left = thermo::molar_enthalpy(mixture, gases, stagnation) - 0.5 * molar_mass * velocity * velocity;
            if left <= 0.0 {
                return None;
            }
            let excess = |t: f64| thermo::molar_enthalpy(mixture, gases, t) - left;
            let slope = |t: f64| thermo::molar_cv(mixture, gases, t) + GAS_CONSTANT;
            Some([velocity, thermo::root(excess, slope, stagnation)])
        }
    }
}

/// The Mach number of such a jet; infinite where there is none.
pub fn jet_mach(speed: JetSpeed, stagnation: f64, mixture: &Mixture, gases: &[Species]) -> f64 {
    jet_state(speed, stagnation, mixture, gases).map_or(f64::INFINITY, |[drift, temperature]| {
        let gamma = thermo::heat_capacity_ratio(mixture, gases, temperature);
        drift / (gamma * GAS_CONSTANT * temperature / thermo::molar_mass(mixture, gases)).sqrt()
    })
}

/// The static temperature of a flow at a Mach number, K: h(Ts) + u^2/2 = h(T0) with u^2 = Ma^2 gamma R Ts / M.
fn temperature_at_mach(stagnation: f64, mach: f64, mixture: &Mixture, gases: &[Species]) -> f64 {
    if thermo::is_constant(mixture, gases) {
        let gamma = thermo::heat_capacity_ratio(mixture, gases, stagnation);
        return stagnation / (1.0 + 0.5 * (gamma - 1.0) * mach * mach);
    }
    let available = thermo::molar_enthalpy(mixture, gases, stagnation);
    let kinetic = |t: f64| 0.5 * mach * mach * thermo::heat_capacity_ratio(mixture, gases, t) * GAS_CONSTANT;
    let excess = |t: f64| thermo::molar_enthalpy(mixture, gases, t) + kinetic(t) * t - available;
    let slope = |t: f64| thermo::molar_cv(mixture, gases, t) + GAS_CONSTANT + kinetic(t);
    thermo::root(excess, slope, stagnation)
}

/// A jet at a moment.
pub struct JetFlow {
    /// m/s.
    drift: f64,
    /// Static, K.
    pub temperature: f64,
    cone_angle: f64,
}

impl JetFlow {
    pub fn of(jet: Jet, stagnation: f64, mixture: &Mixture, gases: &[Species]) -> JetFlow {
        // The plan has refused a jet that is too fast at some time.
        let [drift, temperature] = jet_state(jet.speed, stagnation, mixture, gases).unwrap_or([0.0, stagnation]);
        JetFlow { drift, temperature, cone_angle: jet.cone_angle }
    }

    /// Of a particle, in the orifice's axes, m/s.
    pub fn velocity(&self, gas: &Species, draws: &mut Draws) -> [f64; 3] {
        let &JetFlow { drift, temperature, cone_angle } = self;
        let cosine = 1.0 - draws.uniform() * (1.0 - libm::cos(cone_angle));
        let sine = (1.0 - cosine * cosine).max(0.0).sqrt();
        let around = 2.0 * std::f64::consts::PI * draws.uniform();
        let c0 = (GAS_CONSTANT * temperature / gas.molar_mass).sqrt();
        // A cone wider than a half space would drift into the wall: such directions graze instead.
        let normal = c0 * draws.drifting_flux_speed((drift * cosine / c0).max(0.0));
        [
            normal,
            drift * sine * libm::cos(around) + c0 * draws.normal(),
            drift * sine * libm::sin(around) + c0 * draws.normal(),
        ]
    }
}
