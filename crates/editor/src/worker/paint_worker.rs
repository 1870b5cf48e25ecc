//! What the painting thread does with a job: prepare the scene, draw drafts, then draw exactly.

use std::any::Any;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::Arc;
use std::time::{Duration, Instant};

use egui::ColorImage;
use impasto_editor_model::picking::Picker;
use impasto_gl_render::context::{self, Driver, OpenOptions};
use impasto_gl_render::{RenderError, Renderer};
use impasto_painting::{Frame, Painting, Preparer, Recall};
use impasto_scene::mesh_file::MeshFile;

use super::ahead::Ahead;
use super::draft::DraftSize;
use super::editor_views::EditorViews;
use super::film::{Film, Finished};
use super::mailbox::{Mailbox, Order};
use super::view_frame::{DrawOptions, frame_of, frame_options, styled};
use super::{Picture, Report, ViewJob};
use crate::window::give_back_free_memory;

/// Exact pictures that are not quick to draw are begun when their job is this old and no later job has come.
const REST: Duration = Duration::from_millis(100);

/// Finishing the film of a job begins when the job is this old: by then the user is likely to have paused.
const IDLE: Duration = Duration::from_millis(800);

/// Free memory goes back to the system after a pause of this length.
const PAUSE: Duration = Duration::from_secs(3);

/// Works until the mailbox is closed. If a job panics, that is reported, and the next job gets a new worker.
pub(super) fn run(mailbox: &Mailbox, driver: Driver, wake: &dyn Fn()) {
    let tell = |report: Report| {
        mailbox.report(report);
        wake();
    };
    let mut worker = None;
    let mut work = |order: Option<&Order>| {
        let worked = catch_unwind(AssertUnwindSafe(|| {
            let worker = worker.get_or_insert_with(|| PaintWorker::open(driver, &tell));
            if let Some(order) = order {
                worker.work(order, mailbox, &tell);
            }
        }));
        if let Err(panic) = worked {
            tell(Report::Failed(format!("the picture could not be made: {}", panic_message(panic.as_ref()))));
            let broken = worker.take();
            // A broken driver may panic again when it is dropped.
            let _ = catch_unwind(AssertUnwindSafe(|| drop(broken)));
        }
    };
    // A driver takes time to open, so it is opened before there is anything to draw.
    work(None);
    while let Some(order) = mailbox.take(PAUSE, give_back_free_memory) {
        work(Some(&order));
    }
    let _ = catch_unwind(AssertUnwindSafe(|| drop(worker)));
    mailbox.end();
}

fn panic_message(panic: &(dyn Any + Send)) -> String {
    let text = panic.downcast_ref::<String>().cloned();
    text.or_else(|| panic.downcast_ref::<&str>().map(|text| (*text).to_owned()))
        .unwrap_or_else(|| "no reason was given".to_owned())
}

type Tell<'a> = &'a dyn Fn(Report);

mod preparing;
#[cfg(test)]
mod tests;

struct Prepared {
    painting: Painting,
    serial: u64,
    /// The views that it was prepared for; `None` if it was prepared during a drag.
    seen_from: Option<EditorViews>,
}

struct PaintWorker {
    preparer: Preparer,
    /// The picker is brought up to date here, and the window gets copies of it.
    picker: Picker,
    prepared: Option<Prepared>,
    /// `None` if no driver was found: then scenes are prepared, but nothing is drawn.
    renderer: Option<Renderer>,
    /// The number of the shaders in use, from [`Mailbox::shaders_after`].
    shaders: u64,
    /// The last picture of each view.
    drawn: Vec<Option<Drawn>>,
    draft_size: DraftSize,
    /// The view whose picture the renderer still holds.
    held_view: Option<usize>,
    /// How long the last exact picture took, seconds.
    exact_s: Option<f64>,
    /// The next frame of the playback, which is computed while the present one is drawn.
    ahead: Ahead,
    film: Film,
}

struct Drawn {
    view: ViewJob,
    serial: u64,
    exact: bool,
    /// How many strokes it has, and how many of each region.
    strokes: (usize, Vec<usize>),
    /// What the next draft may recall of this picture; `None` if it has no strokes.
    recall: Option<Arc<Recall>>,
    /// Counts the pictures drawn of the view. The next draft tries some of the strokes that this picture lacks;
    /// [`Recall::of`] picks them by the count. Each view has its own count: if two views shared one, each would only
    /// get every other number.
    turn: u32,
}

impl Drawn {
    fn shows(&self, view: &ViewJob, serial: u64) -> bool {
        self.serial == serial && self.view.looks_like(view)
    }
}

