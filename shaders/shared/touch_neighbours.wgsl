//! uses: turns.wgsl
// Lets those choose again who have a particle in their lists of neighbours: they are in its own list.

@group(0) @binding(14) var<storage, read> neighbour_count: array<u32>;

fn touch_neighbours(s: u32) {
    let listed = neighbour_count[s];
    var direct = direct_of(s);
    let tail = direct.w;
    var k = 0u;
    for (; k < listed; k++) {
        var j = direct.x;
        direct = direct.yzww;
        if (listed > DIRECT && k >= DIRECT - 1u) {
            j = word_at(tail + k);
        }
        touch(j);
    }
    through(k, listed);
}
