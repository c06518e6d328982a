//! Dry friction, stops and contacts along motions, compared with closed-form solutions.
#![allow(non_snake_case)]

mod balls;
mod boxes;
mod discs;
mod drops;
mod dry_friction;
mod pinocchio;
mod robots;
mod stops;
mod tossed;
