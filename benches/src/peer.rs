//! A peer, compiled into a library with the interface of `benches/peers/peer.hpp`, which is loaded at run time.

use crate::contestant::Contestant;
use crate::convention::Convention;
use crate::motion::{BRAKE, STEP, STEPS};
use crate::quantity;
use crate::states::States;
use libloading::{Library, Symbol};
use mozzi::model::description::{Anchor, Closure, Constraint, ConstraintKind, JointKind};
use mozzi::quantities::Query;
use mozzi::{Description, Model, SE3};
use mozzi_sim::Method;
use std::ffi::{CStr, CString, c_char, c_int};

/// The library.
pub struct Peer {
    pub name: String,
    library: Library,
}

/// A robot with its states, made in the library.
pub struct Robot<'a> {
    library: &'a Library,
    this: *mut Opaque,
    run: Run,
    model: &'a Model,
    states: &'a States,
    convention: Convention,
    algorithms: Vec<(Query<'static>, String)>,
}

#[repr(C)]
pub struct Opaque {
    _private: [u8; 0],
}

/// `Body` of peer.hpp.
pub type Body = [f64; 30];

type Text = unsafe extern "C" fn() -> *const c_char;
type TextOf = unsafe extern "C" fn(*mut Opaque, c_int) -> *const c_char;
type NewRobot =
    unsafe extern "C" fn(*const c_char, *const c_char, *const f64, c_int, *const Body, c_int) -> *mut Opaque;
type Free = unsafe extern "C" fn(*mut Opaque);
type SetStates = unsafe extern "C" fn(*mut Opaque, *const f64, c_int);
type Run = unsafe extern "C" fn(*mut Opaque, c_int);
type Simulate = unsafe extern "C" fn(*mut Opaque, c_int, c_int, c_int, f64, f64, *mut f64, *mut f64);
/// The robot, the number of a body, a point in its frame, its place in {s}.
type Pin = unsafe extern "C" fn(*mut Opaque, c_int, *const f64, *const f64);
type GetResult = unsafe extern "C" fn(*mut Opaque, c_int, c_int, *mut f64);

/// A function of the library.
///
/// # Safety
/// `F` is its type.
unsafe fn function<'l, F>(library: &'l Library, name: &str) -> Result<Symbol<'l, F>, String> {
    // SAFETY: by the caller.
    unsafe { library.get(name) }.map_err(|error| format!("{name}: {error}"))
}

/// # Safety
/// The argument is null, or a null-terminated string that stays valid.
unsafe fn text(pointer: *const c_char) -> Option<String> {
    // SAFETY: by the caller.
    (!pointer.is_null()).then(|| unsafe { CStr::from_ptr(pointer) }.to_string_lossy().into_owned())
}

/// The library's optional functions for a robot.
///
/// # Safety
/// `robot` is the library's, and alive.
unsafe fn algorithms(library: &Library, robot: *mut Opaque) -> Result<Vec<(Query<'static>, String)>, String> {
    let mut list = Vec::new();
    // SAFETY: the types are those of peer.hpp; the second function is called only with values from the first one.
    unsafe {
        let quantity_of = function::<TextOf>(library, "peer_quantity")?;
        let name_of = function::<TextOf>(library, "peer_algorithm")?;
        while let Some(name) = text(quantity_of(robot, list.len() as c_int)) {
            let quantity = quantity::all()
                .find(|query| query.name() == name)
                .ok_or_else(|| format!("{name}: no such quantity"))?;
            list.push((quantity, text(name_of(robot, list.len() as c_int)).unwrap_or_default()));
        }
    }
    Ok(list)
}

impl Peer {
    pub fn load(name: &str, path: &str) -> Result<Self, String> {
        // SAFETY: the library's initialisers are its own responsibility.
        let library = unsafe { Library::new(path) }.map_err(|error| format!("{path}: {error}"))?;
        Ok(Peer { name: name.into(), library })
    }

    /// The version of the library, and its compiler flags.
    pub fn version(&self) -> Result<String, String> {
        Ok(format!("{}, `{}`", self.text("peer_version")?, self.text("peer_flags")?))
    }

    fn text(&self, name: &str) -> Result<String, String> {
        // SAFETY: all three are `const char* f()`, and return strings that stay valid.
        unsafe { text(function::<Text>(&self.library, name)?()) }.ok_or_else(|| format!("{name}: no text"))
    }

    /// The robot, made by [`merged`](crate::robots::merged), at the same states; none if the library does not
    /// support it.
    pub fn robot<'a>(&'a self, name: &str, model: &'a Model, states: &'a States) -> Result<Option<Robot<'a>>, String> {
        let (description, library) = (model.description(), &self.library);
        let convention = Convention::named(&self.text("peer_convention")?, model)?;
        let mut numbers = Vec::new();
        for state in states.iter() {
            numbers.extend(convention.state(state).map_err(|error| error.to_string())?.concat());
        }
        let c_text = |text: &str| CString::new(text).map_err(|error| format!("{name}: {error}"));
        let (c_name, urdf) = (c_text(name)?, c_text(&urdf(description)?)?);
        let rows = bodies(description);
        // SAFETY: the types are those of peer.hpp; every pointer is to as many numbers as the library reads, and
        // strings are null-terminated.
        unsafe {
            let (make, set) =
                (function::<NewRobot>(library, "peer_robot")?, function::<SetStates>(library, "peer_states")?);
            let (gravity, count) = (description.gravity.as_ptr(), rows.len() as c_int);
            let is_floating = model.is_floating().into();
            let this = make(c_name.as_ptr(), urdf.as_ptr(), gravity, is_floating, rows.as_ptr(), count);
            if this.is_null() {
                return Ok(None);
            }
            set(this, numbers.as_ptr(), states.count() as c_int);
            for (body, point, place) in pins(description) {
                // a library without this function has no constraints
                let Ok(pin) = function::<Pin>(library, "peer_pin") else {
                    function::<Free>(library, "peer_free")?(this);
                    return Ok(None);
                };
                pin(this, body, point.as_ptr(), place.as_ptr());
            }
            let run = *function::<Run>(library, "peer_run")?;
            Ok(Some(Robot { library, this, run, model, states, convention, algorithms: algorithms(library, this)? }))
        }
    }
}

