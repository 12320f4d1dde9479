//! `corpuscle run --repeat N`: the scene with N seeds, each a run of its own in `seed-S`, and their mean and spread.

use std::time::Instant;

use super::devices;
use super::ending::Ending;
use super::launch::{claim, launch};
use crate::cli::CliError;
use crate::cli::settings::{RunSettings, model_of};
use crate::cli::terminal::tell;
use crate::output::{
    Content, HISTORY_FILE, HISTORY_MEAN_FILE, History, SCENE_FILE, has_ended, history_spread, seed_folder,
};
use crate::ranks::Communicator;
use crate::scene::{Method, to_toml};

/// Seeds are below this.
const SEEDS: u64 = 1 << 56;

/// The runs one after another, each by all ranks.
pub fn repeat(
    settings: RunSettings,
    times: u32,
    comm: &dyn Communicator,
    quiet: bool,
    started: Instant,
) -> Result<Ending, CliError> {
    let RunSettings { scene: file, model, folder: path, execution, .. } = &settings;
    let first = model.scene.seed;
    if model.plan.method == Method::ControlVolume {
        return Err(CliError::NothingToRepeat);
    }
    if model.scene.model.switch.is_some() {
        return Err(CliError::RepeatedSwitch);
    }
    if first + u64::from(times) > SEEDS {
        return Err(CliError::SeedsBeyond { first, times });
    }
    // Earlier results are removed once it is clear that there can be others.
    drop(devices::open(execution.gpu.as_deref(), comm)?);
    let seeds: Vec<u64> = (0..u64::from(times)).map(|k| first + k).collect();
    let folder = if comm.rank() == 0 {
        let folder = claim(&settings, Content::Seeds)?;
        folder.clear()?;
        folder.write_text(SCENE_FILE, &to_toml(&model.scene))?;
        Some(folder)
    } else {
        None
    };
    let name = path.join(SCENE_FILE);
    for (index, &seed) in seeds.iter().enumerate() {
        if comm.rank() == 0 {
            tracing::info!("run {} of {times}: seed {seed}", index + 1);
        }
        let mut scene = model.scene.clone();
        scene.seed = seed;
        let of_seed = RunSettings {
            scene: file.clone(),
            model: model_of(&name, scene)?,
            folder: path.join(seed_folder(seed)),
            force: false,
            execution: execution.clone(),
        };
        let since = if index == 0 { started } else { Instant::now() };
        let ending = launch(&of_seed, None, comm, quiet, since)?;
        // A signal may have stopped it at a checkpoint: then it was meant for all of them.
        let ended = comm.rank() == 0 && has_ended(&of_seed.folder);
        if comm.broadcast(vec![u8::from(ended)])? != [1] {
            if comm.rank() == 0 {
                tracing::warn!(
                    "seed {seed} was stopped before its end: the seeds after it are not run, there is no mean"
                );
            }
            return Ok(ending);
        }
    }
    let Some(folder) = folder else { return Ok(Ending::Done) };
    let names: Vec<String> = seeds.iter().map(|&seed| seed_folder(seed)).collect();
    let histories: Vec<History> =
        names.iter().map(|name| History::read(&path.join(name).join(HISTORY_FILE))).collect::<Result<_, _>>()?;
    history_spread(&histories, &names)?.write_csv(&folder.path().join(HISTORY_MEAN_FILE))?;
    if !quiet {
        tell(&format!(
            "{times} runs, seeds {first} to {}: mean and spread in {HISTORY_MEAN_FILE}\n",
            first + u64::from(times) - 1
        ));
    }
    tell(&format!("{}\n", folder.path().display()));
    Ok(Ending::Done)
}
