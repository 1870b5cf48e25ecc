//! The table of AOVs ("arbitrary output variables"): the data that an EXR file can hold beside the colour.

use crate::nearest::nearest;

/// A kind of data that goes beside the colour.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
#[repr(u8)]
pub enum Aov {
    /// Depth along the gaze.
    Depth,
    /// Normals.
    Normal,
    /// Positions.
    Position,
    /// Motion from the frame before and to the frame after, as Blender writes it.
    Motion,
    /// Motion to the frame after.
    Forward,
    /// Motion to the frame before.
    Backward,
    /// Colour without light.
    Albedo,
    /// Light that falls on the surface.
    Light,
    /// The share of the shadow-casting light that reaches the surface. Only one light of a scene casts shadows.
    Shadow,
    /// How open a place is to ambient light.
    Occlusion,
    /// The number of the object that shows.
    ObjectId,
    /// The number of the stroke that shows most.
    StrokeId,
    /// Angles of strokes.
    StrokeAngle,
    /// How far the turn of strokes can be trusted.
    StrokeKappa,
    /// Ranks of strokes.
    StrokeRank,
    /// Layers of strokes.
    StrokeLayer,
    /// Colour of the paint and the ground. It includes the scene's own light, but not the light of the room in which
    /// the picture hangs, which shades the relief of the paint.
    PaintColor,
    /// Height of the paint.
    PaintHeight,
    /// Normals of the paint.
    PaintNormal,
    /// How wet the paint is.
    PaintWetness,
    /// How much of each layer shows.
    PaintAlpha,
    /// A picture for each layer.
    Layers,
    /// Mattes of objects.
    CryptoObject,
    /// Mattes of materials.
    CryptoMaterial,
    /// Mattes of regions.
    CryptoRegion,
    /// Mattes of single strokes.
    CryptoStroke,
}

/// A row of the table.
#[derive(Clone, Copy, Debug)]
pub struct AovRow {
    /// The AOV that the row describes.
    pub aov: Aov,
    /// Its name in a scene file and on the command line.
    pub name: &'static str,
    /// Its channels in a file.
    pub channels: &'static str,
    /// Type of a sample: half, float or uint.
    pub samples: &'static str,
    /// What it is, and in which unit.
    pub summary: &'static str,
}

const fn row(
    aov: Aov,
    name: &'static str,
    channels: &'static str,
    samples: &'static str,
    summary: &'static str,
) -> AovRow {
    AovRow { aov, name, channels, samples, summary }
}

