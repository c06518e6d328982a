//! Checks that a file is a mesh. A page embeds nothing else, whatever the file's name.

use crate::text::bytes;
use crate::text::dialect::Dialect;
use crate::text::source::Source;
use crate::text::syntax;

/// The words that an OBJ's lines may begin with (Wavefront's specification, version 3.0).
const WORDS: &str = "v vt vn vp deg bmat step cstype p l f curv curv2 surf parm trim hole scrv sp end con g s mg o \
                     bevel c_interp d_interp lod usemtl mtllib usemap maplib shadow_obj trace_obj ctech stech";

/// Reads a file by its format, "stl", "obj" or "dae".
///
/// # Errors
/// The first content that does not belong to a mesh.
pub fn check_mesh(format: &str, file: &[u8]) -> Result<(), String> {
    match format {
        "stl" if is_binary_stl(file) => finite_triangles(file),
        "stl" => ascii_stl(text(file)?),
        "obj" => obj(text(file)?),
        "dae" => collada(text(file)?),
        other => Err(format!("`{other}` is no format of meshes, expected stl, obj or dae")),
    }
}

fn text(file: &[u8]) -> Result<&str, String> {
    bytes::to_text(file).map_err(|(_, finding)| finding.message)
}

/// 80 bytes, the number of triangles, 50 bytes for each: twelve floats and two more bytes.
fn is_binary_stl(file: &[u8]) -> bool {
    let Some((count, rest)) = file.get(80..).and_then(<[u8]>::split_first_chunk::<4>) else { return false };
    let count = u32::from_le_bytes(*count) as usize;
    count > 0 && rest.len() / 50 == count && rest.len() % 50 < 4
}

/// The corners of a binary STL are finite.
fn finite_triangles(file: &[u8]) -> Result<(), String> {
    let is_finite = |bytes: &[u8]| bytes.first_chunk().copied().map(f32::from_le_bytes).is_some_and(f32::is_finite);
    let wrong = file[84..].chunks_exact(50).position(|triangle| !triangle[12..48].chunks_exact(4).all(is_finite));
    match wrong {
        None => Ok(()),
        Some(k) => Err(format!("triangle {} has a corner that is infinite or NaN, expected finite numbers", k + 1)),
    }
}

/// Whether a word is a finite number.
fn is_finite(word: &str) -> bool {
    word.parse::<f64>().is_ok_and(f64::is_finite)
}

/// solid NAME, then for each triangle: facet normal, outer loop, three vertices, endloop, endfacet; endsolid NAME.
fn ascii_stl(text: &str) -> Result<(), String> {
    // the next expected line of a triangle; none outside of a solid
    let (mut next, mut triangles) = (None, 0);
    for (k, line) in text.lines().enumerate().filter(|(_, line)| !line.trim().is_empty()) {
        let line = line.to_ascii_lowercase();
        let mut words = line.split_whitespace();
        let first = words.next().unwrap_or_default();
        let expected = next.map_or("solid", |next: usize| FACET[next]);
        next = match next {
            None if first == "solid" => Some(0),
            Some(0) if first == "endsolid" => None,
            Some(at) if is_line(expected, first, words) => {
                triangles += usize::from(at + 1 == FACET.len());
                Some((at + 1) % FACET.len())
            }
            _ => return Err(format!("line {}: expected `{expected}` of an STL", k + 1)),
        };
    }
    if triangles > 0 && next.is_none() { Ok(()) } else { Err("it has no triangles, or ends within them".into()) }
}

/// True if a line has the expected words, with three finite numbers in place of a 3.
fn is_line<'t>(expected: &str, first: &'t str, rest: impl Iterator<Item = &'t str>) -> bool {
    let words: Vec<&str> = std::iter::once(first).chain(rest).collect();
    let (start, count) = expected.strip_suffix(" 3").map_or((expected, 0), |start| (start, 3));
    let start: Vec<&str> = start.split(' ').collect();
    let numbers = words.strip_prefix(start.as_slice());
    numbers.is_some_and(|numbers| numbers.len() == count && numbers.iter().all(|word| is_finite(word)))
}

