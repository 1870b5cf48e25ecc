//! Works on jobs on the calling thread, one after the other, while other threads finish the results of earlier jobs.
//! The finished results are taken in one by one, in the order of the jobs.

use std::collections::VecDeque;
use std::panic::resume_unwind;
use std::sync::{Arc, Mutex, PoisonError};
use std::thread::{Builder, Scope, ScopedJoinHandle, scope};

/// How each job is done.
pub(crate) struct Steps<W, F> {
    /// Done on the calling thread.
    pub(crate) work: W,
    /// Done on other threads, with what `work` returned.
    pub(crate) finish: F,
    /// While the calling thread works on a job, at most this many results of earlier jobs are being finished on other
    /// threads, or are finished and wait. With 0, the calling thread finishes each result itself.
    pub(crate) most_beside: usize,
}

/// Works on `jobs`, and calls `take_in` on this thread with each finished result. When `take_in` fails, no more jobs
/// are begun.
pub(crate) fn finished_beside<J: Copy, U: Send, T: Send, E>(
    jobs: impl Iterator<Item = J>,
    mut steps: Steps<impl FnMut(J) -> U, impl Fn(U) -> T + Sync>,
    mut take_in: impl FnMut(J, T) -> Result<(), E>,
) -> Result<(), E> {
    let finish = &steps.finish;
    scope(|scope| {
        let mut under_way = VecDeque::new();
        for job in jobs {
            let result = (steps.work)(job);
            let finishing = match steps.most_beside {
                0 => Finishing::Done(finish(result)),
                _ => Finishing::begin(scope, result, finish),
            };
            under_way.push_back((job, finishing));
            if under_way.len() > steps.most_beside
                && let Some((job, finishing)) = under_way.pop_front()
            {
                take_in(job, finishing.result())?;
            }
        }
        under_way.into_iter().try_for_each(|(job, finishing)| take_in(job, finishing.result()))
    })
}

enum Finishing<'scope, T> {
    On(ScopedJoinHandle<'scope, Option<T>>),
    Done(T),
}

impl<'scope, T: Send + 'scope> Finishing<'scope, T> {
    /// Begins on a thread of its own or, if the system gives no more threads, finishes here.
    fn begin<U: Send + 'scope>(
        scope: &'scope Scope<'scope, '_>,
        result: U,
        finish: &'scope (impl Fn(U) -> T + Sync),
    ) -> Self {
        // If no thread can be spawned, the closure is dropped. The result is shared, so that it is not lost then.
        let result = Arc::new(Mutex::new(Some(result)));
        let taken = Arc::clone(&result);
        let take = move |from: &Mutex<Option<U>>| from.lock().unwrap_or_else(PoisonError::into_inner).take();
        let on_thread = move || take(&taken).map(finish);
        match Builder::new().name("files".to_owned()).spawn_scoped(scope, on_thread) {
            Ok(handle) => Self::On(handle),
            Err(_) => match result.lock().unwrap_or_else(PoisonError::into_inner).take() {
                Some(result) => Self::Done(finish(result)),
                None => unreachable!("only a thread takes it, and none was spawned"),
            },
        }
    }

    /// Waits for the result. A panic of its thread is passed on.
    fn result(self) -> T {
        match self {
            Self::Done(result) => result,
            Self::On(handle) => match handle.join() {
                Ok(Some(result)) => result,
                Ok(None) => unreachable!("a thread takes what it was given"),
                Err(panic) => resume_unwind(panic),
            },
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::sync::atomic::{AtomicI64, Ordering};
    use std::time::Duration;

    /// Of each twenty results, later ones take less time, so that they are ready out of order.
    fn slowly(result: i64) -> i64 {
        std::thread::sleep(Duration::from_micros(400 - 20 * (result as u64 % 20)));
        result * result
    }

    #[test]
    fn results_come_in_the_order_of_the_jobs_and_only_a_few_wait() {
        for most_beside in [0, 1, 3] {
            let (begun, this) = (AtomicI64::new(0), std::thread::current().id());
            let work = |job: i64| {
                assert_eq!(std::thread::current().id(), this);
                begun.fetch_add(1, Ordering::SeqCst);
                job
            };
            let mut seen = Vec::new();
            let done = finished_beside(0..200, Steps { work, finish: slowly, most_beside }, |job, result| {
                let waiting = begun.load(Ordering::SeqCst) - seen.len() as i64;
                assert!(waiting <= most_beside as i64 + 1, "{waiting} with {most_beside}");
                seen.push((job, result));
                Ok::<(), ()>(())
            });
            assert_eq!(done, Ok(()));
            assert_eq!(seen, (0..200).map(|job| (job, job * job)).collect::<Vec<_>>());
        }
    }

    #[test]
    fn nothing_is_begun_after_a_failure() {
        let begun = AtomicI64::new(0);
        let work = |job: i64| {
            begun.fetch_add(1, Ordering::SeqCst);
            job
        };
        let mut seen = Vec::new();
        let done = finished_beside(0..1000, Steps { work, finish: slowly, most_beside: 3 }, |job, _| {
            seen.push(job);
            if job == 9 { Err("full") } else { Ok(()) }
        });
        assert_eq!(done, Err("full"));
        assert_eq!(seen, (0..10).collect::<Vec<_>>());
        assert!(begun.load(Ordering::SeqCst) <= 10 + 3);
    }

    #[test]
    #[should_panic(expected = "a file broke off")]
    fn a_panic_beside_is_passed_on() {
        let finish = |job: i64| -> i64 { if job == 5 { panic!("a file broke off") } else { job } };
        let steps = Steps { work: |job: i64| job, finish, most_beside: 2 };
        let _ = finished_beside(0..1_000_000, steps, |_, _| Ok::<(), ()>(()));
    }
}
