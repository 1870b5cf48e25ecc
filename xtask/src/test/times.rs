//! Finds how long each test took, from the moments at which the test runner prints that tests have ended.
//!
//! The runner of a stable toolchain gives no times. It starts tests in the order of their names, as many at once as
//! there are threads, and the next one whenever one ends. So the moments at which tests end tell when each began.

use std::time::{Duration, Instant};

/// The times of all tests seen.
#[derive(Debug)]
pub struct Times {
    threads: usize,
    /// When the tests of the program that runs now began.
    began: Instant,
    /// Tests of that program that have ended, and when.
    ended: Vec<(String, Instant)>,
    known: Vec<(String, Duration)>,
}

impl Default for Times {
    fn default() -> Self {
        let threads = std::env::var("RUST_TEST_THREADS").ok().and_then(|threads| threads.parse().ok());
        let cores = || std::thread::available_parallelism().map_or(1, usize::from);
        Self::of_threads(threads.unwrap_or_else(cores))
    }
}

impl Times {
    fn of_threads(threads: usize) -> Self {
        Self { threads: threads.max(1), began: Instant::now(), ended: Vec::new(), known: Vec::new() }
    }

    /// Takes in a line as it is printed.
    pub fn heard(&mut self, line: &str) {
        self.heard_at(line, Instant::now());
    }

    fn heard_at(&mut self, line: &str, now: Instant) {
        if line.starts_with("running ") && (line.ends_with(" tests") || line.ends_with(" test")) {
            self.began = now;
            self.ended.clear();
        } else if line.starts_with("test result: ") {
            self.close();
        } else if let Some((name, _)) = line.strip_prefix("test ").and_then(|rest| rest.split_once(" ... ")) {
            self.ended.push((name.to_owned(), now));
        }
    }

    /// Computes how long each test of a program took, once all of them have ended.
    fn close(&mut self) {
        let mut order: Vec<&str> = self.ended.iter().map(|(name, _)| name.as_str()).collect();
        order.sort_unstable();
        for (name, end) in &self.ended {
            let place = order.binary_search(&name.as_str()).unwrap_or_default();
            let start = place.checked_sub(self.threads).map_or(self.began, |freed| self.ended[freed].1);
            self.known.push((name.clone(), end.saturating_duration_since(start)));
        }
        self.ended.clear();
    }

    /// The slowest tests, the slowest first.
    pub fn slowest(&self, count: usize) -> Vec<(&str, Duration)> {
        let mut all: Vec<(&str, Duration)> =
            self.known.iter().map(|(name, took)| (name.as_str(), *took)).collect();
        all.sort_by_key(|(_, took)| std::cmp::Reverse(*took));
        all.truncate(count);
        all
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn times_are_told_from_the_moments_at_which_tests_end() {
        let mut times = Times::of_threads(2);
        let begin = Instant::now();
        // `a` and `b` start at second 0. When `b` ends, `c` starts. `c` ends before `a`, and then `d` starts.
        let lines = [
            (0, "running 4 tests"),
            (2, "test b ... ok"),
            (3, "test c ... FAILED"),
            (5, "test a ... ok"),
            (9, "test d ... ok"),
            (9, "test result: FAILED. 3 passed; 1 failed"),
            (20, "running 1 test"),
            (26, "test e ... ok"),
            (26, "test result: ok. 1 passed"),
        ];
        for (second, line) in lines {
            times.heard_at(line, begin + Duration::from_secs(second));
        }
        let told: Vec<(&str, u64)> =
            times.slowest(9).into_iter().map(|(name, took)| (name, took.as_secs())).collect();
        assert_eq!(told, [("d", 6), ("e", 6), ("a", 5), ("b", 2), ("c", 1)]);
    }
}
