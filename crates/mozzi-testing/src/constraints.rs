//! An independent implementation of constraints: from the poses and Jacobians of the anchors in {s}, rates by dual
//! numbers.

use crate::bodies::{frame, source};
use mozzi::model::description::{Anchor, Closure, ConstraintKind};
use mozzi::model::seed_direction;
use mozzi::nalgebra::{DMatrix, DVector};
use mozzi::{Description, Entry, Model, Real, SE3, Scalar, Twist, Vec3};

/// A by rows, and φ.
pub struct Rows<S> {
    pub A: Vec<Vec<S>>,
    pub phi: Vec<S>,
}

/// An anchor seen from {s}: its configuration, and the columns (ω, ṗ) of its origin's motion, in the axes of {s}.
fn anchor<S: Real>(
    robot: &Description<S>,
    model: &Model<S>,
    theta: &[S],
    anchor: &Anchor<S>,
) -> (SE3<S>, Vec<Twist<S>>) {
    let (T, J) = match &anchor.frame {
        None => (SE3::identity(), vec![Twist::zero(); model.n()]),
        Some(name) => frame(robot, model, theta, name),
    };
    let T_anchor = T * anchor.T;
    let columns = J.into_iter().map(|column| {
        let V = anchor.T.inverse().Ad() * column;
        Twist { w: T_anchor.R * V.w, v: T_anchor.R * V.v }
    });
    (T_anchor, columns.collect())
}

/// All rows at θ.
pub fn rows<S: Real>(robot: &Description<S>, model: &Model<S>, theta: &[S]) -> Rows<S> {
    let (mut A, mut phi) = (Vec::new(), Vec::new());
    for constraint in &robot.constraints {
        match &constraint.kind {
            ConstraintKind::Frames { a, b, closure } => {
                let (T_a, J_a) = anchor(robot, model, theta, a);
                let (T_b, J_b) = anchor(robot, model, theta, b);
                let (T_ab, way) = (T_a.inverse() * T_b, T_b.p - T_a.p);
                let R = T_a.R.inverse();
                let columns: Vec<Twist<S>> = (J_a.iter().zip(&J_b))
                    .map(|(a, b)| Twist { w: R * (b.w - a.w), v: R * (b.v - a.v - a.w.cross(way)) })
                    .collect();
                let mut add = |of: &dyn Fn(Twist<S>) -> S, residual: S| {
                    A.push(columns.iter().map(|&column| of(column)).collect());
                    phi.push(residual);
                };
                let p = T_ab.p;
                let z = T_ab.R * Vec3([S::zero(), S::zero(), S::one()]);
                match *closure {
                    Closure::Point => (0..3).for_each(|k| add(&|V| V.v.0[k], p.0[k])),
                    Closure::Weld => {
                        // 2 sin(α/2) n for the rotation vector α n
                        let turn = T_ab.R.log();
                        let angle = turn.norm();
                        let size = if angle > S::zero() {
                            let (sin, _) = (angle * S::from_f64(0.5)).sin_cos();
                            S::from_f64(2.0) * sin / angle
                        } else {
                            S::one()
                        };
                        (0..3).for_each(|k| add(&|V| V.w.0[k], turn.0[k] * size));
                        (0..3).for_each(|k| add(&|V| V.v.0[k], p.0[k]));
                    }
                    Closure::Hinge => {
                        add(&|V| V.w.0[0], -z.0[1]);
                        add(&|V| V.w.0[1], z.0[0]);
                        (0..3).for_each(|k| add(&|V| V.v.0[k], p.0[k]));
                    }
                    Closure::Distance(d) => {
                        add(&|V| p.dot(V.v) / d, (p.dot(p) - d * d) / (d + d));
                    }
                    Closure::Rolling(radius) => {
                        // the wheel's rim is r(u cos s + w sin s); at its lowest point the derivative of the height is
                        // 0
                        let normal = Vec3([S::zero(), S::zero(), S::one()]);
                        let side = z.cross(normal); // horizontal, in the wheel's plane
                        let side = side.map(|x| x / side.norm());
                        let up = side.cross(z);
                        let lowest = up.map(|x| -x * radius);
                        for k in 0..3 {
                            let residual = if k == 2 { p.0[2] + lowest.0[2] } else { S::zero() };
                            add(&|V| (V.v + V.w.cross(lowest)).0[k], residual);
                        }
                    }
                }
            }
            ConstraintKind::Joint { joints, source: others, polynomial } => {
                // a joint's own position, and the index and ratio of its source joint's rate
                let own = |name: &str| {
                    let joint = robot.joints.iter().find(|joint| joint.name == name).expect("a joint");
                    let (source, ratio, offset) = source(robot, joint);
                    let k = model.joint_names().position(|name| *name == source.name).expect("independent");
                    let place = model.places()[k];
                    (place.j, ratio, ratio * theta[place.q] + offset)
                };
                let mut row = vec![S::zero(); model.n()];
                let mut residual = -polynomial[0];
                for gear in joints {
                    let (j, ratio, y) = own(&gear.joint);
                    row[j] += gear.ratio * ratio;
                    residual += gear.ratio * y;
                }
                let others: Vec<_> = others.iter().map(|gear| (gear.ratio, own(&gear.joint))).collect();
                let x = others.iter().fold(S::zero(), |sum, &(r, (_, _, x))| sum + r * x);
                let mut power = S::one(); // x^(k − 1)
                for (k, &c) in polynomial.iter().enumerate().skip(1) {
                    for &(r, (i, ratio, _)) in &others {
                        row[i] -= S::from_f64(k as f64) * c * power * r * ratio;
                    }
                    power = power * x;
                    residual -= if others.is_empty() { S::zero() } else { c * power };
                }
                A.push(row);
                phi.push(residual);
            }
        }
    }
    Rows { A, phi }
}

/// Ȧθ̇: the rate of A(θ)θ̇ along θ̇.
pub fn bias<S: Real>(
    robot: &Description<mozzi::Dual<S>>,
    model: &Model<mozzi::Dual<S>>,
    plain: &Model<S>,
    theta: &[S],
    dtheta: &[S],
) -> Vec<S> {
    let moving = rows(robot, model, &seed_direction(plain, theta, dtheta));
    let speed = |row: Vec<mozzi::Dual<S>>| {
        row.into_iter().zip(dtheta).fold(S::zero(), |sum, (entry, &rate)| sum + entry.derivative * rate)
    };
    moving.A.into_iter().map(speed).collect()
}

/// x and y of M x + Aᵀy = f, A x = a, from the whole matrix; the columns of f and a are solved together.
pub fn saddle<S: Entry>(M: &DMatrix<S>, A: &[Vec<S>], f: &DVector<S>, a: &[S]) -> (Vec<S>, Vec<S>) {
    let (n, m) = (M.nrows(), A.len());
    let mut K = DMatrix::from_element(n + m, n + m, <S as Scalar>::zero());
    let mut right = DMatrix::from_element(n + m, 1, <S as Scalar>::zero());
    for i in 0..n {
        for j in 0..n {
            K[(i, j)] = M[(i, j)];
        }
        right[(i, 0)] = f[i];
    }
    for (r, row) in A.iter().enumerate() {
        for (j, &entry) in row.iter().enumerate() {
            K[(n + r, j)] = entry;
            K[(j, n + r)] = entry;
        }
        right[(n + r, 0)] = a[r];
    }
    let found = crate::solve(&K, &right).expect("independent constraints");
    ((0..n).map(|i| found[(i, 0)]).collect(), (n..n + m).map(|i| found[(i, 0)]).collect())
}