impl PaintWorker {
    fn open(driver: Driver, tell: Tell<'_>) -> Self {
        let renderer = context::open(driver, &OpenOptions::default())
            .map_err(|error| error.to_string())
            .and_then(|context| Renderer::new(context).map_err(|error| error.to_string()));
        let renderer = match renderer {
            Ok(renderer) => {
                tell(Report::Opened(renderer.report().clone()));
                Some(renderer)
            }
            Err(words) => {
                tell(Report::Failed(words));
                None
            }
        };
        Self {
            preparer: Preparer::default(),
            picker: Picker::default(),
            prepared: None,
            renderer,
            shaders: 0,
            drawn: Vec::new(),
            draft_size: DraftSize::default(),
            held_view: None,
            exact_s: None,
            ahead: Ahead::default(),
            film: Film::default(),
        }
    }

    fn work(&mut self, order: &Order, mailbox: &Mailbox, tell: Tell<'_>) {
        self.take_shaders(mailbox, tell);
        let views = &order.job.views;
        self.film.follow(order.job.serial);
        self.drawn.resize_with(views.len(), || None);
        if self.is_new(order) {
            self.show_unpainted(order, tell);
        }
        let Some(mut painting) = self.prepare(order, mailbox, tell) else { return };
        let wanted: Vec<usize> =
            (0..views.len()).filter(|&index| !views[index].size_px.contains(&0)).collect();
        wanted.iter().for_each(|&index| self.redraw_light_icons(order, index, tell));
        wanted.iter().for_each(|&index| self.show_finished(order, index, tell));
        let drafts = wanted.iter().copied().filter(|&index| !self.shows(order, index));
        let drafts: Vec<usize> = drafts.collect();
        let lacking = self.lacking(order);
        if !drafts.is_empty() && (lacking.is_some() || !DraftSize::is_needless(self.exact_s)) {
            let began = Instant::now();
            for &index in &drafts {
                let size_px = self.draft_size.of(views[index].size_px);
                let options = DrawOptions { size_px, is_exact: false, give_up: &|| false };
                if !self.draw(&painting, order, index, &options, tell) {
                    return;
                }
            }
            self.draft_size.took(began.elapsed().as_secs_f64());
        }
        if let Some(views) = lacking {
            if !mailbox.rests(order, REST) {
                return;
            }
            match self.prepare_for(order, Some(views), mailbox, tell) {
                Some(made) => painting = made,
                None if mailbox.is_stale(order) => return,
                None => {}
            }
        }
        let quick = DraftSize::is_needless(self.exact_s);
        let exact = wanted
            .iter()
            .copied()
            .filter(|&index| (quick || !views[index].moving) && !self.shows_exactly(order, index));
        let exact: Vec<usize> = exact.collect();
        if !exact.is_empty() && !quick && !mailbox.rests(order, REST) {
            return;
        }
        for index in exact {
            let give_up = || !quick && mailbox.is_stale(order);
            let options = DrawOptions { size_px: views[index].size_px, is_exact: true, give_up: &give_up };
            if !self.draw(&painting, order, index, &options, tell) {
                return;
            }
        }
        self.finish_film(&painting, order, mailbox, tell);
    }

    /// Shows the film's picture of a view, if there is one and the view is not shown exactly already. The pictures of a
    /// film have no icons of lights. When playback stops, the film's picture stays until one with icons is drawn.
    fn show_finished(&mut self, order: &Order, index: usize, tell: Tell<'_>) {
        let (view, serial) = (&order.job.views[index], order.job.serial);
        if self.shows_exactly(order, index) {
            return;
        }
        let exact = self.film.has(view, serial);
        let shows_no_icons = |drawn: &Drawn| drawn.serial == serial && drawn.view.lights.is_empty();
        if !exact && !self.drawn[index].as_ref().is_some_and(shows_no_icons) {
            return;
        }
        let without_icons = ViewJob { lights: Vec::new(), ..view.clone() };
        let finished = self.film.of(if exact { view } else { &without_icons }, serial);
        let Some(Finished { image, strokes, .. }) = finished else { return };
        // Drafts go on recalling the last picture that was drawn.
        let (recall, turn) = self.drawn[index].take().map_or((None, 0), |drawn| (drawn.recall, drawn.turn));
        let (view, (number, strokes_of)) = (view.clone(), strokes.clone());
        self.drawn[index] = Some(Drawn { view: view.clone(), serial, exact, strokes, recall, turn });
        self.held_view = None;
        let (strokes, seconds) = (number, 0.0);
        tell(Report::Picture(Picture { index, view, serial, image, exact, strokes, strokes_of, seconds }));
    }

