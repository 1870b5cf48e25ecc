//! The selection: which things of the document are selected, by their names.

use impasto_scene::document::Scene;

/// A thing of the document.
#[derive(Clone, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Item {
    /// The shot's camera.
    Camera,
    /// A light, by name.
    Light(String),
    /// An object, by name.
    Object(String),
    /// A region, by name.
    Region(String),
    /// A guide: the name of its region, and its index among that region's guides.
    Guide(String, usize),
    /// A touch, by name: a stroke placed by hand.
    Touch(String),
}

impl Item {
    /// Its name; for a guide, the name of its region.
    pub fn name(&self) -> &str {
        match self {
            Self::Camera => "shot",
            Self::Light(name)
            | Self::Object(name)
            | Self::Region(name)
            | Self::Guide(name, _)
            | Self::Touch(name) => name,
        }
    }

    /// Whether a scene has it.
    pub fn is_in(&self, scene: &Scene) -> bool {
        match self {
            Self::Camera => true,
            Self::Light(name) => scene.lights.iter().any(|light| light.name == *name),
            Self::Object(name) => scene.objects.iter().any(|object| object.name == *name),
            Self::Region(name) => scene.regions.iter().any(|region| region.name == *name),
            Self::Touch(name) => scene.touches.iter().any(|touch| touch.name == *name),
            Self::Guide(name, index) => {
                scene.regions.iter().any(|region| region.name == *name && *index < region.guides.len())
            }
        }
    }
}

/// The selected things, in the order in which they were selected; the last one is the active one.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Selection(Vec<Item>);

impl Selection {
    /// One thing alone.
    pub fn only(item: Item) -> Self {
        Self(vec![item])
    }

    /// All selected things.
    pub fn items(&self) -> &[Item] {
        &self.0
    }

    /// The thing that the inspector shows.
    pub fn active(&self) -> Option<&Item> {
        self.0.last()
    }

    /// Whether a thing is selected.
    pub fn contains(&self, item: &Item) -> bool {
        self.0.contains(item)
    }

    /// Adds a thing and makes it the active one; removes it if it was already active.
    pub fn toggle(&mut self, item: Item) {
        let was_active = self.active() == Some(&item);
        self.0.retain(|other| *other != item);
        if !was_active {
            self.0.push(item);
        }
    }

    /// The selected objects' names.
    pub fn objects(&self) -> impl Iterator<Item = &str> {
        self.0.iter().filter_map(|item| match item {
            Item::Object(name) => Some(name.as_str()),
            _ => None,
        })
    }

    /// Removes things for which `exists` is false.
    pub fn retain(&mut self, exists: impl FnMut(&Item) -> bool) {
        self.0.retain(exists);
    }
}

impl FromIterator<Item> for Selection {
    fn from_iter<I: IntoIterator<Item = Item>>(items: I) -> Self {
        Self(items.into_iter().collect())
    }
}
