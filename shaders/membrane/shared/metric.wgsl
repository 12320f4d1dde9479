// Squares of edges less those of the reference, exactly: in integers of two words, the low one first. Of the two numbers, which agree in
// their first five digits where strains are small, floats would keep the last two alone.

// The product of two numbers below 2^31, two's complement.
fn product(a: i32, b: i32) -> vec2<u32> {
    let u = bitcast<u32>(a);
    let v = bitcast<u32>(b);
    let low = (u & 0xffffu) * (v & 0xffffu);
    let first = (u >> 16u) * (v & 0xffffu) + (low >> 16u);
    let second = (u & 0xffffu) * (v >> 16u) + (first & 0xffffu);
    let high = (u >> 16u) * (v >> 16u) + (first >> 16u) + (second >> 16u);
    // As an unsigned number a negative one is 2^32 too large.
    return vec2<u32>((second << 16u) | (low & 0xffffu), high - select(0u, v, a < 0) - select(0u, u, b < 0));
}

fn sum64(a: vec2<u32>, b: vec2<u32>) -> vec2<u32> {
    let low = a.x + b.x;
    return vec2<u32>(low, a.y + b.y + select(0u, 1u, low < a.x));
}

fn float64(number: vec2<u32>) -> f32 {
    let negative = number.y >= 0x80000000u;
    let opposite = vec2<u32>(~number.x + 1u, ~number.y + select(0u, 1u, number.x == 0u));
    let size = select(number, opposite, negative);
    let value = f32(size.y) * 4294967296.0 + f32(size.x);
    return select(value, -value, negative);
}

// a . b and a number.
fn dot64(a: vec3<i32>, b: vec3<i32>, more: vec2<u32>) -> f32 {
    return float64(sum64(sum64(product(a.x, b.x), product(a.y, b.y)), sum64(product(a.z, b.z), more)));
}
