//! The bill of materials of mozzi's binaries in CycloneDX's format, with the packages of THIRD-PARTY.txt. It names no
//! folders and no time, so that equal sources give an equal file.

use serde_json::{Value, json};

/// The file, which wheels, archives and the Debian package contain.
pub const FILE: &str = "mozzi.cdx.json";

/// The file's text; lines are `NAME VERSION`, licence, the artefacts that contain it.
pub fn text(version: &str, lines: &[(String, String, String)]) -> String {
    let components: Vec<Value> = lines.iter().map(component).collect();
    let document = json!({
        "bomFormat": "CycloneDX",
        "specVersion": "1.5",
        "version": 1,
        "metadata": {
            "component": {"type": "library", "bom-ref": "mozzi", "name": "mozzi", "version": version,
                          "licenses": [{"expression": "MIT OR Apache-2.0"}]},
        },
        "components": components,
    });
    serde_json::to_string_pretty(&document).unwrap_or_default() + "\n"
}

fn component((package, licence, artefacts): &(String, String, String)) -> Value {
    let (name, version) = package.rsplit_once(' ').unwrap_or((package, ""));
    let is_crate = name != "three.js";
    let kind = if is_crate { "cargo" } else { "npm" };
    let purl = format!("pkg:{kind}/{}@{version}", if is_crate { name } else { "three" });
    json!({
        "type": "library",
        "bom-ref": purl,
        "name": name,
        "version": version,
        "purl": purl,
        "licenses": [{"expression": licence.replace('/', " OR ")}],
        "properties": [{"name": "mozzi:contained_in", "value": artefacts}],
    })
}

#[cfg(test)]
mod tests {
    use super::text;

    #[test]
    fn packages_are_components() {
        let line = |name: &str, licence: &str| (name.to_owned(), licence.to_owned(), "wheel".to_owned());
        let text = text("0.1.0", &[line("three.js 0.1", "MIT"), line("a-b 1.2.3", "MIT/Apache-2.0")]);
        let found: serde_json::Value = serde_json::from_str(&text).expect("JSON");
        assert_eq!(found["components"][0]["purl"], "pkg:npm/three@0.1");
        assert_eq!(found["components"][1]["purl"], "pkg:cargo/a-b@1.2.3");
        assert_eq!(found["components"][1]["licenses"][0]["expression"], "MIT OR Apache-2.0");
    }
}
