//! All that must not change in a run, to the last bit.

use corpuscle::simulation::{Row, ZoneState};

use crate::whole_run::Run;

fn zone_bits(zone: &ZoneState) -> Vec<u64> {
    let scalars = [zone.pressure, zone.temperature, zone.density];
    scalars.iter().chain(&zone.velocity).chain(&zone.particles).map(|value| value.to_bits()).collect()
}

fn row_bits(row: &Row) -> Vec<u64> {
    let mut bits: Vec<u64> = [row.time, row.window[0], row.window[1], row.step].map(f64::to_bits).to_vec();
    bits.push(row.particles);
    bits.extend(row.chambers.iter().chain(&row.probes).flat_map(zone_bits));
    for surface in &row.surfaces {
        bits.push(surface.hits);
        bits.push(surface.pressure.to_bits());
        bits.extend(surface.impulse.map(f64::to_bits));
    }
    for fabric in &row.fabrics {
        let [outer, inner] = fabric.pressure;
        bits.extend([fabric.volume, fabric.area, outer, inner, fabric.work, fabric.power].map(f64::to_bits));
    }
    bits.extend(row.walls.iter().flat_map(|wall| [wall.heat, wall.heat_flux]).map(f64::to_bits));
    for vent in &row.vents {
        let flows = [vent.mass_flow, vent.wanted_mass_flow, vent.discharge, vent.wanted_discharge];
        bits.extend(flows.iter().chain(&[vent.mass, vent.enthalpy]).map(|value| value.to_bits()));
    }
    bits
}

/// All that must not change.
#[derive(Clone, PartialEq)]
pub struct Bits {
    pub history: Vec<Vec<u64>>,
    /// Of each snapshot, then of the end; behind it the nodes of fabric.
    pub state: Vec<u8>,
    /// Steps, particle-steps, collisions, bounces.
    pub counts: [u64; 4],
    /// As text that tells any two values apart.
    pub audit: String,
}

/// The most mappings of compiled code of this process for each of its tests that run together. Mesa's lavapipe has some for each kernel that it
/// compiles, and keeps them: some eighty were seen with two tests together. But tens of thousands where that of 22.3 compiles a kernel anew at each dispatch,
/// and in the end no memory.
const MOST_MAPPINGS: usize = 500;

/// Where the system tells (Linux).
fn assert_kernels_are_compiled_once() {
    let Ok(mappings) = std::fs::read_to_string("/proc/self/maps") else { return };
    let is_code = |line: &&str| line.split_whitespace().nth(1).is_some_and(|rights| rights.contains('x'));
    let number = mappings.lines().filter(is_code).count();
    let together = std::thread::available_parallelism().map_or(1, usize::from);
    assert!(
        number < MOST_MAPPINGS * together,
        "{number} mappings of code: kernels are compiled anew on the way (INTERVAL in src/subdomain/registry.rs)"
    );
}

fn fabric_bytes(run: &Run) -> Vec<u8> {
    let fabric = &run.outcome.fabric;
    let velocities = fabric.fields.as_ref().map_or(&[][..], |fields| &fields.velocities);
    [bytemuck::cast_slice(&fabric.nodes), bytemuck::cast_slice(velocities)].concat()
}

impl Bits {
    pub fn of(run: &Run) -> Bits {
        assert_kernels_are_compiled_once();
        Bits {
            history: run.rows.iter().map(row_bits).collect(),
            state: run
                .snapshots
                .iter()
                .map(|(_, particles)| particles)
                .chain([&run.outcome.particles])
                .flat_map(|particles| bytemuck::cast_slice::<_, u8>(particles).to_vec())
                .chain(fabric_bytes(run))
                .collect(),
            counts: [run.outcome.steps, run.outcome.particle_steps, run.outcome.collisions, run.outcome.bounces],
            audit: format!(
                "{:?} {:?} {:?} {:?}",
                run.outcome.audit, run.outcome.step_range, run.outcome.warnings, run.outcome.continued
            ),
        }
    }
}

/// Where two runs part, or `None` if they are the same to the last bit.
pub fn difference(a: &Bits, b: &Bits) -> Option<String> {
    if let Some(row) = a.history.iter().zip(&b.history).position(|(a, b)| a != b) {
        return Some(format!("row {row}"));
    }
    if a.history.len() != b.history.len() || a.state.len() != b.state.len() {
        return Some("lengths".into());
    }
    if let Some(byte) = a.state.iter().zip(&b.state).position(|(a, b)| a != b) {
        return Some(format!("particle {}", byte / 32));
    }
    if a.counts != b.counts {
        return Some(format!("steps, particle-steps, collisions, bounces: {:?} and {:?}", a.counts, b.counts));
    }
    (a.audit != b.audit).then(|| format!("audit: {}\nand {}", a.audit, b.audit))
}

#[track_caller]
pub fn assert_same(name: &str, a: &Bits, b: &Bits) {
    assert_eq!(difference(a, b), None, "{name}");
}
