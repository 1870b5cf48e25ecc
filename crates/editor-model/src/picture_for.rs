//! What a picture file is chosen for, and the command that makes use of it.

use impasto_scene::document::{BrushMix, MaterialOverride, Scene};

use crate::command::{Arrange, Command, Regions, StrokeChange, StrokesOf};
use crate::selection::{Item, Selection};

/// What a picture file is chosen for.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
pub enum PictureFor {
    /// The brush of a region, or of the scene.
    Brush(StrokesOf),
    /// The texture of the named object.
    Texture(String),
    /// A part of the noise in the material of the named object.
    Noise(String, NoisePart),
}

/// A part of the noise of an object's material.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum NoisePart {
    /// What moves the vertices.
    Vertex,
    /// What colours the surface.
    Surface,
}

impl PictureFor {
    /// What a picture dropped on the window is for: the texture of the selected object, or the brush of the selected
    /// region. If neither is selected, it is for the brush of the scene.
    pub fn dropped(selection: &Selection) -> Self {
        match selection.active() {
            Some(Item::Object(name)) => Self::Texture(name.clone()),
            Some(Item::Region(name) | Item::Guide(name, _)) => Self::Brush(StrokesOf::Region(name.clone())),
            Some(Item::Camera | Item::Light(_) | Item::Touch(_)) | None => Self::Brush(StrokesOf::Scene),
        }
    }

    /// The folder beside the scene into which a picture from elsewhere is copied.
    pub fn folder(&self) -> &'static str {
        match self {
            Self::Brush(_) => "brushes",
            Self::Texture(_) | Self::Noise(..) => "textures",
        }
    }

    /// In words for users: *the texture of apple*.
    pub fn words(&self) -> String {
        match self {
            Self::Brush(StrokesOf::Scene) => "the brush of all strokes".to_owned(),
            Self::Brush(StrokesOf::Region(name)) => format!("the brush of {name}"),
            Self::Texture(name) => format!("the texture of {name}"),
            Self::Noise(name, _) => format!("the noise of {name}"),
        }
    }

    /// The command that sets the picture to `name`, its path from the scene's folder. Without a `name`, it removes the
    /// picture. Returns `None` if the object is gone, or has no such noise.
    pub fn command(&self, scene: &Scene, name: Option<String>) -> Option<Command> {
        let material_of = |object: &str| {
            let found = scene.objects.iter().find(|known| known.name == object)?;
            Some(found.material.clone().unwrap_or_default())
        };
        let set = |object: &String, material: MaterialOverride| {
            let material = (material != MaterialOverride::default()).then_some(material);
            Command::Arrange(Arrange::SetMaterial(object.clone(), material))
        };
        Some(match self {
            Self::Brush(of) => {
                let brush = name.map(|name| BrushMix(vec![name]));
                Command::Regions(Regions::SetStroke(of.clone(), StrokeChange::Brush(brush)))
            }
            Self::Texture(object) => set(object, MaterialOverride { texture: name, ..material_of(object)? }),
            Self::Noise(object, part) => {
                let mut material = material_of(object)?;
                let noise = material.noise_displace.as_mut()?;
                let texture = match part {
                    NoisePart::Vertex => &mut noise.vertex.as_mut()?.texture,
                    NoisePart::Surface => &mut noise.surface.as_mut()?.texture,
                };
                *texture = name;
                set(object, material)
            }
        })
    }
}

#[cfg(test)]
mod tests {
    use impasto_scene::document::{NoiseDisplace, Object};
    use impasto_scene::new_scene;

    use super::*;

    fn scene() -> Scene {
        let mut scene = new_scene::empty();
        scene.objects.push(Object::new("apple", "apple.obj"));
        scene
    }

    fn material(command: Option<Command>) -> Option<MaterialOverride> {
        match command {
            Some(Command::Arrange(Arrange::SetMaterial(object, material))) if object == "apple" => material,
            other => panic!("{other:?}"),
        }
    }

    #[test]
    fn what_is_dropped_is_for_what_is_selected() {
        let of = |item: Option<Item>| PictureFor::dropped(&item.into_iter().collect());
        assert_eq!(of(Some(Item::Object("apple".to_owned()))), PictureFor::Texture("apple".to_owned()));
        let skin = PictureFor::Brush(StrokesOf::Region("skin".to_owned()));
        assert_eq!(of(Some(Item::Region("skin".to_owned()))), skin);
        assert_eq!(of(Some(Item::Guide("skin".to_owned(), 1))), skin);
        assert_eq!(of(Some(Item::Camera)), PictureFor::Brush(StrokesOf::Scene));
        assert_eq!(of(None), PictureFor::Brush(StrokesOf::Scene));
    }

    #[test]
    fn a_texture_leaves_the_rest_of_the_material_and_goes_without_a_trace() {
        let mut scene = scene();
        let of = PictureFor::Texture("apple".to_owned());
        let named = material(of.command(&scene, Some("skin.png".to_owned()))).expect("an override");
        assert_eq!(named.texture.as_deref(), Some("skin.png"));
        scene.objects[0].material = Some(named);
        assert_eq!(material(of.command(&scene, None)), None, "nothing is left to state");
        scene.objects[0].material =
            Some(MaterialOverride { gloss: Some(0.5), ..MaterialOverride::default() });
        let both = material(of.command(&scene, Some("skin.png".to_owned()))).expect("an override");
        assert_eq!((both.gloss, both.texture.as_deref()), (Some(0.5), Some("skin.png")));
        assert_eq!(PictureFor::Texture("pear".to_owned()).command(&scene, None), None);
    }

    #[test]
    fn noise_takes_a_picture_only_where_it_is_on() {
        let mut scene = scene();
        let of = PictureFor::Noise("apple".to_owned(), NoisePart::Vertex);
        assert_eq!(of.command(&scene, Some("n.png".to_owned())), None);
        let noise = NoiseDisplace { surface: None, ..NoiseDisplace::default() };
        scene.objects[0].material =
            Some(MaterialOverride { noise_displace: Some(noise), ..MaterialOverride::default() });
        let named = material(of.command(&scene, Some("n.png".to_owned()))).expect("an override");
        let vertex = named.noise_displace.and_then(|noise| noise.vertex).expect("it is on");
        assert_eq!(vertex.texture.as_deref(), Some("n.png"));
        let surface = PictureFor::Noise("apple".to_owned(), NoisePart::Surface);
        assert_eq!(surface.command(&scene, Some("n.png".to_owned())), None);
    }
}
