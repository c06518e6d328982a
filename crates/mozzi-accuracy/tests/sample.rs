//! A sample of docs/accuracy.md: every quantity in every way at a few states, within rounding of the reference; and the references agree.
#![allow(missing_docs)]

use mozzi::quantities::LIST;
use mozzi_accuracy::page::LIMIT;
use mozzi_accuracy::robot::Robot;
use mozzi_accuracy::states::States;
use mozzi_accuracy::{digits, measure};

#[test]
fn every_quantity_is_within_rounding_of_the_reference() {
    for name in ["ur5", "panda", "anymal:floating"] {
        let robot = Robot::open(name).expect("embedded");
        let states = States::new(&robot.model, robot.kind, 12, 7);
        let rows = measure::all(&robot, &states, 7);
        assert!(rows.len() > 3 * LIST.len());
        for row in rows {
            let worst = row.errors.whole().max;
            assert!(worst < LIMIT, "{name}, {}, {}: {worst} units", LIST[row.quantity].name, row.way);
            if let Some(terms) = row.errors.terms() {
                assert!(terms.max < LIMIT, "{name}, {}, {}: {terms:?} of the terms", LIST[row.quantity].name, row.way);
            }
        }
    }
}

#[test]
fn two_ways_agree_to_sixty_digits() {
    let robot = Robot::open("ur5").expect("embedded");
    let states = States::new(&robot.model, robot.kind, 1, 3);
    for quantity in 0..LIST.len() {
        let digits = digits::of(&robot, &states, 1, quantity).expect("regular");
        assert!(digits.ways >= 60.0, "{}: {} digits", LIST[quantity].name, digits.ways);
        assert!(digits.widths >= 25.0, "{}: {} digits of double-double", LIST[quantity].name, digits.widths);
    }
}