impl Robot<'_> {
    /// The state 1 s after this one, by an algorithm of forward dynamics, if the library can simulate.
    ///
    /// # Panics
    /// If slices have a wrong length.
    pub fn simulate(&mut self, algorithm: usize, method: Method, [theta, dtheta]: [&mut [f64]; 2]) -> Option<()> {
        assert!(theta.len() == self.model.n() && dtheta.len() == self.model.n() && algorithm < self.algorithms.len());
        let is_runge_kutta = (method == Method::RungeKutta4).into();
        // SAFETY: the type is that of peer.hpp; the robot is alive, the algorithm one of its own, and both arrays are
        // of n numbers.
        unsafe {
            let simulate = function::<Simulate>(self.library, "peer_simulate").ok()?;
            let (theta, dtheta) = (theta.as_mut_ptr(), dtheta.as_mut_ptr());
            simulate(self.this, algorithm as c_int, is_runge_kutta, STEPS as c_int, STEP, BRAKE, theta, dtheta);
        }
        Some(())
    }
}

impl Contestant for Robot<'_> {
    fn algorithms(&self) -> Vec<(Query<'static>, String)> {
        self.algorithms.clone()
    }

    fn run(&mut self, algorithm: usize) {
        // SAFETY: the library is loaded as long as it is borrowed, and the robot is alive.
        unsafe { (self.run)(self.this, algorithm as c_int) }
    }

    fn result(&mut self, algorithm: usize, state: usize) -> Result<Vec<f64>, String> {
        let query = self.algorithms[algorithm].0;
        let mut out = vec![0.0; quantity::length(query, self.model)];
        // SAFETY: the type is that of peer.hpp; `out` is as long as the quantity.
        unsafe {
            let get = function::<GetResult>(self.library, "peer_result")?;
            get(self.this, algorithm as c_int, state as c_int, out.as_mut_ptr());
        }
        let state = self.states.iter().nth(state).ok_or("no such state")?;
        self.convention.result(self.model, query, state, &out).map_err(|error| error.to_string())
    }
}

impl Drop for Robot<'_> {
    fn drop(&mut self) {
        // SAFETY: made by `peer_robot`, freed once.
        unsafe {
            if let Ok(free) = function::<Free>(self.library, "peer_free") {
                free(self.this);
            }
        }
    }
}

/// The robot's URDF, with a fixed base, for a library that reads nothing else. URDF cannot express gravity.
pub fn urdf(description: &Description) -> Result<String, String> {
    let constraints = Vec::new();
    let standard =
        Description { constraints, gravity: [0.0, 0.0, -9.81], base: mozzi::Base::Fixed, ..description.clone() };
    mozzi_urdf::write(&standard).map_err(|error| error.to_string())
}

/// A row for the base and for each joint with its link.
pub fn bodies(description: &Description) -> Vec<Body> {
    let mut rows = Vec::new();
    for (k, link) in description.links.iter().enumerate() {
        let mut row = Vec::with_capacity(30);
        match k.checked_sub(1).map(|joint| &description.joints[joint]) {
            None => row.extend([[-1.0, 0.0].as_slice(), &numbers(SE3::identity()), &[0.0; 3]].concat()),
            Some(joint) => {
                let JointKind::Screw(screw) = joint.kind else { panic!("`{}` does not move", joint.name) };
                let (twist, is_revolute) = (screw.twist(), !screw.is_prismatic());
                let axis = if is_revolute { twist.w } else { twist.v };
                let parent = description.links.iter().position(|link| link.name == joint.parent).expect("a link");
                row.extend([parent as f64, f64::from(u8::from(is_revolute))]);
                row.extend([numbers(joint.origin).as_slice(), &axis.0].concat());
            }
        }
        let G = link.inertia;
        row.push(G.mass);
        row.extend(if G.mass > 0.0 { G.center_of_mass().0 } else { [0.0; 3] });
        row.extend(if G.mass > 0.0 { G.about_center_of_mass().to_mat3() } else { G.I.to_mat3() }.rows().concat());
        rows.push(std::array::from_fn(|i| row[i]));
    }
    rows
}

/// Points of bodies that are pinned to {s}: the body's number, the point in its frame, its place.
fn pins(description: &Description) -> Vec<(c_int, [f64; 3], [f64; 3])> {
    let pin = |constraint: &Constraint| match &constraint.kind {
        ConstraintKind::Frames { a: Anchor { frame: None, T: place }, b, closure: Closure::Point } => {
            let body = description.links.iter().position(|link| Some(&link.name) == b.frame.as_ref()).expect("a link");
            (body as c_int, b.T.p.0, place.p.0)
        }
        _ => panic!("`{}` pins no point to {{s}}", constraint.name),
    };
    description.constraints.iter().map(pin).collect()
}

/// The rotation by rows, then the translation.
fn numbers(T: SE3) -> [f64; 12] {
    let [[a, b, c], [d, e, f], [g, h, i]] = T.R.matrix().rows();
    let [x, y, z] = T.p.0;
    [a, b, c, d, e, f, g, h, i, x, y, z]
}
