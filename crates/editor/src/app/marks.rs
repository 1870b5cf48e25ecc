//! The marks over the picture: rings, guides, direction lines, outlines. Costly ones are cached.

use egui::{Color32, Ui};
use glam::{DAffine3, DVec2, DVec3, Vec3};
use impasto_core::sampling::Particle;
use impasto_editor_model::Item;
use impasto_editor_model::editor::{Editor, LightPlace};
use impasto_editor_model::gizmo::Gizmo;
use impasto_editor_model::picking::View;
use impasto_editor_model::session::{DirectionLines, Mode, Overlays, Tool};
use impasto_editor_model::tools::{Needle, Ring};
use impasto_painting::Painting;
use impasto_scene::document::{Amount, Guide, LightKind, Scene};
use impasto_scene::motion::CameraPose;
use impasto_scene::new_scene::REGION_COLORS;

use super::comb_preview::CombPreviewStrokes;
use super::motion_marks;
use super::picture::PictureFlow;
use super::picture_view::PictureView;
use crate::viewport::overlay::{
    AmountTint, CurvePart, DirectionMark, GuideCurve, MissingMesh, MotionPath, Outline, RegionTint, Sight,
    SingularPoint, StandIn,
};
use crate::viewport::surface_map::{Face, FacePlace, StandingBody, SurfaceMap};
use crate::viewport::{Framing, HairLook, Marks, direction_marks};

/// The map of visible surfaces has this many cells per point of the window while the view is at rest.
const CELLS_PER_POINT: f64 = 0.5;
/// The same, while the view moves.
const MOVING_CELLS_PER_POINT: f64 = 0.2;

/// The cached marks of the pictures that are shown: two in a comparison, otherwise one.
#[derive(Default)]
pub(super) struct MarkCache {
    halves: [Half; 2],
    pub(super) comb_preview: CombPreviewStrokes,
}

/// The cached marks of one picture.
#[derive(Default)]
struct Half {
    of: Option<Key>,
    map: Option<(MapKey, SurfaceMap)>,
    direction_lines: Vec<DirectionMark>,
    tints: Vec<RegionTint>,
    amounts: Option<AmountTint>,
    outline: Option<Outline>,
    ghosts: Vec<Outline>,
    path: Option<MotionPath>,
}

/// The inputs of the cached marks.
#[derive(Clone, PartialEq)]
struct Key {
    prepared: u64,
    camera: CameraPose,
    frame: f64,
    framing: Framing,
    overlays: Overlays,
    shows_regions: bool,
    /// The amount that is shown: the one that the tool paints.
    amount: Option<Amount>,
    mode: Mode,
    selected: Option<Item>,
    moving: bool,
}

/// The inputs of the map of visible surfaces. An edit of directions changes none of them, so the map stays valid.
#[derive(PartialEq)]
struct MapKey {
    bodies: Vec<StandingBody>,
    camera: CameraPose,
    framing: Framing,
    cells_per_point: f64,
}

/// Marks that are made in every pass.
pub(super) struct Fresh {
    rings: Vec<Ring>,
    needle: Option<Needle>,
    tag: Option<String>,
    guides: Vec<GuideCurve>,
    gizmo: Option<Gizmo>,
    stand_ins: Vec<(StandIn, bool)>,
    missing: Vec<MissingMesh>,
    singular: Vec<SingularPoint>,
    radius_px: f64,
    hides_pointer: bool,
}

