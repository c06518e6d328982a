//! Differences between the shapes of links, which enter no force.

use super::RobotFile;
use super::number::{shown, ten};
use mozzi_urdf::geometry::{Form, Shape};
use std::collections::BTreeSet;
use std::path::Path;

/// Links beyond this number are counted.
const SHOWN: usize = 10;

/// A sentence for each link of both whose shapes differ; `is_shared` has the links of both.
pub fn notes([a, b]: [&RobotFile; 2], is_shared: &dyn Fn(&str) -> bool) -> Vec<String> {
    let (Some(shapes_a), Some(shapes_b)) = (&a.shapes, &b.shapes) else { return Vec::new() };
    let links = |list: &[Shape]| list.iter().map(|shape| shape.link.clone()).collect::<BTreeSet<_>>();
    let (links_a, links_b) = (links(shapes_a), links(shapes_b));
    for (none, some, of, links) in [(a, b, shapes_b, &links_b), (b, a, shapes_a, &links_a)] {
        if none.shapes.as_ref().is_some_and(Vec::is_empty) && !of.is_empty() {
            let (count, of) = (of.len(), links.len());
            let noun = |n: usize, one: &str| format!("{n} {one}{}", if n == 1 { "" } else { "s" });
            let (shapes, links) = (noun(count, "shape"), noun(of, "link"));
            return vec![format!("{} has no shapes, {} has {shapes} of {links}", none.name, some.name)];
        }
    }
    let shared = links_a.union(&links_b).filter(|link| is_shared(link));
    let mut notes: Vec<String> = shared.filter_map(|link| of_link(link, [a, b])).collect();
    let more = notes.len().saturating_sub(SHOWN);
    if more > 0 {
        notes.truncate(SHOWN);
        notes.push(format!("shapes of {more} more links differ"));
    }
    notes
}

fn of_link(link: &str, [a, b]: [&RobotFile; 2]) -> Option<String> {
    let own = |file: &RobotFile| -> Vec<Shape> {
        let mut list: Vec<Shape> = Vec::new();
        for shape in file.shapes.iter().flatten().filter(|shape| shape.link == link) {
            // the same solid for pictures and contacts counts once
            if !list.iter().any(|known| are_same(known, shape)) {
                list.push(shape.clone());
            }
        }
        list
    };
    let (mut lone, mut there) = (own(a), own(b));
    lone.retain(|x| {
        let found = there.iter().position(|y| are_same(x, y));
        found.map(|k| there.remove(k)).is_none()
    });
    let other = &b.name;
    let what = match (lone.as_slice(), there.as_slice()) {
        ([], []) => return None,
        ([x], [y]) if same_form(&x.form, &y.form) => {
            format!("the {} is elsewhere in {other}", x.form.name())
        }
        ([x], [y]) => format!("{} in {other} instead of {}{}", words(y), words(x), factor(x, y)),
        ([x], []) => format!("{} is dropped in {other}", words(x)),
        ([], [y]) => format!("{} appears in {other}", words(y)),
        (list, others) => format!("{} of {} alone, {} of {other} alone", list.len(), a.name, others.len()),
    };
    Some(format!("shapes of `{link}` differ: {what}"))
}

fn are_same(x: &Shape, y: &Shape) -> bool {
    let turn = (x.T.R.inverse() * y.T.R).log().norm();
    let is_there = (x.T.p - y.T.p).norm() <= 1e-6 * (1.0 + x.T.p.norm()) && turn <= 1e-6;
    // a ball has no axes
    let is_center = matches!(x.form, Form::Sphere { .. }) && (x.T.p - y.T.p).norm() <= 1e-6 * (1.0 + x.T.p.norm());
    (is_there || is_center) && same_form(&x.form, &y.form)
}

fn same_form(x: &Form, y: &Form) -> bool {
    let is_near = |(x, y): (&f64, &f64)| (x - y).abs() <= 1e-6 * x.abs().max(y.abs());
    x.name() == y.name() && mesh(x) == mesh(y) && x.size().iter().zip(&y.size()).all(is_near)
}

/// The name of a mesh's file without folder and ending: converters copy meshes, and change their format.
fn mesh(form: &Form) -> Option<String> {
    let Form::Mesh { file, .. } = form else { return None };
    Path::new(file).file_stem().map(|stem| stem.to_string_lossy().into_owned())
}

fn words(shape: &Shape) -> String {
    let size = shape.form.size().into_iter().map(shown).collect::<Vec<_>>().join(" ");
    match mesh(&shape.form) {
        Some(name) => format!("mesh `{name}` of scale {size}"),
        None => format!("{} {size}", shape.form.name()),
    }
}

/// ", by 1e3 (mm)", if all lengths have another unit.
fn factor(x: &Shape, y: &Shape) -> String {
    let (p, q) = (x.form.size(), y.form.size());
    let powers: BTreeSet<Option<i32>> = p.iter().zip(&q).map(|(p, q)| ten(q / p)).collect();
    match powers.first().copied().flatten().filter(|_| powers.len() == 1 && x.form.name() == y.form.name()) {
        Some(3) => ", by 1e3 (mm)".to_string(),
        Some(power) => format!(", by 1e{power}"),
        None => String::new(),
    }
}
