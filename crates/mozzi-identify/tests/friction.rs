//! Dry friction whose jumps pass the filter.

use crate::common;

use common::{motion, with_forces};
use mozzi::random::Random;
use mozzi_identify::signals::{Cutoff, Filter};
use mozzi_identify::{Choice, Columns, Options, Sensor, identify};

/// Largest relative error of μ, of a UR5 that reverses about once a second.
fn error_of_mu(cutoff: f64, stribeck: Option<f64>, has_velocities: bool) -> f64 {
    let model = mozzi_urdf::open("ur5").expect("embedded").description.build().expect("sound");
    let choice = Choice { stribeck, ..Choice::only_friction(Sensor::Link) };
    let columns = Columns::new(&model, choice.clone()).expect("columns");
    let x: Vec<f64> = columns
        .unknowns
        .iter()
        .map(|unknown| match unknown.name.rsplit('.').next() {
            Some("friction") => 5.0,
            Some("damping") => 2.0,
            Some("stribeck") => 1.5,
            _ => 0.3,
        })
        .collect();
    let log = motion(&model, 20.0, 200.0, 0.6, 3);
    let mut log = with_forces(&log, &model, &choice, &x, &[0.02; 6], &mut Random(2));
    log.ddtheta = None;
    if !has_velocities {
        log.dtheta = None;
    }
    let filter = Filter { cutoff: Cutoff::Hz(cutoff), ..Filter::default() };
    let options = Options { choice, filter, ..Options::default() };
    let found = identify(&model, &[log], &options, &|| false).expect("an identification");
    let of_mu = columns.unknowns.iter().enumerate().filter(|(_, unknown)| unknown.name.ends_with(".friction"));
    let found = &found.estimates.consistent.x;
    of_mu.map(|(k, _)| (found[k] / x[k] - 1.0).abs()).fold(0.0, f64::max)
}

#[test]
fn a_low_cut_off_does_not_blunt_dry_friction() {
    for (cutoff, stribeck) in [(4.0, None), (8.0, None), (4.0, Some(0.1))] {
        let error = error_of_mu(cutoff, stribeck, true);
        let without = error_of_mu(cutoff, stribeck, false);
        eprintln!("cut-off {cutoff} Hz, Stribeck {stribeck:?}: error of μ {error:.4}; without velocities {without:.4}");
        assert!(error < 0.02, "{error}");
    }
}
