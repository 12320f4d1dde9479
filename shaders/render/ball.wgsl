//! Draws particles as shaded balls with depth: a square for each, of which the fragments of the ball's disc are kept.
//! uses: view.wgsl
//! binds: items as balls
//!
//! Reads the balls, writes colour and depth; in the alpha channel is BALL, by which the host knows them. A ball has the
//! depth of its centre: one behind a sheet does not come through it. The depth test decides, of equal depths the first in
//! the list.

struct Ball {
    x: f32,
    y: f32,
    z: f32,
    /// Four bytes, red in the lowest.
    colour: u32,
}

var<storage, read> balls: array<Ball>;

const BALL: f32 = 0.5;

struct Corner {
    @builtin(position) position: vec4<f32>,
    /// From the centre, in radii.
    @location(0) offset: vec2<f32>,
    @location(1) @interpolate(flat) colour: vec3<f32>,
}

@vertex
fn vertex(@builtin(vertex_index) index: u32, @builtin(instance_index) which: u32) -> Corner {
    let ball = balls[which];
    let low = index == 0u || index == 1u || index == 4u;
    let left = index == 0u || index == 2u || index == 3u;
    let offset = vec2<f32>(select(1.0, -1.0, left), select(1.0, -1.0, low));
    var place = turned(vec3<f32>(ball.x, ball.y, ball.z));
    place += vec3<f32>(offset * view.middle.w, 0.0);
    return Corner(projected(place), offset, unpack4x8unorm(ball.colour).rgb);
}

@fragment
fn fragment(corner: Corner) -> @location(0) vec4<f32> {
    let far = dot(corner.offset, corner.offset);
    if far > 1.0 {
        discard;
    }
    let normal = vec3<f32>(corner.offset, sqrt(1.0 - far));
    // A dark rim sets a ball off from those behind it.
    let rim = 1.0 - 0.5 * smoothstep(0.6, 1.0, far);
    let colour = min(corner.colour * lit(normal) * rim * 1.1, vec3<f32>(1.0));
    return vec4<f32>(faded(colour, corner.position.z), BALL);
}
