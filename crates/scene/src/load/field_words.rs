//! What each field of a scene file holds, in words for messages.

use crate::document::{LayerSettings, RotatingStrokes, STROKE_NUMBERS, Style, SumiE, SurfaceNoise};

pub(super) fn what_goes_into(field: &str) -> Option<&'static str> {
    Some(match field {
        "version" => "the whole number 1",
        "particles" | "seed" | "hold" | "layer_count" => "a whole number, as in 7",
        "samples" => "a whole number, as in 2",
        "first" | "last" => "a whole frame number, as in 24",
        "layer" => "a whole number, as in 1 or -1",
        "size" => "two whole numbers for a picture, as in (1280, 720), or one number for strokes, as in 1.5",
        "fps" | "frame" | "roll_deg" | "turn_deg" | "fov_y_deg" | "near" | "far" | "height" | "intensity"
        | "gloss" | "radius" | "strength" | "by" | "width_px" | "length_px" | "opacity" | "period_secs"
        | "exposure" | "palette_mix" => A_NUMBER,
        "eye" | "target" | "position" | "translation" | "rotation_deg" | "at" | "normal" | "to_light" => {
            "three numbers, as in (0, 1.5, -2)"
        }
        "reference" => "a frame or a view, as in Frame(0) or View(eye: (0, 1, 4), target: (0, 0, 0))",
        "further_references" => "a list, as in [Frame(60), View(eye: (0, 1, -4), target: (0, 0, 0))]",
        "guides" => "a list, as in [(points: [(at: (…), normal: (…)), …], radius: 0.2)]",
        "amounts" => "a list, as in [(of: Width, dabs: [(at: (…), normal: (…), radius: 0.2, by: 1.5)])]",
        "of" => "Width, Length, Density or Flatness",
        "dabs" => "dabs, as in [(at: (0, 1, 0), normal: (0, 0, 1), radius: 0.2, by: 1.5)]",
        "touches" => "a list, as in [(name: \"glint\", on: \"apple\", points: [(at: (…), normal: (…))])]",
        "points" => "points of a surface, as in [(at: (0, 1, 0), normal: (0, 0, 1)), …]",
        "view" => "an eye and a target, as in (eye: (0, 1, 4), target: (0, 0, 0))",
        "seam" => "Hard or Soft(0.1)",
        "sense" => "Lines or Arrows",
        "falloff" => "Smooth, Linear or Flat",
        "morph" => "a mesh such as \"meshes/late.obj\" for an object, a number from 0 to 1 for a key",
        "scale" => "one number, or three as in (1, 2, 1)",
        "background" | "color" | "ground" | "paper" | "ink" | "seal" | "tint" => {
            "a colour, as in \"#b3262a\""
        }
        "name" | "mesh" | "group" | "parent" | "texture" | "preset" | "object" | "animation" | "of_shot" => {
            "text in quotes, as in \"apple\""
        }
        "rest" => "Bind or Frame(12)",
        "cache" => "a point cache in quotes, as in \"flag.pc2\"",
        "shot" => "a glTF file in quotes, as in \"shot.glb\"",
        "brush" => "a brush such as \"filbert\", a picture such as \"mark.png\", or a list of them",
        "aovs" => "a list of passes, as in [\"depth\", \"motion\"]",
        "palette" => "a list of colours, as in [\"#b3262a\", \"#e3b62c\"]",
        "layers" => "a list of layers, as in [(name: \"scumble\", coverage: 0)]",
        "order" => "all layers from the lowest up, as in [\"underpainting\", \"body\", …]",
        "edges" => "Clip, Overrun(3) or Free",
        "canvas" => "Linen or Board",
        "canvas_follows" | "paper_follows" => "Picture or Camera",
        "mode" => "Comb or Smooth",
        "unlit" | "underpainting" | "hidden" | "locked" | "take_away" | "curve" => "true or false",
        "keys" | "background_keys" => "a list of keys, as in [(frame: 0, …), (frame: 24, …)]",
        "objects" | "lights" | "regions" => "a list, as in [(name: \"apple\", …)]",
        "timeline" => "frames and their rate, as in (fps: 24, first: 0, last: 119)",
        "camera" => "a lens and keys, as in (keys: [(frame: 0, eye: (0, 1, 4), target: (0, 0, 0))])",
        "lens" => "Perspective(fov_y_deg: 35) or Orthographic(height: 2)",
        "strokes" => "stroke settings, as in (length_px: 78, width_px: 25)",
        "noise_displace" => {
            "noise of vertices and of the surface, as in (vertex: (scale: 0.1), surface: None)"
        }
        "vertex" => "noise that moves vertices, as in (value: (0.1, 0.1), scale: 0.1), or None",
        "surface" => "noise that colours a surface, as in (layer_count: 4, tint: \"#ffb040\"), or None",
        "value" | "tiling" | "tile_offset" | "cone_deg" => "two numbers, as in (0.1, 0.1)",
        "space" => "World or Local",
        "normals" => "Kept or Displaced",
        "along" => "Channels or Normal",
        "forward" => "Odd or Even",
        "mix" => "Root or Mean",
        "alpha" => "Texture or Grey",
        "material" => "a colour or a texture, as in (color: \"#b3262a\")",
        "style" => Style::EXAMPLES,
        "rule" => "Painter or Source",
        "drawing" => "Both, Wash or Strokes",
        "light" => "Scene or Eye",
        "tones" => "four tones from dark to light, as in (0.15, 0.45, 0.7, 0.95)",
        "solver" => "Tangent, Horn or HornExact",
        "ease" => "Step, Linear, Smooth, In, Out, Bounce or Curve((0.25, 0.1), (0.25, 1))",
        "kind" => "Sun, Point, Spot or Ambient",
        "up" => "Y, Z, X, NegX, NegY or NegZ",
        "on" => {
            "for a touch the name of an object, for a region Everything, Object(\"apple\"), Collection(\"fruit\"), EachMaterial(\"wood\"), Group(\"apple\", \"leaf\"), Material(\"apple\", \"wood\"), Dabs(\"apple\", [(at: …, normal: …, radius: 0.1)]), Flood(\"apple\", (at: …, normal: …), 30) or Several(\"apple\", [Whole, Group(\"leaf\"), Dabs(…)])"
        }
        "direction" => {
            "a direction: Auto, Angle(35), Crossing(-58, 4), Along((1, 0, 0)), Around((0, 1, 0)), Toward((0, 1, 0)), Curvature(Min) or Up in a region, (x, y, z) in a light"
        }
        _ => return is_number_of_a_table(field).then_some(A_NUMBER),
    })
}

