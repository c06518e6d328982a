//! A second reader of URDF, for numbers of any width: it takes the tree from the first reader's description, and each
//! number from the file's decimals.

use crate::wide::Wide;
use mozzi::linalg::Sym3;
use mozzi::model::description::{JointKind, Mimic};
use mozzi::{Description, SE3, SO3, ScrewAxis, SpatialInertia, Twist, Vec3};
use roxmltree::{Document, Node};
use std::fmt;

/// The reason why a file was not read a second time.
#[derive(Clone, Debug, PartialEq)]
pub struct NotRead(String);

impl fmt::Display for NotRead {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.0)
    }
}
impl std::error::Error for NotRead {}

type Read<T> = Result<T, NotRead>;

fn child<'a, 'i>(node: Node<'a, 'i>, name: &str) -> Option<Node<'a, 'i>> {
    node.children().find(|child| child.has_tag_name(name))
}

/// The numbers of an attribute, `default` if it is missing.
fn numbers<W: Wide, const N: usize>(node: Option<Node>, name: &str, default: &str) -> Read<[W; N]> {
    let text = node.and_then(|node| node.attribute(name)).unwrap_or(default);
    let all: Option<Vec<W>> = text.split_whitespace().map(W::parse).collect();
    let all = all.and_then(|all| all.try_into().ok());
    all.ok_or_else(|| NotRead(format!("{name}=\"{text}\": expected {N} numbers")))
}

fn number<W: Wide>(node: Option<Node>, name: &str, default: &str) -> Read<W> {
    numbers::<W, 1>(node, name, default).map(|[x]| x)
}

fn origin<W: Wide>(node: Node) -> Read<SE3<W>> {
    let origin = child(node, "origin");
    let [roll, pitch, yaw] = numbers(origin, "rpy", "0 0 0")?;
    Ok(SE3 { R: SO3::from_rpy(roll, pitch, yaw), p: Vec3(numbers(origin, "xyz", "0 0 0")?) })
}

fn inertia<W: Wide>(link: Node) -> Read<SpatialInertia<W>> {
    let Some(inertial) = child(link, "inertial") else { return Ok(SpatialInertia::zero()) };
    let T = origin(inertial)?;
    let entry = |name: &str| number(child(inertial, "inertia"), name, "");
    let I = Sym3 {
        xx: entry("ixx")?,
        xy: entry("ixy")?,
        xz: entry("ixz")?,
        yy: entry("iyy")?,
        yz: entry("iyz")?,
        zz: entry("izz")?,
    };
    Ok(SpatialInertia::new(number(child(inertial, "mass"), "value", "")?, T.p, I.congruence(T.R.matrix())))
}

/// A ball, which URDF cannot express, is taken from the description.
fn kind<W: Wide>(joint: Node, described: JointKind<W>) -> Read<JointKind<W>> {
    if let JointKind::Ball(_) = described {
        return Ok(described);
    }
    let direction = || Ok(Vec3(numbers(child(joint, "axis"), "xyz", "1 0 0")?));
    let twist = match joint.attribute("type") {
        Some("fixed") => return Ok(JointKind::Fixed),
        Some("floating") => return Ok(JointKind::Free),
        Some("revolute" | "continuous") => Twist { w: direction()?, v: Vec3::zero() },
        Some("prismatic") => Twist::linear(direction()?),
        other => return Err(NotRead(format!("a joint of type {}", other.unwrap_or("none")))),
    };
    let axis = ScrewAxis::normalize(twist).map_err(|error| NotRead(error.to_string()))?;
    Ok(JointKind::Screw(axis.0))
}

