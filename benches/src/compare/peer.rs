//! Pinocchio, compiled from `benches/pinocchio.cpp` into a library that is loaded at run time.

use libloading::{Library, Symbol};
use mozzi::model::description::{Joint, JointKind};
use mozzi::{Description, Model, SE3};
use mozzi_benches::States;
use std::ffi::{CStr, OsStr, c_char, c_int};
use std::rc::Rc;

/// The library.
pub struct Peer(Rc<Library>);

/// A robot with its states, made in the library.
pub struct Robot {
    library: Rc<Library>,
    this: *mut Opaque,
}

#[repr(C)]
pub struct Opaque {
    _private: [u8; 0],
}

/// The order of `Algorithm` in pinocchio.cpp.
#[derive(Clone, Copy, Debug)]
pub enum Algorithm {
    Rnea,
    AbaWorld,
    AbaLocal,
    CrbaWorld,
    CrbaLocal,
    Coriolis,
    NonLinearEffects,
    RneaDerivatives,
    AbaDerivatives,
}

impl Algorithm {
    pub fn name(self) -> &'static str {
        match self {
            Algorithm::Rnea => "rnea",
            Algorithm::AbaWorld => "aba, WORLD",
            Algorithm::AbaLocal => "aba, LOCAL",
            Algorithm::CrbaWorld => "crba, WORLD",
            Algorithm::CrbaLocal => "crba, LOCAL",
            Algorithm::Coriolis => "computeCoriolisMatrix",
            Algorithm::NonLinearEffects => "nonLinearEffects",
            Algorithm::RneaDerivatives => "computeRNEADerivatives",
            Algorithm::AbaDerivatives => "computeABADerivatives",
        }
    }
}

type Version = unsafe extern "C" fn() -> *const c_char;
type NewRobot = unsafe extern "C" fn(*const f64, c_int) -> *mut Opaque;
type FreeRobot = unsafe extern "C" fn(*mut Opaque);
type AddJoint = unsafe extern "C" fn(*mut Opaque, c_int, *const f64, *const f64, c_int) -> c_int;
type AddBody = unsafe extern "C" fn(*mut Opaque, c_int, *const f64, f64, *const f64, *const f64);
type SetStates = unsafe extern "C" fn(*mut Opaque, *const f64, c_int);
type Run = unsafe extern "C" fn(*mut Opaque, c_int);
type GetResult = unsafe extern "C" fn(*mut Opaque, c_int, c_int, *mut f64, c_int);

/// A function of the library.
///
/// # Safety
/// `F` is its type.
unsafe fn function<'l, F>(library: &'l Library, name: &str) -> Symbol<'l, F> {
    // SAFETY: by the caller.
    unsafe { library.get(name) }.unwrap_or_else(|error| panic!("{name}: {error}"))
}

impl Peer {
    pub fn load(path: &OsStr) -> Result<Self, libloading::Error> {
        // SAFETY: what the library runs when it is loaded is Pinocchio's own.
        unsafe { Library::new(path) }.map(|library| Peer(Rc::new(library)))
    }

    /// What it was compiled from and by.
    pub fn version(&self) -> String {
        self.text("peer_version")
    }

    /// How it was compiled.
    pub fn flags(&self) -> String {
        self.text("peer_flags")
    }

    fn text(&self, name: &str) -> String {
        // SAFETY: both are `const char* f()` and answer with a literal.
        unsafe { CStr::from_ptr(function::<Version>(&self.0, name)()) }.to_string_lossy().into_owned()
    }

