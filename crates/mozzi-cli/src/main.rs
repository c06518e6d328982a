//! The program; it is a library so that tests and fuzz targets can call the readers of files and requests.

fn main() -> std::process::ExitCode {
    mozzi_cli::main()
}
