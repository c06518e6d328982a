//! The rotary inverted pendulum of Furuta (Modern Robotics, exercise 8.4): equations by hand, and its torque ellipsoid.
//!
//! 𝔪1 = 𝔪2 = 2, L1 = L2 = 1, g = 10, I1 = diag(0, 4, 4), I2 = diag(4, 4, 0) in the link frames. The book's figure is
//! not available; assumed: joint 1 turns about z at the origin, link 1 lies along x with its frame at its tip (L1, 0,
//! 0), joint 2 turns about x there, link 2 points along +z with its frame at (L1, 0, L2), all axes parallel at θ = 0.
//! If link 2 hung along −z, L2 would change its sign below: this is shown, too.
//!
//! Seen from axes that turn with link 1, with s2 = sin θ2, c2 = cos θ2, the links have
//!
//! > ω1 = (0, 0, θ̇1),  ṗ1 = (0, L1θ̇1, 0);   p2 = (L1, −L2s2, L2c2),  ṗ2 = (L2s2θ̇1, L1θ̇1 − L2c2θ̇2, −L2s2θ̇2)
//! > ω2 = (θ̇2, s2θ̇1, c2θ̇1) in the axes of link 2
//!
//! and 𝒦 = ½(I1_zzθ̇1² + 𝔪1‖ṗ1‖² + ω2ᵀI2ω2 + 𝔪2‖ṗ2‖²) = ½θ̇ᵀMθ̇, 𝒫 = 𝔪2 g L2c2 give
//!
//! > M11 = I1_zz + 𝔪1L1² + 𝔪2L1² + (I2_yy + 𝔪2L2²)s2² + I2_zzc2² = 8 + 6s2²
//! > M12 = −𝔪2L1L2c2 = −2c2,   M22 = I2_xx + 𝔪2L2² = 6
//! > c1 = M11′θ̇1θ̇2 + M12′θ̇2² = 12s2c2θ̇1θ̇2 + 2s2θ̇2²,   c2 = −½M11′θ̇1² = −6s2c2θ̇1²    (′ = ∂/∂θ2)
//! > g = (0, −𝔪2 g L2s2) = (0, −20s2)
//!
//! The torque ellipsoid is {Mθ̈ : ‖θ̈‖ = 1}: its principal axes are the eigenvectors of M, its semi-axes the
//! eigenvalues.

use mozzi::model::{HomeFrames, Screws};
use mozzi::{Description, Model, SE3, ScrewAxis, SpatialInertia, Sym3, Vec3};
use mozzi_examples::plot::Plot;
use mozzi_examples::{agree, row, show};
use nalgebra::DMatrix;
use std::error::Error;
use std::f64::consts::{FRAC_PI_4, TAU};

/// The exercise's robot; L2 < 0 hangs link 2 along −z.
fn furuta(L2: f64) -> Result<Model, Box<dyn Error>> {
    let M = [SE3::translation([1.0, 0.0, 0.0]), SE3::translation([1.0, 0.0, L2])];
    let G = [Sym3::diagonal(0.0, 4.0, 4.0), Sym3::diagonal(4.0, 4.0, 0.0)];
    let G = G.map(|I| SpatialInertia::new(2.0, Vec3::zero(), I));
    let S = [
        ScrewAxis::from_line([0.0, 0.0, 1.0], [0.0; 3], 0.0)?,
        ScrewAxis::from_line([1.0, 0.0, 0.0], [1.0, 0.0, 0.0], 0.0)?,
    ];
    let robot = Description::from_screws("furuta", HomeFrames::Base(&[M[0], M[1], M[1]]), &G, Screws::Space(&S))?;
    Ok(Description { gravity: [0.0, 0.0, -10.0], ..robot }.build()?)
}

