//! The kernels of the step's phases, bound to the buffers.

use crate::gpu::{BoundKernel, Constants, Device, GpuError, Kernel};

use super::buffers::Buffers;
use super::constants::Features;
use super::shaders::shader;

/// What a scene needs is there; what it lacks is not compiled.
pub struct Kernels<K> {
    pub sort: Option<SortKernels<K>>,
    pub collisions: Option<CollisionKernels<K>>,
    pub cells: Option<CellKernels<K>>,
    pub half_turn: Option<HalfTurnKernels<K>>,
    pub exchange: Option<ExchangeKernels<K>>,
    /// Of a scene with surfaces that deform.
    pub fabric: Option<FabricKernels<K>>,
    pub reset: K,
    pub advect: K,
    pub bounce: K,
    pub tally: K,
    pub blocks: K,
}

/// Where there are collisions at all.
pub struct SortKernels<K> {
    pub bin: K,
    pub scan_sums: K,
    pub scan_stretches: K,
    pub scan_cells: K,
    pub clear_cells: K,
}

/// Collisions of neighbours, in rounds.
pub struct CollisionKernels<K> {
    pub order: K,
    /// Where the diameter is capped.
    pub start_flights: Option<K>,
    pub neighbours: K,
    /// On a device among others.
    pub neighbours_on_demand: Option<K>,
    pub complete_lists: K,
    pub choose: K,
    /// The same kernel, for the pass over the ghosts that were asked.
    pub choose_on_demand: K,
    pub match_pairs: K,
    pub settle: K,
    pub lost: K,
    /// On a device alone.
    pub recall: Option<K>,
}

/// Collisions within cells.
pub struct CellKernels<K> {
    pub arrange: K,
    pub arrange_crowded: K,
    pub collide: K,
    pub collide_crowded: K,
    /// Of a scene whose walls part the gas of a cell.
    pub divided: Option<K>,
    /// Of a scene whose walls move.
    pub moved: Option<K>,
}

/// Collisions of all particles of a cell at once.
pub struct HalfTurnKernels<K> {
    pub list_ids: K,
    pub arrange_by_id: K,
    pub collision_cells: K,
    pub half_turn: K,
    /// Of a scene whose walls may stand between particles of a cell.
    pub cut: Option<K>,
}

/// Where the triangles of fabric are.
pub struct FabricKernels<K> {
    pub list: K,
    pub bound: K,
}

/// On a device among others.
pub struct ExchangeKernels<K> {
    pub pack: K,
    pub message_starts: K,
    pub fill: K,
    pub updates: Option<UpdateKernels<K>>,
    pub weigh: K,
}

/// What the rounds did to ghosts.
pub struct UpdateKernels<K> {
    pub pack: K,
    pub fill: K,
    pub receive: K,
}

