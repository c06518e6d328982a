//! Where a mesh that a robot's file names is.

use std::ffi::OsString;
use std::fmt;
use std::path::{Path, PathBuf};

/// A mesh that was not found.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct NotLocated {
    /// The name in the robot's file.
    pub file: String,
    /// The places searched; empty for unsupported kinds of addresses.
    pub tried: Vec<PathBuf>,
}

impl fmt::Display for NotLocated {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Some(first) = self.tried.first() else {
            return write!(f, "mesh {}: expected package://, file://, or a path", self.file);
        };
        write!(f, "mesh {} was not found: neither {}", self.file, first.display())?;
        match self.tried.len() - 1 {
            0 => Ok(()),
            more => write!(f, " nor {more} other places"),
        }
    }
}

impl std::error::Error for NotLocated {}

/// The file of a mesh that the robot in `robot_file` names. A path is relative to the robot's file; `file://` is
/// absolute; `package://NAME/PATH` (two slashes or three) is searched as `NAME/PATH` in every folder above the robot's
/// file, then in those of `ROS_PACKAGE_PATH`, and as `share/NAME/PATH` in those of `AMENT_PREFIX_PATH`. Nothing is
/// fetched.
///
/// # Errors
/// [`NotLocated`] with the places.
pub fn locate(robot_file: &Path, mesh: &str) -> Result<PathBuf, NotLocated> {
    let tried = candidates(robot_file, mesh, &|name| std::env::var_os(name));
    match tried.iter().find(|path| path.is_file()) {
        Some(found) => Ok(found.clone()),
        None => Err(NotLocated { file: mesh.to_string(), tried }),
    }
}

fn candidates(robot_file: &Path, mesh: &str, variable: &dyn Fn(&str) -> Option<OsString>) -> Vec<PathBuf> {
    let folder = robot_file.parent().unwrap_or(Path::new(""));
    if let Some(path) = mesh.strip_prefix("file://") {
        return vec![folder.join(path)];
    }
    let Some(path) = mesh.strip_prefix("package://") else {
        return if mesh.contains("://") { Vec::new() } else { vec![folder.join(mesh)] };
    };
    let path = path.trim_start_matches('/');
    let whole = folder.canonicalize().unwrap_or_else(|_| folder.to_path_buf());
    let listed = |name: &str| variable(name).map(|list| std::env::split_paths(&list).collect::<Vec<_>>());
    let ros = listed("ROS_PACKAGE_PATH").unwrap_or_default().into_iter().flat_map(|folder| {
        // a folder of packages, or the package itself
        let parent = folder.parent().map(|parent| parent.join(path));
        std::iter::once(folder.join(path)).chain(parent)
    });
    let ament =
        listed("AMENT_PREFIX_PATH").unwrap_or_default().into_iter().map(|folder| folder.join("share").join(path));
    whole.ancestors().map(|above| above.join(path)).chain(ros).chain(ament).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn addresses_lead_to_places() {
        let none = |_: &str| None;
        let of = |mesh: &str| candidates(Path::new("/robots/arm/urdf/arm.urdf"), mesh, &none);
        assert_eq!(of("meshes/a.stl"), [Path::new("/robots/arm/urdf/meshes/a.stl")]);
        assert_eq!(of("file:///x/a.stl"), [Path::new("/x/a.stl")]);
        assert!(of("https://a.b/c.stl").is_empty());
        let package = of("package://arm/meshes/a.stl");
        assert!(package.contains(&PathBuf::from("/robots/arm/meshes/a.stl")), "{package:?}");
        assert_eq!(of("package:///arm/meshes/a.stl"), package);
        let paths = |name: &str| match name {
            "ROS_PACKAGE_PATH" => Some(OsString::from("/ws/src/arm")),
            _ => Some(OsString::from("/opt/ros")),
        };
        let found = candidates(Path::new("arm.urdf"), "package://arm/a.stl", &paths);
        for place in ["/ws/src/arm/a.stl", "/opt/ros/share/arm/a.stl"] {
            assert!(found.contains(&PathBuf::from(place)), "{place} in {found:?}");
        }
    }

    #[test]
    fn what_is_missing_is_named_with_a_place() {
        let error =
            locate(Path::new("/robots/arm.urdf"), "package://arm/a.stl").expect_err("nothing there").to_string();
        assert!(error.starts_with("mesh package://arm/a.stl was not found: neither /"), "{error}");
        let error = locate(Path::new("a.urdf"), "http://a/b.stl").expect_err("no network").to_string();
        assert_eq!(error, "mesh http://a/b.stl: expected package://, file://, or a path");
    }
}
