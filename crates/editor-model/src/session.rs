//! The state of the editor that is not part of the document: mode, tools and their settings, shading, overlays, frame.

use impasto_scene::document::{Amount, Color, LightKind};

use crate::playback::Pacing;

/// The mode: what a drag with the left button does.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum Mode {
    /// A drag moves things together with all their keys.
    #[default]
    Arrange,
    /// A drag paints on surfaces: directions, regions, amounts or touches.
    Paint,
    /// A drag changes the pose at this frame.
    Animate,
}

/// A tool of the rail, the tool bar on the left.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Tool {
    /// Arrange, Animate: picks, and drags what is picked.
    Select,
    /// Arrange, Animate: the gizmo's arrows.
    Move,
    /// Arrange, Animate: the gizmo's rings.
    Turn,
    /// Arrange, Animate: the gizmo's boxes.
    Scale,
    /// Arrange, Animate: adds a light where the user clicks.
    AddLight,
    /// Arrange, Animate: orbits the shot camera.
    ShotCamera,
    /// Paint: strokes follow the drag.
    Comb,
    /// Paint: draws a guide as a curve through points.
    GuideCurve,
    /// Paint: states one direction for a whole region.
    Fill,
    /// Paint: turns or flips a region's directions.
    TurnDirection,
    /// Paint: smooths the directions under the drag, or smears them.
    Smooth,
    /// Paint: cuts guides away, so that strokes follow the region's base direction again.
    Erase,
    /// Paint: chooses which faces belong to a region.
    Region,
    /// Paint: makes strokes wider, longer, denser or flatter under the drag.
    Amount,
    /// Paint: lays single strokes by hand, over all others.
    Touch,
    /// Paint: takes the direction under the cursor.
    Pick,
}

/// How the picture is drawn.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum Shading {
    /// As it will be rendered.
    #[default]
    Painted,
    /// The plain render that strokes take their colours from.
    Shaded,
    /// Painted, coloured by how far each stroke's turn can be trusted.
    Trust,
}

/// Short lines along the strokes.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum DirectionLines {
    /// None.
    Off,
    /// White over black.
    #[default]
    Plain,
    /// In the colours of the regions.
    ByRegion,
}

/// The overlays over the picture.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Overlays {
    /// Lines along the strokes, in Paint.
    pub direction_lines: DirectionLines,
    /// Lines along the strokes, coloured by their trust, in every mode.
    pub trust: bool,
    /// Regions in their colours, with their names.
    pub regions: bool,
    /// The floor's grid.
    pub grid: bool,
}

/// Which axes a gizmo and a typed move follow.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum Axes {
    /// The world's.
    #[default]
    World,
    /// The object's own.
    Local,
    /// The view's.
    View,
}

/// The direction that a fill states.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum FillKind {
    /// Chosen from the shape of the surface, as `Auto` in a scene file.
    #[default]
    Automatic,
    /// Along the direction in which the surface curves least.
    Curvature,
    /// Up the surface.
    Up,
    /// Along the longest axis.
    Along,
    /// Round the longest axis.
    Around,
    /// One angle in the picture.
    Angle,
}

/// How the region tool chooses faces.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum RegionBy {
    /// Dabs of a brush.
    #[default]
    Brush,
    /// Faces that are reached from the clicked one without crossing an edge that bends more than an angle.
    Flood,
    /// A group of the mesh file.
    Group,
    /// A material of the mesh file.
    Material,
}

/// What the region tool does with the faces that it chose.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum RegionDoes {
    /// Makes a region of them.
    New,
    /// Adds them to the selected region.
    #[default]
    Add,
    /// Takes them away from the selected region.
    TakeAway,
}

/// What the pressure of a pen changes. Without a pen it changes nothing.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Pressure {
    /// Nothing.
    #[default]
    Off,
    /// The radius of the brush; the width of a touch.
    Radius,
    /// The strength of the brush; the opacity of a touch.
    Strength,
}

