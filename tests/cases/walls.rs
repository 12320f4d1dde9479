//! Holes that are no openings, gaps round what was meant to part chambers, walls that hardly move.

use super::mistakes::{chamber, metre, model};

const PISTON: &str = include_str!("inputs/walls/piston.toml");
const AIR: &str = super::mistakes::AIR;

/// What a plan notes and doubts, and warns of walls; not what it warns of few particles in the hole.
fn told(text: &str) -> Vec<String> {
    let model = model(text);
    let mut told = [model.notes(), model.plan.told()].concat();
    told.retain(|text| !text.starts_with("opening `throat`"));
    told
}

fn changed(lines: &[[&str; 2]]) -> String {
    lines.iter().fold(PISTON.to_string(), |text, [found, wanted]| {
        assert!(text.contains(found), "{found}");
        text.replacen(found, wanted, 1)
    })
}

/// A block behind the plate, from these y and z, to this y.
fn block(low: i32, high: i32) -> String {
    format!(
        "[[wall]]\nname = \"block\"\nshape = \"box\"\nmin = [102, {low}, {low}]\nmax = [110, {high}, 15]\ngas = \"outside\"\n\n[[motion]]"
    )
}

const WIDE: [&str; 2] = ["size = [60, 60]", "size = [120, 60]"];
const CENTER: &str = "center = [0, 0]\n";

