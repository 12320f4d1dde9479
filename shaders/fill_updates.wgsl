//! uses: step.wgsl grid.wgsl local.wgsl particle.wgsl lists.wgsl update.wgsl sendings.wgsl
//! phase: update
// Update, part 3: what the rounds did to each particle, to its place in the message to its peer.
//
// Reads `sendings`, `peer_starts`, `sorted`, `flights`, `cells`; writes `updates_out`. One thread per sending that
// found room.

var<uniform> step: Step;
var<storage, read> sorted: array<Particle>;
var<storage, read> flights: array<vec4<u32>>;
var<storage, read> cells: array<u32>;
var<storage, read_write> updates_out: array<Update>;
var<storage, read> peer_starts: array<u32>;

@compute @workgroup_size(WORKGROUP)
fn fill_updates(thread: Thread) {
    let k = linear(thread);
    if (k >= min(atomicLoad(&counters[LIST_UPDATES]), arrayLength(&sendings))) {
        return;
    }
    let s = sendings[k].index;
    let place = peer_starts[sendings[k].peer] + sendings[k].place;
    if (place < arrayLength(&updates_out)) {
        updates_out[place] = Update(sorted[s], flight_of(flights[2u * s]), cell_index(cell_of(cells[s])), 0u, 0u, 0u);
    }
}
