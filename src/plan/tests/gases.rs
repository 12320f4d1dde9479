//! What gases can be: their heat capacities, collision numbers and jets.

use super::*;

/// A gas with much spin cannot relax in five collisions: Z is raised, not P clipped.
#[test]
fn the_collision_number_is_raised_where_it_must() {
    let plan = planned(|scene, _| scene.gases[1].heat = HeatCapacity::Constant(9.0 * GAS_CONSTANT)).unwrap();
    assert!(plan.collision_number > 5.0 && near(plan.gases[1].exchange_probability, 1.0, 1e-6));
    assert!(planned(|_, _| ()).unwrap().collision_number == 5.0);
}

/// A heat capacity that grows becomes modes, with a reason that says how well; one that falls is refused with the figure.
#[test]
fn curves_of_the_heat_capacity_are_fitted_or_refused() {
    let with = |cp: [f64; 3]| planned(|scene, _| scene.gases[1].heat = HeatCapacity::Curve(cp));
    let plan = with([23.0, 5.6e-2, -2.2e-5]).unwrap();
    let species = &plan.gases[1].species;
    let residual = species.modes().unwrap().residual;
    assert!(residual < 0.01);
    // The tank has 293 K, the inflow 700 K.
    for temperature in [293.0, 500.0, 700.0, 850.0] {
        let asked = 23.0 + temperature * (5.6e-2 - 2.2e-5 * temperature);
        assert!(near(species.molar_cp(temperature), asked, 1.01 * residual + 1e-12));
    }
    let reason = plan.reasons.iter().find(|reason| reason.quantity == "cp(T) of nitrogen").unwrap();
    assert!(reason.why.contains("from 234.4 to 918.5 K"), "{}", reason.why);
    assert!(plan.to_toml().unwrap().contains("[gases.partition_function]"));
    assert!(!planned(|_, _| ()).unwrap().to_toml().unwrap().contains("partition_function"));
    // Energy is kept: that of all gas at the end is that of the initial gas and the enthalpy that came in.
    assert!(plan.temperature_reference > 400.0 && plan.temperature_reference < 700.0);
    let falls = with([45.0, -0.02, 0.0]).unwrap_err();
    assert!(matches!(&falls, PlanError::HeatCapacity { gas, residual, .. } if gas == "nitrogen" && *residual > 1.0));
    assert!(matches!(with([20.0, 1e-4, 0.0]).unwrap_err(), PlanError::HeatCapacityLow { .. }));
}

/// Temperatures of walls are among those of a heat capacity that depends on the temperature.
#[test]
fn heat_capacities_cover_the_walls() {
    let cold = |scene: &mut Scene| {
        let heat = WallHeat { temperature: 293.0, transfer: HeatTransfer::Accommodation(1.0) };
        let shape = Shape::Box { min: [0.0; 3], max: [0.4; 3], thickness: None, holes: vec![] };
        scene.walls = vec![Wall {
            name: "tank".into(),
            shape,
            gas: GasSide::Inside,
            surface: SurfaceModel { heat: Some(heat), friction: 0.0 },
            parts: Vec::new(),
        }];
    };
    let curved = planned(|scene, _| {
        cold(scene);
        scene.walls[0].surface.heat.as_mut().unwrap().temperature = 200.0;
        scene.gases[1].heat = HeatCapacity::Curve([23.0, 5.6e-2, -2.2e-5]);
    });
    let reasons = curved.unwrap().reasons;
    let reason = reasons.iter().find(|reason| reason.quantity == "cp(T) of nitrogen").unwrap();
    assert!(reason.why.contains("from 160 to"), "{}", reason.why);
}

/// Gas that a chamber of a higher pressure keeps has expanded more than a fifth: half of it gone, to .76 of its temperature.
#[test]
fn heat_capacities_cover_a_chamber_that_empties() {
    let reason = |pressure: f64| {
        let plan = planned(|scene, _| {
            scene.chambers[0].pressure = pressure;
            scene.gases[1].heat = HeatCapacity::Curve([23.0, 5.6e-2, -2.2e-5]);
        });
        let reasons = plan.unwrap().reasons;
        reasons.into_iter().find(|reason| reason.quantity == "cp(T) of nitrogen").unwrap().why
    };
    assert!(reason(101_325.0).contains("from 234.4 to"), "{}", reason(101_325.0));
    assert!(reason(3e5).contains("from 175.8 to"), "{}", reason(3e5));
}

/// A jet whose velocity is beyond Mach 20 in its coldest gas is refused, a slower one is planned.
#[test]
fn jets_are_no_faster_than_their_gas_can_be() {
    let jet = |velocity| {
        planned(|scene, _| {
            scene.orifices[0].jet = Some(Jet { speed: JetSpeed::Velocity(velocity), cone_angle: 0.0 });
            scene.orifices[0].temperature = Curve { points: vec![[0.0, 700.0], [0.05, 400.0]] };
        })
    };
    // sqrt(2 cp T0 / M) = 911.6 m/s at 400 K; Mach 20 is 906.0 m/s.
    assert!(jet(905.0).is_ok());
    let refused = jet(907.0);
    assert!(
        matches!(&refused, Err(PlanError::JetTooFast { orifice, temperature: 400.0, mach, .. })
            if orifice == "inflator" && *mach > 20.0),
        "{refused:?}"
    );
    assert!(matches!(jet(2000.0), Err(PlanError::JetTooFast { mach: f64::INFINITY, .. })));
}
