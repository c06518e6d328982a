//! A second reader of URDF, for numbers of any kind: it takes the tree from the first reader's description, and each
//! number from the file's decimals.

use mozzi::linalg::Sym3;
use mozzi::model::description::{JointKind, Mimic};
use mozzi::{Description, Real, SE3, SO3, ScrewAxis, SpatialInertia, Twist, Vec3};
use roxmltree::{Document, Node};
use std::collections::HashMap;
use std::fmt;

/// The reason why a file was not read a second time.
#[derive(Clone, Debug, PartialEq)]
pub struct NotRead(pub(crate) String);

impl fmt::Display for NotRead {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.0)
    }
}
impl std::error::Error for NotRead {}

type Read<T> = Result<T, NotRead>;

/// The meaning of a number in a robot's description.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum Part {
    /// A coordinate of a joint's or frame's origin in its parent link.
    Origin(usize),
    /// An angle of its roll, pitch and yaw.
    Angle(usize),
    /// A component of a joint's axis.
    Axis(usize),
    /// A link's mass.
    Mass,
    /// A coordinate of its centre of mass.
    Center(usize),
    /// An angle of the axes of its rotational inertia.
    InertiaAngle(usize),
    /// xx, xy, xz, yy, yz or zz of its rotational inertia about the centre of mass.
    Inertia(usize),
    /// Viscous friction.
    Damping,
    /// Coulomb friction.
    Friction,
    /// A spring's stiffness.
    Stiffness,
    /// A spring's rest position.
    SpringReference,
    /// A mimic joint's ratio.
    Ratio,
    /// Its offset.
    Offset,
    /// A component of gravity.
    Gravity(usize),
}

/// A number's place: the link's or joint's name, and what it is.
#[derive(Clone, Copy, Debug)]
pub struct At<'a> {
    /// The link or joint.
    pub name: &'a str,
    /// Its number.
    pub part: Part,
}

fn child<'a, 'i>(node: Node<'a, 'i>, name: &str) -> Option<Node<'a, 'i>> {
    node.children().find(|child| child.has_tag_name(name))
}

/// Reads numbers of a document.
struct Reader<F> {
    number: F,
    normalizes: fn([f64; 3]) -> bool,
}

impl<C: Real + Into<f64>, F: FnMut(At, &str) -> Option<C>> Reader<F> {
    /// The numbers of an attribute, `default` if it is missing.
    fn numbers<const N: usize>(
        &mut self,
        node: Option<Node>,
        attribute: &str,
        default: &str,
        at: impl Fn(usize) -> Part,
        name: &str,
    ) -> Read<[C; N]> {
        let text = node.and_then(|node| node.attribute(attribute)).unwrap_or(default);
        let each = |(k, text)| (self.number)(At { name, part: at(k) }, text);
        let all: Option<Vec<C>> = text.split_whitespace().enumerate().map(each).collect();
        let all = all.and_then(|all| all.try_into().ok());
        all.ok_or_else(|| NotRead(format!("{attribute}=\"{text}\": expected {N} numbers")))
    }

    fn one(&mut self, node: Option<Node>, attribute: &str, default: &str, part: Part, name: &str) -> Read<C> {
        self.numbers::<1>(node, attribute, default, |_| part, name).map(|[x]| x)
    }

    fn joint_origin(&mut self, node: Node, name: &str) -> Read<SE3<C>> {
        let origin = child(node, "origin");
        let [roll, pitch, yaw] = self.numbers(origin, "rpy", "0 0 0", Part::Angle, name)?;
        let p = self.numbers(origin, "xyz", "0 0 0", Part::Origin, name)?;
        Ok(SE3 { R: SO3::from_rpy(roll, pitch, yaw), p: Vec3(p) })
    }

    fn inertia(&mut self, link: Node, name: &str) -> Read<SpatialInertia<C>> {
        let Some(inertial) = child(link, "inertial") else { return Ok(SpatialInertia::zero()) };
        let origin = child(inertial, "origin");
        let [roll, pitch, yaw] = self.numbers(origin, "rpy", "0 0 0", Part::InertiaAngle, name)?;
        let c = Vec3(self.numbers(origin, "xyz", "0 0 0", Part::Center, name)?);
        let matrix = child(inertial, "inertia");
        let mut entry = |k: usize, attribute: &str| self.one(matrix, attribute, "", Part::Inertia(k), name);
        let I = Sym3 {
            xx: entry(0, "ixx")?,
            xy: entry(1, "ixy")?,
            xz: entry(2, "ixz")?,
            yy: entry(3, "iyy")?,
            yz: entry(4, "iyz")?,
            zz: entry(5, "izz")?,
        };
        let mass = self.one(child(inertial, "mass"), "value", "", Part::Mass, name)?;
        Ok(SpatialInertia::new(mass, c, I.congruence(SO3::from_rpy(roll, pitch, yaw).matrix())))
    }

