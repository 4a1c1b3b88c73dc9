//! `plunge view`: hands a log to viewers that run in a browser.

mod request;
mod server;

use std::path::{Path, PathBuf};

use exchange::run_files::RunFiles;
use serde_json::json;

use crate::output::{self, CommandError, CommandResult};
use server::{Served, Server};

/// The names under which logs are served, whatever their files are called.
const RUN: &str = "/run.mcap";
const GRAINS: &str = "/grains.mcap";

/// Arguments of `plunge view`.
#[derive(clap::Args, Debug)]
pub(crate) struct Args {
    /// The log of a run, or the folder of one.
    run: PathBuf,
    /// The port on this machine; 0 takes one that is free.
    #[arg(long, default_value_t = 8791)]
    port: u16,
    /// Print one JSON object to stdout.
    #[arg(long)]
    json: bool,
    /// Print nothing.
    #[arg(long)]
    quiet: bool,
}

pub(crate) fn run(args: &Args) -> CommandResult {
    let files = served(&args.run)?;
    let server = Server::start(args.port, files.clone()).map_err(|why| {
        CommandError::bad_input(format!("cannot listen on port {}: {why}; --port", args.port))
    })?;
    let urls: Vec<String> =
        files.iter().map(|file| format!("http://{}{}", server.address(), file.name)).collect();
    if args.json {
        output::json_to_stdout(&json!({ "port": server.address().port(), "urls": urls }))?;
    } else if !args.quiet {
        output::to_stdout(&as_text(&args.run, &files, &urls))?;
    }
    server.serve()
}

/// The logs of `run` that are there.
fn served(run: &Path) -> Result<Vec<Served>, CommandError> {
    let files = RunFiles::of(run);
    if !files.log.is_file() {
        return Err(CommandError::bad_input(format!("{} is not there", files.log.display())));
    }
    let grains = Some((GRAINS, files.grains)).filter(|(_, path)| path.is_file());
    let all = std::iter::once((RUN, files.log)).chain(grains);
    Ok(all.map(|(name, path)| Served { name, path }).collect())
}

fn as_text(run: &Path, files: &[Served], urls: &[String]) -> String {
    let mut text = "Served on this machine until Ctrl-C:\n\n".to_owned();
    for (file, url) in files.iter().zip(urls) {
        text.push_str(&format!("  {url}  {}\n", file.path.display()));
    }
    let (run, url) = (run.display(), &urls[0]);
    text.push_str(&format!(
        "\n  Foxglove     https://app.foxglove.dev/?ds=remote-file&ds.url={url}\n  \
         Lichtblick   the address of its web build, then ?ds=remote-file&ds.url={url}\n\
         \nThese open the files themselves:\n\n  \
         Rerun        python viewers/rerun_impact.py {run}\n  \
         PlotJuggler  File > Load\n  \
         Python       python examples/read_log.py {log}\n\
         \ndocs/output-files.md has what each of them needs.\n",
        log = files[0].path.display()
    ));
    text
}
