//! Draws triangles, shaded on both sides: meshes that hide what is behind them, and walls that let it through.
//! uses: view.wgsl
//! binds: items as corners
//!
//! Reads the corners, three for each triangle, and writes colour and depth. The alpha channel has the opacity: 1 of a
//! mesh, by which the host knows it.

struct Corner {
    x: f32,
    y: f32,
    z: f32,
    /// Four bytes, red in the lowest; the fourth is the opacity.
    front: u32,
    normal_x: f32,
    normal_y: f32,
    normal_z: f32,
    /// The colour of the side that the normal points away from.
    back: u32,
}

var<storage, read> corners: array<Corner>;

struct Seen {
    @builtin(position) position: vec4<f32>,
    /// In the viewer's directions.
    @location(0) normal: vec3<f32>,
    @location(1) @interpolate(flat) front: vec4<f32>,
    @location(2) @interpolate(flat) back: vec4<f32>,
}

@vertex
fn vertex(@builtin(vertex_index) index: u32) -> Seen {
    let corner = corners[index];
    let normal = turned(vec3<f32>(corner.normal_x, corner.normal_y, corner.normal_z));
    let place = turned(vec3<f32>(corner.x, corner.y, corner.z));
    return Seen(projected(place), normal, unpack4x8unorm(corner.front), unpack4x8unorm(corner.back));
}

@fragment
fn fragment(seen: Seen, @builtin(front_facing) is_front: bool) -> @location(0) vec4<f32> {
    let normal = normalize(select(-seen.normal, seen.normal, is_front));
    let colour = select(seen.back, seen.front, is_front);
    return vec4<f32>(faded(min(colour.rgb * lit(normal), vec3<f32>(1.0)), seen.position.z), colour.a);
}
