//! What a system has to bring for Impasto, and the words that tell somebody how to get it *there*: nobody is told to use a
//! program that their system does not have.
//!
//! What is known of a single kind of system is known here, and asked for by name elsewhere.

mod parts;

use std::path::Path;

pub use parts::{FOR_EGL, FOR_MOVIES, FOR_OSMESA, FOR_WAYLAND, FOR_X11, Part};

/// The kinds of systems that are told apart: by the names of their packages.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum System {
    /// Debian, Ubuntu and what is made from them, with apt.
    Debian,
    /// Fedora and what is made from it, with dnf.
    Fedora,
    /// Arch Linux and what is made from it, with pacman.
    Arch,
    /// A Linux whose packages are not known here.
    OtherLinux,
    /// No Linux: Impasto was never tried there.
    NotLinux,
}

impl System {
    /// The system that the program runs on.
    pub fn here() -> Self {
        if !cfg!(target_os = "linux") {
            return Self::NotLinux;
        }
        let release = ["/etc/os-release", "/usr/lib/os-release"]
            .iter()
            .find_map(|path| std::fs::read_to_string(path).ok())
            .unwrap_or_default();
        let path = std::env::var_os("PATH").unwrap_or_default();
        Self::of(&release, |program| {
            std::env::split_paths(&path).any(|folder| folder.join(program).is_file())
                || Path::new("/usr/bin").join(program).is_file()
        })
    }

    /// The Linux that calls itself so in `os-release`, if it also has the program that installs packages.
    fn of(release: &str, has: impl Fn(&str) -> bool) -> Self {
        let named = |family: &str| {
            let lines = release.lines().filter_map(|line| line.split_once('='));
            let mut values =
                lines.filter(|(key, _)| matches!(*key, "ID" | "ID_LIKE")).map(|(_, value)| value);
            values.any(|value| value.trim_matches(['"', '\'']).split_whitespace().any(|word| word == family))
        };
        let known = [
            (Self::Debian, ["debian", "ubuntu"].as_slice(), "apt-get"),
            (Self::Fedora, &["fedora"], "dnf"),
            (Self::Arch, &["arch"], "pacman"),
        ];
        let is = |families: &[&str], program| families.iter().any(|family| named(family)) && has(program);
        let found = known.into_iter().find(|(_, families, program)| is(families, program));
        found.map_or(Self::OtherLinux, |(system, ..)| system)
    }

    /// The packages that bring these parts here, each once; none where they are not known.
    pub fn packages(self, parts: &[Part]) -> Vec<&'static str> {
        let mut packages: Vec<&str> = Vec::new();
        for name in parts.iter().filter_map(|part| part.package(self)) {
            if !packages.contains(&name) {
                packages.push(name);
            }
        }
        packages
    }

    /// What to do so that these parts are there: a command where one is known, else a sentence.
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

/// "install this and that", with the files of a Linux or without them.
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

    const DEBIAN: &str = "PRETTY_NAME=\"Debian GNU/Linux 12 (bookworm)\"\nID=debian\n";
    const MINT: &str = "ID=linuxmint\nID_LIKE=\"ubuntu debian\"\n";
    const ROCKY: &str = "ID=\"rocky\"\nID_LIKE=\"rhel centos fedora\"\n";
    const ARCH: &str = "NAME=\"Arch Linux\"\nID=arch\n";

    #[test]
    fn a_system_is_known_by_its_release_and_by_the_program_it_has() {
        let has = |wanted: &'static str| move |program: &str| program == wanted;
        assert_eq!(System::of(DEBIAN, has("apt-get")), System::Debian);
        assert_eq!(System::of(MINT, has("apt-get")), System::Debian);
        assert_eq!(System::of(ROCKY, has("dnf")), System::Fedora);
        assert_eq!(System::of(ARCH, has("pacman")), System::Arch);
        // Fedora has apt among its packages: with it, it is still no Debian.
        assert_eq!(System::of("ID=fedora\n", has("apt-get")), System::OtherLinux);
        assert_eq!(
            System::of(DEBIAN, |_| false),
            System::OtherLinux,
            "nobody is told to use what is not there"
        );
        assert_eq!(System::of("ID=nixos\n", |_| true), System::OtherLinux);
        assert_eq!(System::of("", |_| true), System::OtherLinux);
    }

    #[test]
    fn each_system_is_told_in_its_own_words() {
        let says = |system: System| system.mend(FOR_EGL);
        assert_eq!(says(System::Debian), "apt-get install libegl1 libgl1-mesa-dri");
        assert_eq!(says(System::Fedora), "dnf install mesa-libEGL mesa-dri-drivers");
        assert_eq!(says(System::Arch), "pacman -S mesa", "one package, named once");
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
