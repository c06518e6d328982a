//! The shapes of a robot, with the files of their meshes.

use crate::base64;
use flate2::{Compression, read::GzDecoder, write::GzEncoder};
use mozzi::{Model, SE3};
use mozzi_urdf::geometry::{Form, Geometry, MeshFolders, Purpose, Shape, check_mesh, geometry_with, locate, parse};
use mozzi_urdf::{LoadError, XacroArguments, files, visible};
use serde_json::{Value, json};
use std::collections::{BTreeMap, BTreeSet};
use std::io::{Read, Write};
use std::path::Path;

/// A larger file is left out.
const MOST_BYTES: u64 = 64 << 20;
/// When all meshes of a page together have more bytes, the rest is omitted.
const MOST_OF_ALL: u64 = 256 << 20;

/// The formats that the page reads, by the files' endings.
const FORMATS: [&str; 3] = ["stl", "obj", "dae"];

/// The meshes that are embedded in the page.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Meshes {
    /// Visual meshes; for a link without any, its collision meshes.
    #[default]
    Visual,
    /// Collision meshes, which are mostly smaller; for a link without any, its visual boxes, cylinders and balls.
    Collision,
    /// No meshes: only boxes, cylinders and balls, and a skeleton.
    None,
}

/// The shapes of a robot and the files of their meshes, ready for a page.
#[derive(Clone, Debug, Default)]
pub struct Drawing {
    shapes: Vec<Shape>,
    /// By the address in the robot's file.
    meshes: Vec<Mesh>,
    /// Omitted shapes and the reasons, a sentence each.
    pub notes: Vec<String>,
    /// Addresses of meshes, and whether they were read: each once.
    tried: BTreeMap<String, bool>,
    /// Bytes of the meshes' files.
    bytes: u64,
}

#[derive(Clone, Debug)]
struct Mesh {
    address: String,
    format: &'static str,
    gzip: Vec<u8>,
}

impl Drawing {
    /// The drawing of an embedded robot or of a file. Meshes that are not found are omitted, with a note.
    ///
    /// # Errors
    /// [`LoadError::File`] when it cannot be read, [`LoadError::NoSuchRobot`] when there is neither.
    pub fn of_file(name_or_path: &str, meshes: Meshes) -> Result<Self, LoadError> {
        Self::of_file_below(name_or_path, &XacroArguments::default(), meshes, None)
    }

    /// As [`of_file`](Self::of_file), with xacro arguments, whose packages may contain meshes, and the folder
    /// `mesh_root`, which may contain meshes outside of the robot's folder, such as in a folder next to it.
    ///
    /// # Errors
    /// As [`of_file`](Self::of_file); [`LoadError::Refused`] if xacro cannot expand the file.
    pub fn of_file_below(
        name_or_path: &str,
        arguments: &XacroArguments,
        meshes: Meshes,
        mesh_root: Option<&Path>,
    ) -> Result<Self, LoadError> {
        let folders = MeshFolders { root: mesh_root, packages: &arguments.packages };
        Ok(Self::new(geometry_with(name_or_path, arguments)?, Path::new(name_or_path), meshes, folders))
    }

    /// The drawing of a text, such as one from a pipe: without meshes, since it has no folder.
    pub fn of_text(file_name: &str, text: &[u8], meshes: Meshes) -> Self {
        let mut found = parse(file_name, text);
        let all = found.shapes.len();
        found.shapes.retain(|shape| !matches!(shape.form, Form::Mesh { .. }));
        let meshless = all - found.shapes.len();
        let mut drawing = Self::new(found, Path::new(file_name), meshes, MeshFolders::default());
        if meshless > 0 && meshes != Meshes::None {
            drawing
                .notes
                .push(format!("{meshless} meshes: {file_name} has no folder, in which they could be searched"));
        }
        drawing
    }

    fn new(Geometry { shapes, left_out, .. }: Geometry, file: &Path, meshes: Meshes, folders: MeshFolders<'_>) -> Self {
        let mut drawing = Drawing { notes: left_out.iter().map(ToString::to_string).collect(), ..Drawing::default() };
        for shape in chosen(shapes, meshes) {
            if drawing.has_mesh(&shape.form, file, folders) {
                drawing.shapes.push(shape);
            }
        }
        drawing
    }

