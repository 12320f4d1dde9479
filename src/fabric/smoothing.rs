//! The neighbours of each node of a mesh, and the shares that a pass of smoothing gives them (`shaders/membrane/smooth_nodes.wgsl`).

use std::collections::BTreeSet;

use super::layout::GpuNeighbour;

/// Neighbours of all nodes one after the other, by number, and where those of each node begin; behind them where the last end.
pub fn neighbours(nodes: usize, triangles: &[[u32; 3]]) -> (Vec<GpuNeighbour>, Vec<u32>) {
    let mut of_nodes = vec![BTreeSet::new(); nodes];
    for &[a, b, c] in triangles {
        for [one, other] in [[a, b], [b, c], [c, a]] {
            of_nodes[one as usize].insert(other);
            of_nodes[other as usize].insert(one);
        }
    }
    let mut all = Vec::with_capacity(6 * nodes);
    let mut starts = Vec::with_capacity(nodes + 1);
    for own in &of_nodes {
        starts.push(all.len() as u32);
        let share = |other: u32| 1.0 / (1 + own.len().max(of_nodes[other as usize].len())) as f32;
        all.extend(own.iter().map(|&node| GpuNeighbour { node, share: share(node) }));
    }
    starts.push(all.len() as u32);
    (all, starts)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The middle of a fan of six has six neighbours, each of its rim three: both give each other a seventh.
    #[test]
    fn shares_are_alike_on_both_sides_of_an_edge() {
        let fan: Vec<[u32; 3]> = (0..6).map(|k| [0, 1 + k, 1 + (k + 1) % 6]).collect();
        let (all, starts) = neighbours(7, &fan);
        let share = |of: u32, with: u32| {
            let own = &all[starts[of as usize] as usize..starts[of as usize + 1] as usize];
            own.iter().find(|neighbour| neighbour.node == with).map(|neighbour| neighbour.share)
        };
        assert_eq!([share(0, 3), share(3, 0)], [Some(1.0 / 7.0); 2]);
        assert_eq!([share(2, 3), share(3, 2)], [Some(0.25); 2]);
        assert_eq!(share(2, 5), None);
        for node in 0..7 {
            let own = &all[starts[node] as usize..starts[node + 1] as usize];
            assert!(own.iter().map(|neighbour| neighbour.share).sum::<f32>() < 1.0);
        }
    }
}
