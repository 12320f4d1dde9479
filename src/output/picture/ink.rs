//! From what a device has drawn to the pixels of a picture: outlines of meshes, and four texels to a pixel.
//!
//! A texel of a mesh is outline where what is beside it lies deeper by a step: of its depth z and those beside it at equal
//! distances, z1 + z2 - 2 z is above a bound. On a slope that is zero, however steep.

use super::colours::{INK, WHITE, mixed};
use super::image::Image;
use crate::gpu::Drawn;

/// Texels of a pixel along each edge.
pub const TEXELS: u32 = 2;
/// The alpha channel of a mesh (`shaders/render/surface.wgsl`).
const MESH: u8 = 255;
/// Texels at which depths are compared: an outline is as wide.
const DISTANCES: [usize; 2] = [1, 2];
/// How dark an outline is.
const DARKNESS: f64 = 0.85;

/// Darkens the texels of meshes beside which the depth has a step of more than `step`.
pub fn outline(drawn: &mut Drawn, step: f32) {
    let [width, height] = drawn.size.map(|edge| edge as usize);
    let is_edge = |x: usize, y: usize| {
        let at = y * width + x;
        let here = drawn.depths[at];
        DISTANCES.iter().any(|&far| {
            let along = |place: usize, edge: usize, stride: usize| {
                let inside = place >= far && place + far < edge;
                inside && drawn.depths[at - far * stride] + drawn.depths[at + far * stride] - 2.0 * here > step
            };
            along(x, width, 1) || along(y, height, width)
        })
    };
    let texels = (0..width * height).filter(|&at| drawn.colours[at][3] == MESH && is_edge(at % width, at / width));
    for at in texels.collect::<Vec<_>>() {
        let [r, g, b, kind] = drawn.colours[at];
        let [r, g, b] = mixed([r, g, b], INK, DARKNESS);
        drawn.colours[at] = [r, g, b, kind];
    }
}

/// The picture of half the size, each pixel the mean of its texels.
pub fn halved(drawn: &Drawn) -> Image {
    let size = drawn.size.map(|edge| edge / TEXELS);
    let mut image = Image { size, pixels: vec![WHITE; (size[0] * size[1]) as usize] };
    for y in 0..size[1] {
        for x in 0..size[0] {
            let texel = |k: u32| {
                let (column, row) = (TEXELS * x + k % TEXELS, TEXELS * y + k / TEXELS);
                drawn.colours[(row * drawn.size[0] + column) as usize]
            };
            let sum = |channel: usize| (0..TEXELS * TEXELS).map(|k| u32::from(texel(k)[channel])).sum::<u32>();
            let mean = |channel: usize| ((sum(channel) + TEXELS) / (TEXELS * TEXELS)) as u8;
            image.pixels[(y * size[0] + x) as usize] = [mean(0), mean(1), mean(2)];
        }
    }
    image
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A slope of a mesh over the left 20 of 40 columns, something else behind it over the right.
    fn slope(step: f32) -> Drawn {
        let depth = |x: u32| 0.01 * x as f32 + if x < 20 { 0.0 } else { step };
        let texels = || (0..8).flat_map(|_| 0..40u32);
        Drawn {
            size: [40, 8],
            colours: texels().map(|x| [200, 100, 0, if x < 20 { 255 } else { 128 }]).collect(),
            depths: texels().map(depth).collect(),
        }
    }

    #[test]
    fn steps_are_outlined_and_slopes_are_not() {
        for (step, dark) in [(0.004, 0), (0.006, 2), (-0.1, 0)] {
            let mut drawn = slope(step);
            outline(&mut drawn, 0.005);
            let row = &drawn.colours[4 * 40..5 * 40];
            assert_eq!(row.iter().filter(|colour| colour[0] < 100).count(), dark, "{step}");
            assert!(row[..18].iter().all(|colour| colour[0] == 200));
        }
    }

    #[test]
    fn a_pixel_is_the_mean_of_its_texels() {
        let texel = |x: u8| [x, 10 * x, 255, 7];
        let drawn = Drawn { size: [2, 2], colours: [1, 2, 3, 5].map(texel).to_vec(), depths: vec![1.0; 4] };
        assert_eq!(halved(&drawn), Image { size: [1, 1], pixels: vec![[3, 28, 255]] });
    }
}
