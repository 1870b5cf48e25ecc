//! Exact pictures of a shot's frames, kept in memory and on the disk, so that playing again shows them at full rate.

use std::path::Path;
use std::sync::Arc;

use egui::ColorImage;

use super::ViewJob;
use super::film_file::FilmFile;
use crate::files::preferences::film_folder;

/// Pictures in memory take at most this many bytes while the disk has room for the others: 32 frames of a window of
/// 1280x800. Reading such a frame back from the disk takes about two milliseconds.
const EASY_BYTES: usize = 128 << 20;

/// If the disk has no room, pictures in memory take at most this many bytes: 260 such frames.
const MOST_BYTES: usize = 1 << 30;

/// Pictures go into memory only until they take the available memory divided by this.
const SHARE: u64 = 4;

/// How much memory pictures may take, bytes.
#[derive(Clone, Copy, Debug)]
struct Room {
    /// While the disk has room for the other pictures.
    easy_bytes: usize,
    /// If the disk has no room.
    most_bytes: usize,
}

impl Room {
    fn now() -> Self {
        let share = impasto_scene::memory::available_bytes().map(|bytes| usize::try_from(bytes / SHARE));
        let most_bytes = share.and_then(Result::ok).map_or(MOST_BYTES, |share| share.min(MOST_BYTES));
        Self { easy_bytes: most_bytes.min(EASY_BYTES), most_bytes }
    }
}

/// The exact picture of one frame.
#[derive(Clone)]
pub(super) struct Finished {
    /// What it is a picture of.
    pub(super) view: ViewJob,
    /// The version of its scene.
    pub(super) serial: u64,
    pub(super) image: Arc<ColorImage>,
    /// How many strokes it has, and how many of each region.
    pub(super) strokes: (usize, Vec<usize>),
}

fn bytes_of(view: &ViewJob) -> usize {
    view.size_px.iter().map(|&side| side as usize).product::<usize>() * 4
}

struct Kept {
    view: ViewJob,
    serial: u64,
    strokes: (usize, Vec<usize>),
    place: Place,
}

enum Place {
    Memory(Arc<ColorImage>),
    /// At this byte of the file.
    File(u64),
}

/// The kept pictures, all of one version of the scene.
#[derive(Default)]
pub(super) struct Film {
    /// The oldest first.
    kept: Vec<Kept>,
    /// Holds the pictures for which memory has no room. Made when it is first needed.
    file: Option<FilmFile>,
}

impl Film {
    /// The picture of a view, if it is kept. One that cannot be read any more is forgotten.
    pub(super) fn of(&mut self, view: &ViewJob, serial: u64) -> Option<Finished> {
        let Kept { view: kept, strokes, place, .. } = self.find(view, serial)?;
        let image = match place {
            Place::Memory(image) => Some(Arc::clone(image)),
            Place::File(at) => {
                let file = self.file.as_ref();
                file.and_then(|file| file.get(*at, kept.size_px.map(|side| side as usize))).map(Arc::new)
            }
        };
        let finished =
            image.map(|image| Finished { view: kept.clone(), serial, image, strokes: strokes.clone() });
        if finished.is_none() {
            self.kept.retain(|kept| kept.serial != serial || !kept.view.looks_like(view));
        }
        finished
    }

    /// Drops the pictures of other versions of the scene.
    pub(super) fn follow(&mut self, serial: u64) {
        self.kept.retain(|kept| kept.serial == serial);
        if self.kept.is_empty()
            && let Some(file) = &mut self.file
        {
            file.clear();
        }
    }

    pub(super) fn has(&self, view: &ViewJob, serial: u64) -> bool {
        self.find(view, serial).is_some()
    }

    fn find(&self, view: &ViewJob, serial: u64) -> Option<&Kept> {
        self.kept.iter().find(|kept| kept.serial == serial && kept.view.looks_like(view))
    }

    /// The frames of these views whose pictures are kept, in order.
    pub(super) fn frames(&self, views: &[ViewJob], serial: u64) -> Vec<i64> {
        let kept = views.iter().filter(|view| self.has(view, serial));
        let mut frames: Vec<i64> = kept.map(|view| view.frame as i64).collect();
        frames.sort_unstable();
        frames
    }

