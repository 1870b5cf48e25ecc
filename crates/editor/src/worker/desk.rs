//! What the window and the thread pass each other: one job, the latest, and a tray of what has been done.

use std::collections::BTreeMap;
use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::{Arc, Condvar, Mutex, MutexGuard, PoisonError};
use std::time::{Duration, Instant};

use impasto_editor_model::picking::Picker;
use impasto_gl_render::ShaderTexts;
use impasto_gl_render::context::ContextReport;
use impasto_painting::Painting;

use super::{Job, Picture, Report, ViewJob};

/// Words that nobody has read yet are kept up to this many.
const MOST_FAILURES: usize = 8;

/// Shared by both threads.
#[derive(Default)]
pub(super) struct Desk {
    orders: Mutex<Orders>,
    changed: Condvar,
    tray: Mutex<Tray>,
    /// The ticket of the last job that was put down; `u64::MAX` once closed.
    newest: AtomicU64,
    /// The ticket of the last job whose preparing was stopped.
    stopped: AtomicU64,
}

#[derive(Default)]
struct Orders {
    job: Option<Order>,
    closed: bool,
    ended: bool,
    /// What stands in for the program's own shaders, and how often that was said.
    shaders: (Arc<ShaderTexts>, u64),
}

#[derive(Default)]
struct Tray {
    opened: Option<ContextReport>,
    prepared: Option<(Box<(Painting, Picker)>, u64)>,
    pictures: BTreeMap<usize, Picture>,
    failures: Vec<String>,
}

/// A job with its place among all.
pub(super) struct Order {
    pub(super) job: Job,
    pub(super) came: Instant,
    /// The views that will likely be asked for next, while a film plays.
    pub(super) ahead: Vec<ViewJob>,
    ticket: u64,
}

impl Desk {
    pub(super) fn put(&self, job: Job, ahead: Vec<ViewJob>) {
        let mut orders = lock(&self.orders);
        if orders.closed {
            return;
        }
        let ticket = self.newest.load(Ordering::Relaxed) + 1;
        orders.job = Some(Order { job, came: Instant::now(), ahead, ticket });
        self.newest.store(ticket, Ordering::Release);
        self.changed.notify_all();
    }

    pub(super) fn put_shaders(&self, texts: ShaderTexts) {
        let mut orders = lock(&self.orders);
        orders.shaders = (Arc::new(texts), orders.shaders.1 + 1);
    }

    /// What shaders are to be drawn with, where that is another than the one of this number; with its own number.
    pub(super) fn shaders_after(&self, number: u64) -> Option<(Arc<ShaderTexts>, u64)> {
        let (texts, latest) = lock(&self.orders).shaders.clone();
        (latest != number).then_some((texts, latest))
    }

    /// Waits for the next job; `None` once closed.
    pub(super) fn take(&self) -> Option<Order> {
        let orders = lock(&self.orders);
        let mut orders = self
            .changed
            .wait_while(orders, |orders| orders.job.is_none() && !orders.closed)
            .unwrap_or_else(PoisonError::into_inner);
        if orders.closed { None } else { orders.job.take() }
    }

    /// Whether a later job lies on the desk, or the desk is closed.
    pub(super) fn is_stale(&self, order: &Order) -> bool {
        self.newest.load(Ordering::Acquire) != order.ticket
    }

    /// The job that was put down last is not to be prepared to its end.
    pub(super) fn stop_preparing(&self) {
        self.stopped.store(self.newest.load(Ordering::Acquire), Ordering::Release);
    }

    /// Whether preparing this job is given up: it was stopped, or the desk is closed.
    pub(super) fn gives_up(&self, order: &Order) -> bool {
        let is_closed = self.newest.load(Ordering::Acquire) == u64::MAX;
        is_closed || self.stopped.load(Ordering::Acquire) >= order.ticket
    }

    /// Waits until a job is this old. Returns whether no later one came.
    pub(super) fn rests(&self, order: &Order, age: Duration) -> bool {
        let until = order.came + age;
        let mut orders = lock(&self.orders);
        loop {
            let left = until.saturating_duration_since(Instant::now());
            if self.is_stale(order) || left.is_zero() {
                return !self.is_stale(order);
            }
            (orders, _) = self.changed.wait_timeout(orders, left).unwrap_or_else(PoisonError::into_inner);
        }
    }

    pub(super) fn report(&self, report: Report) {
        let mut tray = lock(&self.tray);
        match report {
            Report::Opened(context) => tray.opened = Some(context),
            Report::Prepared(painting, serial) => tray.prepared = Some((painting, serial)),
            Report::Picture(picture) => {
                tray.pictures.insert(picture.index, picture);
            }
            Report::Failed(words) => {
                if tray.failures.len() < MOST_FAILURES && tray.failures.last() != Some(&words) {
                    tray.failures.push(words);
                }
            }
        }
    }

    pub(super) fn collect(&self) -> Vec<Report> {
        let tray = std::mem::take(&mut *lock(&self.tray));
        let opened = tray.opened.into_iter().map(Report::Opened);
        let prepared = tray.prepared.into_iter().map(|(painting, serial)| Report::Prepared(painting, serial));
        let pictures = tray.pictures.into_values().map(Report::Picture);
        opened.chain(prepared).chain(pictures).chain(tray.failures.into_iter().map(Report::Failed)).collect()
    }

    pub(super) fn close(&self) {
        lock(&self.orders).closed = true;
        self.newest.store(u64::MAX, Ordering::Release);
        self.changed.notify_all();
    }

    /// The thread's last words.
    pub(super) fn end(&self) {
        lock(&self.orders).ended = true;
        self.changed.notify_all();
    }

    /// Waits for them; returns whether they came in time.
    pub(super) fn wait_for_end(&self, most: Duration) -> bool {
        let orders = lock(&self.orders);
        let waited = self.changed.wait_timeout_while(orders, most, |orders| !orders.ended);
        waited.unwrap_or_else(PoisonError::into_inner).0.ended
    }
}

/// No code that holds a lock here can panic half way.
fn lock<T>(mutex: &Mutex<T>) -> MutexGuard<'_, T> {
    mutex.lock().unwrap_or_else(PoisonError::into_inner)
}