/// The lines of a triangle; 3 means three finite numbers.
const FACET: [&str; 7] = ["facet normal 3", "outer loop", "vertex 3", "vertex 3", "vertex 3", "endloop", "endfacet"];

/// Known words with finite numbers; at least a vertex and a face; faces of vertices that exist.
fn obj(text: &str) -> Result<(), String> {
    let (mut vertices, mut faces, mut is_continued) = (0_i64, 0, false);
    // the largest index of a vertex, and its line
    let mut largest = (0, 0);
    for (k, line) in text.lines().enumerate() {
        let wrong = |expected: &str| Err(format!("line {}: expected {expected} of an OBJ", k + 1));
        let line = line.split('#').next().unwrap_or_default().trim_ascii();
        let was_continued = std::mem::replace(&mut is_continued, line.ends_with('\\'));
        let mut words = line.trim_end_matches('\\').split_ascii_whitespace();
        let numbers = |mut words: std::str::SplitAsciiWhitespace<'_>| words.all(is_finite);
        let indices = |word: &str| word.split('/').all(|index| index.is_empty() || index.parse::<i64>().is_ok());
        match words.next() {
            None => {}
            Some(_) if was_continued => {}
            Some("v" | "vt" | "vn" | "vp") if !numbers(words.clone()) => return wrong("finite numbers"),
            Some("v") if !was_continued && !is_continued && words.clone().count() < 3 => return wrong("three numbers"),
            Some("f" | "l" | "p") if !words.clone().all(indices) => return wrong("indices"),
            Some("v") => vertices += 1,
            Some("f" | "l" | "p") => {
                faces += 1;
                for index in words.filter_map(|word| word.split('/').next()?.parse::<i64>().ok()) {
                    // a negative index counts from the vertex before it
                    if index == 0 || -index > vertices {
                        return Err(format!("line {}: vertex {index} does not exist, expected 1 or more", k + 1));
                    }
                    largest = largest.max((index, k + 1));
                }
            }
            Some(word) if WORDS.split_ascii_whitespace().any(|known| known == word) => {}
            Some(_) => return wrong("a word"),
        }
    }
    match largest {
        (index, line) if index > vertices => {
            Err(format!("line {line}: vertex {index} does not exist, expected at most {vertices}"))
        }
        _ if vertices > 0 && faces > 0 => Ok(()),
        _ => Err("it has no faces".into()),
    }
}

