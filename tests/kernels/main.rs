//! Every kernel of `shaders/` alone, on random inputs and a device, against the f64 reference: integer
//! results exactly, floating-point ones within bounds derived from f32 rounding (u = 2^-24 per operation).

#[allow(dead_code)] // Each test binary uses its own part.
#[path = "../oracle/mod.rs"]
mod oracle;

mod binned;
mod blocks;
mod bounce;
mod branches;
mod ceilings;
mod choose;
mod closed;
mod collide;
mod crowd;
mod devices;
mod exchange;
mod fabric;
mod fly;
mod half_turn;
mod halo;
mod lists;
mod local;
mod match_pairs;
mod membrane;
mod membrane_nodes;
mod moved;
mod neighbour_lists;
mod neighbours;
mod on_demand;
mod philox;
mod probe;
mod rig;
mod scan;
mod screen;
mod settle;
mod sort;
mod stalled;
mod surface_models;
mod tally;
mod variants;
mod weigh;
mod world;

/// No kernel goes untested: the table of kernels is the list of those the files here run.
#[test]
fn every_kernel_has_its_test() {
    let tested = [
        "advect",
        "arrange",
        "arrange_by_id",
        "arrange_crowded",
        "bin",
        "blocks",
        "bounce",
        "bound_fabric",
        "ceiling_arithmetic",
        "ceiling_copy",
        "ceiling_flights",
        "ceiling_loads",
        "choose",
        "clear_cells",
        "collide",
        "collide_crowded",
        "collide_divided",
        "collide_moved",
        "collision_cells",
        "complete_lists",
        "fill_outbox",
        "fill_updates",
        "half_turn",
        "half_turn_cut",
        "list_fabric",
        "list_ids",
        "lost",
        "match_pairs",
        "message_starts",
        "neighbours",
        "neighbours_on_demand",
        "order",
        "pack",
        "pack_updates",
        "recall",
        "receive",
        "reset",
        "scan_cells",
        "scan_stretches",
        "scan_sums",
        "settle",
        "start_flights",
        "tally",
        "weigh",
    ];
    let known: Vec<&str> = corpuscle::subdomain::KERNELS.iter().map(|kernel| kernel.name).collect();
    assert_eq!(known, tested);
    let of_membranes: Vec<&str> = corpuscle::fabric::KERNELS.iter().map(|kernel| kernel.name).collect();
    assert_eq!(of_membranes, ["element_forces", "move_nodes", "smooth_nodes", "take_impulses"]);
}

/// Whether there are other devices is asked by kernels of integers alone: with floating point one device would have other
/// pipelines than several, and a driver may round otherwise in each. (`neighbours` has some, in the sieve, which has room for any
/// rounding.)
#[test]
fn only_kernels_that_no_rounding_matters_to_know_whether_a_device_is_alone() {
    // Beside the declaration.
    let asks = |source: &str| source.matches("HALO").count() > 1;
    let found: Vec<&str> =
        corpuscle::subdomain::KERNELS.iter().filter(|kernel| asks(kernel.source)).map(|kernel| kernel.name).collect();
    assert_eq!(found, ["match_pairs", "neighbours"]);
}
