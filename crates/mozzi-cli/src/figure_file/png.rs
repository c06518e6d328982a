//! PNG, at twice the figure's size.

use super::cannot;
use crate::failure::Result;
use resvg::{tiny_skia, usvg};

pub fn of(tree: &usvg::Tree) -> Result<Vec<u8>> {
    let size = tree.size().to_int_size().scale_by(2.0);
    let mut pixels = size.and_then(|size| tiny_skia::Pixmap::new(size.width(), size.height()));
    let pixels = pixels.as_mut().ok_or_else(|| cannot("PNG", "it has no size"))?;
    resvg::render(tree, tiny_skia::Transform::from_scale(2.0, 2.0), &mut pixels.as_mut());
    pixels.encode_png().map_err(|error| cannot("PNG", &error.to_string()))
}
