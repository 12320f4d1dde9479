//! Which of a machine's devices a rank takes.

/// The index of the device of the rank `node_rank` of a machine: they take turns through the `devices`. `None` without
/// devices.
pub fn choose_device(node_rank: usize, devices: usize) -> Option<usize> {
    node_rank.checked_rem(devices)
}

#[cfg(test)]
mod tests {
    use super::choose_device;

    /// Ranks take devices in turn, so none serves two ranks more than another.
    #[test]
    fn ranks_take_turns_through_the_devices() {
        assert_eq!(choose_device(0, 0), None);
        for devices in 1..6 {
            for ranks in 1..14 {
                let mut served = vec![0; devices];
                (0..ranks).for_each(|rank| served[choose_device(rank, devices).unwrap()] += 1);
                assert_eq!(served.iter().sum::<usize>(), ranks);
                assert!(served.iter().max().unwrap() - served.iter().min().unwrap() <= 1, "{served:?}");
            }
        }
    }
}
