//! The metrics of `impasto measure`, M1 to M17: their names and titles.

use std::fmt;
use std::str::FromStr;

use serde::{Serialize, Serializer};

/// One metric.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Metric {
    /// How the picture turns as the camera rolls.
    M1,
    /// How the angles of strokes turn as the camera rolls.
    M2,
    /// Angles of strokes against the analytic screen map.
    M3,
    /// Popping.
    M4,
    /// Warp error.
    M5,
    /// Coherence of strokes that the reference view did not see.
    M6,
    /// Shower door: brushwork that stands still on the picture.
    M7,
    /// Flatness: strokes keep their size on the picture.
    M8,
    /// Coverage and bleed.
    M9,
    /// Angular jitter.
    M10,
    /// Authoring: saving and scrubbing leave the strokes as they are, a higher density keeps their directions, and
    /// strokes on a guide lie as drawn.
    M11,
    /// Speed.
    M12,
    /// Loop and replay: the same frame always gives the same picture.
    M13,
    /// Density.
    M14,
    /// Chatter: strokes whose lightness goes up and down from frame to frame.
    M15,
    /// Steps: strokes that visibly appear or vanish from one frame to the next.
    M16,
    /// Flicker of the picture at points that are followed along their motion.
    M17,
}

impl Metric {
    /// All, in order.
    pub const ALL: [Self; 17] = [
        Self::M1,
        Self::M2,
        Self::M3,
        Self::M4,
        Self::M5,
        Self::M6,
        Self::M7,
        Self::M8,
        Self::M9,
        Self::M10,
        Self::M11,
        Self::M12,
        Self::M13,
        Self::M14,
        Self::M15,
        Self::M16,
        Self::M17,
    ];

    /// What it measures, in a few words.
    pub fn title(self) -> &'static str {
        match self {
            Self::M1 => "picture under roll",
            Self::M2 => "angles under roll",
            Self::M3 => "angles in general",
            Self::M4 => "popping",
            Self::M5 => "warp error",
            Self::M6 => "reveal coherence",
            Self::M7 => "shower door",
            Self::M8 => "flatness",
            Self::M9 => "coverage and bleed",
            Self::M10 => "angular jitter",
            Self::M11 => "authoring",
            Self::M12 => "speed",
            Self::M13 => "loop and replay",
            Self::M14 => "density",
            Self::M15 => "chatter",
            Self::M16 => "steps",
            Self::M17 => "flicker",
        }
    }
}

impl fmt::Display for Metric {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(formatter, "{self:?}")
    }
}

impl Serialize for Metric {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.collect_str(self)
    }
}

impl FromStr for Metric {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, Self::Err> {
        let wanted = text.trim();
        Self::ALL
            .into_iter()
            .find(|metric| metric.to_string().eq_ignore_ascii_case(wanted))
            .ok_or_else(|| format!("{wanted:?} is no metric; they are M1 to M17"))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_metric_is_found_by_its_name() {
        for metric in Metric::ALL {
            assert_eq!(metric.to_string().to_lowercase().parse(), Ok(metric));
        }
        assert!("M18".parse::<Metric>().is_err());
    }
}
