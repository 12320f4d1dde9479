// Who goes to whom: first a list of sendings, each with its place among those of its peer; then, once it is
// known where each peer's message begins (message_starts.wgsl), each to its place. So messages leave the device in one
// piece each, whatever the order of the threads, and the host copies them as they are.

struct Sending {
    // Of the particle, in the buffer that is sent from.
    index: u32,
    // Entry of `peers`.
    peer: u32,
    // Among what goes to the same peer.
    place: u32,
}

var<storage, read_write> sendings: array<Sending>;
