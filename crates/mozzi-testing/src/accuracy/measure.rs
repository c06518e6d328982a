//! Every quantity of a robot in every way.

use crate::accuracy::errors::Errors;
use crate::accuracy::reference::{Neighbours, Reference};
use crate::accuracy::robot::Robot;
use crate::accuracy::states::States;
use crate::accuracy::terms;
use crate::accuracy::ways::{Computer, Way};
use mozzi::quantities::LIST;
use rayon::prelude::*;

/// Largest count of numbers in a chunk of states.
const CHUNK: usize = 1 << 18;

/// Largest number of velocities for quantities that take n³ operations or have more than n² numbers.
const LONGEST: usize = 200;

/// The measurement of a quantity.
#[derive(Clone, Debug)]
pub struct Row {
    /// The quantity's index in the list.
    pub quantity: usize,
    /// The way, or another library's name.
    pub way: &'static str,
    /// The errors in units.
    pub errors: Errors,
}

/// All quantities of a robot in all ways, at these states.
pub fn all(robot: &Robot, states: &States, seed: u64) -> Vec<Row> {
    (0..LIST.len()).flat_map(|quantity| one(robot, states, seed, quantity)).collect()
}

/// One quantity: at the states, and in `f32` at the states rounded to `f32`.
pub fn one(robot: &Robot, states: &States, seed: u64, quantity: usize) -> Vec<Row> {
    let (single, double): (Vec<Way>, Vec<Way>) = Way::ALL.into_iter().partition(|&way| way == Way::Single);
    let mut rows = in_ways(robot, states, seed, quantity, &double);
    rows.extend(in_ways(robot, &states.rounded(), seed, quantity, &single));
    rows
}

fn in_ways(robot: &Robot, states: &States, seed: u64, quantity: usize, ways: &[Way]) -> Vec<Row> {
    let query = robot.query(quantity);
    let first = states.inputs(&query, 0, 1);
    if robot.model.compute(query, &first, &robot.model.environment()).is_err() {
        return Vec::new(); // the robot has no mass, or its mass matrix is singular
    }
    let size: usize = query.output_lengths(&robot.model).sum::<usize>().max(1);
    let declaration = query.declaration();
    let is_cubic = declaration.divides && declaration.name != "forward_dynamics";
    if robot.model.n() > LONGEST && (is_cubic || size > robot.model.n().pow(2)) {
        return Vec::new();
    }
    let count = (CHUNK / size).clamp(1, 256);
    let neighbours = Neighbours::new(&robot.double, robot.frame);
    let firsts: Vec<usize> = (0..states.len()).step_by(count).collect();
    // each thread has its own memory and machine code
    let make = || {
        let computer = |way| Some((way, Computer::new(robot, query, way)?));
        (neighbours.memory(), ways.iter().copied().filter_map(computer).collect::<Vec<(Way, Computer)>>())
    };
    // a state at which mozzi returns an error has no result to compare
    let own = robot.model.environment();
    let is_regular = |state: usize| {
        !declaration.divides || robot.model.compute(query, &states.inputs(&query, state, 1), &own).is_ok()
    };
    let chunk = |(memory, computers): &mut (_, Vec<(Way, Computer)>), &first: &usize| {
        let count = count.min(states.len() - first);
        let references: Vec<Reference> = (first..first + count)
            .map(|state| {
                let inputs = states.inputs(&query, state, 1);
                let reference = neighbours.at(&query, &inputs, seed ^ state as u64, memory);
                let rounded: Vec<Vec<f64>> =
                    reference.values.iter().map(|x| x.iter().map(|&x| x.into()).collect()).collect();
                Reference { terms: terms::of(robot, &query, &inputs, &rounded), ..reference }
            })
            .collect();
        let errors = |(way, computer): &mut (Way, Computer)| {
            let (found, mut errors) = (computer.compute(states, first, count), Errors::default());
            for (k, reference) in references.iter().enumerate().filter(|&(k, _)| is_regular(first + k)) {
                let of_state = |x: &Vec<f64>| x[k * (x.len() / count)..][..x.len() / count].to_vec();
                errors.add(reference, &found.iter().map(of_state).collect::<Vec<_>>(), way.epsilon());
            }
            (*way, errors)
        };
        computers.iter_mut().map(errors).collect::<Vec<(Way, Errors)>>()
    };
    let chunks: Vec<Vec<(Way, Errors)>> = firsts.par_iter().map_init(make, chunk).collect();
    let mut rows: Vec<Row> = Vec::new();
    for (way, errors) in chunks.into_iter().flatten() {
        match rows.iter_mut().find(|row| row.way == way.name()) {
            Some(row) => row.errors.join(errors),
            None => rows.push(Row { quantity, way: way.name(), errors }),
        }
    }
    rows
}
