//! The shapes of links: `<visual>` and `<collision>` of URDF, `<geom>` of MJCF. They do not affect the dynamics, except
//! as contact points on request: [`contact_points`].

mod contact;
mod files;
mod filled;
pub(crate) mod hull;
pub(crate) mod inertia;
mod mesh;
pub(crate) mod moments;
mod read;
mod shape;
pub(crate) mod surface;
mod vertices;

pub use contact::{FRICTION, ShapeContacts, contact_points, end_points};
pub(crate) use files::Own;
pub use files::{MeshFolders, NotLocated, locate};
pub use filled::filled_mesh;
pub(crate) use filled::scaled_surface;
pub use mesh::check_mesh;
pub use shape::{Form, Purpose, Shape};
pub use vertices::mesh_corners;

use crate::XacroArguments;
use crate::report::diagnostic::Diagnostic;
use crate::report::error::LoadError;
use crate::report::finding::Findings;
use crate::report::placed::Placed;
use crate::text::context::Context;
use crate::text::dialect::Dialect;
use crate::text::element::Element;
use crate::text::expansion;
use crate::text::pages::Pages;
use crate::text::source::Source;
use crate::text::{bytes, syntax};
use crate::urdf::version;
use crate::{embedded, file_bytes, folder_of, mjcf};
use mozzi::SE3;
use std::path::Path;

/// The shapes of a robot.
#[derive(Clone, Debug, Default)]
pub struct Geometry {
    /// In the order of the file.
    pub shapes: Vec<Shape>,
    /// Planes of an MJCF that do not move and touch the robot, with their names.
    pub planes: Vec<(String, SE3)>,
    /// Attributes and elements of MuJoCo's contacts, in words, that mozzi's rigid ones do not use.
    pub unused: Vec<String>,
    /// Invalid shapes, which are omitted: warnings, since shapes do not affect the dynamics.
    pub left_out: Vec<Diagnostic>,
}

/// The shapes of an embedded robot by its name, or of a file: URDF, or MJCF with its included files. JSON has none.
///
/// # Errors
/// [`LoadError::File`] when it cannot be read, [`LoadError::NoSuchRobot`] when there is neither.
pub fn geometry(name_or_path: &str) -> Result<Geometry, LoadError> {
    geometry_with(name_or_path, &XacroArguments::default())
}

/// As [`geometry`], with xacro arguments.
///
/// # Errors
/// As for [`geometry`]; [`LoadError::Refused`] if xacro cannot expand the file.
pub fn geometry_with(name_or_path: &str, arguments: &XacroArguments) -> Result<Geometry, LoadError> {
    if let Some(text) = embedded::unless_file(name_or_path) {
        return Ok(parse(&format!("{name_or_path}.urdf"), text));
    }
    if !Path::new(name_or_path).exists() {
        return Err(LoadError::NoSuchRobot { name: name_or_path.to_string() });
    }
    let path = Path::new(name_or_path);
    parse_in(path.parent(), name_or_path, &file_bytes(path)?, arguments)
}

/// The shapes of a text. Diagnostics use the name as its file name.
pub fn parse(file_name: &str, text: impl AsRef<[u8]>) -> Geometry {
    parse_with(file_name, text, &XacroArguments::default())
}

/// As [`parse`], with xacro arguments; no shapes if xacro cannot expand the text.
pub fn parse_with(file_name: &str, text: impl AsRef<[u8]>, arguments: &XacroArguments) -> Geometry {
    parse_in(None, file_name, text.as_ref(), arguments).unwrap_or_default()
}