/// The settings of the tools.
#[derive(Clone, Debug, PartialEq)]
pub struct ToolOptions {
    /// Radius of the ring, logical pixels (points) of the screen.
    pub radius_px: f64,
    /// How far strokes follow the drag, 0..=1.
    pub strength: f64,
    /// Whether strokes run against the drag.
    pub against: bool,
    /// Whether the strength is full up to the radius; else it falls off.
    pub even: bool,
    /// How much the drag is steadied, 0..=1.
    pub steady: f64,
    /// What the pressure of a pen changes.
    pub pressure: Pressure,
    /// For each of the object's own axes, whether what is painted is mirrored along it.
    pub mirror: [bool; 3],
    /// Whether only surfaces that face the eye are painted.
    pub front_only: bool,
    /// Whether Smooth smears instead.
    pub smear: bool,
    /// What Fill states.
    pub fill: FillKind,
    /// The angle that [`FillKind::Angle`] states, degrees.
    pub fill_angle_deg: f64,
    /// Whether Turn direction flips directions; else it turns them by a drag.
    pub flip: bool,
    /// How the region tool chooses faces.
    pub region_by: RegionBy,
    /// What the region tool does with the chosen faces.
    pub region_does: RegionDoes,
    /// The bend at which a flood stops, degrees.
    pub flood_deg: f64,
    /// The axes that the gizmo and typed moves follow.
    pub axes: Axes,
    /// Whether moves snap to tenths of a unit, turns to 5 degrees, and scale factors to tenths.
    pub snap: bool,
    /// What kind of light Add light adds.
    pub light: LightKind,
    /// Which amount is painted.
    pub amount: Amount,
    /// Whether a drag lowers the amount instead of raising it.
    pub lowers: bool,
    /// Half the width of a touch, logical pixels of the screen.
    pub touch_radius_px: f64,
    /// Whether a drag erases instead of laying a touch.
    pub touch_erases: bool,
    /// Whether a touch takes the colour that strokes have there; else `touch_color`.
    pub touch_from_picture: bool,
    /// The colour of touches.
    pub touch_color: Color,
    /// How far a touch covers what is below, 0..=1.
    pub touch_opacity: f64,
    /// How much narrower a touch ends than it begins, -1..=1.
    pub touch_taper: f64,
    /// Whether strokes inside the ring are shown as a comb would lay them, before the press.
    pub foresee: bool,
}

/// The state of the editor that is not part of the document.
#[derive(Clone, Debug, PartialEq)]
pub struct Session {
    /// What a drag with the left button does.
    pub mode: Mode,
    /// The mode that Tab goes back to.
    pub mode_before: Mode,
    /// The tool of Arrange and Animate.
    pub object_tool: Tool,
    /// The tool of Paint.
    pub paint_tool: Tool,
    /// Settings of the tools.
    pub options: ToolOptions,
    /// How the picture is drawn.
    pub shading: Shading,
    /// What is drawn over the picture.
    pub overlays: Overlays,
    /// Whether the reference and this frame are shown side by side.
    pub compare: bool,
    /// The frame that is shown.
    pub frame: f64,
    /// The frame to come back to when Paint is left.
    pub frame_before_paint: Option<f64>,
    /// Whether playing begins again at the end of the range.
    pub looped: bool,
    /// Whether the frames of the range are painted exactly, not as drafts, while the window is idle. This begins after
    /// the shot was played for the first time.
    pub finishes: bool,
    /// Whether playing follows the clock or shows every frame.
    pub pacing: Pacing,
    /// Whether a pose made in Animate is keyed at once.
    pub auto_key: bool,
    /// Whether, in Animate, the shot camera moves with the view while the viewport looks through that camera.
    pub lock_to_view: bool,
    /// Whether the lanes of keys are open: the first value is for Animate, the second for the other modes.
    pub lanes: [bool; 2],
    /// Whether the curves of one lane take the place of the keys of all lanes.
    pub curves: bool,
    /// Whether a pen that reports its pressure was seen.
    pub has_pen: bool,
}

