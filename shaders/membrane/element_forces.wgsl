//! uses: thread.wgsl membrane.wgsl metric.wgsl stress.wgsl
//! phase: membrane
// The forces that each triangle puts on its corners: of strain, of damping, of pressure.
//
// F = e2 g2^T + e3 g3^T with the edges e2, e3 from the first corner and the gradients g2, g3 of the shares of the others; E = (F^T F - I)/2, exactly from
// lattice differences (metric.wgsl) and, in floats, from the remainders; force on corner a: -V F S g_a, S by stress.wgsl. Damping: S = 2 eta dE/dt
// along what bears tension. Pressure p: p A n/3 on each corner.
//
// A reference whose lengths are s times the true ones has C/s^2 in place of C = F^T F = 1 + 2E, s^2 V in place of V, and g/s in place of g: the force is
// -V F S g as before, with the stress S of (C/s^2 - 1)/2. Its change by ds does the work V s ds (2 W - tr S - 2 S:E), W the energy of a volume.
//
// Reads `substep` (the time), `membrane_nodes`, `elements`, `elastic`; writes `element_forces`. One thread per triangle.

var<uniform> substep: Substep;
var<uniform> membrane_step: MembraneStep;
var<storage, read> membrane_nodes: array<MembraneNode>;
var<storage, read> elements: array<Element>;
var<storage, read> elastic: array<Elastic>;
var<storage, read_write> element_forces: array<ElementForces>;

// A symmetric tensor's components by the gradients.
fn by_gradients(tensor: vec3<f32>, a: vec2<f32>, b: vec2<f32>) -> f32 {
    return a.x * (tensor.x * b.x + tensor.z * b.y) + a.y * (tensor.z * b.x + tensor.y * b.y);
}

// Half the sum of changes of the metric (22, 33, 23) with both gradients.
fn strain_of(metric: vec3<f32>, g2: vec2<f32>, g3: vec2<f32>) -> vec3<f32> {
    let xx = metric.x * g2.x * g2.x + metric.y * g3.x * g3.x + 2.0 * metric.z * g2.x * g3.x;
    let yy = metric.x * g2.y * g2.y + metric.y * g3.y * g3.y + 2.0 * metric.z * g2.y * g3.y;
    let xy = metric.x * g2.x * g2.y + metric.y * g3.x * g3.y + metric.z * (g2.x * g3.y + g3.x * g2.y);
    return 0.5 * vec3<f32>(xx, yy, xy);
}

// By how much lengths of a reference are larger than true, over these, at a time of the interval, s.
fn loose_at(law: Elastic, time: f32) -> f32 {
    let loose = law.loose - law.tightening * time;
    return select(loose, 0.0, law.tightening != 0.0 && loose * law.tightening <= 0.0);
}

@compute @workgroup_size(WORKGROUP)
fn forces_of_elements(thread: Thread) {
    let k = linear(thread);
    if (k >= membrane_step.elements) {
        return;
    }
    let element = elements[k];
    let a = membrane_nodes[element.nodes.x];
    let b = membrane_nodes[element.nodes.y];
    let c = membrane_nodes[element.nodes.z];
    let q = membrane_step.quantum;
    // Edges: whole quanta, what is beside them, and the sum in m.
    let whole2 = bitcast<vec3<i32>>(b.place - a.place);
    let whole3 = bitcast<vec3<i32>>(c.place - a.place);
    let rest2 = b.remainder - a.remainder;
    let rest3 = c.remainder - a.remainder;
    let float2 = vec3<f32>(whole2);
    let float3 = vec3<f32>(whole3);
    let e2 = q * (float2 + rest2);
    let e3 = q * (float3 + rest3);
    let metric = (q * q) * vec3<f32>(
        dot64(whole2, whole2, element.second2) + dot(2.0 * float2 + rest2, rest2),
        dot64(whole3, whole3, element.third2) + dot(2.0 * float3 + rest3, rest3),
        dot64(whole2, whole3, element.second_third) + dot(float2, rest3) + dot(float3 + rest3, rest2)
    );
    let law = elastic[element.elastic];
    let time = f32(substep.slot) * membrane_step.gas_dt + f32(substep.substep) * membrane_step.dt;
    let size = 1.0 + loose_at(law, time);
    let square = size * size;
    let true_strain = strain_of(metric, element.second, element.third);
    let strain = (true_strain + 0.5 * (1.0 - square) * vec3<f32>(1.0, 1.0, 0.0)) / square;
    let found = tension(law, strain);

    let w2 = b.velocity - a.velocity;
    let w3 = c.velocity - a.velocity;
    let metric_rate = vec3<f32>(2.0 * dot(e2, w2), 2.0 * dot(e3, w3), dot(e2, w3) + dot(e3, w2));
    let rate = in_tension(found, strain_of(metric_rate, element.second, element.third) / square);
    let damping = 2.0 * element.viscosity * rate;

    var forces: ElementForces;
    let s22 = element.volume * by_gradients(found.stress, element.second, element.second);
    let s33 = element.volume * by_gradients(found.stress, element.third, element.third);
    let s23 = element.volume * by_gradients(found.stress, element.second, element.third);
    forces.second = -(s22 * e2 + s23 * e3);
    forces.third = -(s23 * e2 + s33 * e3);
    let d22 = element.volume * by_gradients(damping, element.second, element.second);
    let d33 = element.volume * by_gradients(damping, element.third, element.third);
    let d23 = element.volume * by_gradients(damping, element.second, element.third);
    forces.damped_second = -(d22 * e2 + d23 * e3);
    forces.damped_third = -(d23 * e2 + d33 * e3);
    forces.pressed = (element.pressure / 6.0) * cross(e2, e3);
    forces.energy = element.volume * square * found.energy;
    let relaxing = 2.0 * found.energy - (found.stress.x + found.stress.y) - 2.0 * contracted(found.stress, strain);
    // In half the last step and half this one, as forces act.
    let change = loose_at(law, time + 0.5 * membrane_step.dt) - loose_at(law, time - 0.5 * a.dt);
    forces.relaxed = element.volume * size * change * relaxing;
    forces.state = found.state;
    element_forces[k] = forces;
}
