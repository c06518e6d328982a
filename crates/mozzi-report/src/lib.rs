//! A robot and its motion as one HTML file, which needs only a browser and no network; and as figures for papers, SVG
//! ([`pictures`]).
//!
//! ```
//! use mozzi_sim::{Options, Zero};
//! use mozzi_report::{Drawing, Meshes, Motion};
//!
//! let model = mozzi_urdf::open("ur5")?.build()?;
//! let fall = mozzi_sim::simulate(&model, &[0.0, -1.2, 1.5, 0.3, 1.1, 0.0], &[0.0; 6], Zero, &Options::new(0.2, 200))?;
//! let drawing = Drawing::of_file("ur5", Meshes::Visual)?;
//! let page = mozzi_report::html(&model, &drawing, Some(&Motion::simulated("let go", &fall)))?;
//! assert!(page.starts_with("<!doctype html>") && page.contains("ur5, let go"));
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! The file contains the page (`page/` in the repository, bundled by `cargo xtask page`) and the data, a JSON object:
//!
//! - `robot`: the description, as [`mozzi_urdf::json`] writes it, from which mozzi-web in the page builds the model;
//! - `parameters`: the inertial parameters, if they are not those of the description;
//! - `shapes`, each at a frame, and `meshes`: the files of meshes, gzipped;
//! - `motion`: rows of a trajectory, as 32-bit floats (times: 64), and its contacts ([`Touches`]).
//!
//! [`play_html`] is the playground, which reads robots itself. [`compare`](mod@compare) explains why other libraries
//! give other numbers; [`text`] has tables for terminals, [`whole_file`] writes files at once.
mod base64;
pub mod compare;
mod drawing;
mod error;
pub mod figure;
mod fit;
mod fit_json;
mod markup;
mod motion;
mod page;
pub mod pictures;
mod play;
#[cfg(test)]
mod testing;
pub mod text;
mod touches;
pub mod whole_file;

pub use drawing::{Drawing, Meshes};
pub use error::Error;
pub use fit::fit_html;
pub use fit_json::fit_json;
pub use markup::escaped;
pub use motion::Motion;
pub use page::unpacked;
pub use play::{Played, lesson_html, lessons, play_html};
pub use touches::{Touches, shown_contacts};

use mozzi::Model;

/// Rows of a motion that a page shows without delay: a few megabytes for an arm.
pub const ROWS: usize = 20_000;

/// The HTML file. Without a motion it has a slider for each joint.
///
/// # Errors
/// [`Error::Motion`] if the motion's rows are not as long as this robot's.
pub fn html(model: &Model, drawing: &Drawing, motion: Option<&Motion>) -> Result<String, Error> {
    let title = match motion {
        Some(motion) => format!("{}, {}", model.description().name, motion.title),
        None => model.description().name.clone(),
    };
    let rows = motion.map(|motion| motion.to_json(model)).transpose()?;
    let parameters = Some(model.parameters());
    let described: Model = model.description().clone().build()?;
    let data = serde_json::json!({
        "robot": mozzi_urdf::json::to_value(model.description()),
        "parameters": parameters.filter(|parameters| *parameters != described.parameters()),
        "shapes": drawing.shapes_to_json(model),
        "meshes": drawing.meshes_to_json(),
        "motion": rows,
        "notes": drawing.notes,
    });
    Ok(page::fill(&title, &data))
}
