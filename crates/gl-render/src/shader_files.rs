//! The shader files, built into the binary so that an installation cannot lose them.

use crate::gl::{ShaderFile, ShaderTexts};

macro_rules! shader_files {
    ($($path:literal),* $(,)?) => {
        &[$(ShaderFile { path: $path, text: include_str!(concat!("../shaders/", $path)) }),*]
    };
}

impl ShaderTexts {
    /// The paths of all shader files, below the folder of shaders.
    pub fn paths() -> impl Iterator<Item = &'static str> {
        ALL.iter().flat_map(|group| group.iter()).map(|file| file.path)
    }

    /// Replaces the file at this path; returns whether the program has such a file.
    pub fn put(&mut self, path: &str, text: String) -> bool {
        let known = Self::paths().find(|known| *known == path);
        if let Some(known) = known {
            self.0.insert(known, text);
        }
        known.is_some()
    }
}

const ALL: &[&[ShaderFile]] =
    &[SHARED, REFERENCE, LIGHT_BILLBOARDS, ROTATING_STROKES, SUMI_E, NOISE_DISPLACE];

/// What every style may include.
pub(crate) const SHARED: &[ShaderFile] = shader_files![
    "shared/screen.vert",
    "shared/place.frag",
    "shared/encode.glsl",
    "shared/encode.frag",
    "shared/lay_over.frag",
    "shared/lens.glsl",
    "shared/oklab.glsl",
    "shared/inverse_bilinear.glsl",
    "shared/stroke_shape.glsl",
    "shared/body.glsl",
    "shared/cutout.glsl",
];

/// Bodies that are coloured by noise.
pub(crate) const NOISE_DISPLACE: &[ShaderFile] = shader_files![
    "noise_displace/look.vert",
    "noise_displace/look.frag",
    "noise_displace/background.frag",
    "noise_displace/gather.frag",
    "noise_displace/spread.frag",
    "noise_displace/bloom.frag",
];

/// The reference pass and the motion pass.
pub(crate) const REFERENCE: &[ShaderFile] = shader_files![
    "reference/lighting.glsl",
    "reference/surface.vert",
    "reference/surface.frag",
    "reference/sample.frag",
    "reference/shadow.vert",
    "reference/shadow.frag",
    "reference/openness.frag",
    "reference/light.frag",
    "reference/light_parts.frag",
    "reference/motion.vert",
    "reference/motion.frag",
];

/// Lights as icons that face the camera.
pub(crate) const LIGHT_BILLBOARDS: &[ShaderFile] =
    shader_files!["light_billboards/billboard.vert", "light_billboards/billboard.frag",];

/// Brush strokes.
pub(crate) const ROTATING_STROKES: &[ShaderFile] = shader_files![
    "rotating_strokes/layers.glsl",
    "rotating_strokes/surface.glsl",
    "rotating_strokes/borders.frag",
    "rotating_strokes/surroundings.glsl",
    "rotating_strokes/mixing.glsl",
    "rotating_strokes/resolve.vert",
    "rotating_strokes/paint.vert",
    "rotating_strokes/paint.frag",
    "rotating_strokes/soften.frag",
    "rotating_strokes/detail.frag",
    "rotating_strokes/spread.frag",
    "rotating_strokes/finish.frag",
];

/// Ink on paper.
pub(crate) const SUMI_E: &[ShaderFile] = shader_files![
    "sumi_e/ramp.glsl",
    "sumi_e/inked.glsl",
    "sumi_e/paper.glsl",
    "sumi_e/surface.vert",
    "sumi_e/silhouette.frag",
    "sumi_e/low_pass.frag",
    "sumi_e/interior.frag",
    "sumi_e/mix.frag",
    "sumi_e/wash.frag",
    "sumi_e/soften.frag",
    "sumi_e/resolve.vert",
    "sumi_e/paint.vert",
    "sumi_e/paint.frag",
    "sumi_e/lay.frag",
];

#[cfg(test)]
mod tests {
    use std::collections::BTreeSet;
    use std::path::Path;

    use super::*;

    #[test]
    fn every_file_of_the_folder_is_part_of_the_program_and_none_else() {
        let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("shaders");
        let groups = std::fs::read_dir(&folder).unwrap().map(|group| group.unwrap().path());
        let files = groups.flat_map(|group| std::fs::read_dir(group).unwrap());
        let paths = files.map(|file| file.unwrap().path());
        let there: BTreeSet<String> = paths
            .map(|path| path.strip_prefix(&folder).unwrap().to_string_lossy().replace('\\', "/"))
            .collect();
        let known: BTreeSet<String> = ShaderTexts::paths().map(str::to_owned).collect();
        assert_eq!(there, known);
    }

    #[test]
    fn a_text_stands_only_where_a_file_is() {
        let mut texts = ShaderTexts::default();
        assert!(!texts.put("shared/nowhere.glsl", String::new()) && texts.is_empty());
        assert!(texts.put("shared/encode.glsl", "text".to_owned()));
        assert_eq!(texts.get("shared/encode.glsl"), Some("text"));
    }
}