/// The shapes of a text. Files that an MJCF text includes are searched in a folder.
fn parse_in(
    folder: Option<&Path>,
    file_name: &str,
    text: &[u8],
    arguments: &XacroArguments,
) -> Result<Geometry, LoadError> {
    if text.trim_ascii_start().starts_with(b"{") {
        return Ok(Geometry::default()); // JSON
    }
    let mut findings = Findings::default();
    let source = Source::new(file_name, bytes::read(text, &mut findings));
    let (source, _) = expansion::prepare(source, arguments)?; // the model's reader reports warnings
    let dialect = Dialect::of(&source.text);
    let source = syntax::mended(source, dialect, &mut Findings::default()); // the model's reader reports it
    let mut shapes = Vec::new();
    if dialect == Dialect::Mjcf && !findings.has_errors() {
        let mut sources = vec![source];
        let (found, cx) = mjcf::shapes(&mut sources, folder_of(folder, file_name, arguments), arguments);
        return Ok(placed(found, cx.findings, &sources, dialect));
    }
    if dialect == Dialect::Urdf && source.text.trim_start().starts_with('<') {
        match syntax::parse(&source, Dialect::Urdf) {
            Err(finding) => findings.add(finding),
            Ok(document) => {
                let mut cx = Context::new(findings, Dialect::Urdf);
                if let Some(root) = Element::root(&Pages::single(&source, document), "robot") {
                    cx.version = version::read(&root, &mut cx);
                    shapes = read::robot(&root, &mut cx);
                    cx.report_repeated();
                }
                findings = cx.findings;
            }
        }
    }
    Ok(placed(Geometry { shapes, ..Geometry::default() }, findings, &[source], dialect))
}

/// The number of shapes of a text, readable or not: `<geom>` of bodies in MJCF, else `<visual>` and `<collision>` of
/// links. Included files and the default classes of MJCF are not counted.
pub fn shape_count(text: &str) -> usize {
    let Ok(document) = roxmltree::Document::parse(text.strip_prefix('\u{feff}').unwrap_or(text)) else { return 0 };
    let is_shape = |node: &roxmltree::Node<'_, '_>| match node.tag_name().name() {
        "geom" => node.ancestors().any(|above| above.has_tag_name("worldbody")),
        "visual" | "collision" => node.parent().is_some_and(|above| above.has_tag_name("link")),
        _ => false,
    };
    document.descendants().filter(is_shape).count()
}

