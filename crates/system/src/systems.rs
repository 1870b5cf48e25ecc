//! Which system the program runs on.

use std::path::Path;

/// A kind of system. What packages are called, and how they are installed, depends on it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum System {
    /// Debian, Ubuntu and their derivatives, with apt.
    Debian,
    /// Fedora and its derivatives, with dnf.
    Fedora,
    /// Arch Linux and its derivatives, with pacman.
    Arch,
    /// A Linux whose packages are not known here.
    OtherLinux,
    /// Not Linux: Impasto was never tried there.
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

    /// The kind of Linux that the text of `os-release` names, if the program that installs its packages is there too.
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
        // Fedora also packages `apt-get`, but a Fedora that has it is no Debian.
        assert_eq!(System::of("ID=fedora\n", has("apt-get")), System::OtherLinux);
        assert_eq!(
            System::of(DEBIAN, |_| false),
            System::OtherLinux,
            "apt-get is assumed where it is missing"
        );
        assert_eq!(System::of("ID=nixos\n", |_| true), System::OtherLinux);
        assert_eq!(System::of("", |_| true), System::OtherLinux);
    }
}
