// Lets particles choose again in the next round.

@group(0) @binding(28) var<storage, read_write> touched: array<atomic<u32>>;
@group(0) @binding(29) var<storage, read_write> rechoose: array<u32>;

fn touch(s: u32) {
    if (atomicMax(&touched[s], step.round + 1u) <= step.round) {
        rechoose[append(LIST_RECHOOSE + step.round + 1u)] = s;
    }
}
