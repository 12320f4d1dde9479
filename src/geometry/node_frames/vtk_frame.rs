//! What of a VTK file is a frame: points, and cells that are triangles.

use super::error::Misread;

#[derive(Debug, Clone, Default, PartialEq)]
pub(super) struct VtkFrame {
    pub nodes: Vec<[f64; 3]>,
    pub triangles: Vec<[u32; 3]>,
}

/// VTK's numbers of the cells that are passed over (points, lines) and of triangles.
const POINTS_AND_LINES: std::ops::RangeInclusive<i64> = 1..=4;
const TRIANGLE: i64 = 5;

/// Points of the cells one after the other, and where each cell ends among them.
#[derive(Debug, Default)]
pub(super) struct Cells {
    pub connectivity: Vec<i64>,
    pub ends: Vec<i64>,
    /// VTK's kind of each; none where all are polygons.
    pub types: Option<Vec<i64>>,
}

impl Cells {
    /// The triangles; points and lines are passed over, other cells refused.
    pub fn triangles(&self) -> Result<Vec<[u32; 3]>, Misread> {
        if let Some(types) = self.types.as_ref().filter(|types| types.len() != self.ends.len()) {
            let found = format!("{} types of cells", types.len());
            return Err(Misread::new("cells", found, format!("one for each of the {} cells", self.ends.len())));
        }
        let mut triangles = Vec::with_capacity(self.ends.len());
        let mut begin = 0;
        for (cell, &end) in self.ends.iter().enumerate() {
            let place = || format!("cell {cell}");
            let own = usize::try_from(end).ok().and_then(|end| self.connectivity.get(begin..end));
            let own = own.ok_or_else(|| {
                let expected = format!("one from {begin} to {}", self.connectivity.len());
                Misread::new(place(), format!("the end {end} of its points"), expected)
            })?;
            begin += own.len();
            let kind = self.types.as_ref().map_or(TRIANGLE, |types| types[cell]);
            if POINTS_AND_LINES.contains(&kind) {
                continue;
            }
            let corners: [i64; 3] = match own.try_into() {
                Ok(corners) if kind == TRIANGLE => corners,
                _ => {
                    let what = if kind == TRIANGLE { String::new() } else { format!(" of the type {kind}") };
                    let found = format!("a cell{what} with {} points", own.len());
                    return Err(Misread::new(place(), found, "triangles (ParaView's filter Triangulate makes them)"));
                }
            };
            let mut triangle = [0; 3];
            for (node, found) in triangle.iter_mut().zip(corners) {
                let number = || Misread::new(place(), format!("point {found}"), "a number from 0 on");
                *node = u32::try_from(found).map_err(|_| number())?;
            }
            triangles.push(triangle);
        }
        Ok(triangles)
    }
}

/// x, y, z of each point.
pub(super) fn points(numbers: &[f64]) -> Vec<[f64; 3]> {
    numbers.as_chunks::<3>().0.to_vec()
}
