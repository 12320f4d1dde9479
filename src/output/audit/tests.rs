use super::*;

fn clean() -> Audit {
    Audit {
        particles_initial: 9_440,
        particles_injected: 10_560,
        particles_vented: 1_000,
        particles_inside: 19_000,
        particles_outside: 0,
        through_fabric: None,
        passed: None,
        mass_start: 0.07,
        mass_injected: 0.08,
        mass_vented: 0.01,
        mass_end: 0.14,
        momentum_start: [0.0; 3],
        momentum_injected: [12.0, 0.0, 0.0],
        momentum_to_walls: None,
        momentum_end: [1e-3, -2e-3, 0.0],
        energy_start: 15_000.0,
        enthalpy_injected: 57_000.0,
        enthalpy_vented: 2_000.0,
        heat_to_walls: None,
        work_by_walls: None,
        fabric: None,
        clipped_vents: Vec::new(),
        clipped_surfaces: Vec::new(),
        energy_end: 70_000.5,
        lost_collision_fraction: Some(0.012),
        collision_cells: None,
        wall_overshoot: 1e-9,
        truncated_flights: 0,
        caught_flights: None,
        overflows: Vec::new(),
    }
}

#[test]
fn an_account_that_closes_passes_and_each_one_that_does_not_is_named() {
    let limits = AuditLimits::default();
    assert_eq!(clean().verdict(&limits), Vec::<String>::new());
    assert_eq!(clean().warnings(&limits), Vec::<String>::new());
    type Spoil = fn(&mut Audit);
    let faults: [(Spoil, &str); 9] = [
        (|a| a.particles_inside -= 1, "20,000 particles entered and 19,999"),
        (|a| (a.particles_inside, a.particles_outside) = (18_998, 2), "2 particles are outside"),
        (|a| a.mass_end *= 1.001, "the mass is off"),
        (|a| a.energy_end += 72.0, "the energy is off by 1.01e-3"),
        (|a| a.energy_end = f64::NAN, "the energy is off by NaN"),
        (|a| a.wall_overshoot = 1e-3, "1.00e-3 m beyond a wall"),
        (|a| a.wall_overshoot = f64::NAN, "beyond a wall"),
        (|a| a.truncated_flights = 5, "5 flights"),
        (|a| a.overflows.push("energy tally".to_owned()), "energy tally overflowed"),
    ];
    for (spoil, expected) in faults {
        let mut audit = clean();
        spoil(&mut audit);
        let verdict = audit.verdict(&limits);
        assert_eq!(verdict.len(), 1, "{verdict:?}");
        assert!(verdict[0].contains(expected), "{verdict:?} without {expected:?}");
    }
}

#[test]
fn lost_collisions_warn_and_do_not_fail() {
    let audit = Audit { lost_collision_fraction: Some(0.05), ..clean() };
    let limits = AuditLimits::default();
    assert!(audit.verdict(&limits).is_empty());
    assert!(audit.warnings(&limits)[0].starts_with("5.0 % of the collisions were lost"));
    let none = Audit { lost_collision_fraction: None, ..clean() };
    assert!(none.warnings(&limits).is_empty() && none.render().contains("no collisions"));
}

/// A few flights that fabric caught are told, more make a warning, and many fail the run; those cut short between walls always do.
#[test]
fn flights_that_fabric_caught_warn_before_they_fail() {
    let limits = AuditLimits::default();
    let caught = |share: f64| Audit { caught_flights: Some(CaughtFlights { flights: 1234, share }), ..clean() };
    let few = caught(5e-5);
    assert!(few.verdict(&limits).is_empty() && few.warnings(&limits).is_empty());
    assert!(few.render().contains("flights caught by fabric   1,234, 0.0050 % of particle-steps"), "{}", few.render());
    let more = caught(2e-3);
    assert!(more.verdict(&limits).is_empty());
    assert!(more.warnings(&limits)[0].contains("till the next step: 1,234, 0.2000 % of particle-steps"), "{more:?}");
    for share in [0.02, f64::NAN] {
        let many = caught(share);
        let verdict = many.verdict(&limits);
        assert!(verdict.len() == 1 && verdict[0].contains("were caught by elastic fabric"), "{verdict:?}");
    }
    let cut_short = Audit { truncated_flights: 1, ..few };
    assert!(cut_short.verdict(&limits)[0].contains("1 flights had more bounces"));
}

