//! PDF 1.4 (ISO 32000-1): one page of paths, text as outlines.

use super::cannot;
use crate::failure::Result;
use flate2::{Compression, write::ZlibEncoder};
use resvg::tiny_skia::{Path, PathSegment, Point};
use resvg::usvg::{self, FillRule, Group, LineCap, LineJoin, Node, Paint};
use std::fmt::Write as _;
use std::io::Write as _;

/// Points of 1/72 inch per pixel of 1/96 inch.
const POINTS: f32 = 0.75;

/// The page, as large as the figure.
pub fn of(tree: &usvg::Tree, title: &str) -> Result<Vec<u8>> {
    let (width, height) = (POINTS * tree.size().width(), POINTS * tree.size().height());
    let mut page = Content { text: format!("{POINTS} 0 0 {} 0 {height} cm\n", -POINTS), opacities: Vec::new() };
    page.group(tree.root())?;
    let mut packed = ZlibEncoder::new(Vec::new(), Compression::default());
    let packed = packed.write_all(page.text.as_bytes()).and_then(|()| packed.finish());
    let packed = packed.map_err(|error| cannot("PDF", &error.to_string()))?;
    let mut states = String::new();
    for (k, [fill, stroke]) in page.opacities.iter().enumerate() {
        let _ = write!(states, "/G{k} << /ca {fill} /CA {stroke} >> ");
    }
    let title: String = title.encode_utf16().map(|unit| format!("{unit:04X}")).collect();
    let objects = [
        "<< /Type /Catalog /Pages 2 0 R >>".to_string(),
        "<< /Type /Pages /Kids [3 0 R] /Count 1 >>".to_string(),
        format!(
            "<< /Type /Page /Parent 2 0 R /MediaBox [0 0 {width} {height}] /Contents 5 0 R /Resources << /ExtGState << {states}>> >> >>"
        ),
        format!("<< /Title <FEFF{title}> /Producer (mozzi) >>"),
        format!("<< /Length {} /Filter /FlateDecode >>\nstream\n", packed.len()),
    ];
    let (mut file, mut places) = (b"%PDF-1.4\n%\xe2\xe3\xcf\xd3\n".to_vec(), String::new());
    for (k, object) in objects.iter().enumerate() {
        let _ = writeln!(places, "{:010} 00000 n ", file.len());
        file.extend(format!("{} 0 obj\n{object}", k + 1).into_bytes());
        if k + 1 == objects.len() {
            file.extend(&packed);
            file.extend(b"\nendstream");
        }
        file.extend(b"\nendobj\n");
    }
    let (count, table) = (objects.len() + 1, file.len());
    file.extend(
        format!(
            "xref\n0 {count}\n0000000000 65535 f \n{places}trailer\n<< /Size {count} /Root 1 0 R /Info 4 0 R >>\nstartxref\n{table}\n%%EOF\n"
        )
        .into_bytes(),
    );
    Ok(file)
}

/// The operators of a page.
struct Content {
    text: String,
    /// Opacities of fills and strokes.
    opacities: Vec<[f32; 2]>,
}

impl Content {
    fn group(&mut self, group: &Group) -> Result<()> {
        for node in group.children() {
            match node {
                Node::Group(group) => self.group(group)?,
                Node::Path(path) if path.is_visible() => self.path(path)?,
                Node::Text(text) => self.group(text.flattened())?,
                Node::Path(_) => {}
                Node::Image(_) => return Err(cannot("PDF", "it contains an image")),
            }
        }
        Ok(())
    }

    fn path(&mut self, path: &usvg::Path) -> Result<()> {
        let t = path.abs_transform();
        let _ = writeln!(self.text, "q {} {} {} {} {} {} cm", t.sx, t.ky, t.kx, t.sy, t.tx, t.ty);
        let opacity =
            [path.fill().map_or(1.0, |fill| fill.opacity().get()), path.stroke().map_or(1.0, |s| s.opacity().get())];
        let k = self.opacities.iter().position(|known| *known == opacity).unwrap_or(self.opacities.len());
        if k == self.opacities.len() {
            self.opacities.push(opacity);
        }
        let _ = writeln!(self.text, "/G{k} gs");
        if let Some(fill) = path.fill() {
            let _ = writeln!(self.text, "{} rg", color(fill.paint())?);
        }
        if let Some(stroke) = path.stroke() {
            let cap = match stroke.linecap() {
                LineCap::Butt => 0,
                LineCap::Round => 1,
                LineCap::Square => 2,
            };
            let join = match stroke.linejoin() {
                LineJoin::Miter | LineJoin::MiterClip => 0,
                LineJoin::Round => 1,
                LineJoin::Bevel => 2,
            };
            let (width, miter) = (stroke.width().get(), stroke.miterlimit().get());
            let dashes: Vec<String> = stroke.dasharray().into_iter().flatten().map(f32::to_string).collect();
            let (dashes, offset) = (dashes.join(" "), stroke.dashoffset());
            let color = color(stroke.paint())?;
            let _ = writeln!(self.text, "{color} RG {width} w {cap} J {join} j {miter} M [{dashes}] {offset} d");
        }
        self.outline(path.data());
        let is_even_odd = path.fill().is_some_and(|fill| fill.rule() == FillRule::EvenOdd);
        let paint = match (path.fill().is_some(), path.stroke().is_some(), is_even_odd) {
            (true, true, false) => "B",
            (true, true, true) => "B*",
            (true, false, false) => "f",
            (true, false, true) => "f*",
            (false, true, _) => "S",
            (false, false, _) => "n",
        };
        let _ = writeln!(self.text, "{paint} Q");
        Ok(())
    }

    fn outline(&mut self, path: &Path) {
        let mut last = Point::zero();
        for segment in path.segments() {
            let _ = match segment {
                PathSegment::MoveTo(p) => writeln!(self.text, "{} {} m", p.x, p.y),
                PathSegment::LineTo(p) => writeln!(self.text, "{} {} l", p.x, p.y),
                PathSegment::QuadTo(c, p) => {
                    let third = |end: Point| (end.x + 2.0 * (c.x - end.x) / 3.0, end.y + 2.0 * (c.y - end.y) / 3.0);
                    let ((a, b), (d, e)) = (third(last), third(p));
                    writeln!(self.text, "{a} {b} {d} {e} {} {} c", p.x, p.y)
                }
                PathSegment::CubicTo(a, b, p) => {
                    writeln!(self.text, "{} {} {} {} {} {} c", a.x, a.y, b.x, b.y, p.x, p.y)
                }
                PathSegment::Close => writeln!(self.text, "h"),
            };
            if let PathSegment::MoveTo(p)
            | PathSegment::LineTo(p)
            | PathSegment::QuadTo(_, p)
            | PathSegment::CubicTo(.., p) = segment
            {
                last = p;
            }
        }
    }
}

fn color(paint: &Paint) -> Result<String> {
    let Paint::Color(color) = paint else { return Err(cannot("PDF", "it contains a gradient or a pattern")) };
    let [r, g, b] = [color.red, color.green, color.blue].map(|c| f32::from(c) / 255.0);
    Ok(format!("{r} {g} {b}"))
}
