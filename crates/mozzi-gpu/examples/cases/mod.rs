//! The robots, quantities and forms of docs/gpu.md and benches/GPU.md.

use mozzi::quantities::{
    ForwardDynamics, InverseDynamics, InverseDynamicsDerivatives, InverseDynamicsVjp, MassMatrix, Query,
};
use mozzi::{Base, Model};
use mozzi_codegen::{CudaLayout, Precision};
use std::error::Error;
use std::path::Path;

/// A robot with a name.
pub struct Robot {
    pub name: String,
    pub model: Model,
}

pub const FORMS: [(Precision, CudaLayout); 4] = [
    (Precision::F32, CudaLayout::Columns),
    (Precision::F32, CudaLayout::Rows),
    (Precision::F64, CudaLayout::Columns),
    (Precision::F64, CudaLayout::Rows),
];

/// Quantities, and whether their matrix is packed: all, or those of one name.
pub fn quantities(name: Option<&str>) -> impl Iterator<Item = (Query<'static>, bool)> {
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
pub fn robots(folder: Option<&Path>) -> Result<Vec<Robot>, Box<dyn Error>> {
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
