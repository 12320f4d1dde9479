// Where the particles of the cells of a four start, of which `before` are before it, and of the next one.
struct Starts {
    starts: vec4<u32>,
    next: u32,
}

fn starts_of(counts: vec4<u32>, before: u32) -> Starts {
    let two = counts.x + counts.y;
    let three = two + counts.z;
    return Starts(before + vec4<u32>(0u, counts.x, two, three), before + three + counts.w);
}
