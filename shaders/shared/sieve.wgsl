//! uses: step.wgsl grid.wgsl particle.wgsl nearness.wgsl
// Whether a pair may collide in this step as it begins, told from the packed mid-step points: a sieve before the choices.
//
// Few neighbours do, and the choice among them is dear. Nothing that a choice would find may be lost: packed
// points are off by less than sqrt(3) units of 1/128 cell from each other, for which two are allowed, far more than any rounding
// takes. So it is of no matter how a driver rounds here, and whom else the sieve lets pass: those choose nobody. Starts
// of flights, walls, and what is left of a diameter can only forbid more.

// Rigid spheres, the method `hard-sphere`.
override RIGID: bool = false;

// By how many units two packed points may be off.
const PACKING: f32 = 2.0;

// Two packed mid-step points and their relative velocity.
fn may_collide(a: u32, b: u32, g: vec3<f32>) -> bool {
    let g2 = dot(g, g);
    // What lies beyond its cell is packed nearer than it is; and drivers may differ in what is too small to be normal.
    if (((a | b) & ASTRAY) != 0u || g2 < 1e-30) {
        return true;
    }
    let r = vec3<f32>(packed_between(a, b));
    let along = dot(r, g);
    let reach = sqrt(f32(DIAMETER2_PACKED + 1u)) + PACKING;
    // They are nearest within half a step from its middle; rigid spheres touch before that.
    let early = select(PACKING, reach, RIGID);
    let half = 0.5 * step.dt / (QUANTUM * f32(1u << (CELL_BITS - 7u)));
    return abs(along) <= g2 * half + early * sqrt(g2) && dot(r, r) * g2 - along * along <= reach * reach * g2;
}
