//! The scene document: every field of a scene file, with its default. Angles are in degrees, times in
//! frames and colours in sRGB, as a person writes them. [`crate::presets`] makes [`ResolvedStrokes`] from the settings.

mod color;
mod ease;
mod keys;
mod light;
mod noise_displace;
mod numbers;
mod paint;
mod regions;
mod rotating_strokes;
mod stage;
mod strokes;
mod style;
mod style_settings;
mod sumi_e;
mod touches;
mod up;

use serde::{Deserialize, Serialize};

use self::numbers::usual_fields;

pub use color::Color;
pub use ease::Ease;
pub use keys::{BackgroundKey, Key, LightKey, StrokesKey};
pub use light::{Light, LightKind};
pub use noise_displace::{
    NoiseAlong, NoiseAlpha, NoiseDisplace, NoiseForward, NoiseMix, NoiseNormals, NoiseSpace, SurfaceNoise,
    VertexNoise,
};
pub use numbers::Number;
pub use paint::{BrushMix, Edges, LayerNumber, LayerSettings, ResolvedLayer};
pub use regions::{
    Amount, AmountDab, Bend, Dab, Direction, Falloff, Guide, GuideMode, GuidePoint, GuideView, PaintedAmount,
    Patch, PatchRef, Region, Seam, Seed, Selector, Sense,
};
pub use rotating_strokes::{Canvas, RotatingStrokes, SAMPLES};
pub use stage::{Brought, Lost, Seen, Stage};
pub(crate) use strokes::PresetNumbers;
pub use strokes::{InspectorPlace, ResolvedStrokes, STROKE_NUMBERS, Shown, StrokeNumber, StrokeSettings};
pub use style::Style;
pub use style_settings::{CanvasFollows, Preparation, SettingRule, Solver, StyleInfo, StyleSettings};
pub use sumi_e::{InkDrawing, InkLight, InkRule, SumiE};
pub use touches::{Touch, TouchPoint};
pub use up::Up;

/// A whole scene file.
#[derive(Clone, Debug, PartialEq, Deserialize, Serialize)]
#[serde(deny_unknown_fields)]
pub struct Scene {
    /// Version of the format: 1.
    pub version: u32,
    /// Width and height in pixels, at most 16384 each. Sizes of strokes are stated for a picture of this size.
    #[serde(default = "default_size")]
    pub size: (u32, u32),
    /// A whole number from 0; another one changes every random choice at once.
    #[serde(default, skip_serializing_if = "is_default")]
    pub seed: u32,
    /// The colour that shows where nothing is painted. A scene that states no background, and has a shot with lights,
    /// gets a plain sky as bright as the shot.
    #[serde(default, skip_serializing_if = "is_default")]
    pub background: Color,
    /// The background over time, frames strictly increasing. If there are keys, `background` itself is not used.
    #[serde(default, skip_serializing_if = "is_default")]
    pub background_keys: Vec<BackgroundKey>,
    /// A glTF file beside the scene. Its objects, camera, lights and motion become the scene's, and so do its frames if
    /// `timeline` states none.
    #[serde(default, skip_serializing_if = "is_default")]
    pub shot: Option<String>,
    /// What the shot's file holds, once it has been read. Not part of the scene file.
    #[serde(skip)]
    pub stage: Stage,
    /// Frames and their rate.
    #[serde(default, skip_serializing_if = "is_default")]
    pub timeline: Timeline,
    /// The pose in which stroke directions are stated.
    #[serde(default, skip_serializing_if = "is_default")]
    pub reference: Reference,
    /// More poses in which stroke directions are stated, at most 16. Where a surface does not face the reference, the
    /// pose that it faces best is used.
    #[serde(default, skip_serializing_if = "is_default")]
    pub further_references: Vec<Reference>,
    /// The camera and its keys. May be left out if the scene has a shot with a camera.
    #[serde(default)]
    pub camera: Camera,
    /// Stops of light, from −16 to 16: each doubles the brightness of all lights.
    #[serde(default, skip_serializing_if = "is_default")]
    pub exposure: f64,
    /// Lights, at most 8 suns, and 16 points and spots together; without any, a sun and a soft light all around.
    #[serde(default, skip_serializing_if = "is_default")]
    pub lights: Vec<Light>,
    /// What stands in the scene. May be left out where the scene has a shot, which brings its own.
    #[serde(default)]
    pub objects: Vec<Object>,
    /// Stroke settings for everything that no region overrides.
    #[serde(default, skip_serializing_if = "is_default")]
    pub strokes: StrokeSettings,
    /// Parts of objects with settings of their own; a later region wins over an earlier one.
    #[serde(default, skip_serializing_if = "is_default")]
    pub regions: Vec<Region>,
    /// Strokes placed by hand, the last paint of all; a later one lies over an earlier one.
    #[serde(default, skip_serializing_if = "is_default")]
    pub touches: Vec<Touch>,
    /// How the scene is drawn.
    #[serde(default)]
    pub style: Style,
    /// What EXR files hold beside the colour, such as `["depth", "motion"]` or `["all"]`; `docs/compositing.md` lists
    /// them.
    #[serde(default, skip_serializing_if = "is_default")]
    pub aovs: Vec<String>,
}

