//! Columns of mimic joints, which have no entry: positions must follow the source joint's, forces are added to it.

use super::{Column, Family, MEANINGS, Search, THETA};
use crate::recogniser::reading::{Entry, Kind};
use crate::recogniser::word;
use crate::recogniser::{GROUPS, Role, columns};
use std::f64::consts::TAU;

/// A position or force of a mimic joint.
#[derive(Clone, Debug)]
pub struct Follower {
    pub joint: String,
    pub source: String,
    /// That of positions or of forces.
    pub group: usize,
    /// The source's entry in its group.
    pub entry: usize,
    pub column: Column,
    pub ratio: f64,
    pub offset: f64,
    /// Whether positions are angles, which logs may wrap.
    pub turns: bool,
}

impl Follower {
    /// How far the positions are from ratio · θ + offset, where both are numbers; θ has `width` entries a row.
    pub fn differing(&self, theta: &[f64], width: usize, number: impl Fn(usize) -> f64) -> Option<[f64; 2]> {
        let (mut errors, mut expected) = (Vec::new(), Vec::new());
        for (row, theta) in theta.chunks_exact(width).enumerate() {
            let law = self.ratio * theta[self.entry] + self.offset;
            let error = number(row) * self.column.1 - law;
            if error.is_finite() {
                errors.push(if self.turns { error - TAU * (error / TAU).round() } else { error }.abs());
                expected.push(law);
            }
        }
        let N = expected.len() as f64;
        let mean = expected.iter().sum::<f64>() / N;
        let motion = (expected.iter().map(|x| (x - mean).powi(2)).sum::<f64>() / N).sqrt();
        errors.sort_unstable_by(f64::total_cmp);
        Some([*errors.get(errors.len() / 2)?, motion])
    }

    /// Adds ratio times the forces to those of the source, if there are any; returns in how many rows only the source
    /// has a number.
    pub fn add(&self, tau: &mut [f64], width: usize, number: impl Fn(usize) -> f64) -> usize {
        let rows = || tau.chunks_exact(width).enumerate().filter(|(_, tau)| tau[self.entry].is_finite());
        let missing = rows().filter(|(row, _)| !number(*row).is_finite()).count();
        if missing == 0 {
            for (row, tau) in tau.chunks_exact_mut(width).enumerate() {
                tau[self.entry] += self.ratio * number(row) * self.column.1;
            }
            return 0;
        }
        if missing == rows().count() { 0 } else { missing }
    }
}

impl Search<'_> {
    /// The names of mimic joints.
    pub(super) fn mimic_joints(&self) -> impl Iterator<Item = &str> {
        self.model.moving_joints().filter(|joint| joint.mimic.is_some()).map(|joint| joint.name.as_str())
    }

    /// Takes the columns of mimic joints.
    pub(super) fn take_followers(&self, readings: &mut Family, roles: &mut [Role]) -> Vec<(Kind, Follower)> {
        let mut found = Vec::new();
        readings.retain(|(column, reading)| {
            let Entry::Name(name) = &reading.entry else { return true };
            let mut all = self.model.moving_joints().zip(self.model.sources());
            let Some((_, source)) = all.find(|(joint, _)| joint.name == *name && joint.mimic.is_some()) else {
                return true;
            };
            roles[*column] = Role::Unused("its joint follows another");
            let place = &self.model.places()[source.joint];
            let entry = if reading.quantity == THETA { place.q } else { place.j };
            if [THETA, word::TAU].contains(&reading.quantity) {
                let follower = Follower {
                    joint: name.clone(),
                    source: columns::entries(self.model, GROUPS[reading.quantity])[entry].to_string(),
                    group: reading.quantity,
                    entry,
                    column: (*column, reading.unit.map_or(1.0, |unit| unit.factor)),
                    ratio: source.ratio,
                    offset: source.offset,
                    turns: self.model.joints().nth(source.joint).is_some_and(|joint| joint.kind.name() == "revolute"),
                };
                found.push((reading.kind, follower));
            }
            false
        });
        found
    }

    /// Those that belong to the columns that were chosen, by group.
    pub(super) fn keep_followers(
        &mut self,
        followers: Vec<(Kind, Follower)>,
        chosen: &[Option<Kind>],
        roles: &mut [Role],
    ) -> Vec<Follower> {
        let is_kept = |(kind, follower): &(Kind, Follower)| chosen[follower.group] == Some(*kind);
        let mut kept: Vec<Follower> = followers.into_iter().filter(is_kept).map(|(_, follower)| follower).collect();
        for Follower { joint, source, group, column: (column, _), ratio, .. } in &kept {
            if *group == THETA {
                roles[*column] = Role::Unused("its joint follows another: compared with it");
                continue;
            }
            if chosen[word::TAU].is_some_and(|kind| kind.is_current) {
                roles[*column] = Role::Unused("its joint follows another: currents of two motors have no sum");
                continue;
            }
            roles[*column] = Role::Unused("its joint follows another: added to that joint's");
            self.notes.push(format!(
                "{}: column {} (`{}`): the {} of `{joint}`, which follows `{source}`, is added to that of `{source}`, \
                 times {ratio}",
                self.place,
                column + 1,
                self.name(*column),
                MEANINGS[word::TAU]
            ));
        }
        kept.retain(|follower| follower.group == THETA || chosen[word::TAU].is_some_and(|kind| !kind.is_current));
        kept
    }
}
