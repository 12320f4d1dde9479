//! Flights and neighbour lists as the kernels keep them (`shaders/shared/neighbour_list.wgsl`), written and read by their definition; and
//! `complete_lists` by hand.

use corpuscle::subdomain::GpuFlight;

use crate::rig::*;

/// Entries of a list in its particle's record.
pub const DIRECT: usize = 4;
/// Room for the tails of a test's lists.
pub const TAILS: usize = 1 << 16;

/// Flights, whatever the lists are.
pub fn put_flights(rig: &mut Rig, flights: &[GpuFlight]) {
    rig.put_records(|records, _| {
        records.resize(flights.len(), [NOBODY; RECORD]);
        for (record, flight) in records.iter_mut().zip(flights) {
            record[..RECORD - DIRECT].copy_from_slice(bytemuck::cast_ref::<_, [u32; RECORD - DIRECT]>(flight));
        }
    });
}

pub fn flights(rig: &Rig, count: usize) -> Vec<GpuFlight> {
    rig.get::<[GpuFlight; 2]>("flights", count).into_iter().map(|[flight, _]| flight).collect()
}

/// Empty lists, with room for tails of so many entries.
pub fn put_room(rig: &mut Rig, count: usize, room: usize) {
    rig.put_records(|records, tails| {
        records.resize(count, [NOBODY; RECORD]);
        records.iter_mut().for_each(|record| record[RECORD - DIRECT..].fill(NOBODY));
        *tails = vec![NOBODY; room];
    });
    [LIST_TAILS, LIST_INCOMPLETE].into_iter().for_each(|list| rig.set_counter(list, 0));
    rig.set_choosers(0, 0);
}

pub fn put_lists(rig: &mut Rig, lists: &[Vec<u32>]) {
    rig.put_records(|records, tails| {
        records.resize(lists.len(), [NOBODY; RECORD]);
        tails.clear();
        for (record, list) in records.iter_mut().zip(lists) {
            let direct = if list.len() > DIRECT { DIRECT - 1 } else { list.len() };
            let entries = &mut record[RECORD - DIRECT..];
            entries[..direct].copy_from_slice(&list[..direct]);
            if list.len() > DIRECT {
                entries[direct] = (RECORD * lists.len() + tails.len() - direct) as u32;
                tails.extend(&list[direct..]);
            }
        }
    });
    rig.put("neighbour_count", &lists.iter().map(|list| list.len() as u32).collect::<Vec<_>>());
}

/// Of a rig with so many particles and so much room for tails.
pub fn lists(rig: &Rig, count: usize, tails: usize) -> Vec<Vec<u32>> {
    let words: Vec<u32> = rig.get("neighbours", RECORD * count + tails);
    let lengths: Vec<u32> = rig.get("neighbour_count", count);
    let list = |s: usize| -> Vec<u32> {
        let length = lengths[s] as usize;
        let first = RECORD * s + RECORD - DIRECT;
        let place = |k: usize| {
            if length <= DIRECT || k + 1 < DIRECT { first + k } else { words[first + DIRECT - 1] as usize + k }
        };
        (0..length).map(|k| words[place(k)]).collect()
    };
    (0..count).map(list).collect()
}

/// Runs the kernel over the particles of a list, those that are to be completed or those that were asked.
pub fn complete_lists(rig: &Rig, list: usize) {
    rig.run("complete_lists", rig.counter(list) as usize);
}

/// The particles whose flights or lists are to be completed, in ascending order.
pub fn to_complete_of(rig: &Rig) -> Vec<u32> {
    rig.list("incomplete", LIST_INCOMPLETE)
}

/// Makes these of so many the ones that are to be completed.
pub fn put_to_complete(rig: &mut Rig, count: usize, these: &[u32]) {
    let mut list = these.to_vec();
    list.resize(count, NOBODY);
    rig.put("incomplete", &list);
    rig.set_counter(LIST_INCOMPLETE, these.len() as u32);
}

/// How many entries the tails of such lists have.
pub fn tails_of(lengths: impl Iterator<Item = usize>) -> usize {
    lengths.filter(|&length| length > DIRECT).map(|length| length - (DIRECT - 1)).sum()
}
