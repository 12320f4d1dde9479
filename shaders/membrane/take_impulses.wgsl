//! uses: thread.wgsl membrane.wgsl
//! phase: membrane
// Takes what the gas gave each node in its last step, and clears it.
//
// Reads and clears `impulses`, writes `given` (kg m/s). One thread per node.

var<uniform> membrane_step: MembraneStep;
// Three sums of two words for each node.
var<storage, read_write> impulses: array<u32>;
var<storage, read_write> given: array<vec4<f32>>;

// A signed sum of two words.
fn impulse_word(slot: u32) -> f32 {
    let low = impulses[slot];
    let high = impulses[slot + 1u];
    impulses[slot] = 0u;
    impulses[slot + 1u] = 0u;
    let negative = high >= 0x80000000u;
    let size = select(vec2<u32>(low, high), vec2<u32>(~low + 1u, ~high + select(0u, 1u, low == 0u)), negative);
    let value = f32(size.y) * 4294967296.0 + f32(size.x);
    return select(value, -value, negative) * membrane_step.impulse_unit;
}

@compute @workgroup_size(WORKGROUP)
fn take_impulses(thread: Thread) {
    let k = linear(thread);
    if (k < membrane_step.nodes) {
        given[k] = vec4<f32>(impulse_word(6u * k), impulse_word(6u * k + 2u), impulse_word(6u * k + 4u), 0.0);
    }
}
