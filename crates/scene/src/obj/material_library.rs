//! Finds the materials of one OBJ file: reads the MTL files that it names and their pictures, within limits.

use std::collections::{BTreeMap, BTreeSet, HashMap};
use std::path::{Path, PathBuf};
use std::sync::Arc;

use super::MAX_MTL_BYTES;
use super::lint::{Checked, Library};
use super::materials::{self, Described, GREY};
use crate::assets::{Asset, AssetError, AssetFolders, AssetRequest};
use crate::mesh_file::{Material, Texture};
use crate::problem::{Problem, Report, Severity, TextPosition};
use crate::texture;

/// How many different names of MTL files are looked for.
const MAX_LIBRARIES: usize = 256;

/// The most pixels that the pictures of one model may have together: 512 MiB, eight pictures of 4096 x 4096.
const MAX_KEPT_PIXELS: usize = 1 << 27;

/// How many warnings about files that were not found are reported one by one.
const MAX_REPORTED: usize = 20;

/// Gives line and column of a byte of the OBJ text. It walks the text, so ask only for places that are reported.
type PlaceOf<'a> = &'a dyn Fn(usize) -> TextPosition;

/// Where materials and pictures are looked for, and what was found so far.
pub(super) struct MaterialLibrary<'a> {
    path: &'a Path,
    root: &'a Path,
    folders: &'a AssetFolders,
    warnings: Vec<Problem>,
    /// The MTL files that were read.
    libraries: BTreeSet<PathBuf>,
    /// How many files were not found or could not be used; those beyond [`MAX_REPORTED`] are only counted.
    unfound: usize,
    described: HashMap<String, (Described, Arc<PathBuf>)>,
    /// The pictures by MTL file and the name written there, so that each is read and reported once; `None` for one that
    /// could not be used.
    pictures: BTreeMap<(Arc<PathBuf>, String), Option<Arc<Texture>>>,
    kept_pixels: usize,
}

impl<'a> MaterialLibrary<'a> {
    pub fn new(path: &'a Path, root: &'a Path, folders: &'a AssetFolders) -> Self {
        Self {
            path,
            root,
            folders,
            warnings: Vec::new(),
            libraries: BTreeSet::new(),
            unfound: 0,
            described: HashMap::new(),
            pictures: BTreeMap::new(),
            kept_pixels: 0,
        }
    }

    /// All warnings, in the order in which they arose.
    pub fn finish(mut self) -> Vec<Problem> {
        if self.unfound > MAX_REPORTED {
            let message = format!("{} more files like these were not found", self.unfound - MAX_REPORTED);
            let problem = self.warning(None, message, "");
            self.warnings.push(problem);
        }
        self.warnings
    }

    /// One material for each name in `checked`, and one without a name if there are none.
    ///
    /// # Errors
    /// A [`Report`] when a picture claims more than the limits; everything else is a warning.
    pub fn materials(
        &mut self,
        checked: &Checked<'_>,
        place_of: PlaceOf<'_>,
    ) -> Result<Vec<Material>, Report> {
        self.read_libraries(&checked.libraries, place_of);
        self.tell_of_unknown(checked, place_of);
        let mut materials = Vec::new();
        for name in &checked.materials.list {
            let mut material = Material::plain(name.clone(), GREY);
            if let Some((described, mtl)) = self.described.get(name).cloned() {
                let gloss = described.gloss();
                if let Some(picture) = described.picture {
                    material.texture = self.picture(mtl, picture, described.picture_place)?;
                }
                // If the material states no colour, its picture is shown unchanged.
                let otherwise = if material.texture.is_some() { [1.0; 3] } else { GREY };
                material.color = described.color.unwrap_or(otherwise);
                material.gloss = gloss;
            }
            materials.push(material);
        }
        if materials.is_empty() {
            materials.push(Material::plain(String::new(), GREY));
        }
        Ok(materials)
    }

    /// The MTL files and pictures that are named and found, whether faces use them or not. Pictures are not opened.
    pub fn files(mut self, libraries: &[Library], place_of: PlaceOf<'_>) -> BTreeSet<PathBuf> {
        self.read_libraries(libraries, place_of);
        let mut files = std::mem::take(&mut self.libraries);
        for (described, mtl) in self.described.values() {
            let Some(name) = &described.picture else { continue };
            let request =
                AssetRequest { beside: mtl, root: self.root, name, max_bytes: texture::MAX_FILE_BYTES };
            files.extend(self.folders.find(&request));
        }
        files
    }

