// The nearest whole numbers, of two as near the even one.

fn rounded(x: vec3<f32>) -> vec3<i32> {
    return vec3<i32>(round(x));
}

// Of one that is not negative.
fn rounded_unsigned(x: f32) -> u32 {
    return u32(round(x));
}
