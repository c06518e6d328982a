//! The pages of the documentation that contain Rust, run with the documentation's tests: here, where all of their crates
//! are known. `cargo xtask book --code` runs the other languages and requires each page of `book/src` to be listed.

macro_rules! pages {
    ($($name:ident $file:literal)*) => {
        $(#[doc = include_str!($file)] struct $name;)*
    };
}

pages! {
    Readme "../../README.md"
    Rust "../../docs/rust.md"
    Homework "../../book/src/learn/homework.md"
    Legged "../../book/src/use/legged.md"
    Million "../../book/src/use/million.md"
    Play "../../book/src/use/play.md"
}
