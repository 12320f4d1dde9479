// Where the entries of a particle's neighbour list are in `neighbours`. The first DIRECT of all particles are interleaved,
// entry k of particle s at k * stride + s, where stride is the room for particles. Of a list that is longer the last of these
// holds its tail instead: entry k from there on is at tail + k, behind all that is interleaved. So room is needed for what
// lists hold, not for the longest of all.

const DIRECT: u32 = 8;

// The tail of a list with so many entries; of a short one nothing.
fn tail_of(s: u32, listed: u32, stride: u32) -> u32 {
    if (listed > DIRECT) {
        return neighbours[(DIRECT - 1u) * stride + s];
    }
    return 0u;
}

fn entry_of(s: u32, k: u32, listed: u32, stride: u32, tail: u32) -> u32 {
    return select(k * stride + s, tail + k, listed > DIRECT && k >= DIRECT - 1u);
}
