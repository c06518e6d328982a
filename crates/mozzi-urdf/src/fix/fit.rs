//! Comparison of a link's inertia with its shape.

use crate::XacroArguments;
use crate::geometry::hull::convex_hull;
use crate::geometry::moments::{Filling, Moments, moments};
use crate::geometry::{Form, MeshFolders, Purpose, Shape, scaled_surface};
use mozzi::spatial::Rounded;
use mozzi::{SE3, SO3, SpatialInertia, Vec3};
use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;

/// No solid is denser, kg/m³: osmium has 22,600.
const DENSEST: f64 = 25_000.0;
/// A repair does not leave a link lighter, kg/m³: a hollow shell of a robot has more.
const LIGHTEST: f64 = 20.0;
/// A shape that would be denser is no evidence for its link, kg/m³: a mass in g as one in kg gives at most 1000 times
/// [`DENSEST`].
const ABSURD: f64 = 3e7;
/// Points on a circle.
const AROUND: u32 = 24;
/// Meshes with more points are reduced to the farthest points in this many directions, which is enough for a
/// comparison.
const DIRECTIONS: usize = 300;

/// The points of the hull that matter.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Detail {
    Rough,
    All,
}

/// The convex hull of a link's shapes.
#[derive(Clone, Copy, Debug)]
pub(super) struct Solid {
    pub moments: Moments,
    /// The corners of its bounding box in the link's axes.
    low: [f64; 3],
    high: [f64; 3],
}

impl Solid {
    fn of(points: &[Vec3]) -> Option<Self> {
        let triangles = convex_hull(points)?;
        let moments = moments(points, &triangles, Filling::Exact).ok()?;
        let bound = |pick: fn(f64, f64) -> f64, start: f64| {
            [0, 1, 2].map(|k| points.iter().fold(start, |x, p| pick(x, p.0[k])))
        };
        Some(Solid { moments, low: bound(f64::min, f64::INFINITY), high: bound(f64::max, f64::NEG_INFINITY) })
    }

    /// False for a dummy shape, such as a ball of 1 mm on a body of kilograms.
    pub fn can_have(&self, mass: f64) -> bool {
        mass / self.moments.size <= ABSURD
    }

    /// Whether a repair may give a link this mass.
    pub fn may_weigh(&self, mass: f64) -> bool {
        mass / self.moments.size >= LIGHTEST
    }

    /// The misfit of an inertia and the hull, uniformly filled with the same mass, in powers of ten. It is the largest
    /// of three: |log₁₀| of the ratios of moments about the centre of mass, in the link's axes; an excessive density;
    /// the distance of the centre of mass from the hull's box. Infinite if a moment is not above 0.
    pub fn misfit(&self, G: SpatialInertia) -> f64 {
        let [moments, dense, away] = self.misfits(G, SO3::identity());
        moments.max(dense).max(away)
    }

    /// The misfits of moments in these axes, density and centre.
    fn misfits(&self, G: SpatialInertia, R: SO3) -> [f64; 3] {
        let moments = self.ratios(G, R).map(|(_, ratio)| tenfold(ratio)).into_iter().fold(0.0, f64::max);
        let density = G.mass / self.moments.size;
        let too_dense = if density > DENSEST { (density / 1000.0).log10() } else { 0.0 };
        // the centre's way out of the box, over the box's size
        let whole = [0, 1, 2].map(|k| self.high[k] - self.low[k]).into_iter().fold(0.0, f64::max);
        [moments, too_dense, (1.0 + self.outside(G) / whole).log10() * 2.0]
    }

