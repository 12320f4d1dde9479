// A neighbour list as those read it who write none (neighbour_list.wgsl): in the record's second half the first entries, one after the other,
// of a long one also where its tail is; the word at a place among all.

fn direct_of(s: u32) -> vec4<u32> {
    return flights[2u * s + 1u];
}

fn word_at(place: u32) -> u32 {
    return flights[place >> 2u][place & 3u];
}
