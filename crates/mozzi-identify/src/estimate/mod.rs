//! Estimates of the unknowns: by least squares, and of bodies that exist.

pub mod consistent;
pub mod least_squares;
pub mod pseudo_inertia;
