//! The contacts of a motion: what the page draws of points, planes, forces and cones.

use crate::base64::singles;
use crate::drawing::rows;
use crate::error::Error;
use crate::motion::thin;
use mozzi::{FrameId, Model, SE3, Vec3};
use mozzi_sim::Trajectory;
use mozzi_sim::{ContactEvent, Contacts, PlaneMotion};
use serde_json::{Value, json};

/// So many pairs are shown even where they do not carry: meshes have tens of thousands.
const MOST: usize = 100;

/// The contacts of a simulated motion, by its rows: see [`shown_contacts`].
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Touches {
    pairs: Vec<Pair>,
    planes: Vec<Surface>,
    /// The touching points in {s}, m: rows of 3 for each pair.
    points: Vec<f64>,
    /// The forces that the robot applies to the planes, in {s}, N: rows of 3 for each pair.
    forces: Vec<f64>,
    events: Vec<ContactEvent>,
}

/// A contact point and a plane.
#[derive(Clone, Debug, PartialEq)]
struct Pair {
    name: String,
    frame: FrameId,
    plane: usize,
    mu: f64,
}

#[derive(Clone, Debug, PartialEq)]
struct Surface {
    name: String,
    /// The velocity of a belt's surface, m/s.
    velocity: Option<Vec3>,
    /// Three rows of its configuration in {s}: once, or for each row of the motion if the plane moves.
    poses: Vec<f64>,
}

/// The pairs of a point and a plane that a page or a table of a motion shows: all, or those that carry in at least one
/// row if there are more than 100.
pub fn shown_contacts(pairs: usize, motion: &Trajectory) -> Vec<usize> {
    if pairs <= MOST { (0..pairs).collect() } else { motion.carrying() }
}

impl Touches {
    /// The contacts of a simulation, with its rows and its events.
    ///
    /// # Errors
    /// [`Error::Motion`] if the rows are those of other contacts or of another robot.
    pub fn new(
        model: &Model,
        contacts: &Contacts,
        motion: &Trajectory,
        events: &[ContactEvent],
    ) -> Result<Self, Error> {
        let (found, expected) = (motion.theta.len(), motion.len() * model.nq());
        if found != expected {
            return Err(Error::Motion { what: "theta", found, expected, rows: motion.len(), width: model.nq() });
        }
        let (carrying, all) = (motion.carrying(), contacts.pairs());
        if let Some(&pair) = carrying.last().filter(|pair| **pair >= all) {
            return Err(Error::Contact { pair, all });
        }
        let shown = shown_contacts(all, motion);
        let of_row = |row: mozzi_sim::Sample| {
            let place = |&pair: &usize| contacts.frame(model, row.t, row.theta, pair).p.0;
            shown.iter().flat_map(place).collect::<Vec<_>>()
        };
        let points = motion.samples().flat_map(of_row).collect();
        let names: Vec<String> = contacts.names().collect();
        let pair = |&k: &usize| {
            let point = contacts.point(k);
            Pair { name: names[k].clone(), frame: point.frame, plane: k % contacts.planes.len(), mu: point.mu }
        };
        let surface = |plane: &mozzi_sim::Plane| {
            let at = |T: &SE3| rows(*T);
            let (poses, velocity) = match &plane.motion {
                PlaneMotion::Fixed(T) => (at(T), None),
                PlaneMotion::Belt(T, v) => (at(T), Some(*v)),
                PlaneMotion::Moving(pose) => (motion.t.iter().flat_map(|&t| at(&pose(t).0)).collect(), None),
            };
            Surface { name: plane.name.clone(), velocity, poses }
        };
        Ok(Touches {
            pairs: shown.iter().map(pair).collect(),
            planes: contacts.planes.iter().map(surface).collect(),
            points,
            forces: motion.samples().flat_map(|row| row.forces_of(shown.iter().copied())).collect(),
            events: events.to_vec(),
        })
    }

    /// Keeps selected rows of a motion that has this many.
    pub(crate) fn thin(&mut self, all: usize, is_kept: impl Fn(usize) -> bool + Copy) {
        thin(&mut self.points, all, is_kept);
        thin(&mut self.forces, all, is_kept);
        let moving = self.planes.iter_mut().filter(|plane| plane.poses.len() > 12);
        moving.for_each(|plane| thin(&mut plane.poses, all, is_kept));
    }

    /// The number of numbers per row of points and of forces, and those found.
    pub(crate) fn widths(&self) -> (usize, [usize; 2]) {
        (3 * self.pairs.len(), [self.points.len(), self.forces.len()])
    }

