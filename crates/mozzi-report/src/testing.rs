//! A robot with balls and free joints, and a configuration of any robot.

use mozzi::model::Freedom;
use mozzi::{Description, Model};

/// An arm with two balls, and two free bodies.
pub fn balls() -> Description {
    let text = include_str!("../tests/balls.xml");
    mozzi_urdf::parse("balls.xml", text).expect("sound").description
}

/// Different numbers for all entries, with unit quaternions.
pub fn configuration(model: &Model) -> Vec<f64> {
    let mut theta: Vec<f64> = (0..model.nq()).map(|k| 0.3 + 0.17 * (k % 12) as f64).collect();
    let base = model.is_floating().then_some(0);
    let places = model.places().iter().filter(|place| place.freedom != Freedom::One);
    for q in base.into_iter().chain(places.map(|place| place.q)) {
        let size = theta[q..q + 4].iter().map(|x| x * x).sum::<f64>().sqrt();
        theta[q..q + 4].iter_mut().for_each(|x| *x /= size);
    }
    theta
}
