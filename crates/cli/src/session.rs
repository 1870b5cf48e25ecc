//! Steps that several commands share: reading a scene, preparing it, opening a renderer.

use std::sync::Arc;

use impasto_gl_render::Renderer;
use impasto_gl_render::context::{Driver, OpenOptions, open};
use impasto_painting::{FindKept, KeptKey, Painting, PrepareError, PrepareOptions, Preparer, SeenFrom};
use impasto_scene::assets::AssetFolders;
use impasto_scene::load::{LoadOptions, load};
use impasto_scene::loaded::LoadedScene;
use impasto_scene::memory;

use crate::args::DriverChoice;
use crate::cache::{Cache, Storing};
use crate::failure::Failure;
use crate::scene_args::SceneArguments;
use crate::talk::Loudness;

/// Reads a scene. Each warning goes to stderr once, unless `quiet`.
pub(crate) fn read_scene(arguments: &SceneArguments, quiet: bool) -> Result<LoadedScene, Failure> {
    if let Some(threads) = arguments.threads {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads.clamp(1, 1024)).build_global();
        pool.map_err(|error| Failure::Other(error.to_string()))?;
    }
    let overrides: Result<Vec<(String, String)>, Failure> = arguments
        .set
        .iter()
        .map(|text| match text.split_once('=') {
            Some((path, value)) => Ok((path.trim().to_owned(), value.trim().to_owned())),
            None => Err(Failure::Usage(format!(
                "--set {text}: write it as PATH=VALUE, such as strokes.width_px=12"
            ))),
        })
        .collect();
    let options = LoadOptions {
        folders: AssetFolders::with(arguments.asset_dirs.clone()),
        overrides: overrides?,
        placing: arguments.placing.of(&arguments.scene)?,
    };
    let loaded = load(&arguments.scene, &options)?;
    if !quiet {
        let mut printed = std::collections::BTreeSet::new();
        for warning in &loaded.warnings {
            let words = warning.to_string();
            if printed.insert(words.clone()) {
                eprintln!("{words}");
            }
        }
    }
    Ok(loaded)
}

pub(crate) struct Prepared {
    pub(crate) painting: Painting,
    /// Stores the painting in the cache on another thread. Dropping this waits until it is stored.
    pub(crate) storing: Storing,
}

/// What to prepare if pictures are drawn from these views.
pub(crate) fn for_pictures(seen_from: SeenFrom<'_>) -> PrepareOptions<'_> {
    PrepareOptions { seen_from, only_shown: true, ..PrepareOptions::default() }
}

/// Prepares a scene within its memory limit. With [`Loudness::Steps`] the time and peak memory of each step go to
/// stderr.
pub(crate) fn prepare_scene(
    loaded: LoadedScene,
    arguments: &SceneArguments,
    wanted: PrepareOptions<'_>,
    loudness: Loudness,
) -> Result<Prepared, Failure> {
    let memory_bytes = memory::granted_bytes(arguments.memory);
    let cache = Cache::of(&arguments.cache, memory_bytes, loudness);
    let verbose = loudness == Loudness::Steps;
    let options = PrepareOptions {
        memory_bytes,
        peak_bytes: if verbose { &memory::peak_since_last_bytes } else { &|| None },
        ..wanted
    };
    let painting = prepare_with(&mut Preparer::default(), Arc::new(loaded), options, cache.as_ref())?;
    if verbose {
        let total: f64 = painting.steps().iter().map(|step| step.seconds).sum();
        let particles = painting.particle_total();
        eprintln!("prepared {particles} particles in {:.0} ms", total * 1e3);
        for step in painting.steps() {
            let share = 100.0 * step.seconds / total;
            let peak = step.peak_bytes.map_or_else(String::new, |bytes| format!("{:>7} MiB", bytes >> 20));
            eprintln!("  {:<12}{:>8.1} ms {share:>5.1} %{peak}", step.name, step.seconds * 1e3);
        }
    }
    let storing = cache.map_or_else(Storing::default, |cache| cache.store(&painting));
    Ok(Prepared { painting, storing })
}

/// As [`prepare_scene`], by a preparer that may know an earlier state of the scene. The cache is used only if the
/// preparer is new.
pub(crate) fn prepare_by(
    preparer: &mut Preparer,
    loaded: Arc<LoadedScene>,
    arguments: &SceneArguments,
    wanted: PrepareOptions<'_>,
) -> Result<Prepared, Failure> {
    let memory_bytes = memory::granted_bytes(arguments.memory);
    // Later states of the scene are not kept in the cache: the preparer remembers what it needs.
    let cache = Cache::of(&arguments.cache, memory_bytes, Loudness::Warnings).filter(|_| preparer.is_new());
    let options = PrepareOptions { memory_bytes, ..wanted };
    let painting = prepare_with(preparer, loaded, options, cache.as_ref())?;
    let storing = cache.map_or_else(Storing::default, |cache| cache.store(&painting));
    Ok(Prepared { painting, storing })
}

fn prepare_with(
    preparer: &mut Preparer,
    loaded: Arc<LoadedScene>,
    options: PrepareOptions<'_>,
    cache: Option<&Cache>,
) -> Result<Painting, Failure> {
    let find = cache.map(|cache| |key: &KeptKey| cache.find(key));
    let kept = find.as_ref().map(|find| find as &FindKept<'_>);
    preparer.prepare_with(loaded, &PrepareOptions { kept, ..options }).map_err(unprepared)
}

fn unprepared(error: PrepareError) -> Failure {
    match error {
        PrepareError::Memory { .. } => Failure::Refused(format!("{error}, or more with --memory")),
        _ => Failure::Refused(error.to_string()),
    }
}

/// Opens a renderer. If `verbose`, says on stderr which driver was taken and why.
pub(crate) fn open_renderer(driver: DriverChoice, verbose: bool) -> Result<Renderer, Failure> {
    let context = open(self::driver(driver), &OpenOptions::default())?;
    if verbose {
        eprintln!("driver: {}", context.report());
    }
    Ok(Renderer::new(context)?)
}

pub(crate) fn driver(choice: DriverChoice) -> Driver {
    match choice {
        DriverChoice::Auto => Driver::Auto,
        DriverChoice::Egl => Driver::Egl,
        DriverChoice::Osmesa => Driver::Osmesa,
    }
}
