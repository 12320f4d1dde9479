//! Law: a run that goes on as a control volume keeps what it has. Mass and energy are those that the particles left and that
//! flowed in since, totals of the history go on, rows follow each other without a gap; and what follows is the course of the
//! control volume from there. It switches where it was asked to, and no sooner than pressures are uniform.

use corpuscle::simulation::{Options, Row};

use crate::whole_run::{Run, model, run};

/// A chamber blows down into a larger one around it, with a probe in the first and all walls watched.
fn blow_down(switch: &str) -> String {
    format!(
        "end_time = 4e-3\n[[gas]]\nname = \"nitrogen\"\nmolar_mass = 0.028\ngamma = 1.4\n\
         [[wall]]\nname = \"tank\"\nshape = \"box\"\nmin = [-0.02, -0.08, -0.08]\nmax = [0.36, 0.08, 0.08]\ngas = \"inside\"\n\
         [[wall]]\nname = \"inner\"\nshape = \"box\"\nmin = [0.0, -0.06, -0.06]\nmax = [0.16, 0.06, 0.06]\nthickness = 0.002\n\
         [[wall.hole]]\nname = \"hole\"\nface = \"+x\"\ncenter = [0.0, 0.0]\nsize = [0.04, 0.04]\n\
         [[chamber]]\nname = \"inner\"\npressure = 1e6\ntemperature = 700.0\ngas = \"nitrogen\"\n\
         region = {{ box = {{ min = [0.0, -0.06, -0.06], max = [0.16, 0.06, 0.06] }} }}\n\
         [[chamber]]\nname = \"tank\"\npressure = 2e5\ntemperature = 700.0\ngas = \"nitrogen\"\n\
         [[surface]]\nname = \"walls\"\nwall = \"tank\"\n[[probe]]\nname = \"left\"\n\
         region = {{ box = {{ min = [0.0, -0.06, -0.06], max = [0.08, 0.06, 0.06] }} }}\n\
         [model]\nparticles = 8000\n{switch}\n[output]\nrows = 40\nsnapshots = 0\n"
    )
}

/// Where the one surface is a face of this area across x, its impulse grows by pressure, area and time.
fn follow_each_other(rows: &[Row], end: f64, face: Option<f64>) {
    assert_eq!(rows[0].window[0], 0.0);
    assert!((rows[rows.len() - 1].window[1] / end - 1.0).abs() < 1e-9);
    for pair in rows.windows(2) {
        assert!(
            (pair[1].window[0] - pair[0].window[1]).abs() < 1e-9 * end,
            "{:?} {:?}",
            pair[0].window,
            pair[1].window
        );
        let Some(area) = face else { continue };
        let [before, after] = [0, 1].map(|k| pair[k].surfaces[0]);
        let length = pair[1].window[1] - pair[1].window[0];
        let grown = (after.impulse[0] - before.impulse[0]).abs() / (after.pressure * area * length);
        assert!((grown - 1.0).abs() < 1e-3, "{:?}: {grown}", pair[1].window);
    }
}

/// Mass and energy at the start and at the end of all, and those after the particles.
fn kept(run: &Run) -> &corpuscle::simulation::Continued {
    let (particles, continued) = (&run.outcome.audit, run.outcome.continued.as_ref().expect("it switched"));
    let then = &continued.audit;
    assert!((then.mass_start / particles.mass_end - 1.0).abs() < 1e-12);
    assert!((then.energy_start / particles.energy_end - 1.0).abs() < 1e-9);
    assert!(then.mass_error().abs() < 1e-12 && then.energy_error().abs() < 1e-9, "{then:?}");
    continued
}

