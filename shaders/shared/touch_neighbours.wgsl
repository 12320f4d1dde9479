// Lets those choose again who have a particle in their lists of neighbours: they are in its own list.

@group(0) @binding(13) var<storage, read> neighbours: array<u32>;
@group(0) @binding(14) var<storage, read> neighbour_count: array<u32>;

fn touch_neighbours(s: u32) {
    let stride = arrayLength(&neighbour_count);
    let listed = neighbour_count[s];
    let tail = tail_of(s, listed, stride);
    for (var k = 0u; k < listed; k++) {
        touch(neighbours[entry_of(s, k, listed, stride, tail)]);
    }
}
