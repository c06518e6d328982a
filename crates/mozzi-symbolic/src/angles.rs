//! Names of the state's numbers, and the groups of angles about parallel axes.

use crate::atom::{Angle, Atom, Class, Id, Name};
use crate::parameters::is_turning;
use crate::rational::Rational;
use crate::symbol::{Symbol, with_table};
use crate::table::Group;
use mozzi::quantities::Input;
use mozzi::{Freedom, Model};

fn state(name: Name, class: Class) -> Id {
    with_table(|table| table.id(Atom::State { name, class }))
}

/// Names by the joint's number: a joint of one axis has its number alone, other joints' numbers also their parts.
fn names<'m>(model: &'m Model, places: bool) -> impl Iterator<Item = (Option<usize>, String)> + 'm {
    let floating = model.is_floating();
    let joints = model.places().iter().zip(1..).map(move |(place, k)| (place.freedom, Some(k)));
    let all = floating.then_some((Freedom::Free, None)).into_iter().chain(joints);
    all.flat_map(move |(freedom, number)| {
        let parts: &[&str] = match (freedom, places) {
            (Freedom::One, _) => &[""],
            (_, true) => &["w", "x", "y", "z", "px", "py", "pz"][..freedom.positions()],
            (_, false) => &["ωx", "ωy", "ωz", "vx", "vy", "vz"][..freedom.velocities()],
        };
        parts.iter().map(move |part| (number, part.to_string()))
    })
}

/// θ in symbols.
pub(crate) fn positions(model: &Model) -> Vec<Symbol> {
    let names: Vec<Name> = names(model, true).map(|(number, part)| Name::new("θ", number, part)).collect();
    let mut ids: Vec<Id> = names.iter().map(|name| state(name.clone(), Class::Position)).collect();
    for place in model.configuration_space().places() {
        if place.freedom != Freedom::One {
            let imaginary = [ids[place.q + 1], ids[place.q + 2], ids[place.q + 3]];
            let name = names[place.q].clone();
            ids[place.q] = with_table(|table| table.id(Atom::Real { name, imaginary }));
        }
    }
    ids.into_iter().map(Symbol::atom).collect()
}

/// θ̇, θ̈, τ or a given vector in symbols.
pub(crate) fn input(model: &Model, input: &Input, length: usize) -> Vec<Symbol> {
    let (letter, dots, class) = match input.name {
        "theta" => return positions(model),
        "dtheta" => ("θ", 1, Class::Rate),
        "ddtheta" => ("θ", 2, Class::Linear),
        "tau" => ("τ", 0, Class::Linear),
        "w" => ("w", 0, Class::Linear),
        _ => ("x", 0, Class::Linear),
    };
    let named: Vec<(Option<usize>, String)> = match length == model.n() && input.name != "w" {
        true => names(model, false).collect(),
        false => (1..=length).map(|k| (Some(k), String::new())).collect(),
    };
    let symbol = |(number, part)| Symbol::atom(state(Name { dots, ..Name::new(letter, number, part) }, class));
    named.into_iter().map(symbol).collect()
}

/// The wrench (m, f) that the end effector applies.
pub(crate) fn wrench() -> Vec<Symbol> {
    (1..=6).map(|k| Symbol::atom(state(Name::new("F", k, ""), Class::Linear))).collect()
}

/// The groups of angles: joints whose axes are parallel in every configuration are in one.
pub(crate) fn groups(model: &Model, theta: &[Symbol]) -> Vec<Group> {
    let joints: Vec<_> = model.moving_joints().collect();
    let sources: Vec<_> = model.sources().collect();
    let is_angle: Vec<bool> = joints.iter().map(|joint| is_turning(joint.kind)).collect();
    // the turning joint nearest to the base on the way of each, if their axes are parallel, and their common direction
    let mut before: Vec<Option<(usize, i64)>> = vec![None; joints.len()];
    if let Ok(lists) = model.screws() {
        for i in (0..joints.len()).filter(|&i| is_angle[i]) {
            let mut at = lists.parents[i];
            while at > 0 && !is_angle[at - 1] {
                at = lists.parents[at - 1];
            }
            if at > 0 {
                let dot = lists.S[i].twist().w.dot(lists.S[at - 1].twist().w);
                if dot.abs() > 1.0 - 1e-12 {
                    before[i] = Some((at - 1, if dot > 0.0 { 1 } else { -1 }));
                }
            }
        }
    }
    // a mimic joint's angle is that of its source joint
    let n = model.joints().count();
    let mut group_of: Vec<usize> = (0..n).collect();
    for i in 0..joints.len() {
        if let Some((other, _)) = before[i] {
            let (a, b) = (group_of[sources[i].joint], group_of[sources[other].joint]);
            group_of.iter_mut().filter(|group| **group == a.max(b)).for_each(|group| *group = a.min(b));
        }
    }
    let over = |joint: usize| {
        let of_joint = sources.iter().filter(|source| source.joint == joint);
        let ratios = of_joint.filter_map(|source| Rational::decimal(&format!("{}", source.ratio)));
        ratios.fold(1, |lcm: i64, ratio| match ratio {
            Rational::Small(_, b) => num_integer::lcm(lcm, b),
            Rational::Big(_) => lcm,
        })
    };
    let mut groups = Vec::new();
    for first in 0..n {
        let members: Vec<usize> = (0..n).filter(|&j| group_of[j] == first).collect();
        let turning =
            |j: &usize| joints.iter().zip(&sources).zip(&is_angle).any(|((_, s), turns)| s.joint == *j && *turns);
        let members: Vec<usize> = members.into_iter().filter(turning).collect();
        if members.is_empty() {
            continue;
        }
        let id = |j: usize| {
            let polynomial = theta[model.places()[j].q].polynomial();
            polynomial.terms().first().and_then(|(m, _)| m.factors().next()).map_or(0, |(id, _)| id)
        };
        let is_plain = members.iter().all(|&j| over(j) == 1 && sources.iter().filter(|s| s.joint == j).count() == 1);
        let link = |j: usize| sources.iter().position(|source| source.joint == j);
        let previous = |&j: &usize| {
            let (other, sign) = before[link(j)?].filter(|_| is_plain)?;
            let place = members.iter().position(|&member| member == sources[other].joint)?;
            (place < members.iter().position(|&member| member == j)?).then_some((place, sign))
        };
        let angles = members.iter().map(|&j| Angle::Joint { position: id(j), over: over(j) }).collect();
        groups.push(Group::new(angles, members.iter().map(previous).collect()));
    }
    groups
}
