// Philox 4x32-10 (Salmon, Moraes, Dror, Shaw 2011): a random number is a function of its key alone.

override SEED_LOW: u32;
// The upper part of the seed, shifted left by 8, or'ed with the purpose of the draw.
override SEED_HIGH: u32;

fn multiply_high(a: u32, b: u32) -> u32 {
    let a0 = a & 0xffffu;
    let a1 = a >> 16u;
    let b0 = b & 0xffffu;
    let b1 = b >> 16u;
    let middle = a1 * b0 + ((a0 * b0) >> 16u);
    let carry = a0 * b1 + (middle & 0xffffu);
    return a1 * b1 + (middle >> 16u) + (carry >> 16u);
}

fn philox(counter: vec4<u32>, key: vec2<u32>) -> vec4<u32> {
    var c = counter;
    var k = key;
    for (var round = 0u; round < 10u; round++) {
        let high = vec2<u32>(multiply_high(0xD2511F53u, c.x), multiply_high(0xCD9E8D57u, c.z));
        let low = vec2<u32>(0xD2511F53u * c.x, 0xCD9E8D57u * c.z);
        c = vec4<u32>(high.y ^ c.y ^ k.x, low.y, high.x ^ c.w ^ k.y, low.x);
        k += vec2<u32>(0x9E3779B9u, 0xBB67AE85u);
    }
    return c;
}

// Uniform in (0, 1): 24 bits and a half, never 0 or 1.
fn unit_interval(word: u32) -> f32 {
    return (f32(word >> 8u) + 0.5) * 5.9604645e-8;
}
