// Lets particles choose again in the next round. `touched` has of each the last round of which it is in the list, plus one; 0 of
// one that has not been in any.

@group(0) @binding(28) var<storage, read_write> touched: array<atomic<u32>>;
@group(0) @binding(29) var<storage, read_write> rechoose: array<u32>;

fn touch(s: u32) {
    if (atomicMax(&touched[s], step.round + 2u) < step.round + 2u) {
        rechoose[append(LIST_RECHOOSE + step.round + 1u)] = s;
    }
}
