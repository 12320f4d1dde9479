//! Draws edges of meshes as lines of some pixels' width, before what they lie on.
//! uses: view.wgsl
//! binds: items as lines
//!
//! Reads the lines, writes colour where nothing nearer is; no depth.

struct Line {
    from_x: f32,
    from_y: f32,
    from_z: f32,
    /// Four bytes, red in the lowest; the fourth is the opacity.
    colour: u32,
    to_x: f32,
    to_y: f32,
    to_z: f32,
    /// Pixels.
    width: f32,
}

var<storage, read> lines: array<Line>;

struct Corner {
    @builtin(position) position: vec4<f32>,
    @location(0) @interpolate(flat) colour: vec4<f32>,
}

@vertex
fn vertex(@builtin(vertex_index) index: u32, @builtin(instance_index) which: u32) -> Corner {
    let line = lines[which];
    let start = projected(turned(vec3<f32>(line.from_x, line.from_y, line.from_z)));
    let end = projected(turned(vec3<f32>(line.to_x, line.to_y, line.to_z)));
    let along = (end.xy - start.xy) * view.size;
    let length = length(along);
    // A line towards the viewer is a point.
    let way = select(vec2<f32>(1.0, 0.0), along / max(length, 1e-6), length > 1e-6);
    let at_end = index == 1u || index == 4u || index == 5u;
    let on_left = index == 2u || index == 3u || index == 5u;
    let across = vec2<f32>(-way.y, way.x) * select(-1.0, 1.0, on_left) + way * select(-1.0, 1.0, at_end);
    let place = select(start, end, at_end);
    let lifted = max(place.z - view.lift, 0.0);
    let position = vec4<f32>(place.xy + across * line.width / view.size, lifted, 1.0);
    return Corner(position, unpack4x8unorm(line.colour));
}

@fragment
fn fragment(corner: Corner) -> @location(0) vec4<f32> {
    return vec4<f32>(faded(corner.colour.rgb, corner.position.z), corner.colour.a);
}
