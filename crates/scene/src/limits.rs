//! Limits of a scene. What exceeds a limit is refused, with a message that names the limit. A file is read only up to
//! its limit of bytes. Values, nesting and the characters of a number are counted before the text is parsed. The other
//! limits are checked before the scene is prepared.

/// Bytes of a scene file.
pub const MAX_SCENE_BYTES: u64 = 16 << 20;

/// Values (numbers, texts, lists, fields) in a scene file.
pub const MAX_VALUES: usize = 1_000_000;

/// Depth to which brackets, or comments, may be nested.
pub const MAX_NESTING: usize = 64;

/// Characters of one number.
pub const MAX_NUMBER_CHARS: usize = 400;

/// Bytes of a name in a scene: of an object, light, region, touch, layer or file.
pub const MAX_NAME_BYTES: usize = 1024;

/// Pixels along one side of the picture: every current driver takes a render target of this size.
pub const MAX_SIDE_PX: u32 = 16_384;

/// Pixels of the picture.
pub const MAX_PIXELS: u64 = 1 << 27;

/// Frames of a shot.
pub const MAX_FRAMES: u64 = 1_000_000;

/// Distance of any frame number from 0; exact in every type that carries a frame.
pub const MAX_FRAME: f64 = 1e9;

/// Coordinates, lengths and scales, world units; their squares stay finite in 32 bits.
pub const MAX_LENGTH: f64 = 1e9;

/// The least length, depth or scale that is not zero, world units.
pub const MIN_LENGTH: f64 = 1e-9;

/// Angles of rotation: of keys, references, regions and guides, degrees.
pub const MAX_ANGLE_DEG: f64 = 1e9;

/// Light intensity.
pub const MAX_INTENSITY: f64 = 1e6;

/// Vertical field of view, degrees.
pub const FOV_Y_DEG: std::ops::RangeInclusive<f64> = 1.0..=170.0;

/// Particles of one object; exact in a 32-bit float.
pub const MAX_PARTICLES_OF_OBJECT: u64 = 16_000_000;

/// Particles of the scene.
pub const MAX_PARTICLES: u64 = 32_000_000;

/// Length or width of a stroke, pixels.
pub const MAX_STROKE_PX: f64 = 4096.0;

/// Coverage: strokes per pixel × length × width.
pub const MAX_COVERAGE: f64 = 20.0;

/// Factors without a natural limit: jitter of colour, temperature, relief, weave, varnish, bloom.
pub const MAX_STRENGTH: f64 = 10.0;

/// Thickness of a layer of paint.
pub const MAX_THICKNESS: f64 = 5.0;

/// Colours of a palette.
pub const MAX_PALETTE: usize = 16;

/// Brushes of a mix.
pub const MAX_BRUSHES: usize = 64;

/// Brushes of a scene that are pictures, each counted once.
pub const MAX_BRUSH_PICTURES: usize = 16;

/// Frames for which a pose may be held.
pub const MAX_HOLD: u32 = 1000;

/// Distance from 0 of the number `layer` in stroke settings.
pub const MAX_LAYER: i32 = 1000;

/// Lights of kind `Sun`.
pub const MAX_SUNS: usize = 8;

/// Lights of the kinds `Point` and `Spot`, together.
pub const MAX_POINT_LIGHTS: usize = 16;

/// Problems that one step of reading or checking lists; one more problem may say how many are not listed.
pub const MAX_PROBLEMS: usize = 100;

/// Further references, in addition to the scene's own.
pub const MAX_FURTHER_REFERENCES: usize = 16;

/// Guides of a scene.
pub const MAX_GUIDES: usize = 4096;

/// Points of all guides of a scene.
pub const MAX_GUIDE_POINTS: usize = 65_536;

/// Dabs of a scene that select the faces of its regions.
pub const MAX_DABS: usize = 65_536;

/// Painted amounts of a scene: lists of dabs.
pub const MAX_AMOUNTS: usize = 4096;

/// Dabs of all painted amounts of a scene.
pub const MAX_AMOUNT_DABS: usize = 32_768;

/// Touches of a scene: strokes placed by hand.
pub const MAX_TOUCHES: usize = 2048;

/// Points of one touch.
pub const MAX_TOUCH_POINTS: usize = 256;

/// Points of all touches of a scene.
pub const MAX_ALL_TOUCH_POINTS: usize = 32_768;

/// Width of a touch, pixels.
pub const TOUCH_WIDTH_PX: std::ops::RangeInclusive<f64> = 1.0..=400.0;

/// Length of a touch that has a single point, pixels.
pub const TOUCH_LENGTH_PX: std::ops::RangeInclusive<f64> = 1.0..=4000.0;

/// Floods of a scene.
pub const MAX_FLOODS: usize = 256;

/// Patches of all regions of a scene.
pub const MAX_PATCHES: usize = 16_384;

/// Numbers without a natural limit in a noise-displaced material.
pub const NOISE_RATE: std::ops::RangeInclusive<f64> = -1000.0..=1000.0;

/// Layers of a noise-displaced material. Each but the first costs two texture lookups for every pixel.
pub const NOISE_LAYERS: std::ops::RangeInclusive<f64> = 1.0..=64.0;

/// Intensity and threshold of a noise-displaced material.
pub const MAX_NOISE_INTENSITY: f64 = 1000.0;

/// Period of a noise-displaced material, seconds.
pub const NOISE_PERIOD_SECS: std::ops::RangeInclusive<f64> = 0.01..=1e6;

/// Scale of a key.
pub const KEY_SCALE: std::ops::RangeInclusive<f64> = 1e-3..=1e3;

/// Factor of length and width of strokes in their keys.
pub const KEY_STROKE_SIZE: std::ops::RangeInclusive<f64> = 0.05..=20.0;

/// Factor of the coverage in keys of strokes.
pub const KEY_COVERAGE: std::ops::RangeInclusive<f64> = 0.0..=4.0;

/// `y` of the handles of an ease curve: 0 is the value of the key, 1 that of the next one.
pub const EASE_Y: std::ops::RangeInclusive<f64> = -2.0..=3.0;
