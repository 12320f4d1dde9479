// The coarse blocks of cells, for what a single cell holds too few particles to tell.

// Cells per block and axis, log2; blocks per axis.
override BLOCK_BITS: u32;
override BLOCKS_X: u32;
override BLOCKS_Y: u32;

fn block_of(c: vec3<u32>) -> u32 {
    let b = c >> vec3<u32>(BLOCK_BITS);
    return (b.z * BLOCKS_Y + b.y) * BLOCKS_X + b.x;
}
