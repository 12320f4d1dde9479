//! A closed bag that is shaken.

use corpuscle::scene::Method;
use corpuscle::simulation::{Model, Options};

use crate::meshes::{moved, shaken, sphere};
use crate::whole_run::{model, run};

fn boxed(method: Method, particles: u32, end: f64, step: f64) -> Model {
    model(&format!(
        "end_time = {end:e}\n[[gas]]\nname = \"air\"\nmolar_mass = 0.029\ngamma = 1.4\n\
         [[wall]]\nname = \"box\"\nshape = \"box\"\nmin = [0.0, 0.0, 0.0]\nmax = [0.1, 0.1, 0.1]\ngas = \"inside\"\n\
         [[chamber]]\nname = \"all\"\npressure = 1e5\ntemperature = 300.0\ngas = \"air\"\n\
         [model]\nmethod = \"{}\"\nparticles = {particles}\ntime_step = {step:e}\n[output]\nrows = 5\nsnapshots = 0\n",
        method.name()
    ))
}

fn shake(method: Method, steps: u32) {
    let step = 2e-6;
    let end = step * f64::from(steps);
    let mut model = boxed(method, 3000, end, step);
    model.fabric = moved(sphere([0.05; 3], 0.03, 2), true, end, shaken(100.0, 1e-3));
    let started = model.fabric.inside(0.0);
    let run = run(&model, Options::default());
    let ended = model.fabric.inside(run.rows.last().map_or(end, |_| end));
    let (mut wrong, mut inside) = (Vec::new(), 0);
    for particle in &run.outcome.particles {
        let place = model.plan.grid.to_metres(particle.position);
        inside += u32::from(particle.is_inside());
        if ended.contains(place) != particle.is_inside() {
            wrong.push((particle.id(), place));
        }
    }
    let _ = started;
    eprintln!("{}: {} steps, {inside} inside, {} bounces, {:?}", method.name(), run.outcome.steps, run.outcome.bounces, run.outcome.audit);
    assert!(wrong.is_empty(), "{} of {} on the wrong side: {:?}", wrong.len(), run.outcome.particles.len(), &wrong[..wrong.len().min(5)]);
}

#[test]
fn nothing_passes_a_shaken_bag_in_free_flight() {
    shake(Method::None, 500);
}

#[test]
fn nothing_passes_a_shaken_bag_with_half_turn() {
    shake(Method::HalfTurn, 500);
}

#[test]
fn nothing_passes_a_shaken_bag_with_closest_approach() {
    shake(Method::ClosestApproach, 500);
}
