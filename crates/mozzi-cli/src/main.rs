//! The program; it is a library so that tests and fuzz targets reach what reads files and requests.

fn main() -> std::process::ExitCode {
    mozzi_cli::main()
}
