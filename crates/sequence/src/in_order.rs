//! Works on jobs on several threads, and takes their results in one by one, in the order of the jobs.

use std::collections::BTreeMap;
use std::sync::{Condvar, Mutex, MutexGuard, PoisonError};

/// How many jobs per thread may be under way or waiting to be taken in: enough that a job that takes twice as long as
/// the others holds up no thread.
const AHEAD: u64 = 2;

/// Does one job after the other on its thread.
pub(crate) type Worker<'a, J, T> = Box<dyn FnMut(J) -> T + 'a>;

pub(crate) struct Workers<'a, J, T> {
    /// The worker of the calling thread.
    pub(crate) own: Worker<'a, J, T>,
    /// How many threads work besides the calling one: the further threads.
    pub(crate) further: usize,
    /// Makes the worker of a further thread, on that thread. If it returns `None`, the other threads do the work.
    pub(crate) open: &'a (dyn Fn() -> Option<Worker<'a, J, T>> + Sync),
}

struct State<I, J, T> {
    jobs: I,
    /// How many jobs were given out, and how many results were taken in.
    begun: u64,
    taken_in: u64,
    /// Results that wait for an earlier one, by the number of their job.
    ready: BTreeMap<u64, (J, T)>,
    /// Whether no more jobs are given out.
    closed: bool,
    /// Whether a thread panicked: the result of its job never comes.
    broken: bool,
}

struct Shared<I, J, T> {
    state: Mutex<State<I, J, T>>,
    changed: Condvar,
    /// How many jobs may be begun and not yet taken in.
    max_open: u64,
}

/// What the calling thread does next.
enum Next<J, T> {
    Work(u64, J),
    TakeIn(J, T),
    Nothing,
}

/// Works on `jobs`, which are asked for as they are needed, and calls `take_in` on this thread with each result, in the
/// order of the jobs. When `take_in` fails, no more jobs are begun.
pub(crate) fn in_order<I, J, T, E>(
    jobs: I,
    mut workers: Workers<'_, J, T>,
    mut take_in: impl FnMut(J, T) -> Result<(), E>,
) -> Result<(), E>
where
    I: Iterator<Item = J> + Send,
    J: Copy + Send,
    T: Send,
{
    let state = State { jobs, begun: 0, taken_in: 0, ready: BTreeMap::new(), closed: false, broken: false };
    let shared = Shared {
        state: Mutex::new(state),
        changed: Condvar::new(),
        max_open: AHEAD * (workers.further as u64 + 1),
    };
    std::thread::scope(|scope| {
        let _closing = Closing(&shared);
        for _ in 0..workers.further {
            let (shared, open) = (&shared, workers.open);
            let run = move || {
                let Some(mut work) = open() else { return };
                while let Some((number, job)) = shared.wait_for_work() {
                    let mut promise = Promise { shared, kept: false };
                    let result = work(job);
                    promise.kept = true;
                    shared.hand_in(number, job, result);
                }
            };
            // If the system gives no more threads, the existing ones do all the work.
            if std::thread::Builder::new().name("frames".to_owned()).spawn_scoped(scope, run).is_err() {
                break;
            }
        }
        loop {
            match shared.next() {
                Next::Work(number, job) => {
                    let result = (workers.own)(job);
                    shared.hand_in(number, job, result);
                }
                Next::TakeIn(job, result) => take_in(job, result)?,
                Next::Nothing => return Ok(()),
            }
        }
    })
}

impl<I: Iterator<Item = J>, J: Copy, T> Shared<I, J, T> {
    /// A poisoned lock is ignored: only the iterator of jobs may panic while it is held, and that panic is passed on.
    fn state(&self) -> MutexGuard<'_, State<I, J, T>> {
        self.state.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Prefers taking in a result to beginning a job, so that few results wait. Blocks only while other threads have
    /// all the jobs that may be begun.
    fn next(&self) -> Next<J, T> {
        let mut state = self.state();
        loop {
            let first = state.taken_in;
            if let Some((job, result)) = state.ready.remove(&first) {
                state.taken_in += 1;
                self.changed.notify_all();
                return Next::TakeIn(job, result);
            }
            if let Some((number, job)) = state.begin(self.max_open) {
                return Next::Work(number, job);
            }
            if state.taken_in == state.begun || state.broken {
                return Next::Nothing;
            }
            state = self.changed.wait(state).unwrap_or_else(PoisonError::into_inner);
        }
    }

    /// For a further thread: the next job with its number; `None` when no more are given out.
    fn wait_for_work(&self) -> Option<(u64, J)> {
        let mut state = self.state();
        loop {
            if let Some(work) = state.begin(self.max_open) {
                return Some(work);
            }
            if state.closed {
                return None;
            }
            state = self.changed.wait(state).unwrap_or_else(PoisonError::into_inner);
        }
    }