    /// Reads the mesh of a form, if it has one; returns false, with a note, if that fails.
    fn has_mesh(&mut self, form: &Form, robot_file: &Path, folders: MeshFolders<'_>) -> bool {
        let Form::Mesh { file, .. } = form else { return true };
        if let Some(is_read) = self.tried.get(file) {
            return *is_read;
        }
        let read = match self.bytes > MOST_OF_ALL {
            true => Err(format!("mesh {}: all meshes together have more than {MOST_OF_ALL} bytes", visible(file))),
            false => read(robot_file, file, folders),
        };
        self.tried.insert(file.clone(), read.is_ok());
        match read {
            Ok((format, gzip, bytes)) => {
                self.bytes += bytes;
                self.meshes.push(Mesh { address: file.clone(), format, gzip });
                true
            }
            Err(why) => {
                self.notes.push(why);
                false
            }
        }
    }

    pub(crate) fn shapes(&self) -> &[Shape] {
        &self.shapes
    }

    /// The format and the content of a mesh, by its address in the robot's file.
    pub(crate) fn mesh_file(&self, address: &str) -> Result<(&'static str, Vec<u8>), String> {
        let mesh = self.meshes.iter().find(|mesh| mesh.address == address).ok_or("it was not read")?;
        let mut bytes = Vec::new();
        GzDecoder::new(&*mesh.gzip).read_to_end(&mut bytes).map_err(|error| error.to_string())?;
        Ok((mesh.format, bytes))
    }

    pub(crate) fn meshes_to_json(&self) -> Value {
        let mesh =
            |mesh: &Mesh| json!({ "name": mesh.address, "format": mesh.format, "gzip": base64::encode(&mesh.gzip) });
        self.meshes.iter().map(mesh).collect()
    }

    /// Shapes of links without a frame in the model (such as the parent of a floating base) are omitted.
    pub(crate) fn shapes_to_json(&self, model: &Model) -> Value {
        let frame_of = |link: &str| model.frames().position(|(_, known)| known == link);
        let shape = |shape: &Shape| {
            Some(json!({
                "frame": frame_of(&shape.link)?, "use": shape.purpose.name(), "T": rows(shape.T),
                "kind": shape.form.name(), "size": shape.form.size(), "mesh": self.mesh_of(&shape.form), "color": shape.color,
            }))
        };
        self.shapes.iter().filter_map(shape).collect()
    }

    /// The place of a form's mesh, if it has one.
    fn mesh_of(&self, form: &Form) -> Option<usize> {
        let Form::Mesh { file, .. } = form else { return None };
        self.meshes.iter().position(|mesh| mesh.address == *file)
    }
}

/// The shapes that are drawn.
fn chosen(shapes: Vec<Shape>, meshes: Meshes) -> Vec<Shape> {
    let links = |purpose| -> BTreeSet<String> {
        shapes.iter().filter(|shape| shape.purpose == purpose).map(|shape| shape.link.clone()).collect()
    };
    let (looks, contacts) = (links(Purpose::Visual), links(Purpose::Collision));
    let is_chosen = |shape: &Shape| match (meshes, shape.purpose) {
        (Meshes::None, _) if matches!(shape.form, Form::Mesh { .. }) => false,
        (Meshes::Collision, Purpose::Visual) => {
            !contacts.contains(&shape.link) && !matches!(shape.form, Form::Mesh { .. })
        }
        (Meshes::Collision, Purpose::Collision) => true,
        (_, Purpose::Visual) => true,
        (_, Purpose::Collision) => !looks.contains(&shape.link),
    };
    shapes.into_iter().filter(is_chosen).collect()
}

/// The format of a mesh, its gzipped file and the size of the file, or the reason why it is omitted.
fn read(robot_file: &Path, address: &str, folders: MeshFolders<'_>) -> Result<(&'static str, Vec<u8>, u64), String> {
    let ending = Path::new(address).extension().map(|ending| ending.to_string_lossy().to_lowercase());
    let Some(&format) = FORMATS.iter().find(|format| ending.as_deref() == Some(**format)) else {
        return Err(format!("mesh {}: is no .stl, .obj or .dae", visible(address)));
    };
    let path = locate(robot_file, address, folders).map_err(|error| error.to_string())?;
    let place = visible(&format!("mesh {address}: {}", path.display()));
    let cannot = |error: std::io::Error| format!("{place} cannot be read: {error}");
    let bytes = files::read(&path, MOST_BYTES).map_err(cannot)?;
    check_mesh(format, &bytes).map_err(|why| format!("{place} is no mesh: {why}"))?;
    let mut gzip = GzEncoder::new(Vec::new(), Compression::default());
    gzip.write_all(&bytes).and_then(|()| gzip.finish()).map(|gzip| (format, gzip, bytes.len() as u64)).map_err(cannot)
}

