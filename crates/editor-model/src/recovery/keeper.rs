//! The thread that writes copies of unsaved work, so that the window never waits for the disk.

use std::sync::mpsc::{self, Receiver, Sender};
use std::thread::JoinHandle;

use impasto_scene::whole_file::failure_in_words;

use super::{Offer, Recovery, Work};

/// Writes copies on a thread of its own, in order.
#[derive(Debug)]
pub struct Keeper {
    orders: Option<Sender<Order>>,
    done: Receiver<Kept>,
    thread: Option<JoinHandle<()>>,
}

/// The result of an order. There is one for each copy that was written, and for each order that failed.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Kept {
    /// The copy was written. The number is the time when it was made, seconds since 1970.
    At(u64),
    /// The copy could not be written, removed or taken over, for this reason.
    Not(String),
}

enum Order {
    Keep(Box<Work>),
    Forget,
    TakeOver(Box<Offer>),
}

impl Keeper {
    /// Starts a thread that writes the copies of one session.
    ///
    /// # Errors
    /// If the system cannot start a thread.
    pub fn new(recovery: Recovery) -> std::io::Result<Self> {
        let (orders, to_do) = mpsc::channel();
        let (told, done) = mpsc::channel();
        let thread = std::thread::Builder::new()
            .name("copies".to_owned())
            .spawn(move || work(&recovery, &to_do, &told))?;
        Ok(Self { orders: Some(orders), done, thread: Some(thread) })
    }

    /// Orders a copy of this work, and does not wait for it.
    pub fn keep(&self, work: Work) {
        self.order(Order::Keep(Box::new(work)));
    }

    /// Removes the copy, because its work was saved or discarded.
    pub fn forget(&self) {
        self.order(Order::Forget);
    }

    /// Makes an offered copy this session's own, so that work goes on with it.
    pub fn take_over(&self, offer: Offer) {
        self.order(Order::TakeOver(Box::new(offer)));
    }

    /// The results since the last call.
    pub fn done(&self) -> Vec<Kept> {
        self.done.try_iter().collect()
    }

    fn order(&self, order: Order) {
        // Sending cannot fail: the thread runs until this sender is dropped.
        if let Some(orders) = &self.orders {
            let _ = orders.send(order);
        }
    }
}

impl Drop for Keeper {
    /// Waits until all orders are done. The copy stays, unless [`Keeper::forget`] removed it.
    fn drop(&mut self) {
        self.orders = None;
        if let Some(thread) = self.thread.take() {
            let _ = thread.join();
        }
    }
}

fn work(recovery: &Recovery, to_do: &Receiver<Order>, told: &Sender<Kept>) {
    let not = |error: std::io::Error| Kept::Not(failure_in_words(&error));
    while let Ok(mut order) = to_do.recv() {
        // Of several waiting copies, only the last is written.
        let mut next = None;
        while matches!(order, Order::Keep(_)) && next.is_none() {
            match to_do.try_recv() {
                Ok(later @ Order::Keep(_)) => order = later,
                Ok(other) => next = Some(other),
                Err(_) => break,
            }
        }
        for order in [Some(order), next].into_iter().flatten() {
            let kept = match order {
                Order::Keep(work) => match recovery.keep(&work) {
                    Ok(()) => Kept::At(work.copy.at_unix_secs),
                    Err(error) => not(error),
                },
                Order::Forget => match recovery.forget() {
                    Ok(()) => continue,
                    Err(error) => not(error),
                },
                Order::TakeOver(offer) => match recovery.take_over(*offer) {
                    Ok(()) => continue,
                    Err(error) => not(error),
                },
            };
            // Sending fails if the receiver is gone: then nobody needs the result.
            let _ = told.send(kept);
        }
    }
}
