//! The `lrp` binary: all of it is in the library.

fn main() -> std::process::ExitCode {
    lrp::cli::main()
}
