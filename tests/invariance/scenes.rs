//! The scenes whose bits are compared.

use corpuscle::geometry::{MeshShape, Motion as NodeMotion, Precision, TriangleMesh};
use corpuscle::scene::Method;
use corpuscle::simulation::Model;

use crate::whole_run::{model, model_in, published};

/// The same scene by another method, in at least five intervals.
pub fn by(method: Method, model: Model) -> Model {
    let mut scene = model.scene;
    scene.model.method = Some(method);
    scene.model.time_step = Some(scene.model.time_step.unwrap_or(f64::INFINITY).min(scene.end_time / 160.0));
    Model::new(scene).expect("a model")
}

/// The first part of a scene, with as many rows.
pub fn first(part: f64, model: Model) -> Model {
    let mut scene = model.scene;
    scene.end_time *= part;
    Model::new(scene).expect("a model")
}

/// The first 4 ms of the tank with steps so long that the inner box's rise makes them finer.
pub fn tank(snapshots: u32) -> Model {
    let mut scene = published("tank.toml", 1500, 0.004).scene;
    scene.model.time_step = Some(2e-5);
    scene.output.snapshots = snapshots;
    Model::new(scene).expect("a model")
}

/// A jet into a box: three times as much gas flows in as was there.
pub fn burst() -> Model {
    model(
        "end_time = 1e-3\n[[gas]]\nname = \"air\"\nmolar_mass = 0.029\ngamma = 1.4\n\
         [[wall]]\nname = \"box\"\nshape = \"box\"\nmin = [0.0, 0.0, 0.0]\nmax = [0.1, 0.1, 0.1]\ngas = \"inside\"\n\
         [[chamber]]\nname = \"all\"\npressure = 2e4\ntemperature = 300.0\ngas = \"air\"\n\
         [[orifice]]\nname = \"inlet\"\nposition = [0.0, 0.05, 0.05]\ndirection = [1.0, 0.0, 0.0]\narea = 0.004\n\
         gas = \"air\"\ntemperature = 300.0\nmass_flow = [[0.0, 0.7], [2e-3, 0.7]]\n\
         [model]\nmethod = \"closest-approach\"\nparticles = 3000\n[output]\nrows = 5\nsnapshots = 0\n",
    )
}

/// The same with particles so large that the neighbour lists grow longer and longer, and a vent.
pub fn crowding(particles: u32, diameter: f64) -> Model {
    model(&format!(
        "end_time = 6e-4\n[[gas]]\nname = \"air\"\nmolar_mass = 0.029\ngamma = 1.4\n\
         [[wall]]\nname = \"box\"\nshape = \"box\"\nmin = [0.0, 0.0, 0.0]\nmax = [0.1, 0.1, 0.1]\ngas = \"inside\"\n\
         [[chamber]]\nname = \"all\"\npressure = 2e4\ntemperature = 300.0\ngas = \"air\"\n\
         [[orifice]]\nname = \"inlet\"\nposition = [0.0, 0.05, 0.05]\ndirection = [1.0, 0.0, 0.0]\narea = 0.004\n\
         gas = \"air\"\ntemperature = 300.0\nmass_flow = [[0.0, 2.0], [6e-4, 2.0]]\n\
         [[surface]]\nname = \"walls\"\nwall = \"box\"\n\
         [model]\nparticles = {particles}\ndiameter = {diameter}\ndiameter_cap = \"off\"\ntime_step = 4e-6\n[output]\nrows = 5\nsnapshots = 0\n"
    ))
}

/// Carbon dioxide, whose heat capacity grows, and helium blow into air and helium within warm walls.
pub fn curves() -> Model {
    model(
        "end_time = 8e-4\n[[gas]]\nname = \"air\"\nmolar_mass = 0.029\ngamma = 1.4\n\
         [[gas]]\nname = \"helium\"\nmolar_mass = 0.004\ngamma = 1.667\n\
         [[gas]]\nname = \"carbon dioxide\"\nmolar_mass = 0.044\ncp = [23.0, 5.6e-2, -2.2e-5]\n\
         [[wall]]\nname = \"box\"\nshape = \"box\"\nmin = [0.0, 0.0, 0.0]\nmax = [0.1, 0.1, 0.1]\ngas = \"inside\"\n\
         temperature = 450.0\naccommodation = 0.4\n\
         [[chamber]]\nname = \"all\"\npressure = 4e4\ntemperature = 300.0\ngas = { air = 0.7, helium = 0.3 }\n\
         [[orifice]]\nname = \"inlet\"\nposition = [0.0, 0.05, 0.05]\ndirection = [1.0, 0.0, 0.0]\narea = 0.004\n\
         gas = { helium = 0.25, \"carbon dioxide\" = 0.75 }\ntemperature = 700.0\nmass_flow = [[0.0, 0.3], [2e-3, 0.3]]\n\
         [model]\nmethod = \"closest-approach\"\nparticles = 2000\n[output]\nrows = 5\nsnapshots = 0\n",
    )
}

