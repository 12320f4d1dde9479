//! `remember`: the particles are kept, until an interval has to run again.

use corpuscle::subdomain::{GpuParticle, GpuStep};

use crate::oracle::random::Stream;
use crate::rig::*;

const COUNT: usize = 300;
/// Of the device's own word, behind those that the host reads.
const GOES_BACK: usize = 52;

#[test]
fn the_start_of_the_first_interval_that_must_run_again_is_kept() {
    let world = World::plain();
    let mut stream = Stream::new(91);
    let states: Vec<Vec<GpuParticle>> = (0..4).map(|_| world.particles(&mut stream, COUNT, 300.0)).collect();
    let beyond = GpuParticle { tag: NOBODY, ..GpuParticle::default() };
    let mut rig = Rig::new(&world);
    rig.put("remembered", &vec![beyond; COUNT + 20]);
    rig.step(GpuStep { count: COUNT as u32, ..GpuStep::default() });
    let kept_after = |rig: &mut Rig, state: &[GpuParticle], wanted: u32| {
        rig.put("particles", state);
        rig.set_counter(TAILS_WANTED, wanted);
        rig.run("remember", COUNT);
        let all: Vec<GpuParticle> = rig.get("remembered", COUNT + 20);
        assert!(all[COUNT..].iter().all(|particle| *particle == beyond));
        all[..COUNT].to_vec()
    };
    assert!(kept_after(&mut rig, &states[0], 0) == states[0]);
    assert!(kept_after(&mut rig, &states[1], 0) == states[1]);
    assert_eq!(rig.counter(GOES_BACK), 0);
    // This one had too little room; so what it began with stays, also after later ones that had enough.
    assert!(kept_after(&mut rig, &states[2], 7) == states[1]);
    assert!(kept_after(&mut rig, &states[3], 0) == states[1]);
    assert_eq!(rig.counter(GOES_BACK), 1);
    // Until the host has gone back.
    rig.set_counter(GOES_BACK, 0);
    assert!(kept_after(&mut rig, &states[3], 0) == states[3]);
}
