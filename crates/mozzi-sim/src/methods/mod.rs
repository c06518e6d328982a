//! Methods of integration.

pub(crate) mod dense;
pub(crate) mod dormand_prince;
mod explicit;
mod free_bodies;
mod impulse_steps;
pub(crate) mod midpoint;
pub(crate) mod moreau;

pub use dormand_prince::dormand_prince_by_equal_steps;
pub use explicit::Motion;

use crate::Error;

/// A method of integration. The first three are explicit, with fixed steps; [`Motion::step`](crate::Motion::step) takes
/// such a step on any number type, see [`explicit`](Self::explicit). With θ̈ = F(t, θ, θ̇) and step h:
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Method {
    /// [`MoreauJean`](Self::MoreauJean) if the robot has dry friction or contacts, or limits that are respected, else
    /// [`RungeKutta4`](Self::RungeKutta4).
    Automatic,
    /// Moreau and Jean's step with θ = ½, for dry friction, stops and contacts: their impulses are solved for together
    /// with those of constraints, once a step. Order 2 as long as no contact changes and through rests of joints with
    /// dry friction, order 1 through impacts. It is implicit in springs, damping and the motors'
    /// [gains](crate::Input::gains).
    MoreauJean,
    /// The book's: θ\[k+1\] = θ\[k\] + θ̇\[k\]h, θ̇\[k+1\] = θ̇\[k\] + θ̈\[k\]h. Order 1; a swinging robot gains
    /// energy.
    Euler,
    /// θ̇\[k+1\] = θ̇\[k\] + θ̈\[k\]h, then θ\[k+1\] = θ\[k\] + θ̇\[k+1\]h. Order 1; the energy of a
    /// single pendulum stays bounded, that of a robot whose inertia changes drifts.
    SemiImplicitEuler,
    /// The classical method with four stages. Order 4, as long as F is smooth: kinks of a table, Coulomb friction and
    /// contacts reduce the order of the step in which they occur.
    RungeKutta4,
    /// Dormand and Prince's method of order 5, with adaptive steps whose estimated error is below a tolerance: absolute
    /// for θ (rad, m), relative to 1 + |θ̇| for θ̇.
    DormandPrince {
        /// Above 0.
        tolerance: f64,
    },
    /// The implicit midpoint rule in (θ, p = Mθ̇), order 2. It is symplectic: the energy's error stays bounded. It also
    /// keeps the momentum of a floating base.
    Midpoint,
}

/// An explicit method with fixed steps.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Explicit {
    /// [`Method::Euler`].
    Euler,
    /// [`Method::SemiImplicitEuler`].
    SemiImplicitEuler,
    /// [`Method::RungeKutta4`].
    RungeKutta4,
}

impl Method {
    /// p: the error at a given time falls as hᵖ.
    pub fn order(self) -> u32 {
        match self {
            Method::Euler | Method::SemiImplicitEuler => 1,
            Method::Midpoint | Method::MoreauJean => 2,
            Method::RungeKutta4 | Method::Automatic => 4,
            Method::DormandPrince { .. } => 5,
        }
    }

    /// True if a tolerance determines its step size.
    pub fn is_adaptive(self) -> bool {
        matches!(self, Method::DormandPrince { .. })
    }

    /// The explicit method, for uses in which each step is a map of its own, such as many robots at once, or
    /// derivatives.
    ///
    /// # Errors
    /// [`mozzi::Error::BadArgument`] for a method that is adaptive or implicit.
    pub fn explicit(self) -> Result<Explicit, Error> {
        match self {
            Method::Euler => Ok(Explicit::Euler),
            Method::SemiImplicitEuler => Ok(Explicit::SemiImplicitEuler),
            Method::RungeKutta4 | Method::Automatic => Ok(Explicit::RungeKutta4),
            Method::DormandPrince { .. } | Method::Midpoint | Method::MoreauJean => {
                Err(Error::Model(mozzi::Error::BadArgument {
                    what: "the method",
                    found: self.name().into(),
                    expected: "Euler, semi-implicit Euler or Runge-Kutta 4",
                }))
            }
        }
    }

    /// The method that [`Automatic`](Self::Automatic) is for a robot with or without one-sided forces.
    pub(crate) fn resolved(self, is_one_sided: bool) -> Self {
        match (self, is_one_sided) {
            (Method::Automatic, true) => Method::MoreauJean,
            (Method::Automatic, false) => Method::RungeKutta4,
            (method, _) => method,
        }
    }

    /// "Moreau-Jean", "Euler", "semi-implicit Euler", "Runge-Kutta 4", "Dormand-Prince 5(4)" or "implicit midpoint".
    pub fn name(self) -> &'static str {
        match self {
            Method::Automatic => "automatic",
            Method::MoreauJean => "Moreau-Jean",
            Method::Euler => "Euler",
            Method::SemiImplicitEuler => "semi-implicit Euler",
            Method::RungeKutta4 => "Runge-Kutta 4",
            Method::DormandPrince { .. } => "Dormand-Prince 5(4)",
            Method::Midpoint => "implicit midpoint",
        }
    }
}
