// 64-bit sums in two words, in an array<atomic<u32>> named `sums`: the carry of the low word goes to
// the high one, so the result does not depend on the order of the additions.

fn add64(slot: u32, low: u32, high: u32) {
    let old = atomicAdd(&sums[slot], low);
    let carry = select(0u, 1u, old + low < old);
    if (high + carry != 0u) {
        atomicAdd(&sums[slot + 1u], high + carry);
    }
}

// Minus a number of two words.
fn negated(number: vec2<u32>) -> vec2<u32> {
    return vec2<u32>(~number.x + 1u, ~number.y + select(0u, 1u, number.x == 0u));
}
