//! The robots, quantities and forms of docs/gpu.md and benches/GPU.md, and the arguments that both commands have:
//! `--robots FOLDER` of example-robot-data, `--only NAME` of a robot, `--quantity NAME`, `--page FILE` (else standard
//! output).

use mozzi::quantities::{
    ForwardDynamics, InverseDynamics, InverseDynamicsDerivatives, InverseDynamicsVjp, MassMatrix, Query,
};
use mozzi::{Base, Model};
use mozzi_engine::{CudaLayout, Precision};
use mozzi_gpu::Form;
use std::error::Error;
use std::path::Path;
use std::process::ExitCode;

/// A robot with a name.
pub struct Robot {
    pub name: String,
    pub model: Model,
}

const FORMS: [(Precision, CudaLayout); 4] = [
    (Precision::F32, CudaLayout::Columns),
    (Precision::F32, CudaLayout::Rows),
    (Precision::F64, CudaLayout::Columns),
    (Precision::F64, CudaLayout::Rows),
];

/// The program's arguments.
pub struct Arguments(Vec<String>);

impl Arguments {
    /// What follows the option of this name.
    pub fn option(&self, name: &str) -> Option<&str> {
        let place = self.0.iter().position(|argument| argument == name)?;
        self.0.get(place + 1).map(String::as_str)
    }

    /// All robots that are at hand.
    pub fn robots(&self) -> Result<Vec<Robot>, Box<dyn Error>> {
        robots(self.option("--robots").map(Path::new))
    }

    /// Each robot, quantity and form that the arguments choose.
    pub fn kernels<'r>(&self, robots: &'r [Robot]) -> Vec<(&'r Robot, Query<'static>, Form)> {
        let (only, quantity) = (self.option("--only"), self.option("--quantity"));
        let asked = robots.iter().filter(|robot| only.is_none_or(|name| name == robot.name));
        let forms = asked.flat_map(|robot| FORMS.map(|form| (robot, form)));
        let all = forms.flat_map(|(robot, (precision, layout))| {
            quantities(quantity).map(move |(query, is_packed)| (robot, query, Form { precision, layout, is_packed }))
        });
        all.collect()
    }

    /// Writes the page.
    pub fn write(&self, page: &str) -> Result<(), Box<dyn Error>> {
        match self.option("--page") {
            Some(path) => std::fs::write(path, page)?,
            None => println!("{page}"),
        }
        Ok(())
    }
}

/// Runs a command; its error is said in words.
pub fn run(command: impl FnOnce(&Arguments) -> Result<(), Box<dyn Error>>) -> ExitCode {
    match command(&Arguments(std::env::args().skip(1).collect())) {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("error: {error}");
            ExitCode::FAILURE
        }
    }
}

/// A form in a table, such as `f32 rows`.
pub fn name(form: Form) -> String {
    let precision = if form.precision == Precision::F64 { "f64" } else { "f32" };
    let layout = if form.layout == CudaLayout::Rows { "rows" } else { "SoA" };
    format!("{precision} {layout}")
}

/// A quantity in a table.
pub fn title(quantity: &str, form: Form) -> String {
    quantity.replace('_', " ") + if form.is_packed { ", packed" } else { "" }
}

/// Quantities, and whether their matrix is packed: all, or those of one name.
fn quantities(name: Option<&str>) -> impl Iterator<Item = (Query<'static>, bool)> {
    let all: [(Query, bool); 6] = [
        (InverseDynamics.into(), false),
        (ForwardDynamics.into(), false),
        (MassMatrix.into(), false),
        (MassMatrix.into(), true),
        (InverseDynamicsDerivatives.into(), false),
        (InverseDynamicsVjp.into(), false),
    ];
    all.into_iter().filter(move |(query, _)| name.is_none_or(|name| name == query.name()))
}

/// UR5; Panda with locked fingers, 7 joints; ANYmal, floating; and Talos, floating, if there is the folder of
/// example-robot-data.
fn robots(folder: Option<&Path>) -> Result<Vec<Robot>, Box<dyn Error>> {
    let embedded = |name: &str| -> Result<Model, Box<dyn Error>> { Ok(mozzi_urdf::open(name)?.build()?) };
    let robot = |name: &str, model: Model| Robot { name: name.to_string(), model };
    let mut robots = vec![
        robot("UR5", embedded("ur5")?),
        robot("Panda, 7 joints", embedded("panda")?.with_locked_joints(&[("panda_finger_joint1", 0.0)])?),
        robot("ANYmal", embedded("anymal")?.with_base(Base::Floating)?),
    ];
    if let Some(folder) = folder {
        let talos = mozzi_urdf::load(folder.join("talos_data/robots/talos_reduced.urdf"))?.build()?;
        robots.push(robot("Talos", talos.with_base(Base::Floating)?));
    }
    Ok(robots)
}