/// All AOVs, in the order in which they are listed.
pub const AOVS: [AovRow; 26] = [
    row(Aov::Depth, "depth", "Z", "float", "distance along the gaze, world units; 1e10 where nothing is"),
    row(
        Aov::Normal,
        "normal",
        "N.X N.Y N.Z",
        "half",
        "surface normal, world space; towards the eye; 0 where noise colours the surface",
    ),
    row(Aov::Position, "position", "P.X P.Y P.Z", "float", "place of the surface, world space"),
    row(
        Aov::Motion,
        "motion",
        "motion.X motion.Y motion.Z motion.W",
        "float",
        "X, Y: where the surface was in the frame before, less where it is; Z, W: where it is, less where it will be; pixels, Y up, as Blender's Vector pass",
    ),
    row(
        Aov::Forward,
        "forward",
        "forward.u forward.v",
        "float",
        "where the surface will be in the frame after, less where it is; pixels, Y up",
    ),
    row(
        Aov::Backward,
        "backward",
        "backward.u backward.v",
        "float",
        "where the surface was in the frame before, less where it is; pixels, Y up",
    ),
    row(Aov::Albedo, "albedo", "albedo.R albedo.G albedo.B", "half", "colour of the surface without light"),
    row(
        Aov::Light,
        "light",
        "light.R light.G light.B",
        "half",
        "light that falls on the surface, with shadows; 1 on unlit surfaces and where noise colours",
    ),
    row(
        Aov::Shadow,
        "shadow",
        "shadow.X",
        "half",
        "how much arrives of the light that casts shadows: 1 in the light, 0 in shadow",
    ),
    row(
        Aov::Occlusion,
        "occlusion",
        "occlusion.X",
        "half",
        "how open a place is to light from all around: 1 open, 0 enclosed",
    ),
    row(
        Aov::ObjectId,
        "objectid",
        "objectid.X",
        "float",
        "number of the object in the scene, from 1; 0 where nothing is",
    ),
    row(
        Aov::StrokeId,
        "stroke.id",
        "stroke.id.X",
        "uint",
        "number of the stroke that shows most, the same in every frame; 0 where none is",
    ),
    row(
        Aov::StrokeAngle,
        "stroke.angle",
        "stroke.angle.X",
        "float",
        "its angle, radians counter-clockwise from X in the picture, from -pi to pi",
    ),
    row(
        Aov::StrokeKappa,
        "stroke.kappa",
        "stroke.kappa.X",
        "half",
        "how far its turn can be trusted, 0 to 1",
    ),
    row(
        Aov::StrokeRank,
        "stroke.rank",
        "stroke.rank.X",
        "half",
        "its rank, 0 to 1: strokes with low ranks stay longest when strokes thin out",
    ),
    row(
        Aov::StrokeLayer,
        "stroke.layer",
        "stroke.layer.X",
        "half",
        "its layer of paint, from 1 for the underpainting to 7 for the lights, 8 for touches; 0 where no stroke is",
    ),
    row(
        Aov::PaintColor,
        "paint.color",
        "paint.color.R paint.color.G paint.color.B paint.color.A",
        "half",
        "the paint without the light of the room, premultiplied",
    ),
    row(
        Aov::PaintHeight,
        "paint.height",
        "paint.height.X",
        "half",
        "height of the paint in thicknesses of a usual stroke",
    ),
    row(
        Aov::PaintNormal,
        "paint.normal",
        "paint.normal.X paint.normal.Y paint.normal.Z",
        "half",
        "normal of the paint and the canvas in the picture: X right, Y up, Z towards you",
    ),
    row(
        Aov::PaintWetness,
        "paint.wetness",
        "paint.wetness.X",
        "half",
        "how far the paint runs together with its neighbours, 0 to 1",
    ),
    row(
        Aov::PaintAlpha,
        "paint.alpha",
        "alpha.LAYER.X",
        "half",
        "how much of the finished picture shows each layer of paint, and the ground",
    ),
    row(
        Aov::Layers,
        "layers",
        "layer.LAYER.R .G .B .A",
        "half",
        "each layer of paint as a picture, premultiplied: ground, then the layers, then finish, each laid over the last, give the picture",
    ),
    row(
        Aov::CryptoObject,
        "crypto.object",
        "CryptoObject00.R ... CryptoObject02.A",
        "float",
        "Cryptomatte of objects",
    ),
    row(
        Aov::CryptoMaterial,
        "crypto.material",
        "CryptoMaterial00.R ... CryptoMaterial02.A",
        "float",
        "Cryptomatte of materials",
    ),
    row(
        Aov::CryptoRegion,
        "crypto.region",
        "CryptoRegion00.R ... CryptoRegion02.A",
        "float",
        "Cryptomatte of regions",
    ),
    row(
        Aov::CryptoStroke,
        "crypto.stroke",
        "CryptoStroke00.R ... CryptoStroke02.A",
        "float",
        "Cryptomatte of single strokes, named LAYER/OBJECT/NUMBER",
    ),
];

/// A set of AOVs.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct AovSet(u32);

impl AovSet {
    /// None of them.
    pub const NONE: Self = Self(0);

    /// All of them.
    pub const ALL: Self = Self((1 << AOVS.len()) - 1);

    /// The AOVs of the scene's surfaces, which need no paint.
    pub const OF_SCENE: Self = Self((1 << (Aov::ObjectId as u32 + 1)) - 1);

