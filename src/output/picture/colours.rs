//! Colours that people with any colour vision tell apart: Okabe and Ito's for kinds, viridis for values.

use crate::output::chart::PALETTE;

pub type Colour = [u8; 3];

pub const WHITE: Colour = [255, 255, 255];
pub const INK: Colour = [40, 40, 40];
/// Of walls and their edges.
pub const WALL: Colour = [120, 132, 148];
/// Of fabric that is seen through.
pub const FABRIC: Colour = [178, 142, 84];
/// Of the two sides of a mesh.
pub const MESH: [Colour; 2] = [[236, 226, 205], [150, 178, 205]];

/// Viridis (van der Walt and Smith, 2015) at nine even places.
const VIRIDIS: [Colour; 9] = [
    [68, 1, 84],
    [72, 40, 120],
    [59, 82, 139],
    [44, 114, 142],
    [33, 145, 140],
    [40, 174, 128],
    [94, 201, 98],
    [173, 220, 48],
    [253, 231, 37],
];

/// The colour of a value between 0 and 1; of one beyond, that of the end.
pub fn viridis(value: f64) -> Colour {
    let place = value.clamp(0.0, 1.0) * (VIRIDIS.len() - 1) as f64;
    let from = (place as usize).min(VIRIDIS.len() - 2);
    mixed(VIRIDIS[from], VIRIDIS[from + 1], place - from as f64)
}

/// The colour of the kind of this number. From the eighth on they come again, darker and then lighter.
pub fn of_kind(kind: usize) -> Colour {
    let colour = PALETTE[kind % PALETTE.len()];
    match kind / PALETTE.len() % 3 {
        0 => colour,
        1 => mixed(colour, [0; 3], 0.45),
        _ => mixed(colour, WHITE, 0.5),
    }
}

/// So much of the second colour in the first.
pub fn mixed(first: Colour, second: Colour, share: f64) -> Colour {
    std::array::from_fn(|k| (f64::from(first[k]) * (1.0 - share) + f64::from(second[k]) * share).round() as u8)
}

/// As a word of the shaders, red in the lowest byte; the opacity is from 0 to 255.
pub fn word([r, g, b]: Colour, opacity: u8) -> u32 {
    u32::from_le_bytes([r, g, b, opacity])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn values_rise_in_lightness() {
        let light = |k: u32| {
            let [r, g, b] = viridis(f64::from(k) / 64.0).map(f64::from);
            0.299 * r + 0.587 * g + 0.114 * b
        };
        assert!((0..64).all(|k| light(k + 1) > light(k)));
        assert_eq!((viridis(-3.0), viridis(f64::INFINITY)), (VIRIDIS[0], VIRIDIS[8]));
    }

    #[test]
    fn kinds_have_colours_of_their_own() {
        let all: std::collections::BTreeSet<Colour> = (0..21).map(of_kind).collect();
        assert_eq!(all.len(), 21);
        assert_eq!(word([1, 2, 3], 4), 0x0403_0201);
    }
}
