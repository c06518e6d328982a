//! Diagnostics as SARIF 2.1.0 (OASIS), which editors and CI read.

use serde_json::{Value, json};
use std::collections::BTreeSet;

/// One run with a result for each diagnostic, as `check --format json` has them.
pub fn log(diagnostics: &[Value]) -> Value {
    let codes: BTreeSet<&str> = diagnostics.iter().filter_map(|found| found["code"].as_str()).collect();
    let rule = |code: &&str| {
        let short = code.rsplit("::").next().unwrap_or(code);
        json!({ "id": code, "name": short, "help": { "text": format!("mozzi explain {short}") } })
    };
    json!({
        "$schema": "https://json.schemastore.org/sarif-2.1.0.json",
        "version": "2.1.0",
        "runs": [{
            "tool": { "driver": {
                "name": "mozzi",
                "version": env!("CARGO_PKG_VERSION"),
                "rules": codes.iter().map(rule).collect::<Value>(),
            } },
            "columnKind": "unicodeCodePoints",
            "results": diagnostics.iter().map(|found| result(found, &codes)).collect::<Value>(),
        }],
    })
}

fn result(found: &Value, codes: &BTreeSet<&str>) -> Value {
    let text = |key: &str| found[key].as_str().unwrap_or_default();
    let help = found["help"].as_str().map(|help| format!("\nhelp: {help}")).unwrap_or_default();
    let mut place = json!({ "artifactLocation": { "uri": uri(text("file")) } });
    if let (Some(line), Some(column)) = (found["line"].as_u64(), found["column"].as_u64()) {
        place["region"] = json!({ "startLine": line, "startColumn": column });
    }
    let mut result = json!({
        "level": text("severity"),
        "message": { "text": text("message").to_string() + &help },
        "locations": [{ "physicalLocation": place }],
    });
    if let Some(code) = found["code"].as_str() {
        result["ruleId"] = code.into();
        result["ruleIndex"] = codes.iter().position(|known| *known == code).into();
    }
    result
}

/// A path as a reference of RFC 3986, with percent-encoding of bytes that are not allowed.
fn uri(path: &str) -> String {
    let escaped: String = path
        .replace('\\', "/")
        .bytes()
        .map(|byte| match byte {
            b'a'..=b'z' | b'A'..=b'Z' | b'0'..=b'9' | b'-' | b'.' | b'_' | b'~' | b'/' => char::from(byte).to_string(),
            _ => format!("%{byte:02X}"),
        })
        .collect();
    if path.starts_with('/') { format!("file://{escaped}") } else { escaped }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn paths_become_references() {
        assert_eq!(uri("arms/left arm:ü.urdf"), "arms/left%20arm%3A%C3%BC.urdf");
        assert_eq!(uri("/tmp/a.urdf"), "file:///tmp/a.urdf");
        assert_eq!(uri("arms\\a.urdf"), "arms/a.urdf");
    }
}
