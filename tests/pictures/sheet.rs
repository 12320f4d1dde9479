//! A strip that is folded in zigzag, and what is seen of its folds.

use std::fs;
use std::path::Path;

use super::Png;
use super::folder::rendered;

/// OBJ text of a strip of so many panels, 0.15 wide, whose folds are so high; of height 0 it is flat.
pub fn zigzag(panels: u32, height: f64) -> String {
    const ACROSS: u32 = 8;
    let mut text = String::new();
    for fold in 0..=panels {
        let (x, z) = (0.012 * f64::from(fold), if fold % 2 == 0 { 0.0 } else { height });
        for k in 0..=ACROSS {
            text += &format!("v {x} {} {z}\n", 0.15 * f64::from(k) / f64::from(ACROSS));
        }
    }
    for panel in 0..panels {
        for k in 0..ACROSS {
            let a = panel * (ACROSS + 1) + k + 1;
            let c = a + ACROSS + 1;
            text += &format!("f {a} {c} {}\nf {} {c} {}\n", a + 1, a + 1, c + 1);
        }
    }
    text
}

fn picture(dir: &Path, panels: u32, height: f64, view: &str) -> Png {
    let mesh = dir.join("sheet.obj");
    fs::write(&mesh, zigzag(panels, height)).unwrap();
    let path = rendered(&mesh, &["--view", view, "--size", "640x400"]);
    assert_eq!(path, dir.join("sheet.png"));
    Png::read(&path)
}

/// The runs of pixels along a row through the middle of the sheet: lightness and length.
fn runs(image: &Png) -> Vec<(u8, u32)> {
    let mut runs: Vec<(u8, u32)> = Vec::new();
    for x in 0..image.size[0] {
        let light = image.at(x, 180)[1];
        match runs.last_mut() {
            // A slope that leads away becomes lighter.
            Some((last, length)) if last.abs_diff(light) <= 8 => (*last, *length) = (light, *length + 1),
            _ => runs.push((light, 1)),
        }
    }
    runs
}

/// From above, each panel has the shade of its slope, and each fold is a dark line.
#[test]
fn folds_of_a_sheet_are_seen() {
    let dir = tempfile::tempdir().unwrap();
    for panels in [6, 12] {
        let runs = runs(&picture(dir.path(), panels, 0.02, "top"));
        let slopes: Vec<u8> =
            runs.iter().filter(|(light, length)| *length >= 8 && *light < 250).map(|(light, _)| *light).collect();
        assert_eq!(slopes.len(), panels as usize, "{runs:?}");
        assert!(slopes.windows(2).all(|pair| pair[0].abs_diff(pair[1]) > 15), "{slopes:?}");
        // Two ends and the folds between; some pixels of a line are lighter.
        let lines = runs.windows(3).filter(|w| w[1].0 < 130 && w[0].0 > w[1].0 && w[2].0 > w[1].0).count();
        assert_eq!(lines, panels as usize + 1, "{runs:?}");
    }
    // The count can fail: a flat strip has one shade and no line but its ends.
    let runs = runs(&picture(dir.path(), 12, 0.0, "top"));
    assert_eq!(runs.iter().filter(|(light, length)| *length >= 8 && *light < 250).count(), 1, "{runs:?}");
}

/// From the front and a little above, the nearer folds hide the farther, and each has an outline.
#[test]
fn outlines_set_folds_off_from_those_behind() {
    let dir = tempfile::tempdir().unwrap();
    let dark = |height: f64| {
        let image = picture(dir.path(), 12, height, "60,20");
        let pixels = (0..image.size[0]).filter(|&x| image.at(x, 180).iter().all(|&channel| channel < 110));
        pixels.fold(Vec::<u32>::new(), |mut lines, x| {
            if lines.last().is_none_or(|&last| x > last + 2) {
                lines.push(x);
            }
            lines
        })
    };
    let (folded, flat) = (dark(0.04).len(), dark(0.0).len());
    assert!(folded >= 6 && flat <= 2, "{folded} {flat}");
}
