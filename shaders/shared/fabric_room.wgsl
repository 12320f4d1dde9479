// For those who write the lists of fabric: how many entries there may be, and as many cells that have some.

var<storage, read_write> fabric_entries: array<vec4<u32>>;

fn fabric_room() -> u32 {
    return arrayLength(&fabric_entries) / 2u;
}
