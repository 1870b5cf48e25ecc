//! Makes altered versions of a scene: some to compare with, others without what would disturb a measurement.

use glam::DVec3;
use impasto_scene::document::{
    Canvas, Color, Direction, Edges, LayerSettings, MaterialOverride, NoiseDisplace, RotatingStrokes, Scene,
    Solver, StrokeSettings, Style,
};
use impasto_scene::loaded::LoadedScene;
use impasto_scene::motion;
use impasto_scene::presets::{LayerKind, PAPER_PRESET};

use crate::cameras;

/// A version of a scene. In all but `Unchanged`, boil is off: it lays strokes a little elsewhere every few frames, on
/// purpose, and that must not count as an error. In all but `Unchanged`, the picture is on a *board*, a smooth canvas:
/// the texture of other canvases stands still on the picture by design, which would disturb measurements.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum SceneVersion {
    /// The scene as it is.
    Unchanged,
    /// On a board.
    Board,
    /// On a board, without relief and varnish.
    Bare,
    /// With the source paper's strokes in place of the scene's, directions kept; on a board.
    Paper,
    /// On a board, without objects that would hide the target from a camera that goes round it.
    Orbit,
    /// `Orbit` with the source paper's strokes.
    OrbitPaper,
    /// The body layer alone, without strokes along the contour: those follow the view by design.
    NoContour(TurnSolver),
    /// The body layer alone, with everything that the scene states for it.
    Body,
    /// As `Body`, but with strokes of one size: no random variation, and no keys that change settings over time.
    EqualSizes,
    /// As `NoContour`, but without random turns and without second directions; objects as in `Orbit`.
    NoChance(TurnSolver),
    /// `NoChance` with the source paper's strokes.
    NoChancePaper,
    /// On a board and unlit, because light that stands still on the picture is not brushwork.
    Unlit,
    /// Each object in one flat colour, and nothing that mixes colours.
    Flat,
    /// The body layer alone, without random turns of strokes.
    NoAngleChance,
    /// As `NoAngleChance`, with twice the particles.
    NoAngleChanceTwice,
}

/// How the turns of strokes are found.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum TurnSolver {
    /// By the solver that the scene states.
    Own,
    /// Horn's estimate, baked.
    Horn,
    /// Horn's estimate over all neighbours, in every frame.
    HornExact,
}

impl SceneVersion {
    /// This version of a scene. `particles` says how many particles each object's body layer has; only
    /// `NoAngleChanceTwice` needs it.
    pub fn of(self, loaded: &LoadedScene, particles: &[usize]) -> LoadedScene {
        let mut version = loaded.clone();
        let scene = &mut version.scene;
        if self != Self::Unchanged {
            each_settings(scene, |strokes| strokes.boil = Some(0.0));
        }
        match self {
            Self::Unchanged => {}
            Self::Board => on_board(scene),
            Self::Bare => {
                on_board(scene);
                edit_style(scene, |style| (style.relief, style.varnish) = (0.0, 0.0));
            }
            Self::Paper => paper(scene),
            Self::Orbit => {
                on_board(scene);
                leave_out(&mut version, &orbit_blockers(loaded));
            }
            Self::OrbitPaper => {
                paper(scene);
                leave_out(&mut version, &orbit_blockers(loaded));
            }
            Self::NoContour(solver) => {
                body_alone(scene);
                each_settings(scene, |strokes| strokes.contour = Some(0.0));
                turn_by(scene, solver);
            }
            Self::Body => body_alone(scene),
            Self::EqualSizes => {
                body_alone(scene);
                each_settings(scene, |strokes| strokes.size_jitter = Some(0.0));
                each_settings(scene, |strokes| strokes.keys.clear());
            }
            Self::NoChance(solver) => {
                body_alone(scene);
                without_chance(scene);
                turn_by(scene, solver);
                leave_out(&mut version, &orbit_blockers(loaded));
            }
            Self::NoChancePaper => {
                paper(scene);
                without_chance(scene);
                leave_out(&mut version, &orbit_blockers(loaded));
            }
            Self::Unlit => {
                on_board(scene);
                for object in &mut scene.objects {
                    object.material.get_or_insert_default().unlit = true;
                }
            }
            Self::Flat => flat(scene),
            Self::NoAngleChance => body_without_jitter(scene),
            Self::NoAngleChanceTwice => {
                body_without_jitter(scene);
                for (object, &count) in scene.objects.iter_mut().zip(particles) {
                    object.particles = Some(2 * count as u64);
                }
            }
        }
        version
    }
}

