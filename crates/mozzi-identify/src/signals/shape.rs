//! The shape of dry friction.

/// Dry friction of unit size as a function of velocity: tanh(θ̇/w), and with Stribeck's velocity exp(−(θ̇/v)²)
/// tanh(θ̇/w).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Shape {
    /// w, rad/s or m/s.
    pub width: f64,
    /// v, rad/s or m/s.
    pub stribeck: Option<f64>,
}

impl Default for Shape {
    fn default() -> Self {
        Shape { width: 0.05, stribeck: None }
    }
}

impl Shape {
    /// tanh(θ̇/w).
    pub fn coulomb(&self, dtheta: f64) -> f64 {
        (dtheta / self.width).tanh()
    }

    /// exp(−(θ̇/v)²) tanh(θ̇/w), 0 without v.
    pub fn stribeck(&self, dtheta: f64) -> f64 {
        self.stribeck.map_or(0.0, |v| (-(dtheta / v).powi(2)).exp() * self.coulomb(dtheta))
    }

    /// The derivatives of both.
    pub fn slopes(&self, dtheta: f64) -> [f64; 2] {
        let tanh = self.coulomb(dtheta);
        let slope = (1.0 - tanh * tanh) / self.width;
        let falls = |v: f64| (-(dtheta / v).powi(2)).exp() * (slope - 2.0 * dtheta / (v * v) * tanh);
        [slope, self.stribeck.map_or(0.0, falls)]
    }
}
