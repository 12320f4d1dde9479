// A particle that enters in this step.

struct Newborn {
    particle: Particle,
    // Time of entry, s from the start of the step.
    start: f32,
}

@group(0) @binding(3) var<storage, read> newborns: array<Newborn>;

// When a particle's flight starts: at its entry if it is a newborn of this step.
fn birth_time(id: u32) -> f32 {
    var birth = id - step.newborn_first_id;
    if (step.stride > 1u) {
        // Where particles are dealt out by id. (An older id wraps to far more than the newborns of a step.)
        birth /= step.stride;
    }
    if (birth < step.newborns) {
        return newborns[step.newborn_offset + birth].start;
    }
    return 0.0;
}