/// Edits the settings of the scene and of every region.
fn each_settings(scene: &mut Scene, edit: impl Fn(&mut StrokeSettings)) {
    edit(&mut scene.strokes);
    scene.regions.iter_mut().for_each(|region| edit(&mut region.strokes));
}

fn edit_style(scene: &mut Scene, edit: impl FnOnce(&mut RotatingStrokes)) {
    let mut style = match &scene.style {
        Style::RotatingStrokes(style) => style.clone(),
        _ => RotatingStrokes::default(),
    };
    edit(&mut style);
    scene.style = Style::RotatingStrokes(style);
}

fn on_board(scene: &mut Scene) {
    edit_style(scene, |style| (style.canvas, style.weave) = (Canvas::Board, 0.0));
}

fn turn_by(scene: &mut Scene, solver: TurnSolver) {
    let solver = match solver {
        TurnSolver::Own => return,
        TurnSolver::Horn => Solver::Horn,
        TurnSolver::HornExact => Solver::HornExact,
    };
    edit_style(scene, |style| style.solver = solver);
}

fn paper(scene: &mut Scene) {
    on_board(scene);
    each_settings(scene, |strokes| *strokes = StrokeSettings::default());
    scene.strokes.preset = Some(PAPER_PRESET.to_owned());
}

fn layer(kind: LayerKind) -> LayerSettings {
    LayerSettings { name: kind.name().to_owned(), ..LayerSettings::default() }
}

/// Leaves only the body layer (and touches, the strokes placed by hand), on a board.
pub(crate) fn body_alone(scene: &mut Scene) {
    on_board(scene);
    edit_style(scene, |style| style.underpainting = false);
    each_settings(scene, |strokes| {
        let others = LayerKind::ALL.into_iter().filter(|&kind| kind != LayerKind::Body);
        strokes.layers.extend(others.map(|kind| LayerSettings { coverage: Some(0.0), ..layer(kind) }));
    });
}

fn body_without_jitter(scene: &mut Scene) {
    body_alone(scene);
    each_settings(scene, |strokes| (strokes.angle_jitter_deg, strokes.swing_deg) = (Some(0.0), Some(0.0)));
}

fn without_chance(scene: &mut Scene) {
    each_settings(scene, |strokes| {
        (strokes.angle_jitter_deg, strokes.swing_deg) = (Some(0.0), Some(0.0));
        strokes.contour = Some(0.0);
    });
    for region in &mut scene.regions {
        if let Direction::Crossing(first_deg, _) = region.direction {
            region.direction = Direction::Angle(first_deg);
        }
    }
}

/// A colour for each object, far from those of the others.
pub fn flat_color(object: usize) -> Color {
    let level = |digit: usize| [0.15, 0.85, 0.5][digit % 3];
    // Number 0 would be almost black; 1 is red, and so on.
    let number = object + 1;
    Color([level(number), level(number / 3), level(number / 9)])
}

fn flat(scene: &mut Scene) {
    on_board(scene);
    edit_style(scene, |style| {
        (style.relief, style.varnish, style.underpainting) = (0.0, 0.0, true);
    });
    each_settings(scene, |strokes| {
        strokes.grading = Some(0.0);
        strokes.color_jitter = Some(0.0);
        strokes.temperature = Some(0.0);
        strokes.edges = Some(Edges::Clip);
        strokes.palette = Some(Vec::new());
        strokes.layers.extend(LayerKind::ALL.map(|kind| LayerSettings { pickup: Some(0.0), ..layer(kind) }));
    });
    for (index, object) in scene.objects.iter_mut().enumerate() {
        // Noise that moves the surface stays; noise that colours it goes.
        let noise = object.material.take().and_then(|material| material.noise_displace);
        object.material = Some(MaterialOverride {
            noise_displace: noise.map(|noise| NoiseDisplace { surface: None, ..noise }),
            color: Some(flat_color(index)),
            texture: None,
            unlit: true,
            gloss: Some(0.0),
        });
    }
}

