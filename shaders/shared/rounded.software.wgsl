// The same by the bits of a whole number, digits and how far they are to be shifted: Mesa's software device (25.0, not 22.3) converts each of eight by itself.

// The exponent of a number whose last digit is that of ones.
const ONES: u32 = 150;

fn digits_of(bits: vec3<u32>) -> vec3<u32> {
    let exponent = (bits >> vec3<u32>(23u)) & vec3<u32>(255u);
    let digits = (bits & vec3<u32>(0x7fffffu)) | vec3<u32>(0x800000u);
    // One of both ways is none. Nothing is left of zero.
    let up = max(exponent, vec3<u32>(ONES)) - ONES;
    let down = min(ONES - min(exponent, vec3<u32>(ONES)), vec3<u32>(31u));
    return (digits << up) >> down;
}

fn rounded(x: vec3<f32>) -> vec3<i32> {
    // As far as integers go, as a conversion does.
    let bits = bitcast<vec3<i32>>(clamp(round(x), vec3<f32>(-2147483648.0), vec3<f32>(2147483520.0)));
    let sign = bits >> vec3<u32>(31u);
    return (bitcast<vec3<i32>>(digits_of(bitcast<vec3<u32>>(bits))) ^ sign) - sign;
}

fn rounded_unsigned(x: f32) -> u32 {
    return digits_of(vec3<u32>(bitcast<u32>(clamp(round(x), 0.0, 4294967040.0)))).x;
}