/// A box, cold and thin on one side of a rough plate with a hole and so dense on the other that diameters are capped.
pub fn plate() -> Model {
    model(
        "end_time = 3e-4\n[[gas]]\nname = \"air\"\nmolar_mass = 0.029\ngamma = 1.4\n\
         [[wall]]\nname = \"box\"\nshape = \"box\"\nmin = [0.0, 0.0, 0.0]\nmax = [0.12, 0.08, 0.08]\ngas = \"inside\"\n\
         [[wall]]\nname = \"plate\"\nshape = \"plane\"\ncenter = [0.05, 0.04, 0.04]\nnormal = [0.8, 0.6, 0.0]\n\
         u = [-0.6, 0.8, 0.0]\nsize = [0.05, 0.06]\nthickness = 0.001\nfriction = 0.5\n\
         [[wall.hole]]\nname = \"hole\"\ncenter = [0.005, 0.0]\nsize = [0.02, 0.03]\n\
         [[chamber]]\nname = \"dense\"\nregion = { box = { min = [0.0, 0.0, 0.0], max = [0.04, 0.08, 0.08] } }\n\
         pressure = 3e5\ntemperature = 500.0\ngas = \"air\"\n\
         [[chamber]]\nname = \"thin\"\npressure = 2e4\ntemperature = 250.0\ngas = \"air\"\n\
         [[surface]]\nname = \"walls\"\nwall = \"box\"\n[[surface]]\nname = \"plate\"\nwall = \"plate\"\n\
         [model]\nparticles = 2500\noccupancy = 0.1\n[output]\nrows = 10\nsnapshots = 0\n",
    )
}

/// Two hot gases between a cold box, a warmer plate with a heat-transfer coefficient, and a mirror.
pub fn cold_walls() -> Model {
    model(
        "end_time = 2e-4\n[[gas]]\nname = \"air\"\nmolar_mass = 0.029\ngamma = 1.4\n\
         [[gas]]\nname = \"helium\"\nmolar_mass = 0.004\ngamma = 1.6667\n\
         [[wall]]\nname = \"box\"\nshape = \"box\"\nmin = [0.0, 0.0, 0.0]\nmax = [0.1, 0.08, 0.08]\ngas = \"inside\"\n\
         temperature = 250.0\naccommodation = 0.5\n\
         [[wall]]\nname = \"plate\"\nshape = \"plane\"\ncenter = [0.05, 0.04, 0.04]\nnormal = [0.8, 0.6, 0.0]\n\
         u = [-0.6, 0.8, 0.0]\nsize = [0.05, 0.06]\nthickness = 0.002\ntemperature = 350.0\nheat_transfer = 2e4\n\
         [[wall]]\nname = \"ball\"\nshape = \"sphere\"\ncenter = [0.02, 0.02, 0.02]\nradius = 0.01\nsubdivisions = 1\n\
         gas = \"outside\"\n\
         [[chamber]]\nname = \"dense\"\nregion = { box = { min = [0.0, 0.0, 0.0], max = [0.04, 0.08, 0.08] } }\n\
         pressure = 2e5\ntemperature = 900.0\ngas = { air = 0.6, helium = 0.4 }\n\
         [[chamber]]\nname = \"thin\"\npressure = 1e5\ntemperature = 600.0\ngas = \"air\"\n\
         [[surface]]\nname = \"walls\"\nwall = \"box\"\n\
         [model]\nparticles = 2000\noccupancy = 0.1\n[output]\nrows = 8\nsnapshots = 0\n",
    )
}

/// Gas at rest, with the impulse on its walls.
pub fn gas_box() -> Model {
    published("box.toml", 2000, 4e-4)
}

/// Small particles far apart: so many cells that one device clears them, where three have each so few that they empty them otherwise.
pub fn thin() -> Model {
    let mut scene = published("box.toml", 2000, 1.2e-4).scene;
    scene.model.occupancy = Some(2.2e-3);
    scene.output.rows = 5;
    Model::new(scene).expect("a model")
}

