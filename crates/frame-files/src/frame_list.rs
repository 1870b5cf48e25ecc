//! Lists of frame numbers, such as `0-119x2,130`.

/// The most frames that one command renders.
const MAX_FRAMES: u64 = 1_000_000;

/// Frame numbers in the order in which they were listed. They are stored as ranges, so a long list takes little memory.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct FrameList {
    ranges: Vec<Range>,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
struct Range {
    first: i64,
    last: i64,
    step: u64,
}

impl FrameList {
    /// `first` to `last`, both included.
    pub fn whole(first: i64, last: i64) -> Self {
        Self { ranges: vec![Range { first, last, step: 1 }] }
    }

    /// Reads parts that are separated by commas. Each is `a`, `a-b` or `a..b`; `xN` or `:N` behind it takes every Nth
    /// frame. Numbers may be negative. If `b` is less than `a`, frames count down.
    ///
    /// # Errors
    /// A message that says how a list is written, or that it is too long.
    pub fn parse(text: &str) -> Result<Self, String> {
        let ranges: Result<Vec<Range>, String> =
            text.split(',').map(|part| Range::parse(part.trim(), text)).collect();
        let list = Self { ranges: ranges? };
        let mut count = 0u64;
        for range in &list.ranges {
            count = count.saturating_add(range.count());
        }
        if count > MAX_FRAMES {
            return Err(format!("{text:?} is {count} frames: the limit is {MAX_FRAMES}"));
        }
        Ok(list)
    }

    /// How many frames there are.
    pub fn count(&self) -> u64 {
        self.ranges.iter().map(|range| range.count()).sum()
    }

    /// Each frame, in the order of the list.
    pub fn iter(&self) -> impl Iterator<Item = i64> + '_ {
        self.ranges.iter().flat_map(|range| range.iter())
    }
}

impl Range {
    /// Reads a part of a list.
    fn parse(text: &str, list: &str) -> Result<Self, String> {
        let wrong = || {
            let what = match (text, list.trim()) {
                ("", "") => "the frame list is empty".to_owned(),
                ("", list) => format!("{list:?} has a comma without a frame beside it"),
                _ => format!("{text:?} is no frame list"),
            };
            format!("{what}; write 0-119, 0..119, 0-119x2, 0-119:2 or 5, with commas between")
        };
        let (range, step) = match text.split_once(['x', ':']) {
            Some((range, step)) => {
                (range, step.parse::<u64>().ok().filter(|&step| step > 0).ok_or_else(wrong)?)
            }
            None => (text, 1),
        };
        let number = |text: &str| text.trim().parse::<i64>().map_err(|_| wrong());
        // A leading minus is a sign. The next minus is the dash of a range.
        let dash = range.get(1..).and_then(|rest| rest.find('-')).map(|at| at + 1);
        let (first, last) = match (range.split_once(".."), dash) {
            (Some((first, last)), _) => (number(first)?, number(last)?),
            (None, Some(at)) => (number(&range[..at])?, number(&range[at + 1..])?),
            (None, None) => (number(range)?, number(range)?),
        };
        Ok(Self { first, last, step })
    }

    fn count(self) -> u64 {
        (self.first.abs_diff(self.last) / self.step).saturating_add(1)
    }

    fn iter(self) -> impl Iterator<Item = i64> {
        let down = self.last < self.first;
        (0..self.count()).map(move |index| {
            let offset = index.saturating_mul(self.step);
            if down {
                self.first.saturating_sub_unsigned(offset)
            } else {
                self.first.saturating_add_unsigned(offset)
            }
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn frames(text: &str) -> Vec<i64> {
        FrameList::parse(text).unwrap().iter().collect()
    }

    #[test]
    fn every_way_of_writing_a_list() {
        assert_eq!(frames("5"), [5]);
        assert_eq!(frames("0-3"), [0, 1, 2, 3]);
        assert_eq!(frames("0..3"), [0, 1, 2, 3]);
        assert_eq!(frames("0-7x3, 20"), [0, 3, 6, 20]);
        assert_eq!(frames("1-10:3"), [1, 4, 7, 10]);
        assert_eq!(frames("-5--3"), [-5, -4, -3]);
        assert_eq!(frames("-2..1"), [-2, -1, 0, 1]);
        assert_eq!(frames("3-1"), [3, 2, 1]);
        assert_eq!(FrameList::whole(2, 4).iter().collect::<Vec<_>>(), [2, 3, 4]);
    }

    #[test]
    fn what_is_no_list_is_refused() {
        for text in ["", "a", "1-", "1-2x0", "1-2x", "1,,2", "1e3", "..", "1-2-3", "-"] {
            assert!(FrameList::parse(text).is_err(), "{text:?}");
        }
    }

    #[test]
    fn huge_lists_are_counted_and_refused_at_once() {
        let error = FrameList::parse("0-1000000000000").unwrap_err();
        assert!(error.contains("1000000"), "{error}");
        assert!(FrameList::parse("-9223372036854775808-9223372036854775807").is_err());
        assert_eq!(FrameList::parse("0-999999").unwrap().count(), 1_000_000);
    }
}
