//! Names of the files and folders in the folder of a run.

use super::error::PARTIAL_SUFFIX;

pub const HISTORY_FILE: &str = "history.csv";
pub const PLAN_FILE: &str = "plan.toml";
pub const SCENE_FILE: &str = "scene.toml";
pub const ENVIRONMENT_FILE: &str = "environment.json";
pub const PRESSURE_CHART_FILE: &str = "pressure.svg";
/// Only there once the run has reached its end and all else is written.
pub const AUDIT_FILE: &str = "audit.txt";
pub const BALANCE_FILE: &str = "balance.csv";
pub const SUBDOMAIN_CHART_FILE: &str = "subdomains.svg";
pub const TIMING_FILE: &str = "timing.json";
pub const SWEEP_FILE: &str = "sweep.csv";
pub const SWEEP_TABLE_FILE: &str = "sweep.txt";
pub const SWEEP_CHART_FILE: &str = "sweep.svg";
pub const SWEEP_MODEL_CHART_FILE: &str = "sweep_modelled.svg";
pub const PARETO_FILE: &str = "pareto.csv";
pub const PARETO_TABLE_FILE: &str = "pareto.txt";
pub const PARETO_CHART_FILE: &str = "pareto.svg";
/// Mean and spread over the seeds of a repeated run.
pub const HISTORY_MEAN_FILE: &str = "history_mean.csv";
pub const STABILITY_FILE: &str = "stability.csv";
pub const STABILITY_TABLE_FILE: &str = "stability.txt";
pub const STABILITY_CHART_FILE: &str = "stability.svg";
/// What was told, with times.
pub const LOG_FILE: &str = "log.txt";
pub const SNAPSHOT_FOLDER: &str = "snapshots";
/// Copies of the meshes that the scene names.
pub const MESH_FOLDER: &str = "meshes";
pub const CHECKPOINT_FOLDER: &str = "checkpoints";

/// The page of a run or of a study.
pub const REPORT_FILE: &str = "report.html";

/// Held by who writes into the folder; says who that is.
pub(super) const LOCK_FILE: &str = ".corpuscle-lock";
/// Says that the folder is a run's.
pub(super) const MARKER_FILE: &str = ".corpuscle-run";

/// Everything a run or a study writes at the top of its folder, apart from the snapshots and checkpoints.
pub(super) const RESULT_FILES: [&str; 23] = [
    MARKER_FILE,
    HISTORY_FILE,
    PLAN_FILE,
    SCENE_FILE,
    ENVIRONMENT_FILE,
    PRESSURE_CHART_FILE,
    AUDIT_FILE,
    LOG_FILE,
    BALANCE_FILE,
    SUBDOMAIN_CHART_FILE,
    TIMING_FILE,
    SWEEP_FILE,
    SWEEP_TABLE_FILE,
    SWEEP_CHART_FILE,
    SWEEP_MODEL_CHART_FILE,
    PARETO_FILE,
    PARETO_TABLE_FILE,
    PARETO_CHART_FILE,
    HISTORY_MEAN_FILE,
    STABILITY_FILE,
    STABILITY_TABLE_FILE,
    STABILITY_CHART_FILE,
    REPORT_FILE,
];

pub(super) const SEED_PREFIX: &str = "seed-";

/// The name of the folder of one run of several seeds.
pub fn seed_folder(seed: u64) -> String {
    format!("{SEED_PREFIX}{seed}")
}

pub(super) fn is_seed_folder(name: &str) -> bool {
    name.strip_prefix(SEED_PREFIX).is_some_and(|seed| !seed.is_empty() && seed.bytes().all(|b| b.is_ascii_digit()))
}

pub(super) fn is_snapshot_file(name: &str) -> bool {
    let name = name.trim_end_matches(PARTIAL_SUFFIX);
    let is_numbered = |prefix, suffix| {
        let digits = name.strip_prefix(prefix).and_then(|rest| rest.strip_suffix(suffix));
        digits.is_some_and(|digits: &str| !digits.is_empty() && digits.bytes().all(|b| b.is_ascii_digit()))
    };
    let numbered = is_numbered("particles_", ".vtu") || is_numbered("fabric_", ".vtp");
    numbered || ["particles.pvd", "fabric.pvd", "walls.vtp"].contains(&name)
}

/// Whether a file of [`MESH_FOLDER`] is a copy that a run has made, whole or not.
pub(super) fn is_mesh_copy(name: &str) -> bool {
    let name = name.trim_end_matches(PARTIAL_SUFFIX);
    let hexadecimal = |digits: &str| digits.bytes().all(|byte| byte.is_ascii_hexdigit());
    name.split_once('-').is_some_and(|(crc, rest)| crc.len() == 8 && hexadecimal(crc) && !rest.is_empty())
}
