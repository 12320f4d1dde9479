//! Which of a machine's devices a rank takes.

/// The index of the device of the rank `node_rank` of a machine, and whether it shares it with another of the
/// `node_size` ranks there: they take turns through the `devices`. `None` without devices.
pub fn choose_device(node_rank: usize, node_size: usize, devices: usize) -> Option<(usize, bool)> {
    let index = node_rank.checked_rem(devices)?;
    Some((index, index + devices < node_size))
}

#[cfg(test)]
mod tests {
    use super::choose_device;

    /// Ranks take devices in turn; a device is shared exactly if two ranks take it.
    #[test]
    fn ranks_take_turns_through_the_devices() {
        assert_eq!(choose_device(0, 1, 0), None);
        for devices in 1..6 {
            for ranks in 1..14 {
                let taken: Vec<_> = (0..ranks).map(|rank| choose_device(rank, ranks, devices).unwrap()).collect();
                for (rank, &(index, shared)) in taken.iter().enumerate() {
                    assert_eq!(index, rank % devices);
                    let sharers = taken.iter().filter(|other| other.0 == index).count();
                    assert_eq!(shared, sharers > 1, "rank {rank} of {ranks} on {devices} devices");
                }
            }
        }
    }
}