/// The first three rows of a configuration's matrix.
pub(crate) fn rows(T: SE3) -> Vec<f64> {
    T.to_matrix()[..3].concat()
}

#[cfg(test)]
mod tests {
    use super::*;

    const ARM: &str = r#"<robot name="arm">
  <link name="a"><visual><geometry><mesh filename="a.stl"/></geometry></visual>
    <visual><geometry><mesh filename="a.stl" scale="2 2 2"/></geometry></visual>
    <collision><geometry><box size="1 1 1"/></geometry></collision></link>
  <link name="b"><visual><geometry><mesh filename="b.ply"/></geometry></visual>
    <visual><geometry><mesh filename="c.obj"/></geometry></visual></link>
  <link name="d"><collision><geometry><sphere radius="1"/></geometry></collision></link>
</robot>"#;

    const TRIANGLE: &str = "solid a\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\n\
                            endloop\nendfacet\nendsolid a\n";

    #[test]
    fn files_that_are_no_meshes_stay_out() {
        let folder = std::env::temp_dir().join(format!("mozzi-secret-{}", std::process::id()));
        std::fs::create_dir_all(folder.join("arm")).expect("a folder");
        let secret = folder.join("secret.stl");
        std::fs::write(&secret, TRIANGLE).expect("a file");
        std::fs::write(folder.join("arm/a.stl"), "password = 1\n").expect("a file");
        let robot = ARM.replace("b.ply", "../secret.stl").replace("c.obj", &secret.to_string_lossy());
        let file = folder.join("arm/arm.urdf");
        std::fs::write(&file, &robot).expect("a file");
        let drawing = Drawing::of_file(&file.to_string_lossy(), Meshes::Visual).expect("read");
        assert!(drawing.meshes.is_empty() && drawing.notes.len() == 3, "{:?}", drawing.notes);
        assert!(drawing.notes[0].contains("a.stl is no mesh: line 1: expected `solid`"), "{:?}", drawing.notes);
        for note in &drawing.notes[1..] {
            assert!(note.contains("secret.stl, outside of the robot's folder"), "{note}");
        }
        let below =
            Drawing::of_file_below(&file.to_string_lossy(), &XacroArguments::default(), Meshes::Visual, Some(&folder))
                .expect("read");
        assert!(below.meshes.len() == 2 && below.notes.len() == 1, "{:?}", below.notes);
        let piped = Drawing::of_text("standard input", robot.as_bytes(), Meshes::Visual);
        assert!(piped.notes[0].starts_with("4 meshes: standard input has no folder"), "{:?}", piped.notes);
        std::fs::remove_dir_all(&folder).expect("removed");
    }

    #[test]
    fn meshes_are_read_once_and_what_is_missing_is_noted() {
        let folder = std::env::temp_dir().join(format!("mozzi-drawing-{}", std::process::id()));
        std::fs::create_dir_all(&folder).expect("a folder");
        let file = folder.join("arm.urdf");
        std::fs::write(&file, ARM).expect("a file");
        std::fs::write(folder.join("a.stl"), TRIANGLE).expect("a file");
        let of = |meshes| Drawing::of_file(&file.to_string_lossy(), meshes).expect("read");
        let drawing = of(Meshes::Visual);
        let kinds: Vec<_> = drawing.shapes.iter().map(|shape| (&*shape.link, shape.purpose.name())).collect();
        assert_eq!(kinds, [("a", "visual"), ("a", "visual"), ("d", "collision")]);
        assert_eq!(drawing.meshes.len(), 1);
        assert!(drawing.meshes[0].gzip.starts_with(&[0x1f, 0x8b]));
        assert_eq!(drawing.notes[0], "mesh b.ply: is no .stl, .obj or .dae");
        assert!(drawing.notes[1].starts_with("mesh c.obj was not found: there is no file "), "{:?}", drawing.notes);
        assert_eq!((of(Meshes::Collision).shapes.len(), of(Meshes::None).shapes.len()), (2, 1));
        std::fs::remove_dir_all(&folder).expect("removed");
    }
}
