// Lists of rare work: a kernel that meets it appends, and one that does it is dispatched over exactly
// the list. (On a device that executes untaken branches under a mask, rare heavy branches would cost
// every thread.) The order of a list depends on the order of the threads; entries are independent.

// Lists 0 .. 8 are the pairs of the rounds (of the method `cell`, list 0 the cells that walls part, list 1 those
// that moving walls touch, list 2 the particles of cells that are put in order by themselves, list 3 the crowded cells); list ROUNDS counts the pairs that the rounds lost. Lists
// LIST_RECHOOSE + r are the particles that choose in round r. LIST_BORDER are the particles
// that other devices may need, LIST_CHANGED those of them that a round has changed, LIST_ASKED the ghosts that
// were asked for their choice; LIST_OUTBOX and
// LIST_UPDATES are the sendings of particles and of updates, COUNT_DROPPED counts the slots that hold no particle of this device or its halo.
const LIST_PARTED: u32 = 0;
const LIST_MOVED: u32 = 1;
const LIST_CROWDED: u32 = 2;
const LIST_CROWDS: u32 = 3;
// Only the number of those that may meet a wall in the step, who are in other lists.
const LIST_NEAR_WALLS: u32 = 9;
const LIST_INCOMPLETE: u32 = 10;
const LIST_BOUNCE: u32 = 11;
const LIST_BOUNCE_ODD: u32 = 27;
const LIST_BORDER: u32 = 12;
const LIST_CHANGED: u32 = 13;
const LIST_OUTBOX: u32 = 14;
const LIST_UPDATES: u32 = 15;
const LIST_RECHOOSE: u32 = 16;
const LIST_ASKED: u32 = 26;
// The entries of the tails of neighbour lists.
const LIST_TAILS: u32 = 29;
const COUNT_DROPPED: u32 = 31;
const LISTS: u32 = 32;

// Of the steps at even places in their interval, and of those at odd ones: `advect` empties the one that it does not fill.
fn bounces_of(slot: u32) -> u32 {
    return select(LIST_BOUNCE, LIST_BOUNCE_ODD, slot % 2u == 1u);
}

// Workgroups per dimension of an indirect dispatch.
const GROUP_LIMIT: u32 = 65535;

@group(0) @binding(4) var<storage, read_write> counters: array<atomic<u32>>;
@group(0) @binding(19) var<storage, read_write> dispatches: array<atomic<u32>>;

// (A kernel dispatched over one list may append to another, so `settle` and `settle_chosen`, which are dispatched over pairs and by no list, `pack`, over
// the border, and `order`, `neighbours` and `receive`, whose lists are dispatched like those that choose, are given the buffer `rechoose_dispatches` by this name, and `choose` the buffer `asked_dispatches`.)
//
// Makes sure that a list's dispatch has this workgroup.
fn cover(list: u32, group: u32) {
    atomicMax(&dispatches[3u * list], min(group + 1u, GROUP_LIMIT));
    atomicMax(&dispatches[3u * list + 1u], group / GROUP_LIMIT + 1u);
}

// The place of a new entry, which the list's dispatch covers.
fn append(list: u32) -> u32 {
    let k = atomicAdd(&counters[list], 1u);
    if (k % WORKGROUP == 0u) {
        cover(list, k / WORKGROUP);
    }
    return k;
}

// The same for a list whose entries have a workgroup each.
fn append_group(list: u32) -> u32 {
    let k = atomicAdd(&counters[list], 1u);
    cover(list, k);
    return k;
}
