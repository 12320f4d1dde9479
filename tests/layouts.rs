//! Law: every Rust twin of a shader's struct has naga's offset for each member and naga's size, in every
//! kernel that declares the struct, and every struct that a buffer holds has a twin.

use std::collections::BTreeSet;
use std::mem::offset_of;

use corpuscle::fabric::{
    self, GpuElastic, GpuElement, GpuElementForces, GpuMembraneNode, GpuMembraneStep, GpuNeighbour, GpuNodeConstants,
    GpuObstacle, GpuSubstep,
};
use corpuscle::gpu::KernelSource;
use corpuscle::subdomain::registry::{PHASES, REUSED, Runs, Use};
use corpuscle::subdomain::{
    CROWD, GpuFlight, GpuGas, GpuMotion, GpuNewborn, GpuPart, GpuParticle, GpuPeer, GpuSending, GpuSheet, GpuStep,
    GpuStillGas, GpuSurfaceModel, GpuSwept, GpuTriangle, GpuUpdate, GpuVent, GpuWeights, GpuZone, KERNELS, MEMBERS,
};
use naga::{Expression, Literal, Module, TypeInner};

/// A Rust struct as the shaders should see it.
struct Twin {
    name: &'static str,
    size: usize,
    members: Vec<(&'static str, usize)>,
}

macro_rules! twin {
    ($name:literal, $rust:ty, $($member:ident),+) => {
        Twin { name: $name, size: size_of::<$rust>(), members: vec![$((stringify!($member), offset_of!($rust, $member))),+] }
    };
}

/// `GpuParticle` as kernels read it that read all of it.
#[repr(C)]
#[allow(dead_code)] // Only its layout is used.
struct Packed {
    position_tag: [u32; 4],
    motion: [f32; 4],
}

fn twins() -> Vec<Twin> {
    vec![
        twin!(
            "Step",
            GpuStep,
            count,
            newborns,
            newborn_offset,
            newborn_first_id,
            index,
            dt,
            round,
            arrivals,
            low,
            total,
            size,
            bins,
            own_low,
            depth,
            own_high,
            reach,
            inner_low,
            first,
            inner_high,
            ghosts,
            peers,
            near_peers,
            capacity,
            stride,
            tallies_left,
            slot,
            near2,
            flight,
            next_newborns,
            lattice,
            next_lattice,
            fabric_low,
            fabric_size
        ),
        twin!("Particle", GpuParticle, position, tag, velocity, spin),
        twin!("Packed", Packed, position_tag, motion),
        // The tail padding is not named in the shader.
        twin!("Newborn", GpuNewborn, particle, start),
        twin!("Flight", GpuFlight, start, wall, partner, collisions),
        twin!("Triangle", GpuTriangle, a, sense, b, surface, c, surface_model, normal, motion),
        twin!("Sheet", GpuSheet, a, b, c, closed, surface, surface_model, work, recoil),
        twin!("Swept", GpuSwept, normal, away, corner, pad),
        twin!("Motion", GpuMotion, moved, cells, velocity, rows, low, pad, high, pad2, body_low, pad3, body_size, pad4),
        twin!("SurfaceModel", GpuSurfaceModel, thermal, accommodation, friction, first_vent, end_vent, zone, next),
        twin!("Vent", GpuVent, center, radius2, beta, index, passes, pad),
        twin!("Zone", GpuZone, low, kind, high, radius, axis, height, carried, planes, pad2, pad3),
        twin!("Gas", GpuGas, mass, exchange, inverse_beta, inverse_beta1),
        twin!("Update", GpuUpdate, particle, flight, cell, pad, pad2, pad3),
        twin!("Sending", GpuSending, index, peer, place),
        twin!("Peer", GpuPeer, low, pad, high, pad2),
        twin!("Part", GpuPart, place, volume),
        twin!("StillGas", GpuStillGas, points, volume),
        twin!("Weights", GpuWeights, particle, candidate, wall, sheet, cuts),
        twin!(
            "MembraneStep",
            GpuMembraneStep,
            dt,
            gas_dt,
            quantum,
            quanta,
            gravity,
            drag,
            limit,
            nodes,
            elements,
            substeps,
            impulse_unit,
            prescribed_steps
        ),
        twin!("Substep", GpuSubstep, slot, substep),
        twin!(
            "MembraneNode",
            GpuMembraneNode,
            place,
            dt,
            remainder,
            pad,
            velocity,
            pad2,
            given,
            pad3,
            seen,
            pad4,
            work,
            pad5
        ),
        twin!(
            "Element",
            GpuElement,
            nodes,
            elastic,
            second,
            third,
            second2,
            third2,
            second_third,
            volume,
            viscosity,
            pressure,
            pad,
            pad2,
            pad3
        ),
        twin!("Elastic", GpuElastic, stiffness, compliance, young, share, isotropic, loose, tightening),
        twin!(
            "ElementForces",
            GpuElementForces,
            second,
            energy,
            third,
            state,
            damped_second,
            relaxed,
            damped_third,
            pad2,
            pressed,
            pad3
        ),
        twin!("Obstacle", GpuObstacle, place, friction, normal, pad, whole_normal, last, velocity, pad3),
        twin!("Neighbour", GpuNeighbour, node, share),
        twin!("NodeConstants", GpuNodeConstants, mass, held, first, end, friction),
    ]
}

/// What differs between a twin and the struct of its name in a module, if the module has it.
fn differences(module: &Module, twin: &Twin) -> Option<Vec<String>> {
    let (_, declared) = module.types.iter().find(|(_, ty)| ty.name.as_deref() == Some(twin.name))?;
    let TypeInner::Struct { members, span } = &declared.inner else { return None };
    let mut found = Vec::new();
    if *span as usize != twin.size {
        found.push(format!("{}: {span} bytes in the shader, {} in Rust", twin.name, twin.size));
    }
    let in_shader: Vec<(String, usize)> =
        members.iter().map(|m| (m.name.clone().unwrap_or_default(), m.offset as usize)).collect();
    let in_rust: Vec<(String, usize)> = twin.members.iter().map(|(name, at)| ((*name).into(), *at)).collect();
    if in_shader != in_rust {
        found.push(format!("{}: {in_shader:?} in the shader, {in_rust:?} in Rust", twin.name));
    }
    Some(found)
}

fn modules() -> Vec<(&'static str, Module)> {
    let parse = |source| naga::front::wgsl::parse_str(source).expect("the build has parsed it");
    let sources = |kernel: &KernelSource| [Some(kernel.source), kernel.variants[0], kernel.variants[1]];
    KERNELS
        .iter()
        .chain(fabric::KERNELS)
        .flat_map(|kernel| sources(kernel).into_iter().flatten().map(|source| (kernel.name, parse(source))))
        .collect()
}

/// The structs that the buffers of a module hold, by name, those within structs and arrays included.
fn held(module: &Module) -> BTreeSet<String> {
    let mut names = BTreeSet::new();
    let mut open: Vec<naga::Handle<naga::Type>> = module
        .global_variables
        .iter()
        .filter(|(_, global)| global.binding.is_some())
        .map(|(_, global)| global.ty)
        .collect();
    while let Some(handle) = open.pop() {
        match &module.types[handle].inner {
            TypeInner::Struct { members, .. } => {
                names.insert(module.types[handle].name.clone().unwrap_or_default());
                open.extend(members.iter().map(|member| member.ty));
            }
            TypeInner::Array { base, .. } => open.push(*base),
            _ => {}
        }
    }
    names
}

#[test]
fn every_twin_has_the_offsets_of_its_struct_in_every_kernel() {
    let modules = modules();
    for twin in twins() {
        let mut seen = 0;
        for (kernel, module) in &modules {
            if let Some(found) = differences(module, &twin) {
                assert!(found.is_empty(), "{kernel}: {}", found.join("; "));
                seen += 1;
            }
        }
        assert!(seen > 0, "no kernel declares {}", twin.name);
    }
}

#[test]
fn every_struct_in_a_buffer_has_a_twin() {
    let known: BTreeSet<String> = twins().iter().map(|twin| twin.name.to_string()).collect();
    let held: BTreeSet<String> = modules().iter().flat_map(|(_, module)| held(module)).collect();
    assert_eq!(held, known);
}

/// The same 32 bytes: position and tag, velocity and spin.
#[test]
fn a_packed_particle_is_a_particle() {
    let words = [offset_of!(Packed, position_tag), offset_of!(Packed, motion)].map(|at| [at, at + 12]);
    let [[position, tag], [velocity, spin]] = words;
    assert_eq!(size_of::<Packed>(), size_of::<GpuParticle>());
    assert_eq!([position, tag], [offset_of!(GpuParticle, position), offset_of!(GpuParticle, tag)]);
    assert_eq!([velocity, spin], [offset_of!(GpuParticle, velocity), offset_of!(GpuParticle, spin)]);
}

/// The check can fail: a member left out, swapped or of another size is found.
#[test]
fn a_wrong_twin_is_found() {
    #[repr(C)]
    #[allow(dead_code)] // Only its layout is used.
    struct Swapped {
        position: [u32; 3],
        velocity: [f32; 3],
        tag: u32,
        spin: f32,
    }
    #[repr(C)]
    #[allow(dead_code)] // Only its layout is used.
    struct Short {
        start: f32,
        wall: f32,
        partner: u32,
    }
    let modules = modules();
    let (_, order) = modules.iter().find(|(name, _)| *name == "order").expect("the kernel");
    let swapped = twin!("Particle", Swapped, position, velocity, tag, spin);
    assert_eq!(differences(order, &swapped).map(|found| found.len()), Some(1));
    let same_names = twin!("Particle", Swapped, position, tag, velocity, spin);
    assert_eq!(differences(order, &same_names).map(|found| found.len()), Some(1));
    let short = twin!("Flight", Short, start, wall, partner);
    assert_eq!(differences(order, &short).map(|found| found.len()), Some(2));
    assert!(differences(order, &twin!("NoSuchStruct", Short, start)).is_none());
}

/// Counts of operations, room for lists, and tests go by them.
#[test]
fn constants_of_kernels_are_those_of_the_host() {
    let value = |module: &Module, name: &str| {
        let (_, constant) = module.constants.iter().find(|(_, constant)| constant.name.as_deref() == Some(name))?;
        match module.global_expressions[constant.init] {
            Expression::Literal(Literal::U32(value)) => Some(value),
            _ => panic!("{name} is no number"),
        }
    };
    for (name, of_host) in [("MEMBERS", MEMBERS), ("CROWD", CROWD)] {
        let found: Vec<u32> = modules().iter().filter_map(|(_, module)| value(module, name)).collect();
        assert!(
            !found.is_empty() && found.iter().all(|&value| value == of_host),
            "{name}: {found:?}, {of_host} on the host"
        );
    }
}

/// In their variant for software devices kernels count on it.
#[test]
fn workgroups_have_whole_subgroups() {
    assert!(corpuscle::subdomain::WORKGROUP.is_multiple_of(corpuscle::gpu::WORKGROUP_DIVISOR));
}

/// What is wrong with a table of buffers that are reused, held against the kernels of the phases in which it is which.
fn clashes(reused: &[&[Use]]) -> Vec<String> {
    let at = |phase: &str| PHASES.iter().position(|known| *known == phase).expect("a phase");
    let phases = |used: &Use| -> Vec<usize> {
        let (from, to) = (at(used.from), at(used.to));
        let count = (to + PHASES.len() - from) % PHASES.len();
        (0..=count).map(|k| (from + k) % PHASES.len()).collect()
    };
    let mut found = Vec::new();
    for uses in reused {
        for (k, used) in uses.iter().enumerate() {
            let own = phases(used);
            for other in &uses[k + 1..] {
                let apart = used.runs != other.runs && used.runs != Runs::All && other.runs != Runs::All;
                let others = phases(other);
                let hands_over = |phase: usize| {
                    [(used, other), (other, used)].iter().any(|(a, b)| at(a.to) == phase && at(b.from) == phase)
                };
                let both = own.iter().filter(|phase| others.contains(phase) && !hands_over(**phase));
                found.extend(
                    both.filter(|_| !apart)
                        .map(|&phase| format!("in {} it is {:?} and {:?}", PHASES[phase], used.names, other.names)),
                );
            }
            for kernel in KERNELS.iter().filter(|kernel| !used.idle.contains(&kernel.name)) {
                let bound = kernel.bindings.iter().any(|binding| used.names.contains(&binding.name));
                let outside = kernel.phases.iter().filter(|phase| bound && !own.contains(&at(phase)));
                found.extend(outside.map(|phase| format!("{} has {:?} in {phase}", kernel.name, used.names)));
            }
        }
    }
    found
}

#[test]
fn a_buffer_under_several_names_is_one_at_a_time() {
    assert_eq!(clashes(REUSED), Vec::<String>::new());
    // Each kernel of the step has its phases.
    for kernel in KERNELS.iter().filter(|kernel| !kernel.name.starts_with("ceiling")) {
        assert!(!kernel.phases.is_empty(), "{}: no line '//! phase: ..'", kernel.name);
    }
}

/// The check can fail: a stretch that is too short, one that is too long, and a name of another buffer.
#[test]
fn a_wrong_reuse_is_found() {
    let uses = REUSED.iter().find(|uses| uses[0].names == ["bins"]).expect("the buffer");
    let changed = |change: fn(&mut Vec<Use>)| {
        let mut uses = uses.to_vec();
        change(&mut uses);
        clashes(&[&uses])
    };
    assert!(changed(|_| ()).is_empty());
    assert_eq!(changed(|uses| uses[0].to = "scan").len(), 5, "the kernels of the sort read the bins");
    assert!(changed(|uses| uses[0].to = "neighbours").iter().any(|clash| clash.contains("in collide it is")));
    assert!(!changed(|uses| uses[2].names = &["slots"]).is_empty());
}
