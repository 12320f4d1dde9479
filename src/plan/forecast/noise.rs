//! Statistical noise: by how much the pressures of finitely many particles scatter, as variances relative to the square of
//! the pressure (docs/explanation/method.md, "Noise"; the others are derived here).
//!
//! The initial gas has exactly its energy and number in every chamber (`gas::initial`), inflow exactly its mass and
//! enthalpy: noise comes from what chambers exchange, from translation and spin, and from where particles are just now.

use std::f64::consts::PI;

use crate::scene::HeatTransfer;

/// How long energy keeps between translation and spin with the method `half-turn`, in intervals of 32 steps. It goes to
/// and fro in every step, but rows look at every eighth. Measured: chamber pressures of 1000 particles of nitrogen
/// scatter by .0105 in rows of one interval (four runs of a closed vessel that is filled), the moment's by .0163.
pub const HALF_TURN_MEMORY: f64 = 0.28;

/// What is left of a variance in the mean over a window, if the fluctuation is forgotten as exp(-t / memory):
/// 2 y (1 - y (1 - exp(-1/y))), y = memory / window.
pub fn averaged(memory: f64, window: f64) -> f64 {
    let y = memory / window;
    // Of a long memory, by its series: the formula itself would cancel.
    if y > 1e3 { 1.0 - 1.0 / (3.0 * y) } else { 2.0 * y * (1.0 - y * (1.0 - libm::exp(-1.0 / y))) }
}

/// What a variance has grown to from a start without any, at the rate at which it forgets.
pub fn grown(time: f64, memory: f64) -> f64 {
    1.0 - libm::exp(-2.0 * time / memory)
}

/// Of H independent hits of a wall: 1.13^2 / H, 4 / (pi H) (method.md, "Noise").
pub fn of_hits(hits: f64) -> f64 {
    4.0 / (PI * hits)
}

/// Of a face of a vessel, or of all its wall, by the virial theorem: what the wall received in the window is the energy
/// of the gas, less the change of sum m r.v. Of N particles in a box of length L = V/A behind a face the change of
/// sum m x v_x scatters by sqrt(2 N m kT) L / sqrt 3, of the whole wall (A = 6 L^2) in sum by r.v = sqrt(2 N m kT) L / 2, so
/// relative to the pressure (2/3) (V / (A c0 T_w))^2 / N and 2 (V / (A c0 T_w))^2 / N. Less than by hits where the window is
/// longer than some .2 L / c0: a particle that has hit a wall does not hit it again before it has crossed the vessel.
pub fn of_face(whole: bool, depth: f64, thermal_speed: f64, window: f64, particles: f64) -> f64 {
    let crossing = depth / (thermal_speed * window);
    (if whole { 2.0 } else { 2.0 / 3.0 }) * crossing * crossing / particles
}

/// Of one axis: energy of N particles goes to and fro between x, y and z, var (W_x / W) = 4/(3 N) relative; forgotten in two
/// mean collision times (chi is spread evenly); `none` never forgets it.
pub fn of_axis(particles: f64, collision_time: f64, window: f64) -> f64 {
    4.0 / (3.0 * particles) * if collision_time.is_finite() { averaged(2.0 * collision_time, window) } else { 1.0 }
}

/// Of all gas in a closed chamber: energy of N particles goes to and fro between translation and spin, var = (2/(3 N))
/// zeta/(3 + zeta); forgotten in Z tau / (1 + zeta/3) (method.md, "Spin exchange"). Never begins without collisions.
pub fn of_spin(particles: f64, spin_dof: f64, memory: f64, time: f64, window: f64) -> f64 {
    if !memory.is_finite() || spin_dof <= 0.0 {
        return 0.0;
    }
    2.0 / (3.0 * particles) * spin_dof / (3.0 + spin_dof) * averaged(memory, window) * grown(time, memory)
}

/// Numbers of particles of a chamber and of all, now and at the start, and its part of the volume.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Exchange {
    pub here: f64,
    pub all: f64,
    pub here_at_start: f64,
    pub all_at_start: f64,
    pub share: f64,
}

