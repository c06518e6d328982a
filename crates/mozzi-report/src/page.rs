//! The bundled page, with placeholders for data.

use crate::base64;
use serde_json::Value;

/// Made by `cargo xtask page` from `page/`.
const PAGE: &str = include_str!("../bundle/page.html");
/// mozzi-web for WebAssembly, gzipped, made by `cargo xtask page`.
const WASM: &[u8] = include_bytes!("../bundle/mozzi.wasm.gz");

/// A page of a report.
pub fn fill(title: &str, data: &Value) -> String {
    filled(PAGE, WASM, title, data)
}

/// The text in HTML elements and the JSON in its `<script>` must not contain a `<` that could end them.
pub fn filled(page: &str, wasm: &[u8], title: &str, data: &Value) -> String {
    let title = title.replace('&', "&amp;").replace('<', "&lt;");
    let data = data.to_string().replace('<', "\\u003c");
    let (head, rest) = page.split_once("{{title}}").unwrap_or((page, ""));
    let (middle, rest) = rest.split_once("{{wasm}}").unwrap_or((rest, ""));
    let (last, tail) = rest.split_once("{{data}}").unwrap_or((rest, ""));
    [head, &title, middle, &base64::encode(wasm), last, &data, tail].concat()
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
        assert!(PAGE.contains("default-src 'none'") && PAGE.contains("connect-src 'none'"));
        assert!(PAGE.contains("three.js") && PAGE.contains("The MIT License"), "the notice of three.js");
        let whole = fill("", &Value::Null).len();
        assert!(whole < 1_300_000, "{whole} bytes");
        for place in ["{{title}}", "{{wasm}}", "{{data}}"] {
            assert_eq!(PAGE.matches(place).count(), 1, "{place}");
        }
    }
}