#[test]
fn at_a_time_the_control_volume_takes_over_what_is_there() {
    let switched = model(&blow_down("method = \"closest-approach\"\nswitch = 1e-3"));
    let found = run(&switched, Options::default());
    let continued = kept(&found);
    let time = found.outcome.time;
    assert!((1e-3..1.1e-3).contains(&time) && continued.until == 4e-3 && continued.why == "asked for");
    follow_each_other(&found.rows, 4e-3, None);
    let late: Vec<&Row> = found.rows.iter().filter(|row| row.window[0] >= time * (1.0 - 1e-9)).collect();
    assert!(late.len() >= 29 && late.iter().all(|row| row.particles == 0 && row.surfaces[0].hits == 0));
    // It starts with what is there: p = (gamma - 1) U / V of the particles in each chamber as the run left them, spin and
    // bulk motion included. The course of the rows, led back to then by a parabola, is there within half a per cent.
    let plan = &switched.plan;
    let scales = corpuscle::subdomain::Scales::new(plan);
    let mut energies = [0.0; 2];
    for particle in &found.outcome.particles {
        let [x, y, z] = plan.grid.to_metres(particle.position);
        let outside = !(0.0..=0.16).contains(&x) || y.abs() > 0.06 || z.abs() > 0.06;
        let mass = plan.gases[0].molar_mass * plan.moles_per_particle;
        let speed2: f64 = particle.velocity.iter().map(|v| f64::from(*v).powi(2)).sum();
        energies[usize::from(outside)] += 0.5 * mass * speed2 + scales.reference_mass * f64::from(particle.spin);
    }
    for (chamber, energy) in energies.into_iter().enumerate() {
        let expected = 0.4 * energy / plan.chambers[chamber].volume;
        let [a, b, c] = [1, 2, 3].map(|k| [late[k].time, late[k].chambers[chamber].pressure]);
        let part = |p: [f64; 2], q: [f64; 2], r: [f64; 2]| {
            p[1] * (time - q[0]) * (time - r[0]) / ((p[0] - q[0]) * (p[0] - r[0]))
        };
        let led_back = part(a, b, c) + part(b, a, c) + part(c, a, b);
        println!("chamber {chamber}: {led_back:.0} Pa of {expected:.0} Pa");
        assert!((led_back / expected - 1.0).abs() < 0.005, "chamber {chamber}: {led_back} {expected}");
    }
    assert!(late.iter().all(|row| row.probes[0] == row.chambers[0]));
}

/// So do the particles of the method `half-turn`, whose rows are of longer steps.
#[test]
fn half_turn_hands_over_what_is_there() {
    let found = run(&model(&blow_down("method = \"half-turn\"\nswitch = 1e-3")), Options::default());
    let continued = kept(&found);
    assert!((1e-3..1.3e-3).contains(&found.outcome.time), "{}", found.outcome.time);
    assert!(continued.until == 4e-3 && continued.why == "asked for");
    follow_each_other(&found.rows, 4e-3, None);
    // Nothing jumps: the rows on either side of it are of one course, within its change from row to row and the noise
    // of 8000 particles.
    let at = found.rows.iter().position(|row| row.particles == 0).expect("rows of the control volume");
    for chamber in 0..2 {
        let pressure = |row: usize| found.rows[row].chambers[chamber].pressure;
        let change = (pressure(at + 1) - pressure(at)).abs();
        let length = |row: usize| found.rows[row].window[1] - found.rows[row].window[0];
        let longer = 0.5 * (length(at - 1) + length(at)) / length(at + 1);
        let jump = (pressure(at) - pressure(at - 1)).abs();
        assert!(jump < 2.0 * longer * change + 0.03 * pressure(at), "chamber {chamber}: {jump} {change}");
    }
}

