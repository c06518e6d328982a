//! The vertices of a mesh that are farthest in some direction.

use super::surface::Surface;
use mozzi::nalgebra::Matrix3;
use mozzi::{Scalar, Vec3};
use std::collections::BTreeSet;

/// Directions in which the farthest vertex is looked for.
const DIRECTIONS: usize = 2000;

/// The vertices of a mesh, "stl" or "obj", that are the farthest in one of 2,000 directions: vertices of its convex
/// hull.
///
/// # Errors
/// Another format, or content that is no mesh.
pub fn mesh_corners(format: &str, file: &[u8]) -> Result<Vec<Vec3>, String> {
    let mut vertices = match format {
        "stl" | "obj" => Surface::vertices(format, file)?,
        other => return Err(format!("the vertices of `{other}` meshes are not read; expected stl or obj")),
    };
    // each once: a corner of a surface belongs to some six triangles
    let order = |a: &Vec3, b: &Vec3| {
        (0..3).map(|k| a.0[k].total_cmp(&b.0[k])).fold(std::cmp::Ordering::Equal, |x, y| x.then(y))
    };
    vertices.sort_unstable_by(order);
    vertices.dedup();
    Ok(farthest(&vertices))
}

/// The farthest of v in direction d is that of w = L⁻¹(v − v̄) in direction Lᵀd, for any L. With LLᵀ the vertices'
/// covariance, the w are about as far from 0 in all directions, so that few, from the farthest on, need to be looked
/// at: w·e ≤ ‖w‖‖e‖.
fn farthest(vertices: &[Vec3]) -> Vec<Vec3> {
    let count = vertices.len() as f64;
    let mean = vertices.iter().fold(Vec3::zero(), |sum, &v| sum + v) * (1.0 / count);
    let spread = vertices.iter().fold(Matrix3::zeros(), |sum: Matrix3<f64>, &v| {
        let d = (v - mean).0;
        sum + Matrix3::from_fn(|r, c| d[r] * d[c])
    });
    let least = 1e-12 * spread.trace() + f64::MIN_POSITIVE; // a flat mesh has no spread along its normal
    let L = (spread + Matrix3::identity() * least).cholesky().map_or(Matrix3::identity(), |found| found.l());
    let inverse = L.try_inverse().unwrap_or(Matrix3::identity());
    let mut all: Vec<(f64, Vec3, usize)> = Vec::with_capacity(vertices.len());
    for (k, &v) in vertices.iter().enumerate() {
        let d = (v - mean).0;
        let w = Vec3([0, 1, 2].map(|r| (0..3).map(|c| inverse[(r, c)] * d[c]).sum()));
        all.push((w.norm(), w, k));
    }
    all.sort_by(|a, b| b.0.total_cmp(&a.0));
    let mut found = BTreeSet::new();
    // Fibonacci's sphere
    let turn = std::f64::consts::PI * (3.0 - Scalar::sqrt(5.0_f64));
    for k in 0..DIRECTIONS {
        let z = 1.0 - (2 * k + 1) as f64 / DIRECTIONS as f64;
        let (sine, cosine) = (turn * k as f64).sin_cos();
        let r = Scalar::sqrt(1.0 - z * z);
        let direction = [r * cosine, r * sine, z];
        let e = Vec3([0, 1, 2].map(|c| (0..3).map(|r| L[(r, c)] * direction[r]).sum()));
        let (length, mut most, mut far) = (e.norm(), f64::NEG_INFINITY, None);
        for &(size, w, k) in &all {
            if size * length < most {
                break;
            }
            let along = w.dot(e);
            if along > most {
                (most, far) = (along, Some(k));
            }
        }
        found.extend(far);
    }
    found.into_iter().map(|k| vertices[k]).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_cube_has_eight_mesh_corners() {
        let mut text = String::new();
        for k in 0..27 {
            let [x, y, z] = [k % 3, k / 3 % 3, k / 9].map(|i| f64::from(i) - 1.0);
            text += &format!("v {x} {y} {z}\n");
        }
        text += "f 1 2 3\n";
        let found = mesh_corners("obj", text.as_bytes()).expect("a mesh");
        assert_eq!(found.len(), 8);
        assert!(found.iter().all(|v| v.0.iter().all(|x| x.abs() == 1.0)));
        let mut stl = vec![0; 80];
        stl.extend(1_u32.to_le_bytes());
        for x in [0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 2.0, 0.0_f32] {
            stl.extend(x.to_le_bytes());
        }
        stl.extend([0, 0]);
        assert_eq!(mesh_corners("stl", &stl).expect("a mesh").len(), 3);
        assert!(mesh_corners("dae", b"<COLLADA/>").is_err());
    }
}