fn main() -> Result<(), Box<dyn Error>> {
    let (theta, dtheta) = ([FRAC_PI_4; 2], [0.7, -1.2]);
    let (s, c) = theta[1].sin_cos();
    let mut plot = Plot::new(
        [
            "Torque ellipsoid of the Furuta pendulum at θ = (π/4, π/4)",
            "torques of all joint accelerations of size 1 rad/s²",
        ],
        ["τ₁ (N m)", "τ₂ (N m)"],
        [16.5, 9.0],
        5.0,
    );
    for (L2, side) in [(1.0, "+z: link 2 stands"), (-1.0, "−z: link 2 hangs")] {
        let M_hand = [8.0 + 6.0 * s * s, -2.0 * L2 * c, -2.0 * L2 * c, 6.0];
        let c_hand = [
            12.0 * s * c * dtheta[0] * dtheta[1] + 2.0 * L2 * s * dtheta[1] * dtheta[1],
            -6.0 * s * c * dtheta[0] * dtheta[0],
        ];
        let g_hand = [0.0, -20.0 * L2 * s];

        let model = furuta(L2)?;
        let M = model.mass_matrix(&theta)?;
        println!("{side} at θ = 0; at θ = (π/4, π/4):");
        show("M (kg m²)", &M);
        println!("g = [{}] N m: what holds it there", row(&model.gravity_forces(&theta)?));
        agree("M, by hand and by the library", &M, &M_hand, 1e-14);
        agree("c at θ̇ = (0.7, −1.2) rad/s", &model.velocity_product(&theta, &dtheta)?, &c_hand, 1e-14);
        agree("g", &model.gravity_forces(&theta)?, &g_hand, 1e-14);
        draw(&mut plot, &M, side, L2 > 0.0);
        println!();
    }
    // the same robot is also embedded as a URDF file, which contains no gravity
    let file = mozzi_urdf::open("furuta_pendulum")?.build()?.with_gravity([0.0, 0.0, -10.0])?;
    agree("g of the embedded URDF", &file.gravity_forces(&theta)?, &furuta(1.0)?.gravity_forces(&theta)?, 1e-14);

    std::fs::write("furuta_torque_ellipsoid.svg", plot.svg())?;
    println!(
        "The torque ellipsoid is drawn in {}",
        std::env::current_dir()?.join("furuta_torque_ellipsoid.svg").display()
    );
    Ok(())
}

/// The image of the unit circle, for the assumed pendulum with its axes.
fn draw(plot: &mut Plot, M: &DMatrix<f64>, side: &str, assumed: bool) {
    let image = |angle: f64| [0, 1].map(|i| M[(i, 0)] * angle.cos() + M[(i, 1)] * angle.sin());
    let (colour, y) = if assumed { ("#1f5fa8", -7.5) } else { ("#8a8a8a", -8.4) };
    plot.curve((0..=360).map(|k| image(TAU * f64::from(k) / 360.0)), colour, 2.0, !assumed);
    plot.curve([[-15.9, y + 0.25], [-14.4, y + 0.25]], colour, 2.0, !assumed);
    plot.text([-14.0, y], "start", colour, &format!("{side} at θ = 0"));
    if !assumed {
        return;
    }
    let eigen = M.clone().symmetric_eigen();
    for (k, &lambda) in eigen.eigenvalues.iter().enumerate() {
        let v = eigen.eigenvectors.column(k);
        let v = if v[1] < 0.0 { -v } else { v.into_owned() }; // upwards
        println!("semi-axis {lambda:.4} N m along ({:.4}, {:.4})", v[0], v[1]);
        let [x, y] = [v[0] * lambda, v[1] * lambda];
        plot.curve([[-x, -y], [0.0, 0.0]], "#c0392b", 1.0, true);
        plot.arrow([x, y], "#c0392b");
        plot.text([0.55 * x + 0.5, 0.55 * y + 0.4], "start", "#c0392b", &format!("{lambda:.2} N m"));
    }
    for (angle, words, shift, anchor) in
        [(0.0, "joint 1 alone", [0.3, -0.8], "start"), (TAU / 4.0, "joint 2 alone", [0.0, 0.5], "middle")]
    {
        let [x, y] = image(angle);
        plot.dot([x, y], colour);
        plot.text([x + shift[0], y + shift[1]], anchor, colour, words);
    }
}