/// Gas flows in and leaves through a vent that opens on the way and through leaking walls.
pub fn venting() -> Model {
    let mut scene = published("vent.toml", 1000, 0.004).scene;
    scene.model.method = Some(Method::ClosestApproach);
    scene.vents[0].opening_pressure = 1e3;
    scene.vents[0].area = Some(0.004);
    scene.output.rows = 10;
    Model::new(scene).expect("a model")
}

/// The same in free flight, where those that have left leave their places empty.
pub fn venting_freely() -> Model {
    let mut scene = venting().scene;
    scene.model.method = Some(Method::None);
    Model::new(scene).expect("a model")
}

/// Free flight: not even its memory is in order.
pub fn effusion() -> Model {
    published("effusion.toml", 3000, 4e-3)
}

/// Dense gas with long neighbour lists: intervals are run again, and nothing is lost.
pub fn dense(seed: u64) -> Model {
    model(&format!(
        "end_time = 1.5e-4\nseed = {seed}\n[[gas]]\nname = \"air\"\nmolar_mass = 0.029\ngamma = 1.4\n\
         [[wall]]\nname = \"box\"\nshape = \"box\"\nmin = [0.0, 0.0, 0.0]\nmax = [0.1, 0.1, 0.1]\ngas = \"inside\"\n\
         [[chamber]]\nname = \"all\"\npressure = 1e5\ntemperature = 300.0\ngas = \"air\"\n\
         [[surface]]\nname = \"walls\"\nwall = \"box\"\n\
         [model]\nparticles = 1500\ndiameter = 0.010\ntime_step = 1e-5\n[output]\nrows = 5\nsnapshots = 0\n"
    ))
}

/// Seven steps of thin gas in a long tube: fewer than between two tallies, so speeds may be beyond their range.
pub fn tube() -> Model {
    let mut model = model(
        "end_time = 1e-5\n[[gas]]\nname = \"air\"\nmolar_mass = 0.029\ngamma = 1.4\n\
         [[wall]]\nname = \"tube\"\nshape = \"box\"\nmin = [0.0, 0.0, 0.0]\nmax = [0.4, 0.05, 0.05]\ngas = \"inside\"\n\
         [[chamber]]\nname = \"all\"\npressure = 1e5\ntemperature = 300.0\ngas = \"air\"\n\
         [model]\nparticles = 2500\noccupancy = 0.005\n[output]\nrows = 1\nsnapshots = 0\n",
    );
    model.scene.end_time = 14.0 * model.plan.time_step;
    let mut model = Model::new(model.scene).expect("a model");
    model.plan.steps_per_interval = 7;
    model
}

/// A short jet into a box with a vent and a warm wall, that goes on as a control volume once pressures are uniform.
pub fn switching() -> Model {
    model(
        "end_time = 4e-3\n[[gas]]\nname = \"air\"\nmolar_mass = 0.029\ngamma = 1.4\n\
         [[wall]]\nname = \"box\"\nshape = \"box\"\nmin = [0.0, 0.0, 0.0]\nmax = [0.1, 0.1, 0.1]\ngas = \"inside\"\n\
         temperature = 350.0\naccommodation = 0.3\n\
         [[chamber]]\nname = \"all\"\npressure = 1e5\ntemperature = 300.0\ngas = \"air\"\n\
         [[orifice]]\nname = \"inlet\"\nposition = [0.0, 0.05, 0.05]\ndirection = [1.0, 0.0, 0.0]\narea = 0.002\n\
         gas = \"air\"\ntemperature = 300.0\nmass_flow = [[0.0, 0.7], [6e-4, 0.0]]\n\
         [[vent]]\nname = \"pores\"\nwall = \"box\"\ndischarge = 0.01\nexternal_pressure = 1e5\n\
         [[surface]]\nname = \"behind\"\nwall = \"box\"\nface = \"-x\"\n[[probe]]\nname = \"corner\"\n\
         region = { box = { min = [0.0, 0.0, 0.0], max = [0.1, 0.04, 0.04] } }\n\
         [model]\nmethod = \"closest-approach\"\nparticles = 2000\nswitch = \"when-uniform\"\nuniform_for = 5e-4\n[output]\nrows = 40\nsnapshots = 0\n",
    )
}

