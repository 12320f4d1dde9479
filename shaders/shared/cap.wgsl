// The collision diameter, which follows the density where gas is dense (method.md, "Collisions"): of a pair the smaller
// of its two. What is left of a particle's cross-section there is in the upper half of its flight's `collisions`.

// The largest collision diameter, m.
override DIAMETER: f32;
override CAPPED: bool = false;

// Where all of it is left (`FULL_SHARE`, src/subdomain/encode.rs): a power of two, so that the largest diameter is exact.
const FULL_SHARE: u32 = 32768;
const SHARE_AT: u32 = 16;

fn share_of(flight: Flight) -> u32 {
    return flight.collisions >> SHARE_AT;
}

// The square of the diameter of a pair, m2.
fn diameter2(a: Flight, b: Flight) -> f32 {
    if (CAPPED) {
        return DIAMETER * DIAMETER * (f32(min(share_of(a), share_of(b))) / f32(FULL_SHARE));
    }
    return DIAMETER * DIAMETER;
}
