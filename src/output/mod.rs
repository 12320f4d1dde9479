//! What a run leaves behind: its folder, the history table, snapshots, checkpoints, charts, the record of the
//! environment, the closing audit and phase table, the progress display, pictures, and the page that is made of all that.
//!
//! Everything here takes plain data in SI units and knows no time loop; only [`picture`] draws on a device. Numbers are
//! written with the fewest digits that read back to the same bits, so equal runs leave equal bytes. Files
//! that are rewritten or that must never be seen half done are written beside their place and renamed.

mod appended;
mod audit;
mod balance;
mod chart;
mod checkpoint;
mod checksum;
mod environment;
mod error;
mod folder;
mod history;
mod local_temperature;
mod map;
mod marker;
mod membrane_fields;
mod meshes;
mod names;
mod phases;
pub mod picture;
mod progress;
mod report;
mod scatter;
mod snapshot;
mod snapshot_read;
mod spread;
mod subdomains;
mod table;
mod ticks;
mod timing;
mod vtk;
mod vtk_read;

pub use appended::{AppendedFile, AppendedState};
pub use audit::{Audit, AuditLimits, CaughtFlights, CollisionCells, FabricAccount, PassedParticles};
pub use balance::{BalanceRow, BalanceWriter, over_mean};
pub use chart::{PALETTE, Series, line_chart};
pub use checkpoint::{
    Adapter, Checkpoint, CheckpointError, CheckpointWriter, FileRecord, Manifest, Moment, Origin, OutputState,
    RECORD_BYTES, RunContext, forget_after, latest, run_folder,
};
pub use environment::{AdapterRecord, Environment, host_name};
pub use error::OutputError;
pub use folder::{Claim, Content, OutputFolder};
pub use history::{Column, History, HistoryState, HistoryWriter};
pub use map::{MapCell, MapRow, map_chart};
pub use marker::{check_marker, has_ended};
pub use membrane_fields::{FabricSnapshot, MembraneFields, TriangleField};
pub use meshes::{MeshRecord, mesh_paths, meshes_of};
pub use names::{
    AUDIT_FILE, BALANCE_FILE, CHECKPOINT_FOLDER, ENVIRONMENT_FILE, HISTORY_FILE, HISTORY_MEAN_FILE, LOG_FILE,
    PARETO_CHART_FILE, PARETO_FILE, PARETO_TABLE_FILE, PLAN_FILE, PRESSURE_CHART_FILE, REPORT_FILE, SCENE_FILE,
    SNAPSHOT_FOLDER, STABILITY_CHART_FILE, STABILITY_FILE, STABILITY_TABLE_FILE, SUBDOMAIN_CHART_FILE,
    SWEEP_CHART_FILE, SWEEP_FILE, SWEEP_MODEL_CHART_FILE, SWEEP_TABLE_FILE, TIMING_FILE, seed_folder,
};
pub use phases::PhaseTable;
pub use progress::{LOG_ONLY, Progress, Shown};
pub use report::{COMPARISON_FILE, Progressing, Seen, audit_verdict, seen, write_report};
pub use scatter::{Group, Mark, Scatter, Shape, scatter_chart};
pub use snapshot::{ParticleRow, SnapshotState, SnapshotWriter, TriangleSet};
pub use snapshot_read::{Snapshot, SnapshotEntry, SnapshotSurfaces, snapshots_of};
pub use spread::spread as history_spread;
pub use subdomains::{Frame, subdomain_chart};
pub use table::{aligned, figure, grouped};
pub use timing::{PhaseTiming, RankTiming, Timing};
