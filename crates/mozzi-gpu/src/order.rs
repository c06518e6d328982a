//! The order of a program's steps. A thread has at most 255 registers, and the fewer it uses the more threads run: of
//! several orders, the one in which the fewest values are alive at the same time is taken. Counts of registers for each
//! order are in docs/performance-log.md.

use mozzi_engine::{Program, Step, Value};
use std::collections::BTreeSet;

/// The program in the order in which the fewest values are alive: as recorded, or with the outputs finished joint by
/// joint from the last to the first, which goes limb by limb; each also with [`frugal`] steps first.
pub(crate) fn ordered(program: Program, n: usize) -> Program {
    let by_joint = program.by_need(&joints(&program, n));
    let [frugal_program, frugal_by_joint] = [&program, &by_joint].map(|program| program.by_need(&frugal(program)));
    let all = [program, frugal_program, by_joint, frugal_by_joint];
    let [first, others @ ..] = all;
    let least = |best: Program, other: Program| if alive(&other) < alive(&best) { other } else { best };
    others.into_iter().fold(first, least)
}

/// The outputs' values by joint, from the last to the first: the rows and columns of matrices, entries of vectors.
fn joints(program: &Program, n: usize) -> Vec<Value> {
    let of_joint = |j: usize| {
        program.outputs().iter().flat_map(move |output| {
            let values = &output.values;
            let is_matrix = n > 1 && values.len() == n * n;
            let of_matrix = (0..n).rev().flat_map(move |i| [values[i * n + j], values[j * n + i]]);
            let entries: Vec<Value> =
                if is_matrix { of_matrix.collect() } else { values.get(j).into_iter().copied().collect() };
            entries
        })
    };
    (0..n).rev().flat_map(of_joint).collect()
}

/// An order in which a step that ends as many values as it makes comes as soon as its operands are known, and else the
/// program's next.
fn frugal(program: &Program) -> Vec<Value> {
    let steps = program.steps();
    let is_value = |value: Value| matches!(steps[value as usize], Step::Apply(..));
    let operands = |place: Value| -> BTreeSet<Value> {
        steps[place as usize].operands().iter().copied().filter(|&value| is_value(value)).collect()
    };
    let mut users: Vec<Vec<Value>> = vec![Vec::new(); steps.len()];
    let mut waits = vec![0; steps.len()];
    for place in 0..steps.len() as Value {
        for operand in operands(place) {
            users[operand as usize].push(place);
            waits[place as usize] += 1;
        }
    }
    let mut left: Vec<usize> = users.iter().map(Vec::len).collect();
    // the values that a step makes, less those that it ends
    let is_frugal = |place: Value, left: &[usize]| {
        let made = usize::from(is_value(place) && !users[place as usize].is_empty());
        operands(place).iter().filter(|&&operand| left[operand as usize] == 1).count() >= made
    };
    let mut ready: BTreeSet<Value> = (0..steps.len() as Value).filter(|&place| waits[place as usize] == 0).collect();
    let (mut first, mut order) = (BTreeSet::new(), Vec::with_capacity(steps.len()));
    while let Some(place) = first.pop_first().or_else(|| ready.first().copied()) {
        ready.remove(&place);
        order.push(place);
        for operand in operands(place) {
            left[operand as usize] -= 1;
            if left[operand as usize] == 1 {
                let users = users[operand as usize].iter();
                first.extend(users.filter(|user| ready.contains(user) && is_frugal(**user, &left)));
            }
        }
        for &user in &users[place as usize] {
            waits[user as usize] -= 1;
            if waits[user as usize] == 0 {
                ready.insert(user);
                first.extend(is_frugal(user, &left).then_some(user));
            }
        }
    }
    order
}

/// The most values that are alive at the same time, each from its step to its last use; constants and inputs are read
/// where they are used, outputs written at once.
fn alive(program: &Program) -> usize {
    let steps = program.steps();
    let mut last = vec![0; steps.len()];
    for (place, step) in steps.iter().enumerate() {
        step.operands().iter().for_each(|&operand| last[operand as usize] = place);
    }
    let mut ending = vec![0_usize; steps.len()];
    let (mut now, mut most) = (0_usize, 0);
    for (place, step) in steps.iter().enumerate() {
        now -= ending[place];
        if matches!(step, Step::Apply(..)) && last[place] > place {
            ending[last[place]] += 1;
            now += 1;
            most = most.max(now);
        }
    }
    most
}

#[cfg(test)]
mod tests {
    use super::*;
    use mozzi::quantities::{InverseDynamics, InverseDynamicsVjp, Query};
    use mozzi_engine::{Arguments, Traced, record, record_quantity};

    #[test]
    fn a_sum_of_products_needs_two_values() {
        // all products first, as recorded: ten are alive
        let program = record("test", &[("x", 10)], |x| {
            let sines: Vec<Traced> = x[0].iter().map(|x| *x / Traced::from(3.0)).collect();
            vec![("y", vec![sines.iter().fold(Traced::from(1.0), |sum, &x| sum / x)])]
        })
        .expect("short");
        assert_eq!(alive(&program), 10);
        let found = ordered(program.clone(), 1);
        assert_eq!(alive(&found), 2);
        let x: Vec<f64> = (1..=10).map(f64::from).collect();
        assert_eq!(found.evaluate(&[&x]), program.evaluate(&[&x]));
    }

    #[test]
    fn limbs_one_after_the_other_keep_fewer_values_and_the_same_results() {
        let model = mozzi_urdf::open("anymal").and_then(|robot| robot.build()).expect("an embedded robot");
        for query in [Query::from(InverseDynamics), InverseDynamicsVjp.into()] {
            let program = record_quantity(&model, query, Arguments::default()).expect("no frame");
            let found = ordered(program.clone(), model.n());
            assert!(4 * alive(&found) < 3 * alive(&program), "{} of {}", alive(&found), alive(&program));
            assert_eq!(found.steps().len(), program.steps().len());
            let state = mozzi::random::state(&model, 1);
            let inputs: Vec<&[f64]> = [&state[0], &state[1], &state[2], &state[1]]
                .into_iter()
                .take(program.inputs().len())
                .map(Vec::as_slice)
                .collect();
            assert_eq!(found.evaluate(&inputs), program.evaluate(&inputs), "bit for bit");
        }
    }
}