impl Default for Session {
    fn default() -> Self {
        Self {
            mode: Mode::default(),
            mode_before: Mode::Arrange,
            object_tool: Tool::Select,
            paint_tool: Tool::Comb,
            options: ToolOptions::default(),
            shading: Shading::default(),
            overlays: Overlays::default(),
            compare: false,
            frame: 0.0,
            frame_before_paint: None,
            looped: true,
            finishes: true,
            pacing: Pacing::default(),
            auto_key: true,
            lock_to_view: false,
            lanes: [true, false],
            curves: false,
            has_pen: false,
        }
    }
}

impl Default for ToolOptions {
    fn default() -> Self {
        Self {
            radius_px: 46.0,
            strength: 0.8,
            against: false,
            even: false,
            steady: 0.2,
            pressure: Pressure::default(),
            mirror: [false; 3],
            front_only: true,
            smear: false,
            fill: FillKind::default(),
            fill_angle_deg: 35.0,
            flip: true,
            region_by: RegionBy::default(),
            region_does: RegionDoes::default(),
            flood_deg: 30.0,
            axes: Axes::default(),
            snap: false,
            light: LightKind::Point,
            amount: Amount::Width,
            lowers: false,
            touch_radius_px: 7.0,
            touch_erases: false,
            touch_from_picture: false,
            touch_color: Color([1.0, 0.93, 0.8]),
            touch_opacity: 1.0,
            touch_taper: 0.0,
            foresee: true,
        }
    }
}

impl ToolOptions {
    /// Radius of a tool's ring, logical pixels of the screen.
    pub fn radius_of(&self, tool: Tool) -> f64 {
        if tool == Tool::Touch { self.touch_radius_px } else { self.radius_px }
    }
}

impl Session {
    /// The tool of the mode.
    pub fn tool(&self) -> Tool {
        if self.mode == Mode::Paint { self.paint_tool } else { self.object_tool }
    }

    /// Whether the timeline shows the lanes of keys.
    pub fn shows_lanes(&self) -> bool {
        self.lanes[usize::from(self.mode != Mode::Animate)]
    }

    /// Opens the lanes of keys, or folds them to a strip. Animate has a state of its own; the other modes share one.
    pub fn show_lanes(&mut self, shown: bool) {
        self.lanes[usize::from(self.mode != Mode::Animate)] = shown;
    }

    /// Whether the timeline shows curves.
    pub fn shows_curves(&self) -> bool {
        self.curves && self.shows_lanes()
    }

    /// Shows curves in the place of keys, and opens the lanes for them; or shows the keys again.
    pub fn toggle_curves(&mut self) {
        self.curves = !self.shows_curves();
        if self.curves {
            self.show_lanes(true);
        }
    }

    /// Sets the tool of the mode that it belongs to; the current mode stays.
    pub fn set_tool(&mut self, tool: Tool) {
        if tool.is_for_paint() {
            self.paint_tool = tool;
        } else {
            self.object_tool = tool;
        }
    }

    /// Changes the mode. Entering Paint goes to the reference's frame. Leaving it goes back to the frame before, unless
    /// another frame was chosen in Paint.
    pub fn set_mode(&mut self, mode: Mode, reference_frame: f64) {
        if mode == self.mode {
            return;
        }
        if mode == Mode::Paint {
            self.frame_before_paint = Some(self.frame);
            self.frame = reference_frame;
        } else if self.mode == Mode::Paint
            && let Some(frame) = self.frame_before_paint.take()
            && self.frame == reference_frame
        {
            self.frame = frame;
        }
        self.mode_before = self.mode;
        self.mode = mode;
    }
}

impl Tool {
    /// Whether it is one of Paint's.
    pub fn is_for_paint(self) -> bool {
        matches!(
            self,
            Self::Comb
                | Self::GuideCurve
                | Self::Fill
                | Self::TurnDirection
                | Self::Smooth
                | Self::Erase
                | Self::Region
                | Self::Amount
                | Self::Touch
                | Self::Pick
        )
    }
}
