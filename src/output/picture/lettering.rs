//! Words on a picture, in a small font that the program brings along.

use noto_sans_mono_bitmap::{FontWeight, RasterHeight, get_raster, get_raster_width};

use super::colours::Colour;
use super::image::Image;

/// For a letter that the font has not.
const UNKNOWN: char = '?';

/// The size of letters.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Lettering(RasterHeight);

impl Lettering {
    /// That of a picture of this width.
    pub fn of_width(pixels: u32) -> Lettering {
        Lettering(if pixels < 1000 { RasterHeight::Size16 } else { RasterHeight::Size20 })
    }

    /// Pixels of a line.
    pub fn height(self) -> i64 {
        self.0.val() as i64
    }

    pub fn width(self, text: &str) -> i64 {
        (get_raster_width(FontWeight::Regular, self.0) * text.chars().count()) as i64
    }

    /// Writes a line from its upper left corner.
    pub fn write(self, image: &mut Image, [left, top]: [i64; 2], text: &str, colour: Colour) {
        let letter = |letter: char| get_raster(letter, FontWeight::Regular, self.0);
        for (place, raster) in text.chars().filter_map(|c| letter(c).or_else(|| letter(UNKNOWN))).enumerate() {
            let start = left + (place * raster.width()) as i64;
            for (y, row) in raster.rows().enumerate() {
                for (x, &share) in row.iter().enumerate().filter(|(_, share)| **share > 0) {
                    image.blend([start + x as i64, top + y as i64], colour, f64::from(share) / 255.0);
                }
            }
        }
    }

    /// The text, or as much of its beginning as fits a width.
    pub fn fitting(self, text: &str, width: i64) -> String {
        if self.width(text) <= width {
            return text.to_owned();
        }
        let letters = (width / self.width("m")).max(1) as usize;
        text.chars().take(letters - 1).chain(['.']).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn words_leave_ink_where_they_stand() {
        let lettering = Lettering::of_width(640);
        let mut image = Image::new([200, 40]);
        lettering.write(&mut image, [10, 8], "x\u{2603} I", [0; 3]);
        let width = lettering.width("m") as u32;
        let inked = |place: u32| {
            let columns = 10 + place * width..10 + (place + 1) * width;
            columns.flat_map(|x| (0..40).map(move |y| (x, y))).any(|(x, y)| image.at(x, y)[0] < 128)
        };
        assert_eq!([0, 1, 2, 3, 4].map(inked), [true, true, false, true, false]);
        assert_eq!(lettering.fitting("nitrogen", 4 * i64::from(width)), "nit.");
        assert_eq!(lettering.fitting("air", 4 * i64::from(width)), "air");
    }
}