/// Of a chamber that exchanges particles with others at the rate k = cbar A/4 (1/V + 1/V'). A particle that started in it is
/// there with the probability s = share + (1 - share) exp(-k t), one that did not with r = share (1 - exp(-k t)): their number
/// scatters by N0 s (1 - s) + M0 r (1 - r). Where gas flows in, all have been exchanged that are there: N (1 - N/all)
/// (1 - exp(-2 k t)); the larger of the two. `factor` is what energies add to the scatter of the number: gamma, or 5/3 of
/// translation alone.
pub fn of_exchange(numbers: &Exchange, factor: f64, rate: f64, time: f64, window: f64) -> f64 {
    if rate <= 0.0 {
        return 0.0;
    }
    let Exchange { here, all, here_at_start, all_at_start, share } = *numbers;
    let left = libm::exp(-rate * time);
    let (stayed, came) = (share + (1.0 - share) * left, share * (1.0 - left));
    let others = (all_at_start - here_at_start).max(0.0);
    let of_start = here_at_start * stayed * (1.0 - stayed) + others * came * (1.0 - came);
    let of_now = here * (1.0 - here / all).max(0.0) * grown(time, 1.0 / rate);
    factor * of_start.max(of_now) / (here * here) * averaged(1.0 / rate, window)
}

/// Of an open part of a space, with N of all particles: p V = 2/3 Wk scatters by 5/(3 N) at a moment; forgotten in the time of
/// crossing, V^(1/3) / (3 sqrt(2/pi) c0) (the volume's overlap with itself, moved by a free flight).
pub fn of_zone(particles: f64, all: f64, volume: f64, thermal_speed: f64, window: f64) -> f64 {
    let memory = libm::cbrt(volume) / (3.0 * (2.0 / PI).sqrt() * thermal_speed);
    5.0 / (3.0 * particles) * (1.0 - particles / all).max(0.0) * averaged(memory, window)
}

/// The noise of a profile, not squared: mean |rho - mean| over the mean density, rho of N particles in fiftieths of a tube.
pub fn of_profile(particles: f64) -> f64 {
    (2.0 / PI * 50.0 / particles).sqrt()
}

/// Of what vents have let out: the number is what they should (they pay what they owe), its energy scatters by
/// (5 + zeta)/2 (kT)^2 each (normal energy a gamma variate of shape 2, the rest of shape (1 + zeta)/2), beside the
/// N (3 + zeta)/2 kT that were there then: the sum over what left of 1/N^2 is 1/N - 1/(N + left).
pub fn of_vents(left: f64, particles: f64, spin_dof: f64) -> f64 {
    2.0 * (5.0 + spin_dof) / (3.0 + spin_dof) / (3.0 + spin_dof) * left / (particles * (particles + left))
}

/// Of a wall that keeps a temperature: in the end T scatters by 2 / ((3 + zeta) N), at the rate of heat exchange.
pub fn of_heat(particles: f64, spin_dof: f64, rate: f64, time: f64, window: f64) -> f64 {
    if rate <= 0.0 {
        return 0.0;
    }
    2.0 / ((3.0 + spin_dof) * particles) * averaged(1.0 / rate, window) * grown(time, 1.0 / rate)
}

/// Uniform gas.
pub struct HeatedGas {
    /// m3.
    pub volume: f64,
    pub moles: f64,
    pub spin_dof: f64,
    /// m/s.
    pub thermal_speed: f64,
}

