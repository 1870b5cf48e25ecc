//! The camera of a shot: which one is looked through, and its lens in the terms of a scene.

use glam::{DVec2, DVec3};
use impasto_gltf::{Animator, Lens as ShotLens, Posed};

use super::Shot;
use crate::document::{Lens, Seen};
use crate::gltf::GltfFile;

/// The far depth of a camera that states none, as a multiple of its near depth.
const FARTHEST: f64 = 1e5;

/// The lens for a picture of this size in pixels. The picture shows at least all that the camera's own picture shows.
pub(super) fn lens_in(lens: ShotLens, (width, height): (u32, u32)) -> Lens {
    let aspect = f64::from(width.max(1)) / f64::from(height.max(1));
    match lens {
        ShotLens::Perspective { yfov_rad, aspect: own, znear, zfar } => {
            let half = (0.5 * yfov_rad).tan();
            let half = half.max(own.map_or(0.0, |own| half * own / aspect));
            let fov_y_deg = (2.0 * half.atan()).to_degrees().clamp(1.0, 170.0);
            Lens::Perspective { fov_y_deg, near: znear, far: zfar.unwrap_or(znear * FARTHEST) }
        }
        ShotLens::Orthographic { xmag, ymag, znear, zfar } => {
            Lens::Orthographic { height: 2.0 * ymag.max(xmag / aspect), near: znear, far: zfar }
        }
    }
}

struct HalfSize {
    /// `None` if the file leaves the aspect to the picture.
    x: Option<f64>,
    y: f64,
}

/// Half the width and half the height of what a lens shows: at depth 1 in perspective, at any depth in parallel
/// projection.
fn half_size(lens: ShotLens) -> HalfSize {
    match lens {
        ShotLens::Perspective { yfov_rad, aspect, .. } => {
            let half = (0.5 * yfov_rad).tan();
            HalfSize { x: aspect.map(|aspect| aspect * half), y: half }
        }
        ShotLens::Orthographic { xmag, ymag, .. } => HalfSize { x: Some(xmag), y: ymag },
    }
}

/// How many visible objects have their origin inside a camera's picture.
fn seen(file: &GltfFile, posed: &Posed, node: usize) -> usize {
    let Some(camera) = file.gltf.nodes[node].camera else { return 0 };
    let view_from_world = posed.world_from_view(node).inverse();
    let is_inside = |at: DVec3| match posed.lenses[camera] {
        ShotLens::Perspective { yfov_rad, aspect, znear, .. } => {
            let half = (0.5 * yfov_rad).tan() * -at.z;
            -at.z > znear && at.y.abs() < half && at.x.abs() < half * aspect.unwrap_or(1.0)
        }
        ShotLens::Orthographic { xmag, ymag, .. } => at.z < 0.0 && at.x.abs() < xmag && at.y.abs() < ymag,
    };
    let nodes = file.gltf.nodes.iter().enumerate();
    let shows = nodes.filter(|(index, node)| node.mesh.is_some() && posed.is_visible[*index]);
    shows
        .filter(|(index, _)| {
            is_inside(view_from_world.transform_point3(posed.world_from_node[*index].translation))
        })
        .count()
}

/// The node of the camera with this name, else of the camera of the first cut, else of the first camera that sees the
/// most objects when the shot begins. `None` without cameras. Adds to `odd` where the choice is not clear.
pub(super) fn chosen(
    file: &GltfFile,
    animator: &Animator,
    name: Option<&str>,
    odd: &mut Vec<[String; 2]>,
) -> Option<usize> {
    let nodes = &file.gltf.nodes;
    let all: Vec<usize> =
        (0..nodes.len()).filter(|&node| nodes[node].camera.is_some() && file.is_in_scene(node)).collect();
    let named = name.map(|name| all.iter().copied().find(|&node| nodes[node].name == name));
    let posed = animator.pose(animator.span_s().map_or(0.0, |[first, _]| f64::from(first)));
    // Of equals, `min_by_key` keeps the first.
    let most = all.iter().copied().min_by_key(|&node| std::cmp::Reverse(seen(file, &posed, node)))?;
    let of_cut = file
        .sidecar
        .cuts
        .first()
        .and_then(|cut| all.iter().copied().find(|&node| nodes[node].name == cut.camera));
    let first = of_cut.unwrap_or(most);
    let names: Vec<&str> = all.iter().map(|&node| nodes[node].name.as_str()).collect();
    let is_first = format!("{:?} is looked through", nodes[first].name);
    let mend = || format!("choose one in the scene, as in camera: (of_shot: {:?})", names[names.len() - 1]);
    match (named, name) {
        (Some(Some(node)), _) => return Some(node),
        (Some(None), Some(name)) => {
            odd.push([format!("there is no camera {name:?}; there are {names:?}, and {is_first}"), mend()]);
        }
        _ if all.len() > 1 && of_cut.is_none() => {
            odd.push([format!("there are {} cameras, {names:?}; {is_first}", all.len()), mend()])
        }
        _ => {}
    }
    Some(first)
}

impl Shot {
    /// See [`crate::document::Brought::camera`].
    pub(super) fn seen(&self, time_s: f64, size: (u32, u32)) -> Option<Seen> {
        let posed = self.animator.pose(time_s);
        let frame = time_s * self.rate();
        let sidecar = &self.file.sidecar;
        let named = |name: &str| self.file.node(name).filter(|&node| self.file.is_in_scene(node));
        let of_cut = sidecar.camera_at(frame).filter(|_| !self.is_chosen).and_then(named);
        let node = of_cut.filter(|&node| self.file.gltf.nodes[node].camera.is_some()).or(self.camera)?;
        let node_data = &self.file.gltf.nodes[node];
        let own = posed.lenses[node_data.camera?];
        let lens = lens_in(own, size);
        // The sidecar's shift is in half widths and half heights of the camera's own picture. The scene's shift is in
        // half heights of the picture that is painted, which shows more if its aspect differs.
        let own_half = half_size(own);
        let half_height = match lens {
            Lens::Perspective { fov_y_deg, .. } => (0.5 * fov_y_deg.to_radians()).tan(),
            Lens::Orthographic { height, .. } => 0.5 * height,
        };
        let aspect = f64::from(size.0.max(1)) / f64::from(size.1.max(1));
        let own_half = DVec2::new(own_half.x.unwrap_or(half_height * aspect), own_half.y);
        let shift = sidecar.shift_at(&node_data.name, frame) * own_half / half_height;
        Some(Seen { world_from_view: posed.world_from_view(node), lens, shift })
    }

    /// Width over height of the camera's own picture, where it is stated.
    pub fn camera_aspect(&self) -> Option<f64> {
        let camera = self.file.gltf.nodes[self.camera?].camera?;
        match self.file.gltf.cameras[camera].lens {
            ShotLens::Perspective { aspect, .. } => aspect,
            ShotLens::Orthographic { xmag, ymag, .. } => Some(xmag / ymag),
        }
    }
}
