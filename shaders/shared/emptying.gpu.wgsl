// On a GPU always: it waits for a clear as long as for a kernel.
fn advect_empties() -> bool {
    return true;
}
