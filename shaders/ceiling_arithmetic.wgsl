//! uses: thread.wgsl
// What the device's arithmetic gives: multiplications and additions in registers, for `corpuscle bench`.
//
// Writes `copy_to`. One thread per four words; LOOPS times 4 x 4 fused multiply-adds each.

override LOOPS: u32 = 256;

var<storage, read_write> copy_to: array<vec4<u32>>;

@compute @workgroup_size(WORKGROUP)
fn ceiling_arithmetic(thread: Thread) {
    let k = linear(thread);
    if (k >= arrayLength(&copy_to)) {
        return;
    }
    // Four chains, so that one does not wait for itself; the factors come from the thread, so that nothing is known before.
    let factor = vec4<f32>(0.999 + 1e-9 * f32(k));
    let term = vec4<f32>(1e-3 * f32(k & 7u));
    var a = vec4<f32>(0.1, 0.2, 0.3, 0.4);
    var b = a + term;
    var c = b + term;
    var d = c + term;
    // bench: arithmetic
    for (var i = 0u; i < LOOPS; i++) {
        a = fma(a, factor, term);
        b = fma(b, factor, term);
        c = fma(c, factor, term);
        d = fma(d, factor, term);
    }
    copy_to[k] = bitcast<vec4<u32>>(a + b + c + d);
}
