// What threads that run together do as one: an atomic operation of all of them on one word is done once, by the first. Here each thread
// runs alone; adapters that can tell who runs together have subgroups/together.wgsl in place of this file. What comes of it is the
// same, but for the order of lists, which is that of the threads anyway.

// How many of those that run together and come here come before this thread, and how many they are in all.
fn threads_before() -> u32 {
    return 0u;
}

fn threads_together() -> u32 {
    return 1u;
}

// What the first of them has.
fn of_first(value: u32) -> u32 {
    return value;
}

// The sum of what they have.
fn sum_together(value: u32) -> u32 {
    return value;
}

// The same of numbers of two words.
fn sum64_together(low: u32, high: u32) -> vec2<u32> {
    return vec2<u32>(low, high);
}
