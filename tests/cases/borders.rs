//! Chambers that no wall parts, holes that join none, gaps beside what was to part them.

use super::mistakes::{AIR, LEFT, chamber, metre, model};

/// Chambers of unlike gas that touch are told with what they differ in, those of like gas as one gas space; on two sides of a wall they
/// are not.
#[test]
fn chambers_without_a_wall_between_are_told() {
    let notes = |walls: &str, state: &str| {
        let chambers = chamber("left", LEFT, state) + &chamber("right", "", AIR);
        model(&metre(walls, &chambers, "")).notes()
    };
    let plate = "[[wall]]\nname = \"plate\"\nshape = \"box\"\nmin = [0.49, -0.1, -0.1]\nmax = [0.51, 1.1, 1.1]\ngas = \"outside\"";
    for (state, words) in [
        (
            "pressure = 3e5\ntemperature = 300\ngas = \"n2\"",
            "they have 300000 Pa and 100000 Pa: they mix from the first step",
        ),
        ("pressure = 1e5\ntemperature = 400\ngas = \"n2\"", "they have 400 K and 300 K"),
        ("pressure = 1e5\ntemperature = 300\ngas = \"he\"", "they have unlike gas"),
    ] {
        let told = notes("", state);
        let note = told.iter().find(|note| note.starts_with("chambers `left` and `right`: no wall lies between them"));
        assert!(note.is_some_and(|note| note.contains(words) && note.ends_with("(line 17)")), "{told:?}");
        let told = notes(plate, state);
        assert!(told.iter().all(|note| !note.contains("no wall lies between")), "{told:?}");
    }
    let [note] = &notes("", AIR)[..] else { panic!("{:?}", notes("", AIR)) };
    let words = "chambers `left` and `right`: no wall lies between them where they touch: they are one gas space.";
    assert!(note.starts_with(words) && note.ends_with("(line 17)"), "{note}");
    assert_eq!(notes(plate, AIR), ["2 separate gas spaces: no gas flows between them"]);
}

/// A panel that covers a part of the section is told with the part that it leaves, whether the gas on its sides is alike or not; its
/// hole, and what the scene declares as an opening, are none of it.
#[test]
fn a_panel_that_covers_too_little_is_told() {
    let notes_by = |method: &str, size: &str, state: &str, more: &str| {
        let panel = format!(
            "[[wall]]\nname = \"panel\"\nshape = \"plane\"\ncenter = [0.5, 0.5, 0.5]\nnormal = [1, 0, 0]\nu = [0, 1, 0]\nsize = {size}\n\
             thickness = 0.02\n[[wall.hole]]\nname = \"port\"\ncenter = [0, 0]\ndiameter = 0.2\n"
        );
        let chambers = chamber("left", LEFT, state) + &chamber("right", "", AIR);
        let mut notes = model(&metre(&panel, &chambers, more).replace("particles = 2000", method)).notes();
        notes.retain(|note| note.starts_with("chambers `left` and `right`: no wall lies between them"));
        notes
    };
    let notes = |size: &str, state: &str, more: &str| notes_by("particles = 2000", size, state, more);
    // .4 of the section, to the sixteenth part of its edge.
    let high = "pressure = 3e5\ntemperature = 300\ngas = \"n2\"";
    let told = notes("[1.2, 0.6]", AIR, "");
    assert!(
        told.len() == 1 && told[0].contains("on about 38 % of where they touch: it is an open passage"),
        "{told:?}"
    );
    let told = notes("[0.6, 1.2]", high, "");
    assert!(
        told.len() == 1 && told[0].contains("on about 38 % of where they touch, and they have 300000 Pa"),
        "{told:?}"
    );
    let by_volumes = "method = \"control-volume\"";
    assert_eq!(notes_by(by_volumes, "[0.6, 1.2]", AIR, ""), notes("[0.6, 1.2]", AIR, ""));
    assert_eq!(notes_by(by_volumes, "[1.2, 1.2]", AIR, ""), [""; 0]);
    let declared = "[[opening]]\nname = \"pass\"\nbetween = [\"left\", \"right\"]\narea = 0.4";
    assert_eq!(notes("[1.2, 0.6]", AIR, declared), [""; 0]);
    for state in [AIR, high] {
        assert_eq!(notes("[1.2, 1.2]", state, ""), [""; 0]);
    }
}

