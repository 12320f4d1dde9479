// A particle that enters in this step.

struct Newborn {
    particle: Particle,
    // Time of entry, s from the start of the step.
    start: f32,
}

var<storage, read> newborns: array<Newborn>;

// Whether particles enter anywhere.
override ORIFICES: bool = true;

// Whether this one enters in this step; those that do have the highest ids. (Where particles are dealt out by id, those between are
// others' newborns. An older id wraps to far more than the newborns of a step.)
fn is_newborn(id: u32) -> bool {
    return ORIFICES && id - step.newborn_first_id < step.newborns * step.stride;
}

// When a particle's flight starts: at its entry if it is a newborn of this step.
fn birth_time(id: u32) -> f32 {
    if (!is_newborn(id)) {
        return 0.0;
    }
    return newborns[step.newborn_offset + (id - step.newborn_first_id) / step.stride].start;
}