    pub(crate) fn to_json(&self, model: &Model) -> Value {
        let frame_of = |id: FrameId| model.frames().position(|(known, _)| known == id);
        let pair = |pair: &Pair| json!({ "name": pair.name, "frame": frame_of(pair.frame), "plane": pair.plane, "mu": pair.mu });
        let plane = |plane: &Surface| json!({ "name": plane.name, "velocity": plane.velocity.map(|v| v.0), "poses": singles(&plane.poses) });
        let event =
            |event: &ContactEvent| json!({ "t": event.t, "contact": event.contact, "change": event.change.name() });
        json!({
            "pairs": self.pairs.iter().map(pair).collect::<Value>(),
            "planes": self.planes.iter().map(plane).collect::<Value>(),
            "points": singles(&self.points),
            "forces": singles(&self.forces),
            "events": self.events.iter().map(event).collect::<Value>(),
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use mozzi_sim::{ContactPoint, Options, Plane, Simulation, Zero};

    fn fallen<'a>(model: &Model, planes: Vec<Plane<'a>>) -> (Contacts<'a>, Trajectory, Vec<ContactEvent>) {
        let point = |k: usize| {
            let sign = |bit: usize| if k & bit == 0 { -0.05 } else { 0.05 };
            ContactPoint::new(format!("{k}"), model.frame("box").expect("a link"), Vec3([sign(1), sign(2), -0.05]), 0.5)
        };
        let contacts = Contacts { points: (0..4).map(point).collect(), planes };
        let simulation = Simulation { contacts, ..Simulation::new(Options::new(0.3, 30)) };
        let start = [1.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.1];
        let run = simulation.run(model, &start, &[0.0; 6], Zero).expect("a motion");
        (simulation.contacts, run.motion, run.contact_events)
    }

    fn cube() -> Model {
        let text = r#"<robot name="cube"><link name="box"><inertial><mass value="2"/>
            <inertia ixx="0.003" iyy="0.003" izz="0.003" ixy="0" ixz="0" iyz="0"/></inertial></link></robot>"#;
        mozzi_urdf::parse("cube.urdf", text).expect("sound").description.floating().build().expect("sound")
    }

    #[test]
    fn points_are_on_the_ground_once_forces_act() {
        let model = cube();
        let (contacts, motion, events) = fallen(&model, vec![Plane::ground()]);
        let touches = Touches::new(&model, &contacts, &motion, &events).expect("contacts");
        assert!(events.len() >= 4 && touches.planes[0].poses.len() == 12);
        let mut carrying = 0;
        for (point, force) in touches.points.chunks(3).zip(touches.forces.chunks(3)) {
            assert!(force[2] <= 0.0, "the robot presses down");
            if force[2] < 0.0 {
                carrying += 1;
                assert!(point[2].abs() < 1e-12, "{point:?}");
            }
        }
        assert!(carrying > 60, "{carrying}");
        let json = touches.to_json(&model);
        assert_eq!((&json["pairs"][3]["name"], &json["pairs"][3]["mu"]), (&json!("3"), &json!(0.5)));
        assert_eq!(json["events"][0]["change"], "touches down");
    }

    #[test]
    fn planes_that_move_have_a_pose_for_each_row() {
        let model = cube();
        let lift = |t: f64| {
            let V = mozzi::Twist { w: Vec3::zero(), v: Vec3([0.0, 0.0, 0.1]) };
            (SE3::translation([0.0, 0.0, 0.1 * t - 0.05]), V)
        };
        let planes = || vec![Plane { name: "lift".into(), motion: PlaneMotion::Moving(Box::new(lift)) }];
        let (contacts, motion, events) = fallen(&model, planes());
        let mut touches = Touches::new(&model, &contacts, &motion, &events).expect("contacts");
        assert_eq!(touches.planes[0].poses.len(), 12 * 31);
        touches.thin(31, |row| row % 10 == 0);
        assert_eq!((touches.points.len(), touches.planes[0].poses.len()), (4 * 12, 4 * 12));
        assert!((touches.planes[0].poses[47] - (0.1 * 0.3 - 0.05)).abs() < 1e-12);
        let fewer = Contacts { points: contacts.points[..2].to_vec(), planes: planes() };
        let message = Touches::new(&model, &fewer, &motion, &events).expect_err("other contacts").to_string();
        assert_eq!(message, "the motion has a force of contact 3, expected fewer than 2 contacts");
    }
}