/// A fast jet flows in for 2 ms; there must be a millisecond of uniform pressure after it, and not much more.
#[test]
fn it_switches_once_pressures_are_uniform() {
    let text = "end_time = 0.02\n[[gas]]\nname = \"nitrogen\"\nmolar_mass = 0.028\ngamma = 1.4\n\
         [[wall]]\nname = \"box\"\nshape = \"box\"\nmin = [0.0, 0.0, 0.0]\nmax = [0.1, 0.1, 0.1]\ngas = \"inside\"\n\
         [[chamber]]\nname = \"all\"\npressure = 5e4\ntemperature = 300.0\ngas = \"nitrogen\"\n\
         [[orifice]]\nname = \"inlet\"\nposition = [0.0, 0.05, 0.05]\ndirection = [1.0, 0.0, 0.0]\narea = 0.002\n\
         jet = { mach = 5.0, cone_angle = 10.0 }\ngas = \"nitrogen\"\ntemperature = 300.0\nmass_flow = [[0.0, 0.4], [2e-3, 0.4]]\n\
         [[surface]]\nname = \"behind the jet\"\nwall = \"box\"\nface = \"-x\"\n[[probe]]\nname = \"corner\"\n\
         region = { box = { min = [0.0, 0.0, 0.0], max = [0.1, 0.03, 0.03] } }\n\
         [model]\nmethod = \"closest-approach\"\nparticles = 6000\nswitch = \"when-uniform\"\nuniform_for = 1e-3\n[output]\nrows = 80\nsnapshots = 0\n";
    let found = run(&model(text), Options::default());
    let continued = kept(&found);
    println!("{:.4} ms: {}", 1e3 * found.outcome.time, continued.why);
    // A jet takes its momentum from the wall behind it: while it does, and a millisecond longer, nothing is uniform.
    assert!((3e-3..8e-3).contains(&found.outcome.time), "{}", found.outcome.time);
    assert!(continued.why.contains("within their noise"), "{}", continued.why);
    follow_each_other(&found.rows, 0.02, Some(0.01));
    let [particles, then] = [found.rows.iter().rfind(|row| row.particles > 0), found.rows.last()].map(Option::unwrap);
    let off = particles.chambers[0].pressure / then.chambers[0].pressure - 1.0;
    assert!(off.abs() < 0.01, "{off}");
}

/// Walls take heat, a vent passes gas and a piston works on it: what they took until the run ends, particles and control
/// volume together, is what the gas lost. The totals of the last row stand for it, and no total jumps where the one follows
/// on the other.
#[test]
fn totals_of_walls_vents_and_pistons_go_on() {
    let end = 6e-4;
    let text = format!(
        "end_time = {end:e}\n[[gas]]\nname = \"air\"\nmolar_mass = 0.029\ngamma = 1.4\n\
         [[wall]]\nname = \"box\"\nshape = \"box\"\nmin = [0.0, 0.0, 0.0]\nmax = [0.1, 0.06, 0.06]\ngas = \"inside\"\n\
         temperature = 300.0\nheat_transfer = 8000.0\n\
         [[wall]]\nname = \"piston\"\nshape = \"box\"\nmin = [-0.05, -0.01, -0.01]\nmax = [0.01, 0.07, 0.07]\ngas = \"outside\"\n\
         [[motion]]\nwall = \"piston\"\ndirection = [1.0, 0.0, 0.0]\nvelocity = 40.0\n\
         [[chamber]]\nname = \"all\"\npressure = 4e5\ntemperature = 600.0\ngas = \"air\"\n\
         [[surface]]\nname = \"walls\"\nwall = \"box\"\n\
         [[vent]]\nname = \"valve\"\nwall = \"box\"\nface = \"+x\"\ndischarge = 0.15\n\
         [model]\nparticles = 6000\nswitch = 3e-4\n[output]\nrows = 24\nsnapshots = 0\n"
    );
    let found = run(&model(&text), Options::default());
    let continued = found.outcome.continued.as_ref().expect("it switched");
    let totals = |row: &Row| [row.walls[0].heat, row.vents[0].enthalpy, -row.motions[0].work];
    let last = totals(found.rows.last().expect("rows"));
    let start = found.outcome.audit.energy_start;
    let lost = start - continued.audit.energy_end;
    println!("heat {:.4} J, enthalpy {:.4} J, work {:.4} J of {start:.4} J", last[0], last[1], -last[2]);
    assert!(last[0] > 0.01 * start && last[1] > 0.01 * start && last[2] < -0.01 * start, "{last:?} of {start}");
    assert!((lost / last.iter().sum::<f64>() - 1.0).abs() < 1e-5, "{lost} {last:?}");
    // A total that started anew would fall, one that was taken twice would grow by that of all rows.
    let at = found.rows.iter().position(|row| row.particles == 0).expect("rows of the control volume");
    let [before, after] = [at - 1, at].map(|row| &found.rows[row]);
    let length = (after.window[1] - before.window[1]) / before.window[1];
    for (before, after) in totals(before).into_iter().zip(totals(after)) {
        let grown = (after - before) / (before * length);
        assert!((0.4..2.5).contains(&grown), "{before} {after} in {length} of the time before");
    }
}