impl<K> Kernels<K> {
    fn build<E>(features: Features, mut make: impl FnMut(&'static str) -> Result<K, E>) -> Result<Kernels<K>, E> {
        let sort = if features.collisions {
            Some(SortKernels {
                bin: make("bin")?,
                scan_sums: make("scan_sums")?,
                scan_stretches: make("scan_stretches")?,
                scan_cells: make("scan_cells")?,
                clear_cells: make("clear_cells")?,
            })
        } else {
            None
        };
        let half_turn = if features.half_turn {
            Some(HalfTurnKernels {
                list_ids: make("list_ids")?,
                arrange_by_id: make("arrange_by_id")?,
                collision_cells: make("collision_cells")?,
                half_turn: make("half_turn")?,
                cut: if features.divided || features.moving || features.fabric {
                    Some(make("half_turn_cut")?)
                } else {
                    None
                },
            })
        } else {
            None
        };
        let cells = if features.has_cells() && !features.half_turn {
            Some(CellKernels {
                arrange: make("arrange")?,
                arrange_crowded: make("arrange_crowded")?,
                collide: make("collide")?,
                collide_crowded: make("collide_crowded")?,
                divided: if features.divided { Some(make("collide_divided")?) } else { None },
                moved: if features.moving { Some(make("collide_moved")?) } else { None },
            })
        } else {
            None
        };
        let collisions = if features.rounds {
            Some(CollisionKernels {
                order: make("order")?,
                start_flights: if features.capped { Some(make("start_flights")?) } else { None },
                neighbours: make("neighbours")?,
                neighbours_on_demand: if features.halo { Some(make("neighbours_on_demand")?) } else { None },
                complete_lists: make("complete_lists")?,
                choose: make("choose")?,
                choose_on_demand: make("choose_on_demand")?,
                match_pairs: make("match_pairs")?,
                settle: make("settle")?,
                lost: make("lost")?,
                recall: if features.halo { None } else { Some(make("recall")?) },
            })
        } else {
            None
        };
        let exchange = if features.halo {
            Some(ExchangeKernels {
                pack: make("pack")?,
                message_starts: make("message_starts")?,
                fill: make("fill_outbox")?,
                updates: if features.rounds {
                    Some(UpdateKernels {
                        pack: make("pack_updates")?,
                        fill: make("fill_updates")?,
                        receive: make("receive")?,
                    })
                } else {
                    None
                },
                weigh: make("weigh")?,
            })
        } else {
            None
        };
        let fabric = if features.fabric {
            Some(FabricKernels { list: make("list_fabric")?, bound: make("bound_fabric")? })
        } else {
            None
        };
        Ok(Kernels {
            sort,
            collisions,
            cells,
            half_turn,
            exchange,
            fabric,
            reset: make("reset")?,
            advect: make("advect")?,
            bounce: make("bounce")?,
            tally: make("tally")?,
            blocks: make("blocks")?,
        })
    }
}

/// A kernel that is bound a second time, so that both do the same to the last bit: its name, its shader, and the buffer
/// that it has instead of another.
struct Second {
    name: &'static str,
    shader: &'static str,
    instead_of: &'static str,
    buffer: &'static str,
}

/// The pass over the ghosts that were asked asks nobody, and may not write what it takes its size from.
const SECONDS: [Second; 1] = [Second {
    name: "choose_on_demand",
    shader: "choose",
    instead_of: "on_demand_dispatches",
    buffer: "rechoose_dispatches",
}];

fn second(name: &str) -> Option<&'static Second> {
    SECONDS.iter().find(|second| second.name == name)
}

/// Compiled kernels by name.
pub struct Compiled(Vec<(&'static str, Kernel)>);

impl Compiled {
    /// `runtime` names the runtime constants.
    pub fn new(
        device: &Device,
        features: Features,
        constants: &Constants,
        runtime: &[&str],
    ) -> Result<Compiled, GpuError> {
        let mut compiled = Vec::new();
        Kernels::build(features, |name| {
            if second(name).is_none() {
                compiled.push((name, Kernel::with_runtime_constants(device, shader(name)?, constants, runtime)?));
            }
            Ok::<(), GpuError>(())
        })?;
        Ok(Compiled(compiled))
    }

    pub fn bind(
        &self,
        device: &Device,
        features: Features,
        buffers: &Buffers<'_>,
    ) -> Result<Kernels<BoundKernel>, GpuError> {
        Kernels::build(features, |name| {
            let second = second(name);
            let shader = second.map_or(name, |second| second.shader);
            let kernel = self.0.iter().find(|(known, _)| *known == shader).map(|(_, kernel)| kernel);
            let Some(kernel) = kernel else {
                return Err(GpuError::Kernel { kernel: name.into(), reason: "not compiled".into() });
            };
            kernel.bind(device, |buffer| match second {
                Some(second) if second.instead_of == buffer => buffers.by_name(second.buffer),
                _ => buffers.by_name(buffer),
            })
        })
    }
}
