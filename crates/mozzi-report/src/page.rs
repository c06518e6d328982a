//! The bundled page, with placeholders for data.

use crate::base64;
use flate2::read::GzDecoder;
use serde_json::Value;
use std::io::Read;

/// HTML, gzipped, made by `cargo xtask page` from `page/`.
const PAGE: &[u8] = include_bytes!("../bundle/page.html.gz");
/// mozzi-web for WebAssembly, gzipped, made by `cargo xtask page`.
const WASM: &[u8] = include_bytes!("../bundle/mozzi.wasm.gz");

/// A page of a report.
pub fn fill(title: &str, data: &Value) -> String {
    filled(PAGE, WASM, title, data)
}

/// A gzipped page with its data. The text in HTML elements and the JSON in its `<script>` must not contain a `<` that
/// could end them.
pub fn filled(page: &[u8], wasm: &[u8], title: &str, data: &Value) -> String {
    let page = unpacked(page);
    let title = title.replace('&', "&amp;").replace('<', "&lt;");
    let data = data.to_string().replace('<', "\\u003c");
    let (head, rest) = page.split_once("{{title}}").unwrap_or((&page, ""));
    let (middle, rest) = rest.split_once("{{wasm}}").unwrap_or((rest, ""));
    let (last, tail) = rest.split_once("{{data}}").unwrap_or((rest, ""));
    [head, &title, middle, &base64::encode(wasm), last, &data, tail].concat()
}

/// A gzipped text; empty if it is none. Those of the program are read by tests.
pub fn unpacked(page: &[u8]) -> String {
    let mut text = String::new();
    GzDecoder::new(page).read_to_string(&mut text).map(|_| text).unwrap_or_default()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_cannot_leave_their_place() {
        let bad = "</script><script>alert(1)</script>";
        let page = fill(bad, &serde_json::json!({ "name": bad }));
        assert!(!page.contains("<script>alert"));
        assert!(page.contains("&lt;/script>") && page.contains("\\u003c/script>"));
    }

    #[test]
    fn the_bundle_asks_for_nothing_and_is_small() {
        let page = unpacked(PAGE);
        assert!(page.contains("default-src 'none'") && page.contains("connect-src 'none'"));
        assert!(page.contains("three.js") && page.contains("The MIT License"), "the notice of three.js");
        let whole = fill("", &Value::Null).len();
        assert!(whole < 1_300_000, "{whole} bytes");
        for place in ["{{title}}", "{{wasm}}", "{{data}}"] {
            assert_eq!(page.matches(place).count(), 1, "{place}");
        }
    }
}
