//! Rotations and axes of a robot without a file's decimals: rational numbers whose squares are those of a rotation
//! exactly. Kernels differ in where they take RᵀR for I, and a column of the regressor depends on others only if it is.

use crate::atom::Atom;
use crate::rational::Rational;
use crate::symbol::{Symbol, with_table};
use mozzi::{SO3, Scalar, ScrewAxis, Twist, Vec3};

/// Differences of numbers that are one but for rounding.
const ROUNDING: f64 = 1e-15;

/// The rotation within rounding: an entry that is 0 stays 0, as it is where a rotation about one of the frame's axes is
/// followed by one about another; else by a rational quaternion.
pub(crate) fn exact(R: SO3) -> SO3<Symbol> {
    let rows = R.matrix().rows().map(|row| row.map(|x| if x.abs() < ROUNDING { 0.0 } else { x }));
    let (s, Vec3(v)) = R.quaternion();
    let q = [s, v[0], v[1], v[2]].map(|x| if x.abs() < ROUNDING { 0.0 } else { x });
    if q[1..].iter().filter(|x| **x != 0.0).count() < 2 {
        return about_one_axis(q);
    }
    let pairs = || (0..9).map(|k| (k / 3, k % 3)).filter(|&(i, j)| rows[i][j] == 0.0);
    if let Some((i, j)) = pairs().find(|(i, j)| i != j) {
        // Rot(i) Rot(j): the first turns the axis j to the column j
        let first = turned(i, j, [0, 1, 2].map(|row| rows[row][j]));
        return exact(first) * exact(first.inverse() * R);
    }
    if let Some((i, _)) = pairs().next() {
        // Rot(i), a quarter turn of the axis i to k, Rot(i)
        let (j, k) = ((i + 1) % 3, (i + 2) % 3);
        let first = turned(i, k, [0, 1, 2].map(|row| rows[row][i]));
        let mut turn = Vec3::zero();
        turn.0[j] = -1.0;
        let quarter = SO3::from_quaternion(1.0, turn);
        return exact(first) * exact(quarter) * exact(quarter.inverse() * first.inverse() * R);
    }
    by_quaternion(q)
}

/// The rotation about the axis i that turns the axis j to a column, whose entry i is 0.
fn turned(i: usize, j: usize, column: [f64; 3]) -> SO3 {
    let k = 3 - i - j;
    let sign = if j == (i + 1) % 3 { 1.0 } else { -1.0 };
    let angle = (sign * column[k]).atan2(column[j]);
    let mut axis = Vec3::zero();
    axis.0[i] = (0.5 * angle).sin();
    SO3::from_quaternion((0.5 * angle).cos(), axis)
}

/// By a multiple of π/12, or a rational point of the circle.
fn about_one_axis(q: [f64; 4]) -> SO3<Symbol> {
    let axis = (1..4).find(|&k| q[k] != 0.0).unwrap_or(1);
    let twelfths = 24.0 / std::f64::consts::PI * q[axis].atan2(q[0]);
    if (twelfths - twelfths.round()).abs() < 12.0 * ROUNDING {
        let pi = Symbol::atom(with_table(|table| table.id(Atom::Pi)));
        let angle = |k| if k == axis { pi * Rational::new(twelfths.round() as i64, 12).into() } else { Symbol::zero() };
        return SO3::from_rpy(angle(1), angle(2), angle(3));
    }
    by_quaternion(q)
}

fn by_quaternion(q: [f64; 4]) -> SO3<Symbol> {
    let largest = (1..4).fold(0, |m, k| if q[k].abs() > q[m].abs() { k } else { m });
    let ratios = q.map(|x| x / q[largest]);
    let several = ratios.iter().filter(|x| x.fract() != 0.0).count() > 1;
    let [s, x, y, z] = ratios.map(|ratio| {
        let simple = simplest(ratio);
        // three long fractions have a longer common denominator than decimals have
        let is_short = matches!(simple, Rational::Small(_, ..1000));
        Symbol::from(if several && !is_short { digits(ratio) } else { simple })
    });
    SO3::from_quaternion(s, Vec3([x, y, z]))
}

/// The axis within rounding, of length 1 exactly; it may be beside its link's origin.
pub(crate) fn exact_axis(A: ScrewAxis) -> Option<ScrewAxis<Symbol>> {
    let Twist { w, v } = A.twist();
    let is_turning = w.norm() > 0.0;
    let direction = unit(if is_turning { w.0 } else { v.0 });
    let number = |x: f64| Symbol::from(digits(if x.abs() < ROUNDING { 0.0 } else { x }));
    let twist = match is_turning {
        true => {
            let (pitch, p) = (number(w.dot(v)), w.cross(v).map(number));
            Twist { w: direction, v: p.cross(direction) + direction * pitch }
        }
        false => Twist::linear(direction),
    };
    ScrewAxis::normalize(twist).ok().map(|(axis, _)| axis)
}

