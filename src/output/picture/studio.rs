//! Draws a picture on a device: balls and meshes, which hide each other by their depths, then panes over them from the
//! farthest to the nearest, and the edges of the panes, which are faint where something is before them.
//!
//! The device draws twice as large as the picture is, without multisampling, in a fixed order; the host makes the outlines
//! and the pixels of it ([`ink`](super::ink)) and writes what explains it ([`annotation`](super::annotation)). So a picture
//! has the same bytes on one adapter each time.

use bytemuck::{Pod, Zeroable};
use glam::DVec3;

use super::annotation::annotate;
use super::camera::Camera;
use super::colours::{Colour, INK, MESH, WHITE, word};
use super::image::Image;
use super::ink::{TEXELS, halved, outline};
use super::model::{Pane, Picture};
use super::surface::Surface;
use crate::gpu::{Batch, Device, GpuError, Layer, Painter, RenderSource, draw};

include!(concat!(env!("OUT_DIR"), "/render_shaders.rs"));

/// Balls cover each place of a picture so often, on average: those behind are seen between those before.
const COVER: f64 = 1.2;
/// Pixels.
const RADIUS: std::ops::RangeInclusive<f64> = 1.2..=9.0;
/// Of the edges of panes where something is before them, of 255.
const HIDDEN_OPACITY: u8 = 130;
/// How much of the background the farthest has, among particles and without any.
const FADING: [f32; 2] = [0.45, 0.12];
/// Texels of the width of lines.
const EDGE: f32 = 2.0;
const CREASE: f32 = 1.5;
/// Pixels by which a line comes before what it lies on, and by which a step of depth is an outline.
const LIFT: f64 = 1.5;
const STEP: f64 = 3.0;

/// Twins of the structs in `shaders/render/`.
#[derive(Debug, Clone, Copy, Pod, Zeroable)]
#[repr(C)]
struct GpuView {
    right: [f32; 4],
    up: [f32; 4],
    towards: [f32; 4],
    middle: [f32; 4],
    background: [f32; 4],
    size: [f32; 2],
    lift: f32,
    unused: f32,
}

#[derive(Debug, Clone, Copy, Pod, Zeroable)]
#[repr(C)]
struct GpuBall {
    place: [f32; 3],
    colour: u32,
}

#[derive(Debug, Clone, Copy, Pod, Zeroable)]
#[repr(C)]
struct GpuCorner {
    place: [f32; 3],
    front: u32,
    normal: [f32; 3],
    back: u32,
}

#[derive(Debug, Clone, Copy, Pod, Zeroable)]
#[repr(C)]
struct GpuLine {
    from: [f32; 3],
    colour: u32,
    to: [f32; 3],
    /// Texels.
    width: f32,
}

/// Draws pictures on one device.
pub struct Studio<'a> {
    device: &'a Device,
    balls: Painter,
    meshes: Painter,
    panes: Painter,
    lines: Painter,
}

/// Something for a painter: vertices, instances and what it reads.
struct Load<'a> {
    painter: &'a Painter,
    items: wgpu::Buffer,
    vertices: usize,
    instances: usize,
}

