//! Finds the folders for preferences, copies of unsaved work and cached pictures; reads and writes preferences.

use std::fs;
use std::io::Write as _;
use std::path::{Path, PathBuf};

use etcetera::BaseStrategy as _;
use impasto_scene::assets::{AssetError, read_regular_file};
use impasto_scene::whole_file::{WholeFile, failure_in_words};
use serde::Deserialize;

use super::{Preferences, VERSION};

const FILE: &str = "editor.ron";
const MAX_BYTES: u64 = 1 << 20;

/// The folder of the editor's preferences: `$IMPASTO_CONFIG_DIR`, else `impasto` in the user's config folder; none if
/// the user has no home.
pub fn config_folder() -> Option<PathBuf> {
    match std::env::var_os("IMPASTO_CONFIG_DIR").filter(|folder| !folder.is_empty()) {
        Some(folder) => Some(PathBuf::from(folder)),
        None => Some(etcetera::choose_base_strategy().ok()?.config_dir().join("impasto")),
    }
}

/// The folder of copies of unsaved work: `recovery` in `$IMPASTO_CONFIG_DIR`. If that is not set, `impasto/recovery`
/// in the user's state folder, or in the data folder where the system has no state folder. None if the user has no
/// home.
pub fn recovery_folder() -> Option<PathBuf> {
    let folder = match std::env::var_os("IMPASTO_CONFIG_DIR").filter(|folder| !folder.is_empty()) {
        Some(folder) => PathBuf::from(folder),
        None => {
            let places = etcetera::choose_base_strategy().ok()?;
            places.state_dir().unwrap_or_else(|| places.data_dir()).join("impasto")
        }
    };
    Some(folder.join("recovery"))
}

/// The folder for pictures that a window keeps while it is open: `cache` in `$IMPASTO_CONFIG_DIR`. If that is not set,
/// `impasto` in the user's cache folder. None if the user has no home.
pub fn film_folder() -> Option<PathBuf> {
    match std::env::var_os("IMPASTO_CONFIG_DIR").filter(|folder| !folder.is_empty()) {
        Some(folder) => Some(PathBuf::from(folder).join("cache")),
        None => Some(etcetera::choose_base_strategy().ok()?.cache_dir().join("impasto")),
    }
}

/// Preferences as they were read.
#[derive(Clone, Debug, PartialEq)]
pub struct Loaded {
    /// The preferences to use.
    pub preferences: Preferences,
    /// A note for the user, if the file could not be used: why, and where it is now.
    pub note: Option<String>,
}

/// Why preferences were not written.
#[derive(Debug, thiserror::Error)]
pub enum PreferencesError {
    /// The file could not be written.
    #[error("the preferences could not be kept in {}: {}", folder.display(), failure_in_words(source))]
    Unwritable {
        /// The config folder.
        folder: PathBuf,
        /// What the system said.
        source: std::io::Error,
    },
    /// The preferences could not be turned into RON.
    #[error("the preferences could not be written down: {0}")]
    NoText(#[from] ron::Error),
}

#[derive(Deserialize)]
struct VersionOnly {
    #[serde(default = "this_version")]
    version: u32,
}

fn this_version() -> u32 {
    VERSION
}

/// Reads the preferences in a folder. Never fails: if the file cannot be used, or a newer Impasto wrote it, the
/// defaults are used, and the file is renamed to `editor.ron.bad` if that is possible.
pub fn load(folder: &Path) -> Loaded {
    let path = folder.join(FILE);
    let why = match read_regular_file(&path, MAX_BYTES) {
        Ok(bytes) => match parse(&bytes) {
            Ok(mut preferences) => {
                preferences.settle();
                return Loaded { preferences, note: None };
            }
            Err(why) => why,
        },
        Err(AssetError::Missing { .. }) => return Loaded { preferences: Preferences::default(), note: None },
        Err(error) => error.to_string(),
    };
    let kept = folder.join(format!("{FILE}.bad"));
    let ending = match fs::rename(&path, &kept) {
        Ok(()) => format!("it is kept as {}", kept.display()),
        Err(error) => format!("it could not be set aside ({error})"),
    };
    let note =
        format!("Preferences are the default ones: {} cannot be used: {why}; {ending}", path.display());
    Loaded { preferences: Preferences::default(), note: Some(note) }
}

fn parse(bytes: &[u8]) -> Result<Preferences, String> {
    let text = std::str::from_utf8(bytes).map_err(|_| "it is no text".to_owned())?;
    let VersionOnly { version } = ron::from_str(text).map_err(|error| error.to_string())?;
    if version > VERSION {
        return Err(format!("a newer Impasto wrote it (layout {version}; this one reads {VERSION})"));
    }
    ron::from_str(text).map_err(|error| error.to_string())
}

/// Writes the preferences into a folder, which is created if it is missing. At any moment the file is the whole old
/// one or the whole new one.
///
/// # Errors
/// [`PreferencesError`]; the old file is untouched.
pub fn save(folder: &Path, preferences: &Preferences) -> Result<(), PreferencesError> {
    let layout = ron::ser::PrettyConfig::new().depth_limit(3);
    let text = ron::ser::to_string_pretty(preferences, layout)?;
    let write = || -> std::io::Result<()> {
        fs::create_dir_all(folder)?;
        let mut file = WholeFile::create_private(&folder.join(FILE))?;
        writeln!(file, "{text}")?;
        file.finish()
    };
    write().map_err(|source| PreferencesError::Unwritable { folder: folder.to_owned(), source })
}
