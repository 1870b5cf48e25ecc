//! Lists the rows of the scene tree: which there are, in which order, and what each shows.

use egui::Color32;
use impasto_editor_model::{Document, Item};
use impasto_scene::document::{Color, Direction, Object, Region, Scene, Touch};
use impasto_scene::new_scene::REGION_COLORS;

use crate::icons;
use crate::panels::column_state::ColumnState;
use crate::widgets::RowMark;

/// Objects start open if the whole tree has at most about this many rows.
const ROWS_OPEN_AT_FIRST: usize = 20;

/// One row of the scene tree.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct TreeLine {
    /// What it stands for; `None` for the canvas.
    pub(super) item: Option<Item>,
    pub(super) name: String,
    /// What kind of thing it is, as a screen reader says it: *region*, *object*, *light*.
    pub(super) kind: &'static str,
    /// What stands before the name.
    pub(super) mark: RowMark,
    /// How many rows it lies under; 0 at the top level.
    pub(super) depth: usize,
    /// Whether the rows under it are shown; `None` if there are none.
    pub(super) expanded: Option<bool>,
    /// Words at its right end.
    pub(super) note: String,
    /// Whether it has more than one key.
    pub(super) keyed: bool,
    pub(super) hidden: bool,
    pub(super) locked: bool,
}

impl TreeLine {
    fn new(item: Item, kind: &'static str, mark: RowMark) -> Self {
        Self {
            name: item.name().to_owned(),
            item: Some(item),
            kind,
            mark,
            depth: 0,
            expanded: None,
            note: String::new(),
            keyed: false,
            hidden: false,
            locked: false,
        }
    }

    /// Name, kind and state: *skin, region, 4 guides*.
    pub(super) fn spoken(&self) -> String {
        let mut words = format!("{}, {}", self.name, self.kind);
        if !self.note.is_empty() {
            words = format!("{words}, {}", self.note);
        }
        for (on, word) in [(self.hidden, "hidden"), (self.locked, "locked")] {
            if on {
                words = format!("{words}, {word}");
            }
        }
        words
    }
}

/// The rows as they are shown, top to bottom.
pub(super) fn rows(document: &Document, state: &ColumnState) -> Vec<TreeLine> {
    let loaded = document.shown();
    let scene = &loaded.scene;
    let searched = state.search.as_deref().map(str::trim).filter(|text| !text.is_empty());
    let camera = TreeLine {
        keyed: scene.camera.keys.len() > 1,
        ..TreeLine::new(Item::Camera, "camera", RowMark::Icon(icons::CAMERA))
    };
    let mut rows = vec![camera];
    let light = RowMark::Icon(icons::LIGHT);
    rows.extend(scene.lights.iter().map(|of| TreeLine {
        keyed: of.keys.len() > 1,
        ..TreeLine::new(Item::Light(of.name.clone()), "light", light)
    }));
    let starts_open = scene.objects.len() + scene.regions.len() + rows.len() <= ROWS_OPEN_AT_FIRST;
    let listing = Listing { document, state, starts_open, all_open: searched.is_some() };
    listing.objects_on(None, 0, &mut rows);
    rows.extend(
        scene
            .regions
            .iter()
            .enumerate()
            .filter(|(_, region)| region.on.object().is_none())
            .map(|(index, region)| region_row((index, region), 0)),
    );
    rows.push(TreeLine {
        item: None,
        name: "canvas".to_owned(),
        keyed: scene.background_keys.len() > 1,
        ..TreeLine::new(Item::Camera, "background", RowMark::Icon(icons::BACKDROP))
    });
    match searched {
        Some(text) => found(rows, &text.to_lowercase()),
        None => rows,
    }
}

struct Listing<'a> {
    document: &'a Document,
    state: &'a ColumnState,
    /// Whether objects start open, before the user has opened or folded them.
    starts_open: bool,
    /// Whether all objects are open, because the tree is searched.
    all_open: bool,
}

