//! uses: step.wgsl grid.wgsl particle.wgsl gas.wgsl add64.wgsl coarse.wgsl
//! binds: block_sums as sums
//! phase: blocks
// The local state that sets the step size: number and kinetic energy in coarse blocks of cells, and how
// many particles would cross more than CELLS_FLOWN cells at each step of the ladder.
//
// Reads `particles`; writes the integer tally `sums`: per block number (two words) and energy (two
// words), then the LEVELS counts of fast particles. One thread per particle. Sums of integers do not
// depend on order.

// Blocks in all.
override BLOCKS: u32;
// The ladder's largest step, s, and its number of levels.
override TIME_STEP: f32;
override LEVELS: u32;
// Cells that a particle may fly in a step.
override CELLS_FLOWN: f32 = 1.0;
// Kinetic energy over reference mass to tally units.
override BLOCK_ENERGY_SCALE: f32;

var<uniform> step: Step;
var<storage, read> stalled: array<u32>;
var<uniform> gases: array<Gas, 16>;
var<storage, read> particles: array<Particle>;
var<storage, read_write> counters: array<atomic<u32>>;
var<storage, read_write> sums: array<atomic<u32>>;

@compute @workgroup_size(WORKGROUP)
fn blocks(thread: Thread) {
    let i = linear(thread);
    if (i >= step.total || stalled[STALLED] > 0u) {
        return;
    }
    let particle = particles[i];
    if (particle.tag == NOBODY) {
        return;
    }
    let cell = nearest_cell(particle.position);
    let slot = block_of(cell) * BLOCK_WORDS;
    let speed2 = dot(particle.velocity, particle.velocity);
    let energy = 0.5 * gases[kind_of(particle.tag)].mass * speed2 * BLOCK_ENERGY_SCALE;
    if (energy >= 4.29e9) {
        atomicAdd(&counters[TALLY_OVERFLOW], 1u);
        return;
    }
    add64(slot + BLOCK_NUMBER, 1u, 0u);
    add64(slot + BLOCK_ENERGY, rounded_unsigned(energy), 0u);
    // Too fast at level l if |v| TIME_STEP / 2^l is more than CELLS_FLOWN cells.
    var reach = sqrt(speed2) * TIME_STEP * QUANTA / f32(1u << CELL_BITS);
    var level = 0u;
    while (reach > CELLS_FLOWN && level < LEVELS) {
        atomicAdd(&sums[BLOCK_WORDS * BLOCKS + level], 1u);
        reach *= 0.5;
        level++;
    }
}
