//! Surfaces of triangles in files: STL, binary and ASCII, OBJ, and MuJoCo's MSH.

use super::check_mesh;
use crate::text::bytes;
use mozzi::Vec3;
use std::collections::BTreeMap;

/// Triangles of vertices, in the file's own coordinates. In an STL each corner is a vertex of its own.
#[derive(Clone, Debug, Default)]
pub(crate) struct Surface {
    pub vertices: Vec<Vec3>,
    /// Counterclockwise, seen from outside.
    pub triangles: Vec<[usize; 3]>,
    /// The number of triangles in the first group (`o` or `g`) of an OBJ; of all in other formats.
    pub first_group: usize,
}

impl Surface {
    /// Reads a file by its format, "stl", "obj" or "msh".
    pub fn read(format: &str, file: &[u8]) -> Result<Self, String> {
        match format {
            "stl" => check_mesh(format, file).and_then(|()| stl(file)),
            "obj" => check_mesh(format, file).and_then(|()| obj(file)),
            "msh" => msh(file),
            other => Err(format!("surfaces of `{other}` files are not read; expected stl, obj or msh")),
        }
    }

    /// The vertices of an STL or an OBJ alone.
    pub fn vertices(format: &str, file: &[u8]) -> Result<Vec<Vec3>, String> {
        match format {
            "obj" => check_mesh(format, file).and_then(|()| words(file, "v")),
            _ => Ok(Self::read(format, file)?.vertices),
        }
    }

    fn of(vertices: Vec<Vec3>, triangles: Vec<[usize; 3]>) -> Self {
        Surface { first_group: triangles.len(), vertices, triangles }
    }
}

/// Binary: 80 bytes, a count, and for each triangle a normal and three corners of three `f32` each.
fn stl(file: &[u8]) -> Result<Surface, String> {
    let count = file.get(80..84).and_then(|bytes| bytes.first_chunk().copied()).map_or(0, u32::from_le_bytes);
    let mut corners = Vec::new();
    if file.len() / 50 < count as usize || file.starts_with(b"solid") && words(file, "vertex").is_ok() {
        corners = words(file, "vertex")?;
    } else {
        for triangle in file[84..].chunks_exact(50) {
            let number = |k: usize| triangle[12 + 4 * k..].first_chunk().copied().map_or(0.0, f32::from_le_bytes);
            corners.extend((0..3).map(|corner| Vec3(std::array::from_fn(|k| f64::from(number(3 * corner + k))))));
        }
    }
    // equal corners are one vertex
    let (mut known, mut vertices, mut numbers) = (BTreeMap::new(), Vec::new(), Vec::new());
    for corner in corners {
        let key = corner.0.map(|x| (x + 0.0).to_bits());
        let number = *known.entry(key).or_insert_with(|| {
            vertices.push(corner);
            vertices.len() - 1
        });
        numbers.push(number);
    }
    Ok(Surface::of(vertices, numbers.chunks_exact(3).map(|t| [t[0], t[1], t[2]]).collect()))
}

/// The three numbers after a word at the beginning of a line.
fn words(file: &[u8], word: &str) -> Result<Vec<Vec3>, String> {
    let text = bytes::to_text(file).map_err(|(_, finding)| finding.message)?;
    let mut found = Vec::new();
    for line in text.lines() {
        let mut parts = line.split_ascii_whitespace();
        if parts.next().is_some_and(|first| first.eq_ignore_ascii_case(word)) {
            let numbers: Vec<f64> = parts.take(3).filter_map(|part| part.parse().ok()).collect();
            if let [x, y, z] = numbers[..] {
                found.push(Vec3([x, y, z]));
            }
        }
    }
    if found.is_empty() { Err("it has no vertices".into()) } else { Ok(found) }
}

/// `v` and `f` of Wavefront's OBJ; polygons are split.
fn obj(file: &[u8]) -> Result<Surface, String> {
    let text = bytes::to_text(file).map_err(|(_, finding)| finding.message)?;
    let (vertices, mut triangles, mut first_group) = (words(file, "v")?, Vec::new(), None);
    let mut count = 0_i64;
    for line in text.lines() {
        let mut parts = line.split('#').next().unwrap_or_default().split_ascii_whitespace();
        match parts.next() {
            Some("v") => count += 1,
            Some("o" | "g") if !triangles.is_empty() => {
                first_group.get_or_insert(triangles.len());
            }
            Some("f") => {
                // a negative index counts back from the last vertex so far
                let index = |part: &str| part.split('/').next()?.parse::<i64>().ok();
                let place = |i: i64| usize::try_from(if i < 0 { count + i } else { i - 1 }).ok();
                let polygon: Option<Vec<usize>> = parts.map(|part| index(part).and_then(place)).collect();
                let polygon = polygon.filter(|all| all.iter().all(|&i| i < vertices.len())).unwrap_or_default();
                triangles.extend(split(&polygon, &vertices));
            }
            _ => {}
        }
    }
    Ok(Surface { first_group: first_group.unwrap_or(triangles.len()), vertices, triangles })
}

