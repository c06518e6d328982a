//! The fenced blocks of a page.

/// A fenced block.
#[derive(Debug, PartialEq)]
pub struct Block {
    /// Its first word: `python`, `sh`, `cpp`, ….
    pub language: String,
    /// The words after it, between commas.
    pub options: Vec<String>,
    pub code: String,
    /// The number of its first line of code in the page.
    pub line: usize,
    /// The output that the page shows: the block `text` that follows.
    pub output: Option<String>,
}

impl Block {
    /// The value of an option `name=value`.
    pub fn option(&self, name: &str) -> Option<&str> {
        self.options.iter().find_map(|option| option.strip_prefix(name)?.strip_prefix('='))
    }
}

/// All blocks of a page; a block `text` becomes the output of the one before it.
pub fn blocks(page: &str) -> Result<Vec<Block>, String> {
    let mut found: Vec<Block> = Vec::new();
    let mut lines = page.lines().enumerate();
    while let Some((number, line)) = lines.next() {
        let Some(info) = line.strip_prefix("```") else { continue };
        let mut words = info.split(',').map(|word| word.trim().to_owned());
        let language = words.next().unwrap_or_default();
        let (options, mut code) = (words.collect(), String::new());
        loop {
            match lines.next() {
                Some((_, "```")) => break,
                Some((_, line)) => code += &format!("{line}\n"),
                None => return Err(format!("line {}: the block is not closed", number + 1)),
            }
        }
        if language == "text" {
            let before = found.last_mut().filter(|block| block.output.is_none());
            let before = before.ok_or_else(|| format!("line {}: a block `text` follows a program", number + 1))?;
            before.output = Some(code);
            continue;
        }
        found.push(Block { language, options, code, line: number + 2, output: None });
    }
    Ok(found)
}

#[cfg(test)]
mod tests {
    use super::blocks;

    #[test]
    fn blocks_have_languages_options_and_outputs() {
        let found = blocks("a\n```python\nprint(1)\n```\nprints\n```text\n1\n```\n```xml,file=a.urdf\n<a/>\n```\n");
        let found = found.expect("closed blocks");
        assert_eq!(found.len(), 2);
        assert_eq!((found[0].language.as_str(), found[0].code.as_str(), found[0].line), ("python", "print(1)\n", 3));
        assert_eq!(found[0].output.as_deref(), Some("1\n"));
        assert_eq!(found[1].option("file"), Some("a.urdf"));
    }

    #[test]
    fn mistakes_are_errors() {
        assert!(blocks("```sh\nls\n").is_err());
        assert!(blocks("```text\nls\n```\n").is_err());
    }
}
