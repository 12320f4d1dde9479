//! Laws of `corpuscle render`: the same bytes twice on one adapter; what a place in the gas shows is at the pixel that the
//! camera says; folds of a sheet are seen; what is wrong is said. Pictures are drawn on whatever adapter the machine has.

mod folder;
mod sheet;

use std::fs;
use std::path::Path;

use corpuscle::output::picture::{Camera, Colouring, RunPictures, frame, of_kind, viridis};
use corpuscle::output::snapshots_of;

use folder::{finished_run, outcome, rendered};

const SIZE: &str = "480x320";

/// A picture as read back: width, height and rows of colours.
struct Png {
    size: [u32; 2],
    bytes: Vec<u8>,
}

impl Png {
    fn read(path: &Path) -> Png {
        let file = std::io::BufReader::new(fs::File::open(path).unwrap());
        let mut reader = png::Decoder::new(file).read_info().unwrap();
        let mut bytes = vec![0; reader.output_buffer_size().unwrap()];
        let info = reader.next_frame(&mut bytes).unwrap();
        assert_eq!((info.color_type, info.bit_depth), (png::ColorType::Rgb, png::BitDepth::Eight));
        Png { size: [info.width, info.height], bytes }
    }

    fn at(&self, x: u32, y: u32) -> [u8; 3] {
        let at = 3 * (y * self.size[0] + x) as usize;
        [self.bytes[at], self.bytes[at + 1], self.bytes[at + 2]]
    }
}

/// Whether a colour is a shade of another, by the order of its channels and how far they are apart.
fn is_shade_of(seen: [u8; 3], colour: [u8; 3]) -> bool {
    let saturation = |[r, g, b]: [i32; 3]| r.max(g).max(b) - r.min(g).min(b);
    let [seen, colour] = [seen, colour].map(|colour| colour.map(i32::from));
    let spread = saturation(seen);
    let alike = |k: usize, l: usize| {
        let expected = f64::from(colour[k] - colour[l]) / f64::from(saturation(colour));
        (f64::from(seen[k] - seen[l]) / f64::from(spread.max(1)) - expected).abs() < 0.25
    };
    spread > 60 && alike(0, 1) && alike(1, 2)
}

/// How many pixels of columns from `from` to `to`, in shares of what is between two pixels, are shades of each colour.
fn shades(image: &Png, [left, right]: [[f64; 2]; 2], shares: [f64; 2], colours: &[[u8; 3]]) -> Vec<usize> {
    let [from, to] = shares.map(|share| left[0] + share * (right[0] - left[0]));
    let pixels = || (0..image.size[1]).flat_map(|y| (from as u32..to as u32).map(move |x| (x, y)));
    colours.iter().map(|&colour| pixels().filter(|&(x, y)| is_shade_of(image.at(x, y), colour)).count()).collect()
}

/// Of the two gases each half has its own, at the start of a run: seen from the front in its half of the box, and from the
/// side, where one half is behind the other, only the nearer in the most.
#[test]
fn each_gas_is_seen_where_it_is() {
    let dir = tempfile::tempdir().unwrap();
    let run = finished_run(dir.path(), "");
    let pictures = RunPictures::open(&run).unwrap();
    let series = pictures.series(&[0], Colouring::Gas).unwrap();
    let gases = [of_kind(0), of_kind(1)];
    for (view, count) in [("front", 2), ("top", 2), ("180,0", 2)] {
        let image = Png::read(&rendered(&run, &["--time", "0s", "--view", view, "--size", SIZE]));
        assert_eq!(image.size, [480, 320]);
        let places = pictures.places(&[0]).unwrap();
        let camera = Camera::around(view.parse().unwrap(), frame(image.size, &series.key), places.into_iter());
        let mut ends = [[0.0, 0.05, 0.05], [0.2, 0.05, 0.05]].map(|place| camera.pixel(place.into()));
        let mut expected = gases;
        if ends[0][0] > ends[1][0] {
            ends.reverse();
            expected.reverse();
        }
        let halves = [[0.02, 0.48], [0.52, 0.98]].map(|shares| shades(&image, ends, shares, &expected));
        assert_eq!(halves.len(), count);
        assert!(halves[0][0] > 500 && halves[0][1] == 0, "{view}: {halves:?}");
        assert!(halves[1][1] > 500 && halves[1][0] == 0, "{view}: {halves:?}");
    }
}

