//! uses: particle.wgsl newborn.wgsl cap.wgsl
// The flight with which a particle starts the step, of which no wall is known yet.

var<storage, read> sorted: array<Packed>;

fn first_flight(s: u32, share: u32) -> vec4<u32> {
    var start = 0.0;
    // Whether any enter: of every slot it is the same, but no branch asks a uniform alone for what changes (INTERVAL in src/subdomain/registry.rs).
    if (s < step.total * min(step.newborns, 1u)) {
        start = birth_time(id_of(sorted[s].position_tag.w));
    }
    return packed_flight(Flight(start, NEVER, NOBODY, share << SHARE_AT));
}
