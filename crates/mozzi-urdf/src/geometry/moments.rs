//! The volume, centre and moments of what a surface of triangles bounds, or of the surface itself.

use super::hull::convex_hull;
use mozzi::Vec3;
use mozzi::linalg::Sym3;

/// The part of a mesh that is filled with mass: MuJoCo's values of `inertia`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Filling {
    /// The convex hull.
    Convex,
    /// The solid that the triangles bound.
    Exact,
    /// The pyramids from the middle of the surface to each triangle, all counted as positive.
    Legacy,
    /// The triangles, evenly thin.
    Shell,
}

/// A solid or a shell of unit density.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Moments {
    /// Volume in m³; of a shell the area in m².
    pub size: f64,
    pub center: Vec3,
    /// ∫ (‖r‖² E − r rᵀ) about the centre.
    pub I: Sym3,
}

/// Less is no volume, and no area.
const LEAST: f64 = 1e-15;

/// The moments of a surface. The convex hull is that of all vertices; the others are of the triangles.
///
/// # Errors
/// The reason why there is no volume or area.
pub(crate) fn moments(vertices: &[Vec3], triangles: &[[usize; 3]], filling: Filling) -> Result<Moments, String> {
    let hull = match filling {
        Filling::Convex => {
            Some(convex_hull(vertices).ok_or("its vertices are in one plane, so it has no convex hull")?)
        }
        _ => None,
    };
    let whole = |&[a, b, c]: &[usize; 3]| [vertices[a], vertices[b], vertices[c]];
    let area = |[a, b, c]: [Vec3; 3]| 0.5 * (b - a).cross(c - a).norm();
    let third = |[a, b, c]: [Vec3; 3]| (a + b + c) * (1.0 / 3.0);
    if filling == Filling::Exact
        && let Some([a, b]) = doubled_edge(vertices, triangles)
    {
        return Err(format!("its triangles do not all face outwards: two have the edge from vertex {a} to {b}"));
    }

    // the middle of the surface, the tip of all pyramids
    let (mut surface, mut middle) = (0.0, Vec3::zero());
    for triangle in triangles.iter().map(whole) {
        surface += area(triangle);
        middle += third(triangle) * area(triangle);
    }
    if surface < LEAST {
        return Err(format!("the area of its surface is {surface:.1e} m², expected more"));
    }
    middle = middle * (1.0 / surface);

    let faces = hull.as_deref().unwrap_or(triangles);
    let size_from = |tip: Vec3, triangle: [Vec3; 3]| {
        let [a, b, c] = triangle.map(|corner| corner - tip);
        match filling {
            Filling::Shell => area(triangle),
            Filling::Legacy => (a.dot(b.cross(c)) / 6.0).abs(),
            Filling::Convex | Filling::Exact => a.dot(b.cross(c)) / 6.0,
        }
    };
    let (mut size, mut center) = (0.0, Vec3::zero());
    for triangle in faces.iter().map(whole) {
        let part = size_from(middle, triangle);
        size += part;
        let at = third(triangle);
        center += if filling == Filling::Shell { at } else { at * 0.75 + middle * 0.25 } * part;
    }
    if size < LEAST {
        let turned = if size < -LEAST { ": its triangles face inwards" } else { "" };
        return Err(format!("its volume is {size:.1e} m³, expected more than 0{turned}"));
    }
    center = center * (1.0 / size);

    // ∫ r rᵀ over a triangle or a pyramid from the centre
    let (mut second, mut sum) = ([[0.0; 3]; 3], 0.0);
    let divisor = if filling == Filling::Shell { 12.0 } else { 20.0 };
    for triangle in faces.iter().map(whole) {
        let part = size_from(center, triangle);
        sum += part;
        let [a, b, c] = triangle.map(|corner| (corner - center).0);
        for (i, row) in second.iter_mut().enumerate() {
            for (j, entry) in row.iter_mut().enumerate() {
                let squares = a[i] * a[j] + b[i] * b[j] + c[i] * c[j];
                *entry += part / divisor * (squares + (a[i] + b[i] + c[i]) * (a[j] + b[j] + c[j]));
            }
        }
    }
    let P = |i: usize, j: usize| second[i][j];
    let I = Sym3 {
        xx: P(1, 1) + P(2, 2),
        yy: P(0, 0) + P(2, 2),
        zz: P(0, 0) + P(1, 1),
        xy: -P(0, 1),
        xz: -P(0, 2),
        yz: -P(1, 2),
    };
    Ok(Moments { size: sum, center, I })
}

