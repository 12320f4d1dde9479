//! What kernels have several variants of is the same in each, to the last bit.

use corpuscle::gpu::{Device, KernelVariant};
use corpuscle::subdomain::places_in_shards;

use crate::oracle::random::Stream;
use crate::probe::Probe;
use crate::rig::{LENGTHS_OF_SHARDS, LIST_SHARDS, MISPLACED, SHARD_WORDS, device, numbers};

const ROUNDED: [&str; 2] =
    [include_str!("../../shaders/shared/rounded.wgsl"), include_str!("../../shaders/shared/rounded.software.wgsl")];
const OF_ROUNDED: &str = "
@group(0) @binding(0) var<storage, read> inputs: array<f32>;
@group(0) @binding(1) var<storage, read_write> outputs: array<vec4<u32>>;

@compute @workgroup_size(64)
fn probe(@builtin(global_invocation_id) id: vec3<u32>) {
    let x = inputs[id.x];
    let signed = bitcast<vec3<u32>>(rounded(vec3<f32>(x, -x, 0.5 * x)));
    outputs[id.x] = vec4<u32>(signed, rounded_unsigned(abs(x)));
}
";

const LANES: [&str; 2] =
    [include_str!("../../shaders/shared/lane.wgsl"), include_str!("../../shaders/shared/lane.software.wgsl")];
const OF_LANES: &str = "
@group(0) @binding(0) var<storage, read> inputs: array<f32>;
@group(0) @binding(1) var<storage, read_write> outputs: array<vec4<u32>>;

@compute @workgroup_size(WORKGROUP)
fn probe(thread: Thread) {
    let k = linear(thread);
    outputs[k] += vec4<u32>(group_of(thread), lane_of(thread), groups_of(thread), 1u);
}
";

#[test]
fn whole_numbers_are_the_nearest_in_either_form() {
    let mut stream = Stream::new(41);
    // Halves and their neighbours, the ends of the integers and what lies beyond, nothing, and numbers of any size.
    let mut inputs = vec![0.0, -0.0, 1e-40, 0.25, 2_147_483_520.0, -2_147_483_648.0, 4_294_967_040.0, 1e10, -3e38];
    for half in (0..40).map(|k| k as f32 + 0.5).chain((1..31).map(|bits| (1u32 << bits) as f32)) {
        inputs.extend([half, half.next_up(), half.next_down(), -half]);
    }
    while inputs.len() < 64 * 256 {
        let exponent = 90 + stream.word() % 78;
        inputs.push(f32::from_bits((stream.word() & 0x807f_ffff) | (exponent << 23)));
    }
    let outputs = ROUNDED.map(|variant| {
        Probe::new(variant.to_owned() + OF_ROUNDED, &[]).run(device(), &inputs, inputs.len(), [256, 1, 1])
    });
    for (k, &x) in inputs.iter().enumerate() {
        // Beyond the integers it is the last of them that 32 bits of floating point hold.
        let nearest = |x: f32| x.round_ties_even().clamp(-2_147_483_648.0, 2_147_483_520.0) as i32 as u32;
        let size = x.abs().round_ties_even().min(4_294_967_040.0) as u32;
        for output in &outputs {
            assert_eq!(output[k], [nearest(x), nearest(-x), nearest(0.5 * x), size], "{x:e}");
        }
    }
    // The check can fail: with numbers rounded away from zero, or toward it.
    assert!(inputs.iter().any(|x| x.round_ties_even() != x.round() && x.trunc() != x.round()));
}

#[test]
fn every_thread_has_a_number_of_its_own_in_either_form() {
    let groups = [5, 3, 1];
    let variants = 1 + usize::from(device().adapter().variants().contains(&KernelVariant::Software));
    for lane in &LANES[..variants] {
        let text = (*lane).to_owned() + include_str!("../../shaders/shared/thread.wgsl") + OF_LANES;
        for (k, output) in (0..).zip(Probe::new(text, &[]).run(device(), &[0.0f32], 64 * 15, groups)) {
            assert_eq!(output, [k / 64, k % 64, 15, 1]);
        }
    }
}

