//! The neighbours of each node of a mesh, and the shares that a pass of smoothing gives them (`shaders/membrane/smooth_nodes.wgsl`).

use std::collections::BTreeSet;

use super::layout::GpuNeighbour;

/// Neighbours of all nodes one after the other, by number, and where those of each node begin; behind them where the last end. Nodes of triangles that
/// have none that is free are as they are: nothing is smoothed there.
pub fn neighbours(is_free: &[bool], triangles: &[[u32; 3]]) -> (Vec<GpuNeighbour>, Vec<u32>) {
    let nodes = is_free.len();
    let mut of_nodes = vec![BTreeSet::new(); nodes];
    for &[a, b, c] in triangles.iter().filter(|corners| corners.iter().any(|&node| is_free[node as usize])) {
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

/// What a hit of unit impulse on each triangle changes its velocity by along that impulse, 1/kg: the mean of w.G w over places of the triangle, w the
/// weights of its corners, G = S^n M^-1 S^n with n passes S of smoothing and M the masses of nodes.
pub fn recoils(inverse_masses: &[f64], triangles: &[[u32; 3]], passes: u32) -> Vec<f64> {
    let is_free: Vec<bool> = inverse_masses.iter().map(|&inverse| inverse > 0.0).collect();
    let (all, starts) = neighbours(&is_free, triangles);
    let own = |node: usize| &all[starts[node] as usize..starts[node + 1] as usize];
    // What a pass makes of a sparse vector; `sum` is zero before and after.
    let mut sum = vec![0.0; inverse_masses.len()];
    let mut smoothed = |from: &[(usize, f64)]| -> Vec<(usize, f64)> {
        let mut touched = BTreeSet::new();
        for &(node, value) in from {
            touched.insert(node);
            let mut left = value;
            for neighbour in own(node) {
                let share = f64::from(neighbour.share) * value;
                touched.insert(neighbour.node as usize);
                sum[neighbour.node as usize] += share;
                left -= share;
            }
            sum[node] += left;
        }
        touched.into_iter().map(|node| (node, std::mem::take(&mut sum[node]))).collect()
    };
    let spread: Vec<Vec<(usize, f64)>> = (0..inverse_masses.len())
        .map(|node| (0..passes).fold(vec![(node, 1.0)], |vector, _| smoothed(&vector)))
        .collect();
    // Both are ordered by node.
    let response = |one: u32, other: u32| {
        let (mut ones, mut others) = (spread[one as usize].iter().peekable(), spread[other as usize].iter().peekable());
        let mut sum = 0.0;
        while let (Some(&&(p, a)), Some(&&(q, b))) = (ones.peek(), others.peek()) {
            if p == q {
                sum += a * b * inverse_masses[p];
            }
            if p <= q {
                ones.next();
            }
            if q <= p {
                others.next();
            }
        }
        sum
    };
    // The mean of w_i^2 over a triangle is a sixth, that of w_i w_k a twelfth.
    let of_triangle = |&[a, b, c]: &[u32; 3]| {
        let alike = response(a, a) + response(b, b) + response(c, c);
        (alike + response(a, b) + response(b, c) + response(c, a)) / 6.0
    };
    triangles.iter().map(of_triangle).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Without smoothing: of three equal masses half of one. With many passes on all nodes: as of all of them together.
    #[test]
    fn triangles_recoil_with_the_mass_that_a_hit_moves() {
        let fan: Vec<[u32; 3]> = (0..6).map(|k| [0, 1 + k, 1 + (k + 1) % 6]).collect();
        let masses = [0.5; 7];
        assert!(recoils(&masses, &fan, 0).iter().all(|recoil| (recoil - 0.5 * 0.5).abs() < 1e-12));
        assert!(recoils(&masses, &fan, 400).iter().all(|recoil| (recoil - 0.5 / 7.0).abs() < 1e-6));
        // Nodes that are held take no part.
        let mut held = masses;
        held[1..].fill(0.0);
        assert!(recoils(&held, &fan, 0).iter().all(|recoil| (recoil - 0.5 / 6.0).abs() < 1e-12));
    }

    /// The middle of a fan of six has six neighbours, each of its rim three: both give each other a seventh.
    #[test]
    fn shares_are_alike_on_both_sides_of_an_edge() {
        let fan: Vec<[u32; 3]> = (0..6).map(|k| [0, 1 + k, 1 + (k + 1) % 6]).collect();
        let (all, starts) = neighbours(&[true; 7], &fan);
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