impl<'a> Studio<'a> {
    /// # Errors
    /// If the device refuses a shader.
    pub fn new(device: &'a Device) -> Result<Studio<'a>, GpuError> {
        let painter = |name: &str, layer| {
            let source = RENDER_SHADERS.iter().find(|shader| shader.name == name);
            let missing = || GpuError::Shader { shader: name.into(), reason: "no such shader".into() };
            Painter::new(device, source.ok_or_else(missing)?, layer)
        };
        Ok(Studio {
            device,
            balls: painter("ball", Layer::Opaque)?,
            meshes: painter("surface", Layer::Opaque)?,
            panes: painter("surface", Layer::Translucent)?,
            lines: painter("line", Layer::Translucent)?,
        })
    }

    /// # Errors
    /// If the picture is too large for the device, or it fails.
    pub fn paint(&self, camera: &Camera, picture: &Picture) -> Result<Image, GpuError> {
        let [view, lifted] = self.views(camera, picture)?;
        let mut edges = Vec::new();
        let mut hidden_edges = Vec::new();
        for Pane { surface, colour, .. } in &picture.panes {
            let own = surface.drawn_edges(camera);
            add_lines(&mut edges, camera, &own, (word(*colour, u8::MAX), EDGE));
            add_lines(&mut hidden_edges, camera, &own, (word(INK, HIDDEN_OPACITY), EDGE));
        }
        let mut creases = Vec::new();
        for mesh in &picture.meshes {
            add_lines(&mut creases, camera, &mesh.sharp_edges(), (word(INK, u8::MAX), CREASE));
        }
        let loads = [
            (&view, self.opaque_meshes(camera, picture)?),
            (&view, self.all_lines(&creases)?),
            (&view, self.all_balls(camera, picture)?),
            (&view, self.all_panes(camera, picture)?),
            (&view, self.all_lines(&edges)?),
            (&lifted, self.all_lines(&hidden_edges)?),
        ];
        let some = loads.iter().filter(|(_, load)| load.vertices * load.instances > 0);
        let batches: Vec<Batch<'_>> = some
            .map(|(view, Load { painter, items, vertices, instances })| {
                let [vertices, instances] = [*vertices, *instances].map(|count| count as u32);
                Batch { painter, view, items, vertices, instances }
            })
            .collect();
        let size = camera.size.map(|edge| edge.saturating_mul(TEXELS));
        let mut drawn = draw(self.device, size, WHITE.map(|channel| f64::from(channel) / 255.0), &batches)?;
        outline(&mut drawn, (STEP * depth_of_pixel(camera)) as f32);
        let mut image = halved(&drawn);
        annotate(&mut image, camera, picture);
        Ok(image)
    }

    /// The view, and the same with lines before all else.
    fn views(&self, camera: &Camera, picture: &Picture) -> Result<[wgpu::Buffer; 2], GpuError> {
        let view = gpu_view(camera, picture);
        let make = |view: GpuView| {
            let buffer = self.device.uniform("view", size_of::<GpuView>() as u64)?;
            self.device.write(&buffer, 0, &[view]);
            Ok(buffer)
        };
        Ok([make(view)?, make(GpuView { lift: 1.0, ..view })?])
    }

    fn all_balls(&self, camera: &Camera, picture: &Picture) -> Result<Load<'_>, GpuError> {
        let ball = |(place, colour): &(DVec3, Colour)| GpuBall {
            place: from_centre(camera, *place),
            colour: word(*colour, u8::MAX),
        };
        let balls: Vec<GpuBall> = picture.balls.iter().map(ball).collect();
        let items = self.device.storage_of("balls", &balls)?;
        Ok(Load { painter: &self.balls, items, vertices: 6, instances: balls.len() })
    }

    fn opaque_meshes(&self, camera: &Camera, picture: &Picture) -> Result<Load<'_>, GpuError> {
        let mut corners = Vec::new();
        for mesh in &picture.meshes {
            let back = if mesh.has_two_sides() { MESH[1] } else { MESH[0] };
            let colours = [MESH[0], back].map(|colour| word(colour, u8::MAX));
            add_triangles(&mut corners, camera, mesh, colours);
        }
        self.triangles(&self.meshes, "meshes", &corners)
    }

    /// The triangles of all panes in one order: of panes within each other the farther is laid down first.
    fn all_panes(&self, camera: &Camera, picture: &Picture) -> Result<Load<'_>, GpuError> {
        let mut all = Vec::new();
        for Pane { surface, colour, opacity } in &picture.panes {
            add_triangles(&mut all, camera, surface, [word(*colour, *opacity); 2]);
        }
        let order = joined(&picture.panes).from_behind(camera);
        let corners: Vec<GpuCorner> = order.into_iter().flat_map(|k| all[3 * k..3 * k + 3].iter().copied()).collect();
        self.triangles(&self.panes, "panes", &corners)
    }

    fn triangles<'b>(
        &self,
        painter: &'b Painter,
        name: &'static str,
        corners: &[GpuCorner],
    ) -> Result<Load<'b>, GpuError> {
        let items = self.device.storage_of(name, corners)?;
        Ok(Load { painter, items, vertices: corners.len(), instances: 1 })
    }

    fn all_lines(&self, lines: &[GpuLine]) -> Result<Load<'_>, GpuError> {
        let items = self.device.storage_of("lines", lines)?;
        Ok(Load { painter: &self.lines, items, vertices: 6, instances: lines.len() })
    }
}