impl Scene {
    /// The schema version that this build reads and writes.
    pub const VERSION: u32 = 1;
}

fn default_size() -> (u32, u32) {
    (1280, 720)
}

usual_fields! {
    /// Frame range and rate.
    pub struct Timeline {
        /// Frames per second, more than 0 and at most 1000000. If the scene has a shot and `timeline` states no frames,
        /// a rate of 24 counts as left out: the rate is then the shot's.
        pub fps: f64 = 24.0; saved always,
        /// First frame of the shot.
        pub first: i64 = 0; saved always,
        /// Last frame of the shot, included.
        pub last: i64 = 0; saved always,
        /// Which animation of the shot plays, where there are several: its name; left out, all of them together.
        pub animation: Option<String> = None,
    }
}

/// Which pose the stroke directions refer to.
#[derive(Clone, Debug, PartialEq, Deserialize, Serialize)]
#[serde(deny_unknown_fields)]
pub enum Reference {
    /// The camera and the objects as posed at this frame.
    Frame(i64),
    /// A separate camera, and the objects as posed at a frame.
    View {
        /// Where the eye is, world space.
        eye: [f64; 3],
        /// What it looks at, world space.
        target: [f64; 3],
        /// Turns the camera about its gaze, degrees counter-clockwise as the camera sees it.
        #[serde(default, skip_serializing_if = "is_default")]
        roll_deg: f64,
        /// Vertical field of view, degrees, from 1 to 170; left out, that of the camera at `frame`.
        #[serde(default, skip_serializing_if = "is_default")]
        fov_y_deg: Option<f64>,
        /// The frame that poses the objects.
        #[serde(default, skip_serializing_if = "is_default")]
        frame: i64,
    },
}

/// The camera: a lens and keyed poses.
#[derive(Clone, Debug, Default, PartialEq, Deserialize, Serialize)]
#[serde(deny_unknown_fields)]
pub struct Camera {
    /// Which camera of the shot is used, if the shot has several: the name of the camera's node. Left out, the cameras
    /// of the sidecar's cuts, or else the one that sees the most objects when the shot begins.
    #[serde(default, skip_serializing_if = "is_default")]
    pub of_shot: Option<String>,
    /// How the camera projects.
    #[serde(default, skip_serializing_if = "is_default")]
    pub lens: Lens,
    /// Frames strictly increasing; at least one key, unless the scene has a shot with a camera.
    #[serde(default)]
    pub keys: Vec<CameraKey>,
}

/// Projection of the camera. Lengths in world units.
#[derive(Clone, Debug, PartialEq, Deserialize, Serialize)]
#[serde(deny_unknown_fields)]
pub enum Lens {
    /// Central projection; `fov_y_deg` is the vertical field of view.
    Perspective {
        /// Vertical field of view, degrees, from 1 to 170.
        #[serde(default = "default_fov_y_deg")]
        fov_y_deg: f64,
        /// Nearest depth that is seen, more than 0.
        #[serde(default = "default_near")]
        near: f64,
        /// Farthest depth that is seen, more than `near`.
        #[serde(default = "default_far")]
        far: f64,
    },
    /// Parallel projection; `height` world units fill the picture's height.
    Orthographic {
        /// World units from the bottom to the top of the picture, more than 0.
        height: f64,
        /// Nearest depth that is seen.
        #[serde(default = "default_near")]
        near: f64,
        /// Farthest depth that is seen, more than `near`.
        #[serde(default = "default_far")]
        far: f64,
    },
}

fn default_fov_y_deg() -> f64 {
    35.0
}

fn default_near() -> f64 {
    0.05
}

fn default_far() -> f64 {
    100.0
}

