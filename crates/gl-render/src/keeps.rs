//! Which data of a picture a renderer keeps, while it draws and afterwards.

use impasto_painting::frame::Style;

/// Pictures of more pixels than this are huge. Making their targets anew costs little compared with drawing, and
/// keeping all targets to the end of the picture takes twice the memory.
const HUGE_PX: u64 = 16 << 20;

/// What can be read of a drawn picture, besides its colour, its depth and its bodies. Strokes, and paint that was
/// gathered, can be read in any case. Keeping less saves memory, because each target is freed after its last use. The
/// picture itself is the same.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Keeps {
    /// Everything. The targets also stay for the next picture.
    #[default]
    Everything,
    /// The surfaces that the picture shows: unlit colour, normals, light.
    Surfaces,
    /// Nothing besides its colour, its depth and its bodies.
    Picture,
}

impl Keeps {
    /// What to keep of a picture of this size: everything, unless the picture is huge. `surfaces` says whether surfaces
    /// will be read. Where [`Renderer::read_paint`](crate::Renderer::read_paint) will be called, use `Everything`
    /// instead.
    pub fn of_size(size_px: [u32; 2], surfaces: bool) -> Self {
        match (Self::is_huge(size_px), surfaces) {
            (false, _) => Self::Everything,
            (true, true) => Self::Surfaces,
            (true, false) => Self::Picture,
        }
    }

    /// Whether a picture of this size is huge.
    pub(crate) fn is_huge(size_px: [u32; 2]) -> bool {
        size_px.map(u64::from).iter().product::<u64>() > HUGE_PX
    }

    /// The most memory that drawing a picture in this style takes, bytes per pixel. A pixel has `samples` samples along
    /// each axis.
    pub fn bytes_per_px(self, style: &Style, samples: u32) -> u64 {
        let fine = if samples > 1 { u64::from(samples * samples) * 12 } else { 0 };
        // The colours of samples. They are drawn only for pictures that are not huge, and these keep everything.
        let colors = if samples > 1 { u64::from(samples * samples) * 4 } else { 0 };
        // Bytes of the target that is computed from the samples: depth and body at the middle of each pixel, and the
        // share of the pixel that does not show this body.
        let surface = if samples > 1 { 8 } else { 0 };
        // The ink style reads the unlit targets of the reference pass.
        let (paint, reads_unlit) = match style {
            Style::RotatingStrokes(_) => (21, false),
            Style::SumiE(_) => (33, true),
            Style::Reference => (0, false),
        };
        // Bytes of `UnlitTargets`, of the other targets of the reference pass, and of the finished picture.
        let [unlit, lit, picture] = [13, 30, 16];
        // Bytes for strokes, for data that is read back, and for the driver's own needs.
        let else_taken = 8;
        let drawn = match self {
            Self::Everything => unlit + lit + fine + colors + surface + paint + picture,
            Self::Picture if !reads_unlit => lit + fine.max(surface + paint + picture),
            Self::Surfaces | Self::Picture => unlit + lit + fine.max(surface + paint + picture),
        };
        drawn + else_taken
    }

    /// Whether targets are freed while a picture is drawn, instead of staying for the next one.
    pub(crate) fn lets_go(self) -> bool {
        self != Self::Everything
    }
}