    /// Keeps a picture in the first of these places that has room: in memory up to `Room::easy_bytes`, where pictures
    /// that are not `wanted` make way; in the file; in memory up to `Room::most_bytes`. Returns false if none has room.
    pub(super) fn keep(&mut self, finished: Finished, wanted: &[ViewJob]) -> bool {
        self.keep_within(finished, wanted, Room::now(), film_folder().as_deref())
    }

    fn keep_within(
        &mut self,
        finished: Finished,
        wanted: &[ViewJob],
        room: Room,
        folder: Option<&Path>,
    ) -> bool {
        self.follow(finished.serial);
        if self.has(&finished.view, finished.serial) {
            return true;
        }
        let in_memory = |kept: &Kept| matches!(kept.place, Place::Memory(_));
        let mut bytes: usize =
            self.kept.iter().filter(|kept| in_memory(kept)).map(|kept| bytes_of(&kept.view)).sum();
        let is_wanted = |kept: &Kept| wanted.iter().any(|view| kept.view.looks_like(view));
        let own = bytes_of(&finished.view);
        self.kept.retain(|kept| {
            let goes = bytes + own > room.easy_bytes && in_memory(kept) && !is_wanted(kept);
            bytes -= if goes { bytes_of(&kept.view) } else { 0 };
            !goes
        });
        let Finished { view, serial, image, strokes } = finished;
        let within = |most: usize| (bytes + own <= most).then(|| Place::Memory(Arc::clone(&image)));
        let mut place = within(room.easy_bytes).or_else(|| self.file(&image, folder));
        // The file only grows. If it has no room, and nothing in it is wanted any more, it is emptied.
        if place.is_none() && !self.kept.iter().any(|kept| !in_memory(kept) && is_wanted(kept)) {
            self.kept.retain(in_memory);
            if let Some(file) = &mut self.file {
                file.clear();
                place = self.file(&image, folder);
            }
        }
        let place = place.or_else(|| within(room.most_bytes));
        let Some(place) = place else { return false };
        self.kept.push(Kept { view, serial, strokes, place });
        true
    }

    /// Puts a picture into the file.
    fn file(&mut self, image: &ColorImage, folder: Option<&Path>) -> Option<Place> {
        if self.file.is_none() {
            self.file = FilmFile::new(folder?);
        }
        self.file.as_mut()?.put(image).map(Place::File)
    }

    /// Drops all pictures, because the renderer would draw them differently now.
    pub(super) fn clear(&mut self) {
        *self = Self::default();
    }
}

#[cfg(test)]
mod tests {
    use impasto_editor_model::session::Shading;
    use impasto_scene::{motion, new_scene};

    use super::*;

    fn view(frame: f64) -> ViewJob {
        ViewJob {
            camera: motion::camera_at(&new_scene::empty(), 0.0),
            frame,
            size_px: [10, 10],
            shot_height_px: 10.0,
            shading: Shading::Painted,
            lights: Vec::new(),
            moving: false,
        }
    }

    fn room(bytes: usize) -> Room {
        Room { easy_bytes: bytes, most_bytes: bytes }
    }

    fn finished(view: &ViewJob, serial: u64) -> Finished {
        let image = Arc::new(ColorImage::filled([10, 10], egui::Color32::BLACK));
        Finished { view: view.clone(), serial, image, strokes: (0, Vec::new()) }
    }

    #[test]
    fn what_is_not_wanted_any_more_makes_way_and_an_edit_drops_all() {
        let mut film = Film::default();
        let wanted = [1.0, 2.0, 3.0].map(view);
        let room = room(3 * 400);
        for frame in [7.0, 1.0, 2.0] {
            assert!(film.keep_within(finished(&view(frame), 1), &wanted, room, None));
        }
        assert_eq!(film.frames(&wanted, 1), [1, 2]);
        assert!(film.of(&view(7.0), 1).is_some(), "there was room for all");
        assert!(film.keep_within(finished(&wanted[2], 1), &wanted, room, None));
        assert!(film.of(&view(7.0), 1).is_none());
        assert_eq!(film.frames(&wanted, 1), [1, 2, 3]);
        // No wanted picture is dropped to make room.
        assert!(!film.keep_within(finished(&view(4.0), 1), &wanted, room, None));
        assert!(film.keep_within(finished(&wanted[0], 1), &wanted, room, None), "it is kept already");
        // Another look, another version of the scene.
        let shaded = ViewJob { shading: Shading::Shaded, ..view(1.0) };
        assert!(film.of(&shaded, 1).is_none() && film.of(&view(1.0), 2).is_none());
        assert!(film.of(&ViewJob { moving: true, ..view(1.0) }, 1).is_some(), "playing is the same look");
        assert!(film.keep_within(finished(&wanted[0], 2), &wanted, room, None));
        assert_eq!((film.frames(&wanted, 1), film.frames(&wanted, 2)), (Vec::new(), vec![1]));
    }