/// A device takes the variant that it says, and can be had with any that it can run.
#[test]
fn a_device_takes_its_form_of_a_kernel() {
    let text = |variant: u32| {
        format!(
            "@group(0) @binding(0) var<storage, read> inputs: array<f32>;
            @group(0) @binding(1) var<storage, read_write> outputs: array<vec4<u32>>;
            @compute @workgroup_size(1)
            fn probe() {{ outputs[0] = vec4<u32>({variant}u, bitcast<u32>(inputs[0]), 0u, 0u); }}"
        )
    };
    let variant = |device: &Device| {
        let probe = Probe::new(text(1), &[]).or([text(2), text(3)]);
        probe.run(device, &[0.0f32], 1, [1, 1, 1])[0][0]
    };
    let number = |variant| match variant {
        KernelVariant::Plain => 1,
        KernelVariant::Software => 2,
        KernelVariant::Gpu => 3,
    };
    let variants = device().adapter().variants();
    assert_eq!(device().variant(), variants[0]);
    for of in [KernelVariant::Plain, KernelVariant::Software, KernelVariant::Gpu] {
        match Device::open_in(None, of) {
            Ok(device) => assert_eq!((variant(&device), device.variant()), (number(of), of)),
            Err(error) => assert!(!variants.contains(&of), "{error}"),
        }
    }
    // Lavapipe can run all: else other tests would compare a variant with itself.
    assert!(variants.len() == 3 || !device().adapter().info.name.contains("llvmpipe"));
}

const TOGETHER: [&str; 2] =
    [include_str!("../../shaders/shared/together.wgsl"), include_str!("../../shaders/shared/together.gpu.wgsl")];
const OF_TOGETHER: &str = "
@group(0) @binding(0) var<storage, read> inputs: array<u32>;
@group(0) @binding(1) var<storage, read_write> outputs: array<vec4<u32>>;

@compute @workgroup_size(64)
fn probe(@builtin(global_invocation_id) id: vec3<u32>) {
    let count = inputs[id.x];
    if (count % 5u != 4u) {
        outputs[id.x] = vec4<u32>(counted_up(1u, count), count, 0u, 1u);
    }
}
";
const OF_TOGETHER_IN_TURNS: &str = "
@group(0) @binding(0) var<storage, read> inputs: array<u32>;
@group(0) @binding(1) var<storage, read_write> outputs: array<vec4<u32>>;

fn counted(k: u32, count: u32, first: u32) {
    outputs[k] = vec4<u32>(first, count, 0u, 1u);
}

@compute @workgroup_size(64)
fn probe(@builtin(global_invocation_id) id: vec3<u32>) {
    let own = inputs[id.x];
    if (own == 0u) {
        return;
    }
    // As the search enters pairs, and what a collision touches.
    var k = 8u * id.x;
    var left = own;
    while (left > 0u) {
        left--;
        k++;
        if ((own + left) % 3u == 1u) {
            continue;
        }
        counted(k - 1u, left % 3u, counted_up(1u, left % 3u));
    }
    for (var turn = 0u; turn < own % 4u; turn++) {
        if (own > 5u && turn == 1u) {
            break;
        }
        // (Nobody else's.)
        if (k < 8u * id.x + 8u) {
            counted(k, own + turn, counted_up(1u, own + turn));
            k++;
        }
    }
}
";

