//! Points of a robot, and the planes that stop them.

use crate::Error;
use crate::options::check;
use alloc::boxed::Box;
use alloc::format;
use alloc::string::String;
use alloc::vec::Vec;
use mozzi::lie::{SE3, SO3};
use mozzi::linalg::Vec3;
use mozzi::model::{ContactPoint, Model, Support};
use mozzi::scalar::Scalar;
use mozzi::spatial::Twist;

/// A start may be this far within a plane, m: it is put right in the first step.
const DEEPEST: f64 = 1e-3;

/// The largest coefficient of friction: cones beyond it are half-spaces to rounding.
const LARGEST_MU: f64 = 1e6;
/// The part of a belt's velocity that may be along its normal: rounding.
const ALONG: f64 = 1e-6;

/// A plane that stops the robot's contact points: z = 0 of a frame, whose z-axis points towards the robot.
pub struct Plane<'a> {
    /// The name in results.
    pub name: String,
    /// How it moves.
    pub motion: PlaneMotion<'a>,
}

/// The motion of a plane.
pub enum PlaneMotion<'a> {
    /// At rest in this configuration in {s}.
    Fixed(SE3),
    /// A belt: the plane is at rest, its surface moves with this velocity in {s}, m/s.
    Belt(SE3, Vec3),
    /// Maps time (s) to the plane's configuration in {s}, and to its angular velocity and the velocity of its origin,
    /// in the axes of {s}.
    Moving(Box<dyn Fn(f64) -> (SE3, Twist) + 'a>),
}

/// The contact points of a robot and the planes of its environment. Each point can touch each plane. Shapes do not
/// touch each other.
#[derive(Default)]
pub struct Contacts<'a> {
    /// The points.
    pub points: Vec<ContactPoint>,
    /// The planes.
    pub planes: Vec<Plane<'a>>,
}

/// The force that a contact point applies to a plane.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ContactForce {
    /// The pair of a point and a plane, in the order of [`Contacts::names`].
    pub pair: usize,
    /// In {s}, N.
    pub f: Vec3,
}

/// A contact that begins or ceases to carry or to slide.
#[derive(Clone, Debug, PartialEq)]
pub struct ContactEvent {
    /// Seconds; for methods with fixed steps the end of the step.
    pub t: f64,
    /// The contact: see [`Contacts::names`].
    pub contact: String,
    /// The change.
    pub change: ContactChange,
}

/// A change of a contact.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ContactChange {
    /// It begins to carry.
    TouchDown,
    /// It ceases to carry.
    LiftOff,
    /// It carried, and ceases to slide.
    Sticks,
    /// It stuck, and begins to slide.
    Slides,
}

impl ContactChange {
    /// Each change.
    pub const ALL: [Self; 4] = [Self::TouchDown, Self::LiftOff, Self::Sticks, Self::Slides];

    /// "touches down", "lifts off", "sticks" or "slides".
    pub fn name(self) -> &'static str {
        match self {
            ContactChange::TouchDown => "touches down",
            ContactChange::LiftOff => "lifts off",
            ContactChange::Sticks => "sticks",
            ContactChange::Slides => "slides",
        }
    }
}

/// A plane at a time.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Surface {
    pub T: SE3,
    pub V: Twist,
}

impl Surface {
    /// How far a point in {s} is above it.
    pub fn height(&self, at: Vec3) -> f64 {
        (self.T.R * Vec3([0.0, 0.0, 1.0])).dot(at - self.T.p)
    }

    /// n, into the plane, and d in a frame at T in {s}: its point x is at the distance −(n · x + d).
    pub(crate) fn seen_from(&self, T: SE3) -> (Vec3, f64) {
        let n = -(self.T.R * Vec3([0.0, 0.0, 1.0]));
        (T.R.inverse_mul(n), n.dot(T.p - self.T.p))
    }

    /// A contact point next to it; T is the configuration of its frame in {s}.
    pub(crate) fn touch(&self, point: &ContactPoint, T: SE3) -> Touch {
        self.touch_at(point.farthest(self.seen_from(T).0), T)
    }

    /// As [`touch`](Self::touch), shortly before or after a point of the frame touched.
    pub(crate) fn touch_like(&self, point: &ContactPoint, T: SE3, like: Vec3) -> Touch {
        self.touch_at(point.farthest_like(self.seen_from(T).0, like), T)
    }

    fn touch_at(&self, of_frame: Vec3, T: SE3) -> Touch {
        let axes = self.T.R.matrix().transpose().rows().map(Vec3);
        let n = -axes[2];
        let at = T * of_frame;
        let from = at - self.T.p;
        let v = self.V.v + self.V.w.cross(from);
        let axes = [n, axes[0], axes[1]];
        Touch { gap: -n.dot(from), of_frame, at, R: T.R, axes, speeds: axes.map(|axis| axis.dot(v)) }
    }
}

/// A contact point next to a plane.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Touch {
    /// The distance, m; negative within the plane.
    pub gap: f64,
    /// The touching point in its frame, and in {s}.
    pub of_frame: Vec3,
    pub at: Vec3,
    /// The orientation of its frame.
    pub R: SO3,
    /// n (into the plane), t₁ and t₂ in {s}.
    pub axes: [Vec3; 3],
    /// The velocity of the plane's material there along these axes.
    pub speeds: [f64; 3],
}

impl<'a> Plane<'a> {
    /// The ground: z = 0 of {s}.
    pub fn ground() -> Self {
        Plane { name: "ground".into(), motion: PlaneMotion::Fixed(SE3::identity()) }
    }

    /// A plane at rest.
    pub fn fixed(name: impl Into<String>, T: SE3) -> Self {
        Plane { name: name.into(), motion: PlaneMotion::Fixed(T) }
    }