    #[test]
    fn what_memory_has_no_room_for_goes_to_the_disk_and_comes_back() {
        let folder = tempfile::tempdir().unwrap();
        let place = Some(folder.path());
        let file = Some(FilmFile::within(folder.path(), 4000, 0));
        let mut film = Film { file, ..Film::default() };
        let wanted = [1.0, 2.0, 3.0, 4.0].map(view);
        let picture = |frame: u8| {
            let pixels = (0..100).map(|pixel| egui::Color32::from_rgb(frame, pixel, 7)).collect();
            Arc::new(ColorImage::new([10, 10], pixels))
        };
        for (frame, view) in (1..).zip(&wanted) {
            let finished = Finished { image: picture(frame), ..finished(view, 1) };
            assert!(film.keep_within(finished, &wanted, room(400), place), "frame {frame}");
        }
        assert_eq!(film.frames(&wanted, 1), [1, 2, 3, 4]);
        for (frame, view) in (1..).zip(&wanted) {
            assert_eq!(film.of(view, 1).unwrap().image, picture(frame), "frame {frame}");
        }
        // The file has no name in the folder, so nothing is left there.
        assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), 0);
        assert_eq!(film.file.as_ref().unwrap().used_bytes(), 3 * 400);
        film.follow(2);
        assert_eq!(film.file.as_ref().unwrap().used_bytes(), 0, "another version of the scene drops all");
        assert!(film.keep_within(finished(&wanted[0], 2), &wanted, room(0), place));
        assert_eq!(film.frames(&wanted, 2), [1]);
        assert!(film.of(&wanted[1], 1).is_none());
        // A picture that cannot be read is not kept any more.
        film.file = Some(FilmFile::within(folder.path(), 4000, 0));
        assert!(film.of(&wanted[0], 2).is_none() && film.frames(&wanted, 2).is_empty());
    }

    #[test]
    fn a_full_file_begins_anew_once_nothing_in_it_is_wanted() {
        let folder = tempfile::tempdir().unwrap();
        let mut film = Film { file: Some(FilmFile::within(folder.path(), 800, 0)), ..Film::default() };
        let [old, new] = [[1.0, 2.0, 3.0].map(view), [4.0, 5.0, 6.0].map(view)];
        let keep = |film: &mut Film, view: &ViewJob, wanted: &[ViewJob]| {
            let room = Room { easy_bytes: 0, most_bytes: 400 };
            film.keep_within(finished(view, 1), wanted, room, None)
        };
        let in_memory =
            |film: &Film| film.kept.iter().filter(|kept| matches!(kept.place, Place::Memory(_))).count();
        let kept = old.each_ref().map(|view| keep(&mut film, view, &old));
        assert_eq!((kept, in_memory(&film)), ([true; 3], 1), "the file takes two, and then memory one");
        let kept = new[..2].iter().all(|view| keep(&mut film, view, &new));
        assert_eq!((kept, in_memory(&film)), (true, 0), "the file begins anew before memory is asked");
        assert!(keep(&mut film, &new[2], &new) && in_memory(&film) == 1);
        assert_eq!((film.frames(&old, 1), film.frames(&new, 1)), (Vec::new(), vec![4, 5, 6]));
        // A disk that would be too full takes nothing, but memory does.
        film.file = Some(FilmFile::within(folder.path(), 800, u64::MAX / 2));
        film.follow(2);
        assert!(!film.keep_within(finished(&old[0], 2), &old, room(0), None));
        let room = Room { easy_bytes: 400, most_bytes: 800 };
        let kept = old.each_ref().map(|view| film.keep_within(finished(view, 2), &old, room, None));
        assert_eq!(kept, [true, true, false]);
    }
}