/// The facets of a can lie partly beyond the region of its radius: a film that other chambers have there is no open section.
#[test]
fn a_round_region_beside_facets_does_not_touch() {
    let notes = |plate: f64| {
        let text = format!(
            "end_time = 1e-3\n[[gas]]\nname = \"n2\"\nmolar_mass = 0.028\ngamma = 1.4\n[[wall]]\nname = \"can\"\nshape = \"cylinder\"\n\
             base = [0, 0, 0]\naxis = [0, 0, 1]\nradius = 0.2\nheight = 1\ngas = \"inside\"\n[[wall]]\nname = \"plate\"\nshape = \"plane\"\n\
             center = [0, 0, 0.5]\nnormal = [0, 0, 1]\nu = [1, 0, 0]\nsize = [0.6, {plate}]\nthickness = 0.02\n{}{}[model]\nparticles = 2000\n",
            chamber("low", "cylinder = { base = [0, 0, 0], axis = [0, 0, 1], radius = 0.2, height = 0.5 }", AIR),
            chamber("rest", "", AIR)
        );
        let mut notes = model(&text).notes();
        notes.retain(|note| note.starts_with("chambers "));
        notes
    };
    assert_eq!(notes(0.6), [""; 0]);
    assert!(notes(0.2)[0].starts_with("chambers `low` and `rest`: no wall lies between them on about "));
}

/// A hole with one chamber on both sides is no opening, nor is one that something covers.
#[test]
fn a_hole_that_joins_no_two_chambers_is_told() {
    let shell = "[[wall]]\nname = \"shell\"\nshape = \"box\"\nmin = [0.2, 0.2, 0.2]\nmax = [0.4, 0.4, 0.4]\nthickness = 0.01\n\
        hole = [{ name = \"slit\", face = \"+x\", center = [0.3, 0.3], size = [0.1, 0.1] }]\n";
    let lid = "[[wall]]\nname = \"lid\"\nshape = \"box\"\nmin = [0.405, 0.2, 0.2]\nmax = [0.43, 0.4, 0.4]\ngas = \"outside\"\n";
    let inner = chamber("inner", "box = { min = [0.2, 0.2, 0.2], max = [0.4, 0.4, 0.4] }", AIR);
    let rest = chamber("rest", "", AIR);
    let notes = |walls: &str, chambers: &str| {
        let mut notes = model(&metre(walls, chambers, "")).notes();
        notes.retain(|note| note.starts_with("hole `slit` of wall `shell`: "));
        notes
    };
    assert!(notes(shell, &rest)[0].contains("on both its sides is that of chamber `rest`, so it is no opening"));
    let both = inner + &rest;
    assert_eq!(notes(shell, &both), [""; 0]);
    assert!(notes(&format!("{shell}{lid}"), &both)[0].contains("no gas lies before one of its sides"));
}

/// A slit beside a plate that was meant to close: a note with both walls and a place, and where it is narrower than what collides
/// across it a warning in place of the note. A plate that reaches into the walls has none.
#[test]
fn a_gap_beside_a_plate_is_told_with_its_walls() {
    let told = |top: f64, particles: u64| {
        let plate = format!(
            "[[wall]]\nname = \"plate\"\nshape = \"box\"\nmin = [0.49, -0.1, -0.1]\nmax = [0.51, 1.1, {top}]\ngas = \"outside\""
        );
        let chambers = chamber("left", LEFT, AIR) + &chamber("right", "", AIR);
        let text = metre(&plate, &chambers, "").replace("particles = 2000", &format!("particles = {particles}"));
        let model = model(&text);
        (model.notes(), model.plan.warnings)
    };
    let (notes, _) = told(0.985, 10_000_000);
    let walls = "the narrowest gap, 0.015 m between walls `tank` and `plate` near (0.";
    assert!(
        notes.iter().any(|note| note.starts_with(walls) && note.contains("if they were meant to touch")),
        "{notes:?}"
    );
    let (notes, warnings) = told(0.999, 20_000);
    let walls = "the smallest passage, 1 mm between walls `tank` and `plate` near (";
    let warned =
        |text: &String| text.starts_with(walls) && text.contains("let the walls overlap if they were meant to touch");
    assert!(
        warnings.iter().any(warned) && notes.iter().all(|note| !note.contains("narrowest gap")),
        "{warnings:?} {notes:?}"
    );
    let (notes, warnings) = told(1.1, 20_000);
    assert!(warnings.iter().chain(&notes).all(|text| !text.contains("the walls overlap")), "{warnings:?} {notes:?}");
}
