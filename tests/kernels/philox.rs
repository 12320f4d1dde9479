//! The device's Philox, alone in a probe, is the published function.

use crate::oracle::random::{Stream, philox};
use crate::probe::Probe;
use crate::rig::device;

const PROBE: &str = "
@group(0) @binding(0) var<storage, read> inputs: array<u32>;
@group(0) @binding(1) var<storage, read_write> outputs: array<vec4<u32>>;

@compute @workgroup_size(64)
fn probe(@builtin(global_invocation_id) id: vec3<u32>) {
    let at = 6u * id.x;
    let counter = vec4<u32>(inputs[at], inputs[at + 1u], inputs[at + 2u], inputs[at + 3u]);
    outputs[id.x] = philox(counter, vec2<u32>(inputs[at + 4u], inputs[at + 5u]));
}
";

#[test]
fn the_device_draws_the_published_philox() {
    let count = 64 * 64;
    let mut stream = Stream::new(40);
    let mut inputs: Vec<u32> = (0..6 * count).map(|_| stream.word()).collect();
    // The extremes: carries of the split multiplication.
    inputs[..6].fill(0);
    inputs[6..12].fill(u32::MAX);
    inputs[12..18].copy_from_slice(&[0xffff, 0xffff_0000, 0x1_0000, 0x8000_8000, 1, u32::MAX]);
    let text = include_str!("../../shaders/shared/philox.wgsl").to_owned() + PROBE;
    let probe = Probe::new(text, &[("SEED_LOW", 0.0), ("SEED_HIGH", 0.0)]);
    let outputs = probe.run(device(), &inputs, count, [64, 1, 1]);
    for (input, output) in inputs.chunks_exact(6).zip(outputs) {
        let (counter, key) = ([input[0], input[1], input[2], input[3]], [input[4], input[5]]);
        assert_eq!(output, philox(counter, key), "{counter:?} {key:?}");
        assert_ne!(output, philox(counter, [key[0] ^ 1, key[1]]), "the check can fail");
    }
}
