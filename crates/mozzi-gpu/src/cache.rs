//! Compiled kernels in a folder, for later processes.

use crate::binary::{Binary, Resources};
use std::path::PathBuf;

/// The inputs that determine a kernel's code.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
pub(crate) struct Key {
    pub text: String,
    pub entry: String,
    pub arch: crate::Arch,
    pub options: Vec<String>,
}

/// The first bytes of a file, with the number of its format.
const MAGIC: &[u8; 8] = b"mozzi\0g1";

impl Key {
    /// All of it, as text.
    fn content(&self) -> String {
        format!("{} {} {}\n{}", self.arch, self.entry, self.options.join(" "), self.text)
    }

    /// The file in the folder that the variable `MOZZI_GPU_CACHE` names.
    fn file(&self) -> Option<PathBuf> {
        let folder = std::env::var_os("MOZZI_GPU_CACHE").filter(|folder| !folder.is_empty())?;
        // 64-bit FNV-1a; the file has the whole content, which is compared
        let step = |hash: u64, byte: u8| (hash ^ u64::from(byte)).wrapping_mul(0x0100_0000_01b3);
        let hash = self.content().bytes().fold(0xcbf2_9ce4_8422_2325, step);
        Some(PathBuf::from(folder).join(format!("{}-{hash:016x}.kernel", self.entry)))
    }

    /// The code of an earlier process; `None` if there is none of exactly this content.
    pub fn read(&self) -> Option<Binary> {
        self.parse(&std::fs::read(self.file()?).ok()?)
    }

    /// Stores the code, if there is a folder. A file that cannot be written is left out: it would only have saved time.
    pub fn write(&self, binary: &Binary) {
        let Some(file) = self.file() else { return };
        let part = file.with_extension(format!("{}.part", std::process::id()));
        let folder = file.parent().map_or(Ok(()), std::fs::create_dir_all);
        let written = folder.and_then(|()| std::fs::write(&part, self.bytes(binary)));
        if written.and_then(|()| std::fs::rename(&part, &file)).is_err() {
            let _ = std::fs::remove_file(&part);
        }
    }

    fn bytes(&self, binary: &Binary) -> Vec<u8> {
        let (content, r) = (self.content(), binary.resources.unwrap_or_default()); // 0 registers if not known
        let counts = [r.registers, r.stack_bytes, r.spill_stores, r.spill_loads, r.shared_bytes, content.len()];
        let mut bytes = MAGIC.to_vec();
        counts.iter().for_each(|&count| bytes.extend((count as u64).to_le_bytes()));
        bytes.extend(content.as_bytes());
        bytes.extend(&binary.code);
        bytes
    }

    fn parse(&self, bytes: &[u8]) -> Option<Binary> {
        let (counts, rest) = bytes.strip_prefix(MAGIC)?.split_at_checked(48)?;
        let counts = counts.as_chunks().0.iter().map(|count| usize::try_from(u64::from_le_bytes(*count)).ok());
        let counts: Vec<usize> = counts.collect::<Option<_>>()?;
        let [registers, stack_bytes, spill_stores, spill_loads, shared_bytes, length] = counts[..] else { return None };
        let (content, code) = rest.split_at_checked(length)?;
        let resources = Resources { registers, stack_bytes, spill_stores, spill_loads, shared_bytes };
        let is_same = content == self.content().as_bytes() && code.starts_with(b"\x7fELF");
        let resources = (registers > 0).then_some(resources);
        is_same.then(|| Binary { code: code.to_vec(), entry: self.entry.clone(), arch: self.arch, resources })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Arch;

    #[test]
    fn a_file_is_read_for_the_same_content_only() {
        let key = |text: &str| Key {
            text: text.to_string(),
            entry: "f_rows".to_string(),
            arch: Arch::SM_90,
            options: vec!["-DX".to_string()],
        };
        let resources = Some(Resources { registers: 64, spill_loads: 8, shared_bytes: 1024, ..Resources::default() });
        let code = b"\x7fELF and more".to_vec();
        let binary = Binary { code: code.clone(), entry: "f_rows".to_string(), arch: Arch::SM_90, resources };
        let bytes = key("one").bytes(&binary);
        let found = key("one").parse(&bytes).expect("the same");
        assert_eq!((found.code, found.resources), (code, resources));
        let unknown = key("one").bytes(&Binary { resources: None, ..binary });
        assert_eq!(key("one").parse(&unknown).expect("the same").resources, None);
        assert!(key("two").parse(&bytes).is_none());
        assert!(Key { options: Vec::new(), ..key("one") }.parse(&bytes).is_none());
        for length in 0..bytes.len() - 13 {
            assert!(key("one").parse(&bytes[..length]).is_none(), "{length} bytes");
        }
    }
}