/// The gas keeps what it had and got less what the walls received: checked where that is known.
#[test]
fn the_momentum_closes_where_the_walls_part_is_known() {
    let limits = AuditLimits::default();
    let received = |x: f64| Audit { momentum_to_walls: Some([x, 2e-3, 0.0]), ..clean() };
    let closed = received(12.0 - 1e-3);
    assert!(closed.verdict(&limits).is_empty() && closed.momentum_error().unwrap() < 1e-12);
    // All gas flying one way has sqrt(2 x 72,000 J x 0.15 kg) = 147.0 kg m/s.
    let off = received(12.03);
    assert!((off.momentum_error().unwrap() - 0.031 / 147.0).abs() < 1e-7);
    let verdict = off.verdict(&limits);
    assert!(verdict.len() == 1 && verdict[0].starts_with("the momentum is off by 2.11e-4"), "{verdict:?}");
    assert_eq!(received(f64::NAN).verdict(&limits).len(), 1);
    assert_eq!(clean().momentum_error(), None);
}

/// What was there counts, not what is left: a vessel pumped empty passes, and a fault in its momentum is found still.
#[test]
fn a_vessel_pumped_empty_is_judged_by_what_it_held() {
    let limits = AuditLimits::default();
    let empty = |to_walls: f64| Audit {
        particles_vented: 20_000,
        particles_inside: 0,
        mass_vented: 0.15,
        mass_end: 0.0,
        momentum_end: [0.0; 3],
        momentum_to_walls: Some([to_walls, 0.0, 0.0]),
        enthalpy_vented: 72_000.0,
        energy_end: 0.0,
        ..clean()
    };
    assert_eq!(empty(12.0 + 1e-9).verdict(&limits), Vec::<String>::new());
    let verdict = empty(12.0 + 1.1e-4 * 147.0).verdict(&limits);
    assert!(verdict.len() == 1 && verdict[0].starts_with("the momentum is off by 1.10e-4"), "{verdict:?}");
    // So is what a piston let expand to nothing: the work that the gas did was its own.
    let expanded = Audit { work_by_walls: Some(-71_999.0), enthalpy_vented: 1.0, ..empty(12.0) };
    assert_eq!(expanded.energy_error(), 0.0);
    let off = Audit { enthalpy_vented: 1.0 + 7.3, ..expanded };
    assert!((off.energy_error() - 7.3 / 72_000.0).abs() < 1e-9 && off.verdict(&limits).len() == 1);
}

#[test]
fn the_energy_error_is_relative_to_all_energy_that_entered() {
    let audit = clean();
    assert!((audit.energy_error() - 0.5 / 72_000.0).abs() < 1e-12);
    // Leaving the vented enthalpy out would be an error of 2.8 %.
    let forgotten = Audit { enthalpy_vented: 0.0, ..audit };
    assert!((forgotten.energy_error() + 1999.5 / 72_000.0).abs() < 1e-12);
}

#[test]
fn the_table_shows_every_account() {
    insta::assert_snapshot!(clean().render(), @r"
    Audit            start           in          out          end     error
    particles        9,440       10,560        1,000       19,000         0
    mass, kg   7.000000e-2  8.000000e-2  1.000000e-2  1.400000e-1   +0.00e0
    energy, J   1.500000e4   5.700000e4   2.000000e3   7.000050e4  +6.94e-6
    outside the vessel         0
    lost collisions            1.200 %
    largest wall overshoot, m  1.00e-9
    truncated flights          0
    overflows                  none
    momentum, kg m/s, start    (0.000e0, 0.000e0, 0.000e0)
      injected                 (1.200e1, 0.000e0, 0.000e0)
      to the walls             not tallied: no surfaces
      end                      (1.000e-3, -2.000e-3, 0.000e0)
      error                    unknown
    ");
    let told = Audit { momentum_to_walls: Some([11.999, 2e-3, 0.0]), ..clean() }.render();
    assert!(told.contains("to the walls             (1.200e1, 2.000e-3, 0.000e0)"), "{told}");
    assert!(!told.contains("unknown"), "{told}");
    let cells = CollisionCells { free_flights: 2e-4, unfitted: 0.013, cut_groups: 8.25 };
    let told = Audit { collision_cells: Some(cells), ..clean() }.render();
    assert!(told.contains("free flights               0.020 % of particle-steps\nwithout a gradient         1.300 %"));
    assert!(told.contains("groups cut by walls        8.2 a step") && !told.contains("lost"), "{told}");
}

#[test]
fn an_empty_run_is_clean() {
    assert!(Audit::default().verdict(&AuditLimits::default()).is_empty());
}
