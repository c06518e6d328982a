//! ANYmal on its feet.
#![allow(non_snake_case)]

mod anymal;
mod drop;
mod held;