    fn hand_in(&self, number: u64, job: J, result: T) {
        self.state().ready.insert(number, (job, result));
        self.changed.notify_all();
    }
}

impl<I: Iterator<Item = J>, J, T> State<I, J, T> {
    fn begin(&mut self, max_open: u64) -> Option<(u64, J)> {
        if self.closed || self.begun - self.taken_in >= max_open {
            return None;
        }
        let Some(job) = self.jobs.next() else {
            self.closed = true;
            return None;
        };
        self.begun += 1;
        Some((self.begun - 1, job))
    }
}

/// On drop, gives out no more jobs, so that the further threads end, even after an error or a panic.
struct Closing<'a, I: Iterator<Item = J>, J: Copy, T>(&'a Shared<I, J, T>);

impl<I: Iterator<Item = J>, J: Copy, T> Drop for Closing<'_, I, J, T> {
    fn drop(&mut self) {
        self.0.state().closed = true;
        self.0.changed.notify_all();
    }
}

/// If this thread panics, tells the others that the result of its job never comes; the scope passes the panic on.
struct Promise<'a, I: Iterator<Item = J>, J: Copy, T> {
    shared: &'a Shared<I, J, T>,
    kept: bool,
}

impl<I: Iterator<Item = J>, J: Copy, T> Drop for Promise<'_, I, J, T> {
    fn drop(&mut self) {
        if !self.kept {
            let mut state = self.shared.state();
            state.broken = true;
            state.closed = true;
            drop(state);
            self.shared.changed.notify_all();
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::sync::atomic::{AtomicI64, Ordering};
    use std::time::Duration;

    /// Of each twenty jobs, later ones take less time, so that results come out of order.
    fn slowly(job: i64) -> i64 {
        std::thread::sleep(Duration::from_micros(400 - 20 * (job as u64 % 20)));
        job * job
    }

    fn workers<'a>(
        further: usize,
        open: &'a (dyn Fn() -> Option<Worker<'a, i64, i64>> + Sync),
    ) -> Workers<'a, i64, i64> {
        Workers { own: Box::new(slowly), further, open }
    }

    #[test]
    fn results_come_in_the_order_of_the_list_and_only_a_few_wait() {
        let (begun, most) = (AtomicI64::new(0), AtomicI64::new(0));
        for further in [0, 1, 3] {
            begun.store(0, Ordering::SeqCst);
            let jobs = (0..200).inspect(|_| {
                begun.fetch_add(1, Ordering::SeqCst);
            });
            let mut seen = Vec::new();
            let open = || Some(Box::new(slowly) as Worker<'_, i64, i64>);
            let done = in_order(jobs, workers(further, &open), |job, result| {
                let waiting = begun.load(Ordering::SeqCst) - seen.len() as i64;
                most.fetch_max(waiting, Ordering::SeqCst);
                seen.push((job, result));
                Ok::<(), ()>(())
            });
            assert_eq!(done, Ok(()));
            assert_eq!(seen, (0..200).map(|job| (job, job * job)).collect::<Vec<_>>());
            let most = most.load(Ordering::SeqCst);
            assert!(most <= 2 * (further as i64 + 1) + 1, "{most} with {further} further threads");
        }
    }

    #[test]
    fn threads_that_cannot_work_are_done_without() {
        let mut count = 0;
        let done = in_order(0..50, workers(3, &|| None), |_, _| {
            count += 1;
            Ok::<(), ()>(())
        });
        assert_eq!((done, count), (Ok(()), 50));
    }

    #[test]
    fn nothing_is_begun_after_a_failure_and_what_came_before_it_is_whole() {
        let begun = AtomicI64::new(0);
        let jobs = (0..1000).inspect(|_| {
            begun.fetch_add(1, Ordering::SeqCst);
        });
        let mut seen = Vec::new();
        let open = || Some(Box::new(slowly) as Worker<'_, i64, i64>);
        let done = in_order(jobs, workers(2, &open), |job, _| {
            seen.push(job);
            if job == 9 { Err("full") } else { Ok(()) }
        });
        assert_eq!(done, Err("full"));
        assert_eq!(seen, (0..10).collect::<Vec<_>>());
        assert!(begun.load(Ordering::SeqCst) <= 10 + 6);
    }

    #[test]
    #[should_panic(expected = "a scoped thread panicked")]
    fn a_thread_that_panics_ends_the_work() {
        let broken = |_: i64| -> i64 { panic!("a frame broke off") };
        let open = || Some(Box::new(broken) as Worker<'_, i64, i64>);
        let _ = in_order(0..1_000_000, workers(1, &open), |_, _| Ok::<(), ()>(()));
    }
}
