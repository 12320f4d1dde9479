// Where a particle's flight and its neighbour list are from the sort until the particles fly: in RECORD words of its own, the flight
// in the first four (particle.wgsl), the first DIRECT entries of the list behind it. Of a list that is longer the last of these holds its tail
// instead: entry k from there on is at tail + k, behind the records of all. So room is needed for what lists hold, not for the longest of all.
//
// Kernels that write lists have them as `neighbours` and write them word by word, since several threads write to one list (search.wgsl); the others have
// them as `flights` (listed.wgsl).

const RECORD: u32 = 8;
const DIRECT: u32 = 4;

// Where among all words entry k of a list is, of a long one only of the first.
fn direct_entry(s: u32, k: u32) -> u32 {
    return RECORD * s + (RECORD - DIRECT) + k;
}