    /// Draws the frames of the job's film exactly and keeps them, while nothing else is to be done.
    fn finish_film(&mut self, painting: &Painting, order: &Order, mailbox: &Mailbox, tell: Tell<'_>) {
        let (views, serial) = (&order.later.film, order.job.serial);
        if views.is_empty() {
            return;
        }
        tell(Report::Finished(self.film.frames(views, serial), serial));
        if !mailbox.rests(order, IDLE) {
            return;
        }
        let give_up = || mailbox.is_stale(order);
        for view in views {
            if self.film.has(view, serial) {
                continue;
            }
            let Some(renderer) = &mut self.renderer else { return };
            self.held_view = None;
            renderer.set_billboards(&view.lights);
            let options = DrawOptions { size_px: view.size_px, is_exact: true, give_up: &give_up };
            let (frame, picture) = render(renderer, painting, view, None, &options, None);
            let image = match picture {
                Ok(Some(picture)) => Arc::new(picture),
                Ok(None) => return,
                Err(error) => return tell(Report::Failed(error.to_string())),
            };
            let strokes = (frame.strokes.len(), strokes_per_region(&frame, painting.scene().regions.len()));
            if !self.film.keep(Finished { view: view.clone(), serial, image, strokes }, views) {
                return;
            }
            tell(Report::Finished(self.film.frames(views, serial), serial));
        }
    }

    /// Draws with new shaders from now on, if there are any.
    fn take_shaders(&mut self, mailbox: &Mailbox, tell: Tell<'_>) {
        let Some(renderer) = &mut self.renderer else { return };
        let Some((texts, number)) = mailbox.shaders_after(self.shaders) else { return };
        self.shaders = number;
        match renderer.replace_shaders(&texts) {
            Ok(()) => {
                self.drawn.clear();
                self.film.clear();
            }
            Err(error) => tell(Report::Failed(error.to_string())),
        }
    }

    /// Whether the scene shares no mesh with the scene that was prepared last.
    fn is_new(&self, order: &Order) -> bool {
        let known = |mesh: &Arc<MeshFile>| {
            let before = self.prepared.iter().flat_map(|known| known.painting.loaded().meshes.values());
            before.into_iter().any(|before| Arc::ptr_eq(before, mesh))
        };
        !order.job.loaded.meshes.values().any(known)
    }

    /// Shows a new scene lit but unpainted, in few pixels, until its strokes are prepared. Errors are ignored here:
    /// they come again when the scene is prepared and drawn, and are reported then.
    fn show_unpainted(&mut self, order: &Order, tell: Tell<'_>) {
        let Some(renderer) = &mut self.renderer else { return };
        let Ok(plain) = self.preparer.prepare_plain(&order.job.loaded) else { return };
        for (index, view) in order.job.views.iter().enumerate() {
            if view.size_px.contains(&0) {
                continue;
            }
            let began = Instant::now();
            let size_px = self.draft_size.of(view.size_px);
            let options = DrawOptions { size_px, is_exact: false, give_up: &|| false };
            let frame = plain.bare(&view.camera, view.frame, &frame_options(view, &options));
            self.held_view = None;
            renderer.set_billboards(&view.lights_in(size_px));
            let Ok(picture) = renderer.render(&frame) else { return };
            tell(Report::Picture(Picture {
                index,
                view: view.clone(),
                serial: order.job.serial,
                image: Arc::new(image(picture)),
                exact: false,
                strokes: 0,
                strokes_of: Vec::new(),
                seconds: began.elapsed().as_secs_f64(),
            }));
        }
    }

    /// Redraws only the icons of lights, if nothing else changed since the view's exact picture, and the renderer still
    /// holds that picture.
    fn redraw_light_icons(&mut self, order: &Order, index: usize, tell: Tell<'_>) {
        let (view, serial) = (&order.job.views[index], order.job.serial);
        let (Some(renderer), Some(drawn)) = (&mut self.renderer, &mut self.drawn[index]) else { return };
        let is_there = self.held_view == Some(index) && drawn.serial == serial && drawn.exact;
        if !is_there || drawn.view.looks_like(view) || !drawn.view.differs_in_lights_alone(view) {
            return;
        }
        let began = Instant::now();
        renderer.set_billboards(&view.lights);
        // An error here is reported when the whole picture is drawn again.
        let Ok(Some(picture)) = renderer.with_other_billboards() else { return };
        drawn.view = view.clone();
        let (strokes, strokes_of) = drawn.strokes.clone();
        let (image, seconds) = (Arc::new(image(picture)), began.elapsed().as_secs_f64());
        let view = view.clone();
        tell(Report::Picture(Picture {
            index,
            view,
            serial,
            image,
            exact: true,
            strokes,
            strokes_of,
            seconds,
        }));
    }

    fn shows(&self, order: &Order, index: usize) -> bool {
        let drawn = self.drawn[index].as_ref();
        drawn.is_some_and(|drawn| drawn.shows(&order.job.views[index], order.job.serial))
    }

