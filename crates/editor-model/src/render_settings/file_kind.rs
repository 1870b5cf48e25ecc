//! Which files are written for a frame, and what EXR files hold beside the colour.

use std::path::{Path, PathBuf};

use impasto_scene::aovs::{AOVS, Aov, AovRow, AovSet};
use impasto_scene::document::Scene;

/// The files of a frame.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum FileKind {
    /// A PNG file of 8 bits a channel.
    #[default]
    Png8,
    /// A PNG file of 16 bits a channel.
    Png16,
    /// An EXR file.
    Exr,
    /// A PNG file of 8 bits, and an EXR file beside it.
    PngAndExr,
    /// One movie of all frames; the ending of its name says which kind.
    Movie,
}

impl FileKind {
    /// All kinds, in the order in which they are offered.
    pub const ALL: [Self; 5] = [Self::Png8, Self::Png16, Self::Exr, Self::PngAndExr, Self::Movie];

    /// Its words in the sheet.
    pub fn label(self) -> &'static str {
        match self {
            Self::Png8 => "PNG 8 bit",
            Self::Png16 => "PNG 16 bit",
            Self::Exr => "EXR",
            Self::PngAndExr => "PNG and EXR",
            Self::Movie => "Movie",
        }
    }

    /// Whether an EXR file is one of the files.
    pub fn has_exr(self) -> bool {
        matches!(self, Self::Exr | Self::PngAndExr)
    }

    /// Whether a PNG file is one of the files.
    pub fn has_png(self) -> bool {
        matches!(self, Self::Png8 | Self::Png16 | Self::PngAndExr)
    }

    /// The endings of a frame's files; the first is that of the pattern. For a movie, the endings that it may have, the
    /// usual one first.
    pub const fn endings(self) -> &'static [&'static str] {
        match self {
            Self::Png8 | Self::Png16 => &["png"],
            Self::Exr => &["exr"],
            Self::PngAndExr => &["png", "exr"],
            Self::Movie => MOVIES,
        }
    }

    /// The pattern `output` with the ending of this kind.
    pub(super) fn renamed(self, output: &str) -> String {
        let output = output.trim_end();
        let ending = FileEnding::of(output);
        if self == Self::Movie && ending == Some(FileEnding::Movie) {
            return output.to_owned();
        }
        let stem = ending.and_then(|_| output.rfind('.')).map_or(output, |at| &output[..at]);
        // The name of a movie has no frame number. If frames replace a movie, their names get a number again.
        let stem = match self {
            Self::Movie => match stem.trim_end_matches('#').trim_end_matches(['_', '-', '.']) {
                folder if folder != stem && name_in(folder).is_empty() => format!("{folder}movie"),
                name => name.to_owned(),
            },
            _ if stem.is_empty() || stem.ends_with(['/', '\\']) => stem.to_owned(),
            _ if ending == Some(FileEnding::Movie) && !name_in(stem).contains('#') => format!("{stem}_####"),
            _ => stem.to_owned(),
        };
        // An empty name gets no ending.
        if stem.is_empty() || stem.ends_with(['/', '\\']) {
            return output.to_owned();
        }
        format!("{stem}.{}", self.endings()[0])
    }

    /// This kind if it fits the ending of `output`, else the usual kind with that ending.
    pub(super) fn fitting(self, output: &str) -> Self {
        match (FileEnding::of(output), self) {
            (Some(FileEnding::Exr), _) => Self::Exr,
            (Some(FileEnding::Movie), _) => Self::Movie,
            (Some(FileEnding::Png), Self::Exr | Self::Movie) => Self::Png8,
            _ => self,
        }
    }

    /// The files of a frame, of which `path` is the one that the pattern names.
    pub(super) fn files(self, path: &Path) -> Vec<PathBuf> {
        match self {
            Self::Movie => vec![path.to_owned()],
            _ => self.endings().iter().map(|ending| path.with_extension(ending)).collect(),
        }
    }
}

/// The part of a path after its folders.
fn name_in(path: &str) -> &str {
    path.rsplit(['/', '\\']).next().unwrap_or(path)
}

/// The ending of a file that can be rendered.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum FileEnding {
    Png,
    Exr,
    Movie,
}