/// Triangles of a polygon: a quadrilateral's by its shorter diagonal, in numbers of 32 bits as tinyobjloader has them,
/// else a fan.
fn split(polygon: &[usize], vertices: &[Vec3]) -> Vec<[usize; 3]> {
    if let &[a, b, c, d] = polygon {
        let square = |i: usize, j: usize| {
            let [x, y, z] = [0, 1, 2].map(|k| vertices[j].0[k] as f32 - vertices[i].0[k] as f32);
            x * x + y * y + z * z
        };
        return if square(a, c) < square(b, d) { vec![[a, b, c], [a, c, d]] } else { vec![[a, b, d], [b, c, d]] };
    }
    polygon.windows(2).skip(1).map(|pair| [polygon[0], pair[0], pair[1]]).collect()
}

/// Four counts (vertices, normals, texture coordinates, triangles), then these as `f32` and `i32`.
fn msh(file: &[u8]) -> Result<Surface, String> {
    let word = |k: usize| file.get(4 * k..).and_then(|bytes| bytes.first_chunk::<4>().copied());
    let count = |k: usize| word(k).and_then(|bytes| usize::try_from(i32::from_le_bytes(bytes)).ok());
    let (Some(v), Some(n), Some(t), Some(f)) = (count(0), count(1), count(2), count(3)) else {
        return Err("it has no header of four counts, expected an MSH".into());
    };
    let size = [(v, 3), (n, 3), (t, 2), (f, 3)]
        .iter()
        .try_fold(4_usize, |sum, &(count, width)| sum.checked_add(count.checked_mul(width)?));
    if size.and_then(|size| size.checked_mul(4)) != Some(file.len()) || v == 0 {
        return Err(format!("it has {} bytes, expected those of {v} vertices and {f} triangles of an MSH", file.len()));
    }
    let float = |k: usize| word(k).map_or(0.0, |bytes| f64::from(f32::from_le_bytes(bytes)));
    let vertices: Vec<Vec3> = (0..v).map(|i| Vec3([0, 1, 2].map(|k| float(4 + 3 * i + k)))).collect();
    if let Some(i) = vertices.iter().position(|vertex| !vertex.0.iter().all(|x| x.is_finite())) {
        return Err(format!("vertex {i} is infinite or NaN, expected finite numbers"));
    }
    let start = 4 + 3 * v + 3 * n + 2 * t;
    let mut triangles = Vec::with_capacity(f);
    for i in 0..f {
        let corners = [0, 1, 2].map(|k| count(start + 3 * i + k).filter(|&corner| corner < v));
        let [Some(a), Some(b), Some(c)] = corners else {
            return Err(format!("triangle {i} has a vertex that does not exist, expected 0 to {}", v - 1));
        };
        triangles.push([a, b, c]);
    }
    Ok(Surface::of(vertices, triangles))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn polygons_are_split_and_groups_are_counted() {
        let text = "o a\nv 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2/1 3//2 -1\no b\nf 1 2 3\n";
        let surface = Surface::read("obj", text.as_bytes()).expect("a mesh");
        assert_eq!(surface.triangles, [[0, 1, 3], [1, 2, 3], [0, 1, 2]]);
        assert_eq!((surface.vertices.len(), surface.first_group), (4, 2));
        // by the shorter diagonal; a pentagon from its first corner
        let text = text.replace("v 1 1 0", "v 0.9 0.9 0").replace("f 1 2 3", "f 1 2 3 4 1");
        let surface = Surface::read("obj", text.as_bytes()).expect("a mesh");
        assert_eq!(surface.triangles[..3], [[0, 1, 2], [0, 2, 3], [0, 1, 2]]);
    }

    #[test]
    fn msh_is_counted() {
        let mut file = Vec::new();
        [3_i32, 0, 0, 1].iter().for_each(|n| file.extend(n.to_le_bytes()));
        [0.0_f32, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 2.0, 0.0].iter().for_each(|x| file.extend(x.to_le_bytes()));
        [0_i32, 1, 2].iter().for_each(|n| file.extend(n.to_le_bytes()));
        let surface = Surface::read("msh", &file).expect("a mesh");
        assert_eq!((surface.vertices[2], &surface.triangles[..]), (Vec3([0.0, 2.0, 0.0]), &[[0, 1, 2]][..]));
        let last = file.len() - 4;
        file[last..].copy_from_slice(&3_i32.to_le_bytes());
        assert!(Surface::read("msh", &file).is_err_and(|why| why.starts_with("triangle 0")));
        file.pop();
        assert!(Surface::read("msh", &file).is_err_and(|why| why.contains("63 bytes")));
        assert!(Surface::read("msh", b"abc").is_err());
    }
}