    /// The moments in these axes, as parts of those of the hull.
    fn ratios(&self, G: SpatialInertia, R: SO3) -> [(&'static str, f64); 3] {
        let to_axes = R.inverse();
        let [found, filled] = [G.about_center_of_mass(), self.moments.I * (G.mass / self.moments.size)]
            .map(|I| I.congruence(to_axes.matrix()));
        [("ixx", found.xx / filled.xx), ("iyy", found.yy / filled.yy), ("izz", found.zz / filled.zz)]
    }

    /// The centre's way out of the hull's box, m.
    fn outside(&self, G: SpatialInertia) -> f64 {
        let c = G.center_of_mass().0;
        [0, 1, 2].map(|k| (self.low[k] - c[k]).max(c[k] - self.high[k])).into_iter().fold(0.0, f64::max)
    }

    /// The largest difference from the hull: a moment in these axes, the density, or the centre.
    pub fn doubt(&self, G: SpatialInertia, R: SO3) -> String {
        let [moments, dense, away] = self.misfits(G, R);
        if away >= moments.max(dense) {
            return format!("the centre of mass is {} m outside of the link's shape", Rounded(self.outside(G)));
        }
        if dense >= moments {
            return format!("the link's shape would have {} kg/m³", Rounded(G.mass / self.moments.size));
        }
        let worst = self.ratios(G, R).into_iter().max_by(|(_, a), (_, b)| tenfold(*a).total_cmp(&tenfold(*b)));
        let (name, ratio) = worst.unwrap_or_default();
        format!("{name} is about {} times that of the link's shape, uniformly filled", Rounded(ratio))
    }

    /// How far an inertia is from the hull's, all in all; for the choice among possible ones.
    pub fn distance(&self, G: SpatialInertia) -> f64 {
        let (found, filled) = (G.about_center_of_mass(), self.moments.I * (G.mass / self.moments.size));
        let square = |a: f64, b: f64| if a / b > 0.0 { (a / b).log10().powi(2) } else { 100.0 };
        let density = (G.mass / self.moments.size / 1000.0).log10();
        let moments = square(found.xx, filled.xx) + square(found.yy, filled.yy) + square(found.zz, filled.zz);
        moments + 0.1 * density * density
    }
}

/// |log₁₀| of a ratio; infinite if it is not above 0.
fn tenfold(ratio: f64) -> f64 {
    if ratio > 0.0 { ratio.log10().abs() } else { f64::INFINITY }
}

/// The solids of links, and the reasons why others have none.
#[derive(Default)]
pub(super) struct Solids {
    pub all: BTreeMap<String, Solid>,
    /// The first shape of each link without a solid that was not read.
    pub unread: BTreeMap<String, String>,
}

/// The solids of all links whose shapes can be read: the collision shapes, or else the visual ones. Meshes are located
/// as those of pages are; in `folders`, too.
pub(super) fn solids(file: &Path, text: &str, detail: Detail, folders: MeshFolders<'_>) -> Solids {
    let shapes = crate::geometry::parse_with(&file.to_string_lossy(), text, &XacroArguments::default()).shapes;
    let mut links: BTreeMap<&str, Vec<&Shape>> = BTreeMap::new();
    for shape in &shapes {
        links.entry(&shape.link).or_default().push(shape);
    }
    let mut solids = Solids::default();
    for (link, shapes) in links {
        let mut why = None;
        let solid = [Purpose::Collision, Purpose::Visual].into_iter().find_map(|purpose| {
            let mut points = Vec::new();
            let own: Vec<&&Shape> = shapes.iter().filter(|shape| shape.purpose == purpose).collect();
            for shape in &own {
                let read = points_of(shape, file, folders);
                let mut own = read.map_err(|error| why.get_or_insert(error).clone()).ok()?;
                if detail == Detail::Rough {
                    own = farthest(own);
                }
                points.extend(own.into_iter().map(|p| shape.T.R.matrix() * p + shape.T.p));
            }
            let mut solid = Solid::of(&points)?;
            if let [Shape { form, T, .. }] = own[..] {
                solid.moments = form.solid().map_or(solid.moments, |solid| exact(solid, *T));
            }
            Some(solid)
        });
        if let Some(solid) = solid {
            solids.all.insert(link.to_string(), solid);
        } else if let Some(why) = why {
            solids.unread.insert(link.to_string(), why);
        }
    }
    solids
}

/// A lone solid has its formulas.
fn exact(solid: mozzi::Solid, T: SE3) -> Moments {
    let G = solid.of_density(1.0).transformed(T);
    Moments { size: G.mass, center: T.p, I: G.about_center_of_mass() }
}

/// The points that are the farthest in some direction of Fibonacci's sphere.
fn farthest(points: Vec<Vec3>) -> Vec<Vec3> {
    if points.len() <= DIRECTIONS {
        return points;
    }
    let turn = std::f64::consts::PI * (3.0 - 5.0_f64.sqrt());
    let direction = |k: usize| {
        let z = 1.0 - (2 * k + 1) as f64 / DIRECTIONS as f64;
        let ((sin, cos), r) = ((turn * k as f64).sin_cos(), (1.0 - z * z).sqrt());
        Vec3([r * cos, r * sin, z])
    };
    let far = |e: Vec3| (0..points.len()).max_by(|&i, &j| points[i].dot(e).total_cmp(&points[j].dot(e)));
    let chosen: BTreeSet<usize> = (0..DIRECTIONS).filter_map(|k| far(direction(k))).collect();
    chosen.into_iter().map(|i| points[i]).collect()
}

/// Points whose hull is about the shape's, or why its mesh cannot be read.
fn points_of(shape: &Shape, robot: &Path, folders: MeshFolders<'_>) -> Result<Vec<Vec3>, String> {
    let ring = |radius: f64, z: f64| {
        (0..AROUND).map(move |k| {
            let (sin, cos) = (f64::from(k) / f64::from(AROUND) * std::f64::consts::TAU).sin_cos();
            Vec3([radius * cos, radius * sin, z])
        })
    };
    // rings of a ball about z = h, from its equator up or down
    let dome = |radius: f64, h: f64, up: f64| {
        (0..=6).flat_map(move |k| {
            let (sin, cos) = (f64::from(k) / 6.0 * std::f64::consts::FRAC_PI_2).sin_cos();
            ring(radius * cos, h + up * radius * sin)
        })
    };
    Ok(match &shape.form {
        Form::Box { size } => {
            let corner = |k: u32| Vec3([0, 1, 2].map(|i| (f64::from(k >> i & 1) - 0.5) * size[i]));
            (0..8).map(corner).collect()
        }
        Form::Cylinder { radius, length } => ring(*radius, length / 2.0).chain(ring(*radius, -length / 2.0)).collect(),
        Form::Capsule { radius, length } => {
            dome(*radius, length / 2.0, 1.0).chain(dome(*radius, -length / 2.0, -1.0)).collect()
        }
        Form::Sphere { radius } => dome(*radius, 0.0, 1.0).chain(dome(*radius, 0.0, -1.0)).collect(),
        Form::Ellipsoid { radii } => {
            let ball = dome(1.0, 0.0, 1.0).chain(dome(1.0, 0.0, -1.0));
            ball.map(|p| Vec3([0, 1, 2].map(|k| p.0[k] * radii[k]))).collect()
        }
        Form::Mesh { file, scale } => scaled_surface(robot, file, *scale, folders)?.vertices,
    })
}
