// Lets particles choose in a round, or again in the next one. `touched` has of each the last round of which it is in the list, plus one; 0 of
// one that has not been in any.

@group(0) @binding(28) var<storage, read_write> touched: array<atomic<u32>>;
@group(0) @binding(29) var<storage, read_write> rechoose: array<u32>;

fn to_choose(s: u32, round: u32) {
    if (atomicMax(&touched[s], round + 1u) <= round) {
        rechoose[append(LIST_RECHOOSE + round)] = s;
    }
}

fn touch(s: u32) {
    to_choose(s, step.round + 1u);
}
