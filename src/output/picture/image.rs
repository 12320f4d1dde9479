//! A picture as pixels, and its file.

use std::path::Path;

use super::colours::{Colour, WHITE, mixed};
use crate::output::OutputError;
use crate::output::error::write_atomically;

/// Rows from the top.
#[derive(Debug, Clone, PartialEq)]
pub struct Image {
    /// Width and height.
    pub size: [u32; 2],
    pub pixels: Vec<Colour>,
}

impl Image {
    /// White.
    pub fn new(size: [u32; 2]) -> Image {
        Image { size, pixels: vec![WHITE; size[0] as usize * size[1] as usize] }
    }

    pub fn at(&self, x: u32, y: u32) -> Colour {
        self.pixels[(y * self.size[0] + x) as usize]
    }

    /// Lays a colour over a pixel; one beyond the edges is none.
    pub fn blend(&mut self, [x, y]: [i64; 2], colour: Colour, opacity: f64) {
        let inside = |value: i64, edge: u32| u32::try_from(value).ok().filter(|&value| value < edge);
        if let (Some(x), Some(y)) = (inside(x, self.size[0]), inside(y, self.size[1])) {
            let pixel = &mut self.pixels[(y * self.size[0] + x) as usize];
            *pixel = mixed(*pixel, colour, opacity);
        }
    }

    /// Fills a rectangle from its upper left corner.
    pub fn fill(&mut self, [left, top]: [i64; 2], [width, height]: [i64; 2], colour: Colour) {
        for y in top..top + height {
            for x in left..left + width {
                self.blend([x, y], colour, 1.0);
            }
        }
    }

    /// A line of a pixel's width, by the share of each pixel.
    pub fn line(&mut self, from: [f64; 2], to: [f64; 2], colour: Colour) {
        let way = [to[0] - from[0], to[1] - from[1]];
        let length = way[0].hypot(way[1]);
        let steps = (4.0 * length).ceil().max(1.0) as u32;
        let mut drawn = std::collections::BTreeMap::<[i64; 2], f64>::new();
        for step in 0..=steps {
            let share = f64::from(step) / f64::from(steps);
            let at = [from[0] + share * way[0] - 0.5, from[1] + share * way[1] - 0.5];
            let (low, part) = (at.map(|x| x.floor()), at.map(|x| x - x.floor()));
            for (right, down) in [(0, 0), (1, 0), (0, 1), (1, 1)] {
                let weigh = |side: i32, part: f64| if side == 1 { part } else { 1.0 - part };
                let pixel = [low[0] as i64 + i64::from(right), low[1] as i64 + i64::from(down)];
                let most = drawn.entry(pixel).or_default();
                *most = most.max(weigh(right, part[0]) * weigh(down, part[1]));
            }
        }
        for (pixel, share) in drawn {
            self.blend(pixel, colour, share);
        }
    }

    /// Writes it as PNG.
    ///
    /// # Errors
    /// If the file cannot be written.
    pub fn write_png(&self, path: &Path) -> Result<(), OutputError> {
        let mut bytes = Vec::new();
        self.encode(&mut bytes)
            .map_err(|problem| OutputError::Chart { path: path.to_path_buf(), problem: problem.to_string() })?;
        write_atomically(path, |out| out.write_all(&bytes))
    }

    fn encode(&self, bytes: &mut Vec<u8>) -> Result<(), png::EncodingError> {
        let mut encoder = png::Encoder::new(bytes, self.size[0], self.size[1]);
        encoder.set_color(png::ColorType::Rgb);
        encoder.set_depth(png::BitDepth::Eight);
        encoder.set_compression(png::Compression::High);
        let mut writer = encoder.write_header()?;
        writer.write_image_data(self.pixels.as_flattened())?;
        writer.finish()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_file_holds_the_pixels() {
        let mut image = Image::new([7, 3]);
        image.fill([5, 1], [4, 1], [1, 2, 3]);
        image.blend([-1, 0], [0; 3], 1.0);
        let dir = tempfile::tempdir().unwrap();
        let path = dir.path().join("image.png");
        image.write_png(&path).unwrap();
        let file = std::io::BufReader::new(std::fs::File::open(&path).unwrap());
        let mut reader = png::Decoder::new(file).read_info().unwrap();
        let mut bytes = vec![0; 7 * 3 * 3];
        reader.next_frame(&mut bytes).unwrap();
        assert_eq!(bytes, image.pixels.as_flattened());
        assert_eq!((image.at(5, 1), image.at(6, 1), image.at(4, 1)), ([1, 2, 3], [1, 2, 3], WHITE));
        assert!(image.write_png(Path::new("/nonexistent/image.png")).is_err());
    }

    #[test]
    fn a_line_leads_from_one_end_to_the_other() {
        let mut image = Image::new([20, 20]);
        image.line([2.5, 2.5], [17.5, 10.5], [0; 3]);
        let dark = |x, y| image.at(x, y)[0] < 60;
        assert!(dark(2, 2) && dark(17, 10) && !dark(2, 10) && !dark(17, 2));
        assert!((2..18).all(|x| (0..20).any(|y| image.at(x, y)[0] < 140)));
    }
}