    /// The same robot, of revolute and prismatic joints, at the same states.
    pub fn robot(&self, model: &Model, states: &States) -> Robot {
        let library = &self.0;
        let description = model.description();
        let moving: Vec<&Joint> = model.moving_joints().collect();
        // SAFETY: the types are those of pinocchio.cpp; every pointer is to as many numbers as it reads there.
        unsafe {
            let this =
                function::<NewRobot>(library, "peer_robot")(description.gravity.as_ptr(), model.is_floating().into());
            let first = c_int::from(model.is_floating()); // the free base is Pinocchio's joint 1
            let (add_joint, add_body) =
                (function::<AddJoint>(library, "peer_joint"), function::<AddBody>(library, "peer_body"));
            for (k, joint) in moving.iter().enumerate() {
                let (parent, carrier) = place(description, &moving, &joint.parent);
                let JointKind::Screw(screw) = joint.kind else { panic!("`{}` does not move", joint.name) };
                let twist = screw.twist();
                let axis = if screw.is_prismatic() { twist.v } else { twist.w };
                let revolute = !screw.is_prismatic();
                assert!(!revolute || twist.v == mozzi::Vec3::zero(), "`{}` turns beside its origin", joint.name);
                let T = numbers(carrier * joint.origin);
                let number = add_joint(this, first + parent as c_int, T.as_ptr(), axis.0.as_ptr(), revolute.into());
                assert_eq!(number, first + k as c_int + 1);
            }
            for link in &description.links {
                let ((joint, T), G) = (place(description, &moving, &link.name), link.inertia);
                let (c, I) = (G.center_of_mass().0, G.about_center_of_mass().to_mat3().rows());
                add_body(this, first + joint as c_int, numbers(T).as_ptr(), G.mass, c.as_ptr(), I.as_ptr().cast());
            }
            let count = States::COUNT as c_int;
            function::<SetStates>(library, "peer_states")(this, theirs(model, states).as_ptr(), count);
            Robot { library: Rc::clone(library), this }
        }
    }
}

impl Robot {
    /// What runs an algorithm over all states.
    pub fn runner(&self, algorithm: Algorithm) -> impl FnMut() + '_ {
        // SAFETY: the type is that of pinocchio.cpp.
        let run = unsafe { function::<Run>(&self.library, "peer_run") };
        // SAFETY: the robot lives as long as this borrow of it.
        move || unsafe { run(self.this, algorithm as c_int) }
    }

    /// The result at one state: a vector, or matrices by columns. No longer than `length`.
    pub fn result(&self, algorithm: Algorithm, state: usize, length: usize) -> Vec<f64> {
        let mut out = vec![0.0; length];
        // SAFETY: the type is that of pinocchio.cpp; `out` is as long as said.
        unsafe {
            let get = function::<GetResult>(&self.library, "peer_result");
            get(self.this, algorithm as c_int, state as c_int, out.as_mut_ptr(), length as c_int);
        }
        out
    }
}

impl Drop for Robot {
    fn drop(&mut self) {
        // SAFETY: made by `peer_robot`, freed once.
        unsafe { function::<FreeRobot>(&self.library, "peer_robot_free")(self.this) }
    }
}

/// The number of the moving joint that carries a link (0: none, the base) and the link's frame seen from it.
fn place(description: &Description, moving: &[&Joint], link: &str) -> (usize, SE3) {
    let (mut T, mut link) = (SE3::identity(), link);
    while let Some(joint) = description.joints.iter().find(|joint| joint.child == link) {
        if let Some(k) = moving.iter().position(|moving| moving.name == joint.name) {
            return (k + 1, T);
        }
        (T, link) = (joint.origin * T, &joint.parent);
    }
    (0, T)
}

/// The states in Pinocchio's order: of a free base the linear three first, and the quaternion's real part last.
fn theirs(model: &Model, states: &States) -> Vec<f64> {
    let mut numbers = Vec::new();
    for state in states.iter() {
        for (mut values, positions) in state.into_iter().zip([true, false, false, false]) {
            if model.is_floating() && positions {
                numbers.extend([4, 5, 6, 1, 2, 3, 0].map(|i| values[i]));
                values = &values[7..];
            } else if model.is_floating() {
                numbers.extend([3, 4, 5, 0, 1, 2].map(|i| values[i]));
                values = &values[6..];
            }
            numbers.extend(values);
        }
    }
    numbers
}

/// The rotation by rows, then the translation.
fn numbers(T: SE3) -> [f64; 12] {
    let [[a, b, c], [d, e, f], [g, h, i]] = T.R.matrix().rows();
    let [x, y, z] = T.p.0;
    [a, b, c, d, e, f, g, h, i, x, y, z]
}
