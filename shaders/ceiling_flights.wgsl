//! uses: thread.wgsl particle.wgsl rounded.wgsl
// The least that a step does with a particle, for `corpuscle bench`: reads it, moves it, writes where it is.
//
// Reads and writes `copy_to`. One thread per particle.

// Per metre, as in grid.wgsl.
override QUANTA: f32 = 1048576.0;

var<storage, read_write> copy_to: array<Packed>;

@compute @workgroup_size(WORKGROUP)
fn ceiling_flights(thread: Thread) {
    let k = linear(thread);
    if (k < arrayLength(&copy_to)) {
        let place = copy_to[k].position_tag;
        let moved = rounded(copy_to[k].motion.xyz * QUANTA);
        copy_to[k].position_tag = vec4<u32>(place.xyz + bitcast<vec3<u32>>(moved), place.w);
    }
}
