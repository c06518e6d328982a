//! Robots whose equations nobody reads are refused before memory is used up.

use crate::attempt;
use mozzi_symbolic::{Error, Options, Symbols};
use std::fmt::Write;

/// Links that turn about parallel axes, one on the other.
fn chain(links: usize) -> String {
    let mut text = String::from("<robot name='chain'><link name='l0'/>");
    for i in 1..=links {
        let below = i - 1;
        let _ = write!(
            text,
            "<link name='l{i}'><inertial><mass value='1'/><inertia ixx='1' ixy='0' ixz='0' iyy='1' iyz='0' izz='1'/></inertial></link>\
             <joint name='j{i}' type='continuous'><origin xyz='0 0 1'/><parent link='l{below}'/><child link='l{i}'/><axis xyz='0 1 0'/></joint>"
        );
    }
    text + "</robot>"
}

#[test]
fn long_chains_are_refused_by_their_terms() {
    let options = Options { symbols: Symbols::NONE, ..Options::default() };
    match attempt(&chain(36), "mass_matrix", &options) {
        Err(error @ Error::TooLong { terms, most: 200_000, .. }) => {
            assert!(terms > 200_000 && error.to_string().contains("expected at most 200000"), "{error}");
        }
        other => panic!("{other:?}"),
    }
    let error = attempt(&chain(1001), "gravity_forces", &options).expect_err("too many");
    assert!(error.to_string().contains("1001 moving links, expected at most 1000"), "{error}");
    assert!(attempt(&chain(36), "gravity_forces", &options).is_ok());
}
