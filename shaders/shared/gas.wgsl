// What the device knows of a gas.

struct Gas {
    // Over the reference mass.
    mass: f32,
    // Exchange probability P; 0 for a gas without spin.
    exchange: f32,
    // 1/beta and 1/(beta + 1), beta = zeta/2.
    inverse_beta: f32,
    inverse_beta1: f32,
}

override GASES: u32;

// Of a particle by its tag; of one gas alone no tag is asked.
fn kind_of(tag: u32) -> u32 {
    return select(gas_of(tag), 0u, GASES == 1u);
}
