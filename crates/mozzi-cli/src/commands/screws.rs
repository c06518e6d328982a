//! `mozzi screws`: the robot as the book's lists.

use super::info;
use super::python::literals;
use crate::failure::{Failure, Result};
use crate::json;
use crate::numbers::TWIST;
use crate::robot::{RobotArguments, screen};
use crate::text::{Page, Sections, beside, column, constants, rows_of, table, twists};
use clap::Args;
use mozzi::model::ScrewLists;
use mozzi::{Model, SE3, ScrewAxis};

#[derive(Args, Debug)]
pub struct ScrewsArguments {
    #[command(flatten)]
    robot: RobotArguments,
    /// Print Python literals for NumPy and the Modern Robotics package: Mlist, Glist, Slist, Blist, M
    #[arg(long, conflicts_with = "json")]
    python: bool,
    /// Print all lists, however long
    #[arg(long)]
    all: bool,
}

pub fn run(arguments: &ScrewsArguments) -> Result<String> {
    let model = arguments.robot.load()?;
    let lists = model.screws()?;
    if arguments.robot.json {
        let mut object = json::screws(&lists);
        object["base"] = json::base(&model).into();
        if model.is_floating() {
            object["G_base"] = json::rows(model.base_inertia().to_matrix());
        }
        return Ok(json::print(&object));
    }
    if !arguments.python {
        return Ok(page(&model, &lists, if arguments.all { usize::MAX } else { screen(&model) }));
    }
    python(&model)
}

/// The robot as Python's literals.
pub fn python(model: &Model) -> Result<String> {
    let lists = model.screws()?;
    let serial = lists.parents.iter().enumerate().all(|(i, &parent)| parent == i);
    if !serial || model.has_mimic_joints() {
        return Err(Failure::wrong(format!(
            "Python: `{}` has {}, and the Modern Robotics package knows serial chains of independent joints only; \
             JSON has the lists of any robot",
            model.description().name,
            if serial { "joints that follow others" } else { "branches" }
        )));
    }
    model.end_effector()?; // or an error that names the candidates
    let tip = lists.end_effector.as_ref().map_or(SE3::identity(), |&(_, T)| T);
    Ok(literals(model, &lists, tip))
}

/// Each moving link's screw in a table: number, joint, six entries.
pub fn axes(lists: &ScrewLists, axes: &[ScrewAxis]) -> Vec<String> {
    let twists = twists(&axes.iter().map(|A| A.twist()).collect::<Vec<_>>());
    let mut cells =
        vec![[["i", "joint"].as_slice(), &TWIST].concat().into_iter().map(String::from).collect::<Vec<_>>()];
    for ((i, joint), twist) in (1..).zip(&lists.joints).zip(twists) {
        cells.push([vec![i.to_string(), joint.clone()], twist].concat());
    }
    table(&cells, "rlr")
}

/// Mass, the origin of the home frame, and the rotational inertia's diagonal in a table.
pub fn masses(lists: &ScrewLists) -> Vec<String> {
    let of = |name: &str, pick: &dyn Fn(usize) -> f64| {
        [vec![name.to_string()], column(&(0..lists.links.len()).map(pick).collect::<Vec<_>>())].concat()
    };
    let numbers: Vec<String> =
        std::iter::once("i".to_string()).chain((1..=lists.links.len()).map(|i| i.to_string())).collect();
    let columns = vec![
        numbers,
        [vec!["link".to_string()], lists.links.clone()].concat(),
        of("m", &|i| lists.G[i].mass),
        of("p_x", &|i| lists.M[i].p.0[0]),
        of("p_y", &|i| lists.M[i].p.0[1]),
        of("p_z", &|i| lists.M[i].p.0[2]),
        of("I_xx", &|i| lists.G[i].I.xx),
        of("I_yy", &|i| lists.G[i].I.yy),
        of("I_zz", &|i| lists.G[i].I.zz),
    ];
    table(&rows_of(columns), "rlr")
}

fn page(model: &Model, lists: &ScrewLists, most: usize) -> String {
    let mut page = Page::default();
    page.line(info::headline(model)).line(info::surroundings(model));
    page.line("Frame {i} is at the centre of mass of moving link i, with the axes of the link's frame.");
    page.line("A screw axis is (ω, v): ω the turn's axis, v the velocity at the origin for 1 rad/s.");
    if model.is_floating() {
        page.line("The base, link 0, is free: its axes are the identity in its own frame, and G_0 is its inertia there. \"Base frame\" is that frame.");
    }
    if lists.parents.iter().enumerate().any(|(i, &parent)| parent != i) {
        page.line("The robot branches: the parent of each link is");
        let parents =
            lists.parents.iter().enumerate().map(|(i, parent)| format!("{}←{parent}", i + 1)).collect::<Vec<_>>();
        page.lines(&[parents.join("  ")]);
    }
    let mut sections = Sections::default();
    let poses = |symbol: &dyn Fn(usize) -> String, list: &[SE3]| {
        let blocks: Vec<_> = list.iter().enumerate().map(|(i, T)| (symbol(i), constants(T.to_matrix()))).collect();
        beside(&blocks)
    };
    sections.add("S_i", "S_i: screw axes in the base frame, at θ = 0", axes(lists, &lists.S));
    if let Some((name, T)) = &lists.end_effector {
        let title = format!("M: the end effector {name} at θ = 0, [R p], m");
        sections.add("M", title, constants(T.to_matrix()));
    }
    sections.add("G_i", "G_i: mass [kg], origin of {i} [m], inertia about it [kg m²]", masses(lists));
    match &lists.end_effector {
        Some((name, _)) => {
            sections.add("B_i", format!("B_i: the same in the end-effector frame {name}"), axes(lists, &lists.B));
        }
        None => sections.add("B_i", "B_i", vec!["left out: name the frame by --end-effector".to_string()]),
    }
    sections.add("A_i", "A_i = [Ad_M_i⁻¹] S_i: the same in their own links' frames", axes(lists, &lists.A));
    let home = poses(&|i| format!("M_{}", i + 1), &lists.M);
    sections.add("M_i", "M_i: home frames {i} seen from the base, [R p], m", home);
    let relative = |i: usize| format!("M_{},{}", lists.parents[i], i + 1);
    let relative = poses(&relative, &lists.M_relative);
    sections.add("M_i-1,i", "M_i-1,i: home frames seen from the one before, m", relative);
    let base = model.is_floating().then(|| ("G_0, the base".to_string(), constants(model.base_inertia().to_matrix())));
    let links =
        lists.G.iter().enumerate().map(|(i, G)| (format!("G_{}, {}", i + 1, lists.links[i]), constants(G.to_matrix())));
    let inertias: Vec<_> = base.into_iter().chain(links).collect();
    sections.add("G_i as matrices", "G_i: spatial inertias in frames {i}, kg m² and kg", beside(&inertias));
    sections.write(&mut page, most);
    page.end()
}
