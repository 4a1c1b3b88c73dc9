//! `plunge completions` and `plunge man`, from the definitions that read the arguments.

use std::io::Write as _;
use std::path::{Path, PathBuf};

use anyhow::Context as _;
use clap::Command;
use clap_complete::Shell;
use clap_mangen::Man;

use crate::output::{self, CommandResult};
use crate::workbench::write_whole;

/// Arguments of `plunge completions`.
#[derive(clap::Args, Debug)]
pub(crate) struct CompletionArgs {
    /// The shell.
    shell: Shell,
}

/// Arguments of `plunge man`.
#[derive(clap::Args, Debug)]
pub(crate) struct ManArgs {
    /// The folder to write to, one page per command.
    folder: PathBuf,
}

/// Writes what makes `shell` complete the arguments of `command` to stdout.
pub(crate) fn completions(args: &CompletionArgs, mut command: Command) -> CommandResult {
    let mut text = Vec::new();
    let name = command.get_name().to_owned();
    clap_complete::generate(args.shell, &mut command, name, &mut text);
    output::whole_to_stdout(&String::from_utf8_lossy(&text))
}

/// Writes a manual page of `command` and of each of its own.
pub(crate) fn man(args: &ManArgs, mut command: Command) -> CommandResult {
    let folder = &args.folder;
    std::fs::create_dir_all(folder).with_context(|| format!("cannot make {}", folder.display()))?;
    command.build();
    let name = command.get_name().to_owned();
    let mut pages = vec![page(&command, &name, folder)?];
    for one in command.get_subcommands().filter(|one| one.get_name() != "help") {
        pages.push(page(one, &format!("{name}-{}", one.get_name()), folder)?);
    }
    output::to_stdout(&format!("{} manual pages -> {}\n", pages.len(), folder.display()))
}

fn page(command: &Command, name: &str, folder: &Path) -> Result<PathBuf, output::CommandError> {
    let mut text = Vec::new();
    Man::new(command.clone())
        .title(name)
        .render(&mut text)
        .and_then(|()| text.flush())
        .with_context(|| format!("cannot describe {name}"))?;
    let path = folder.join(format!("{name}.1"));
    write_whole(&path, &String::from_utf8_lossy(&text))?;
    Ok(path)
}
