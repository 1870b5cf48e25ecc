//! Random choices for strange files, with odd numbers and odd names among them. The same seed gives the same choices.

/// Random choices of one case; the same seed and number always give the same file.
pub struct Chance {
    numbers: fastrand::Rng,
    /// How often a number or a name is an odd one: 0 to 1.
    oddness: f64,
}

/// Numbers that readers trip over: too large, too small, not finite, cut short, or not quite numbers.
const ODD_NUMBERS: [&str; 40] = [
    "0",
    "-0",
    "0.0",
    "-1",
    "1e-45",
    "-1e-38",
    "1e-7",
    "1e6",
    "1e7",
    "-3e7",
    "1e10",
    "1e19",
    "3.4028235e38",
    "1e39",
    "-1e300",
    "1e309",
    "1e99999",
    "1e-99999",
    "NaN",
    "-nan",
    "inf",
    "-inf",
    "Infinity",
    "4294967295",
    "4294967296",
    "2147483648",
    "-2147483649",
    "9223372036854775807",
    "18446744073709551616",
    "0x7f",
    "1_000",
    "1,5",
    "+",
    "-",
    ".",
    "1.",
    ".5",
    "1e",
    "007",
    "00000000000000000000000000000000000000000000000000000000000000000000000001",
];

/// Names that readers trip over: empty, escaped, in many scripts, of another folder, or of a device.
const ODD_NAMES: [&str; 28] = [
    "",
    " ",
    ".",
    "..",
    "../m.obj",
    "../../../../etc/passwd",
    "/etc/passwd",
    "/dev/zero",
    "/dev/stdin",
    "/proc/self/mem",
    "a/b\\c",
    "C:\\m.obj",
    "\\\\host\\m.obj",
    "m.obj#",
    "m.obj#a#b",
    "%00",
    "\u{1b}[31mred\u{1b}[0m",
    "\u{7}\u{8}\u{7f}",
    "\u{202e}jbo.m",
    "e\u{301}\u{301}\u{301}\u{301}",
    "naïve.obj",
    "模型.obj",
    "\u{feff}m.obj",
    "m.obj ",
    "M.OBJ",
    "nul",
    "-o",
    "$(touch outside)",
];

impl Chance {
    /// The random choices of case `number` of this seed. A quarter of all cases have nothing odd, because some code of
    /// the program is reached only by sound files.
    pub fn new(seed: u64, number: u64) -> Self {
        let mut numbers = fastrand::Rng::with_seed(seed.wrapping_mul(0x9e37_79b9_7f4a_7c15) ^ number);
        let oddness = *numbers.choice(&[0.0, 0.002, 0.02, 0.15]).unwrap_or(&0.0);
        Self { numbers, oddness }
    }

    /// Returns true with this probability.
    pub fn happens(&mut self, probability: f64) -> bool {
        self.numbers.f64() < probability
    }

    /// Whether something odd is to come next.
    pub fn is_odd(&mut self) -> bool {
        self.happens(self.oddness)
    }

    /// Whether this case may hold anything odd at all.
    pub fn may_be_odd(&self) -> bool {
        self.oddness > 0.0
    }

    /// A whole number below `end`; 0 where that is 0.
    pub fn below(&mut self, end: usize) -> usize {
        if end == 0 { 0 } else { self.numbers.usize(..end) }
    }

    /// A count from 1 to `most`, small ones far more often.
    pub fn count(&mut self, most: usize) -> usize {
        let power = self.numbers.f64() * (most as f64).ln();
        (power.exp() as usize).clamp(1, most)
    }

    pub fn byte(&mut self) -> u8 {
        self.numbers.u8(..)
    }

    pub fn between(&mut self, least: f64, most: f64) -> f64 {
        least + (most - least) * self.numbers.f64()
    }

    /// One of these, by chance.
    pub fn of<T: Copy>(&mut self, from: &[T]) -> T {
        from[self.below(from.len())]
    }

    pub fn odd_number(&mut self) -> &'static str {
        self.of(&ODD_NUMBERS)
    }

    /// An odd name; now and then one of up to a million letters.
    pub fn odd_name(&mut self) -> String {
        if self.happens(0.05) {
            return self.of(&["a", "é", "\u{1f58c}"]).repeat(self.count(1_000_000));
        }
        self.of(&ODD_NAMES).to_owned()
    }

    /// A number to write into a file: as a rule the one given, now and then an odd one.
    pub fn number(&mut self, usual: f64) -> String {
        if self.is_odd() { self.odd_number().to_owned() } else { format!("{usual}") }
    }

    /// A name to write into a file: as a rule one of those given, now and then an odd one.
    pub fn name(&mut self, usual: &[&str]) -> String {
        if self.is_odd() { self.odd_name() } else { self.of(usual).to_owned() }
    }
}
