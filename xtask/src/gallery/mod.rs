//! `cargo xtask gallery`: renders the pictures of the README and the docs anew, or only those whose names are given.

mod list;
mod noise;
mod panel;
mod sumi_e;

use std::path::{Path, PathBuf};

use anyhow::{Context as _, bail};

use crate::steps::{self, Profile, build, step};
use crate::tidy::pictures::DOCS_LIMIT_BYTES;

use list::{Picture, View};
use panel::Panel;

/// Size at which a picture is rendered, unless it asks for the size of its scene. Crops are in pixels of the rendered
/// picture.
const SIZE_PX: [u32; 2] = [1280, 720];

/// Renders every picture into `docs/pictures/`, or those whose names are given.
pub fn run(root: &Path, only: &[String]) -> anyhow::Result<()> {
    if let Some(unknown) = only.iter().find(|name| pictures().all(|picture| picture.name != **name)) {
        bail!("there is no picture `{unknown}`; the lists are in xtask/src/gallery");
    }
    let impasto = step("build", || build(root, Profile::Release))?;
    let work =
        Work { root, impasto: impasto.to_string_lossy().into_owned(), folder: root.join("out/gallery") };
    std::fs::create_dir_all(&work.folder)?;
    for picture in
        pictures().filter(|picture| only.is_empty() || only.iter().any(|name| name == picture.name))
    {
        step(picture.name, || work.make(picture))?;
    }
    Ok(())
}

fn pictures() -> impl Iterator<Item = &'static Picture> {
    list::PICTURES.iter().chain(noise::PICTURES).chain(sumi_e::PICTURES)
}

struct Work<'a> {
    root: &'a Path,
    impasto: String,
    /// For intermediate files.
    folder: PathBuf,
}

impl Work<'_> {
    fn make(&self, picture: &Picture) -> anyhow::Result<()> {
        let panels: Vec<Panel> = picture
            .panels
            .iter()
            .enumerate()
            .map(|(index, set)| self.panel(picture, index, set))
            .collect::<anyhow::Result<_>>()?;
        let columns = picture.columns.min(panels.len());
        let whole = Panel::side_by_side(&panels, columns)?;
        let target = self.root.join(format!("docs/pictures/{}.png", picture.name));
        // The file has 256 colours, enough for paint. If it is still too large, the picture is reduced.
        for percent in [100, 85, 70, 60, 50, 40] {
            let reduced = whole.reduced(percent);
            reduced.write(&target)?;
            let bytes = std::fs::metadata(&target)?.len();
            if bytes <= DOCS_LIMIT_BYTES {
                println!("{}: {:?}, {} KB", target.display(), reduced.size_px, bytes / 1024);
                return Ok(());
            }
        }
        bail!("{} is over {} KB however small", target.display(), DOCS_LIMIT_BYTES / 1024)
    }

    fn panel(&self, picture: &Picture, index: usize, set: &[(&str, &str)]) -> anyhow::Result<Panel> {
        let file = self.folder.join(format!("{}_{index}.png", picture.name));
        let output = file.to_string_lossy().into_owned();
        match picture.view {
            View::Brushes => steps::run(self.root, &self.impasto, &["brushes", "-o", &output])?,
            View::Scene { scene, frame, .. } => {
                let scene = format!("scenes/{scene}.ron");
                let (frame, size) = (frame.to_string(), format!("{}x{}", SIZE_PX[0], SIZE_PX[1]));
                let stated = |flag: &str| set.iter().find(|(path, _)| *path == flag).map(|&(_, value)| value);
                let frame = stated("--frames").unwrap_or(&frame);
                let mut arguments = vec!["render", &scene, "--quiet", "--frames", frame, "-o", &output];
                for flag in ["--rotation", "--colors"] {
                    if let Some(value) = stated(flag) {
                        arguments.extend([flag, value]);
                    }
                }
                let set: Vec<String> = set
                    .iter()
                    .filter(|(path, _)| !path.starts_with("--"))
                    .map(|(path, value)| format!("{path}={value}"))
                    .collect();
                if !picture.own_size {
                    arguments.extend(["--size", &size]);
                }
                for value in &set {
                    arguments.extend(["--set", value]);
                }
                steps::run(self.root, &self.impasto, &arguments)?;
            }
        }
        let panel = Panel::read(&file).with_context(|| format!("{} cannot be read", file.display()))?;
        match picture.view {
            View::Scene { crop: Some([x, y, width, height]), .. } => panel.cropped([x, y], [width, height]),
            View::Scene { crop: None, .. } | View::Brushes => Ok(panel),
        }
    }
}
