//! What a system has to bring for Impasto (libraries, drivers, ffmpeg), and the words that tell users how to install it
//! on *their* system. Nobody is told to use a program that their system does not have.
//!
//! Only this crate knows the differences between systems; others name the parts that they need.

mod parts;
mod systems;

pub use parts::{FOR_EGL, FOR_MOVIES, FOR_OSMESA, FOR_WAYLAND, FOR_X11, Part};
pub use systems::System;

impl System {
    /// The packages that bring these parts on this system, each once; parts whose package is not known are left out.
    pub fn packages(self, parts: &[Part]) -> Vec<&'static str> {
        let mut packages: Vec<&str> = Vec::new();
        for name in parts.iter().filter_map(|part| part.package(self)) {
            if !packages.contains(&name) {
                packages.push(name);
            }
        }
        packages
    }

    /// How to install these parts: a command where one is known, else a sentence.
    pub fn mend(self, parts: &[Part]) -> String {
        let command = match self {
            Self::Debian => "apt-get install",
            Self::Fedora => "dnf install",
            Self::Arch => "pacman -S",
            Self::OtherLinux => return in_words(parts, true),
            Self::NotLinux => {
                return format!("{} (Impasto was never tried on this system)", in_words(parts, false));
            }
        };
        let packages = self.packages(parts);
        if packages.is_empty() { in_words(parts, true) } else { format!("{command} {}", packages.join(" ")) }
    }
}

/// "install this and that", with or without the names of the files on Linux.
fn in_words(parts: &[Part], with_files: bool) -> String {
    let name = |part: &Part| match part.file {
        file if with_files && file != part.what => format!("{} ({file})", part.what),
        _ => part.what.to_owned(),
    };
    let mut names: Vec<String> = parts.iter().map(name).collect();
    let last = names.pop().unwrap_or_default();
    if names.is_empty() {
        format!("install {last}")
    } else {
        format!("install {} and {last}", names.join(", "))
    }
}

/// [`System::mend`] of the system that the program runs on.
pub fn mend(parts: &[Part]) -> String {
    System::here().mend(parts)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_system_is_told_in_its_own_words() {
        let says = |system: System| system.mend(FOR_EGL);
        assert_eq!(says(System::Debian), "apt-get install libegl1 libgl1-mesa-dri");
        assert_eq!(says(System::Fedora), "dnf install mesa-libEGL mesa-dri-drivers");
        assert_eq!(says(System::Arch), "pacman -S mesa", "one package for both parts");
        let words = "install the EGL library (libEGL.so.1) and Mesa's OpenGL drivers (swrast_dri.so)";
        assert_eq!(says(System::OtherLinux), words);
        let elsewhere = says(System::NotLinux);
        assert!(elsewhere.contains("never tried") && !elsewhere.contains(".so"), "{elsewhere}");
        assert_eq!(System::OtherLinux.mend(FOR_MOVIES), "install ffmpeg");
    }

    #[test]
    fn what_a_system_no_longer_packages_is_told_in_words() {
        assert_eq!(System::Arch.mend(FOR_OSMESA), "install the OSMesa library (libOSMesa.so.8)");
        assert!(System::Arch.packages(FOR_OSMESA).is_empty());
    }
}
