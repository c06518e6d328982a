//! Text in SVG and HTML.

/// The fonts of figures, as an attribute's value.
pub(crate) const SANS: &str = "Helvetica, Arial, 'DejaVu Sans', sans-serif";

/// Text as SVG or HTML.
pub fn escaped(text: &str) -> String {
    text.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;").replace('"', "&quot;")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_are_escaped() {
        assert_eq!(escaped("<b>&\""), "&lt;b&gt;&amp;&quot;");
    }
}