fn add_lines(lines: &mut Vec<GpuLine>, camera: &Camera, edges: &[[DVec3; 2]], (colour, width): (u32, f32)) {
    lines.extend(edges.iter().map(|ends| {
        let [from, to] = ends.map(|end| from_centre(camera, end));
        GpuLine { from, colour, to, width }
    }));
}

fn joined(panes: &[Pane]) -> Surface {
    let mut all = Surface::default();
    for Pane { surface, .. } in panes {
        let first = all.vertices.len() as u32;
        all.vertices.extend(&surface.vertices);
        all.triangles.extend(surface.triangles.iter().map(|triangle| triangle.map(|vertex| first + vertex)));
    }
    all
}

fn add_triangles(corners: &mut Vec<GpuCorner>, camera: &Camera, surface: &Surface, [front, back]: [u32; 2]) {
    for (triangle, normals) in surface.corner_normals().into_iter().enumerate() {
        let places = surface.corners(triangle);
        corners.extend(places.into_iter().zip(normals).map(|(place, normal)| GpuCorner {
            place: from_centre(camera, place),
            front,
            normal: normal.as_vec3().to_array(),
            back,
        }));
    }
}

fn from_centre(camera: &Camera, place: DVec3) -> [f32; 3] {
    (place - camera.centre).as_vec3().to_array()
}

/// The depth that is as long as a pixel.
fn depth_of_pixel(camera: &Camera) -> f64 {
    0.5 / (camera.reach * camera.scale)
}

fn gpu_view(camera: &Camera, picture: &Picture) -> GpuView {
    let [width, height] = camera.size.map(f64::from);
    let axis = |k: usize, behind: f64| camera.axes[k].extend(behind).as_vec4().to_array();
    let middle = [2.0 * camera.middle[0] / width - 1.0, 1.0 - 2.0 * camera.middle[1] / height, 0.5];
    let [x, y, depth] = middle.map(|value| value as f32);
    let fading = FADING[usize::from(picture.balls.is_empty())];
    let [red, green, blue] = WHITE.map(|channel| f32::from(channel) / 255.0);
    GpuView {
        right: axis(0, 2.0 * camera.scale / width),
        up: axis(1, 2.0 * camera.scale / height),
        towards: axis(2, 0.5 / camera.reach),
        middle: [x, y, depth, (radius(camera, picture) / camera.scale) as f32],
        background: [red, green, blue, fading],
        size: camera.size.map(|edge| (edge * TEXELS) as f32),
        lift: (LIFT * depth_of_pixel(camera)) as f32,
        unused: 0.0,
    }
}

/// Pixels of the radius of a ball.
fn radius(camera: &Camera, picture: &Picture) -> f64 {
    let far = [f64::INFINITY; 2];
    let (low, high) = picture.points().map(|point| camera.pixel(point)).fold(
        (far, far.map(|value| -value)),
        |(low, high): ([f64; 2], [f64; 2]), pixel| {
            ([0, 1].map(|k| low[k].min(pixel[k])), [0, 1].map(|k| high[k].max(pixel[k])))
        },
    );
    let area = (high[0] - low[0]).max(1.0) * (high[1] - low[1]).max(1.0);
    let count = picture.most_balls.max(picture.balls.len()).max(1) as f64;
    (COVER * area / (std::f64::consts::PI * count)).sqrt().clamp(*RADIUS.start(), *RADIUS.end())
}

#[cfg(test)]
mod tests {
    use wgpu::naga::front::wgsl;

    use super::*;

    /// The twins have the sizes of the shaders' structs.
    #[test]
    fn structs_are_as_the_shaders_have_them() {
        let size_in = |shader: &str, name: &str| {
            let source = RENDER_SHADERS.iter().find(|known| known.name == shader).unwrap().source;
            let module = wgsl::parse_str(source).unwrap();
            let (_, found) = module.types.iter().find(|(_, found)| found.name.as_deref() == Some(name)).unwrap();
            found.inner.size(module.to_ctx()) as usize
        };
        assert_eq!(size_in("ball", "View"), size_of::<GpuView>());
        assert_eq!(size_in("ball", "Ball"), size_of::<GpuBall>());
        assert_eq!(size_in("surface", "Corner"), size_of::<GpuCorner>());
        assert_eq!(size_in("line", "Line"), size_of::<GpuLine>());
    }
}