/// A plate between two chambers, no mirror, is driven faster and faster through gas that flows in, and a ball moves the
/// other way.
pub fn pistons() -> Model {
    model(
        "end_time = 3e-4\n[[gas]]\nname = \"air\"\nmolar_mass = 0.029\ngamma = 1.4\n\
         [[gas]]\nname = \"helium\"\nmolar_mass = 0.004\ngamma = 1.6667\n\
         [[wall]]\nname = \"box\"\nshape = \"box\"\nmin = [0.0, 0.0, 0.0]\nmax = [0.1, 0.06, 0.06]\ngas = \"inside\"\n\
         [[wall]]\nname = \"plate\"\nshape = \"plane\"\ncenter = [0.03, 0.03, 0.03]\nnormal = [1.0, 0.0, 0.0]\n\
         u = [0.0, 1.0, 0.0]\nsize = [0.064, 0.06]\nthickness = 0.002\ntemperature = 400.0\naccommodation = 0.5\nfriction = 0.6\n\
         [[wall]]\nname = \"ball\"\nshape = \"sphere\"\ncenter = [0.09, 0.015, 0.03]\nradius = 0.008\nsubdivisions = 1\n\
         gas = \"outside\"\nfriction = 1.0\n\
         [[motion]]\nwall = \"plate\"\ndirection = [1.0, 0.0, 0.0]\nvelocity = [[0.0, 0.0], [1.5e-4, 150.0]]\n\
         [[motion]]\nwall = \"ball\"\ndirection = [0.0, 1.0, 0.0]\ndisplacement = [[0.0, 0.0], [1.5e-4, 0.015], [2.25e-4, 0.0]]\n\
         [[chamber]]\nname = \"behind\"\nregion = { box = { min = [0.0, 0.0, 0.0], max = [0.03, 0.06, 0.06] } }\n\
         pressure = 2e5\ntemperature = 300.0\ngas = { air = 0.5, helium = 0.5 }\n\
         [[chamber]]\nname = \"before\"\npressure = 1e5\ntemperature = 300.0\ngas = \"air\"\n\
         [[orifice]]\nname = \"inlet\"\nposition = [0.0, 0.03, 0.03]\ndirection = [1.0, 0.0, 0.0]\narea = 0.001\n\
         gas = \"air\"\ntemperature = 300.0\nmass_flow = [[0.0, 0.3], [2e-3, 0.3]]\n\
         [[surface]]\nname = \"walls\"\nwall = \"box\"\n\
         [model]\nparticles = 1200\n[output]\nrows = 8\nsnapshots = 0\n",
    )
}

/// A bag that is shaken, with another pressure inside, and gas that flows into it.
pub fn shaken_bag(method: Method) -> Model {
    bag(method, "", "")
}

/// The same of warm and rough fabric, with pores that lead to the gas around and a vent in them that opens late.
pub fn porous_bag(method: Method) -> Model {
    bag(
        method,
        "temperature = 350.0\naccommodation = 0.3\nfriction = 0.5\n",
        "[[vent]]\nname = \"vent\"\nfabric = \"bag\"\nface = \"upper\"\nposition = [0.05, 0.05, 0.05]\ndiameter = 0.05\n\
         area = 0.0002\ndischarge = 0.7\nopening_pressure = 1.8e5\n\
         [[vent]]\nname = \"pores\"\nfabric = \"bag\"\nleak_velocity = [[0.0, 0.0], [2e5, 30.0]]\n",
    )
}

/// Two shaken bags so near each other that their boxes overlap, and a turning plate with pores and a hole that opens late.
pub fn several_fabrics(method: Method) -> Model {
    several(method, "", "")
}

/// The same with one bag elastic, some of its nodes shaken, and a block that moves against it.
pub fn driven_fabrics(method: Method) -> Model {
    several(
        method,
        "fixed = [{ sphere = { center = [0.02, 0.04, 0.03], radius = 0.015 } }]\n\
         [fabric.material]\nthickness = 3.3e-4\ndensity = 9000.0\nyoung = 4e8\npoisson = 0.3\n",
        "[[wall]]\nname = \"block\"\nshape = \"box\"\nmin = [0.045, 0.025, -0.02]\nmax = [0.075, 0.055, 0.002]\ngas = \"outside\"\n\
         [[motion]]\nwall = \"block\"\ndirection = [0.0, 0.0, 1.0]\nvelocity = [[0.0, 0.0], [3e-4, 40.0]]\n",
    )
}

