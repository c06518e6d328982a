//! The texts of a Debian package: its control file, checksums and copyright.

use crate::command;
use crate::glibc;
use crate::zig::GLIBC;
use std::fmt::Write;
use std::path::{Path, PathBuf};
use std::process::Command;

/// No address is known at which bugs are received.
const NO_ADDRESS: &str = "mozzi@localhost";
/// The first line is the synopsis.
const DESCRIPTION: &str = "dynamics of robots by screws: command line, C and C++ library
 Rigid-body dynamics of robots in the notation of Lynch and Park's Modern
 Robotics: inverse and forward dynamics, mass matrix, Jacobians, gradients,
 simulation, inverse kinematics, identification, from URDF, MJCF and xacro.
 .
 This package has the program mozzi with completions and manual, the shared
 library, headers for C and C++17, a CMake package and a pkg-config file.";

/// A package for one kind of processor, by Debian's name and by that of its folder of libraries.
pub struct Package {
    version: String,
    maintainer: String,
    architecture: &'static str,
    multiarch: &'static str,
}

impl Package {
    /// A package for this machine's processor, by the maintainer in DEBFULLNAME and DEBEMAIL.
    pub fn of_this_machine(version: String) -> Result<Package, String> {
        let (architecture, multiarch) = match std::env::consts::ARCH {
            "x86_64" => ("amd64", "x86_64-linux-gnu"),
            "aarch64" => ("arm64", "aarch64-linux-gnu"),
            other => return Err(format!("{other} has no name in this list of Debian's architectures")),
        };
        let set = |name: &str, otherwise: &str| std::env::var(name).unwrap_or_else(|_| otherwise.to_owned());
        let maintainer = format!("{} <{}>", set("DEBFULLNAME", "The mozzi contributors"), set("DEBEMAIL", NO_ADDRESS));
        Ok(Package { version, maintainer, architecture, multiarch })
    }

    /// Rust's name of the target.
    pub fn triple(&self) -> String {
        format!("{}-unknown-linux-gnu", std::env::consts::ARCH)
    }

    /// The target with the version of glibc, as cargo-zigbuild reads it.
    pub fn target(&self) -> String {
        format!("{}.2.{GLIBC}", self.triple())
    }

    pub fn multiarch(&self) -> &str {
        self.multiarch
    }

    pub fn file_name(&self) -> String {
        format!("mozzi_{}_{}.deb", self.version, self.architecture)
    }

    /// Writes DEBIAN/ into the staged folder, for binaries in it.
    pub fn write_control(&self, stage: &Path, binaries: &[PathBuf]) -> Result<(), String> {
        let mut newest = 0;
        for binary in binaries {
            let bytes = std::fs::read(binary).map_err(|error| format!("{}: {error}", binary.display()))?;
            newest = newest.max(glibc::newest(&bytes).unwrap_or_default());
        }
        if newest > GLIBC {
            return Err(format!("the binaries need glibc 2.{newest}, expected at most 2.{GLIBC}"));
        }
        let soname = binaries.iter().find_map(|binary| soname_version(binary)).ok_or("no library has a soname")?;
        let (_, sums) = command::output(
            Command::new("sh")
                .current_dir(stage)
                .args(["-c", "find usr -type f -print0 | LC_ALL=C sort -z | xargs -0 md5sum"]),
        )?;
        let files = |(name, text): (&str, String)| {
            let file = stage.join("DEBIAN").join(name);
            super::write(&file, text.as_bytes())
        };
        let size = installed_kilobytes(&stage.join("usr"))?;
        [
            ("control", self.control(newest, size)),
            ("md5sums", sums),
            ("shlibs", format!("libmozzi {soname} mozzi (>= {})\n", self.version)),
            ("triggers", "activate-noawait ldconfig\n".to_owned()),
        ]
        .into_iter()
        .try_for_each(files)
    }

    fn control(&self, glibc: u32, kilobytes: u64) -> String {
        format!(
            "Package: mozzi\nVersion: {}\nArchitecture: {}\nMaintainer: {}\nInstalled-Size: {kilobytes}\nDepends: libc6 (>= 2.{glibc}), libgcc-s1\nSection: science\nPriority: optional\n\
             Description: {DESCRIPTION}\n",
            self.version, self.architecture, self.maintainer
        )
    }

    /// Debian's changelog, which names the project's; `date` is in the format of RFC 5322.
    pub fn changelog(&self, date: &str) -> String {
        format!(
            "mozzi ({}) unstable; urgency=medium\n\n  * CHANGELOG.md.gz lists the changes.\n\n -- {}  {date}\n",
            self.version, self.maintainer
        )
    }
}

/// N of libmozzi.so.N.
fn soname_version(library: &Path) -> Option<String> {
    let name = library.file_name()?.to_str()?;
    name.strip_prefix("libmozzi.so.").map(str::to_owned)
}

/// The size of all files, each rounded up to a kilobyte.
fn installed_kilobytes(folder: &Path) -> Result<u64, String> {
    let failed = |error: std::io::Error| format!("{}: {error}", folder.display());
    let mut sum = 0;
    for entry in std::fs::read_dir(folder).map_err(failed)? {
        let path = entry.map_err(failed)?.path();
        let about = std::fs::symlink_metadata(&path).map_err(failed)?;
        sum += if about.is_dir() { installed_kilobytes(&path)? + 1 } else { about.len().div_ceil(1024) };
    }
    Ok(sum)
}

/// The copyright file, in Debian's format, with the text of the MIT licence.
pub fn copyright(licence: &str) -> String {
    let mut file = "Format: https://www.debian.org/doc/packaging-manuals/copyright-format/1.0/\nUpstream-Name: mozzi\n\
                    Comment: THIRD-PARTY.txt.gz, next to this file, has the licences of the linked packages.\n\nFiles: *\n\
                    Copyright: (c) The mozzi contributors\nLicense: MIT or Apache-2.0\n\nLicense: MIT\n"
        .to_owned();
    for line in licence.lines().skip_while(|line| !line.starts_with("Permission")) {
        // writing to a String cannot fail
        let _ = writeln!(file, " {}", if line.is_empty() { "." } else { line });
    }
    file + "\nLicense: Apache-2.0\n On Debian systems, /usr/share/common-licenses/Apache-2.0 has its text.\n"
}

#[cfg(test)]
mod tests {
    use super::{Package, copyright, soname_version};
    use std::path::Path;

    #[test]
    fn the_control_file_states_what_is_needed() {
        let package = Package {
            version: "1.2.3".into(),
            maintainer: "A <a@b.org>".into(),
            architecture: "amd64",
            multiarch: "x86_64-linux-gnu",
        };
        let text = package.control(28, 12);
        assert!(package.changelog("now").starts_with("mozzi (1.2.3) ") && text.contains("\nMaintainer: A <a@b.org>\n"));
        assert!(text.contains("\nDepends: libc6 (>= 2.28), libgcc-s1\n") && text.contains("\nInstalled-Size: 12\n"));
        assert!(text.lines().all(|line| !line.is_empty()), "{text}");
    }

    #[test]
    fn empty_lines_of_a_licence_are_points() {
        let text = copyright("MIT License\n\nCopyright\n\nPermission is\n\nTHE END\n");
        assert!(text.contains("License: MIT\n Permission is\n .\n THE END\n\nLicense: Apache-2.0\n"), "{text}");
    }

    #[test]
    fn a_soname_ends_with_a_number() {
        assert_eq!(soname_version(Path::new("a/libmozzi.so.3")), Some("3".into()));
        assert_eq!(soname_version(Path::new("usr/bin/mozzi")), None);
    }
}
