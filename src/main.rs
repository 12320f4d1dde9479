//! The program `corpuscle`.

fn main() -> std::process::ExitCode {
    corpuscle::cli::main()
}
