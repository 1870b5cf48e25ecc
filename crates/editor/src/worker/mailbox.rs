//! The mailbox between the window and the painting thread. The window puts in the latest job. The thread puts in the
//! results, which wait until the window polls them.

use std::collections::BTreeMap;
use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::{Arc, Condvar, Mutex, MutexGuard, PoisonError};
use std::time::{Duration, Instant};

use impasto_editor_model::picking::Picker;
use impasto_gl_render::ShaderTexts;
use impasto_gl_render::context::ContextReport;
use impasto_painting::Painting;

use super::{Job, Later, Picture, Report};

/// At most this many failures wait to be polled; further ones are dropped.
const MOST_FAILURES: usize = 8;

#[derive(Default)]
pub(super) struct Mailbox {
    orders: Mutex<Orders>,
    changed: Condvar,
    tray: Mutex<Tray>,
    /// The ticket of the last job; `u64::MAX` once closed.
    newest: AtomicU64,
    /// Preparing is stopped for jobs up to this ticket.
    stopped: AtomicU64,
}

#[derive(Default)]
struct Orders {
    job: Option<Order>,
    closed: bool,
    ended: bool,
    /// The shaders that replace the program's own, and how often they were set.
    shaders: (Arc<ShaderTexts>, u64),
}

#[derive(Default)]
struct Tray {
    opened: Option<ContextReport>,
    prepared: Option<(Box<(Painting, Picker)>, u64)>,
    pictures: BTreeMap<usize, Picture>,
    finished: Option<(Vec<i64>, u64)>,
    failures: Vec<String>,
}

/// A job with its ticket: a number that grows with each job.
pub(super) struct Order {
    pub(super) job: Job,
    pub(super) came: Instant,
    pub(super) later: Later,
    ticket: u64,
}

impl Mailbox {
    pub(super) fn put(&self, job: Job, later: Later) {
        let mut orders = lock(&self.orders);
        if orders.closed {
            return;
        }
        let ticket = self.newest.load(Ordering::Relaxed) + 1;
        orders.job = Some(Order { job, came: Instant::now(), later, ticket });
        self.newest.store(ticket, Ordering::Release);
        self.changed.notify_all();
    }

    pub(super) fn put_shaders(&self, texts: ShaderTexts) {
        let mut orders = lock(&self.orders);
        orders.shaders = (Arc::new(texts), orders.shaders.1 + 1);
    }

    /// The shaders to draw with, and their number; `None` if they are still those of `number`.
    pub(super) fn shaders_after(&self, number: u64) -> Option<(Arc<ShaderTexts>, u64)> {
        let (texts, latest) = lock(&self.orders).shaders.clone();
        (latest != number).then_some((texts, latest))
    }

    /// Waits for the next job; `None` once closed. If none comes `within` this time, `pause` is called once.
    pub(super) fn take(&self, within: Duration, pause: impl FnOnce()) -> Option<Order> {
        let nothing = |orders: &mut Orders| orders.job.is_none() && !orders.closed;
        let waited = self.changed.wait_timeout_while(lock(&self.orders), within, nothing);
        let (mut orders, timeout) = waited.unwrap_or_else(PoisonError::into_inner);
        if timeout.timed_out() {
            drop(orders);
            pause();
            let waited = self.changed.wait_while(lock(&self.orders), nothing);
            orders = waited.unwrap_or_else(PoisonError::into_inner);
        }
        if orders.closed { None } else { orders.job.take() }
    }

    /// Whether a later job has come, or the mailbox is closed.
    pub(super) fn is_stale(&self, order: &Order) -> bool {
        self.newest.load(Ordering::Acquire) != order.ticket
    }

    /// Stops preparing the last job, and those before it.
    pub(super) fn stop_preparing(&self) {
        self.stopped.store(self.newest.load(Ordering::Acquire), Ordering::Release);
    }

    /// Whether to give up preparing this job: it was stopped, or the mailbox is closed.
    pub(super) fn gives_up(&self, order: &Order) -> bool {
        let is_closed = self.newest.load(Ordering::Acquire) == u64::MAX;
        is_closed || self.stopped.load(Ordering::Acquire) >= order.ticket
    }

    /// Waits until a job is `age` old. Returns true then, and false as soon as a later job comes or the mailbox is
    /// closed.
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
            Report::Finished(frames, serial) => tray.finished = Some((frames, serial)),
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
        let finished = tray.finished.into_iter().map(|(frames, serial)| Report::Finished(frames, serial));
        let all = opened.chain(prepared).chain(pictures).chain(finished);
        all.chain(tray.failures.into_iter().map(Report::Failed)).collect()
    }

    pub(super) fn close(&self) {
        let mut orders = lock(&self.orders);
        orders.closed = true;
        // Under the lock: a thread that is about to wait for a later job would miss the notice otherwise.
        self.newest.store(u64::MAX, Ordering::Release);
        self.changed.notify_all();
    }

    /// Marks that the thread has ended.
    pub(super) fn end(&self) {
        lock(&self.orders).ended = true;
        self.changed.notify_all();
    }

    /// Waits for the thread to end, at most this long; returns whether it has.
    pub(super) fn wait_for_end(&self, most: Duration) -> bool {
        let orders = lock(&self.orders);
        let waited = self.changed.wait_timeout_while(orders, most, |orders| !orders.ended);
        waited.unwrap_or_else(PoisonError::into_inner).0.ended
    }
}

/// Locks, and ignores poisoning: no code that holds a lock here can panic and leave the data half changed.
fn lock<T>(mutex: &Mutex<T>) -> MutexGuard<'_, T> {
    mutex.lock().unwrap_or_else(PoisonError::into_inner)
}
