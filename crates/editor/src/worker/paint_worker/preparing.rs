//! Prepares the scenes of jobs, and prepares them again for views in which large surfaces may lack particles.

use std::sync::Arc;

use impasto_painting::{Painting, PrepareError, PrepareOptions, SeenFrom};

use super::super::Report;
use super::super::ahead::Ahead;
use super::super::editor_views::{EditorViews, is_moving};
use super::super::mailbox::{Mailbox, Order};
use super::{PaintWorker, Prepared, Tell};

impl PaintWorker {
    /// The painting of an order's scene. During a drag, large surfaces keep the particles that they have.
    pub(super) fn prepare(&mut self, order: &Order, mailbox: &Mailbox, tell: Tell<'_>) -> Option<Painting> {
        if let Some(known) = self.prepared.as_ref().filter(|known| known.serial == order.job.serial) {
            return Some(known.painting.clone());
        }
        let views = (!is_moving(order)).then(|| EditorViews::of(order));
        self.prepare_for(order, views, mailbox, tell)
    }

    /// The views of an order at rest, if its scene was prepared for other views. Large surfaces may then lack
    /// particles.
    pub(super) fn lacking(&self, order: &Order) -> Option<EditorViews> {
        let known = self.prepared.as_ref().filter(|known| known.serial == order.job.serial)?;
        if is_moving(order) || !known.painting.depends_on_views() {
            return None;
        }
        let views = EditorViews::of(order);
        (known.seen_from.as_ref() != Some(&views)).then_some(views)
    }

    /// Prepares an order's scene for these views. During a drag, `views` is `None`. Returns `None` if preparing was
    /// given up or failed.
    pub(super) fn prepare_for(
        &mut self,
        order: &Order,
        views: Option<EditorViews>,
        mailbox: &Mailbox,
        tell: Tell<'_>,
    ) -> Option<Painting> {
        let serial = order.job.serial;
        let is_again = self.prepared.as_ref().is_some_and(|known| known.serial == serial);
        // If there is a painting of this scene already, a newer job may interrupt.
        let give_up = || mailbox.gives_up(order) || is_again && mailbox.is_stale(order);
        let options = PrepareOptions {
            give_up: &give_up,
            memory_bytes: impasto_scene::memory::available_bytes(),
            seen_from: views.as_ref().map_or(SeenFrom::AsBefore, EditorViews::seen_from),
            ..PrepareOptions::default()
        };
        match self.preparer.prepare_with(Arc::clone(&order.job.loaded), &options) {
            Ok(painting) => {
                let is_same = |known: &Prepared| known.painting.has_particles_of(&painting);
                if is_again && !self.prepared.as_ref().is_some_and(is_same) {
                    // Pictures of the previous painting lack strokes.
                    self.drawn.iter_mut().flatten().for_each(|drawn| drawn.exact = false);
                    self.film.clear();
                    self.ahead = Ahead::default();
                    self.held_view = None;
                }
                self.prepared = Some(Prepared { painting: painting.clone(), serial, seen_from: views });
                let frame = order.job.views.first().map_or(0.0, |view| view.frame);
                self.picker.follow(&painting, frame);
                tell(Report::Prepared(Box::new((painting.clone(), self.picker.clone())), serial));
                Some(painting)
            }
            Err(PrepareError::GivenUp) => None,
            Err(error) => {
                match self.prepared.as_mut().filter(|_| is_again) {
                    // The painting of this scene that is there already stays in use. For these views it is not prepared
                    // again, which would only fail again.
                    Some(known) => known.seen_from = views,
                    None => tell(Report::Failed(error.to_string())),
                }
                None
            }
        }
    }
}