/// The first reader's description of a file, with the file's decimals in wide numbers. Gravity, which files do not
/// contain, is taken from the description's shortest decimals; balls and rotor inertias, which URDF cannot express, are
/// the description's numbers.
///
/// # Errors
/// [`NotRead`] if the second reader does not know an element, or the two readers disagree.
pub fn read_urdf<W: Wide>(text: &str, robot: &Description) -> Result<Description<W>, NotRead> {
    let document = Document::parse(text).map_err(|error| NotRead(error.to_string()))?;
    let named = |tag: &str, name: &str| {
        let mut elements = document.root_element().children();
        let found = elements.find(|node| node.has_tag_name(tag) && node.attribute("name") == Some(name));
        found.ok_or_else(|| NotRead(format!("there is no <{tag} name=\"{name}\">")))
    };
    let mut wide = robot.map(W::from_f64);
    for (wide, gravity) in wide.gravity.iter_mut().zip(robot.gravity) {
        *wide = W::parse(&format!("{gravity}")).ok_or_else(|| NotRead(format!("gravity {gravity}")))?;
    }
    for link in &mut wide.links {
        link.inertia = inertia(named("link", &link.name)?)?;
    }
    for joint in &mut wide.joints {
        let node = named("joint", &joint.name)?;
        (joint.origin, joint.kind) = (origin(node)?, kind(node, joint.kind)?);
        let dynamics = child(node, "dynamics").filter(|_| joint.kind != JointKind::Free); // not for free joints
        (joint.damping, joint.friction) = (number(dynamics, "damping", "0")?, number(dynamics, "friction", "0")?);
        joint.stiffness = number(dynamics, "spring_stiffness", "0")?;
        joint.spring_reference = number(dynamics, "spring_reference", "0")?;
        if let (Some(mimic), Some(node)) = (&mut joint.mimic, child(node, "mimic")) {
            let (ratio, offset) = (number(Some(node), "multiplier", "1")?, number(Some(node), "offset", "0")?);
            *mimic = Mimic { joint: mimic.joint.clone(), ratio, offset };
        }
    }
    agree(&wide.map(Into::into), robot)?;
    Ok(wide)
}

/// Checks that both readers read the same robot, to rounding.
fn agree(second: &Description, first: &Description) -> Read<()> {
    let near = |what: &str, a: &[f64], b: &[f64]| {
        let size = b.iter().fold(0.0_f64, |m, x| m.max(x.abs()));
        match a.iter().zip(b).all(|(a, b)| (a - b).abs() <= 1e-14 * size) {
            true => Ok(()),
            false => Err(NotRead(format!("{what}: the second reader finds {a:?}, the first {b:?}"))),
        }
    };
    for (a, b) in second.links.iter().zip(&first.links) {
        near(&b.name, &a.inertia.to_parameters(), &b.inertia.to_parameters())?;
    }
    for (a, b) in second.joints.iter().zip(&first.joints) {
        let screw = |kind: JointKind| match kind {
            JointKind::Screw(A) => A.twist().to_array(),
            other => [f64::from(u8::from(other == JointKind::Free)); 6],
        };
        near(&b.name, a.origin.to_matrix().as_flattened(), b.origin.to_matrix().as_flattened())?;
        near(&b.name, &screw(a.kind), &screw(b.kind))?;
        near(&b.name, &[a.damping, a.friction], &[b.damping, b.friction])?;
        near(&b.name, &[a.stiffness], &[b.stiffness])?;
        near(&b.name, &[a.spring_reference], &[b.spring_reference])?;
        let mimic = |mimic: &Option<Mimic>| mimic.as_ref().map_or([1.0, 0.0], |mimic| [mimic.ratio, mimic.offset]);
        near(&b.name, &mimic(&a.mimic), &mimic(&b.mimic))?;
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Double, Octuple};

    const TEXT: &str = r#"<robot name="r"><link name="a"/><link name="b"><inertial><origin xyz="0.1 0.2 0.3" rpy="0.1 0 0.7"/>
        <mass value="1.3"/><inertia ixx="0.3" ixy="0.01" ixz="0.02" iyy="0.2" iyz="0" izz="0.25"/></inertial></link>
        <joint name="j" type="revolute"><parent link="a"/><child link="b"/><origin xyz="0 0 0.333" rpy="1.5707963 0 0.1"/>
        <axis xyz="0 0.6 0.8"/><limit lower="-1" upper="1" effort="1" velocity="1"/><dynamics damping="0.7"/></joint></robot>"#;

    fn first() -> Description {
        mozzi_urdf::parse("r.urdf", TEXT).expect("sound").description
    }

    #[test]
    fn decimals_keep_their_digits() {
        let robot = read_urdf::<Octuple>(TEXT, &first()).expect("read");
        let error = robot.joints[0].origin.p.0[2] - Octuple::parse("0.333").expect("a number");
        assert_eq!(f64::from(error), 0.0);
        assert!(f64::from(robot.joints[0].origin.p.0[2] - Octuple::from(0.333)) != 0.0, "f64 has not all of 0.333");
        let model = read_urdf::<Double>(TEXT, &first()).expect("read").build().expect("sound");
        assert_eq!(model.n(), 1);
    }

    #[test]
    fn readers_that_disagree_are_told() {
        let mut other = first();
        other.joints[0].damping = 0.8;
        let error = read_urdf::<Double>(TEXT, &other).expect_err("another damping").to_string();
        assert!(error.starts_with("j: the second reader finds"), "{error}");
    }
}
