// What a round did to a particle, on its way to the devices that have it as a ghost.

struct Update {
    particle: Particle,
    flight: Flight,
    // Its cell in the global grid (`cell_index`).
    cell: u32,
    pad: u32,
    pad2: u32,
    pad3: u32,
}

// Another device: the cells it owns. Its ghosts are in `step.depth` layers around them (halo.wgsl).
struct Peer {
    low: vec3<i32>,
    pad: u32,
    high: vec3<i32>,
    pad2: u32,
}

var<storage, read> peers: array<Peer>;

fn owns(peer: Peer, c: vec3<i32>, around: i32) -> bool {
    return all(c >= peer.low - around) && all(c < peer.high + around);
}

// The cell of `cell_index`.
fn global_cell(index: u32) -> vec3<u32> {
    let row = index / CELLS_X;
    return vec3<u32>(index % CELLS_X, row % CELLS_Y, row / CELLS_Y);
}