/// Where a single ball must be, is its colour; the second gas has none of its own near the middle of the first.
#[test]
fn a_colour_says_the_speed_and_the_key_its_ends() {
    let dir = tempfile::tempdir().unwrap();
    let run = finished_run(dir.path(), "");
    let pictures = RunPictures::open(&run).unwrap();
    for (colouring, name) in [(Colouring::Speed, "speed"), (Colouring::Temperature, "temperature")] {
        let series = pictures.series(&[0], colouring).unwrap();
        let text = format!("{:?}", series.key);
        assert!(text.contains(name), "{text}");
        let image = Png::read(&rendered(&run, &["--time", "0s", "--color-by", name, "--size", SIZE]));
        let key = (340..480).flat_map(|x| (0..320).map(move |y| (x, y)));
        let seen: std::collections::BTreeSet<[u8; 3]> = key.map(|(x, y)| image.at(x, y)).collect();
        let wanted = (1..40).map(|k| viridis(f64::from(k) / 40.0));
        let near = |a: [u8; 3], b: [u8; 3]| a.iter().zip(b).all(|(a, b)| a.abs_diff(b) <= 6);
        assert!(wanted.into_iter().all(|colour| seen.iter().any(|&other| near(other, colour))), "{name}");
    }
}

#[test]
fn the_same_picture_has_the_same_bytes() {
    let dir = tempfile::tempdir().unwrap();
    let run = finished_run(dir.path(), "");
    let draw = |view: &str| fs::read(rendered(&run, &["--view", view, "--size", SIZE])).unwrap();
    let first = draw("iso");
    assert!(first == draw("iso"), "two pictures of one snapshot differ");
    assert!(first != draw("31,25"), "another view is the same picture");
}

#[test]
fn a_movie_has_all_snapshots_and_a_time_its_nearest() {
    let dir = tempfile::tempdir().unwrap();
    let run = finished_run(dir.path(), "");
    let times: Vec<f64> = snapshots_of(&run).unwrap().iter().map(|entry| entry.time).collect();
    assert!(times.len() >= 3, "{times:?}");
    let out = dir.path().join("m.png");
    let out = out.to_str().unwrap();
    let (code, said, err) = outcome(&["render", run.to_str().unwrap(), "--movie", "--size", "320x200", "-o", out]);
    assert_eq!((code, err.as_str()), (0, ""));
    let files: Vec<String> = (0..times.len()).map(|k| out.replace("m.png", &format!("m_{k:06}.png"))).collect();
    assert_eq!(said.lines().collect::<Vec<_>>(), files);
    let frames: Vec<Vec<u8>> = files.iter().map(|path| fs::read(path).unwrap()).collect();
    assert!(frames.windows(2).all(|pair| pair[0] != pair[1]));
    // The nearest to a time between two is the picture of that one; a time far from all is told.
    let picture = |time: f64| {
        let time = format!("{}us", 1e6 * time);
        let arguments = ["render", run.to_str().unwrap(), "--time", &time, "--size", "320x200", "-o", out];
        let (code, _, err) = outcome(&arguments);
        assert_eq!(code, 0, "{err}");
        (fs::read(out).unwrap(), err)
    };
    let (second, err) = picture(times[1] + 0.4 * (times[2] - times[1]));
    // Its balls are as large as with so many particles; the gas of this box stays the same.
    assert!(second == frames[1] && err.is_empty(), "{err}");
    let (last, err) = picture(10.0 * times[times.len() - 1]);
    assert!(last == frames[times.len() - 1] && err.contains("no snapshot within half an interval"), "{err}");
}

