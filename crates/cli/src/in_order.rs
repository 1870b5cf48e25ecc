//! Work on several threads whose results are taken in one after the other, in the order of the list.

use std::collections::BTreeMap;
use std::sync::{Condvar, Mutex, MutexGuard, PoisonError};

/// Results that may wait or be under way, for each thread: enough that nobody waits for a single slow one.
const AHEAD: u64 = 2;

/// What one more thread works with; it is made on that thread.
pub(crate) type Worker<'a, T> = Box<dyn FnMut(i64) -> T + 'a>;

/// Who does the work.
pub(crate) struct Workers<'a, T> {
    /// On this thread.
    pub(crate) own: Worker<'a, T>,
    /// How many more threads.
    pub(crate) helpers: usize,
    /// What a helper works with; where there is none, the others do its share.
    pub(crate) open: &'a (dyn Fn() -> Option<Worker<'a, T>> + Sync),
}

struct State<I, T> {
    jobs: I,
    /// How many jobs were taken, and how many results were taken in.
    taken: u64,
    done: u64,
    /// Results that wait for an earlier one, by the number of their job.
    ready: BTreeMap<u64, (i64, T)>,
    /// No more jobs are given out.
    closed: bool,
    /// A thread broke off: its result never comes.
    broken: bool,
}

struct Shared<I, T> {
    state: Mutex<State<I, T>>,
    changed: Condvar,
    most: u64,
}

/// What there is to do next.
enum Next<T> {
    Work(u64, i64),
    TakeIn(i64, T),
    Nothing,
}

/// Works on `jobs`, which are asked for as they are needed, and calls `take_in` on this thread with each result in their order.
/// Where that fails, no more jobs are begun.
pub(crate) fn in_order<I, T, E>(
    jobs: I,
    mut workers: Workers<'_, T>,
    mut take_in: impl FnMut(i64, T) -> Result<(), E>,
) -> Result<(), E>
where
    I: Iterator<Item = i64> + Send,
    T: Send,
{
    let state = State { jobs, taken: 0, done: 0, ready: BTreeMap::new(), closed: false, broken: false };
    let shared = Shared {
        state: Mutex::new(state),
        changed: Condvar::new(),
        most: AHEAD * (workers.helpers as u64 + 1),
    };
    std::thread::scope(|scope| {
        let _closing = Closing(&shared);
        for _ in 0..workers.helpers {
            let (shared, open) = (&shared, workers.open);
            let help = move || {
                let Some(mut work) = open() else { return };
                while let Some((number, job)) = shared.wait_for_work() {
                    let mut promise = Promise { shared, kept: false };
                    let result = work(job);
                    promise.kept = true;
                    shared.hand_in(number, (job, result));
                }
            };
            // Without a thread the others do its share.
            if std::thread::Builder::new().name("frames".to_owned()).spawn_scoped(scope, help).is_err() {
                break;
            }
        }
        loop {
            match shared.next() {
                Next::Work(number, job) => {
                    let result = (workers.own)(job);
                    shared.hand_in(number, (job, result));
                }
                Next::TakeIn(job, result) => take_in(job, result)?,
                Next::Nothing => return Ok(()),
            }
        }
    })
}

impl<I: Iterator<Item = i64>, T> Shared<I, T> {
    /// No code that holds the lock can panic half way, but for the list of jobs, which ends then.
    fn state(&self) -> MutexGuard<'_, State<I, T>> {
        self.state.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Takes in before it works, so that little waits; waits only where others have all that may be begun.
    fn next(&self) -> Next<T> {
        let mut state = self.state();
        loop {
            let first = state.done;
            if let Some((job, result)) = state.ready.remove(&first) {
                state.done += 1;
                self.changed.notify_all();
                return Next::TakeIn(job, result);
            }
            if let Some((number, job)) = state.take(self.most) {
                return Next::Work(number, job);
            }
            if state.done == state.taken || state.broken {
                return Next::Nothing;
            }
            state = self.changed.wait(state).unwrap_or_else(PoisonError::into_inner);
        }
    }