/// `low`: keys of the lower bag.
fn several(method: Method, low: &str, more: &str) -> Model {
    let folder = tempfile::TempDir::new().expect("a folder");
    for (name, x, seed) in [("low", 0.045, 3), ("high", 0.055, 4)] {
        let shape = MeshShape::Cushion { radius: 0.03, rings: 3, gap: 0.01 };
        let mut mesh = shape.mesh([0.0; 3]).expect("a cushion");
        // Askew, one above the other.
        let away = if seed == 3 { -0.008 } else { 0.008 };
        for node in &mut mesh.nodes {
            let [a, b, c] = [node[0], node[1], node[2] + away];
            *node = [x + 0.8 * a + 0.6 * c, 0.04 + b, 0.03 - 0.6 * a + 0.8 * c];
        }
        let shake = NodeMotion::Shake { speed: 40.0, amplitude: Some(5e-4), seed };
        let frames = shake.frames(&mesh, 25, 3e-4).expect("frames");
        mesh.write(&folder.path().join(format!("{name}.obj")), 1.0).expect("a mesh file");
        frames.write(&folder.path().join(format!("{name}.nodes")), Precision::Double).expect("a file of nodes");
    }
    let mut plate = TriangleMesh::default();
    plate.nodes.extend((0..21).map(|k| [0.02 + 0.03 * f64::from(k % 3), 0.01 + 0.01 * f64::from(k / 3), 0.1]));
    let squares = (0..17).filter(|k| k % 3 < 2);
    plate.triangles.extend(squares.flat_map(|k| [[k, k + 1, k + 4], [k, k + 4, k + 3]]));
    plate.parts = vec![None; plate.triangles.len()];
    plate.write(&folder.path().join("plate.obj"), 1.0).expect("a mesh file");
    let bag = |name: &str, keys: &str, pressure: f64| {
        format!(
            "[[fabric]]\nname = \"{name}\"\nfile = \"{name}.obj\"\nmotion = \"{name}.nodes\"\n{keys}[[chamber]]\nname = \"in {name}\"\n\
             inside = \"{name}\"\npressure = {pressure:e}\ntemperature = 400.0\ngas = \"air\"\n"
        )
    };
    model_in(
        &format!(
            "end_time = 3e-4\n[[gas]]\nname = \"air\"\nmolar_mass = 0.029\ngamma = 1.4\n\
             [[wall]]\nname = \"box\"\nshape = \"box\"\nmin = [0.0, 0.0, 0.0]\nmax = [0.1, 0.08, 0.12]\ngas = \"inside\"\n{more}{}{}\
             [[chamber]]\nname = \"out\"\npressure = 1e5\ntemperature = 300.0\ngas = \"air\"\n\
             [[fabric]]\nname = \"plate\"\nfile = \"plate.obj\"\n[fabric.turn]\naxis = [0.0, 1.0, 0.0]\ncenter = [0.05, 0.0, 0.1]\n\
             angular_velocity = 1500.0\n\
             [[vent]]\nname = \"hole\"\nfabric = \"plate\"\nposition = [0.03, 0.04, 0.1]\ndiameter = 0.03\narea = 0.0002\n\
             discharge = 0.7\nopening_pressure = 1e2\n\
             [[vent]]\nname = \"pores\"\nfabric = \"plate\"\nleak_velocity = [[0.0, 0.0], [5e3, 300.0]]\n\
             [model]\nmethod = \"{}\"\nparticles = 1500\ntime_step = 1.8e-6\n[output]\nrows = 8\nsnapshots = 0\n",
            bag("low", low, 3e5),
            bag("high", "", 2e5),
            method.name()
        ),
        folder.path(),
    )
}

