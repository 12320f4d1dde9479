// Cells of the method `cell` with so few particles that a thread puts them in order by itself: at most MEMBERS, numbered as they lie.

const MEMBERS: u32 = 12;
// Bits of such a number.
const NUMBER_BITS: u32 = 4;
