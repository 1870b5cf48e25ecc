//! The JSON pointers of KHR_animation_pointer that are read.

use crate::animation::{CameraProperty, LightProperty, MaterialProperty, NodeProperty, Target};
use crate::extensions::{EMISSIVE_STRENGTH, LIGHTS, VISIBILITY};

/// The property that a pointer drives; `None` if motion of this property is not read. The index may be out of range.
pub(crate) fn target(pointer: &str) -> Option<Target> {
    let parts: Vec<&str> = pointer.strip_prefix('/')?.split('/').collect();
    let index = |text: &str| {
        let is_plain =
            text.bytes().all(|digit| digit.is_ascii_digit()) && (text == "0" || !text.starts_with('0'));
        if is_plain { text.parse::<usize>().ok() } else { None }
    };
    Some(match *parts.as_slice() {
        ["nodes", node, property] => {
            let property = match property {
                "translation" => NodeProperty::Translation,
                "rotation" => NodeProperty::Rotation,
                "scale" => NodeProperty::Scale,
                "weights" => NodeProperty::Weights,
                _ => return None,
            };
            Target::Node(index(node)?, property)
        }
        ["nodes", node, "extensions", VISIBILITY, "visible"] => {
            Target::Node(index(node)?, NodeProperty::Visible)
        }
        ["cameras", camera, _, property] => {
            let property = match (parts[2], property) {
                ("perspective", "yfov") => CameraProperty::Yfov,
                ("orthographic", "xmag") => CameraProperty::Xmag,
                ("orthographic", "ymag") => CameraProperty::Ymag,
                ("perspective" | "orthographic", "znear") => CameraProperty::Znear,
                ("perspective" | "orthographic", "zfar") => CameraProperty::Zfar,
                _ => return None,
            };
            Target::Camera(index(camera)?, property)
        }
        ["extensions", LIGHTS, "lights", light, property] => {
            let property = match property {
                "color" => LightProperty::Color,
                "intensity" => LightProperty::Intensity,
                "range" => LightProperty::Range,
                _ => return None,
            };
            Target::Light(index(light)?, property)
        }
        ["extensions", LIGHTS, "lights", light, "spot", property] => {
            let property = match property {
                "innerConeAngle" => LightProperty::InnerConeAngle,
                "outerConeAngle" => LightProperty::OuterConeAngle,
                _ => return None,
            };
            Target::Light(index(light)?, property)
        }
        ["materials", material, "pbrMetallicRoughness", property] => {
            let property = match property {
                "baseColorFactor" => MaterialProperty::BaseColor,
                "metallicFactor" => MaterialProperty::Metallic,
                "roughnessFactor" => MaterialProperty::Roughness,
                _ => return None,
            };
            Target::Material(index(material)?, property)
        }
        ["materials", material, "emissiveFactor"] => {
            Target::Material(index(material)?, MaterialProperty::EmissiveFactor)
        }
        ["materials", material, "extensions", EMISSIVE_STRENGTH, "emissiveStrength"] => {
            Target::Material(index(material)?, MaterialProperty::EmissiveStrength)
        }
        _ => return None,
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn known_pointers_have_targets() {
        assert_eq!(target("/cameras/3/perspective/yfov"), Some(Target::Camera(3, CameraProperty::Yfov)));
        let visible = "/nodes/12/extensions/KHR_node_visibility/visible";
        assert_eq!(target(visible), Some(Target::Node(12, NodeProperty::Visible)));
        let inner = "/extensions/KHR_lights_punctual/lights/0/spot/innerConeAngle";
        assert_eq!(target(inner), Some(Target::Light(0, LightProperty::InnerConeAngle)));
    }

    #[test]
    fn others_have_none() {
        for pointer in [
            "",
            "/",
            "nodes/0/scale",
            "/nodes/0",
            "/nodes/-1/scale",
            "/nodes/00/scale",
            "/nodes/+1/scale",
            "/nodes//scale",
            "/nodes/99999999999999999999999/scale",
            "/cameras/0/orthographic/yfov",
            "/meshes/0/weights",
        ] {
            assert_eq!(target(pointer), None, "{pointer}");
        }
    }
}