/// With more keys of its fabric, and more entries.
fn bag(method: Method, keys: &str, more: &str) -> Model {
    let folder = tempfile::TempDir::new().expect("a folder");
    let mesh = MeshShape::Cushion { radius: 0.04, rings: 4, gap: 0.018 }.mesh([0.05, 0.05, 0.04]).expect("a cushion");
    let shake = NodeMotion::Shake { speed: 60.0, amplitude: Some(1.5e-3), seed: 3 };
    let frames = shake.frames(&mesh, 25, 3e-4).expect("frames");
    mesh.write(&folder.path().join("bag.obj"), 1.0).expect("a mesh file");
    frames.write(&folder.path().join("bag.nodes"), Precision::Double).expect("a file of nodes");
    model_in(
        &format!(
            "end_time = 3e-4\n[[gas]]\nname = \"air\"\nmolar_mass = 0.029\ngamma = 1.4\n\
             [[gas]]\nname = \"helium\"\nmolar_mass = 0.004\ngamma = 1.6667\n\
             [[wall]]\nname = \"box\"\nshape = \"box\"\nmin = [0.0, 0.0, 0.0]\nmax = [0.1, 0.1, 0.08]\ngas = \"inside\"\n\
             [[fabric]]\nname = \"bag\"\nfile = \"bag.obj\"\nmotion = \"bag.nodes\"\n{keys}{more}\
             [[chamber]]\nname = \"in\"\ninside = \"bag\"\npressure = 3e5\ntemperature = 400.0\ngas = {{ air = 0.5, helium = 0.5 }}\n\
             [[chamber]]\nname = \"out\"\npressure = 1e5\ntemperature = 300.0\ngas = \"air\"\n\
             [[orifice]]\nname = \"inlet\"\nposition = [0.05, 0.05, 0.04]\ndirection = [1.0, 0.0, 0.0]\narea = 0.0001\n\
             gas = \"helium\"\ntemperature = 500.0\nmass_flow = [[0.0, 0.05], [2e-3, 0.05]]\n\
             [[surface]]\nname = \"walls\"\nwall = \"box\"\n\
             [model]\nmethod = \"{}\"\nparticles = 1500\ntime_step = 1.8e-6\n[output]\nrows = 8\nsnapshots = 0\n",
            method.name()
        ),
        folder.path(),
    )
}

/// An elastic bag that the gas inflates, with gas around it and gas that flows into it.
pub fn inflated_bag(method: Method) -> Model {
    elastic_bag(method, "", "")
}

/// The same of warm, rough and heavy fabric with a vent, whose reference shrinks.
pub fn vented_bag(method: Method) -> Model {
    let vent = "[[vent]]\nname = \"vent\"\nfabric = \"bag\"\nface = \"upper\"\narea = 0.001\ndischarge = 0.7\n";
    let keys = "temperature = 350.0\naccommodation = 0.3\nfriction = 0.5\nreference_scale = 1.02\nreference_time = 2e-4\n\
                added_mass = 0.05\nwall_friction = 0.3\n";
    elastic_bag(method, keys, vent)
}

/// With more keys of its fabric, and more entries.
fn elastic_bag(method: Method, keys: &str, more: &str) -> Model {
    let folder = tempfile::TempDir::new().expect("a folder");
    let mesh = MeshShape::Cushion { radius: 0.04, rings: 4, gap: 0.018 }.mesh([0.05, 0.05, 0.04]).expect("a cushion");
    mesh.write(&folder.path().join("bag.obj"), 1.0).expect("a mesh file");
    model_in(
        &format!(
            "end_time = 3e-4\n[[gas]]\nname = \"air\"\nmolar_mass = 0.029\ngamma = 1.4\n\
             [[gas]]\nname = \"helium\"\nmolar_mass = 0.004\ngamma = 1.6667\n\
             [[wall]]\nname = \"box\"\nshape = \"box\"\nmin = [0.0, 0.0, 0.0]\nmax = [0.1, 0.1, 0.08]\ngas = \"inside\"\n\
             [[fabric]]\nname = \"bag\"\nfile = \"bag.obj\"\n{keys}\
             [fabric.material]\nthickness = 3e-4\ndensity = 800.0\nyoung = 1e8\npoisson = 0.3\n{more}\
             [[chamber]]\nname = \"in\"\ninside = \"bag\"\npressure = 3e5\ntemperature = 400.0\ngas = {{ air = 0.5, helium = 0.5 }}\n\
             [[chamber]]\nname = \"out\"\npressure = 1e5\ntemperature = 300.0\ngas = \"air\"\n\
             [[orifice]]\nname = \"inlet\"\nposition = [0.05, 0.05, 0.04]\ndirection = [1.0, 0.0, 0.0]\narea = 0.0001\n\
             gas = \"helium\"\ntemperature = 500.0\nmass_flow = [[0.0, 0.05], [2e-3, 0.05]]\n\
             [[surface]]\nname = \"walls\"\nwall = \"box\"\n\
             [model]\nmethod = \"{}\"\nparticles = 1500\ntime_step = 1.8e-6\n[output]\nrows = 8\nsnapshots = 0\n",
            method.name()
        ),
        folder.path(),
    )
}
