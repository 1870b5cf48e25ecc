//! The shipped scenes, each prepared once per run for all tests.

use std::collections::BTreeMap;
use std::sync::{Arc, Mutex, OnceLock};

use impasto_painting::{Painting, prepare};
use impasto_scene::load::{LoadOptions, load};

use crate::command::root;

type Cell = Arc<OnceLock<Arc<Painting>>>;

/// A shipped scene as it is. While one test prepares it, others that ask for it wait.
///
/// # Panics
/// When it does not load or prepare.
pub fn painting(name: &str) -> Arc<Painting> {
    static ALL: Mutex<BTreeMap<String, Cell>> = Mutex::new(BTreeMap::new());
    let cell = {
        let mut all = ALL.lock().unwrap_or_else(std::sync::PoisonError::into_inner);
        Arc::clone(all.entry(name.to_owned()).or_default())
    };
    Arc::clone(cell.get_or_init(|| Arc::new(painting_with(name, &[]))))
}

/// A shipped scene with fields set, as by `--set`.
///
/// # Panics
/// When it does not load or prepare.
pub fn painting_with(name: &str, set: &[(&str, &str)]) -> Painting {
    let overrides = set.iter().map(|&(path, value)| (path.to_owned(), value.to_owned())).collect();
    let options = LoadOptions { overrides, ..LoadOptions::default() };
    let path = root().join("scenes").join(format!("{name}.ron"));
    let loaded = load(&path, &options).unwrap_or_else(|report| panic!("{report}"));
    prepare(Arc::new(loaded)).unwrap_or_else(|error| panic!("{name}: {error}"))
}
