//! The command that sets an object's material override: values that replace those of the mesh file.

use impasto_scene::document::{MaterialOverride, Scene};

use super::region::in_file;
use super::{Done, unlocked_object};
use crate::refusal::Refusal;

pub(super) fn set_material(
    scene: &mut Scene,
    name: &str,
    mut material: Option<MaterialOverride>,
) -> Result<Done, Refusal> {
    if let Some(material) = &mut material {
        material.color = material.color.map(in_file);
        let surface = material.noise_displace.as_mut().and_then(|noise| noise.surface.as_mut());
        if let Some(surface) = surface {
            surface.tint = in_file(surface.tint);
        }
    }
    let object = unlocked_object(scene, name)?;
    let before = std::mem::replace(&mut object.material, material.clone());
    let words = changed(&before.unwrap_or_default(), &material.unwrap_or_default());
    Ok(Done::new(format!("{words} of {name}")))
}

/// Says in words what differs between two materials. If several things differ, or if the difference has no word here,
/// this is *Material*.
fn changed(before: &MaterialOverride, now: &MaterialOverride) -> &'static str {
    let with = |change: fn(&mut MaterialOverride, &MaterialOverride)| {
        let mut changed = before.clone();
        change(&mut changed, now);
        changed == *now && changed != *before
    };
    let either =
        |is_stated: bool, set: &'static str, reset: &'static str| if is_stated { set } else { reset };
    if with(|material, now| material.color = now.color) {
        either(now.color.is_some(), "Colour", "Reset colour")
    } else if with(|material, now| material.texture.clone_from(&now.texture)) {
        either(now.texture.is_some(), "Texture", "Reset texture")
    } else if with(|material, now| material.gloss = now.gloss) {
        either(now.gloss.is_some(), "Gloss", "Reset gloss")
    } else if with(|material, now| material.noise_displace.clone_from(&now.noise_displace)) {
        "Noise"
    } else {
        "Material"
    }
}

#[cfg(test)]
mod tests {
    use impasto_scene::document::Color;

    use super::*;

    #[test]
    fn the_history_says_what_changed() {
        let bare = MaterialOverride::default();
        let red = MaterialOverride { color: Some(Color([1.0, 0.0, 0.0])), ..bare.clone() };
        let both = MaterialOverride { texture: Some("a.png".to_owned()), ..red.clone() };
        let glazed = MaterialOverride { gloss: Some(1.0), ..both.clone() };
        assert_eq!(changed(&bare, &red), "Colour");
        assert_eq!(changed(&red, &bare), "Reset colour");
        assert_eq!(changed(&red, &both), "Texture");
        assert_eq!(changed(&both, &red), "Reset texture");
        assert_eq!(changed(&both, &glazed), "Gloss");
        assert_eq!(changed(&glazed, &both), "Reset gloss");
        assert_eq!(changed(&bare, &both), "Material", "two things changed at once");
        assert_eq!(changed(&bare, &MaterialOverride { unlit: true, ..bare.clone() }), "Material");
    }
}
