use super::*;

fn warned(when: &str) -> Warned {
    Warned {
        when: when.to_owned(),
        what: "probe `jet`: 4 particles, at least 100".to_owned(),
        remedy: "more `particles`".to_owned(),
    }
}

fn going() -> Seen {
    let ramp = |from: f64, to: f64| (0..60).map(|k| from + (to - from) * f64::from(k) / 59.0).collect::<Vec<_>>();
    Seen {
        title: "Tank test, 60 L".to_owned(),
        state: Progressing::Going("process 7 of host: corpuscle run scenes/tank.toml".to_owned()),
        verdict: Verdict { level: "unknown", word: "This run goes on".to_owned(), lines: Vec::new() },
        reached: 0.03,
        end: 0.1,
        time: "s",
        told: "1 min 31 s left, 105 steps/s, 306 k particle-steps/s".to_owned(),
        rows: [60, 200],
        snapshots: [4, 11],
        lines: vec![
            Line { name: "particles".to_owned(), values: ramp(1416.0, 2400.0) },
            Line { name: "inner pressure, Pa".to_owned(), values: [ramp(1e5, 4e5), ramp(4e5, 2e5)].concat() },
        ],
        warned: (0..7).map(|k| warned(&format!("at {k} ms"))).collect(),
    }
}

#[test]
fn a_run_that_goes_on_is_told_in_text() {
    insta::assert_snapshot!(going().render(100), @r#"
    Tank test, 60 L: goes on (process 7 of host: corpuscle run scenes/tank.toml)
    [#########.......................] 30 %  0.03000 of 0.1000 s, 1 min 31 s left, 105 steps/s, 306 k
        particle-steps/s
    rows 60 of 200, snapshots 4 of 11

                               now       least        most
    particles               2400.0      1416.0      2400.0  ▁▁▁▁▁▂▂▂▂▂▃▃▃▃▃▄▄▄▄▄▅▅▅▅▅▆▆▆▆▆▇▇▇▇▇█████
    inner pressure, Pa      200000      100000      400000  ▁▁▁▂▂▃▃▃▄▄▅▅▆▆▆▇▇███████▇▇▇▇▆▆▆▅▅▅▅▄▄▄▄▃

    2 earlier warnings

    warning at 2 ms: probe `jet`: 4 particles, at least 100; more `particles`
    warning at 3 ms: probe `jet`: 4 particles, at least 100; more `particles`
    warning at 4 ms: probe `jet`: 4 particles, at least 100; more `particles`
    warning at 5 ms: probe `jet`: 4 particles, at least 100; more `particles`
    warning at 6 ms: probe `jet`: 4 particles, at least 100; more `particles`
    "#);
}

#[test]
fn a_run_that_was_killed_says_so_and_one_without_rows_has_none() {
    let mut killed = Seen { state: Progressing::Stopped, warned: Vec::new(), ..going() };
    killed.verdict.word = "This run has not reached its end".to_owned();
    killed.verdict.lines = vec!["its history ends at 30 ms of 100 ms".to_owned()];
    killed.lines.iter_mut().for_each(|line| line.values.clear());
    insta::assert_snapshot!(killed.render(60), @r#"
    Tank test, 60 L: This run has not reached its end
      its history ends at 30 ms of 100 ms
    [#########.......................] 30 %  0.03000 of 0.1000 s
    rows 60 of 200, snapshots 4 of 11

    no rows yet
    "#);
}

#[test]
fn the_last_line_of_progress_is_found_in_a_log() {
    let log = "2026-11-28T20:03:16Z  INFO 89 %: 89.19 ms of 100.00 ms, 22.7 s left, 92.6 steps/s\n\
               2026-11-28T20:03:17Z  WARN probe `jet`: 4 particles\n\
               2026-11-28T20:03:18Z  INFO opens at 3 %: of 4, not this\n";
    assert_eq!(last_told(log), "22.7 s left, 92.6 steps/s");
    assert_eq!(last_told(""), "");
}

/// Heights follow the values and not their order alone.
#[test]
fn a_course_rises_with_its_values() {
    assert_eq!(course(&[0.0, 1.0, 0.5, 0.0], [0.0, 1.0], 4), "▁█▅▁");
    assert_eq!(course(&[0.0, 2.0, 4.0, 4.0], [0.0, 4.0], 2), "▃█");
    assert_eq!(course(&[3.0, 3.0], [3.0, 3.0], 8), "▁▁");
    assert_eq!(course(&[], [0.0, 1.0], 8), "");
}