fn placed(found: Geometry, findings: Findings, sources: &[Source], dialect: Dialect) -> Geometry {
    let placed = Placed::of(findings, sources, dialect);
    Geometry { left_out: placed.diagnostics.into_iter().map(Diagnostic::into_warning).collect(), ..found }
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
        let Geometry { shapes, left_out, .. } = parse("arm.urdf", ARM);
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

    const FIGURE: &str = r#"<mujoco>
  <compiler angle="radian" meshdir="assets"/>
  <default>
    <geom type="capsule" size="0.1 0.2" rgba="0 1 0 1"/><mesh scale="0.001 0.001 0.001"/>
    <default class="contact"><geom type="box" size="0.5 1 2" group="3"/></default>
  </default>
  <asset>
    <mesh file="deep/hand.stl" refpos="100 0 0"/>
    <mesh name="points" vertex="0 0 0 1 0 0 0 1 0 0 0 1"/>
    <material name="steel" rgba="0.5 0.5 0.6 1"/>
  </asset>
  <worldbody>
    <geom type="plane" size="1 1 1"/>
    <body name="arm" pos="0 0 5">
      <inertial pos="0 0 0" mass="1" diaginertia="1 1 1"/>
      <joint type="hinge" axis="0 1 0"/>
      <geom fromto="0 0 0 0 0 1"/>
      <geom class="contact"/>
      <frame pos="0 3 0"><geom type="ellipsoid" size="1 2 3" pos="1 0 0"/></frame>
      <geom type="mesh" mesh="hand" material="steel" rgba="1 0 0 0.5"/>
      <geom type="mesh" mesh="points"/>
      <geom type="sphere" size="1" rgba="0 0 0 0"/>
      <geom type="cylinder" size="0" pos="0 0 1"/>
    </body>
  </worldbody>
</mujoco>"#;

    #[test]
    fn geoms_are_shapes() {
        let Geometry { shapes, left_out, .. } = parse("figure.xml", FIGURE);
        let forms: Vec<_> = shapes.iter().map(|shape| (shape.purpose, shape.form.clone())).collect();
        let hand = Form::Mesh { file: "assets/deep/hand.stl".into(), scale: [0.001; 3] };
        let expected = [
            (Purpose::Visual, Form::Capsule { radius: 0.1, length: 1.0 }),
            (Purpose::Collision, Form::Box { size: [1.0, 2.0, 4.0] }),
            (Purpose::Visual, Form::Ellipsoid { radii: [1.0, 2.0, 3.0] }),
            (Purpose::Visual, hand),
            // transparent: not drawn, and touched all the same
            (Purpose::Collision, Form::Sphere { radius: 1.0 }),
        ];
        assert_eq!(forms, expected);
        assert!(shapes.iter().all(|shape| shape.link == "arm"));
        assert_eq!((shapes[0].T.p, shapes[2].T.p), (Vec3([0.0, 0.0, 0.5]), Vec3([1.0, 3.0, 0.0])));
        assert!((shapes[3].T.p - Vec3([-0.1, 0.0, 0.0])).norm() < 1e-15, "the reference point is subtracted");
        assert_eq!((shapes[0].color, shapes[3].color), (Some([0.0, 1.0, 0.0, 1.0]), Some([1.0, 0.0, 0.0, 0.5])));
        let said: Vec<_> = left_out.iter().map(|found| (found.line(), found.code())).collect();
        assert_eq!(said, [(21, "mozzi::mjcf::ignored_mesh"), (23, "mozzi::mjcf::missing_size")], "{left_out:?}");
        // with a free body as the base, the world's shapes are not drawn
        let free = FIGURE.replace("<joint type=\"hinge\" axis=\"0 1 0\"/>", "<freejoint/>");
        let shapes = parse("figure.xml", free).shapes;
        assert!(shapes.len() == 5 && shapes.iter().all(|shape| shape.link == "arm"));
    }

    /// As in MuJoCo: by `contype` and `conaffinity`, those of classes too, on planes of the world and of bodies that do
    /// not move; what is not used is named.
    #[test]
    fn geoms_touch_planes_by_their_bits() {
        const BOX: &str = "<geom class='b' type='box' size='1 1 1'/>";
        let scene = |defaults: &str, plane: &str, rest: &str| {
            parse(
                "scene.xml",
                format!(
                    "<mujoco><default>{defaults}<default class='b'/></default><worldbody>{plane}
                     <body name='a'><freejoint/><inertial pos='0 0 0' mass='1' diaginertia='1 1 1'/>{BOX}</body>
                     </worldbody>{rest}</mujoco>"
                ),
            )
        };
        let of = |defaults: &str, plane: &str| {
            let found = scene(defaults, plane, "");
            (found.shapes[0].touches, found.planes.len(), found.shapes[0].friction)
        };
        const PLANE: &str = "<geom type='plane' size='1 1 1'/>";
        let with = |attributes: &str| PLANE.replace("/>", &format!(" contype='1' conaffinity='1' {attributes}/>"));
        assert_eq!(of("", PLANE), (true, 1, Some(1.0)));
        assert_eq!(of("<geom friction='.2 .005'/>", PLANE), (true, 1, Some(0.2)));
        assert_eq!(of("<geom contype='0' conaffinity='0'/>", &with("")), (false, 0, Some(1.0)));
        assert_eq!(of("<geom contype='0' conaffinity='0'/>", ""), (false, 0, Some(1.0)));
        assert_eq!(of("<geom contype='2' conaffinity='2'/>", PLANE), (true, 1, Some(1.0)));
        assert_eq!(of("<geom contype='2' conaffinity='2'/>", ""), (false, 0, Some(1.0)));
        assert_eq!(of("<geom contype='2' conaffinity='4'/>", PLANE), (false, 0, Some(1.0)));
        let on_a_table = scene("", &format!("<body pos='0 0 -0.2'>{PLANE}</body>"), "");
        assert_eq!(on_a_table.planes[0].1.p, Vec3([0.0, 0.0, -0.2]));
        let rest = "<option><flag contact='disable'/></option>
                    <contact><exclude body1='world' body2='a'/></contact>";
        let found = scene("<geom friction='.3' condim='1' priority='0' margin='.01'/>", &with("friction='.4'"), rest);
        let friction = "the friction 0.4 of the plane `ground` (MuJoCo takes the larger of two)";
        let expected = ["margin (2 geoms)", "condim (2 geoms)", friction, "1 <exclude>", "contact=\"disable\""];
        assert_eq!(found.unused, expected);
    }

    #[test]
    fn other_languages_have_none_and_broken_files_say_why() {
        assert!(parse("a.json", "{}").left_out.is_empty());
        assert_eq!(parse("a.urdf", "<robot name='a'><link").left_out.len(), 1);
        assert!(matches!(geometry("no_such_robot"), Err(LoadError::NoSuchRobot { .. })));
        assert!(geometry("ur5").expect("embedded").left_out.is_empty());
    }
}