/// Fabric hides the gas behind it or lets it through, as asked. Here it is the box itself.
#[test]
fn fabric_is_seen_through_or_with_its_folds() {
    let dir = tempfile::tempdir().unwrap();
    let run = finished_run(dir.path(), "");
    let picture = |look: &[&str]| Png::read(&rendered(&run, &[&["--time", "0s", "--size", SIZE], look].concat()));
    let gas = |image: &Png| shades(image, [[0.0; 2], [330.0, 0.0]], [0.0, 1.0], &[of_kind(0), of_kind(1)]);
    let (code, _, err) = outcome(&["render", run.to_str().unwrap(), "--time", "0s", "--fabric", "opaque"]);
    assert!(code == 2 && err.contains("there is no fabric beside it"), "{err}");
    let bare = picture(&[]);
    folder::add_fabric(&run);
    let (clear, opaque, none) = (picture(&[]), picture(&["--fabric", "opaque"]), picture(&["--fabric", "none"]));
    assert!(none.bytes == bare.bytes && clear.bytes != bare.bytes);
    // Balls at the outline of the box stand out beside it.
    let (seen, hidden) = (gas(&clear), gas(&opaque));
    assert!(seen.iter().zip(&hidden).all(|(seen, hidden)| *seen > 500 && 10 * hidden < *seen), "{seen:?} {hidden:?}");
    let inside = Camera::around(
        "iso".parse().unwrap(),
        frame(opaque.size, &RunPictures::open(&run).unwrap().series(&[0], Colouring::Gas).unwrap().key),
        [[0.0; 3], [0.2, 0.1, 0.1]].map(Into::into).into_iter(),
    );
    let [x, y] = inside.pixel([0.1, 0.05, 0.05].into());
    let [r, _, b] = opaque.at(x as u32, y as u32);
    assert!(r < 250 && r.abs_diff(b) > 8, "the middle is no side of a mesh: {:?}", opaque.at(x as u32, y as u32));
}

#[test]
fn what_is_wrong_is_said() {
    let dir = tempfile::tempdir().unwrap();
    let none = finished_run(dir.path(), "\n[output]\nsnapshots = 0\n");
    let path = |name: &str| dir.path().join(name).to_str().unwrap().to_owned();
    fs::write(path("sheet.obj"), sheet::zigzag(4, 0.02)).unwrap();
    fs::write(path("broken.obj"), "v 0 0 0\nf 1 2 3\n").unwrap();
    fs::write(path("empty.obj"), "v 0 0 0\n").unwrap();
    fs::write(path("notes.txt"), "hello").unwrap();
    let (none, folder, mesh) = (none.to_str().unwrap().to_owned(), path(""), path("sheet.obj"));
    let missing = path("missing");
    for (arguments, words) in [
        (vec![none.as_str()], "`snapshots = 20` in [output]"),
        (vec![&folder], "is no folder of a run"),
        (vec![&missing], "there is no such folder or file"),
        (vec![&mesh, "--time", "1ms"], "--time with"),
        (vec![&mesh, "--color-by", "gas"], "--color-by with"),
        (vec![&mesh, "--movie"], "--movie with"),
        (vec![&mesh, "--fabric", "clear"], "--fabric with"),
        (vec![&path("broken.obj")], "line 2: found a face with vertex 3"),
        (vec![&path("empty.obj")], "there are no triangles"),
        (vec![&path("notes.txt")], "neither `stl` nor `obj`"),
        (vec![&mesh, "-o", "sheet.jpg"], "ends in .png"),
        (vec![&mesh, "--size", "100x100"], "1280x800"),
        (vec![&mesh, "--view", "behind"], "AZIMUTH,ELEVATION"),
        (vec![&mesh, "-o", "/nonexistent/sheet.png"], "/nonexistent/sheet.png"),
    ] {
        let arguments: Vec<&str> = ["render"].into_iter().chain(arguments).collect();
        let (code, said, err) = outcome(&arguments);
        assert_eq!((code, said.as_str()), (2, ""), "{arguments:?}: {err}");
        assert!(err.contains(words), "{arguments:?}: {err}");
    }
    let (code, _, err) = outcome(&["render", &mesh, "--gpu", "99"]);
    assert!(code == 3 && err.contains("no adapter `99`"), "{err}");
}

/// Only a run among several ranks knows of subdomains.
#[test]
fn subdomains_are_seen_where_they_are_known() {
    let dir = tempfile::tempdir().unwrap();
    let alone = finished_run(dir.path(), "");
    let (code, _, err) = outcome(&["render", alone.to_str().unwrap(), "--color-by", "subdomain"]);
    assert!(code == 2 && err.contains("its particles have no subdomains"), "{err}");
    let dir = tempfile::tempdir().unwrap();
    let among = folder::run(dir.path(), "", &["--subdomains", "2"]);
    let image =
        Png::read(&rendered(&among, &["--time", "0s", "--color-by", "subdomain", "--view", "front", "--size", SIZE]));
    let whole = [[0.0; 2], [300.0, 0.0]];
    let owners = shades(&image, whole, [0.0, 1.0], &[of_kind(0), of_kind(1)]);
    assert!(owners.iter().all(|&pixels| pixels > 500), "{owners:?}");
}