    fn wait_for_work(&self) -> Option<(u64, i64)> {
        let mut state = self.state();
        loop {
            if let Some(work) = state.take(self.most) {
                return Some(work);
            }
            if state.closed {
                return None;
            }
            state = self.changed.wait(state).unwrap_or_else(PoisonError::into_inner);
        }
    }

    fn hand_in(&self, number: u64, result: (i64, T)) {
        self.state().ready.insert(number, result);
        self.changed.notify_all();
    }
}

impl<I: Iterator<Item = i64>, T> State<I, T> {
    fn take(&mut self, most: u64) -> Option<(u64, i64)> {
        if self.closed || self.taken - self.done >= most {
            return None;
        }
        let Some(job) = self.jobs.next() else {
            self.closed = true;
            return None;
        };
        self.taken += 1;
        Some((self.taken - 1, job))
    }
}

/// Lets the helpers go, however the work ends.
struct Closing<'a, I: Iterator<Item = i64>, T>(&'a Shared<I, T>);

impl<I: Iterator<Item = i64>, T> Drop for Closing<'_, I, T> {
    fn drop(&mut self) {
        self.0.state().closed = true;
        self.0.changed.notify_all();
    }
}

/// Tells the others that nothing will come of a job, where its thread panics; the scope passes the panic on.
struct Promise<'a, I: Iterator<Item = i64>, T> {
    shared: &'a Shared<I, T>,
    kept: bool,
}

impl<I: Iterator<Item = i64>, T> Drop for Promise<'_, I, T> {
    fn drop(&mut self) {
        if !self.kept {
            let mut state = self.shared.state();
            (state.broken, state.closed) = (true, true);
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

    /// Later jobs are done sooner.
    fn slowly(job: i64) -> i64 {
        std::thread::sleep(Duration::from_micros(400 - 20 * (job as u64 % 20)));
        job * job
    }

    fn workers<'a>(
        helpers: usize,
        open: &'a (dyn Fn() -> Option<Worker<'a, i64>> + Sync),
    ) -> Workers<'a, i64> {
        Workers { own: Box::new(slowly), helpers, open }
    }

    #[test]
    fn results_come_in_the_order_of_the_list_and_only_a_few_wait() {
        let (begun, most) = (AtomicI64::new(0), AtomicI64::new(0));
        for helpers in [0, 1, 3] {
            begun.store(0, Ordering::SeqCst);
            let jobs = (0..200).inspect(|_| {
                begun.fetch_add(1, Ordering::SeqCst);
            });
            let mut seen = Vec::new();
            let open = || Some(Box::new(slowly) as Worker<'_, i64>);
            let done = in_order(jobs, workers(helpers, &open), |job, result| {
                let waiting = begun.load(Ordering::SeqCst) - seen.len() as i64;
                most.fetch_max(waiting, Ordering::SeqCst);
                seen.push((job, result));
                Ok::<(), ()>(())
            });
            assert_eq!(done, Ok(()));
            assert_eq!(seen, (0..200).map(|job| (job, job * job)).collect::<Vec<_>>());
            let most = most.load(Ordering::SeqCst);
            assert!(most <= 2 * (helpers as i64 + 1) + 1, "{most} with {helpers} helpers");
        }
    }

    #[test]
    fn helpers_that_cannot_work_are_done_without() {
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
        let open = || Some(Box::new(slowly) as Worker<'_, i64>);
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
    fn a_helper_that_panics_ends_the_work() {
        let broken = |_: i64| -> i64 { panic!("a frame broke off") };
        let open = || Some(Box::new(broken) as Worker<'_, i64>);
        let _ = in_order(0..1_000_000, workers(1, &open), |_, _| Ok::<(), ()>(()));
    }
}
