//! `cargo xtask lint`: every check that does not run the engine.

use std::process::{Command, ExitCode, Stdio};

use anyhow::Result;
use xshell::{Cmd, Shell, cmd};

use crate::tidy;

/// What installs the tools that are no part of Rust, by their versions.
const REQUIREMENTS: &str = ".ci/lint-requirements.txt";

/// Runs all checks, also after one has failed, and ends with the list of those that failed.
pub(crate) fn run(sh: &Shell) -> Result<ExitCode> {
    let mut failed = Vec::new();
    let checks = [
        ("fmt", cmd!(sh, "cargo fmt --all --check")),
        ("clippy", cmd!(sh, "cargo clippy --workspace --all-targets --locked -- --deny warnings")),
        (
            "doc",
            cmd!(sh, "cargo doc --workspace --no-deps --locked")
                .env("RUSTDOCFLAGS", "--deny warnings"),
        ),
    ];
    for (name, check) in checks {
        if !passes(name, check) {
            failed.push(name);
        }
    }

    heading("tidy");
    if tidy::run(sh)? != ExitCode::SUCCESS {
        failed.push("tidy");
    }

    let tools = [
        (
            "cargo-deny",
            cmd!(sh, "cargo-deny --version"),
            cmd!(sh, "cargo-deny --locked check bans licenses sources"),
        ),
        ("typos", cmd!(sh, "typos --version"), cmd!(sh, "typos")),
        // Models, sets and campaigns against their schemas; `.taplo.toml` lists them.
        ("taplo", cmd!(sh, "taplo --version"), cmd!(sh, "taplo lint")),
    ];
    for (name, version, check) in tools {
        if !is_installed(version) {
            heading(name);
            eprintln!("{name} is not on the path: `pip install -r {REQUIREMENTS}` installs it");
            failed.push(name);
        } else if !passes(name, check) {
            failed.push(name);
        }
    }

    if failed.is_empty() {
        return Ok(ExitCode::SUCCESS);
    }
    eprintln!("\nlint: {} failed", failed.join(", "));
    Ok(ExitCode::FAILURE)
}

fn heading(name: &str) {
    eprintln!("== {name}");
}

fn passes(name: &str, check: Cmd<'_>) -> bool {
    heading(name);
    check.quiet().run().inspect_err(|error| eprintln!("{error}")).is_ok()
}

fn is_installed(version: Cmd<'_>) -> bool {
    let mut command = Command::from(version);
    command.stdin(Stdio::null()).stdout(Stdio::null()).stderr(Stdio::null());
    command.status().is_ok_and(|status| status.success())
}