    fn read_libraries(&mut self, libraries: &[Library], place_of: PlaceOf<'_>) {
        let mut seen: BTreeSet<&str> = BTreeSet::new();
        for library in libraries {
            if !seen.insert(&library.name) {
                continue;
            }
            // The rest of the line is one name with spaces, or several names: it is tried as one first.
            let whole = self.open(&library.name);
            let is_list = library.words.len() > 1;
            if is_list && matches!(whole, Err(AssetError::Missing { .. } | AssetError::Refused { .. })) {
                for word in &library.words {
                    if seen.len() <= MAX_LIBRARIES && seen.insert(word) {
                        let found = self.open(word);
                        self.take_library(found, library.offset, place_of);
                    }
                }
            } else {
                self.take_library(whole, library.offset, place_of);
            }
            if seen.len() > MAX_LIBRARIES {
                let message = format!("more than {MAX_LIBRARIES} files of materials are named");
                let place = Some(place_of(library.offset));
                let problem = self.warning(place, message, "the rest is not read; join them in one file");
                self.warnings.push(problem);
                return;
            }
        }
    }

    fn take_library(&mut self, found: Result<Asset, AssetError>, offset: usize, place_of: PlaceOf<'_>) {
        match found {
            Ok(Asset { path, bytes }) => {
                let (list, warnings) = materials::parse(&path, bytes);
                self.warnings.extend(warnings);
                self.libraries.insert(path.clone());
                let path = Arc::new(path);
                for material in list {
                    let name = material.name.clone();
                    self.described.entry(name).or_insert_with(|| (material, Arc::clone(&path)));
                }
            }
            Err(error) => {
                self.unfound += 1;
                if self.unfound <= MAX_REPORTED {
                    let message = format!("no materials from here: {error}");
                    let problem = self.warning(Some(place_of(offset)), message, error.mend());
                    self.warnings.push(problem);
                }
            }
        }
    }

    /// Gives one warning for all materials that no file describes. If a named file was not found, that was reported,
    /// and there is no warning here.
    fn tell_of_unknown(&mut self, checked: &Checked<'_>, place_of: PlaceOf<'_>) {
        if self.unfound > 0 {
            return;
        }
        let names = &checked.materials.list;
        let unknown = |at: &usize| !names[*at].is_empty() && !self.described.contains_key(&names[*at]);
        let missing: Vec<usize> = (0..names.len()).filter(unknown).collect();
        let Some(&first) = missing.first() else { return };
        let more =
            if missing.len() > 1 { format!(" (and {} more)", missing.len() - 1) } else { String::new() };
        let message = format!("no file describes the material {:?}{more}; grey is used", names[first]);
        let place = checked.material_offsets.get(first).map(|&offset| place_of(offset));
        let problem = self.warning(place, message, "name its MTL file with mtllib");
        self.warnings.push(problem);
    }

    fn warning(&self, place: Option<TextPosition>, message: String, mend: &str) -> Problem {
        let path = self.path.to_owned();
        Problem {
            severity: Severity::Warning,
            path,
            place,
            field_path: Box::default(),
            message,
            mend: mend.to_owned(),
        }
    }

    fn open(&self, name: &str) -> Result<Asset, AssetError> {
        let name = name.trim_matches('"');
        let (beside, root) = (self.path, self.root);
        self.folders.open(&AssetRequest { beside, root, name, max_bytes: MAX_MTL_BYTES })
    }

    /// The picture of this name; `place` is where the MTL file names it.
    fn picture(
        &mut self,
        mtl: Arc<PathBuf>,
        name: String,
        place: Option<TextPosition>,
    ) -> Result<Option<Arc<Texture>>, Report> {
        let key = (mtl, name);
        if let Some(known) = self.pictures.get(&key) {
            return Ok(known.clone());
        }
        let (beside, name) = (key.0.as_path(), key.1.as_str());
        let request = AssetRequest { beside, root: self.root, name, max_bytes: texture::MAX_FILE_BYTES };
        let texture = match texture::read(self.folders, &request) {
            Ok(decoded) => {
                self.warnings.extend(decoded.warnings);
                self.kept_pixels += decoded.texture.rgba8.len();
                if self.kept_pixels > MAX_KEPT_PIXELS {
                    return Err(self.too_many_pixels(beside));
                }
                Some(Arc::new(decoded.texture))
            }
            Err(problem) if problem.severity.is_fatal() => {
                let mut problems = std::mem::take(&mut self.warnings);
                problems.push(problem);
                return Err(Report(problems));
            }
            Err(mut problem) => {
                self.unfound += 1;
                // If the picture cannot be opened, the problem gets the place in the MTL file where the picture is
                // named. Otherwise the problem is in the picture itself, which has no lines.
                if problem.path == *beside {
                    problem.place = place;
                }
                if self.unfound <= MAX_REPORTED {
                    self.warnings.push(problem);
                }
                None
            }
        };
        self.pictures.insert(key, texture.clone());
        Ok(texture)
    }

    fn too_many_pixels(&mut self, mtl: &Path) -> Report {
        let mut problems = std::mem::take(&mut self.warnings);
        problems.push(Problem {
            severity: Severity::Limit,
            path: mtl.to_owned(),
            place: None,
            field_path: Box::default(),
            message: format!("the pictures of this model have more than {MAX_KEPT_PIXELS} pixels altogether"),
            mend: "scale them down: 2048 x 2048 is more than a painting shows".to_owned(),
        });
        Report(problems)
    }
}
