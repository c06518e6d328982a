//! Numbers that suggest another unit: grams, millimetres, degrees. All are warnings; the numbers are used as given.
//!
//! The thresholds are so wide that no sound robot exceeds them. Among the 1985 links and 2075 joints of the robots in
//! `example-robot-data`, the heaviest link has 116 kg, the largest radius of gyration is 4 m (a placeholder), the
//! longest distance from a joint to the next is 0.9 m, and the widest meaningful limits of a revolute joint are ±10
//! rad. Only [`massless`](Report::massless) gives a warning there, correctly, for the two feet of one robot.

use super::{Element, Report, Severity, numbers::is_finite};
use crate::model::description::JointKind;
use crate::scalar::Scalar;
use crate::spatial::Rounded;
use alloc::format;
use alloc::string::String;

/// No matter is denser than osmium: kg/m³.
const DENSEST: f64 = 22_600.0;
/// Lighter links are not judged by density: their moments are often rounded to zero. kg.
const LIGHT: f64 = 5.0;
/// A heavier point mass is not a payload: kg.
const HEAVY: f64 = 1000.0;
/// Distance from one joint to the next, or to a centre of mass: m.
const FAR: f64 = 50.0;
/// Radius of gyration: m, and relative to the longest distance between joints.
const WIDE: f64 = 10.0;
/// Limits in radians end here, at two turns either way; limits beyond 720 are not degrees but mean unlimited.
const DEGREES: core::ops::RangeInclusive<f64> = 4.0 * core::f64::consts::PI..=720.0;

impl Report<'_> {
    /// Grams, millimetres, degrees.
    pub(super) fn units(&mut self) {
        let longest = self.lengths();
        for i in 0..self.description.links.len() {
            if is_finite(&self.description.links[i].inertia) {
                self.massless(i);
                self.gyration(i, longest);
            }
        }
        self.degrees();
    }

    /// The longest distance from a joint to the next; of a robot whose joints coincide, to a centre of mass. One
    /// warning at most: for the longest of all, with the number of the others.
    fn lengths(&mut self) -> f64 {
        let d = self.description;
        let (mut far, mut longest, mut between) = (0, (0.0, Element::Robot, ""), 0.0_f64);
        let joints = d.joints.iter().enumerate().map(|(i, joint)| (joint.origin.p.norm(), Element::Joint(i), "origin"));
        let links = d.links.iter().enumerate().filter(|(_, link)| is_finite(&link.inertia));
        let links = links.map(|(i, link)| (link.inertia.center_of_mass().norm(), Element::Link(i), "inertia"));
        for way in joints.chain(links).filter(|way| way.0.is_finite()) {
            far += usize::from(way.0 > FAR);
            if way.2 == "origin" {
                between = between.max(way.0);
            }
            if way.0 > longest.0 {
                longest = way;
            }
        }
        let (length, element, attribute) = longest;
        if far > 0 {
            let what = if attribute == "origin" { "is" } else { "the centre of mass is" };
            let others = if far > 1 { format!(" ({} more are, too)", far - 1) } else { String::new() };
            let message = format!(
                "{what} {} m from the frame that it is given in, farther than {FAR} m{others}: in millimetres?",
                Rounded(length)
            );
            self.add(Severity::Warning, element, attribute, "implausible_length", message);
        }
        if between > 0.0 { between } else { length }
    }

    /// Moments without mass, which is not physical.
    fn massless(&mut self, i: usize) {
        let G = &self.description.links[i].inertia;
        if G.mass == 0.0 && G.I.trace() > 0.0 {
            let moment = Rounded(G.I.trace() / 2.0);
            let message = format!("is 0 kg, but the moments of inertia are not: half their sum is {moment} kg m²");
            self.add(Severity::Warning, Element::Link(i), "mass", "implausible_mass", message);
        }
    }

    /// Compares the radius of gyration √(tr I / 2m) with the densest body of this mass, and with the robot.
    fn gyration(&mut self, i: usize, longest: f64) {
        let G = &self.description.links[i].inertia;
        let trace = G.about_center_of_mass().trace();
        if !(G.mass > 0.0 && trace >= 0.0) {
            return;
        }
        let radius = Scalar::sqrt(trace / (2.0 * G.mass));
        // of all bodies of a mass and a radius of gyration r, the ball of radius √(5/3) r is the least dense
        let ball = 9.01 * radius * radius * radius;
        let kg = G.mass;
        // moments that are rounding errors of the shift to the centre of mass count as zero
        let is_point = trace <= 1e-9 * G.I.trace() || trace == 0.0;
        let is_too_dense = if is_point { kg > HEAVY } else { kg > LIGHT && kg > DENSEST * ball };
        if is_too_dense {
            let (kg, mm) = (Rounded(kg), Rounded(1000.0 * radius));
            let message = format!(
                "is {kg} kg within a radius of gyration of {mm} mm, denser than any matter: mass in grams, or moments too small?"
            );
            self.add(Severity::Warning, Element::Link(i), "mass", "implausible_mass", message);
        } else if radius > WIDE && radius > WIDE * longest {
            let (kg, m) = (Rounded(kg), Rounded(radius));
            let message = format!(
                "at {kg} kg has a radius of gyration of {m} m, expected at most {WIDE} m: moments in kg mm², or the mass too small?"
            );
            self.add(Severity::Warning, Element::Link(i), "inertia", "implausible_inertia", message);
        }
    }

    /// Whole numbers beyond two turns, as bounds of a joint that turns.
    fn degrees(&mut self) {
        let d = self.description;
        for (i, joint) in d.joints.iter().enumerate() {
            let (JointKind::Screw(A), Some([low, high])) = (joint.kind, joint.limits.position) else { continue };
            let is_degrees = |x: f64| DEGREES.contains(&x.abs()) && x % 1.0 == 0.0;
            let is_whole = low % 1.0 == 0.0 && high % 1.0 == 0.0;
            if !A.is_prismatic() && is_whole && low <= high && (is_degrees(low) || is_degrees(high)) {
                let turns = Rounded(tenths((high - low) / core::f64::consts::TAU));
                let message = format!("go from {low} to {high} radians, which is {turns} turns: in degrees?");
                self.add(Severity::Warning, Element::Joint(i), "limits", "degrees", message);
            }
        }
    }
}

/// Rounds a nonnegative number to tenths.
fn tenths(x: f64) -> f64 {
    (x * 10.0 + 0.5) as i64 as f64 / 10.0
}
