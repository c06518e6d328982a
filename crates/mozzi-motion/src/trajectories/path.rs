//! Paths without timing: θ(s) for s from 0 to 1.

use crate::Error;
use crate::error::check;
use mozzi::Model;
use mozzi::model::{difference, integrate};

/// A point of a path.
#[derive(Clone, Debug, PartialEq)]
pub struct Point {
    /// θ, nq positions.
    pub theta: Vec<f64>,
    /// θ′, n numbers as velocities are: the motion at ṡ = 1.
    pub slope: Vec<f64>,
    /// θ″, n numbers: the rate of θ′ at ṡ = 1.
    pub curvature: Vec<f64>,
}

/// A path of a robot's positions.
pub trait Path {
    /// θ, θ′ and θ″ at s, which is between 0 and 1.
    fn at(&self, s: f64) -> Point;

    /// The s at which θ″ or its rate jumps: extreme accelerations may be there. By default none.
    fn knots(&self) -> Vec<f64> {
        Vec::new()
    }
}

impl<P: Path + ?Sized> Path for &P {
    fn at(&self, s: f64) -> Point {
        (**self).at(s)
    }
    fn knots(&self) -> Vec<f64> {
        (**self).knots()
    }
}

impl<P: Path + ?Sized> Path for Box<P> {
    fn at(&self, s: f64) -> Point {
        (**self).at(s)
    }
    fn knots(&self) -> Vec<f64> {
        (**self).knots()
    }
}

/// θ₀ ⊕ sΔ with Δ = θ₁ ⊖ θ₀: the joints in proportion to each other, a floating base along a screw.
#[derive(Clone, Debug)]
pub struct Line<'m> {
    model: &'m Model,
    from: Vec<f64>,
    way: Vec<f64>,
}

impl<'m> Line<'m> {
    /// From θ₀ to θ₁.
    ///
    /// # Errors
    /// [`mozzi::Error::WrongLength`], [`mozzi::Error::BadArgument`].
    pub fn new(model: &'m Model, from: &[f64], to: &[f64]) -> Result<Self, Error> {
        for (what, theta) in [("the start of a line", from), ("the end of a line", to)] {
            model.check_configuration(theta)?;
            check(theta.iter().all(|x| x.is_finite()), what, format!("{theta:?}"), "finite numbers")?;
        }
        let mut way = vec![0.0; model.n()];
        difference(model, from, to, &mut way);
        Ok(Line { model, from: from.to_vec(), way })
    }
}

impl Path for Line<'_> {
    fn at(&self, s: f64) -> Point {
        let mut theta = self.from.clone();
        integrate(self.model, &mut theta, &self.way, s);
        Point { theta, slope: self.way.clone(), curvature: vec![0.0; self.way.len()] }
    }
}
