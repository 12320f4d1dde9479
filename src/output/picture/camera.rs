//! From where a picture is seen: a parallel projection of space to pixels.
//!
//! With the azimuth a and the elevation e the viewer is in the direction (sin a cos e, -cos a cos e, sin e): at 0, 0 before
//! the front, x to the right and z up. A length across the view has the same pixels wherever it is.

use std::str::FromStr;

use glam::DVec3;

/// Whence it is seen, in degrees.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct View {
    /// From the front counter-clockwise, seen from above: 90 is from +x.
    pub azimuth: f64,
    /// Above the horizon, -90 to 90.
    pub elevation: f64,
}

impl View {
    /// Directions that have names.
    pub const NAMED: [(&str, View); 4] = [
        ("iso", View { azimuth: 30.0, elevation: 25.0 }),
        ("front", View { azimuth: 0.0, elevation: 0.0 }),
        ("side", View { azimuth: 90.0, elevation: 0.0 }),
        ("top", View { azimuth: 0.0, elevation: 90.0 }),
    ];

    /// The unit vectors to the right, upwards and towards the viewer.
    fn axes(self) -> [DVec3; 3] {
        let (sin_a, cos_a) = exact_sin_cos(self.azimuth);
        let (sin_e, cos_e) = exact_sin_cos(self.elevation);
        let right = DVec3::new(cos_a, sin_a, 0.0);
        let towards = DVec3::new(sin_a * cos_e, -cos_a * cos_e, sin_e);
        [right, towards.cross(right), towards]
    }
}

/// Without the rounding of a right angle.
fn exact_sin_cos(degrees: f64) -> (f64, f64) {
    match degrees.rem_euclid(360.0) {
        0.0 => (0.0, 1.0),
        90.0 => (1.0, 0.0),
        180.0 => (0.0, -1.0),
        270.0 => (-1.0, 0.0),
        other => other.to_radians().sin_cos(),
    }
}

impl FromStr for View {
    type Err = String;

    fn from_str(text: &str) -> Result<View, String> {
        if let Some((_, view)) = View::NAMED.iter().find(|(name, _)| *name == text) {
            return Ok(*view);
        }
        let allowed = "allowed: iso, front, side, top, or AZIMUTH,ELEVATION in degrees such as 30,25, the elevation from -90 to 90";
        let angles = text.split_once(',').and_then(|(azimuth, elevation)| {
            Some([azimuth.trim().parse::<f64>().ok()?, elevation.trim().parse::<f64>().ok()?])
        });
        match angles {
            Some([azimuth, elevation]) if azimuth.is_finite() && elevation.abs() <= 90.0 => {
                Ok(View { azimuth, elevation })
            }
            _ => Err(allowed.to_owned()),
        }
    }
}

/// Where on a picture the things are seen.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Frame {
    /// Pixels of the whole picture.
    pub size: [u32; 2],
    /// Pixels left free at the left, at the top, at the right and at the bottom.
    pub margins: [f64; 4],
}

/// A view of things that fill a frame.
#[derive(Debug, Clone, PartialEq)]
pub struct Camera {
    /// Right, up and towards the viewer.
    pub axes: [DVec3; 3],
    /// What is at `middle`, m.
    pub centre: DVec3,
    /// Pixels, from the left and from the top.
    pub middle: [f64; 2],
    /// Pixels per m.
    pub scale: f64,
    /// Half of what is seen along the view, m.
    pub reach: f64,
    pub size: [u32; 2],
}

