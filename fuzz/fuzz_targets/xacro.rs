//! Any text of xacro is expanded within the bounds, or refused at a place; the expansion is XML.
#![no_main]

use mozzi_xacro::{Arguments, expand_text};

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| {
    let Ok(text) = std::str::from_utf8(bytes) else { return };
    // an expression, or a file
    let whole = match text.starts_with('<') {
        true => text.to_string(),
        false => format!("<robot xmlns:xacro=\"http://www.ros.org/wiki/xacro\"><a>${{{}}}</a></robot>", text.replace(['<', '&'], " ")),
    };
    match expand_text("fuzz.xacro", &whole, &Arguments::default()) {
        Ok(expansion) => {
            let end = expansion.text.len(); // behind the first element, before which there is no origin
            assert!(expansion.origin(end..end).is_some());
        }
        Err(error) => assert!(!error.message().is_empty() && error.place().is_some(), "{error}"),
    }
});
