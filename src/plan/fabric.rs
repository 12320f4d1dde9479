//! How elastic fabric is modelled: whether what hits give its nodes is smoothed.
//!
//! Hits thermalise nodes: a node of mass M is as fast as c0 sqrt(m_p/M), each way. Passes of smoothing spread each hit over more nodes.

use super::text::significant;
use super::{Measured, Reason};
use crate::scene::Scene;

/// So heavy may a particle be over the lightest node without smoothing, with few passes, and with many
/// (`src/fabric/smoothing.rs`).
const PLAIN: f64 = 1.5e-3;
const FEW: f64 = 0.015;

/// Passes of smoothing for a mass of the heaviest particle over that of the lightest node.
pub fn smoothings(ratio: f64) -> u32 {
    if ratio <= PLAIN {
        0
    } else if ratio <= FEW {
        4
    } else {
        10
    }
}

/// What n passes leave of ripples is this over n, above what was measured: .037 and .056 after ten in a taut sheet, by the step
/// (`cargo test --test fabric smoothed -- --nocapture`). Four passes were not measured.
const LEFT: f64 = 0.6;

/// The mass of the heaviest particle over that of the lightest node of elastic fabric, if there is any.
pub fn mass_over_node(scene: &Scene, measured: &Measured, moles_per_particle: f64) -> Option<f64> {
    let heaviest = scene.gases.iter().map(|gas| gas.molar_mass).fold(0.0, f64::max) * moles_per_particle;
    measured.lightest_node.map(|node| heaviest / node)
}

/// What the gas does to fabric: so heavy are its particles over the lightest node, and so much is kT, J, T that of particles.
#[derive(Debug, Clone, Copy)]
pub struct Noise {
    pub mass_over_node: f64,
    pub thermal_energy: f64,
}

impl Noise {
    /// Pa, the share of the area of a closed surface that ripples take, times the gauge pressure.
    ///
    /// Hits give each node kT/2 across the fabric, and bends take that up: under a tension F for each length, half of the gauge
    /// pressure times the radius of a sphere of the area A, fabric is by (nodes) kT/(2 F) larger than what it spans. Smoothing keeps hits from short
    /// waves, and damping takes energy: without smoothing this is a bound.
    fn ripples_times_pressure(self, measured: &Measured) -> Option<f64> {
        let passes = smoothings(self.mass_over_node);
        let left = if passes == 0 { 1.0 } else { LEFT / f64::from(passes) };
        measured.nodes_over_volume.map(|nodes| left * nodes * self.thermal_energy)
    }

    /// The share of its area that ripples take at the end, where all gas stays in bags.
    pub fn final_ripples(self, scene: &Scene, measured: &Measured, number_density: f64) -> Option<f64> {
        measured.inflated.filter(|_| scene.vents.is_empty())?;
        let outside = scene.fabrics.iter().filter_map(|fabric| fabric.external_pressure).fold(0.0, f64::max);
        let gauge = number_density * self.thermal_energy - outside;
        self.ripples_times_pressure(measured).filter(|_| gauge > 0.0).map(|product| (product / gauge).min(1.0))
    }
}

/// `thermal_energy`: kT of a particle at the end, J.
pub fn reasons(
    scene: &Scene,
    measured: &Measured,
    moles_per_particle: f64,
    thermal_energy: f64,
    reasons: &mut Vec<Reason>,
) {
    if let Some(inflated) = measured.inflated {
        reasons.push(Reason {
            quantity: "volume of bags".into(),
            value: format!("{} L", significant(1e3 * inflated)),
            why: format!(
                "about what their fabric holds inflated, or what they hold at the start: {} L",
                significant(1e3 * measured.gas_volume)
            ),
        });
    }
    let Some(ratio) = mass_over_node(scene, measured, moles_per_particle) else { return };
    let passes = smoothings(ratio);
    reasons.push(Reason {
        quantity: "smoothing of hits".into(),
        value: if passes == 0 { "none".into() } else { format!("{passes} passes") },
        why: format!(
            "a particle has {} of the mass of the lightest node of fabric; up to {} hits may shake each node alone",
            significant(ratio),
            significant(PLAIN)
        ),
    });
    let noise = Noise { mass_over_node: ratio, thermal_energy };
    reasons.extend(noise.ripples_times_pressure(measured).map(|product| Reason {
        quantity: "ripples of fabric".into(),
        value: format!("1 % of a bag's area at {} kPa above the pressure outside", significant(1e-3 * product / 0.01)),
        why: format!(
            "{}, and in inverse proportion to that pressure: by noise of the gas",
            if passes == 0 { "at most" } else { "about" }
        ),
    }));
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn heavier_particles_are_smoothed_more() {
        assert_eq!([1e-4, 1.5e-3, 2e-3, 0.015, 0.02, 0.5].map(smoothings), [0, 0, 4, 4, 10, 10]);
    }
}