    /// Whether the set holds this AOV.
    pub fn has(self, aov: Aov) -> bool {
        self.0 & (1 << aov as u32) != 0
    }

    /// Whether the set holds at least one of these.
    pub fn has_any(self, aovs: &[Aov]) -> bool {
        aovs.iter().any(|aov| self.has(*aov))
    }

    /// Whether it is empty.
    pub fn is_empty(self) -> bool {
        self.0 == 0
    }

    /// Both together.
    #[must_use]
    pub fn with(self, other: Self) -> Self {
        Self(self.0 | other.0)
    }

    /// Those that are in both.
    #[must_use]
    pub fn shared(self, other: Self) -> Self {
        Self(self.0 & other.0)
    }

    /// Those that `other` lacks.
    #[must_use]
    pub fn without(self, other: Self) -> Self {
        Self(self.0 & !other.0)
    }

    /// The rows of its members.
    pub fn rows(self) -> impl Iterator<Item = &'static AovRow> {
        AOVS.iter().filter(move |row| self.has(row.aov))
    }

    /// The set that a word stands for: `all`, `none`, `scene`, the name of one AOV, or the part before the dot that
    /// several names share, such as `stroke`.
    ///
    /// # Errors
    /// The word is unknown. The error is the known name that is close to it, if there is one.
    pub fn named(word: &str) -> Result<Self, Option<&'static str>> {
        match word {
            "all" => return Ok(Self::ALL),
            "none" => return Ok(Self::NONE),
            "scene" => return Ok(Self::OF_SCENE),
            _ => {}
        }
        let begins = |name: &str| name.split_once('.').is_some_and(|(group, _)| group == word);
        let found = AOVS.iter().filter(|row| row.name == word || begins(row.name));
        let set = found.fold(Self::default(), |set, row| set.with(row.aov.into()));
        if set.is_empty() { Err(nearest(word, AOVS.iter().map(|row| row.name))) } else { Ok(set) }
    }

    /// The set that these words stand for together.
    ///
    /// # Errors
    /// The first unknown word, with what to write in its place.
    pub fn of_words<'a>(words: impl IntoIterator<Item = &'a str>) -> Result<Self, String> {
        words.into_iter().try_fold(Self::default(), |set, word| {
            let known = Self::named(word).map_err(|near| match near {
                Some(near) => format!("there is no AOV \"{word}\"; did you mean \"{near}\"?"),
                None => {
                    format!("there is no AOV \"{word}\"; write all, or names from `impasto render --help`")
                }
            })?;
            Ok(set.with(known))
        })
    }
}

impl From<Aov> for AovSet {
    fn from(aov: Aov) -> Self {
        Self(1 << aov as u32)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_table_is_in_order_and_every_name_is_its_own() {
        for (index, row) in AOVS.iter().enumerate() {
            assert_eq!(row.aov as usize, index);
            assert!(
                AOVS[..index].iter().all(|other| other.name != row.name && other.channels != row.channels)
            );
            assert_eq!(AovSet::named(row.name), Ok(row.aov.into()));
        }
        assert_eq!(AovSet::ALL.rows().count(), AOVS.len());
    }

    #[test]
    fn words_name_one_or_several_and_a_slip_is_answered_with_the_nearest() {
        assert_eq!(AovSet::named("all"), Ok(AovSet::ALL));
        assert_eq!(AovSet::named("none"), Ok(AovSet::NONE));
        assert_eq!(AovSet::named("stroke").unwrap().rows().count(), 5);
        assert_eq!(AovSet::named("crypto").unwrap().rows().count(), 4);
        assert!(AovSet::OF_SCENE.has(Aov::ObjectId) && !AovSet::OF_SCENE.has(Aov::StrokeId));
        let words = AovSet::of_words(["depth", "normals"]).unwrap_err();
        assert!(words.contains("\"normals\"") && words.contains("\"normal\""), "{words}");
        assert!(AovSet::of_words(["qqq"]).unwrap_err().contains("--help"));
    }
}
