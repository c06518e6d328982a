//! `<inertial>` as text.

use mozzi::linalg::Sym3;
use mozzi::{SpatialInertia, Vec3};

/// The attributes of `<inertia>`, in the order of [`moments`].
pub(crate) const MOMENTS: [&str; 6] = ["ixx", "ixy", "ixz", "iyy", "iyz", "izz"];

pub(crate) fn moments(I: Sym3) -> [f64; 6] {
    let Sym3 { xx, xy, xz, yy, yz, zz } = I;
    [xx, xy, xz, yy, yz, zz]
}

/// The element, with its children after `line`, such as an end of line and spaces, and its end tag after `end`.
pub(crate) fn element(G: SpatialInertia, format: impl Fn(f64) -> String, line: &str, end: &str) -> String {
    let c = G.center_of_mass();
    let center = c.0.map(&format).join(" ");
    let origin = if c == Vec3::zero() { String::new() } else { format!("{line}<origin xyz=\"{center}\"/>") };
    let mass = format(G.mass);
    let numbers = MOMENTS.into_iter().zip(moments(G.about_center_of_mass()).map(format));
    let inertia: String = numbers.map(|(name, x)| format!(" {name}=\"{x}\"")).collect();
    format!("<inertial>{origin}{line}<mass value=\"{mass}\"/>{line}<inertia{inertia}/>{end}</inertial>")
}
