//! `corpuscle stability`: maps as files, and what is no case.

use std::fs;

use super::{names_below, outcome, printed};

/// With one round a fifth of the collisions is lost at x = .2, with four almost none: the map, its files and its page say so.
#[test]
fn a_quick_map_finds_what_breaks_first() {
    let folder = tempfile::tempdir().unwrap();
    let (out, page) = (folder.path().join("map"), folder.path().join("limits.md"));
    let (to, at) = (out.to_str().unwrap(), page.to_str().unwrap());
    let text = printed(&["stability", "rounds", "--quick", "--out", to, "--markdown", at]);
    assert_eq!(text.lines().last(), Some(to));
    assert!(text.contains("holds to 4; at 1 ") && text.contains("(guard: at least 3)"), "{text}");
    let row = text.lines().find(|line| line.starts_with("closest-approach")).unwrap();
    assert!(row.contains("holds ") && row.contains(" x"), "{row}");
    assert_eq!(names_below(&out), [".corpuscle-run", "stability.csv", "stability.svg", "stability.txt"]);
    let csv = fs::read_to_string(out.join("stability.csv")).unwrap();
    let state = |start: &str| csv.lines().find(|line| line.starts_with(start)).map(|line| line.rsplit(',').nth(1));
    assert_eq!(state("rounds,closest-approach,4,energy"), Some(Some("holds")), "{csv}");
    assert_eq!(state("rounds,closest-approach,1,collision rate"), Some(Some("broken")), "{csv}");
    let page = fs::read_to_string(page).unwrap();
    assert!(
        page.contains("corpuscle stability rounds --quick --markdown") && page.contains("| method | 4 | 1 |"),
        "{page}"
    );
}

#[test]
fn what_is_no_axis_is_2() {
    let (code, _, err) = outcome(&["stability", "rounds", "temperature"]);
    assert!(
        code == 2 && err.contains("`temperature`") && err.contains("temperature-ratio") && err.contains("all"),
        "{err}"
    );
    assert_eq!(outcome(&["stability"]).0, 2);
    assert_eq!(outcome(&["stability", "all", "temperature"]).0, 2, "beside all, too");
    let list = printed(&["stability", "--list"]);
    assert!(list.lines().count() >= 10 && list.contains("mass-ratio         heavier over lighter gas"), "{list}");
}
