//! `impasto new`: writes a scene file for a model, with the scene that `impasto render MODEL` paints.

use std::path::{Component, Path, PathBuf};

use impasto_frame_files::{not_an_input, ready_folder};
use impasto_scene::load::{LoadOptions, load};
use impasto_scene::{built_in_mesh, save};

use crate::args::NewArguments;
use crate::failure::Failure;

pub(crate) fn run(arguments: &NewArguments) -> Result<(), Failure> {
    if arguments.output.exists() && !arguments.force {
        return Err(Failure::Refused(format!(
            "{} is there already; name another file with -o, or replace it with --force",
            arguments.output.display()
        )));
    }
    if arguments.model.extension().is_some_and(|extension| extension.eq_ignore_ascii_case("ron")) {
        let words =
            format!("{} is a scene already; name a model (.obj, .gltf, .glb)", arguments.model.display());
        return Err(Failure::Refused(words));
    }
    let placing = arguments.placing.of(&arguments.model)?;
    let loaded = load(&arguments.model, &LoadOptions { placing, ..LoadOptions::default() })?;
    for warning in &loaded.warnings {
        eprintln!("{warning}");
    }
    not_an_input(&arguments.output, &loaded.inputs())?;
    let folder = ready_folder(&arguments.output)?;
    let mut scene = loaded.scene.without_shot();
    let mesh = path_from(&folder, &arguments.model)?;
    if let Some(shot) = &mut scene.shot {
        shot.clone_from(&mesh);
    }
    // The backdrop is a built-in mesh, which needs no file.
    for object in scene.objects.iter_mut().filter(|object| !built_in_mesh::is_built_in(&object.mesh)) {
        object.mesh.clone_from(&mesh);
    }
    save::write(&arguments.output, &scene)?;
    if mesh.starts_with("..") {
        eprintln!(
            "impasto: {} lies outside the scene's folder: render it with --asset-dir {}",
            arguments.model.display(),
            arguments
                .model
                .parent()
                .filter(|folder| *folder != Path::new(""))
                .unwrap_or(Path::new("."))
                .display()
        );
    }
    Ok(())
}

/// The path of the model relative to `folder`, with `/`, as a scene in `folder` names it.
fn path_from(folder: &Path, model: &Path) -> Result<String, Failure> {
    let (folder, model) = (folder.canonicalize()?, model.canonicalize()?);
    let (from, to): (Vec<Component<'_>>, Vec<Component<'_>>) =
        (folder.components().collect(), model.components().collect());
    let shared = from.iter().zip(&to).take_while(|(a, b)| a == b).count();
    if shared == 0 {
        let words = format!("{} and {} have no folder in common", folder.display(), model.display());
        return Err(Failure::Refused(words));
    }
    let up = std::iter::repeat_n("..".to_owned(), from.len() - shared);
    let down = to[shared..].iter().map(|part| part.as_os_str().to_string_lossy().into_owned());
    let path: PathBuf = up.chain(down).collect();
    Ok(path.to_string_lossy().replace('\\', "/"))
}
