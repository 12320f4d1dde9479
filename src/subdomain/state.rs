//! Particles, gases and regions between the host's SI and the device's units.

use crate::gas::{MOST_MODES, Particle};
use crate::geometry::Grid;
use crate::plan::Plan;
use crate::scene::Region;

use super::layout::{GpuGas, GpuNewborn, GpuParticle, GpuZone};
use super::scales::Scales;

#[derive(Debug, thiserror::Error, PartialEq)]
pub enum StateError {
    #[error("particle {id} at ({:.6}, {:.6}, {:.6}) m is outside the grid of cells", position[0], position[1], position[2])]
    OutsideGrid { id: u32, position: [f64; 3] },
}

impl GpuParticle {
    /// # Errors
    /// If the position is outside the grid.
    pub fn from_host(particle: &Particle, grid: &Grid, scales: &Scales) -> Result<GpuParticle, StateError> {
        let outside = StateError::OutsideGrid { id: particle.id, position: particle.position };
        Ok(GpuParticle {
            position: grid.to_fixed(particle.position).ok_or(outside)?,
            tag: GpuParticle::tag(particle.gas, particle.id),
            velocity: particle.velocity.map(|v| v as f32),
            spin: (particle.spin_energy / scales.reference_mass) as f32,
        })
    }

    pub fn to_host(&self, grid: &Grid, scales: &Scales) -> Particle {
        Particle {
            id: self.id(),
            gas: self.gas(),
            position: grid.to_metres(self.position),
            velocity: self.velocity.map(f64::from),
            spin_energy: f64::from(self.spin) * scales.reference_mass,
        }
    }
}

impl GpuNewborn {
    /// A particle that enters at its position `start` s after the start of a step.
    ///
    /// # Errors
    /// If the position is outside the grid.
    pub fn from_host(particle: &Particle, start: f64, grid: &Grid, scales: &Scales) -> Result<GpuNewborn, StateError> {
        let mut born = GpuParticle::from_host(particle, grid, scales)?;
        let start = start as f32;
        for axis in 0..3 {
            // The virtual position x0 = x - v t, which may lie behind the orifice.
            let back = (f64::from(born.velocity[axis]) * f64::from(start) / grid.quantum()).round() as i64;
            born.position[axis] = born.position[axis].wrapping_sub(back as u32);
        }
        Ok(GpuNewborn { particle: born, start, pad: [0; 3] })
    }
}

/// The rows of the device's gas table, by gas index.
pub fn gas_table(plan: &Plan) -> Vec<GpuGas> {
    let heaviest = plan.gases.iter().map(|gas| gas.molar_mass).fold(0.0, f64::max);
    plan.gases
        .iter()
        .map(|gas| {
            let beta = 0.5 * gas.spin_dof;
            let has_spin = gas.species.has_spin();
            GpuGas {
                mass: (gas.molar_mass / heaviest) as f32,
                exchange: if has_spin { gas.exchange_probability as f32 } else { 0.0 },
                inverse_beta: if has_spin { inverse(beta) } else { 0.0 },
                inverse_beta1: (1.0 / (beta + 1.0)) as f32,
            }
        })
        .collect()
}

/// The device's table of shares (`shaders/shared/spin.wgsl`), of 16 gases with each of 16: of a change of the relative velocity
/// the one takes m_j/(m_i + m_j) and the other the rest, each in its upper twelve bits and what they lack.
pub fn share_table(gases: &[GpuGas]) -> Vec<[f32; 4]> {
    let mut table = vec![[0.5, 0.0, 0.5, 0.0]; 256];
    for (i, one) in gases.iter().enumerate() {
        for (j, other) in gases.iter().enumerate() {
            let [own, others] = [one, other].map(|gas| f64::from(gas.mass));
            let [[upper, lower], [upper_j, lower_j]] = [others, own].map(|mass| in_two(mass / (own + others)));
            table[16 * i + j] = [upper, lower, upper_j, lower_j];
        }
    }
    table
}