impl MarkCache {
    /// Updates the marks whose inputs have changed.
    pub(super) fn refresh(&mut self, editor: &Editor, picture_flow: &PictureFlow, picture: &PictureView<'_>) {
        let Some(painting) = editor.painting() else {
            // The marks of the previous scene must not lie over a scene that was just opened.
            self.halves = Default::default();
            return;
        };
        let Some(&framing) = picture_flow.layout().framings().get(picture.index) else { return };
        let session = &editor.session;
        if editor.time().playback.is_playing() {
            // During playback no time is spent on marks.
            self.halves[picture.index] = Half::default();
            return;
        }
        let key = Key {
            prepared: picture_flow.prepared(),
            camera: picture.camera.clone(),
            frame: picture.frame,
            framing,
            overlays: session.overlays,
            // The tool that makes regions shows them.
            shows_regions: session.overlays.regions || session.tool() == Tool::Region,
            amount: (session.tool() == Tool::Amount).then_some(session.options.amount),
            mode: session.mode,
            selected: editor.document().selection().active().cloned(),
            moving: editor.is_navigating(),
        };
        let (shows_regions, amount) = (key.shows_regions, key.amount);
        let half = &mut self.halves[picture.index];
        if half.of.as_ref() == Some(&key) {
            return;
        }
        let shows_lines = session.mode == Mode::Paint
            && session.overlays.direction_lines != DirectionLines::Off
            || session.overlays.trust;
        let active = editor.active_object();
        let outlines = session.mode != Mode::Paint && active.is_some();
        let old_map = half.map.take();
        *half = Half { of: Some(key), ..Half::default() };
        if !(shows_lines || shows_regions || outlines || amount.is_some()) {
            return;
        }
        let view = framing.view(picture.camera);
        let key = MapKey {
            bodies: StandingBody::all(painting, picture.frame),
            camera: picture.camera.clone(),
            framing,
            cells_per_point: if editor.is_navigating() { MOVING_CELLS_PER_POINT } else { CELLS_PER_POINT },
        };
        let (key, map) = old_map.filter(|(before, _)| *before == key).unwrap_or_else(|| {
            let map = SurfaceMap::new(&key.bodies, &view, key.cells_per_point);
            (key, map)
        });
        let scene = painting.scene();
        let colours = region_colours(scene);
        if shows_lines {
            let region = selected_region(editor, scene).filter(|_| session.mode == Mode::Paint);
            let object = active.filter(|_| session.mode != Mode::Paint);
            let look = HairLook { overlays: session.overlays, region_colours: &colours, region, object };
            half.direction_lines =
                direction_marks(painting, picture.camera, picture.frame, &framing, &map, &look);
        }
        if shows_regions {
            let names: Vec<(&str, Color32)> = scene
                .regions
                .iter()
                .zip(&colours)
                .map(|(region, &colour)| (region.name.as_str(), colour))
                .collect();
            half.tints = RegionTint::all(&map, &names, |face| region_of(painting, face));
        }
        half.amounts =
            amount.map(|of| AmountTint::of(&map, |face, place| factor_at(painting, face, place, of)));
        if outlines && let Some(active) = active {
            half.outline = Some(Outline::new(&map, |object| object == active));
            if session.mode == Mode::Animate && !editor.is_navigating() {
                half.path = motion_marks::path(scene, active);
                half.ghosts = motion_marks::ghosts(painting, picture, &framing, active);
            }
        }
        half.map = Some((key, map));
    }

    /// The marks of a picture: the cached ones and, with `fresh`, also those that are made in every pass. The caller
    /// adds singular points, from [`MarkCache::singular`].
    pub(super) fn marks<'a>(&'a self, index: usize, editor: &Editor, fresh: Option<&'a Fresh>) -> Marks<'a> {
        let half = &self.halves[index];
        let marks = Marks {
            grid: editor.session.overlays.grid,
            regions: &half.tints,
            amounts: half.amounts.as_ref(),
            selected: half.outline.as_ref(),
            ghosts: &half.ghosts,
            path: half.path.as_ref(),
            direction_lines: &half.direction_lines,
            ..Marks::default()
        };
        let Some(fresh) = fresh else { return marks };
        Marks {
            rings: &fresh.rings,
            needle: fresh.needle,
            radius_px: fresh.radius_px,
            tag: fresh.tag.as_deref(),
            guides: &fresh.guides,
            stand_ins: &fresh.stand_ins,
            missing: &fresh.missing,
            comb_preview: self.comb_preview.shown(),
            gizmo: fresh.gizmo.as_ref().map(|gizmo| (gizmo, None)),
            hides_pointer: fresh.hides_pointer,
            ..marks
        }
    }

    /// Singular points of the bodies, for [`Marks::singular`].
    pub(super) fn singular<'a>(
        fresh: &'a Fresh,
        sight: Sight<'a>,
    ) -> Option<(&'a [SingularPoint], Sight<'a>)> {
        (!fresh.singular.is_empty()).then_some((&fresh.singular[..], sight))
    }
}

