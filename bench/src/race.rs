//! Times several programs or functions, the contenders, on the same task. Each round runs all of them in turn, so that
//! a slow moment of the machine slows all alike.

use std::hint::black_box;
use std::time::Instant;

use crate::table::{Figure, Spread, Unit};

/// Runs the task as many times as it is told, and returns the seconds of all runs together.
type Run<'a> = Box<dyn FnMut(usize) -> anyhow::Result<f64> + 'a>;

/// Something that does the task, or why it is missing on this machine.
pub struct Contender<'a> {
    who: String,
    note: String,
    run: Result<Run<'a>, String>,
}

impl<'a> Contender<'a> {
    /// A function of this program.
    pub fn here<T>(who: &str, note: &str, mut work: impl FnMut() -> T + 'a) -> Self {
        Self::timed(who, note, move |times| {
            let start = Instant::now();
            for _ in 0..times {
                black_box(work());
            }
            Ok(start.elapsed().as_secs_f64())
        })
    }

    /// Something that measures its own time: `run` does the task as many times as it is told, and returns the seconds
    /// of all runs together.
    pub fn timed(who: &str, note: &str, run: impl FnMut(usize) -> anyhow::Result<f64> + 'a) -> Self {
        Self { who: who.to_owned(), note: note.to_owned(), run: Ok(Box::new(run)) }
    }

    /// One that is missing on this machine.
    pub fn missing(who: &str, why: &str) -> Self {
        Self { who: who.to_owned(), note: String::new(), run: Err(why.to_owned()) }
    }

    /// One that may have failed to start; if it has, it counts as missing.
    pub fn started(
        who: &str,
        note: &str,
        run: anyhow::Result<impl FnMut(usize) -> anyhow::Result<f64> + 'a>,
    ) -> Self {
        match run {
            Ok(run) => Self::timed(who, note, run),
            Err(why) => Self::missing(who, &format!("{why:#}")),
        }
    }
}

/// Even a slow contender gets this many of a race's rounds (all, if the race has fewer), unless it is so slow that it
/// gets only one.
const LEAST_ROUNDS: usize = 3;

/// How long a race takes.
#[derive(Clone, Copy, Debug)]
pub struct Pace {
    /// Rounds after the warm-up.
    pub rounds: usize,
    /// Shortest measurement, seconds: quicker tasks are done several times in a row.
    pub least_secs: f64,
    /// Once a contender has taken this many seconds, its first warm-up included, it gets no further round, except to
    /// complete three rounds. If that warm-up alone took as long, the warm-up is the contender's only round.
    pub most_secs: f64,
}

/// Runs the contenders; returns one figure for each, in their order.
///
/// # Errors
/// When a contender that had started fails.
pub fn race(pace: &Pace, contenders: Vec<Contender<'_>>) -> anyhow::Result<Vec<Figure>> {
    struct Lane<'a> {
        contender: Contender<'a>,
        times: usize,
        spent_secs: f64,
        /// Too slow for another round.
        once: bool,
        secs: Vec<f64>,
    }
    let mut lanes = Vec::new();
    for mut contender in contenders {
        let (mut times, mut once) = (1, false);
        let (mut spent_secs, mut secs) = (0.0, Vec::new());
        if let Ok(run) = &mut contender.run {
            // A quick contender warms up twice: the first run also pays for memory, tables and just-in-time compilers.
            spent_secs = run(1)?;
            let mut warm_secs = spent_secs;
            if warm_secs < pace.most_secs / 4.0 {
                warm_secs = warm_secs.min(run(1)?);
            }
            once = spent_secs >= pace.most_secs;
            if once {
                secs.push(spent_secs);
            }
            times = (pace.least_secs / warm_secs.max(1e-9)).ceil().clamp(1.0, 1e6) as usize;
        }
        lanes.push(Lane { contender, times, spent_secs, once, secs });
    }
    for _ in 0..pace.rounds {
        for lane in &mut lanes {
            let Ok(run) = &mut lane.contender.run else { continue };
            if !lane.once && (lane.spent_secs < pace.most_secs || lane.secs.len() < LEAST_ROUNDS) {
                let secs = run(lane.times)?;
                lane.spent_secs += secs;
                lane.secs.push(secs / lane.times as f64);
            }
        }
    }
    let figure = |lane: Lane<'_>| Figure {
        value: lane.contender.run.map(|_| Spread::of(lane.secs)),
        who: lane.contender.who,
        unit: Unit::Seconds,
        note: lane.contender.note,
    };
    Ok(lanes.into_iter().map(figure).collect())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn contenders_take_turns_and_a_missing_one_keeps_its_place() {
        let order = std::cell::RefCell::new(Vec::new());
        let contender = |who: &'static str, secs: f64| {
            let order = &order;
            Contender::timed(who, "", move |times| {
                order.borrow_mut().push(who);
                Ok(secs * times as f64)
            })
        };
        let pace = Pace { rounds: 4, least_secs: 0.1, most_secs: 10.0 };
        let contenders = vec![
            contender("quick", 0.01),
            Contender::missing("none", "why"),
            contender("slow", 6.0),
            contender("once", 20.0),
        ];
        let figures = race(&pace, contenders).unwrap();
        let runs: Vec<Option<usize>> =
            figures.iter().map(|figure| Some(figure.value.as_ref().ok()?.runs)).collect();
        assert_eq!(runs, [Some(4), None, Some(3), Some(1)]);
        assert_eq!(
            figures.iter().map(Figure::median).collect::<Vec<_>>(),
            [Some(0.01), None, Some(6.0), Some(20.0)]
        );
        // Warm-ups, two of them the quick one's; then rounds in which the quick and the slow one alternate.
        assert_eq!(order.borrow()[..7], ["quick", "quick", "slow", "once", "quick", "slow", "quick"]);
    }

    #[test]
    fn a_contender_that_fails_ends_the_race() {
        let mut runs = 0;
        let dying = Contender::timed("dying", "", |_| {
            runs += 1;
            anyhow::ensure!(runs < 4, "gone");
            Ok(1.0)
        });
        let pace = Pace { rounds: 9, least_secs: 0.0, most_secs: 100.0 };
        assert!(race(&pace, vec![dying]).is_err());
    }
}
