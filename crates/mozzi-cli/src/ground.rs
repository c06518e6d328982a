//! `--ground`, `--contact` and `--contacts FILE.json`: points of the robot and planes that stop them.

use crate::failure::{self, Failure, Result};
use crate::json_file;
use crate::numbers::number;
use crate::robot::RobotArguments;
use clap::Args;
use mozzi::{Model, SE3, Vec3};
use mozzi_sim::{ContactPoint, Contacts, Plane, PlaneMotion, Support};
use mozzi_urdf::counted;
use mozzi_urdf::geometry::{FRICTION, Geometry, contact_points, end_points, geometry_with};
use mozzi_urdf::json::{At, Object, Read};
use std::path::Path;

#[derive(Args, Debug, Default)]
pub struct GroundArguments {
    /// Put the robot on the ground, the plane z = 0: its collision shapes touch it, or the frames of --contact. A
    /// floating base without --theta starts on the ground
    #[arg(long, alias = "floor")]
    ground: bool,
    /// A frame whose origin touches planes, instead of the collision shapes; may be repeated
    #[arg(long, value_name = "FRAME")]
    contact: Vec<String>,
    /// Coefficient of friction of the contacts [default: that of MJCF's geoms, else 0.7]
    #[arg(long, value_name = "MU")]
    contact_friction: Option<String>,
    /// Coefficient of restitution of the contacts, 0 to 1 [default: 0]
    #[arg(long, value_name = "E")]
    restitution: Option<String>,
    /// Contact points and planes from a file: {"points": [{"frame": …, "at": [x,y,z], "radius": …, "friction": …,
    /// "restitution": …}], "planes": [{"name": …, "pose": [qw,qx,qy,qz,x,y,z], "velocity": [x,y,z]}]}; planes and the
    /// velocities of belts are in {s}, a plane's z-axis points towards the robot. Without points those of --contact or
    /// of the collision shapes; without planes the ground
    #[arg(long, value_name = "FILE.json")]
    contacts: Option<String>,
    /// Columns of each contact in the --out table: f_n_NAME and f_t_NAME, the force on its plane along the normal and
    /// across, N, the mean over the step that ends at the row
    #[arg(long)]
    contact_forces: bool,
}

/// More contact points are announced with their cost.
const MANY: usize = 1000;

impl GroundArguments {
    /// The contacts; none without the flags.
    pub fn contacts(&self, robot: &RobotArguments, model: &Model) -> Result<Contacts<'static>> {
        let (mu, restitution) = self.coefficients()?;
        let coefficients = [mu.unwrap_or(FRICTION), restitution];
        if !self.ground && self.contacts.is_none() {
            self.name_unused_planes(robot)?;
            return Ok(Contacts::default());
        }
        let mut found = Contacts::default();
        if let Some(file) = &self.contacts {
            found = read(file, model, coefficients)?;
        }
        // a file's own points and planes need no shapes; standard input has been read already
        let needs_shapes = robot.model != "-" && (self.ground || found.points.is_empty());
        let shapes = match needs_shapes {
            true => geometry_with(&robot.model, &robot.settings().xacro)?,
            false => Geometry::default(),
        };
        if self.ground && !shapes.planes.is_empty() {
            let plane = |(name, T): &(String, SE3)| Plane::fixed(name.clone(), *T);
            found.planes.extend(shapes.planes.iter().map(plane));
        } else if found.planes.is_empty() || self.ground {
            found.planes.push(Plane::ground());
        }
        if found.points.is_empty() {
            found.points = self.points(robot, model, &shapes, (mu, restitution))?;
        }
        let (count, planes) = (found.points.len(), found.planes.len());
        let (points, planes) = (counted(count, "contact point"), counted(planes, "plane"));
        let cost = match count > MANY {
            true => "; each costs time at every step, --contact FRAME takes fewer",
            false => "",
        };
        failure::note(&format!("{}: {points}, {planes}{cost}", self.flag()));
        Ok(found)
    }

    /// A note if the file has planes that nothing touches without --ground.
    fn name_unused_planes(&self, robot: &RobotArguments) -> Result<()> {
        let is_mjcf = Path::new(&robot.model).is_file() && robot.model.ends_with(".xml");
        let planes = if is_mjcf { geometry_with(&robot.model, &robot.settings().xacro)?.planes } else { Vec::new() };
        if let Some((name, _)) = planes.first() {
            failure::note(&format!("the file's plane `{name}` is not used; --ground puts the robot on it"));
        }
        Ok(())
    }

    /// True if the output has columns of contact forces.
    pub fn writes_forces(&self) -> bool {
        self.contact_forces
    }

    /// The flag of messages.
    pub fn flag(&self) -> &'static str {
        if self.contacts.is_some() { "--contacts" } else { "--ground" }
    }

    /// μ, if it is given, and e.
    fn coefficients(&self) -> Result<(Option<f64>, f64)> {
        let of = |flag, text: &Option<String>| text.as_ref().map(|text| number(flag, text)).transpose();
        let mu = of("--contact-friction", &self.contact_friction)?;
        Ok((mu, of("--restitution", &self.restitution)?.unwrap_or(0.0)))
    }

    /// The frames of `--contact`; else the collision shapes; else the ends of the robot.
    fn points(
        &self,
        robot: &RobotArguments,
        model: &Model,
        shapes: &Geometry,
        (given, restitution): (Option<f64>, f64),
    ) -> Result<Vec<ContactPoint>> {
        let mu = given.unwrap_or(FRICTION);
        let of_frame = |name: &str| -> Result<ContactPoint> {
            let point = ContactPoint::new(name, model.frame(name)?, Vec3::zero(), mu);
            Ok(ContactPoint { restitution, ..point })
        };
        if !self.contact.is_empty() {
            return self.contact.iter().map(|name| of_frame(name)).collect();
        }
        let found = contact_points(model, &shapes.shapes, Path::new(&robot.model), None, (given, restitution));
        if let Some(reason) = found.left_out.first().filter(|_| robot.is_strict()) {
            return Err(Failure::wrong(format!(
                "{}: {reason}; --strict refuses a shape that is left out",
                self.flag()
            )));
        }
        found.left_out.iter().for_each(|reason| failure::note(&format!("{}: {reason}", self.flag())));
        if !shapes.unused.is_empty() {
            failure::note(&format!("{}: not used by rigid contacts: {}", self.flag(), shapes.unused.join(", ")));
        }
        if !found.points.is_empty() {
            return Ok(found.points);
        }
        let ends = end_points(model, mu, restitution);
        let listed = ends.iter().map(|point| point.name.as_str()).collect::<Vec<_>>().join(", ");
        failure::note(&format!(
            "{}: the robot has no collision shapes; the origins of its last links touch: {listed}",
            self.flag()
        ));
        Ok(ends)
    }
}

