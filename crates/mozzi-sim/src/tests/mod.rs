//! Simulations compared with closed-form solutions, and the robots they use.

mod against_stops;
mod balls;
mod constraints;
mod courses;
mod free_base;
mod moreau;
pub mod robots;
mod simulate;
mod springs;
