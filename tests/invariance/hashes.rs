//! Hashes of short runs, to compare two builds: each scene of `scenes/` with each method that it takes, alone, in three
//! parts and by two ranks.
//!
//! `./scripts/bits.sh` prints them. What is told apart is a change of bits, not whether it is right.

use std::hash::Hasher;

use corpuscle::scene::{self, Method};
use corpuscle::simulation::{BalanceMode, Model};

use crate::among::{Way, World};
use crate::bits::{Bits, assert_same};

const METHODS: [Method; 5] =
    [Method::ClosestApproach, Method::HardSphere, Method::Cell, Method::HalfTurn, Method::None];
const PARTICLES: u64 = 2000;
const STEPS: u64 = 128;

/// FNV-1a, 64 bits.
struct Fnv(u64);

impl Hasher for Fnv {
    fn finish(&self) -> u64 {
        self.0
    }

    fn write(&mut self, bytes: &[u8]) {
        for byte in bytes {
            self.0 = (self.0 ^ u64::from(*byte)).wrapping_mul(0x100_0000_01b3);
        }
    }
}

/// The hash of the history, and that of the state at the end.
fn hashes(bits: &Bits) -> [u64; 2] {
    let [mut history, mut state] = [0, 0].map(|_| Fnv(0xcbf2_9ce4_8422_2325));
    bits.history.iter().flatten().for_each(|word| history.write(&word.to_le_bytes()));
    state.write(&bits.state);
    [history.finish(), state.finish()]
}

/// The scene by another method, or why it takes it not.
fn model(name: &str, method: Method) -> Result<Model, String> {
    let path = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("scenes").join(name);
    let mut scene = scene::load(&path).map_err(|error| error.to_string())?;
    scene.model.method = Some(method);
    scene.model.particles = Some(PARTICLES);
    scene.output.snapshots = 0;
    // A row for each interval.
    let by_default = Model::new(scene.clone()).map_err(|error| error.to_string())?;
    scene.output.rows = (scene.end_time / by_default.plan.time_step).ceil() as u32;
    Model::new(scene).map_err(|error| error.to_string())
}

#[test]
#[ignore = "prints hashes of runs, to compare builds: ./scripts/bits.sh"]
fn hashes_of_scenes() {
    let folder = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("scenes");
    let entries = std::fs::read_dir(folder).expect("the scenes");
    let mut names: Vec<_> =
        entries.map(|entry| entry.expect("a scene").file_name().into_string().expect("a name")).collect();
    names.sort();
    for name in &names {
        for method in METHODS {
            let model = match model(name, method) {
                Ok(model) => model,
                Err(reason) => {
                    println!("bits {name} {method:?} refused: {}", reason.lines().next().unwrap_or_default());
                    continue;
                }
            };
            let world = World::new(&model);
            let runs = [1, 3, 2].map(|ranks| {
                let way = Way { stop: Some(STEPS), ..Way::new(ranks, BalanceMode::Dynamic, 2) };
                world.try_run(&way, None).map(|run| Bits::of(&run))
            });
            // An old lavapipe cannot run them all.
            let bits = match runs {
                [Ok(alone), Ok(parts), Ok(ranks)] => [alone, parts, ranks],
                [Err(reason), ..] | [_, Err(reason), _] | [.., Err(reason)] => {
                    println!("bits {name} {method:?} does not run: {reason}");
                    continue;
                }
            };
            let [alone, parts, ranks] = bits.each_ref().map(hashes);
            println!("bits {name} {method:?} alone {alone:016x?} 3 parts {parts:016x?} 2 ranks {ranks:016x?}");
            assert!(bits[0].history.len() > 2, "{name} {method:?}: a history to compare");
            assert_same("parts", &bits[0], &bits[1]);
            assert_same("ranks", &bits[0], &bits[2]);
        }
    }
}
