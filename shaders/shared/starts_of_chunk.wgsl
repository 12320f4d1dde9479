//! uses: stretches.wgsl
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

// Where the particles of a chunk's cells start, of which `before_first` are before it and `own` in it, in place of how many
// there are in each cell.
fn write_starts_of_chunk(chunk: u32, before_first: u32, own: u32) {
    let begin = chunk * (CHUNK / 4u);
    let end = begin + CHUNK / 4u;
    if (own == 0u) {
        // bench: empty
        for (var four = begin; four < end; four++) {
            cell_start[four] = vec4<u32>(before_first);
        }
        return;
    }
    var before = before_first;
    // Four fours are read before any is written: a read would wait for what was written before it.
    // bench: started
    for (var four = begin; four < end; four += 4u) {
        let counts0 = cell_start[four];
        let counts1 = cell_start[four + 1u];
        let counts2 = cell_start[four + 2u];
        let counts3 = cell_start[four + 3u];
        let starts0 = starts_of(counts0, before);
        let starts1 = starts_of(counts1, starts0.next);
        let starts2 = starts_of(counts2, starts1.next);
        let starts3 = starts_of(counts3, starts2.next);
        cell_start[four] = starts0.starts;
        cell_start[four + 1u] = starts1.starts;
        cell_start[four + 2u] = starts2.starts;
        cell_start[four + 3u] = starts3.starts;
        before = starts3.next;
    }
}
