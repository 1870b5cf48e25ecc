//! The parts that a system has to bring, with the packages that bring them. The names for Debian were tried; those for
//! Fedora and Arch are from their package lists.

use crate::systems::System;

/// A library or a program that the system has to bring.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Part {
    /// What it is called in a sentence.
    pub what: &'static str,
    /// The file by which it is found on Linux.
    pub file: &'static str,
    /// The packages of Debian, Fedora and Arch, in this order; empty where there is none.
    packages: [&'static str; 3],
}

impl Part {
    /// The package that brings it on this system; `None` if none is known.
    pub fn package(&self, system: System) -> Option<&'static str> {
        let [debian, fedora, arch] = self.packages;
        let name = match system {
            System::Debian => debian,
            System::Fedora => fedora,
            System::Arch => arch,
            System::OtherLinux | System::NotLinux => "",
        };
        (!name.is_empty()).then_some(name)
    }
}

const fn part(what: &'static str, file: &'static str, packages: [&'static str; 3]) -> Part {
    Part { what, file, packages }
}

/// The library through which OpenGL is opened.
const EGL: Part = part("the EGL library", "libEGL.so.1", ["libegl1", "mesa-libEGL", "mesa"]);

/// What draws where there is no graphics card.
const SOFTWARE_DRIVERS: Part =
    part("Mesa's OpenGL drivers", "swrast_dri.so", ["libgl1-mesa-dri", "mesa-dri-drivers", "mesa"]);

/// What drawing through EGL needs, also without a graphics card.
pub const FOR_EGL: &[Part] = &[EGL, SOFTWARE_DRIVERS];

/// What drawing through OSMesa needs: Mesa's off-screen library, which Mesa 25.1 dropped.
pub const FOR_OSMESA: &[Part] =
    &[part("the OSMesa library", "libOSMesa.so.8", ["libosmesa6", "mesa-libOSMesa", ""])];

/// What movies need.
pub const FOR_MOVIES: &[Part] = &[part("ffmpeg", "ffmpeg", ["ffmpeg", "ffmpeg-free", "ffmpeg"])];

/// What a window on X11 needs.
pub const FOR_X11: &[Part] = &[
    part("the X11 library", "libX11.so.6", ["libx11-6", "libX11", "libx11"]),
    part("the bridge from X11 to XCB", "libX11-xcb.so.1", ["libx11-xcb1", "libX11-xcb", "libx11"]),
    part("the X11 cursors", "libXcursor.so.1", ["libxcursor1", "libXcursor", "libxcursor"]),
    part("the X11 input library", "libXi.so.6", ["libxi6", "libXi", "libxi"]),
    part(
        "the X11 keyboard library",
        "libxkbcommon-x11.so.0",
        ["libxkbcommon-x11-0", "libxkbcommon-x11", "libxkbcommon-x11"],
    ),
    EGL,
];

/// What a window on Wayland needs.
pub const FOR_WAYLAND: &[Part] = &[
    part(
        "the Wayland library",
        "libwayland-client.so.0",
        ["libwayland-client0", "libwayland-client", "wayland"],
    ),
    part(
        "the bridge from Wayland to EGL",
        "libwayland-egl.so.1",
        ["libwayland-egl1", "libwayland-egl", "wayland"],
    ),
    part("the keyboard library", "libxkbcommon.so.0", ["libxkbcommon0", "libxkbcommon", "libxkbcommon"]),
    EGL,
];