/// The marks of the tool and of the selection in this pass.
pub(super) fn fresh(editor: &Editor, view: &View, ui: &Ui) -> Fresh {
    let output = editor.tool_output();
    let is_painting = editor.session.mode == Mode::Paint;
    let rings = if is_painting { output.rings.clone() } else { Vec::new() };
    let needle = output.needle.filter(|_| is_painting);
    let has_ring = !rings.is_empty();
    let poses = editor.poses();
    let scene = &editor.document().shown().scene;
    let visible = |object: usize| scene.objects.get(object).is_some_and(|object| !object.hidden);
    let sight = Sight { picker: editor.picker(), poses: &poses, visible: &visible, view };
    let mut guides = if is_painting { guides(editor, scene, &sight) } else { Vec::new() };
    guides.extend(selected_touch(editor, scene, &sight));
    if is_painting && output.line_px.len() > 1 {
        guides.push(GuideCurve {
            runs_px: vec![output.line_px.clone()],
            handles_px: output.handles_px.iter().copied().enumerate().collect(),
            end_shows: true,
            selected: true,
            lit: Some(CurvePart::Line),
            adrift_px: Vec::new(),
        });
    }
    // The label beside the ring appears once the pointer rests.
    if is_painting && has_ring {
        ui.ctx().request_repaint_after(std::time::Duration::from_millis(420));
    }
    Fresh {
        rings,
        needle,
        tag: output.label.clone().filter(|_| is_painting),
        guides,
        gizmo: editor.gizmo(view),
        stand_ins: if editor.session.mode == Mode::Arrange { stand_ins(editor, scene) } else { Vec::new() },
        missing: motion_marks::missing(editor, &poses),
        singular: singular(editor, &poses, view),
        radius_px: editor.session.options.radius_of(editor.session.tool()),
        hides_pointer: has_ring && editor.session.tool() != Tool::Pick,
    }
}

fn region_of(painting: &Painting, face: Face) -> Option<usize> {
    let surface = painting.surface(face.object as usize);
    let [a, b, c] = surface.mesh.corners(face.triangle as usize);
    let place = Particle {
        triangle: face.triangle,
        barycentric: [1.0 / 3.0; 2],
        flipped: false,
        position: (a + b + c) / 3.0,
        normal: (b - a).cross(c - a).normalize_or_zero(),
    };
    let region = painting.region_at(face.object as usize, &place);
    (region < painting.scene().regions.len()).then_some(region)
}

/// The factor that is painted onto an amount at a visible place.
fn factor_at(painting: &Painting, face: Face, seen: FacePlace, of: Amount) -> f32 {
    let mesh = &painting.surface(face.object as usize).mesh;
    let place = Particle {
        triangle: face.triangle,
        barycentric: seen.barycentric,
        flipped: seen.flipped,
        position: Vec3::ZERO,
        normal: Vec3::Y,
    };
    painting.painted_at(face.object as usize, &place.on(mesh, &mesh.positions, &mesh.normals), of)
}

/// The colours of a scene's regions: a region without its own has a default one, by its index.
fn region_colours(scene: &Scene) -> Vec<Color32> {
    let colour = |index: usize, own: Option<impasto_scene::document::Color>| {
        let [r, g, b] =
            own.unwrap_or(REGION_COLORS[index % REGION_COLORS.len()]).0.map(|c| (c * 255.0).round() as u8);
        Color32::from_rgb(r, g, b)
    };
    scene.regions.iter().enumerate().map(|(index, region)| colour(index, region.color)).collect()
}

fn selected_region(editor: &Editor, scene: &Scene) -> Option<usize> {
    let name = match editor.document().selection().active()? {
        Item::Region(name) | Item::Guide(name, _) => name,
        _ => return None,
    };
    scene.regions.iter().position(|region| region.name == *name)
}