/// One pose of the camera.
#[derive(Clone, Debug, PartialEq, Deserialize, Serialize)]
#[serde(deny_unknown_fields)]
pub struct CameraKey {
    /// The frame; need not be whole.
    pub frame: f64,
    /// Where the eye is, world space.
    pub eye: [f64; 3],
    /// The point that the camera looks at, world space; not `eye` itself, and not straight above or below `eye`.
    pub target: [f64; 3],
    /// Turns the camera about its gaze, degrees counter-clockwise as the camera sees it. The picture turns the other
    /// way.
    #[serde(default, skip_serializing_if = "is_default")]
    pub roll_deg: f64,
    /// The lens's field of view from this key on, degrees, from 1 to 170; interpolated between keys. Not for parallel
    /// lenses.
    #[serde(default, skip_serializing_if = "is_default")]
    pub fov_y_deg: Option<f64>,
    /// How the pose moves from this key to the next.
    #[serde(default, skip_serializing_if = "is_default")]
    pub ease: Ease,
}

/// Whether a field has its default value; such a field is not saved.
fn is_default<T: Default + PartialEq>(value: &T) -> bool {
    *value == T::default()
}

fn one() -> f64 {
    1.0
}

fn is_one(value: &f64) -> bool {
    *value == 1.0
}

fn one_frame() -> u32 {
    1
}

fn is_one_frame(frames: &u32) -> bool {
    *frames == 1
}

/// A thing in the scene: a mesh file or one group of it, placed and keyed.
#[derive(Clone, Debug, PartialEq, Deserialize, Serialize)]
#[serde(deny_unknown_fields)]
pub struct Object {
    /// Unique. How the strokes turn out depends on the name, so a renamed object is painted anew.
    pub name: String,
    /// The mesh: the path, relative to the scene file, of an OBJ or glTF file, or of one node of a glTF file, as in
    /// `props.glb#Lamp`; or a built-in mesh, `impasto:backdrop` (a floor and a wall) or `impasto:patch` (a round piece
    /// of floor). Left out, the mesh of the shot's object of this name.
    #[serde(default)]
    pub mesh: String,
    /// The only group of the mesh that is used; left out, the whole mesh.
    #[serde(default, skip_serializing_if = "is_default")]
    pub group: Option<String>,
    /// The object that this one moves with.
    #[serde(default, skip_serializing_if = "is_default")]
    pub parent: Option<String>,
    /// How many particles its body layer has, at most 16000000; where faces lie on each other, it gets fewer. Left out,
    /// the number follows from the coverage, as it does for the other layers.
    #[serde(default, skip_serializing_if = "is_default")]
    pub particles: Option<u64>,
    /// For how many frames each pose is held, from 1 to 1000, counted from the first frame. With 1 the object moves in
    /// every frame, with 2 "on twos".
    #[serde(default = "one_frame", skip_serializing_if = "is_one_frame")]
    pub hold: u32,
    /// Constant scale of the mesh, applied before strokes are placed on it; children do not inherit it.
    #[serde(default, skip_serializing_if = "is_default")]
    pub scale: Scale,
    /// Which axis of the mesh file points up.
    #[serde(default, skip_serializing_if = "is_default")]
    pub up: Up,
    /// Path of a mesh with equal topology, into which keys can turn this mesh.
    #[serde(default, skip_serializing_if = "is_default")]
    pub morph: Option<String>,
    /// Path of a PC2 point cache: where the points of the mesh file are, frame by frame, in the mesh file's own space.
    /// The mesh file must be an OBJ with as many points as the cache.
    #[serde(default, skip_serializing_if = "is_default")]
    pub cache: Option<String>,
    /// The shape of the object in which strokes are laid and sized. If strokes are combed while the object has another
    /// shape, their directions are carried back to this one.
    #[serde(default, skip_serializing_if = "is_default")]
    pub rest: Rest,
    /// Overrides the materials of the mesh file.
    #[serde(default, skip_serializing_if = "is_default")]
    pub material: Option<MaterialOverride>,
    /// Poses, frames strictly increasing; none means the identity.
    #[serde(default, skip_serializing_if = "is_default")]
    pub keys: Vec<ObjectKey>,
    /// Left out of the picture: no body, no shadow, no strokes. Its children stay.
    #[serde(default, skip_serializing_if = "is_default")]
    pub hidden: bool,
    /// The editor does not change it; no other effect.
    #[serde(default, skip_serializing_if = "is_default")]
    pub locked: bool,
}

/// The shape in which strokes are laid on a body that bends.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize, Serialize)]
pub enum Rest {
    /// The shape that the mesh file has without any motion.
    #[default]
    Bind,
    /// Its shape at this frame.
    Frame(i64),
}

