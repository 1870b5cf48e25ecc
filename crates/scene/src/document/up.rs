//! Which axis of a mesh file points up.

use serde::{Deserialize, Serialize};

/// Which axis of the mesh file points up.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize, Serialize)]
pub enum Up {
    /// Y up, −Z forward (the usual OBJ export).
    #[default]
    Y,
    /// Z up, Y forward (CAD, raw Blender).
    Z,
    /// X up.
    X,
    /// −X up.
    NegX,
    /// −Y up: upside down.
    NegY,
    /// −Z up.
    NegZ,
}

impl Up {
    /// All, with their names on the command line.
    pub const ALL: [(&'static str, Self); 6] = [
        ("x", Self::X),
        ("y", Self::Y),
        ("z", Self::Z),
        ("-x", Self::NegX),
        ("-y", Self::NegY),
        ("-z", Self::NegZ),
    ];

    /// Turns the file's axes so that Y points up.
    pub fn y_up_from_file(self) -> glam::DMat3 {
        use glam::DVec3;
        // The images of the file's X, Y and Z.
        let [x, y, z] = match self {
            Self::Y => [DVec3::X, DVec3::Y, DVec3::Z],
            Self::Z => [DVec3::X, DVec3::NEG_Z, DVec3::Y],
            Self::X => [DVec3::Y, DVec3::NEG_X, DVec3::Z],
            Self::NegX => [DVec3::NEG_Y, DVec3::X, DVec3::Z],
            Self::NegY => [DVec3::X, DVec3::NEG_Y, DVec3::NEG_Z],
            Self::NegZ => [DVec3::X, DVec3::Z, DVec3::NEG_Y],
        };
        glam::DMat3::from_cols(x, y, z)
    }
}
