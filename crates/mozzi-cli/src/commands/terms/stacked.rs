//! The stacked matrices of the closed form as text, block by block.

use crate::table::short;
use crate::text::{beside, matrix, table};
use mozzi::{ClosedForm, Model};
use nalgebra::{DMatrix, DVector};

pub fn lines(model: &Model, form: &ClosedForm, ddtheta: &[f64]) -> Vec<String> {
    let (N, n, base) = (form.G.nrows() / 6, model.n(), usize::from(model.is_floating()));
    let ddtheta = DVector::from_column_slice(ddtheta);
    // balls and free joints have one position more than velocities
    let (links, joints) = match model.nq() > n + base {
        true => ("moving links, of which a ball has three and a free joint six, one for each axis", "velocities"),
        false => ("moving links", if base == 1 { "velocities" } else { "joints" }),
    };
    let first = if base == 1 { ", link 1 being the floating base" } else { "" };
    let mut lines = vec![
        format!(
            "N = {N} {links}, n = {n} {joints}{first}; blocks of six rows, base to tips; blocks that are not shown are 0"
        ),
        "𝒱 = 𝒲𝒱 + 𝒜θ̇ + 𝒱_base,  𝓕 = 𝒲ᵀ𝓕 + 𝒢𝒱̇ − [ad_𝒱]ᵀ𝒢𝒱 + 𝓕_tip,  M = 𝒜ᵀℒᵀ𝒢ℒ𝒜,  τ = 𝒜ᵀ𝓕".to_string(),
    ];
    lines.extend(blocks("𝒜: the screw axes A_i in their links' frames", "𝒜", &form.A, 1));
    lines.extend(blocks("𝒢: the spatial inertias", "𝒢", &form.G, 6));
    lines.extend(blocks("𝒲(θ): from each link's parent to the link, [Ad_T]", "𝒲", &form.W, 6));
    lines.extend(blocks("ℒ(θ) = (I − 𝒲)⁻¹ = I + 𝒲 + 𝒲² + …", "ℒ", &form.L, 6));
    lines.extend(blocks("[ad_𝒱]", "[ad_𝒱]", &form.ad_V, 6));
    lines.extend(blocks("[ad_𝒜θ̇]", "[ad_𝒜θ̇]", &form.ad_Adtheta, 6));
    lines.push("the stacked vectors".to_string());
    let vectors = [
        ("𝒱", "ℒ(𝒜θ̇ + 𝒱_base)", form.V.clone()),
        ("𝒱̇", "with gravity", form.accelerations(&ddtheta)),
        ("𝓕", "through the joints", form.wrenches(&ddtheta)),
        ("𝒱_base", "", form.V_base.clone()),
        ("𝒱̇_base", "−gravity, seen from the first links", form.dV_base.clone()),
        ("𝓕_tip", "on the environment", form.F_tip.clone()),
    ];
    let mut rows = Vec::new();
    for (symbol, what, vector) in &vectors {
        for i in 0..N {
            let entries: Vec<f64> = vector.rows(6 * i, 6).iter().copied().collect();
            let head = if i == 0 { [symbol.to_string(), what.to_string()] } else { [String::new(), String::new()] };
            rows.push([head.to_vec(), vec![format!("link {}", i + 1), short(&entries)]].concat());
        }
    }
    lines.extend(table(&rows, "l").into_iter().map(|line| format!("  {line}")));
    lines
}

/// The blocks that are not 0.
fn blocks(title: &str, symbol: &str, stacked: &DMatrix<f64>, columns: usize) -> Vec<String> {
    let (R, C) = (stacked.nrows() / 6, stacked.ncols() / columns);
    let mut list = Vec::new();
    for i in 0..R {
        for j in 0..C {
            let block = stacked.view((6 * i, columns * j), (6, columns)).into_owned();
            if block.iter().any(|&x| x != 0.0) {
                list.push((format!("{symbol}({}, {})", i + 1, j + 1), matrix(&block)));
            }
        }
    }
    let size = format!("{title}, {} × {}", stacked.nrows(), stacked.ncols());
    let none = if list.is_empty() { vec!["  all 0".to_string()] } else { Vec::new() };
    [vec![size], none, beside(&list).into_iter().map(|line| format!("  {line}")).collect()].concat()
}
