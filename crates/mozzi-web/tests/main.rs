//! The tests in one program: each links the crate and all that it needs.
#![allow(clippy::unwrap_used, missing_docs)]

mod interface;
mod play;
mod three_links;
