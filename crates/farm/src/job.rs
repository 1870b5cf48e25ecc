//! A job for a farm: which frames of which scene to paint, independent of the format that the farm takes.

use impasto_frame_files::FrameList;

/// A shot to be painted, frame by frame.
#[derive(Clone, Debug)]
pub struct Job {
    /// Its name, for people.
    pub name: String,
    /// The scene, as the machines of the farm find it.
    pub scene: String,
    /// The frames, from low to high, each once.
    pub frames: Frames,
    /// Where frames go, with `####` for their number.
    pub output: String,
    /// Further arguments of `impasto render`.
    pub arguments: Vec<String>,
    /// The movie that is made of the frames, if any.
    pub movie: Option<String>,
    /// Frames a second of the movie.
    pub fps: f64,
}

/// Frames, from low to high, each once, stored as runs of constant step.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Frames {
    runs: Vec<Run>,
}

/// `first`, `first + step` … `last`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
struct Run {
    first: i64,
    last: i64,
    step: i64,
}

impl Run {
    fn count(self) -> usize {
        (self.last.abs_diff(self.first) / self.step.unsigned_abs()) as usize + 1
    }

    fn text(self) -> String {
        let Self { first, last, step } = self;
        match (self.count(), step) {
            (1, _) => first.to_string(),
            (_, 1) => format!("{first}-{last}"),
            _ => format!("{first}-{last}:{step}"),
        }
    }
}

impl Frames {
    /// The frames of a list.
    pub fn of(list: &FrameList) -> Self {
        let mut all: Vec<i64> = list.iter().collect();
        all.sort_unstable();
        all.dedup();
        Self::of_sorted(&all)
    }

    fn of_sorted(all: &[i64]) -> Self {
        let mut runs: Vec<Run> = Vec::new();
        let mut at = 0;
        while at < all.len() {
            let step = all.get(at + 1).map_or(1, |next| next.wrapping_sub(all[at]));
            let mut end = at + 1;
            while end < all.len() && all[end].wrapping_sub(all[end - 1]) == step {
                end += 1;
            }
            // Two frames that are not neighbours do not form a run, so that the second may begin one.
            if end - at == 2 && step != 1 {
                end = at + 1;
            }
            runs.push(Run { first: all[at], last: all[end - 1], step: if end - at == 1 { 1 } else { step } });
            at = end;
        }
        Self { runs }
    }

    /// How many there are.
    pub fn count(&self) -> usize {
        self.runs.iter().map(|run| run.count()).sum()
    }

    /// As `-f` takes them: `1-48`, `1-9:2,20`.
    pub fn text(&self) -> String {
        self.runs.iter().map(|run| run.text()).collect::<Vec<_>>().join(",")
    }

    /// Parts of at most `most` frames, each written as `-f` takes it.
    pub fn chunks(&self, most: usize) -> Vec<String> {
        let all: Vec<i64> =
            self.runs.iter().flat_map(|run| (run.first..=run.last).step_by(run.step as usize)).collect();
        all.chunks(most.max(1)).map(|part| Self::of_sorted(part).text()).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn frames(text: &str) -> Frames {
        Frames::of(&FrameList::parse(text).unwrap())
    }

    #[test]
    fn a_list_is_told_shortly_and_reads_back_as_the_same_frames() {
        for (list, told) in [
            ("1-48", "1-48"),
            ("5", "5"),
            ("9..1", "1-9"),
            ("1-9:2,4,20-20", "1,3-5,7,9,20"),
            ("3,30", "3,30"),
            ("10-19:3,30", "10-19:3,30"),
            ("-5--1", "-5--1"),
            ("1,2,3,2,1,7", "1-3,7"),
            ("-9000000000000000000,9000000000000000000", "-9000000000000000000,9000000000000000000"),
            (
                "-9000000000000000000,0,9000000000000000000",
                "-9000000000000000000-9000000000000000000:9000000000000000000",
            ),
        ] {
            let found = frames(list);
            assert_eq!(found.text(), told, "of {list}");
            assert_eq!(frames(&found.text()), found);
            let mut wanted: Vec<i64> = FrameList::parse(list).unwrap().iter().collect();
            wanted.sort_unstable();
            wanted.dedup();
            assert_eq!(FrameList::parse(told).unwrap().iter().collect::<Vec<_>>(), wanted);
            assert_eq!(found.count(), wanted.len());
        }
    }

    #[test]
    fn chunks_are_all_frames_once() {
        let found = frames("1-40:3,100-110");
        for most in [1, 3, 7, 1000] {
            let chunks = found.chunks(most);
            let again: Vec<i64> = chunks
                .iter()
                .flat_map(|part| FrameList::parse(part).unwrap().iter().collect::<Vec<_>>())
                .collect();
            assert_eq!(again, FrameList::parse("1-40:3,100-110").unwrap().iter().collect::<Vec<_>>());
            assert_eq!(chunks.len(), found.count().div_ceil(most));
        }
    }
}
