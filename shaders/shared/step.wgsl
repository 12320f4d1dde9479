//! uses: thread.wgsl
// The parameters of one step.

struct Step {
    // Slots of `particles` in use before this step's newborns. On a device among others some of them are
    // dead (their tag is NOBODY): ghosts of the step before.
    count: u32,
    newborns: u32,
    // Where this step's newborns start in the batch's list.
    newborn_offset: u32,
    // Ids of this step's newborns: first .. first + newborns.
    newborn_first_id: u32,
    // Steps since the start of the run: the key of random numbers.
    index: u32,
    // Length of the step, s.
    dt: f32,
    // Round of this dispatch.
    round: u32,
    // Particles that came from other devices, after the newborns.
    arrivals: u32,
    // The box of cells that have bins here: the own ones, the halo, and a border layer that stays empty.
    low: vec3<u32>,
    // Entries of `sorted`.
    total: u32,
    size: vec3<u32>,
    // Cells in that box.
    bins: u32,
    // The cells whose particles this device owns.
    own_low: vec3<u32>,
    // Layers of cells around them, and links of chains of neighbours from them, with ghosts (halo.wgsl); 0 on a device alone.
    depth: u32,
    own_high: vec3<u32>,
    // Layers of ghosts (halo.wgsl) up to which the pairs of this round are settled here.
    reach: u32,
    // Cells that no other device has in its halo.
    inner_low: vec3<u32>,
    // The first slot to bin.
    first: u32,
    inner_high: vec3<u32>,
    // Which ghosts choose partners, and in which pass: see on_demand.wgsl.
    ghosts: u32,
    // Entries of `peers`, and how many of them, the first, have ghosts of particles of this device.
    peers: u32,
    near_peers: u32,
    // Room for particles.
    capacity: u32,
    // Distance of the ids of two newborns.
    stride: u32,
    // Tallies of the zones in this interval at the end of this step or later.
    tallies_left: u32,
    // Place of the step in its interval.
    slot: u32,
    // The square of the distance, in 1/128 cells, below which two particles of the largest diameter may meet.
    near2: u32,
    // Layers of cells around the own ones beyond which particles stray; 0 where all other devices are peers, or none has ghosts.
    flight: u32,
    // Newborns of the step that follows in the interval, where particles are counted for it as they fly (binned.wgsl).
    next_newborns: u32,
    // The number of the step modulo 6, which tells where the tiles of the method `half-turn` lie, and that of the step that follows.
    lattice: u32,
    next_lattice: u32,
    // The box of cells in which triangles of fabric are listed: the own ones, and as many around as flights come to (sheets.wgsl); all on a device alone.
    fabric_low: vec3<u32>,
    fabric_size: vec3<u32>,
}

// `ghosts`: all of them choose; the outermost wait; the pass over those that were asked.
const GHOSTS_ALL: u32 = 0;
const GHOSTS_WAIT: u32 = 1;
const GHOSTS_ON_DEMAND: u32 = 2;
