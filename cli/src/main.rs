//! The command `nekton`.

fn main() -> std::process::ExitCode {
    nekton_cli::command()
}