impl Camera {
    /// Sees all of the points, as large as the frame allows.
    pub fn around(view: View, frame: Frame, points: impl Iterator<Item = DVec3>) -> Camera {
        let axes = view.axes();
        let seen = |point: DVec3| DVec3::new(point.dot(axes[0]), point.dot(axes[1]), point.dot(axes[2]));
        let far = DVec3::splat(f64::INFINITY);
        let (low, high) = points.map(seen).fold((far, -far), |(low, high), point| (low.min(point), high.max(point)));
        // Nothing to be seen, or a point: a space all the same.
        let (low, high) = if low.x <= high.x { (low, high) } else { (DVec3::ZERO, DVec3::ZERO) };
        let extent = (high - low).max(DVec3::splat(1e-6 * (high - low).max_element().max(1e-9)));
        let [left, top, right, bottom] = frame.margins;
        let [width, height] = frame.size.map(f64::from);
        let room = [(width - left - right).max(1.0), (height - top - bottom).max(1.0)];
        let centre = 0.5 * (low + high);
        Camera {
            axes,
            centre: axes[0] * centre.x + axes[1] * centre.y + axes[2] * centre.z,
            middle: [left + 0.5 * room[0], top + 0.5 * room[1]],
            scale: (room[0] / extent.x).min(room[1] / extent.y),
            // A little more, for what has a thickness.
            reach: 0.55 * extent.z + 0.05 * extent.x.max(extent.y),
            size: frame.size,
        }
    }

    /// Where a place is seen, in pixels from the left and from the top.
    pub fn pixel(&self, place: DVec3) -> [f64; 2] {
        let place = place - self.centre;
        let across = [place.dot(self.axes[0]), -place.dot(self.axes[1])];
        [0, 1].map(|k| self.middle[k] + self.scale * across[k])
    }

    /// How near a place is along the view, m.
    pub fn nearness(&self, place: DVec3) -> f64 {
        (place - self.centre).dot(self.axes[2])
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn camera(view: &str, points: &[DVec3]) -> Camera {
        let frame = Frame { size: [200, 100], margins: [10.0, 20.0, 30.0, 0.0] };
        Camera::around(view.parse().unwrap(), frame, points.iter().copied())
    }

    #[test]
    fn named_views_look_along_the_axes() {
        let corners = [DVec3::ZERO, DVec3::new(1.0, 2.0, 3.0)];
        for (view, right, up, towards) in [
            ("front", DVec3::X, DVec3::Z, -DVec3::Y),
            ("side", DVec3::Y, DVec3::Z, DVec3::X),
            ("top", DVec3::X, DVec3::Y, DVec3::Z),
        ] {
            assert_eq!(camera(view, &corners).axes, [right, up, towards], "{view}");
        }
        let [right, up, towards] = camera("iso", &corners).axes;
        assert!(right.cross(up).distance(towards) < 1e-12 && towards.z > 0.0 && towards.y < 0.0 && right.z == 0.0);
    }

    #[test]
    fn what_is_seen_fills_its_frame() {
        let camera = camera("front", &[DVec3::ZERO, DVec3::new(4.0, 1.0, 1.0)]);
        assert_eq!(camera.scale, 40.0);
        let (low, high) = (camera.pixel(DVec3::ZERO), camera.pixel(DVec3::new(4.0, 0.0, 1.0)));
        assert_eq!((low, high), ([10.0, 80.0], [170.0, 40.0]));
        assert!(camera.nearness(DVec3::ZERO) > camera.nearness(DVec3::Y));
    }

    #[test]
    fn nothing_and_a_point_are_seen_without_faults() {
        for points in [&[][..], &[DVec3::ONE][..]] {
            let camera = camera("iso", points);
            assert!(camera.scale.is_finite() && camera.pixel(DVec3::ONE).iter().all(|x| x.is_finite()));
        }
    }

    #[test]
    fn a_view_is_a_name_or_two_angles() {
        assert_eq!("-30, 12.5".parse(), Ok(View { azimuth: -30.0, elevation: 12.5 }));
        for wrong in ["", "back", "30", "30,91", "a,b", "nan,0", "1,2,3"] {
            assert!(wrong.parse::<View>().unwrap_err().contains("AZIMUTH,ELEVATION"), "{wrong}");
        }
    }
}
