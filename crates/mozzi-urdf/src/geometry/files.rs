//! Locates the meshes that a robot's file names.

use crate::report::visible::visible;
use std::ffi::{OsStr, OsString};
use std::fmt;
use std::path::{Component, Path, PathBuf};

/// A mesh that was not found, or that does not belong to the robot.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct NotLocated {
    /// The name in the robot's file.
    pub file: String,
    /// The places searched; empty for unsupported kinds of addresses.
    pub tried: Vec<PathBuf>,
    /// A file that was found, and is not used because it is outside of the robot's folder and package.
    pub outside: Option<PathBuf>,
}

impl fmt::Display for NotLocated {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let name = visible(&self.file);
        let shown = |path: &Path| visible(&path.display().to_string());
        if let Some(outside) = &self.outside {
            let outside = shown(outside);
            return write!(
                f,
                "mesh {name} is {outside}, outside of the robot's folder and of its package (a folder with \
                 package.xml); a mesh root (--mesh-root in the command line) above it allows it"
            );
        }
        let Some(first) = self.tried.first() else {
            return write!(f, "mesh {name}: expected package://, file://, or a path");
        };
        let first = shown(first);
        match self.tried.len() - 1 {
            0 => write!(f, "mesh {name} was not found: there is no file {first}"),
            1 => write!(f, "mesh {name} was not found: neither {first} nor at 1 other place"),
            more => write!(f, "mesh {name} was not found: neither {first} nor at {more} other places"),
        }?;
        match package_path(&self.file).as_deref().and_then(package_name) {
            Some(package) => {
                let package = visible(&package.to_string_lossy());
                write!(f, "; ROS_PACKAGE_PATH, or --package {package}=DIR in the command line, names its folder")
            }
            None => Ok(()),
        }
    }
}

impl std::error::Error for NotLocated {}

/// Folders chosen by the reader of a robot, in which meshes are searched and may lie.
#[derive(Clone, Copy, Debug, Default)]
pub struct MeshFolders<'f> {
    /// A folder of meshes, or of packages.
    pub root: Option<&'f Path>,
    /// Packages by name, with their folders.
    pub packages: &'f [(String, PathBuf)],
}

impl<'f> From<Option<&'f Path>> for MeshFolders<'f> {
    fn from(root: Option<&'f Path>) -> Self {
        MeshFolders { root, packages: &[] }
    }
}

/// The file of a mesh that the robot in `robot_file` names. A path is relative to the robot's file; `file://` is
/// absolute; `package://NAME/PATH` (two slashes or three) is searched in the given packages, as `NAME/PATH` in every
/// folder above the robot's file, then in those of `ROS_PACKAGE_PATH`, and as `share/NAME/PATH` in those of
/// `AMENT_PREFIX_PATH`. A path or package that is not there is searched in the given root. Nothing is fetched.
///
/// A robot's file must not give access to other files of its reader: with symbolic links followed, the mesh must lie in
/// the folder of the robot's file, in the package around it (the nearest folder above that has a `package.xml`), or in
/// the package of its address. Such a package has a `package.xml`, contains the robot's file, or is one of ROS. Meshes
/// may also lie in the folders chosen by the reader.
///
/// # Errors
/// [`NotLocated`] with the places searched, or with the file that is outside of these folders.
pub fn locate<'f>(robot_file: &Path, mesh: &str, folders: impl Into<MeshFolders<'f>>) -> Result<PathBuf, NotLocated> {
    let folders = folders.into();
    let candidates = candidates(robot_file, mesh, &folders, &|name| std::env::var_os(name));
    let mut own = own_folders(robot_file);
    own.extend(folders.root.and_then(|root| root.canonicalize().ok()));
    let mut outside = None;
    for candidate in candidates.iter().filter(|candidate| candidate.path.is_file()) {
        match candidate.is_allowed(&own) {
            true => return Ok(candidate.path.clone()),
            false => outside = outside.or(Some(candidate.path.clone())),
        }
    }
    Err(NotLocated {
        file: mesh.to_string(),
        tried: candidates.into_iter().map(|candidate| candidate.path).collect(),
        outside,
    })
}

/// The folder of the robot's file and the package around it; for a symbolic link, also those of its target.
fn own_folders(robot_file: &Path) -> Vec<PathBuf> {
    let parent = robot_file.parent().filter(|parent| !parent.as_os_str().is_empty()).unwrap_or(Path::new("."));
    let real = robot_file.canonicalize().ok().and_then(|file| file.parent().map(Path::to_path_buf));
    let folders: Vec<PathBuf> = parent.canonicalize().ok().into_iter().chain(real).collect();
    let package = |folder: &PathBuf| folder.ancestors().find(|above| is_package(above)).map(Path::to_path_buf);
    let packages: Vec<PathBuf> = folders.iter().filter_map(package).collect();
    folders.into_iter().chain(packages).collect()
}

/// The folders of a robot's own files.
pub(crate) struct Own(Vec<PathBuf>);