    fn shows_exactly(&self, order: &Order, index: usize) -> bool {
        self.shows(order, index) && self.drawn[index].as_ref().is_some_and(|drawn| drawn.exact)
    }

    /// Draws one view and reports the picture. Returns whether to go on with the job.
    fn draw(
        &mut self,
        painting: &Painting,
        order: &Order,
        index: usize,
        options: &DrawOptions<'_>,
        tell: Tell<'_>,
    ) -> bool {
        let Some(renderer) = &mut self.renderer else { return false };
        let (view, serial) = (&order.job.views[index], order.job.serial);
        let began = Instant::now();
        let next = order.later.ahead.get(index);
        let ahead = self.ahead.take(serial, view, next, options);
        let (view, frame) = ahead.map_or_else(|| (view.clone(), None), |(view, frame)| (view, Some(frame)));
        let drawn = self.drawn[index].as_ref();
        let turn = drawn.map_or(0, |drawn| drawn.turn.wrapping_add(1));
        let recall = drawn.and_then(|drawn| drawn.recall.clone());
        if let Some(next) = next {
            self.ahead.begin(painting, serial, next, options, recall.clone());
        }
        let recall = recall.as_deref();
        self.held_view = None;
        renderer.set_billboards(&view.lights_in(options.size_px));
        let (frame, picture) = render(renderer, painting, &view, frame, options, recall);
        let strokes = frame.strokes.len();
        let strokes_of = strokes_per_region(&frame, painting.scene().regions.len());
        let picture = match picture {
            Ok(Some(picture)) => picture,
            Ok(None) => return false,
            Err(error) => {
                self.drawn[index] = None;
                tell(Report::Failed(error.to_string()));
                return false;
            }
        };
        let seconds = began.elapsed().as_secs_f64();
        if options.is_exact {
            self.exact_s = Some(seconds);
        }
        let resolved = renderer.resolved_strokes();
        let is_there = |index: usize| resolved.get(index).is_some_and(|stroke| stroke.alpha > 0.0);
        let recall = (strokes > 0).then(|| Arc::new(Recall::of(painting, &frame, is_there, turn)));
        let exact = options.is_exact;
        self.held_view = Some(index);
        let counted = (strokes, strokes_of.clone());
        self.drawn[index] = Some(Drawn { view: view.clone(), serial, exact, strokes: counted, recall, turn });
        let image = Arc::new(picture);
        if exact && order.later.film.iter().any(|of_film| of_film.looks_like(&view)) {
            let (view, image, strokes) = (view.clone(), Arc::clone(&image), (strokes, strokes_of.clone()));
            self.film.keep(Finished { view, serial, image, strokes }, &order.later.film);
        }
        tell(Report::Picture(Picture { index, view, serial, image, exact, strokes, strokes_of, seconds }));
        true
    }
}

fn strokes_per_region(frame: &Frame, regions: usize) -> Vec<usize> {
    let mut counts = vec![0; regions + 1];
    for source in &frame.sources {
        counts[(source.region as usize).min(regions)] += 1;
    }
    counts
}

/// Draws a view. Returns its frame, which was `computed` ahead or is computed now, and the picture; `None` in place of
/// the picture if drawing was given up.
fn render(
    renderer: &mut Renderer,
    painting: &Painting,
    view: &ViewJob,
    computed: Option<Frame>,
    options: &DrawOptions<'_>,
    recall: Option<&Recall>,
) -> (Frame, Result<Option<ColorImage>, RenderError>) {
    let (frame, picture) = match computed {
        None if !options.is_exact => {
            // Drafts are not given up, so strokes can be computed while the driver already works on the bare frame.
            let painting = styled(painting, view.shading);
            let options = frame_options(view, options);
            let mut frame = painting.bare(&view.camera, view.frame, &options);
            let strokes = || painting.strokes(&view.camera, view.frame, &options, recall);
            let picture = renderer.render_with(&mut frame, strokes).map(Some);
            (frame, picture)
        }
        computed => {
            let frame = computed.unwrap_or_else(|| frame_of(painting, view, options, None));
            let picture = if options.is_exact {
                renderer.render_unless(&frame, &mut || (options.give_up)())
            } else {
                renderer.render(&frame).map(Some)
            };
            (frame, picture)
        }
    };
    (frame, picture.map(|picture| picture.map(image)))
}

/// A picture as egui takes it. The window's pictures are opaque, so it does not matter that egui expects premultiplied
/// alpha.
fn image(picture: impasto_gl_render::Picture) -> ColorImage {
    ColorImage::from_rgba_premultiplied(picture.size_px.map(|side| side as usize), &picture.rgba8)
}