/// A start may be this far within a plane: a floating base is lifted, m.
const DEEPEST: f64 = 0.05;
/// So far within a plane no base is lifted, m: rounding.
const ROUNDING: f64 = 1e-9;

/// Moves a floating base up or down, so that its lowest contact point is on the plane that is nearest; a start that was
/// given is lifted out of the ground only.
pub fn settle(flag: &str, model: &Model, contacts: &Contacts, theta: &mut [f64], is_own: bool) -> Result<()> {
    let gaps = contacts.gaps(model, 0.0, theta);
    let Some((k, &lowest)) = gaps.iter().enumerate().min_by(|a, b| a.1.total_cmp(b.1)) else { return Ok(()) };
    if !is_own && lowest >= -ROUNDING {
        return Ok(());
    }
    if model.is_floating() && (is_own || lowest >= -DEEPEST) {
        theta[6] -= lowest;
        let (z, depth) = (theta[6], -lowest);
        failure::note(&match is_own {
            true => format!("{flag}: the base starts at z = {z:.6} m, where its lowest contact point touches"),
            false => {
                format!("{flag}: the base starts at z = {z:.6} m, {depth:.6} m higher than given: it was in the ground")
            }
        });
        return Ok(());
    }
    let link = model.frame_name(contacts.points[k / contacts.planes.len()].frame);
    let remedy =
        if model.is_floating() { "; a start may be 5 cm deep" } else { "; its base is fixed, --floating frees it" };
    let message = format!("{flag}: link `{link}` starts {:.6} m within the ground{remedy}", -lowest);
    if lowest < -1e-3 { Err(Failure::Wrong(message)) } else { Ok(()) }
}

/// The keys of a file of contacts.
const KEYS: Object = Object::of(&[]).optional(&["points", "planes"]).children(&[
    ("points", Object::of(&["frame"]).optional(&["at", "radius", "friction", "restitution", "name"])),
    ("planes", Object::of(&[]).optional(&["name", "pose", "velocity"])),
]);

fn read(name: &str, model: &Model, [mu, restitution]: [f64; 2]) -> Result<Contacts<'static>> {
    let file = json_file::read(name)?;
    let root = At::root(&file, "the contacts");
    KEYS.check_all(&root)?;
    let list = |key| Read::Ok(root.get(key).some(At::list)?.unwrap_or_default());
    let mut found = Contacts::default();
    for entry in list("points")? {
        let at = entry.get("frame");
        let frame = at.text()?;
        let number = |key, default| Read::Ok(entry.get(key).some(At::number)?.unwrap_or(default));
        let radius = number("radius", 0.0)?;
        found.points.push(ContactPoint {
            name: entry.get("name").some(At::text)?.unwrap_or_else(|| frame.clone()),
            frame: model.frame(&frame).or_else(|why| at.error(why))?,
            center: Vec3(entry.get("at").some(At::vector)?.unwrap_or_default()),
            support: if radius == 0.0 { Support::Point } else { Support::Sphere { radius } },
            mu: number("friction", mu)?,
            restitution: number("restitution", restitution)?,
        });
    }
    for (k, entry) in list("planes")?.iter().enumerate() {
        let pose = entry.get("pose").some(pose)?.unwrap_or_else(SE3::identity);
        let motion = match entry.get("velocity").some(At::vector)? {
            None => PlaneMotion::Fixed(pose),
            Some(v) => PlaneMotion::Belt(pose, Vec3(v)),
        };
        let name = entry.get("name").some(At::text)?.unwrap_or_else(|| format!("plane {}", k + 1));
        found.planes.push(Plane { name, motion });
    }
    Ok(found)
}

/// A plane's pose: unit quaternion and origin.
fn pose(at: &At) -> Read<SE3> {
    let pose = at.vector::<7>()?;
    let square = pose[..4].iter().map(|x| x * x).sum::<f64>();
    if (square - 1.0).abs() > 2e-3 {
        return at.wrong("[qw, qx, qy, qz, x, y, z] with a unit quaternion");
    }
    Ok(SE3::from_pose(pose))
}
