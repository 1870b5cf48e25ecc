//! EXR files: one part with all channels, lossless, the same bytes for the same picture.

use std::io::Cursor;
use std::path::Path;

use anyhow::Context as _;
use exr::meta::MetaData;
use exr::meta::attribute::{AttributeValue, Chromaticities, Text};
use exr::prelude::{
    AnyChannel, AnyChannels, Compression, Encoding, FlatSamples, Image, IntegerBounds, Layer,
    LayerAttributes, ReadChannels as _, ReadLayers as _, SmallVec, Vec2, WritableImage,
};
use half::f16;
use impasto_scene::limits::MAX_PIXELS;

use crate::exr_header::sort_attributes;
use crate::frame_rate::fraction;
use crate::picture_file::Provenance;

/// The values of a channel, row by row from the top.
#[derive(Clone, Debug, PartialEq)]
pub enum Samples {
    /// 16-bit floats, for colours and for values that need no more precision.
    Half(Vec<f16>),
    /// 32-bit floats, for measured values such as depth.
    Float(Vec<f32>),
    /// Whole numbers.
    Uint(Vec<u32>),
}

impl Samples {
    /// Rounds values to 16 bits.
    pub fn half(values: impl IntoIterator<Item = f32>) -> Self {
        Self::Half(values.into_iter().map(f16::from_f32).collect())
    }
}

/// A channel of a file.
#[derive(Clone, Debug, PartialEq)]
pub struct Channel {
    /// Its name, as in `N.X`.
    pub name: String,
    /// Its values.
    pub samples: Samples,
}

impl Channel {
    /// A channel of this name.
    pub fn new(name: impl Into<String>, samples: Samples) -> Self {
        Self { name: name.into(), samples }
    }
}

/// A note in the head of a file.
#[derive(Clone, Debug, PartialEq)]
pub enum Note {
    /// Words, in UTF-8.
    Text(String),
    /// A whole number.
    Number(i32),
    /// A number.
    Float(f32),
    /// Three numbers.
    Vector([f32; 3]),
}

/// A picture with everything that is known of it.
#[derive(Clone, Debug)]
pub struct ExrPicture {
    /// Width and height in pixels.
    pub size_px: [u32; 2],
    /// Its channels; no two have the same name.
    pub channels: Vec<Channel>,
    /// Frames per second.
    pub fps: f64,
    /// The matrices from world to camera space and from world to clip space (−1..1 over the picture), for row vectors,
    /// row by row.
    pub from_world: [[f32; 16]; 2],
    /// Notes by name, beside those that every file has.
    pub notes: Vec<(String, Note)>,
}

/// Deflate, the compression of ZIP, shrinks at most this many bytes to one.
const MOST_SHRUNK: u64 = 1032;

/// Rec. 709 with the white of D65.
const REC_709: Chromaticities = Chromaticities {
    red: Vec2(0.64, 0.33),
    green: Vec2(0.30, 0.60),
    blue: Vec2(0.15, 0.06),
    white: Vec2(0.3127, 0.3290),
};

/// Whether a file is compressed.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Packing {
    /// Compressed (ZIP, 16 rows at a time).
    #[default]
    Small,
    /// Uncompressed, row by row: for a program that waits for the file, reads it once and removes it.
    Plain,
}

/// Encodes a picture, on all cores.
///
/// # Errors
/// What the encoder said.
pub fn encode(picture: ExrPicture, provenance: &Provenance, packing: Packing) -> anyhow::Result<Vec<u8>> {
    let size = Vec2(picture.size_px[0] as usize, picture.size_px[1] as usize);
    let channels: SmallVec<[AnyChannel<FlatSamples>; 4]> = picture
        .channels
        .into_iter()
        .map(|Channel { name, samples }| {
            let samples = match samples {
                Samples::Half(values) => FlatSamples::F16(values),
                Samples::Float(values) => FlatSamples::F32(values),
                Samples::Uint(values) => FlatSamples::U32(values),
            };
            AnyChannel { quantize_linearly: true, ..AnyChannel::new(text(&name), samples) }
        })
        .collect();
    let [over, under] = fraction(picture.fps);
    let attributes = LayerAttributes {
        software_name: Some(text(concat!("Impasto ", env!("CARGO_PKG_VERSION")))),
        frames_per_second: Some((over as i32, under)),
        world_to_camera: Some(picture.from_world[0]),
        world_to_normalized_device: Some(picture.from_world[1]),
        ..LayerAttributes::default()
    };
    let encoding = match packing {
        Packing::Small => Encoding { compression: Compression::ZIP16, ..Encoding::SMALL_LOSSLESS },
        Packing::Plain => Encoding::UNCOMPRESSED,
    };
    let mut image = Image::from_layer(Layer::new(size, attributes, encoding, AnyChannels::sort(channels)));
    image.attributes.display_window = IntegerBounds::from_dimensions(size);
    image.attributes.chromaticities = Some(REC_709);
    let own = [
        ("Scene", Note::Text(provenance.scene.clone())),
        ("Driver", Note::Text(provenance.driver.clone())),
        ("State", Note::Text(provenance.state.clone())),
        ("colorInteropID", Note::Text("lin_rec709_scene".to_owned())),
    ];
    let own = own.map(|(name, note)| (name.to_owned(), note));
    for (name, note) in own.into_iter().chain(picture.notes) {
        image.attributes.other.insert(text(&name), attribute(note));
    }
    let mut bytes = Cursor::new(Vec::new());
    image.write().to_buffered(&mut bytes)?;
    let mut bytes = bytes.into_inner();
    sort_attributes(&mut bytes);
    Ok(bytes)
}