/// A scale along three axes: in the file one number, or `(x, y, z)`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Scale(pub [f64; 3]);

usual_fields! {
    /// Colour or texture that replaces what the mesh file says.
    pub struct MaterialOverride {
        /// Base colour.
        pub color: Option<Color> = None,
        /// Picture file, relative to the scene file; multiplied by `color` (white when that is left out).
        pub texture: Option<String> = None,
        /// Shown as it is, without light or shadow.
        pub unlit: bool = false,
        /// Strength of highlights, from 0, matt, to 1, glazed; left out, what the mesh file says.
        pub gloss: Option<f64> = None,
        /// Noise that moves the object's vertices and colours its surface.
        pub noise_displace: Option<NoiseDisplace> = None,
    }
}

impl MaterialOverride {
    /// The picture files that the material names, each with the path of its field inside the material.
    pub fn textures(&self) -> impl Iterator<Item = (&String, &'static str)> {
        let own = self.texture.as_ref().map(|name| (name, "texture"));
        own.into_iter().chain(self.noise_displace.iter().flat_map(NoiseDisplace::textures))
    }
}

/// One pose of an object in its parent's space.
#[derive(Clone, Debug, PartialEq, Deserialize, Serialize)]
#[serde(deny_unknown_fields)]
pub struct ObjectKey {
    /// The frame; need not be whole.
    pub frame: f64,
    /// Translation, parent space.
    #[serde(default, skip_serializing_if = "is_default")]
    pub translation: [f64; 3],
    /// Euler angles in degrees: about X first, then Y, then Z; interpolated as numbers, so 0 to 720 is two turns.
    #[serde(default, skip_serializing_if = "is_default")]
    pub rotation_deg: [f64; 3],
    /// Scale along the object's own axes, each from 0.001 to 1000; children scale with it.
    #[serde(default, skip_serializing_if = "is_default")]
    pub scale: Scale,
    /// How far the mesh has turned into the object's `morph`, from 0, not at all, to 1, wholly.
    #[serde(default, skip_serializing_if = "is_default")]
    pub morph: f64,
    /// How the pose moves from this key to the next.
    #[serde(default, skip_serializing_if = "is_default")]
    pub ease: Ease,
}

impl Object {
    /// An object that shows a whole mesh as it is in its file, without keys.
    pub fn new(name: impl Into<String>, mesh: impl Into<String>) -> Self {
        Self {
            name: name.into(),
            mesh: mesh.into(),
            group: None,
            parent: None,
            particles: None,
            scale: Scale::default(),
            up: Up::default(),
            morph: None,
            cache: None,
            rest: Rest::default(),
            material: None,
            hold: one_frame(),
            keys: Vec::new(),
            hidden: false,
            locked: false,
        }
    }

    /// From the mesh file's coordinates to the object's own space: the axis `up` turned to Y, then the static scale.
    pub fn model_from_file(&self) -> glam::DMat3 {
        glam::DMat3::from_diagonal(glam::DVec3::from(self.scale.0)) * self.up.y_up_from_file()
    }
}

impl ObjectKey {
    /// A key with the identity pose.
    pub fn at(frame: f64) -> Self {
        let ease = Ease::default();
        Self {
            frame,
            translation: [0.0; 3],
            rotation_deg: [0.0; 3],
            scale: Scale::default(),
            morph: 0.0,
            ease,
        }
    }
}

impl Scale {
    /// The same scale along all axes.
    pub fn even(scale: f64) -> Self {
        Self([scale; 3])
    }

    /// The even scale that gives the same volume: the geometric mean of the three.
    pub fn mean(self) -> f64 {
        let [x, y, z] = self.0;
        if x == y && y == z { x } else { (x * y * z).cbrt() }
    }

    /// The scale times `factor`, each component rounded by `tidy` afterwards.
    pub fn times(self, factor: f64, tidy: impl Fn(f64) -> f64) -> Self {
        Self(self.0.map(|scale| tidy(scale * factor)))
    }

    /// The scale as a matrix.
    pub fn matrix(self) -> glam::DMat3 {
        glam::DMat3::from_diagonal(glam::DVec3::from(self.0))
    }
}

impl Default for Scale {
    fn default() -> Self {
        Self([1.0; 3])
    }
}

impl Default for Reference {
    fn default() -> Self {
        Self::Frame(0)
    }
}

impl Default for Lens {
    fn default() -> Self {
        Self::Perspective { fov_y_deg: default_fov_y_deg(), near: default_near(), far: default_far() }
    }
}
