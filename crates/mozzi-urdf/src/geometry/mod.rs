//! What a URDF says of its links' looks: `<visual>` and `<collision>`, which say nothing about the dynamics.

mod files;
mod mesh;
mod read;
mod shape;

pub use files::{NotLocated, locate};
pub use mesh::check_mesh;
pub use shape::{Form, Purpose, Shape};

use crate::context::Context;
use crate::diagnostic::Diagnostic;
use crate::dialect::Dialect;
use crate::error::LoadError;
use crate::finding::Findings;
use crate::pages::Pages;
use crate::source::Source;
use crate::version::Version;
use crate::{bytes, embedded, file_bytes, syntax};
use std::path::Path;

/// The shapes of a robot.
#[derive(Clone, Debug, Default)]
pub struct Geometry {
    /// In the order of the file.
    pub shapes: Vec<Shape>,
    /// Invalid shapes, which are omitted: warnings, since shapes do not affect the dynamics.
    pub left_out: Vec<Diagnostic>,
}

/// The shapes of an embedded robot by its name, or of a URDF file. None in files of other languages: MJCF, JSON.
///
/// # Errors
/// [`LoadError::File`] when it cannot be read, [`LoadError::NoSuchRobot`] when there is neither.
pub fn geometry(name_or_path: &str) -> Result<Geometry, LoadError> {
    if let Some(text) = embedded::unless_file(name_or_path) {
        return Ok(parse(&format!("{name_or_path}.urdf"), text));
    }
    if !Path::new(name_or_path).exists() {
        return Err(LoadError::NoSuchRobot { name: name_or_path.to_string() });
    }
    Ok(parse(name_or_path, file_bytes(Path::new(name_or_path))?))
}

/// The shapes of a text. Diagnostics use the name as its file name.
pub fn parse(file_name: &str, text: impl AsRef<[u8]>) -> Geometry {
    let mut findings = Findings::default();
    let source = Source::new(file_name, bytes::read(text.as_ref(), &mut findings));
    let source = syntax::mended(source, Dialect::Urdf, &mut Findings::default()); // the model's reader reports it
    let mut shapes = Vec::new();
    if Dialect::of(&source.text) == Dialect::Urdf && source.text.trim_start().starts_with('<') {
        match syntax::parse(&source, Dialect::Urdf) {
            Err(finding) => findings.add(finding),
            Ok(document) => {
                let mut cx = Context::new(findings, Dialect::Urdf);
                if let Some(root) = Pages::single(&source, document).root("robot") {
                    cx.version = Version::read(&root, &mut cx);
                    shapes = read::robot(&root, &mut cx);
                    cx.report_repeated();
                }
                findings = cx.findings;
            }
        }
    }
    let placed = findings.place(&[source], Dialect::Urdf);
    Geometry { shapes, left_out: placed.diagnostics.into_iter().map(Diagnostic::into_warning).collect() }
}

#[cfg(test)]
mod tests {
    use super::*;
    use mozzi::Vec3;

    const ARM: &str = r##"<robot name="arm">
  <material name="steel"><color rgba="0.5 0.5 0.6 1"/></material>
  <link name="base">
    <visual><geometry><box size="1 2 3"/></geometry><material name="steel"/></visual>
    <collision><origin xyz="0 0 0.5"/><geometry><cylinder radius="0.1" length="1"/></geometry></collision>
  </link>
  <link name="arm">
    <visual><geometry><mesh filename="package://arm/meshes/arm.STL" scale="1 -1 1"/></geometry>
      <material name="red"><color rgba="1 0 0 1"/></material></visual>
    <visual><geometry><sphere radius="0,1"/></geometry></visual>
    <visual><geometry><box size="1 2"/></geometry></visual>
    <visual><geometry><torus radius="1"/></geometry></visual>
    <visual/>
    <visual><origin xyz="1 0 0" rpy="0 x 0"/><geometry><sphere radius="1"/></geometry></visual>
    <visual><geometry><sphere radius="-1"/></geometry></visual>
    <collision><geometry><capsule radius="0.2" length="0.4"/></geometry></collision>
  </link>
  <joint name="j" type="fixed"><parent link="base"/><child link="arm"/></joint>
</robot>"##;

    #[test]
    fn shapes_are_read_with_their_places_and_colours() {
        let Geometry { shapes, left_out } = parse("arm.urdf", ARM);
        let forms: Vec<_> = shapes.iter().map(|shape| (&*shape.link, shape.purpose, shape.form.clone())).collect();
        let mesh = Form::Mesh { file: "package://arm/meshes/arm.STL".into(), scale: [1.0, -1.0, 1.0] };
        assert_eq!(
            forms,
            [
                ("base", Purpose::Visual, Form::Box { size: [1.0, 2.0, 3.0] }),
                ("base", Purpose::Collision, Form::Cylinder { radius: 0.1, length: 1.0 }),
                ("arm", Purpose::Visual, mesh),
                ("arm", Purpose::Collision, Form::Capsule { radius: 0.2, length: 0.4 }),
            ]
        );
        assert_eq!(shapes[0].color, Some([0.5, 0.5, 0.6, 1.0]));
        assert_eq!((shapes[1].T.p, shapes[1].color), (Vec3([0.0, 0.0, 0.5]), None));
        assert_eq!(shapes[2].color, Some([1.0, 0.0, 0.0, 1.0]));
        let said: Vec<_> = left_out.iter().map(|found| (found.line(), found.code())).collect();
        let expected = [
            (10, "mozzi::urdf::decimal_comma"),
            (11, "mozzi::urdf::wrong_count"),
            (12, "mozzi::urdf::unknown_element"),
            (13, "mozzi::urdf::missing_element"),
            (14, "mozzi::urdf::not_a_number"),
            (15, "mozzi::urdf::not_a_number"),
        ];
        assert_eq!(said, expected, "{left_out:?}");
        assert!(left_out.iter().all(|found| found.severity() == crate::Severity::Warning));
    }

    #[test]
    fn other_languages_have_none_and_broken_files_say_why() {
        let none = parse("a.xml", "<mujoco><worldbody><geom type='box' size='1 1 1'/></worldbody></mujoco>");
        assert!(none.shapes.is_empty() && none.left_out.is_empty());
        assert!(parse("a.json", "{}").left_out.is_empty());
        assert_eq!(parse("a.urdf", "<robot name='a'><link").left_out.len(), 1);
        assert!(matches!(geometry("no_such_robot"), Err(LoadError::NoSuchRobot { .. })));
        assert!(geometry("ur5").expect("embedded").left_out.is_empty());
    }
}