    /// A ball, which URDF cannot express, is taken from the description, and so are axes that these numbers cannot
    /// normalise.
    fn kind(&mut self, joint: Node, described: JointKind<C>, name: &str) -> Read<JointKind<C>> {
        if let JointKind::Ball(_) = described {
            return Ok(described);
        }
        let normalizes = self.normalizes;
        let mut direction = || Ok(Vec3(self.numbers(child(joint, "axis"), "xyz", "1 0 0", Part::Axis, name)?));
        let twist = match joint.attribute("type") {
            Some("fixed") => return Ok(JointKind::Fixed),
            Some("floating") => return Ok(JointKind::Free),
            Some("revolute" | "continuous") => Twist { w: direction()?, v: Vec3::zero() },
            Some("prismatic") => Twist::linear(direction()?),
            other => return Err(NotRead(format!("a joint of type {}", other.unwrap_or("none")))),
        };
        let [w, v] = [twist.w, twist.v].map(|x| x.0.map(Into::into));
        if matches!(described, JointKind::Screw(_)) && !normalizes([0, 1, 2].map(|k| w[k] + v[k])) {
            return Ok(described);
        }
        let axis = ScrewAxis::normalize(twist).map_err(|error| NotRead(error.to_string()))?;
        Ok(JointKind::Screw(axis.0))
    }
}

/// The first reader's description of a file, with the file's decimals by `number`. Gravity, which files do not
/// contain, is taken from the description's shortest decimals; balls and rotor inertias, which URDF cannot express, and
/// axes that are not to be normalised in these numbers (`normalizes`), are the description's numbers by `plain`. Joints
/// are read first, then links. [`agree`] compares the readers.
///
/// # Errors
/// [`NotRead`] if the second reader does not know an element.
pub fn read_urdf<C: Real + Into<f64>>(
    text: &str,
    robot: &Description,
    normalizes: fn([f64; 3]) -> bool,
    plain: impl Fn(f64) -> C + Copy,
    number: impl FnMut(At, &str) -> Option<C>,
) -> Result<Description<C>, NotRead> {
    let document = Document::parse(text).map_err(|error| NotRead(error.to_string()))?;
    let mut elements: HashMap<(&str, &str), Node> = HashMap::new();
    for node in document.root_element().children() {
        if let Some(name) = node.attribute("name") {
            elements.entry((node.tag_name().name(), name)).or_insert(node);
        }
    }
    let named = |tag: &str, name: &str| {
        let found = elements.get(&(tag, name)).copied();
        found.ok_or_else(|| NotRead(format!("there is no <{tag} name=\"{name}\">")))
    };
    let mut reader = Reader { number, normalizes };
    let mut read = robot.map(plain);
    for (k, gravity) in robot.gravity.iter().enumerate() {
        let at = At { name: "gravity", part: Part::Gravity(k) };
        read.gravity[k] =
            (reader.number)(at, &format!("{gravity}")).ok_or_else(|| NotRead(format!("gravity {gravity}")))?;
    }
    for joint in &mut read.joints {
        let (node, name) = (named("joint", &joint.name)?, joint.name.clone());
        (joint.origin, joint.kind) = (reader.joint_origin(node, &name)?, reader.kind(node, joint.kind, &name)?);
        let dynamics = child(node, "dynamics").filter(|_| joint.kind != JointKind::Free); // not for free joints
        let mut dynamic = |attribute, part| reader.one(dynamics, attribute, "0", part, &name);
        joint.damping = dynamic("damping", Part::Damping)?;
        joint.friction = dynamic("friction", Part::Friction)?;
        joint.stiffness = dynamic("spring_stiffness", Part::Stiffness)?;
        joint.spring_reference = dynamic("spring_reference", Part::SpringReference)?;
        if let (Some(mimic), Some(node)) = (&mut joint.mimic, child(node, "mimic")) {
            let ratio = reader.one(Some(node), "multiplier", "1", Part::Ratio, &name)?;
            let offset = reader.one(Some(node), "offset", "0", Part::Offset, &name)?;
            *mimic = Mimic { joint: mimic.joint.clone(), ratio, offset };
        }
    }
    for link in &mut read.links {
        link.inertia = reader.inertia(named("link", &link.name)?, &link.name.clone())?;
    }
    Ok(read)
}

/// Checks that both readers read the same robot.
///
/// # Errors
/// [`NotRead`] where they disagree by more than `tolerance` of an attribute's largest number.
pub fn agree<C: Real + Into<f64>>(second: &Description<C>, first: &Description, tolerance: f64) -> Result<(), NotRead> {
    let second = second.map(Into::into);
    let near = |what: &str, a: &[f64], b: &[f64]| {
        let size = b.iter().fold(0.0_f64, |m, x| m.max(x.abs()));
        match a.iter().zip(b).find(|(a, b)| !((*a - *b).abs() <= tolerance * size)) {
            None => Ok(()),
            Some((a, b)) => Err(NotRead(format!("{what}: the second reader finds {a}, the first {b}"))),
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