/// A direction in small whole numbers, else of length 1 and with a rational distance from the axis of its least
/// component, from which the joint's frame is made.
fn unit(direction: [f64; 3]) -> Vec3<Symbol> {
    let direction = direction.map(|x| if x.abs() < ROUNDING { 0.0 } else { x });
    if is_short(direction) {
        let least = direction.iter().map(|x| x.abs()).filter(|x| *x > 0.0).fold(f64::INFINITY, f64::min);
        let whole = Vec3(direction.map(|x| Symbol::from(simplest_within(x / least, 1e-9))));
        return whole * (Symbol::one() / whole.norm());
    }
    let least = (1..3).fold(0, |least, k| if direction[k].abs() < direction[least].abs() { k } else { least });
    let (i, j) = ((least + 1) % 3, (least + 2) % 3);
    let [away, along] = circle(direction[i].hypot(direction[j]), direction[least]);
    let [a, b] = circle(direction[i], direction[j]);
    let mut unit = Vec3::zero();
    (unit.0[least], unit.0[i], unit.0[j]) = (along.into(), (&away * &a).into(), (&away * &b).into());
    unit
}

/// Whether an axis is in the direction of small integers, so that its norm has a short root.
pub(crate) fn is_short(axis: [f64; 3]) -> bool {
    let least = axis.iter().map(|x| x.abs()).filter(|x| *x > 0.0).fold(f64::INFINITY, f64::min);
    let is_integer = |x: f64| (x - x.round()).abs() < 1e-9;
    (1..=100).any(|k| axis.iter().all(|x| is_integer(x / least * f64::from(k))))
}

/// The rational point of the unit circle in the direction (x, y).
fn circle(x: f64, y: f64) -> [Rational; 2] {
    let t = simplest(y / (x.abs() + x.hypot(y)));
    let square = &t * &t;
    let over = (&Rational::ONE + &square).inverse();
    let cosine = &(&Rational::ONE - &square) * &over;
    [if x < 0.0 { -&cosine } else { cosine }, &(&Rational::new(2, 1) * &t) * &over]
}

/// Sixteen digits behind the point.
fn digits(x: f64) -> Rational {
    Rational::decimal(&format!("{x:.16}")).unwrap_or(Rational::ZERO)
}

/// The simplest fraction of a number of size at most 1.
fn simplest(x: f64) -> Rational {
    simplest_within(x, 4e-16)
}

/// A fraction by the continued fraction of x.
fn simplest_within(x: f64, error: f64) -> Rational {
    let (mut rest, mut before, mut last) = (x.abs(), (0_i64, 1_i64), (1_i64, 0_i64));
    for _ in 0..40 {
        let whole = rest.floor();
        let next = |a: i64, b: i64| a.checked_add((whole as i64).checked_mul(b)?);
        let (Some(a), Some(b)) = (next(before.0, last.0), next(before.1, last.1)) else { break };
        (before, last) = (last, (a, b));
        if (a as f64 / b as f64 - x.abs()).abs() <= error || rest == whole {
            break;
        }
        rest = 1.0 / (rest - whole);
    }
    let (a, b) = last;
    Rational::new(if x < 0.0 { -a } else { a }, b)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::symbol::start;
    use crate::table::Table;

    fn near(found: Symbol, expected: f64) {
        assert!((f64::from(found) - expected).abs() < 4e-15, "{} instead of {expected}", f64::from(found));
    }

    #[test]
    fn rotations_are_exact() {
        start(Table::default());
        let [a, b, quarter] = [0.3, -2.5, std::f64::consts::FRAC_PI_2];
        for rpy in [
            [0.0, 0.0, 0.0],
            [0.7, 0.0, 0.0],
            [0.0, -2.3, 0.0],
            [a, 0.4, b],
            [a, b, 0.0],
            [0.0, a, b],
            [a, 0.0, b],
            [a, quarter, b],
            [quarter, a, b],
            [b, a, quarter],
            [0.5 * quarter, 0.0, quarter],
        ] {
            let R = SO3::from_rpy(rpy[0], rpy[1], rpy[2]);
            let found = exact(R);
            let square = (found.inverse() * found).matrix().rows();
            for i in 0..3 {
                for j in 0..3 {
                    let unit = if i == j { Symbol::one() } else { Symbol::zero() };
                    assert_eq!(square[i][j], unit, "{rpy:?}");
                    let (found, expected) = (found.matrix().rows()[i][j], R.matrix().rows()[i][j]);
                    near(found, expected);
                    assert!(expected.abs() > ROUNDING || found == Symbol::zero(), "{rpy:?}: {i} {j}");
                }
            }
        }
        assert_eq!(
            exact(SO3::from_quaternion(0.8, Vec3([0.6, 0.0, 0.0]))).matrix().rows()[1][1],
            Rational::new(7, 25).into()
        );
    }

    #[test]
    fn axes_have_length_1_and_a_rational_frame() {
        start(Table::default());
        for axis in [[0.0, 0.0, -1.0], [1.0, 2.0, 3.0], [0.1, 0.23, 0.97], [-0.71, 0.5, 0.0], [0.3, -0.9, 0.44]] {
            let norm = axis.iter().map(|x| x * x).sum::<f64>().sqrt();
            let A = ScrewAxis::from_line(axis.map(|x| x / norm), [0.2, 0.0, -0.1], 0.0).expect("a screw");
            let found = exact_axis(A).expect("an axis").twist();
            let expected = A.twist().to_array();
            assert_eq!(found.w.dot(found.w), Symbol::one(), "{axis:?}");
            assert_eq!(found.w.dot(found.v), Symbol::zero(), "{axis:?}");
            found.to_array().into_iter().zip(expected).for_each(|(found, expected)| near(found, expected));
        }
    }
}
