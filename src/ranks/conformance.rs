//! What every communicator must do, whatever joins its ranks.
//!
//! A check is called by all ranks at once and tells what went wrong; the checks can follow each other on one
//! communicator. The tests run them for each of its forms.

use super::{Communicator, RankError, agree};

/// A law and the check of it.
pub type Check = (&'static str, fn(&dyn Communicator) -> Result<(), String>);

/// What holds while nobody fails.
pub const CHECKS: &[Check] = &[
    ("ranks are numbered within their number, on their node too", numbering),
    ("messages between two ranks keep their order", order),
    ("messages may be empty", empty),
    ("messages may be 50 MB long, both ways at once", large),
    ("messages of any length may follow each other", lengths),
    ("all can send to all before anyone receives", all_pairs),
    ("random patterns of messages arrive whole", random_pattern),
    ("sums wrap and maxima are exact", reduction),
    ("several reductions may be under way with messages between", several_reductions),
    ("reductions of different lengths are an error on every rank", reduction_lengths),
    ("rank 0 gathers everyone's bytes", gathering),
    ("everyone gets everyone's bytes", all_gathering),
    ("everyone gets rank 0's bytes", broadcasting),
    ("nobody leaves a barrier before all have come", barrier),
    ("a message to oneself or to no rank is refused", wrong_ranks),
    ("equal facts agree", agreement),
    ("the first differing fact is named on every rank", disagreement),
    // Last, since the ticket that is refused is lost.
    ("reductions are finished in the order started", reduction_order),
];

fn same<T: PartialEq + std::fmt::Debug>(what: &str, found: T, expected: T) -> Result<(), String> {
    if found == expected { Ok(()) } else { Err(format!("{what}: found {found:?}, expected {expected:?}")) }
}

/// As [`same`] for what is too long to print.
fn same_bytes(what: &str, found: &[u8], expected: &[u8]) -> Result<(), String> {
    same(&format!("length of {what}"), found.len(), expected.len())?;
    let differing = found.iter().zip(expected).position(|(a, b)| a != b);
    differing.map_or(Ok(()), |at| Err(format!("{what} differs at byte {at}")))
}

fn told<T>(result: Result<T, RankError>) -> Result<T, String> {
    result.map_err(|error| error.to_string())
}

/// A generator of 64-bit numbers (Steele, Lea and Flood's SplitMix64): equal seeds, equal numbers on every rank.
struct Numbers(u64);

impl Numbers {
    fn next(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mixed = (self.0 ^ (self.0 >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        let mixed = (mixed ^ (mixed >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        mixed ^ (mixed >> 31)
    }

    fn below(&mut self, limit: usize) -> usize {
        (self.next() % limit as u64) as usize
    }
}

/// Bytes that tell sender, receiver and number of a message.
fn bytes(from: usize, to: usize, number: usize, length: usize) -> Vec<u8> {
    let mut numbers = Numbers((from * 1_000_003 + to * 1_009 + number) as u64);
    let mut bytes = Vec::with_capacity(length + 8);
    while bytes.len() < length {
        bytes.extend(numbers.next().to_le_bytes());
    }
    bytes.truncate(length);
    bytes
}

fn others(comm: &dyn Communicator) -> impl Iterator<Item = usize> + use<> {
    let own = comm.rank();
    (0..comm.size()).filter(move |&rank| rank != own)
}

fn numbering(comm: &dyn Communicator) -> Result<(), String> {
    let bound =
        |what: &str, number, size| if number < size { Ok(()) } else { Err(format!("{what} {number} of {size}")) };
    bound("rank", comm.rank(), comm.size())?;
    bound("rank of the node", comm.node_rank(), comm.node_size())?;
    let own = (comm.rank() as u64).to_le_bytes().to_vec();
    let expected: Vec<Vec<u8>> = (0..comm.size() as u64).map(|rank| rank.to_le_bytes().to_vec()).collect();
    same("ranks", told(comm.all_gather(own))?, expected)
}

fn order(comm: &dyn Communicator) -> Result<(), String> {
    const MESSAGES: usize = 20;
    // Short and long ones by turns, which MPI sends by different ways.
    let length = |number: usize| if number % 3 == 2 { 20_000 } else { number };
    for number in 0..MESSAGES {
        for dest in others(comm) {
            told(comm.send(dest, bytes(comm.rank(), dest, number, length(number))))?;
        }
    }
    for source in others(comm) {
        for number in 0..MESSAGES {
            let expected = bytes(source, comm.rank(), number, length(number));
            same_bytes(&format!("message {number} of rank {source}"), &told(comm.receive(source))?, &expected)?;
        }
    }
    Ok(())
}

fn empty(comm: &dyn Communicator) -> Result<(), String> {
    for dest in others(comm) {
        told(comm.send(dest, Vec::new()))?;
        told(comm.send(dest, vec![7]))?;
    }
    for source in others(comm) {
        same("an empty message", told(comm.receive(source))?, Vec::new())?;
        same("the next message", told(comm.receive(source))?, vec![7])?;
    }
    Ok(())
}

fn large(comm: &dyn Communicator) -> Result<(), String> {
    const LENGTH: usize = 50_000_000;
    // Only the first two: it is the length that is tested.
    let other = 1 - comm.rank().min(1);
    if comm.size() < 2 || comm.rank() > 1 {
        return Ok(());
    }
    told(comm.send(other, bytes(comm.rank(), other, 0, LENGTH)))?;
    same_bytes("a large message", &told(comm.receive(other))?, &bytes(other, comm.rank(), 0, LENGTH))
}

/// Lengths that grow, stay and shrink by a lot, sent before any of them is received.
fn lengths(comm: &dyn Communicator) -> Result<(), String> {
    const LENGTHS: [usize; 12] = [0, 4094, 4095, 4096, 4097, 1_000_000, 1_300_000, 1_300_000, 7, 0, 90_000_000, 5000];
    let other = 1 - comm.rank().min(1);
    if comm.size() < 2 || comm.rank() > 1 {
        return Ok(());
    }
    for (k, &length) in LENGTHS.iter().enumerate() {
        told(comm.send(other, bytes(comm.rank(), other, k, length)))?;
    }
    for (k, &length) in LENGTHS.iter().enumerate() {
        let expected = bytes(other, comm.rank(), k, length);
        same_bytes(&format!("message {k} of a growing row"), &told(comm.receive(other))?, &expected)?;
    }
    Ok(())
}

fn all_pairs(comm: &dyn Communicator) -> Result<(), String> {
    let length = 300_000 / comm.size();
    for dest in others(comm) {
        told(comm.send(dest, bytes(comm.rank(), dest, 0, length)))?;
    }
    for source in others(comm) {
        let expected = bytes(source, comm.rank(), 0, length);
        same_bytes(&format!("the message of rank {source}"), &told(comm.receive(source))?, &expected)?;
    }
    Ok(())
}

fn random_pattern(comm: &dyn Communicator) -> Result<(), String> {
    const ROUNDS: usize = 20;
    let (own, size) = (comm.rank(), comm.size());
    if size < 2 {
        return Ok(());
    }
    let mut numbers = Numbers(2_024);
    for round in 0..ROUNDS {
        let messages: Vec<(usize, usize, usize)> = (0..numbers.below(4 * size))
            .map(|_| {
                let from = numbers.below(size);
                let to = (from + 1 + numbers.below(size - 1)) % size;
                let longest = 1 << numbers.below(16);
                (from, to, numbers.below(longest))
            })
            .collect();
        for &(from, to, length) in messages.iter().filter(|message| message.0 == own) {
            told(comm.send(to, bytes(from, to, round, length)))?;
        }
        for &(from, to, length) in messages.iter().filter(|message| message.1 == own) {
            same_bytes(
                &format!("a message of round {round}"),
                &told(comm.receive(from))?,
                &bytes(from, to, round, length),
            )?;
        }
    }
    Ok(())
}

fn reduction(comm: &dyn Communicator) -> Result<(), String> {
    let (own, size) = (comm.rank() as u64, comm.size() as u64);
    // What is short for one reduction may be long for the next, and the other way round.
    for length in [0, 1, 63, 64, 65, 1_000, 1_000, 65, 0, 20_000, 20_000, 3] {
        let lists = |rank: u64| -> (Vec<u64>, Vec<u64>) {
            let mut numbers = Numbers(rank);
            let sums: Vec<u64> = (0..length).map(|_| numbers.next()).collect();
            (sums, (0..length / 2).map(|_| numbers.next()).collect())
        };
        let (mut sums, mut maxima) = lists(0);
        for rank in 1..size {
            let (more, most) = lists(rank);
            sums.iter_mut().zip(more).for_each(|(sum, value)| *sum = sum.wrapping_add(value));
            maxima.iter_mut().zip(most).for_each(|(old, value)| *old = value.max(*old));
        }
        let (own_sums, own_maxima) = lists(own);
        let started = told(comm.start_reduction(own_sums, own_maxima))?;
        same("sums and maxima", told(comm.finish_reduction(started))?, (sums, maxima))?;
    }
    same("sum", told(comm.sum(vec![1, own]))?, vec![size, size * (size - 1) / 2])?;
    same("maximum", told(comm.maximum(vec![own, 9]))?, vec![size - 1, 9])
}

fn several_reductions(comm: &dyn Communicator) -> Result<(), String> {
    const REDUCTIONS: usize = 5;
    let size = comm.size();
    let length = |number: usize| 1 + 40 * number;
    let mut started = Vec::new();
    for number in 0..REDUCTIONS {
        started.push(told(comm.start_reduction(vec![number as u64; length(number)], vec![comm.rank() as u64]))?);
        for dest in others(comm) {
            told(comm.send(dest, vec![number as u8]))?;
        }
        if number == 2 {
            told(comm.barrier())?;
        }
    }
    for (number, reduction) in started.into_iter().enumerate() {
        let expected = (vec![(number * size) as u64; length(number)], vec![size as u64 - 1]);
        same("a reduction", told(comm.finish_reduction(reduction))?, expected)?;
        for source in others(comm) {
            same("a message between", told(comm.receive(source))?, vec![number as u8])?;
        }
    }
    Ok(())
}

/// Where reductions are started and finished in different orders, the first error is the caller's, and final.
fn reduction_order(comm: &dyn Communicator) -> Result<(), String> {
    let first = told(comm.start_reduction(vec![1], vec![]))?;
    let second = told(comm.start_reduction(vec![2], vec![]))?;
    let early = comm.finish_reduction(second);
    if !matches!(early, Err(RankError::Order { .. })) {
        return Err(format!("the second reduction was finished first: {early:?}"));
    }
    same("the first", told(comm.finish_reduction(first))?.0, vec![comm.size() as u64])
}

fn reduction_lengths(comm: &dyn Communicator) -> Result<(), String> {
    let own = comm.rank();
    let last = comm.size() - 1;
    let mut found = Vec::new();
    for (sums, maxima) in [(own, 0), (0, 1_000 * own), (own, last - own)] {
        let started = told(comm.start_reduction(vec![1; sums], vec![1; maxima]))?;
        found.push(comm.finish_reduction(started).err());
    }
    let lengths = |sums: [usize; 2], maxima: [usize; 2]| RankError::Lengths {
        shortest_sums: sums[0] as u64,
        longest_sums: sums[1] as u64,
        shortest_maxima: maxima[0] as u64,
        longest_maxima: maxima[1] as u64,
    };
    let all = [lengths([0, last], [0, 0]), lengths([0, 0], [0, 1_000 * last]), lengths([0, last], [0, last])];
    let expected: Vec<Option<RankError>> = all.into_iter().map(|error| (last > 0).then_some(error)).collect();
    same("errors", found, expected)?;
    same("the next reduction", told(comm.sum(vec![1]))?, vec![comm.size() as u64])
}

/// What rank `rank` contributes to a gathering: of different lengths, rank 1 nothing.
fn share(rank: usize) -> Vec<u8> {
    bytes(rank, rank, 0, if rank == 1 { 0 } else { 1_000 * (rank % 7) + 3 })
}

fn gathering(comm: &dyn Communicator) -> Result<(), String> {
    let expected = (comm.rank() == 0).then(|| (0..comm.size()).map(share).collect::<Vec<_>>());
    same("gathered", told(comm.gather(share(comm.rank())))?, expected)
}

fn all_gathering(comm: &dyn Communicator) -> Result<(), String> {
    let expected: Vec<Vec<u8>> = (0..comm.size()).map(share).collect();
    same("gathered", told(comm.all_gather(share(comm.rank())))?, expected)
}

fn broadcasting(comm: &dyn Communicator) -> Result<(), String> {
    // Nothing, from a vector that never held anything.
    same("nothing", told(comm.broadcast(Vec::new()))?, Vec::new())?;
    for length in [0, 1, 100_000] {
        let found = told(comm.broadcast(bytes(comm.rank(), 0, 0, length + comm.rank())))?;
        same_bytes("rank 0's bytes", &found, &bytes(0, 0, 0, length))?;
    }
    Ok(())
}

/// A message sent before the barrier is there after it: nothing more can be seen without a clock. So the ranks
/// come in turn, each told by the one before, and the last has come before any leaves.
fn barrier(comm: &dyn Communicator) -> Result<(), String> {
    let (own, size) = (comm.rank(), comm.size());
    for _ in 0..3 {
        if own > 0 {
            same("the turn", told(comm.receive(own - 1))?, vec![1])?;
        }
        if own + 1 < size {
            told(comm.send(own + 1, vec![1]))?;
        }
        told(comm.barrier())?;
    }
    Ok(())
}

fn wrong_ranks(comm: &dyn Communicator) -> Result<(), String> {
    let (rank, size) = (comm.rank(), comm.size());
    let nobody = RankError::NoSuchRank { rank: size, size };
    same("to nobody", comm.send(size, vec![1]), Err(nobody.clone()))?;
    same("from nobody", comm.receive(size), Err(nobody))?;
    same("to oneself", comm.send(rank, vec![1]), Err(RankError::Oneself { rank }))?;
    same("from oneself", comm.receive(rank), Err(RankError::Oneself { rank }))
}

fn agreement(comm: &dyn Communicator) -> Result<(), String> {
    told(agree(comm, &[("version", "1".to_owned()), ("scene", "tank\n".repeat(1_000))]))
}

fn disagreement(comm: &dyn Communicator) -> Result<(), String> {
    let rank = comm.rank();
    // The last rank differs in the first fact, all in the second, from rank 1 on.
    let last = comm.size() - 1;
    let scene = format!("{}, particles = {}", "vessel ".repeat(100), 1_000 + rank / last.max(1));
    let result = agree(comm, &[("version", "1".to_owned()), ("scene", scene), ("adapter", format!("GPU {rank}"))]);
    if last == 0 {
        return told(result);
    }
    let error = result.err().ok_or("the ranks agree on different facts")?;
    let RankError::Disagreement { name, expected, rank, found } = &error else { return Err(error.to_string()) };
    same("the fact", name.as_str(), "scene")?;
    same("the rank", *rank, last)?;
    if !expected.ends_with("particles = 1000`") || !found.ends_with("particles = 1001`") || found.len() > 100 {
        return Err(format!("the values are not told apart or too long: {expected}, {found}"));
    }
    Ok(())
}