/// Some channels of a file as numbers, row by row from the top.
#[derive(Clone, Debug, PartialEq)]
pub struct Planes {
    /// Width and height in pixels.
    pub size_px: [u32; 2],
    /// The channels, in the order in which they were asked for.
    pub values: Vec<Vec<f32>>,
}

/// Reads channels of a file. A picture with more pixels than a scene may have is refused.
///
/// # Errors
/// What is wrong with the file, or the first channel that it lacks.
pub fn read(path: &Path, channels: &[&str]) -> anyhow::Result<Planes> {
    let meta = MetaData::read_from_file(path, false)?;
    let header = meta.headers.first().context("it has no picture")?;
    let Vec2(width, height) = header.layer_size;
    anyhow::ensure!(
        (width as u64).saturating_mul(height as u64) <= MAX_PIXELS,
        "{width} x {height} pixels are too many"
    );
    let sample_bytes: usize = header.channels.list.iter().map(|it| it.sample_type.bytes_per_sample()).sum();
    let claimed = (width as u64 * height as u64).saturating_mul(sample_bytes as u64);
    let length = path.metadata()?.len();
    anyhow::ensure!(
        claimed <= length.saturating_mul(MOST_SHRUNK),
        "it claims more than its {length} bytes can hold"
    );
    anyhow::ensure!(crate::exr_header::is_whole(path), "it was cut, or has parts of other kinds");
    for name in channels {
        anyhow::ensure!(
            header.channels.list.iter().any(|channel| channel.name.eq(name)),
            "it has no channel {name}"
        );
    }
    let image = exr::prelude::read()
        .no_deep_data()
        .largest_resolution_level()
        .all_channels()
        .first_valid_layer()
        .all_attributes()
        .from_file(path)?;
    let values = channels.iter().map(|name| {
        let channel = image.layer_data.channel_data.list.iter().find(|channel| channel.name.eq(name));
        channel.map(|channel| channel.sample_data.values_as_f32().collect()).context("a channel is gone")
    });
    Ok(Planes { size_px: [width as u32, height as u32], values: values.collect::<Result<_, _>>()? })
}

/// A text as UTF-8. The library would store Latin-1, which readers of the format refuse.
fn text(words: &str) -> Text {
    Text::from_slice_unchecked(words.as_bytes())
}

fn attribute(note: Note) -> AttributeValue {
    match note {
        Note::Text(words) => AttributeValue::Text(text(&words)),
        Note::Number(number) => AttributeValue::I32(number),
        Note::Float(number) => AttributeValue::F32(number),
        Note::Vector([x, y, z]) => AttributeValue::FloatVec3((x, y, z)),
    }
}

#[cfg(test)]
mod tests {
    use std::collections::BTreeMap;

    use exr::prelude::read;

    use super::*;

    fn picture() -> ExrPicture {
        let pixels = 7 * 5;
        let ramp = (0..pixels).map(|index| index as f32 * 0.37 - 2.0);
        ExrPicture {
            size_px: [7, 5],
            channels: vec![
                Channel::new("Z", Samples::Float(ramp.clone().collect())),
                Channel::new("R", Samples::half(ramp)),
                Channel::new(
                    "stroke.id",
                    Samples::Uint((0..pixels).map(|index| index * 99_999_999).collect()),
                ),
            ],
            fps: 23.976,
            from_world: [std::array::from_fn(|index| index as f32), [0.5; 16]],
            notes: (0..9)
                .map(|index| (format!("note {index}"), Note::Text("Äpfel 日".to_owned())))
                .chain([("Frame".to_owned(), Note::Number(-3))])
                .collect(),
        }
    }

    fn provenance() -> Provenance {
        Provenance {
            scene: "Café.ron".to_owned(),
            state: String::new(),
            frame: "1".to_owned(),
            driver: "a driver".to_owned(),
        }
    }

    #[test]
    fn what_is_written_is_read_back_with_its_names_and_types() {
        let bytes = encode(picture(), &provenance(), Packing::Small).unwrap();
        let image = read()
            .no_deep_data()
            .largest_resolution_level()
            .all_channels()
            .first_valid_layer()
            .all_attributes()
            .from_buffered(Cursor::new(&bytes))
            .unwrap();
        let found: BTreeMap<String, FlatSamples> = image
            .layer_data
            .channel_data
            .list
            .iter()
            .map(|channel| (channel.name.to_string(), channel.sample_data.clone()))
            .collect();
        assert_eq!(found.len(), 3);
        for Channel { name, samples } in picture().channels {
            match (samples, &found[&name]) {
                (Samples::Half(values), FlatSamples::F16(read)) => assert_eq!(&values, read),
                (Samples::Float(values), FlatSamples::F32(read)) => assert_eq!(&values, read),
                (Samples::Uint(values), FlatSamples::U32(read)) => assert_eq!(&values, read),
                _ => panic!("{name} has another type"),
            }
        }
        // When it reads a file, the library puts custom notes into the layer's attributes.
        let other = &image.layer_data.attributes.other;
        assert_eq!(other.get(&text("Scene")), Some(&AttributeValue::Text(text("Café.ron"))));
        assert_eq!(other.get(&text("note 4")), Some(&AttributeValue::Text(text("Äpfel 日"))));
        assert_eq!(other.get(&text("Frame")), Some(&AttributeValue::I32(-3)));
        assert_eq!(image.layer_data.attributes.frames_per_second, Some((24000, 1001)));
    }

    #[test]
    fn the_same_picture_gives_the_same_bytes() {
        for packing in [Packing::Small, Packing::Plain] {
            let once = encode(picture(), &provenance(), packing).unwrap();
            assert!(encode(picture(), &provenance(), packing).unwrap() == once);
        }
    }
}