#[test]
fn holes_gaps_and_strokes_that_were_not_meant_are_told() {
    let [whole, part] = [block(-15, 15), block(-15, 0)];
    let slips: &[(&[[&str; 2]], &[&str])] = &[
        (
            &[["velocity = 6000", "velocity = 6"]],
            &[
                "motion of wall `piston`: it moves by 0.048 mm",
                "chamber `left`",
                "in m/s? This scene has mm/s (line 38)",
            ],
        ),
        (
            &[["velocity = 6000", "displacement = [[0, 0], [0.008, 0.048]]"]],
            &[
                "motion of wall `piston`: it moves by 0.048 mm",
                "is its `displacement` in m? This scene has mm (line 38)",
            ],
        ),
        (
            &[WIDE, [CENTER, "center = [40, 0]\n"]],
            &[
                "hole `throat` of wall `plate`: no gas lies",
                "outside of wall `duct`, which encloses the gas",
                "(line 26)",
            ],
        ),
        (
            &[WIDE, [CENTER, "center = [24, 0]\n"]],
            &[
                "hole `throat` of wall `plate`: about 175.9 of its 314.2 mm2 are open",
                "outside of wall `duct`",
                "(line 26)",
            ],
        ),
        (
            &[["[[motion]]", &whole]],
            &["hole `throat` of wall `plate`: no gas lies", "it is covered by wall `block`", "(line 26)"],
        ),
        (
            &[["[[motion]]", &part]],
            &["hole `throat` of wall `plate`: about 157.1 of its 314.2 mm2 are open", "covered by wall `block`"],
        ),
        (
            &[["[-60, -27, -27]", "[-60, -24, -24]"], ["[0, 27, 27]", "[0, 24, 24]"]],
            &[
                "wall `piston`: a gap of 1 mm lies between walls `duct` and `piston` near",
                "flows round the wall as it moves",
            ],
        ),
        (
            &[["size = [60, 60]", "size = [40, 40]"]],
            &[
                "wall `plate`: a gap of 5 mm lies between walls `duct` and `plate`",
                "chambers `left` and `right` are open",
            ],
        ),
        (
            &[["size = [60, 60]", "size = [60, 46]"]],
            &["2 mm", "between walls `duct` and `plate`", "et the walls overlap if they were meant to touch"],
        ),
        (
            &[["center = [100, 0, 0]", "center = [100, 0, -25]"], [CENTER, "center = [0, 18]\n"]],
            &[
                "chambers `left` and `right`: no wall lies between them on about 38 % of where they touch: it is an open",
            ],
        ),
    ];
    let mut wrong = Vec::new();
    for (lines, words) in slips {
        // A gap is told whatever the number of particles.
        let counts = ["particles = 20000", "particles = 1000000"];
        let count = if words.iter().any(|word| word.contains("between walls")) { 2 } else { 1 };
        for particles in &counts[..count] {
            let found = told(&changed(&[*lines, &[["particles = 20000", particles]]].concat()));
            if !found.iter().any(|text| words.iter().all(|word| text.contains(word))) {
                wrong.push(format!("{words:?} in {found:#?}"));
            }
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

/// The piston as it is, one that swings by little and often, a plate that ends at the walls, and a hole as wide as its duct.
#[test]
fn what_is_meant_has_no_note() {
    let swings: Vec<String> =
        (0..200).map(|k| format!("[{}, {}]", 4e-5 * f64::from(k), 0.1 * f64::from(k % 2))).collect();
    let swings = format!("displacement = [{}]", swings.join(", "));
    for lines in [
        &[][..],
        &[["velocity = 6000", &swings]],
        &[["size = [60, 60]", "size = [50, 50]"]],
        &[["diameter = 20", "size = [50, 20]"]],
    ] {
        assert_eq!(told(&changed(lines)), [""; 0], "{lines:?}");
    }
}

/// A piston that uncovers a hole in the course of the run.
#[test]
fn a_hole_that_a_moving_wall_uncovers_is_open() {
    let shell = "[[wall]]\nname = \"shell\"\nshape = \"box\"\nmin = [0.2, 0.2, 0.2]\nmax = [0.4, 0.4, 0.4]\nthickness = 0.01\n\
        hole = [{ name = \"slit\", face = \"+x\", center = [0.3, 0.3], size = [0.1, 0.1] }]\n\
        [[wall]]\nname = \"lid\"\nshape = \"box\"\nmin = [0.405, 0.2, 0.2]\nmax = [0.43, 0.4, 0.4]\ngas = \"outside\"\n";
    let chambers =
        chamber("inner", "box = { min = [0.2, 0.2, 0.2], max = [0.4, 0.4, 0.4] }", AIR) + &chamber("rest", "", AIR);
    let holes = |far: f64| {
        let motion =
            format!("[[motion]]\nwall = \"lid\"\ndirection = [0, 0, 1]\ndisplacement = [[0, 0], [1e-3, {far}]]");
        let mut notes = model(&metre(shell, &chambers, &motion)).notes();
        notes.retain(|note| note.starts_with("hole "));
        notes
    };
    assert_eq!(holes(0.3), [""; 0]);
    assert!(holes(0.04)[0].contains("no gas lies before one of its sides: it is covered by wall `lid`"));
    assert!(holes(0.08)[0].contains("of its 0.01 m2 are open: the rest is covered by wall `lid`"), "{:?}", holes(0.08));
}

/// A coefficient in W/(m2 K), where the unit is mJ/(s mm2 K), a thousand of it.
#[test]
fn heat_transfer_in_another_unit_is_told() {
    let heated = "gas = \"inside\"\ntemperature = 293\nheat_transfer = 100";
    let found = told(&changed(&[["gas = \"inside\"", heated]]));
    let words = [
        "wall `duct`: heat_transfer 100 mJ/(s mm2 K), usual is 0.0001 to below 10",
        "is it in W/(m2 K)? 100 W/(m2 K) are 0.1 mJ/(s mm2 K)",
    ];
    assert!(found.iter().any(|text| words.iter().all(|word| text.contains(word))), "{found:?}");
}

/// The rows of all gas say what they leave out.
#[test]
fn the_work_of_moving_walls_is_said_to_be_left_out() {
    let plan = model(PISTON).explained();
    let words = "no heat lost, without the work of moving walls";
    let rows = plan.render().lines().filter(|row| row.contains(words)).count();
    assert_eq!(rows, 2, "{}", plan.render());
    let still = model(super::plausible::TANK).explained().render();
    assert!(still.contains("no heat lost") && !still.contains("moving walls"));
}

/// How far a wall moves, where to, and how far in all.
#[test]
fn the_way_of_a_wall_is_said() {
    let row = |more: &[[&str; 2]]| {
        let text = model(&changed(more)).plan.inventory.render();
        assert!(text.contains("moving wall  moves until the end by  towards"), "{text}");
        let row = text.lines().rfind(|line| line.starts_with("piston ")).unwrap();
        row.split_whitespace().collect::<Vec<_>>().join(" ")
    };
    assert_eq!(row(&[]), "piston 48 mm (1, 0, 0)");
    assert_eq!(row(&[["velocity = 6000", "velocity = -3000"]]), "piston 24 mm (-1, 0, 0)");
    let back = "displacement = [[0, 0], [0.004, 30], [0.008, 10]]";
    assert_eq!(row(&[["velocity = 6000", back]]), "piston 10 mm (1, 0, 0) to and fro 50 mm in all");
}

/// A hole that is covered has its own note, and none that its chambers touch without a wall; without the wall they do.
#[test]
fn a_covered_hole_has_one_note() {
    let shell = "[[wall]]\nname = \"shell\"\nshape = \"box\"\nmin = [0.2, 0.2, 0.2]\nmax = [0.4, 0.4, 0.4]\nthickness = 0.01\n\
        hole = [{ name = \"slit\", face = \"+x\", center = [0.3, 0.3], size = [0.1, 0.1] }]\n";
    let lid = "[[wall]]\nname = \"lid\"\nshape = \"box\"\nmin = [0.405, 0.2, 0.2]\nmax = [0.43, 0.4, 0.4]\ngas = \"outside\"\n";
    let high = "pressure = 3e5\ntemperature = 300\ngas = \"n2\"";
    let chambers =
        chamber("inner", "box = { min = [0.2, 0.2, 0.2], max = [0.4, 0.4, 0.4] }", high) + &chamber("rest", "", AIR);
    let notes = |walls: &str| {
        let mut notes = model(&metre(walls, &chambers, "")).notes();
        notes.retain(|note| note.starts_with("hole ") || note.starts_with("chambers "));
        notes
    };
    let covered = notes(&format!("{shell}{lid}"));
    assert!(covered.len() == 1 && covered[0].starts_with("hole `slit` of wall `shell`: no gas lies"), "{covered:?}");
    assert_eq!(notes(shell), [""; 0]);
    assert!(notes("").iter().any(|note| note.contains("no wall lies between them")));
}

/// An orifice on a wall that points into it is refused with its line; one just off a wall that blows at it has a note, one that blows
/// away from it has none. Errors of chambers have their lines, too.
#[test]
fn an_orifice_that_points_into_a_wall_is_told() {
    let tank = super::plausible::TANK;
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("tank.toml");
    let refused = |lines: &[[&str; 2]]| {
        std::fs::write(&path, lines.iter().fold(tank.to_string(), |text, [a, b]| text.replacen(a, b, 1))).unwrap();
        let (code, _, err) = super::outcome(&["check", path.to_str().unwrap()]);
        assert_eq!(code, 2, "{err}");
        err
    };
    let into = ["direction = [0.0, 0.0, 1.0]", "direction = [0.0, 0.0, -1.0]"];
    let err = refused(&[into]);
    assert!(err.contains("tank.toml, line 23: orifice \"inflator\": `direction` points into the wall"), "{err}");
    let err = refused(&[["position = [0.2, 0.15, 0.0]", "position = [0.2, 0.15, -0.1]"]]);
    assert!(err.contains("tank.toml, line 23: orifice \"inflator\": its disc"), "{err}");
    let away = "[[chamber]]\nregion = { box = { min = [1, 1, 1], max = [2, 2, 2] } }";
    let err = refused(&[["[[chamber]]", away]]);
    assert!(err.contains("tank.toml, line 18: chamber `tank` has a volume of 0"), "{err}");
    let off = ["position = [0.2, 0.15, 0.0]", "position = [0.2, 0.15, 0.002]"];
    let notes = |lines: &[[&str; 2]]| {
        let text = lines.iter().fold(tank.to_string(), |text, [a, b]| text.replacen(a, b, 1));
        let mut notes = model(&text).notes();
        notes.retain(|note| note.starts_with("orifice "));
        notes
    };
    let told = notes(&[off, into]);
    assert!(told[0].contains("its jet meets wall `tank` after 0.00") && told[0].ends_with("(line 23)"), "{told:?}");
    assert_eq!(notes(&[off]), [""; 0]);
}

/// A duct of half its length has the work of a slow piston: p V^1.4 and T V^.4 stay. Beside an inflow it is not known.
#[test]
fn the_work_of_slow_walls_is_told() {
    let told = |more: &[[&str; 2]]| {
        let text = model(&changed(more)).explained().render();
        text.lines().find(|line| line.starts_with("all gas")).unwrap().to_string()
    };
    // The piston comes in by 48 of 200 mm; the plate of 4 mm has a hole of 314 mm2.
    let ratio: f64 = (500_000.0 - 4.0 * (2500.0 - 314.16)) / (380_000.0 - 4.0 * (2500.0 - 314.16));
    let row = told(&[]);
    let (pressure, temperature) = (0.101325 * ratio.powf(1.4), 293.0 * ratio.powf(0.4));
    let words =
        format!("without the work of moving walls; {pressure:.2} MPa, {temperature:.1} K with it, if they are slow");
    assert!(row.ends_with(&words), "{words}: {row}");
    let orifice = "[[orifice]]\nname = \"o\"\nposition = [200, 0, 0]\ndirection = [-1, 0, 0]\narea = 50\ngas = \"air\"\ntemperature = 400\n\
        mass_flow = [[0, 1e-5], [0.008, 1e-5]]\n[[motion]]";
    assert!(told(&[["[[motion]]", orifice]]).ends_with("which depends on when gas comes in"));
}
