//! A stamp: the text of the sources of a build, stored with its result. If the text is unchanged, nothing is rebuilt.

use std::path::PathBuf;

/// 64-bit FNV-1a, as hexadecimal text.
pub fn fnv(bytes: impl IntoIterator<Item = u8>) -> String {
    let step = |hash: u64, byte: u8| (hash ^ u64::from(byte)).wrapping_mul(0x0100_0000_01b3);
    format!("{:016x}", bytes.into_iter().fold(0xcbf2_9ce4_8422_2325, step))
}

pub struct Stamp {
    file: PathBuf,
    text: String,
}

impl Stamp {
    pub fn new(file: PathBuf, text: String) -> Self {
        Self { file, text }
    }

    pub fn is_fresh(&self) -> bool {
        std::fs::read_to_string(&self.file).is_ok_and(|text| text == self.text)
    }

    /// Call before the build: an interrupted run must not look finished.
    pub fn remove(&self) -> Result<(), String> {
        match std::fs::remove_file(&self.file) {
            Err(error) if error.kind() != std::io::ErrorKind::NotFound => Err(self.complaint(&error)),
            _ => Ok(()),
        }
    }

    /// Call after the build.
    pub fn write(&self) -> Result<(), String> {
        std::fs::write(&self.file, &self.text).map_err(|error| self.complaint(&error))
    }

    fn complaint(&self, error: &std::io::Error) -> String {
        format!("{}: {error}", self.file.display())
    }
}

#[cfg(test)]
mod tests {
    use super::Stamp;

    #[test]
    fn fresh_after_writing_the_same_text_only() -> Result<(), String> {
        let file = std::env::temp_dir().join(format!("mozzi-stamp-{}", std::process::id()));
        let stamp = Stamp::new(file.clone(), "one".into());
        stamp.remove()?;
        assert!(!stamp.is_fresh());
        stamp.write()?;
        assert!(stamp.is_fresh());
        assert!(!Stamp::new(file, "two".into()).is_fresh());
        stamp.remove()
    }
}
