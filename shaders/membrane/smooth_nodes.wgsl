//! uses: thread.wgsl membrane.wgsl
//! phase: membrane
// One pass of smoothing over the nodes of a mesh: a symmetric matrix S whose rows have the sum 1.
//
// S gives each neighbour a share 1/(1 + the larger number of neighbours of the two), and a node what is left. Sums over all nodes stay, and
// (S a).b = a.(S b): so what smoothed impulses do with velocities is what impulses do with smoothed velocities.
//
// Reads `smooth_from`, `neighbours` and `neighbour_starts`, writes `smooth_to`. One thread per node; its neighbours are added in their order.

struct Neighbour {
    node: u32,
    share: f32,
}

var<uniform> membrane_step: MembraneStep;
var<storage, read> neighbours: array<Neighbour>;
// Of each node where its neighbours begin, and behind the last where they end.
var<storage, read> neighbour_starts: array<u32>;
var<storage, read> smooth_from: array<vec4<f32>>;
var<storage, read_write> smooth_to: array<vec4<f32>>;

@compute @workgroup_size(WORKGROUP)
fn smooth_nodes(thread: Thread) {
    let k = linear(thread);
    if (k >= membrane_step.nodes) {
        return;
    }
    let own = smooth_from[k];
    var more = vec4<f32>(0.0);
    for (var at = neighbour_starts[k]; at < neighbour_starts[k + 1u]; at += 1u) {
        let neighbour = neighbours[at];
        more += neighbour.share * (smooth_from[neighbour.node] - own);
    }
    smooth_to[k] = own + more;
}