impl Listing<'_> {
    fn objects_on(&self, parent: Option<&str>, depth: usize, rows: &mut Vec<TreeLine>) {
        let scene = &self.document.shown().scene;
        for object in scene.objects.iter().filter(|object| object.parent.as_deref() == parent) {
            let name = object.name.as_str();
            let regions = || {
                scene.regions.iter().enumerate().filter(move |(_, region)| region.on.object() == Some(name))
            };
            let touches = || scene.touches.iter().filter(move |touch| touch.on == name);
            let is_parent = regions().next().is_some()
                || touches().next().is_some()
                || scene.objects.iter().any(|other| other.parent.as_deref() == Some(name));
            let open = self.all_open || self.state.rows.get(name).copied().unwrap_or(self.starts_open);
            let lacks_mesh = self.document.lacks_mesh(&object.mesh);
            rows.push(TreeLine {
                depth,
                expanded: is_parent.then_some(open),
                note: if lacks_mesh { "mesh missing".to_owned() } else { String::new() },
                keyed: object.keys.len() > 1,
                hidden: object.hidden,
                locked: object.locked,
                ..TreeLine::new(Item::Object(name.to_owned()), "object", mark_of(lacks_mesh))
            });
            if is_parent && open {
                rows.extend(regions().map(|region| region_row(region, depth + 1)));
                rows.extend(touches().map(|touch| touch_row(touch, depth + 1)));
                self.objects_on(Some(name), depth + 1, rows);
            }
        }
    }
}

fn mark_of(lacks_mesh: bool) -> RowMark {
    if lacks_mesh { RowMark::Wrong(icons::WARNING) } else { RowMark::Icon(icons::OBJECT) }
}

fn region_row((index, region): (usize, &Region), depth: usize) -> TreeLine {
    TreeLine {
        depth,
        note: note_of(region),
        keyed: region.strokes.keys.len() > 1,
        hidden: region.hidden,
        locked: region.locked,
        ..TreeLine::new(
            Item::Region(region.name.clone()),
            "region",
            RowMark::Colour(shown_color(region.color, index)),
        )
    }
}

fn touch_row(touch: &Touch, depth: usize) -> TreeLine {
    let mark = match touch.color {
        Some(color) => RowMark::Colour(color_of(color)),
        None => RowMark::Icon(icons::TOUCH),
    };
    TreeLine { depth, hidden: touch.hidden, ..TreeLine::new(Item::Touch(touch.name.clone()), "touch", mark) }
}

/// The colour that a region is shown in: its own, or one by its index.
pub(crate) fn region_color(scene: &Scene, name: &str) -> Color32 {
    let index = scene.regions.iter().position(|region| region.name == name).unwrap_or(0);
    shown_color(scene.regions.get(index).and_then(|region| region.color), index)
}

fn shown_color(own: Option<Color>, index: usize) -> Color32 {
    color_of(own.unwrap_or(REGION_COLORS[index % REGION_COLORS.len()]))
}

fn color_of(Color(channels): Color) -> Color32 {
    let [r, g, b] = channels.map(|channel| (channel * 255.0).round() as u8);
    Color32::from_rgb(r, g, b)
}

/// How many guides a region has, as *4 guides*; without guides, its base direction.
fn note_of(region: &Region) -> String {
    match region.guides.len() {
        0 => {}
        1 => return "1 guide".to_owned(),
        count => return format!("{count} guides"),
    }
    match region.direction {
        Direction::Auto => String::new(),
        Direction::Angle(angle) => format!("{angle:.0}\u{b0}").replace('-', "\u{2212}"),
        Direction::Crossing(..) => "crossing".to_owned(),
        Direction::Along(_) => "along".to_owned(),
        Direction::Around(_) => "around".to_owned(),
        Direction::Up => "up".to_owned(),
        Direction::Toward(_) => "toward".to_owned(),
        Direction::Curvature(_) => "curvature".to_owned(),
    }
}

/// The rows whose names contain `text`, with the rows that they lie under.
fn found(rows: Vec<TreeLine>, text: &str) -> Vec<TreeLine> {
    let mut kept = Vec::new();
    let mut under = 0;
    for row in rows.into_iter().rev() {
        if row.name.to_lowercase().contains(text) || row.depth < under {
            under = row.depth;
            kept.push(row);
        }
    }
    kept.reverse();
    kept
}

/// The objects that an item lies under, the nearest first.
pub(super) fn above(scene: &Scene, item: &Item) -> Vec<String> {
    let object = |name: &str| scene.objects.iter().find(|object: &&Object| object.name == name);
    let mut next = match item {
        Item::Region(name) | Item::Guide(name, _) => {
            let region = scene.regions.iter().find(|region| region.name == *name);
            region.and_then(|region| region.on.object()).map(str::to_owned)
        }
        Item::Object(name) => object(name).and_then(|object| object.parent.clone()),
        Item::Touch(name) => {
            scene.touches.iter().find(|touch| touch.name == *name).map(|touch| touch.on.clone())
        }
        Item::Camera | Item::Light(_) => None,
    };
    let mut names = Vec::new();
    while let Some(name) = next.take().filter(|name| !names.contains(name)) {
        next = object(&name).and_then(|object| object.parent.clone());
        names.push(name);
    }
    names
}