/// An edge that two triangles have in the same direction; those of triangles without an area do not count.
fn doubled_edge(vertices: &[Vec3], triangles: &[[usize; 3]]) -> Option<[usize; 2]> {
    let mut edges = Vec::with_capacity(3 * triangles.len());
    for &[a, b, c] in triangles {
        let area = 0.5 * (vertices[b] - vertices[a]).cross(vertices[c] - vertices[a]).norm();
        if area > LEAST.sqrt() {
            edges.extend([[a, b], [b, c], [c, a]]);
        }
    }
    edges.sort_unstable();
    edges.windows(2).find(|pair| pair[0] == pair[1]).map(|pair| pair[0])
}

#[cfg(test)]
mod tests {
    use super::*;
    use mozzi::Solid;

    /// A box with edges 1, 2, 3 whose corner is at (5, 0, 0); inside out if asked.
    fn cube(is_turned: bool) -> (Vec<Vec3>, Vec<[usize; 3]>) {
        let corner = |k: u32| Vec3([5.0 + f64::from(k & 1), 2.0 * f64::from(k >> 1 & 1), 3.0 * f64::from(k >> 2)]);
        let mut faces = convex_hull(&(0..8).map(corner).collect::<Vec<_>>()).expect("a solid");
        if is_turned {
            faces.iter_mut().for_each(|face| face.swap(0, 1));
        }
        ((0..8).map(corner).collect(), faces)
    }

    #[test]
    fn a_box_is_a_box_in_every_way() {
        let (vertices, faces) = cube(false);
        let expected = Solid::Box([1.0, 2.0, 3.0]).of_density(1.0).about_center_of_mass();
        for filling in [Filling::Convex, Filling::Exact, Filling::Legacy] {
            let found = moments(&vertices, &faces, filling).expect("a solid");
            assert!((found.size - 6.0).abs() < 1e-13 && (found.center - Vec3([5.5, 1.0, 1.5])).norm() < 1e-14);
            for (a, b) in [(found.I.xx, expected.xx), (found.I.yy, expected.yy), (found.I.zz, expected.zz)] {
                assert!((a / b - 1.0).abs() < 1e-13);
            }
            assert!([found.I.xy, found.I.xz, found.I.yz].iter().all(|x| x.abs() < 1e-13));
        }
        // six plates
        let shell = moments(&vertices, &faces, Filling::Shell).expect("a shell");
        assert!((shell.size - 22.0).abs() < 1e-13 && (shell.center - Vec3([5.5, 1.0, 1.5])).norm() < 1e-14);
        let plates = 2.0 * (2.0 * (4.0 / 12.0 + 2.25) + 6.0 * (4.0 + 9.0) / 12.0 + 3.0 * (1.0 + 9.0 / 12.0));
        assert!((shell.I.xx / plates - 1.0).abs() < 1e-13, "{} {plates}", shell.I.xx);
    }

    #[test]
    fn what_bounds_nothing_is_told() {
        let (vertices, faces) = cube(true);
        let why = |filling| moments(&vertices, &faces, filling).expect_err("no solid");
        assert!(why(Filling::Exact).contains("face inwards"));
        assert!(
            moments(&vertices, &faces, Filling::Legacy).is_ok() && moments(&vertices, &faces, Filling::Convex).is_ok()
        );
        let mut mixed = cube(false).1;
        mixed[3].swap(0, 1);
        assert!(moments(&vertices, &mixed, Filling::Exact).is_err_and(|why| why.contains("two have the edge")));
        let flat = [Vec3([0.0; 3]), Vec3([1.0, 0.0, 0.0]), Vec3([0.0, 1.0, 0.0])];
        assert!(moments(&flat, &[[0, 1, 2]], Filling::Convex).is_err_and(|why| why.contains("one plane")));
        assert!(moments(&flat, &[[0, 1, 1]], Filling::Shell).is_err_and(|why| why.contains("area")));
        assert!(moments(&flat, &[[0, 1, 2]], Filling::Exact).is_err_and(|why| why.contains("volume")));
    }
}
