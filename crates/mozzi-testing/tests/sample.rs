//! A sample of docs/accuracy.md: every quantity in every way at a few states is within rounding of the reference, and
//! the references agree.
#![allow(missing_docs)]

use mozzi::quantities::LIST;
use mozzi_testing::accuracy::page::LIMIT;
use mozzi_testing::accuracy::robot::Robot;
use mozzi_testing::accuracy::states::States;
use mozzi_testing::accuracy::{digits, measure};
use rayon::prelude::*;

#[test]
fn every_quantity_is_within_rounding_of_the_reference() {
    for name in ["ur5", "panda", "anymal:floating", "mixed", "mixed:floating"] {
        let robot = Robot::open(name).expect("embedded");
        let states = States::new(&robot.model, robot.kind, 12, 7);
        let rows = measure::all(&robot, &states, 7);
        assert!(rows.len() > 3 * LIST.len());
        for row in rows {
            let worst = row.errors.whole().max;
            // a gradient by an axis is that by its placement less that by its link, which cancel in part
            let by_robot = LIST[row.quantity].name.ends_with("_parameter_vjp");
            let limit = if by_robot { 2.0 * LIMIT } else { LIMIT };
            assert!(worst < limit, "{name}, {}, {}: {worst} units", LIST[row.quantity].name, row.way);
            if let Some(terms) = row.errors.terms() {
                assert!(terms.max < LIMIT, "{name}, {}, {}: {terms:?} of the terms", LIST[row.quantity].name, row.way);
            }
        }
    }
}

#[test]
fn two_ways_agree_to_sixty_digits() {
    for name in ["ur5", "mixed"] {
        let robot = Robot::open(name).expect("embedded");
        let states = States::new(&robot.model, robot.kind, 1, 3);
        (0..LIST.len()).into_par_iter().for_each(|quantity| {
            let digits = digits::of(&robot, &states, 1, quantity).expect("regular");
            let quantity = LIST[quantity].name;
            assert!(digits.ways >= 60.0, "{name}, {quantity}: {} digits", digits.ways);
            assert!(digits.widths >= 25.0, "{name}, {quantity}: {} digits of double-double", digits.widths);
        });
    }
}
