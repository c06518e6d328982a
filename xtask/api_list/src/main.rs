//! Prints the public items of each crate whose rustdoc JSON is given: FILE… OUT, into OUT/CRATE.txt. Implementations of
//! blanket, automatic and derived traits are left out.

use public_api::Builder;
use std::error::Error;
use std::path::Path;

fn main() -> Result<(), Box<dyn Error>> {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let (folder, files) = arguments.split_last().ok_or("FILE… OUT")?;
    for file in files {
        let builder = Builder::from_rustdoc_json(file).omit_blanket_impls(true).omit_auto_trait_impls(true);
        let api = builder.omit_auto_derived_impls(true).build()?;
        let lines: String = api.items().map(|item| format!("{item}\n")).collect();
        let name = Path::new(file).file_stem().ok_or("no file name")?;
        std::fs::write(Path::new(folder).join(name).with_extension("txt"), lines)?;
    }
    Ok(())
}