/// XML with a mesh of Collada.
fn collada(text: &str) -> Result<(), String> {
    let source = Source::new("mesh", text);
    let document = syntax::parse(&source, Dialect::Urdf).map_err(|_| "it is not XML that can be read".to_string())?;
    let root = document.root_element();
    let is_mesh = |node: roxmltree::Node| node.tag_name().name() == "mesh";
    if root.tag_name().name() != "COLLADA" || !root.descendants().any(is_mesh) {
        return Err("it is not Collada with a mesh".into());
    }
    let lists = root.descendants().filter(|node| node.tag_name().name() == "float_array");
    let words = lists.filter_map(|list| list.text()).flat_map(str::split_whitespace);
    match words.into_iter().find(|word| !is_finite(word)) {
        None => Ok(()),
        Some(_) => Err("a number of its <float_array> is infinite or NaN, expected finite numbers".into()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const STL: &str = "solid a b\n facet normal 0 0 1\n  outer loop\n   vertex 0 0 0\n   vertex 1 0 0\n   vertex 0 1e-3 0\n\
                       \x20 endloop\n endfacet\nendsolid a b\n";
    const OBJ: &str =
        "# a\nmtllib a.mtl\no a\nv 0 0 0\nv 1 0 0 \\\n 1\nv 0 1 0\nvn 0 0 1\nusemtl x\ns off\nf 1//1 2//1 3//1\n";
    const DAE: &str = "<?xml version='1.0'?><COLLADA xmlns='http://www.collada.org/2005/11/COLLADASchema'>\
                       <library_geometries><geometry><mesh/></geometry></library_geometries></COLLADA>";

    fn binary(triangles: u32, corner: f32) -> Vec<u8> {
        let triangle = [[0; 12].to_vec(), corner.to_le_bytes().repeat(9), vec![0; 2]].concat();
        [vec![b's'; 80], triangles.to_le_bytes().to_vec(), triangle.repeat(2)].concat()
    }

    #[test]
    fn meshes_are_known_by_their_content() {
        for (format, file) in [("stl", STL), ("obj", OBJ), ("dae", DAE)] {
            assert_eq!(check_mesh(format, file.as_bytes()), Ok(()), "{format}");
            for other in ["stl", "obj", "dae"].into_iter().filter(|other| *other != format) {
                assert!(check_mesh(other, file.as_bytes()).is_err(), "{format} as {other}");
            }
        }
        assert_eq!(check_mesh("stl", STL.repeat(2).replace('\n', "\r\n").as_bytes()), Ok(()));
        assert_eq!(check_mesh("stl", &binary(2, 0.5)), Ok(()));
        assert!(check_mesh("stl", &binary(3, 0.5)).is_err());
    }

    #[test]
    fn numbers_are_finite_and_vertices_exist() {
        let why = |format: &str, file: &[u8]| check_mesh(format, file).expect_err("a mesh that is none");
        assert_eq!(why("stl", &binary(2, f32::NAN))[..27], *"triangle 1 has a corner tha");
        let ascii = STL.replace("vertex 1 0 0", "vertex inf 0 0");
        assert_eq!(why("stl", ascii.as_bytes()), "line 5: expected `vertex 3` of an STL");
        for (text, expected) in [
            ("v nan inf 0\nf 1 1 1\n", "line 1: expected finite numbers of an OBJ"),
            ("v 1e999 0 0\nf 1 1 1\n", "line 1: expected finite numbers of an OBJ"),
            ("v 0 0\nf 1 1 1\n", "line 1: expected three numbers of an OBJ"),
            ("v 0 0 0\nf 1 2 1\nv 1 1 1\nf 1 2 3\n", "line 4: vertex 3 does not exist, expected at most 2"),
            ("v 0 0 0\nf -1 -2 -1\n", "line 2: vertex -2 does not exist, expected 1 or more"),
            ("v 0 0 0\nf 0 1 1\n", "line 2: vertex 0 does not exist, expected 1 or more"),
        ] {
            assert_eq!(why("obj", text.as_bytes()), expected);
        }
        assert_eq!(check_mesh("obj", b"v 0 0 0\nv 1 0 0\nf -1 -2/1 2//1\n"), Ok(()));
        let dae = DAE.replace("<mesh/>", "<mesh><float_array>0 1 nan</float_array></mesh>");
        assert!(why("dae", dae.as_bytes()).contains("infinite or NaN"));
    }

    #[test]
    fn other_files_are_none() {
        let secrets = [
            "root:x:0:0:root:/root:/bin/sh\n",
            "-----BEGIN OPENSSH PRIVATE KEY-----\nb3BlbnNzaC1rZXktdjEAAAAA\n-----END OPENSSH PRIVATE KEY-----\n",
            "solid a\nendsolid a\n",
            "solid a\npassword 1\nendsolid a\n",
            "solid a\n facet normal 0 0 1\nendsolid\n",
            "v 0 0 0\nf 1 1 1\npassword = x\n",
            "v 0 0 0\nv a b c\nf 1 1 1\n",
            "# only remarks\n",
            "<config><password>x</password></config>",
            "<COLLADA/>",
            "",
            "\u{0}\u{1}",
        ];
        for secret in secrets {
            for format in ["stl", "obj", "dae"] {
                let why = check_mesh(format, secret.as_bytes()).expect_err(secret);
                assert!(!why.contains("password") && !why.contains("root"), "{why}");
            }
        }
    }
}