/// 1/s: heat through a wall of this area over the heat capacity of the gas.
pub fn heat_rate(transfer: HeatTransfer, area: f64, gas: &HeatedGas) -> f64 {
    let &HeatedGas { volume, moles, spin_dof, thermal_speed } = gas;
    let mean_speed = (8.0 / PI).sqrt() * thermal_speed;
    let most = 0.25 * mean_speed * area / volume * (2.0 + 0.5 * spin_dof) / (0.5 * (3.0 + spin_dof));
    match transfer {
        HeatTransfer::Accommodation(share) => share * most,
        HeatTransfer::Coefficient(coefficient) => {
            let capacity = 0.5 * (3.0 + spin_dof) * crate::scene::GAS_CONSTANT * moles;
            (coefficient * area / capacity).min(most)
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn near(found: f64, expected: f64, tolerance: f64) -> bool {
        (found / expected - 1.0).abs() < tolerance
    }

    /// A short memory leaves 2 memory / window, a long one all; the two formulas meet.
    #[test]
    fn averages_forget() {
        assert!(near(averaged(1e-4, 1.0), 2e-4, 1e-3) && near(averaged(1e6, 1.0), 1.0, 1e-6));
        assert!(near(averaged(1.0001e3, 1.0), averaged(0.9999e3, 1.0), 1e-6));
        assert!(averaged(1.0, 1.0) < averaged(2.0, 1.0));
        assert!(near(grown(1e-3, 1.0), 2e-3, 1e-2) && near(grown(10.0, 1.0), 1.0, 1e-6));
    }

    /// The prototype's figure: .0051 predicted at so many hits.
    #[test]
    fn noise_of_hits_is_the_prototype_s() {
        let hits = (1.13f64 / 0.0051).powi(2);
        assert!(near(of_hits(hits).sqrt(), 0.0051, 2e-3));
    }

    /// A face of a cube behind which the window is short knows its pressure by hits, after a long one by the virial.
    #[test]
    fn long_windows_know_a_face_better_than_by_hits() {
        let (edge, speed, particles) = (0.1, 300.0, 1e4);
        let hits = |window: f64| particles / edge * (8.0 / PI).sqrt() * speed * window / 4.0;
        let face = |window: f64| of_face(false, edge, speed, window, particles);
        let crossing = edge / speed;
        assert!(of_hits(hits(0.05 * crossing)) < face(0.05 * crossing));
        assert!(of_hits(hits(5.0 * crossing)) > 5.0 * face(5.0 * crossing));
        // All of a wall: sqrt(2/N) / 6 x edge / (c0 T_w), that of `study::verify::collisions`.
        let whole = of_face(true, edge / 6.0, speed, crossing, particles).sqrt();
        assert!(near(whole, (2.0 / particles).sqrt() / 6.0, 1e-9));
    }

    /// Half of the particles gone leave 1/N of the rest, less 1/N of the start.
    #[test]
    fn vents_scatter_by_what_left() {
        assert!(near(of_vents(500.0, 500.0, 2.0), 14.0 / 25.0 * (1.0 / 500.0 - 1.0 / 1000.0), 1e-12));
        assert_eq!(of_vents(0.0, 500.0, 2.0), 0.0);
    }

    #[test]
    fn closed_chambers_without_collisions_or_spin_do_not_scatter() {
        assert_eq!(of_spin(100.0, 2.0, f64::INFINITY, 1.0, 1.0), 0.0);
        assert_eq!(of_spin(100.0, 0.0, 1.0, 1.0, 1.0), 0.0);
        assert!(near(of_spin(100.0, 2.0, 1e3, 1e6, 1e-3), 2.0 / 300.0 * 0.4, 1e-3));
    }

    /// At rest gamma/N (1 - N/all) after a long time, nothing at once; of gas that leaves, binomial.
    #[test]
    fn exchange_scatters_numbers() {
        let rest = Exchange { here: 100.0, all: 200.0, here_at_start: 100.0, all_at_start: 200.0, share: 0.5 };
        assert_eq!(of_exchange(&rest, 1.4, 0.0, 1.0, 1.0), 0.0);
        assert!(near(of_exchange(&rest, 1.4, 1e-3, 1e6, 1e-3), 0.007, 1e-3));
        assert!(of_exchange(&rest, 1.4, 1e-3, 1.0, 1e-3) < 1e-4);
        let alone = Exchange { here: 100.0, all: 100.0, here_at_start: 100.0, all_at_start: 100.0, share: 1.0 };
        assert_eq!(of_exchange(&alone, 1.4, 1.0, 1.0, 1.0), 0.0);
        let effusion = Exchange { here: 75.0, all: 100.0, here_at_start: 100.0, all_at_start: 100.0, share: 0.0 };
        let rate = -libm::log(0.75);
        assert!(near(of_exchange(&effusion, 1.0, rate, 1.0, 1e-6), 0.25 / 75.0, 1e-3));
    }

    /// A coefficient as large as all hits can carry is the accommodation 1.
    #[test]
    fn a_wall_exchanges_at_most_what_hits_carry() {
        let rate = |transfer| {
            heat_rate(transfer, 0.06, &HeatedGas { volume: 1e-3, moles: 0.04, spin_dof: 2.0, thermal_speed: 300.0 })
        };
        assert_eq!(rate(HeatTransfer::Accommodation(1.0)), rate(HeatTransfer::Coefficient(1e9)));
        assert!(near(rate(HeatTransfer::Accommodation(0.5)), 0.5 * rate(HeatTransfer::Coefficient(1e9)), 1e-12));
        assert!(rate(HeatTransfer::Coefficient(10.0)) < rate(HeatTransfer::Coefficient(20.0)));
        assert!(of_heat(100.0, 2.0, 0.0, 1.0, 1.0) == 0.0 && of_heat(100.0, 2.0, 1.0, 1.0, 1.0) > 0.0);
    }
}