    pub(crate) fn at(&self, t: f64) -> Surface {
        match &self.motion {
            PlaneMotion::Fixed(T) => Surface { T: *T, V: Twist::zero() },
            PlaneMotion::Belt(T, v) => Surface { T: *T, V: Twist { w: Vec3::zero(), v: *v } },
            PlaneMotion::Moving(motion) => {
                let (T, V) = motion(t);
                Surface { T, V }
            }
        }
    }
}

impl Contacts<'_> {
    /// True if there are no points or no planes.
    pub fn is_empty(&self) -> bool {
        self.points.is_empty() || self.planes.is_empty()
    }

    /// The number of pairs of a point and a plane.
    pub fn pairs(&self) -> usize {
        self.points.len() * self.planes.len()
    }

    /// The names of the pairs: of each point, with the plane's if there are several.
    pub fn names(&self) -> impl Iterator<Item = String> + '_ {
        (0..self.points.len()).flat_map(move |point| (0..self.planes.len()).map(move |plane| self.name(point, plane)))
    }

    /// The point of a pair.
    ///
    /// # Panics
    /// When there is no such pair.
    pub fn point(&self, pair: usize) -> &ContactPoint {
        &self.points[pair / self.planes.len()]
    }

    /// The plane of a pair.
    ///
    /// # Panics
    /// When there is no such pair.
    pub fn plane(&self, pair: usize) -> &Plane<'_> {
        &self.planes[pair % self.planes.len()]
    }

    pub(crate) fn name(&self, point: usize, plane: usize) -> String {
        let point = &self.points[point].name;
        if self.planes.len() == 1 { point.clone() } else { format!("{point} on {}", self.planes[plane].name) }
    }

    /// The distances of all pairs at a time, m: those of the first point to each plane, then of the second.
    ///
    /// # Panics
    /// When θ is not nq long.
    pub fn gaps(&self, model: &Model, t: f64, theta: &[f64]) -> Vec<f64> {
        let surfaces: Vec<Surface> = self.planes.iter().map(|plane| plane.at(t)).collect();
        let of_point = |point: &ContactPoint| {
            let T = mozzi::kinematics::forward_kinematics(model, theta, point.frame);
            surfaces.iter().map(|surface| surface.touch(point, T).gap).collect::<Vec<_>>()
        };
        self.points.iter().flat_map(of_point).collect()
    }

    /// The frame of a pair in {s}: its origin is the robot's point nearest to the plane, its axes are the plane's.
    ///
    /// # Panics
    /// When there is no such pair, or θ is not nq long.
    pub fn frame(&self, model: &Model, t: f64, theta: &[f64], pair: usize) -> SE3 {
        let (point, surface) = (self.point(pair), self.plane(pair).at(t));
        let T = mozzi::kinematics::forward_kinematics(model, theta, point.frame);
        SE3 { R: surface.T.R, p: surface.touch(point, T).at }
    }

    /// Checks that no contact point starts within a plane.
    pub(crate) fn check_start(&self, model: &Model, theta: &[f64]) -> Result<(), Error> {
        for (gap, name) in self.gaps(model, 0.0, theta).into_iter().zip(self.names()) {
            let found = || format!("contact point `{name}` {:.6} m within its plane", -gap);
            if !(gap >= -DEEPEST) {
                check(false, "the start", found(), "contact points outside of planes, or at most 1 mm within")?;
            }
        }
        Ok(())
    }

    /// Checks coefficients, shapes and frames.
    ///
    /// # Errors
    /// [`mozzi::Error::BadArgument`] naming the contact point.
    pub fn check(&self, model: &Model) -> Result<(), Error> {
        let frames = model.frames().len();
        for ContactPoint { name, frame, center, support, mu, restitution } in &self.points {
            let says = |what: &str| format!("{what} of contact point `{name}`");
            check(frame.index() < frames, "the frame of a contact point", says("that"), "a frame of this model")?;
            let is_friction = (0.0..=LARGEST_MU).contains(mu);
            check(is_friction, "the coefficient of friction", says(&format!("{mu:e}")), "0 to 1e6")?;
            let is_ratio = (0.0..=1.0).contains(restitution);
            check(is_ratio, "the coefficient of restitution", says(&format!("{restitution}")), "0 to 1")?;
            let z = Vec3([0.0, 0.0, 1.0]);
            let (radii, axis, turn) = match *support {
                Support::Point => ([0.0; 3], z, 0.0),
                Support::Sphere { radius } => ([radius; 3], z, 0.0),
                Support::Disc { axis, radius, turn } => ([radius; 3], axis, turn),
                Support::Ellipsoid { radii, .. } => (radii, z, 0.0),
            };
            let numbers = [&center.0[..], &axis.0, &[turn]].concat();
            let is_finite = numbers.iter().all(|x| x.is_finite()) && Scalar::sqrt(axis.dot(axis)) > 0.0;
            check(is_finite, "the shape", says(&format!("{support:?} at {center:?}")), "finite numbers and an axis")?;
            for radius in radii {
                check(radius >= 0.0 && radius.is_finite(), "the radius", says(&format!("{radius}")), "at least 0")?;
            }
        }
        for Plane { name, motion } in &self.planes {
            let PlaneMotion::Belt(T, v) = motion else { continue };
            let (along, speed) = ((T.R * Vec3([0.0, 0.0, 1.0])).dot(*v), Scalar::sqrt(v.dot(*v)));
            let found = format!("({}, {}, {}) m/s in {{s}}, of plane `{name}`", v.0[0], v.0[1], v.0[2]);
            check(along.abs() <= ALONG * speed, "the velocity of a belt", found, "a velocity along its plane")?;
        }
        Ok(())
    }
}
