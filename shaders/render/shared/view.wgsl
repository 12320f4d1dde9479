//! The camera of a picture: a parallel projection, with a light that goes with the viewer.
//!
//! Positions are in m from what the camera looks at, directions those of the viewer: right, up, towards him.

struct View {
    /// Unit vectors; behind `right` clip units to the right per m, behind `up` those upwards.
    right: vec4<f32>,
    up: vec4<f32>,
    /// Behind it the depth (0 near, 1 far) per m.
    towards: vec4<f32>,
    /// Where the middle of what is seen lies, in clip units (x, y); its depth; the radius of a ball, m.
    middle: vec4<f32>,
    /// The background, and how much of it the farthest has.
    background: vec4<f32>,
    /// Pixels.
    size: vec2<f32>,
    /// Depth by which lines come forward.
    lift: f32,
    unused: f32,
}

var<uniform> view: View;

/// In the viewer's directions.
fn turned(direction: vec3<f32>) -> vec3<f32> {
    return vec3<f32>(dot(view.right.xyz, direction), dot(view.up.xyz, direction), dot(view.towards.xyz, direction));
}

/// Clip coordinates of a place that is given in the viewer's directions.
fn projected(place: vec3<f32>) -> vec4<f32> {
    let across = view.middle.xy + place.xy * vec2<f32>(view.right.w, view.up.w);
    return vec4<f32>(across, view.middle.z - place.z * view.towards.w, 1.0);
}

/// Lambert's law for a light from above on the left, and what comes from all around and from the viewer. `normal` has
/// unit length, in the viewer's directions.
fn lit(normal: vec3<f32>) -> f32 {
    let light = vec3<f32>(-0.36, 0.48, 0.80);
    return 0.42 + 0.42 * max(dot(normal, light), 0.0) + 0.22 * max(normal.z, 0.0);
}

/// What is far fades into the background.
fn faded(colour: vec3<f32>, depth: f32) -> vec3<f32> {
    return mix(colour, view.background.rgb, view.background.a * clamp(depth, 0.0, 1.0));
}