impl Own {
    /// The folder of the robot's file, the package around it, and further folders.
    pub fn of<'p>(robot_file: &Path, more: impl Iterator<Item = &'p Path>) -> Self {
        Own(own_folders(robot_file).into_iter().chain(more.filter_map(|folder| folder.canonicalize().ok())).collect())
    }

    /// Whether a file is in one of them, or in any package.
    pub fn has(&self, file: &Path) -> bool {
        let Ok(file) = file.canonicalize() else { return true }; // a text that was given
        self.0.iter().any(|own| file.starts_with(own)) || file.ancestors().skip(1).any(is_package)
    }
}

fn is_package(folder: &Path) -> bool {
    folder.join("package.xml").is_file()
}

/// A place where a mesh may be.
struct Candidate {
    path: PathBuf,
    /// The package of a `package://` address, and whether it is one of ROS.
    package: Option<(PathBuf, bool)>,
}

impl Candidate {
    /// True if the file, with symbolic links followed, is in one of these folders or in its package.
    fn is_allowed(&self, own: &[PathBuf]) -> bool {
        let Ok(file) = self.path.canonicalize() else { return false };
        let of_package = self.package.as_ref().and_then(|(folder, is_of_ros)| {
            let folder = folder.canonicalize().ok()?;
            (*is_of_ros || is_package(&folder) || own.iter().any(|own| own.starts_with(&folder))).then_some(folder)
        });
        own.iter().chain(&of_package).any(|folder| file.starts_with(folder))
    }
}

/// The path of a `package://` address, which begins with the package's name.
fn package_path(mesh: &str) -> Option<PathBuf> {
    mesh.strip_prefix("package://").map(|path| PathBuf::from(path.trim_start_matches('/')))
}

fn package_name(path: &Path) -> Option<&OsStr> {
    match path.components().next() {
        Some(Component::Normal(name)) => Some(name),
        _ => None,
    }
}