/// Threads that count up one word together have each their own part of what they count, and leave nothing out.
#[test]
fn what_threads_count_together_is_what_each_counts() {
    let variants = 1 + usize::from(device().adapter().variants().contains(&KernelVariant::Gpu));
    let mut stream = Stream::new(43);
    let inputs: Vec<u32> = (0..64 * 40).map(|_| stream.word() % 9).collect();
    for (variant, (kernel, outputs)) in TOGETHER[..variants]
        .iter()
        .flat_map(|variant| [(variant, (OF_TOGETHER, 1)), (variant, (OF_TOGETHER_IN_TURNS, 8))])
    {
        // The word is one behind the threads' own.
        let word = "@group(0) @binding(2) var<storage, read_write> counters: array<atomic<u32>>;\n";
        let text = word.to_owned() + &numbers() + &variant.replace("//!", "//") + kernel;
        let (outputs, counters) =
            Probe::new(text, &[]).run_and_count(device(), &inputs, outputs * inputs.len(), [40, 1, 1]);
        assert_eq!(counters[MISPLACED], 0, "threads were parted");
        let counting: u32 = outputs.iter().filter(|[.., done]| *done == 1).map(|[_, count, ..]| count).sum();
        let mut parts: Vec<[u32; 2]> = outputs
            .iter()
            .filter(|[.., done]| *done == 1)
            .filter(|[_, count, ..]| *count > 0)
            .map(|&[first, count, ..]| [first, count])
            .collect();
        parts.sort_unstable();
        let end = parts.iter().fold(0, |end, &[first, count]| {
            assert_eq!(first, end, "one behind the other");
            first + count
        });
        assert_eq!((end, counters[1]), (counting, counting));
        // The check can fail: they count.
        assert!(counting > 1000, "{counting}");
    }
}

const OF_SHARDS: &str = "
fn cover(list: u32, group: u32) {
    atomicMax(&counters[0], group + 1u);
}

@group(0) @binding(0) var<storage, read> inputs: array<u32>;
@group(0) @binding(1) var<storage, read_write> outputs: array<vec4<u32>>;

@compute @workgroup_size(WORKGROUP)
fn probe(@builtin(global_invocation_id) id: vec3<u32>) {
    let most = arrayLength(&inputs);
    // All to one part, which has no room for them.
    let thread = id.x % WORKGROUP + id.x / WORKGROUP * (WORKGROUP * LIST_SHARDS);
    let number = entries_from(7u, 1u, thread, most);
    outputs[id.x] = vec4<u32>(entry_place(number, 7u, thread, most), room_of_shard(most), inputs[id.x], 1u);
}
";

/// What a part of a list has no room for goes to others: each entry has a place of its own, within the room of the list.
#[test]
fn what_a_shard_has_no_room_for_goes_to_others() {
    if !device().adapter().variants().contains(&KernelVariant::Gpu) {
        return;
    }
    let count = 64 * 40;
    let text = [
        "override WORKGROUP: u32 = 64;\n",
        "@group(0) @binding(2) var<storage, read_write> counters: array<atomic<u32>>;\n",
        &numbers(),
        include_str!("../../shaders/shared/together.gpu.wgsl"),
        include_str!("../../shaders/shared/list_shards.gpu.wgsl"),
        include_str!("../../shaders/shared/sharded_lists.gpu.wgsl"),
        OF_SHARDS,
    ];
    let text = text.map(|part| part.replace("//!", "//")).concat();
    let (outputs, counters) =
        Probe::new(text.clone(), &[]).run_and_count(device(), &vec![0u32; count], count, [40, 1, 1]);
    // Each is counted once.
    let lengths = (0..LIST_SHARDS).map(|part| counters[LENGTHS_OF_SHARDS + part * SHARD_WORDS + 7] as usize);
    assert_eq!((lengths.sum::<usize>(), counters[MISPLACED]), (count, 0));
    let room = outputs[0][1] as usize;
    let mut places: Vec<usize> = outputs.iter().map(|output| output[0] as usize).collect();
    places.sort_unstable();
    places.dedup();
    assert_eq!(places.len(), count, "each has a place of its own");
    assert!(places.iter().all(|&place| place / 64 / 16 < room / 64), "within the room of the list");
    // What the host takes for it where it tells a thread for each place.
    assert_eq!((room * LIST_SHARDS) as u64, places_in_shards(count as u64));
    // The check can fail: one part has room for few of them.
    assert!(room < count / 4);
    // Those for whom all parts together have no room are told of.
    let (_, counters) = Probe::new(text, &[]).run_and_count(device(), &[0u32; 64], count, [40, 1, 1]);
    assert_eq!(counters[MISPLACED] as usize, count - 64 * LIST_SHARDS);
}
