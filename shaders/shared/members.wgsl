//! uses: crowds.wgsl
// Cells of the method `cell` that a thread puts in order by itself: of at most MEMBERS particles, numbered as they lie, and of more, where it has a network, by
// their slots, up to CROWD, counted from the slot of a multiple of four that is their first or before it.

const MEMBERS: u32 = 12;
// Bits of such a number.
const NUMBER_BITS: u32 = 4;
const CROWD: u32 = 64;

fn fits_a_thread(begin: u32, end: u32) -> bool {
    return end - begin <= MEMBERS || (NETWORKS && end - (begin & 0xfffffffcu) <= CROWD);
}
