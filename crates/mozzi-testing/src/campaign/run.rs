//! A seed's robot in its ways.

use crate::campaign::case::Case;
use crate::campaign::log::{Counts, Finding, Way};
use crate::campaign::trial::{Compared, Plain, Trial};
use crate::campaign::{LIMIT, generate};
use mozzi::quantities::{
    ForwardDynamicsDerivatives, ForwardDynamicsParameterVjp, ForwardDynamicsVjp, GravityForcesDerivative,
    InverseDynamicsDerivatives, InverseDynamicsParameterVjp, InverseDynamicsVjp, LIST, MassMatrixProductDerivative,
    MassMatrixProductVjp, Query, TipForcesDerivative,
};
use std::panic::{AssertUnwindSafe, catch_unwind};

/// Quantities of each robot that are compared with their second way, in turn.
pub const SECONDS: usize = 3;
/// Quantities of each robot that are recorded and compiled, in turn.
pub const CODED: usize = 1;
/// Rounds of the list of which one has long second ways, for robots of more than 6 and of more than 12 velocities.
pub const LONG: [u64; 2] = [4, 16];

/// True if the second way differentiates the stacked equations along each joint.
fn is_long(index: usize) -> bool {
    let long: [Query; 10] = [
        InverseDynamicsDerivatives.into(),
        ForwardDynamicsDerivatives.into(),
        InverseDynamicsVjp.into(),
        ForwardDynamicsVjp.into(),
        InverseDynamicsParameterVjp.into(),
        ForwardDynamicsParameterVjp.into(),
        MassMatrixProductVjp.into(),
        MassMatrixProductDerivative.into(),
        GravityForcesDerivative.into(),
        TipForcesDerivative.into(),
    ];
    long.iter().any(|query| query.index() == index)
}

/// The robot of a seed: all quantities by the kernel on `f64`, in memory full of NaN, fused, and on `f32`; [`SECONDS`]
/// of them by their second way; [`CODED`] as program and machine code. Consecutive seeds cover the list evenly.
pub fn one(seed: u64, counts: &mut Counts) -> Vec<Finding> {
    let case = generate::case(seed);
    let list = LIST.len() as u64;
    let (place, round) = ((seed % list) as usize, seed / list);
    let n = case.robot.clone().build().map_or(0, |model| model.n());
    let has_long = match n {
        0..=6 => true,
        7..=12 => round.is_multiple_of(LONG[0]),
        _ => round.is_multiple_of(LONG[1]),
    };
    let is_of = |count: usize, index: usize| (index + LIST.len() - place * count % LIST.len()) % LIST.len() < count;
    let ways = |index: usize| {
        let second = (is_of(SECONDS, index) && (has_long || !is_long(index))).then_some(Way::Second);
        let coded: &[Way] = match is_of(CODED, index) {
            true if round.is_multiple_of(2) => &[Way::Program, Way::Code, Way::Arrays],
            true => &[Way::Program, Way::Code, Way::SingleArrays],
            false => &[],
        };
        second.into_iter().chain([Way::Memory, Way::Fused, Way::Single]).chain(coded.iter().copied()).collect()
    };
    of_case(seed, &case, ways, counts)
}

/// The robot of a seed with every quantity in every way but C.
pub fn replay(seed: u64, counts: &mut Counts) -> Vec<Finding> {
    of_case(seed, &generate::case(seed), |_| Way::ALL.to_vec(), counts)
}

/// The largest difference of one quantity in one way, if it is above the limit.
pub fn differs(case: &Case, quantity: usize, way: Way) -> Option<Finding> {
    let ways = |index: usize| if index == quantity { vec![way] } else { Vec::new() };
    of_case(0, case, ways, &mut Counts::default()).pop()
}

fn of_case(seed: u64, case: &Case, ways: impl Fn(usize) -> Vec<Way>, counts: &mut Counts) -> Vec<Finding> {
    let Ok(model) = case.robot.clone().build() else {
        counts.skip("robot refused");
        return Vec::new();
    };
    let mut findings = Vec::new();
    // a panic is a finding, and the next comparison begins with fresh memory
    let mut trial = guarded(|| Trial::new(case, &model)).ok().flatten();
    if trial.is_none() {
        counts.skip("no trial");
    }
    for index in 0..LIST.len() {
        let chosen = ways(index);
        let Some(now) = &mut trial else { break };
        if chosen.is_empty() {
            continue;
        }
        let plain = guarded(|| now.plain(index));
        let mut plain = match plain {
            Ok(Ok(plain)) => plain,
            Ok(Err(why)) => {
                counts.skip(why);
                continue;
            }
            Err(what) => {
                findings.push(Finding { seed, quantity: index, way: Way::Memory, units: f64::INFINITY, what });
                trial = guarded(|| Trial::new(case, &model)).ok().flatten();
                continue;
            }
        };
        for way in chosen {
            let Some(now) = &mut trial else { break };
            match guarded(|| now.compare(&mut plain, way)) {
                Ok(None) => {}
                Ok(Some(compared)) => findings.extend(noted(seed, &plain, way, compared, counts)),
                Err(what) => {
                    findings.push(Finding { seed, quantity: index, way, units: f64::INFINITY, what });
                    trial = guarded(|| Trial::new(case, &model)).ok().flatten();
                }
            }
        }
    }
    findings
}

/// Counts a comparison; a finding if it is above the limit.
pub(crate) fn noted(seed: u64, plain: &Plain, way: Way, compared: Compared, counts: &mut Counts) -> Option<Finding> {
    let Compared { units, numbers, what } = compared;
    let quantity = plain.query().index();
    counts.add(LIST[quantity].name, way, units, numbers);
    (!(units <= LIMIT)).then_some(Finding { seed, quantity, way, units, what })
}

/// The message of a panic.
fn guarded<T>(of: impl FnOnce() -> T) -> Result<T, String> {
    catch_unwind(AssertUnwindSafe(of)).map_err(|panic| {
        let text = panic.downcast_ref::<String>().cloned();
        let text = text.or_else(|| panic.downcast_ref::<&str>().map(|text| (*text).to_string()));
        format!("panicked: {}", text.unwrap_or_default())
    })
}