fn candidates(
    robot_file: &Path,
    mesh: &str,
    given: &MeshFolders<'_>,
    variable: &dyn Fn(&str) -> Option<OsString>,
) -> Vec<Candidate> {
    let folder = robot_file.parent().unwrap_or(Path::new(""));
    let plain = |path: PathBuf| Candidate { path, package: None };
    if let Some(path) = mesh.strip_prefix("file://") {
        return vec![plain(folder.join(path))];
    }
    let in_root = |path: &Path| given.root.map(|root| plain(root.join(path)));
    let Some(path) = package_path(mesh) else {
        let relative = || std::iter::once(plain(folder.join(mesh))).chain(in_root(Path::new(mesh))).collect();
        return if mesh.contains("://") { Vec::new() } else { relative() };
    };
    let path = path.as_path();
    let Some(name) = package_name(path) else { return Vec::new() };
    let inside = path.strip_prefix(name).unwrap_or(path);
    let named = given.packages.iter().filter(|(known, _)| **known == *name);
    let named =
        named.map(|(_, package)| Candidate { path: package.join(inside), package: Some((package.clone(), true)) });
    // the root may be a folder of packages, or the package itself
    let of_root =
        in_root(path).into_iter().chain(in_root(inside).filter(|_| given.root.and_then(Path::file_name) == Some(name)));
    let of = |folder: PathBuf, is_of_ros| Candidate {
        path: folder.join(path),
        package: Some((folder.join(name), is_of_ros)),
    };
    let here = if folder.as_os_str().is_empty() { Path::new(".") } else { folder };
    let whole = here.canonicalize().unwrap_or_else(|_| folder.to_path_buf());
    let listed = |name: &str| variable(name).map(|list| std::env::split_paths(&list).collect::<Vec<_>>());
    let ros = listed("ROS_PACKAGE_PATH").unwrap_or_default().into_iter().flat_map(|folder| {
        // a folder of packages, or the package itself
        let parent = folder.parent().map(Path::to_path_buf);
        std::iter::once(folder).chain(parent)
    });
    let ament = listed("AMENT_PREFIX_PATH").unwrap_or_default().into_iter().map(|folder| folder.join("share"));
    let of_ros = ros.chain(ament).map(|folder| of(folder, true));
    let above = whole.ancestors().map(|above| of(above.to_path_buf(), false));
    named.chain(above).chain(of_ros).chain(of_root).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn addresses_lead_to_places() {
        let none = |_: &str| None;
        let paths = |found: Vec<Candidate>| found.into_iter().map(|found| found.path).collect::<Vec<_>>();
        let of = |mesh: &str| {
            paths(candidates(Path::new("/robots/arm/urdf/arm.urdf"), mesh, &MeshFolders::default(), &none))
        };
        assert_eq!(of("meshes/a.stl"), [Path::new("/robots/arm/urdf/meshes/a.stl")]);
        assert_eq!(of("file:///x/a.stl"), [Path::new("/x/a.stl")]);
        assert!(of("https://a.b/c.stl").is_empty());
        let package = of("package://arm/meshes/a.stl");
        assert!(package.contains(&PathBuf::from("/robots/arm/meshes/a.stl")), "{package:?}");
        assert_eq!(of("package:///arm/meshes/a.stl"), package);
        assert!(of("package://../a.stl").is_empty() && of("package:///").is_empty());
        let variables = |name: &str| match name {
            "ROS_PACKAGE_PATH" => Some(OsString::from("/ws/src/arm")),
            _ => Some(OsString::from("/opt/ros")),
        };
        let found =
            paths(candidates(Path::new("arm.urdf"), "package://arm/a.stl", &MeshFolders::default(), &variables));
        let here = std::env::current_dir().expect("a folder").canonicalize().expect("a folder");
        assert!(found.contains(&here.join("arm/a.stl")), "{found:?}");
        for place in ["/ws/src/arm/a.stl", "/opt/ros/share/arm/a.stl"] {
            assert!(found.contains(&PathBuf::from(place)), "{place} in {found:?}");
        }
        let packages = [("arm".to_string(), PathBuf::from("/x/arm_description"))];
        let given = MeshFolders { root: Some(Path::new("/y/arm")), packages: &packages };
        let found = paths(candidates(Path::new("arm.urdf"), "package://arm/m/a.stl", &given, &none));
        assert_eq!(found[0], Path::new("/x/arm_description/m/a.stl"));
        assert_eq!(found[found.len() - 2..], ["/y/arm/arm/m/a.stl", "/y/arm/m/a.stl"].map(PathBuf::from));
        let found = paths(candidates(Path::new("/r/arm.urdf"), "m/a.stl", &given, &none));
        assert_eq!(found, ["/r/m/a.stl", "/y/arm/m/a.stl"].map(PathBuf::from));
    }

    #[test]
    fn what_is_missing_is_named_with_a_place() {
        let error =
            locate(Path::new("/robots/arm.urdf"), "package://arm/a.stl", None).expect_err("nothing there").to_string();
        assert!(error.starts_with("mesh package://arm/a.stl was not found: neither /"), "{error}");
        assert!(error.ends_with("; ROS_PACKAGE_PATH, or --package arm=DIR in the command line, names its folder"));
        let error = locate(Path::new("a.urdf"), "http://a/b.stl", None).expect_err("no network").to_string();
        assert_eq!(error, "mesh http://a/b.stl: expected package://, file://, or a path");
    }
    #[test]
    #[cfg(unix)]
    fn files_of_others_are_not_meshes_of_the_robot() {
        let top = std::env::temp_dir().join(format!("mozzi-locate-{}", std::process::id()));
        for folder in ["ws/arm/urdf/near", "ws/arm/meshes", "ws/tool/meshes", "ws/secret"] {
            std::fs::create_dir_all(top.join(folder)).expect("a folder");
        }
        let files =
            ["ws/arm/meshes/a.stl", "ws/arm/urdf/near/b.stl", "ws/tool/meshes/c.stl", "ws/secret/d.stl", "e.stl"];
        files.iter().for_each(|file| std::fs::write(top.join(file), "").expect("a file"));
        std::os::unix::fs::symlink(top.join("e.stl"), top.join("ws/arm/urdf/link.stl")).expect("a link");
        std::os::unix::fs::symlink(top.join("e.stl"), top.join("ws/tool/link.stl")).expect("a link");
        let robot = top.join("ws/arm/urdf/arm.urdf");
        std::fs::write(&robot, "").expect("a file");
        let found_below = |mesh: &str, root: Option<&Path>| match locate(&robot, mesh, root) {
            Ok(_) => true,
            Err(error) => {
                assert!(
                    error.outside.is_some() && error.to_string().contains("outside of the robot's folder"),
                    "{error}"
                );
                false
            }
        };
        let absolute = format!("file://{}", top.join("e.stl").display());
        let addresses = [
            "near/b.stl",
            "near/../near/b.stl",
            "../meshes/a.stl",
            "package://arm/meshes/a.stl",
            "package://tool/meshes/c.stl",
            "package://secret/d.stl",
            "link.stl",
            "package://tool/link.stl",
            "package://arm/../../e.stl",
            "../../../e.stl",
            &absolute,
        ];
        let found_with = |root: Option<&Path>, expected: &[usize]| {
            for (k, address) in addresses.iter().enumerate() {
                assert_eq!(found_below(address, root), expected.contains(&k), "{address}");
            }
        };
        let found = |expected: &[usize]| found_with(None, expected);
        found_with(Some(&top.join("ws/arm")), &[0, 1, 2, 3]);
        found_with(Some(&top.join("ws/nowhere")), &[0, 1, 3]);
        found_with(Some(&top.join("ws")), &[0, 1, 2, 3, 4, 5]);
        found(&[0, 1, 3]);
        std::fs::write(top.join("ws/tool/package.xml"), "").expect("a file");
        found(&[0, 1, 3, 4]);
        std::fs::write(top.join("ws/arm/package.xml"), "").expect("a file");
        found(&[0, 1, 2, 3, 4]);
        std::fs::remove_dir_all(&top).expect("removed");
    }
}