/// The endings of movies; the first is the usual one.
const MOVIES: &[&str] = &["mp4", "mov", "webm", "mkv"];

impl FileEnding {
    /// How a name ends, whatever the case of its letters; `None` if nothing can be rendered into such a file.
    pub(super) fn of(name: &str) -> Option<Self> {
        let name = name.trim_end().to_ascii_lowercase();
        let (_, ending) = name.rsplit_once('.')?;
        match ending {
            "png" => Some(Self::Png),
            "exr" => Some(Self::Exr),
            ending => MOVIES.contains(&ending).then_some(Self::Movie),
        }
    }
}

/// What EXR files hold beside the colour.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum AovChoice {
    /// What the scene's own `aovs` say.
    #[default]
    OfScene,
    /// All that the style of the scene has.
    All,
    /// These, as far as the style has them; an empty set means the colour alone.
    These(AovSet),
}

impl AovChoice {
    /// The colour alone.
    pub const NONE: Self = Self::These(AovSet::NONE);

    /// The AOVs that files of this scene hold, without those that its style lacks.
    pub fn set(self, scene: &Scene) -> AovSet {
        let wanted = match self {
            Self::OfScene => aovs_of(scene),
            Self::All => AovSet::ALL,
            Self::These(these) => these,
        };
        wanted.shared(scene.style.settings().aovs())
    }

    /// The same choice, but with this AOV or without it.
    #[must_use]
    pub fn with(self, aov: Aov, is_wanted: bool, scene: &Scene) -> Self {
        let others = self.set(scene).without(aov.into());
        Self::These(if is_wanted { others.with(aov.into()) } else { others })
    }

    /// In words: *No AOVs*, *AOV depth*, *The scene's 3 AOVs*.
    pub fn words(self, scene: &Scene) -> String {
        let set = self.set(scene);
        let aovs = |count: usize| if count == 1 { "1 AOV".to_owned() } else { format!("{count} AOVs") };
        match (self, set.rows().count()) {
            (_, 0) => "No AOVs".to_owned(),
            (Self::OfScene, count) => format!("The scene\u{2019}s {}", aovs(count)),
            (Self::All, count) => format!("All {}", aovs(count)),
            (Self::These(_), 1) => set.rows().map(|row| format!("AOV {}", row.name)).collect(),
            (Self::These(_), count) => aovs(count),
        }
    }

    /// The value of `--aov` for the same files; `None` to leave the option out.
    pub(super) fn command_words(self, scene: &Scene) -> Option<String> {
        let set = self.set(scene);
        match self {
            Self::OfScene => None,
            Self::All => Some("all".to_owned()),
            Self::These(_) if set.is_empty() => Some("none".to_owned()),
            Self::These(_) => Some(set.rows().map(|row| row.name).collect::<Vec<_>>().join(",")),
        }
    }
}

/// What the scene's own `aovs` name. Unknown words are left out: they are reported as problems of the scene.
fn aovs_of(scene: &Scene) -> AovSet {
    let known = scene.aovs.iter().filter_map(|word| AovSet::named(word).ok());
    known.fold(AovSet::NONE, AovSet::with)
}

/// AOVs that belong together.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct AovGroup {
    /// Its name in the sheet.
    pub label: &'static str,
    set: AovSet,
}

impl AovGroup {
    /// All groups, in the order in which they are shown. Every AOV is in one of them.
    pub fn all() -> [Self; 4] {
        let [strokes, mattes] = ["stroke.", "crypto."].map(|begin| {
            let rows = AOVS.iter().filter(|row| row.name.starts_with(begin));
            rows.fold(AovSet::NONE, |set, row| set.with(row.aov.into()))
        });
        let paint = AovSet::ALL.without(AovSet::OF_SCENE).without(strokes).without(mattes);
        [("Scene", AovSet::OF_SCENE), ("Strokes", strokes), ("Paint", paint), ("Mattes", mattes)]
            .map(|(label, set)| Self { label, set })
    }

    /// Its AOVs, each with its words in this group: *angle* for `stroke.angle`.
    pub fn rows(self) -> impl Iterator<Item = (&'static str, &'static AovRow)> {
        self.set.rows().map(|row| (row.name.split_once('.').map_or(row.name, |(_, own)| own), row))
    }
}