/// A number as the sum of two: its upper twelve bits, whose product with a word loses no more than that of any other word
/// does, and the rest.
fn in_two(number: f64) -> [f32; 2] {
    let upper = f32::from_bits((number as f32).to_bits() & !0xfff);
    [upper, (number - f64::from(upper)) as f32]
}

/// 1/beta; finite for a mode without internal energy, whose share it still makes zero.
fn inverse(beta: f64) -> f32 {
    (1.0 / beta.max(1e-9)) as f32
}

/// The device's table of modes (`shaders/shared/modes.wgsl`), [`MOST_MODES`] for each of 16 gases: for an exchange at an
/// energy, then for an equilibrium at a temperature.
pub fn mode_table(plan: &Plan) -> Vec<[f32; 4]> {
    let mut table = vec![[-1e30, 0.0, 1.0, 1.0]; 2 * 16 * MOST_MODES];
    let (at_energy, thermal) = table.split_at_mut(16 * MOST_MODES);
    let rows = at_energy.chunks_exact_mut(MOST_MODES).zip(thermal.chunks_exact_mut(MOST_MODES));
    for (gas, (rows, thermal)) in plan.gases.iter().zip(rows) {
        let Some(modes) = gas.species.modes() else {
            let beta = 0.5 * gas.spin_dof;
            rows[0] = [0.0, 0.0, inverse(beta), (1.0 / (beta + 1.0)) as f32];
            thermal[0] = [0.0, 0.0, beta as f32, 0.0];
            continue;
        };
        let ln_warmer = libm::log(plan.temperature_reference / modes.scale);
        for ((row, thermal), mode) in rows.iter_mut().zip(thermal).zip(&modes.modes) {
            let beta = modes.nu0 + mode.power;
            let ln_weight = mode.ln_weight + mode.power * ln_warmer;
            let at_energy = ln_weight - libm::lgamma(beta + 2.0);
            *row = [at_energy as f32, mode.power as f32, inverse(beta), (1.0 / (beta + 1.0)) as f32];
            *thermal = [ln_weight as f32, mode.power as f32, beta as f32, 0.0];
        }
    }
    table
}

/// The first quanta that are not before a point: one outside the grid is moved to its edge, since there are no particles beyond.
fn within(point: [f64; 3], grid: &Grid) -> [u32; 3] {
    std::array::from_fn(|axis| {
        let limit = f64::from(grid.cells[axis]) * f64::from(1u32 << grid.cell_bits);
        ((point[axis] - grid.origin[axis]) / grid.quantum()).ceil().clamp(0.0, limit) as u32
    })
}

/// A plane behind the zones: a point of it, m, and the normal that points out.
pub fn zone_plane(point: [f64; 3], normal: [f64; 3], grid: &Grid) -> GpuZone {
    GpuZone { low: within(point, grid), axis: normal.map(|x| x as f32), ..GpuZone::default() }
}

/// The inside of closed fabric that never leaves a box.
pub fn zone_inside((low, high): ([f64; 3], [f64; 3]), grid: &Grid) -> GpuZone {
    // A particle may be on its fabric, and a gap beyond.
    let [low, high] = [low.map(|x| x - grid.cell), high.map(|x| x + grid.cell)].map(|corner| within(corner, grid));
    GpuZone { kind: 4, low, high, ..GpuZone::default() }
}

/// A region as `shaders/shared/zones.wgsl` tests it; `None` is everywhere.
pub fn zone_of(region: Option<&Region>, grid: &Grid) -> GpuZone {
    let fixed = |point: [f64; 3]| within(point, grid);
    let mut zone = GpuZone::default();
    match region {
        None => {}
        Some(Region::Box { min, max }) => {
            zone.kind = 1;
            zone.low = fixed(*min);
            zone.high = fixed(*max);
        }
        Some(Region::Sphere { center, radius }) => {
            zone.kind = 2;
            zone.low = fixed(*center);
            zone.radius = *radius as f32;
        }
        Some(Region::Cylinder { base, axis, radius, height }) => {
            zone.kind = 3;
            zone.low = fixed(*base);
            zone.axis = axis.map(|a| a as f32);
            zone.radius = *radius as f32;
            zone.height = *height as f32;
        }
    }
    zone
}
