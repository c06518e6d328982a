//! The principal moments of a mesh in MuJoCo 4. It turns the mesh to its principal axes by Jacobi's rotations as
//! quaternions, stops early, and drops the products of inertia that are left. A model means the robot that MuJoCo makes
//! of it, so the same is dropped here.

use mozzi::linalg::Sym3;

/// Smaller products of inertia, relative to the largest moment, are dropped.
const SMALL: f64 = 1e-7;
const MOST_TURNS: usize = 500;

/// The inertia that remains.
pub(crate) fn settled(I: Sym3) -> Sym3 {
    let scale = I.to_mat3().rows().as_flattened().iter().fold(0.0_f64, |m, x| m.max(x.abs()));
    if scale == 0.0 {
        return I;
    }
    let M = (I * (1.0 / scale)).to_mat3().rows();
    let mut q = [1.0, 0.0, 0.0, 0.0];
    let mut R = matrix(q);
    let mut D = turned(M, R);
    for _ in 0..MOST_TURNS {
        let (a, b, c) = (D[0][1].abs(), D[0][2].abs(), D[1][2].abs());
        let (i, j) = if a > b && a > c {
            (0, 1)
        } else if b > c {
            (0, 2)
        } else {
            (1, 2)
        };
        if D[i][j].abs() <= SMALL || !D[i][j].is_finite() {
            break;
        }
        let tau = (D[j][j] - D[i][i]) / (2.0 * D[i][j]);
        let root = (1.0 + tau * tau).sqrt();
        let t = if tau >= 0.0 { 1.0 / (tau + root) } else { -1.0 / (-tau + root) };
        // about the third axis, by −atan t, or atan t about y
        let (axis, half) = (3 - i - j, t / (1.0 + (1.0 + t * t).sqrt()));
        let mut turn = [1.0, 0.0, 0.0, 0.0];
        turn[axis + 1] = if axis == 1 { half } else { -half };
        q = unit(product(q, unit(turn)));
        R = matrix(q);
        D = turned(M, R);
    }
    let entry = |i: usize, j: usize| (0..3).map(|k| R[i][k] * D[k][k] * R[j][k]).sum::<f64>() * scale;
    Sym3 { xx: entry(0, 0), xy: entry(0, 1), xz: entry(0, 2), yy: entry(1, 1), yz: entry(1, 2), zz: entry(2, 2) }
}

/// Rᵀ M R.
fn turned(M: [[f64; 3]; 3], R: [[f64; 3]; 3]) -> [[f64; 3]; 3] {
    let all = [0, 1, 2];
    let half = all.map(|i| all.map(|j| all.iter().map(|&k| R[k][i] * M[k][j]).sum::<f64>()));
    all.map(|i| all.map(|j| all.iter().map(|&k| half[i][k] * R[k][j]).sum()))
}

fn product([a, b, c, d]: [f64; 4], [e, f, g, h]: [f64; 4]) -> [f64; 4] {
    [
        a * e - b * f - c * g - d * h,
        a * f + b * e + c * h - d * g,
        a * g - b * h + c * e + d * f,
        a * h + b * g - c * f + d * e,
    ]
}

fn unit(q: [f64; 4]) -> [f64; 4] {
    let length = q.iter().map(|x| x * x).sum::<f64>().sqrt();
    q.map(|x| x / length)
}

fn matrix([w, x, y, z]: [f64; 4]) -> [[f64; 3]; 3] {
    [
        [w * w + x * x - y * y - z * z, 2.0 * (x * y - w * z), 2.0 * (x * z + w * y)],
        [2.0 * (x * y + w * z), w * w - x * x + y * y - z * z, 2.0 * (y * z - w * x)],
        [2.0 * (x * z - w * y), 2.0 * (y * z + w * x), w * w - x * x - y * y + z * z],
    ]
}

#[cfg(test)]
mod tests {
    use super::*;
    use mozzi::{SO3, Vec3};

    #[test]
    fn what_is_dropped_is_small() {
        for k in 0..50 {
            let turn = SO3::exp(Vec3([0.3 * f64::from(k), -1.1, 0.07 * f64::from(k * k)]));
            let I = Sym3::diagonal(0.3, 0.31 + 0.01 * f64::from(k), 0.5).congruence(turn.matrix());
            let (a, b) = (I.to_mat3().rows(), settled(I).to_mat3().rows());
            let far = a.as_flattened().iter().zip(b.as_flattened()).fold(0.0_f64, |m, (x, y)| m.max((x - y).abs()));
            assert!(far < 3e-7, "{k}: {far:e}");
        }
        // as MuJoCo 4.0.0 of sheared boxes: what is kept is turned to the axes, however small the angle
        for (xy, is_kept) in [(0.99e-7, false), (1.01e-7, true), (2e-7, true)] {
            for scale in [1.0, 1e-9] {
                let found = settled(Sym3 { xy, ..Sym3::diagonal(0.5, 1.0, 0.6) } * scale).xy / scale;
                let expected = if is_kept { xy } else { 0.0 };
                assert!((found - expected).abs() < 1e-15, "{found:e} {expected:e}");
            }
        }
        let I = Sym3 { xy: 2e-21, ..Sym3::diagonal(1e-9, 2e-9, 2.5e-9) };
        assert_eq!(settled(I).xy, 0.0);
        assert_eq!(settled(Sym3::diagonal(0.0, 0.0, 0.0)), Sym3::diagonal(0.0, 0.0, 0.0));
    }
}