/// Objects that would hide the target from a camera that goes round it, as walls and other backdrops do. An object
/// counts only if it is large compared with the camera's distance and has no children.
pub fn orbit_blockers(loaded: &LoadedScene) -> Vec<usize> {
    let scene = &loaded.scene;
    let (camera, frame) = motion::referred_to(scene, &scene.reference);
    let poses = motion::poses_at(scene, frame);
    let is_parent = |name: &str| scene.objects.iter().any(|object| object.parent.as_deref() == Some(name));
    let corners_of = |index: usize| {
        let object = &scene.objects[index];
        let file = loaded.meshes.get(&object.mesh);
        let to_world = poses[index].matrix3 * object.model_from_file();
        let from = poses[index].translation;
        (0..file.map_or(0, |file| file.mesh.triangles.len())).filter_map(move |triangle| {
            Some(file?.mesh.corners(triangle).map(|corner| to_world * corner.as_dvec3() + from))
        })
    };
    // The object in the middle of the reference camera's picture is what the camera goes round.
    let first_hit = |index: &usize| {
        let hits = corners_of(*index).filter_map(|corners| segment_hit(camera.eye, camera.target, corners));
        hits.fold(f64::INFINITY, f64::min)
    };
    let subject = (0..scene.objects.len())
        .map(|index| (first_hit(&index), index))
        .filter(|(at, _)| at.is_finite())
        .min_by(|a, b| a.0.total_cmp(&b.0))
        .map(|(_, index)| index);
    let blocks = |index: usize| {
        let object = &scene.objects[index];
        let Some(file) = loaded.meshes.get(&object.mesh).filter(|_| subject != Some(index)) else {
            return false;
        };
        let model_from_file = object.model_from_file();
        let to_world = |at: glam::Vec3| poses[index].transform_point3(model_from_file * at.as_dvec3());
        let Some((low, high)) = file.mesh.bounds() else { return false };
        let half_diagonal = 0.5 * (to_world(high) - to_world(low)).length();
        if is_parent(&object.name) || half_diagonal < 0.5 * (camera.eye - camera.target).length() {
            return false;
        }
        (1..24).any(|step| {
            let eye = cameras::orbited(&camera, 15.0 * f64::from(step)).eye;
            // A surface that the target itself lies on does not block it.
            let to = eye + (camera.target - eye) * 0.95;
            corners_of(index).any(|corners| segment_hit(eye, to, corners).is_some())
        })
    };
    (0..scene.objects.len()).filter(|&index| blocks(index)).collect()
}

/// Where a segment meets a triangle, 0 at its beginning and 1 at its end (Möller and Trumbore 1997).
fn segment_hit(from: DVec3, to: DVec3, [a, b, c]: [DVec3; 3]) -> Option<f64> {
    let (along, ab, ac) = (to - from, b - a, c - a);
    let p = along.cross(ac);
    let determinant = ab.dot(p);
    if determinant.abs() < 1e-15 {
        return None;
    }
    let offset = from - a;
    let u = offset.dot(p) / determinant;
    let q = offset.cross(ab);
    let v = along.dot(q) / determinant;
    let t = ac.dot(q) / determinant;
    (u >= 0.0 && v >= 0.0 && u + v <= 1.0 && (0.0..=1.0).contains(&t)).then_some(t)
}

/// Leaves out these objects, unless they are all that there is.
pub(crate) fn leave_out(loaded: &mut LoadedScene, blockers: &[usize]) {
    if blockers.len() == loaded.scene.objects.len() {
        return;
    }
    let mut index = 0;
    loaded.scene.objects.retain(|_| {
        index += 1;
        !blockers.contains(&(index - 1))
    });
}