/// The guides of the selected region, with handles on a selected guide.
fn guides(editor: &Editor, scene: &Scene, sight: &Sight<'_>) -> Vec<GuideCurve> {
    let Some(region) = selected_region(editor, scene) else { return Vec::new() };
    let region = &scene.regions[region];
    let selected = match editor.document().selection().active() {
        Some(Item::Guide(_, index)) => Some(*index),
        _ => None,
    };
    // Of many guides only the newest are shown: all of them would hide the strokes.
    let first = region.guides.len().saturating_sub(24);
    let curve = |(index, guide): (usize, &Guide)| {
        let name = guide.object.as_deref().or(region.on.object())?;
        let object = scene.objects.iter().position(|object| object.name == name)?;
        let pose = sight.poses.get(object)?;
        let place = |at: [f64; 3], normal: [f64; 3]| {
            let at = DVec3::from(at);
            lifted(&(*pose * sight.picker.now_from_rest(object, at)), at, DVec3::from(normal))
        };
        let points: Vec<[DVec3; 2]> =
            guide.points.iter().map(|point| place(point.at, point.normal)).collect();
        let is_selected = selected == Some(index);
        let handles = if is_selected { points.clone() } else { Vec::new() };
        Some(GuideCurve { selected: is_selected, ..GuideCurve::seen(&points, &handles, sight) })
    };
    let is_shown = |index: usize| index >= first || selected == Some(index);
    region.guides.iter().enumerate().filter(|(index, _)| is_shown(*index)).filter_map(curve).collect()
}

/// The line of the selected touch, with its points as handles.
fn selected_touch(editor: &Editor, scene: &Scene, sight: &Sight<'_>) -> Option<GuideCurve> {
    let Item::Touch(name) = editor.document().selection().active()? else { return None };
    let touch = scene.touches.iter().find(|touch| touch.name == *name)?;
    let object = scene.objects.iter().position(|object| object.name == touch.on)?;
    let pose = sight.poses.get(object)?;
    let place =
        |at: DVec3, normal: DVec3| lifted(&(*pose * sight.picker.now_from_rest(object, at)), at, normal);
    let handles: Vec<[DVec3; 2]> =
        touch.points.iter().map(|point| place(point.at.into(), point.normal.into())).collect();
    Some(GuideCurve { selected: true, ..GuideCurve::seen(&handles, &handles, sight) })
}

fn lifted(pose: &DAffine3, at: DVec3, normal: DVec3) -> [DVec3; 2] {
    let normal = (pose.matrix3.inverse().transpose() * normal).normalize_or(DVec3::Y);
    [pose.transform_point3(at), normal]
}

fn singular(editor: &Editor, poses: &[DAffine3], view: &View) -> Vec<SingularPoint> {
    let Some(painting) = editor.painting().filter(|_| editor.session.overlays.trust) else {
        return Vec::new();
    };
    let objects = 0..painting.scene().objects.len().min(poses.len());
    objects
        .flat_map(|object| painting.singularities(object).iter().map(move |point| (object, point)))
        .map(|(object, point)| {
            let now = poses[object] * editor.picker().now_from_rest(object, point.position);
            let position_in_world = now.transform_point3(point.position);
            // The normal points to the eye, so that only a surface in front of the point can hide the mark.
            let normal_in_world = (view.camera.eye - position_in_world).normalize_or(DVec3::Z);
            SingularPoint { position_in_world, normal_in_world, index: point.index as f32 }
        })
        .collect()
}

/// Marks for suns and, when looking through another camera, for the shot camera.
fn stand_ins(editor: &Editor, scene: &Scene) -> Vec<(StandIn, bool)> {
    let selection = editor.document().selection();
    let sun = |place: &LightPlace| {
        let light = &place.light;
        let direction = DVec3::from(light.direction.filter(|_| light.kind == LightKind::Sun)?);
        let direction = direction.normalize_or(DVec3::NEG_Y);
        let selected = selection.contains(&Item::Light(light.name.clone()));
        Some((StandIn::Sun { at: place.position, direction }, selected))
    };
    let mut all: Vec<(StandIn, bool)> = editor.light_places().iter().filter_map(sun).collect();
    let shot = editor.shot();
    if editor.camera() != shot {
        let view = View {
            camera: shot.clone(),
            size_px: DVec2::new(f64::from(scene.size.0), f64::from(scene.size.1)),
        };
        let ahead = shot.eye + (shot.target - shot.eye) * 0.3;
        let [width, height] = [view.size_px.x, view.size_px.y];
        let corners = [[0.0, 0.0], [width, 0.0], [width, height], [0.0, height]];
        let corners = corners.map(|[x, y]| view.at_depth_of(DVec2::new(x, y), ahead));
        all.push((StandIn::Camera { eye: shot.eye, corners }, selection.contains(&Item::Camera)));
    }
    all
}