const A_NUMBER: &str = "one number, as in 2.5";

/// Whether one of the document's tables has a number of this name.
fn is_number_of_a_table(field: &str) -> bool {
    let strokes = STROKE_NUMBERS.iter().map(|of| of.number.field);
    let layers = LayerSettings::NUMBERS.iter().map(|of| of.number.field);
    let styles = RotatingStrokes::numbers().map(|of| of.field);
    let ink = SumiE::numbers().map(|of| of.field);
    let noise = SurfaceNoise::numbers().map(|of| of.field);
    strokes.chain(layers).chain(styles).chain(ink).chain(noise).any(|known| known == field)
}

#[cfg(test)]
mod tests {
    use std::collections::{BTreeMap, BTreeSet};

    use super::*;

    /// Every field with a row in `docs/scene_file.md` has words. If all its rows say the same about what it takes, the
    /// words agree with them.
    #[test]
    fn every_field_has_words() {
        let page = include_str!("../../../../docs/scene_file.md");
        let mut in_fields = false;
        let mut fields: BTreeMap<&str, BTreeSet<&str>> = BTreeMap::new();
        for line in page.lines() {
            let cells: Vec<&str> = line.split('|').map(str::trim).collect();
            match cells[..] {
                ["", "field", ..] => in_fields = true,
                ["", cell, takes, ..] if in_fields && cell.starts_with('`') => {
                    fields.entry(cell.trim_matches('`')).or_default().insert(takes);
                }
                ["", ..] => {}
                _ => in_fields = false,
            }
        }
        assert!(fields.len() > 120, "{fields:?}");
        let mut compared = 0;
        for (field, takes) in &fields {
            let words = what_goes_into(field).unwrap_or_else(|| panic!("{field} has no words"));
            let of_one = takes.first().filter(|_| takes.len() == 1).copied();
            let part = match of_one {
                Some("(x, y)" | "`(x, y)`") => "two",
                Some("(x, y, z)" | "`(x, y, z)`") => "three",
                Some("a whole number") => "whole",
                Some(of) if of.starts_with("a number") => "number",
                Some(of) if of.starts_with("a list") => "[",
                Some("a colour") => "colour",
                Some("text") => "quotes",
                Some("`true` or `false`") => "true or false",
                // The first name of a choice.
                Some(of) if of.starts_with('`') && !of.starts_with("`(") => {
                    of.split('`').nth(1).unwrap_or_default()
                }
                _ => continue,
            };
            assert!(words.contains(part), "{field} takes {takes:?}; the words: {words}");
            compared += 1;
        }
        assert!(compared > 80, "only {compared} of {} were compared", fields.len());
    }
}
