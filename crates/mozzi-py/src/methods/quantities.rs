//! The form of a method that computes a quantity, and what `help` says of each argument.

/// Methods of Python's `Model`, in numpydoc's sections:
///
/// ```text
/// /// What it computes.
/// name(theta, dtheta; of frame; touching tip_wrench; with own: Type = default; in gravity; to out) = Quantity::OfThese(frame) => {
///     /// What it answers: the section `Returns`, and the sections after it.
/// }
/// ```
///
/// First the state; then what may be left out: the frame, the wrench by position, the rest by name, of which the quantity takes its own and
/// the environment the others. Without `to out` there are several results, and `as Class` names their tuple.
macro_rules! methods {
    ($(
        $(#[doc = $what:tt])*
        $name:ident(
            $($state:ident),+ $(; of $frame:ident)? $(; touching $wrench:ident)? $(; with $($own:ident: $kind:ty = $default:tt),+)?
            $(; in $($around:ident),+)? $(; to $out:ident)?
        ) = $quantity:expr $(, as $class:ident)? => { $(#[doc = $answer:tt])* }
    )*) => {
        #[pymethods]
        impl PyModel { $(
            $(#[doc = $what])*
            #[doc = "\nParameters\n----------"]
            #[doc = said!($($state,)+ $($frame,)? $($wrench,)? $($($own,)+)? $($($around,)+)? $($out,)? threads)]
            #[doc = "\nReturns\n-------"]
            $(#[doc = $answer])*
            #[pyo3(signature = (
                $($state,)+ $($frame=None,)? $($wrench=None,)? *, $($($own=$default,)+)? $($($around=None,)+)? $($out=None,)? threads=None
            ))]
            #[allow(clippy::too_many_arguments, clippy::needless_update)] // Python's; some methods have all
            fn $name<'py>(
                &self,
                py: Python<'py>,
                $($state: &Bound<'py, PyAny>,)+
                $($frame: Option<&str>,)?
                $($wrench: Given<'_, 'py>,)?
                $($($own: $kind,)+)?
                $($($around: Given<'_, 'py>,)+)?
                $($out: Given<'_, 'py>,)?
                threads: Option<Threads>,
            ) -> PyResult<Bound<'py, PyAny>> {
                $(let $frame = self.frame($frame)?;)?
                let state = [$((stringify!($state), $state)),+];
                let around = Arguments { $($wrench,)? $($($around,)+)? ..Arguments::default() };
                let options = Options { $($out,)? threads, ..Options::default() };
                answer!(self, py, $quantity, state, around, options $(, $class)?)
            }
        )* }
    };
}

/// An array, or several as a named tuple.
macro_rules! answer {
    ($model:ident, $py:ident, $quantity:expr, $state:ident, $around:ident, $options:ident) => {
        $model.robot().ask($py, $quantity, $state, $around, $options)
    };
    ($model:ident, $py:ident, $quantity:expr, $state:ident, $around:ident, $options:ident, $class:ident) => {
        named($py, stringify!($class), $model.robot().ask_all($py, $quantity, &$state, &$around, $options)?)
    };
}

/// What `help` says of arguments, in numpydoc's form; `one` of those that are of one state.
macro_rules! said {
    (base_twist, base_acceleration $(, $($rest:ident),+)?) => {
        concat!("base_twist, base_acceleration : array_like, shape (6,), optional
    The motion of {s} itself, (ω, v) and (ω̇, v̇).", $("\n", said!($($rest),+))?)
    };
    ($first:ident, $($rest:ident),+) => { concat!(said!($first), "\n", said!($($rest),+)) };
    (one $first:ident, $($rest:ident),+) => { concat!(said!(one $first), "\n", said!(one $($rest),+)) };
    (theta) => { "theta : array_like, shape (..., nq)
    Positions: rad (revolute, helical) or m (prismatic); of a floating base first its quaternion (w, x, y, z) and origin." };
    (dtheta) => { "dtheta : array_like, shape (..., n)
    Velocities: rad/s or m/s; of a floating base first its body twist (ω, v)." };
    (ddtheta) => { "ddtheta : array_like, shape (..., n)
    Accelerations: rad/s² or m/s²." };
    (tau) => { "tau : array_like, shape (..., n)
    Joint torques and forces: N m or N." };
    (x) => { "x : array_like, shape (..., n)
    A constant vector." };
    (frame) => { "frame : str, optional
    A link or frame of the robot; without it, its end effector." };
    (tip_wrench) => { "tip_wrench : array_like, shape (..., 6), optional
    (m, f) that the end effector applies to the environment, in its own coordinates: N m, N." };
    (about) => { "about : array_like, shape (3,), optional
    A point of {s}; by default its origin." };
    (coordinates) => { "coordinates : {'body', 'space'}
    Whose coordinates the twist and the wrench are in." };
    (rows) => { "rows : sequence of int, optional
    Which of (ω_x, ω_y, ω_z, v_x, v_y, v_z), each once; all by default." };
    (gravity) => { "gravity : array_like, shape (3,), optional
    In place of the model's own, in the axes of {s}: m/s²." };
    (applied_wrenches) => { "applied_wrenches : dict of str to array_like of shape (..., 6), optional
    (m, f) that each frame applies to the environment, in its own coordinates." };
    (base_twist) => { "base_twist : array_like, shape (6,), optional
    The motion of {s} itself, (ω, v)." };
    (out) => { "out : numpy.ndarray, optional
    Where the result is written." };
    (threads) => { "threads : int, optional
    As many at most; by default all cores. Many states only." };
    (one theta) => { "theta : array_like, shape (nq,)
    Positions: rad or m." };
    (one dtheta) => { "dtheta : array_like, shape (n,)
    Velocities: rad/s or m/s." };
    (one ddtheta) => { "ddtheta : array_like, shape (n,)
    Accelerations: rad/s² or m/s²." };
    (one tip_wrench) => { "tip_wrench : array_like, shape (6,), optional
    (m, f) that the end effector applies to the environment, in its own coordinates: N m, N." };
    (one applied_wrenches) => { "applied_wrenches : dict of str to array_like of shape (6,), optional
    (m, f) that each frame applies to the environment, in its own coordinates." };
}
