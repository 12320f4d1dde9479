// How near two particles must be, in 1/128 cells between their packed mid-step points, to meet in this step
// (src/subdomain/nearness.rs): nearer by what the smaller diameter lacks where gas is dense (cap.wgsl).

// The square of the largest diameter, rounded down.
override DIAMETER2_PACKED: u32;

// The square of the distance below which a particle with this share of the cross-section may collide.
fn near2(share: u32) -> i32 {
    return i32(step.near2) - i32((DIAMETER2_PACKED * (FULL_SHARE - share)) / FULL_SHARE);
}
