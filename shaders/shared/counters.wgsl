// Slots of the counters that the host reads some steps late (src/subdomain/counters.rs).

const PAIRS: u32 = 0;               // 0 .. 32: lengths of the lists of this step, see lists.wgsl (of lists in parts nothing, but of pairs for the sample of lost ones)
const COLLISIONS_LOW: u32 = 32;     // of the rounds since the last read, two words
const COLLISIONS_HIGH: u32 = 33;
const LOST: u32 = 34;               // lost pairs in the sampled steps
const SAMPLED: u32 = 35;            // collisions in the sampled steps
const TAILS_WANTED: u32 = 36;       // entries of the tails of neighbour lists where there was no room for all
const OUTSIDE: u32 = 37;            // particles found outside the vessel
const OVERSHOOT: u32 = 38;          // largest distance behind a wall, quanta
const TRUNCATED: u32 = 39;          // flights cut short after the last bounce
const TALLY_OVERFLOW: u32 = 40;     // values beyond the range of a tally
const CAPACITY_FAILED: u32 = 41;    // newborns that found no room
const BOUNCES: u32 = 42;            // wall hits since the last read
const BLOCKED: u32 = 43;            // pairs parted by a wall where they would have met
const FOREIGN: u32 = 44;            // pairs settled here that another device counts
const STRAYS: u32 = 45;             // particles whose owner, or who may need them, is none of the peers
const MISSING: u32 = 46;            // updates of ghosts that are not here
const CANDIDATES: u32 = 47;         // entries of the neighbour lists at the last step before the read
const MOVED: u32 = 48;              // particles that came from another owner since the last read
const FAST_PAIRS: u32 = 49;         // collisions of pairs faster than the plan's fastest since the last read
const GHOST_CANDIDATES: u32 = 50;    // of CANDIDATES those of ghosts
const GHOST_WALLS: u32 = 51;         // ghosts that may meet a wall in that step
const CUT_SHORT: u32 = 52;           // threads whose loops the device ended too soon (turns.wgsl)
// Collisions in cells since the last read, in COLLISION_COUNTS parts of two words, so that few threads count up the same word.
const CELL_COLLISIONS: u32 = 53;
const COLLISION_COUNTS: u32 = 32;
const MISPLACED: u32 = 117;          // entries of lists that found no place, and threads that were parted while they counted together (together.gpu.wgsl)
// The lengths of lists that are in parts (parted_lists.gpu.wgsl), by part, each part's so far from the next one's that another part of a GPU's cache has them.
const PARTS_OF_LISTS: u32 = 128;
const PART_WORDS: u32 = 64;
