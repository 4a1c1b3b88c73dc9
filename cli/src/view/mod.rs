//! `plunge view`: hands a log to viewers that run in a browser, and shows the page and the messages of a run while it
//! goes on.

mod live;
mod request;
mod server;
mod stream;

use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::thread;

use exchange::run_files::RunFiles;
use serde_json::json;

use crate::output::{self, CommandError, CommandResult};
use live::{LivePage, PAGE};
use server::{Content, LAYOUT, Served, Server};

/// The names under which logs are served, whatever their files are called.
const RUN: &str = "/run.mcap";
const GRAINS: &str = "/grains.mcap";

/// Arguments of `plunge view`.
#[derive(clap::Args, Debug)]
pub(crate) struct Args {
    /// The log of a run, or the folder of one, which may go on.
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
    let server = start(args.port, &args.run, files.clone())?;
    let urls: Vec<String> =
        files.iter().map(|file| format!("http://{}{}", server.address(), file.name)).collect();
    if args.json {
        output::json_to_stdout(&json!({
            "port": server.address().port(),
            "urls": urls,
            "page": page(&server),
            "stream": stream(&server),
            "layout": layout(&server),
        }))?;
    } else if !args.quiet {
        output::to_stdout(&as_text(&args.run, &files, &urls, &server))?;
    }
    server.serve()
}

/// Shows the page of a run to a browser while the run goes on.
pub(crate) struct Live {
    content: Arc<Content>,
}

impl Live {
    /// Of the run that is written to `out`; says where, unless it is to be `quiet`.
    pub(crate) fn start(port: u16, out: &Path, quiet: bool) -> Result<Self, CommandError> {
        let server = start(port, out, Vec::new())?;
        if !quiet {
            output::to_stderr(&format!(
                "live: {}\n      {} (Foxglove, Lichtblick)\n",
                page(&server),
                stream(&server)
            ));
        }
        let content = server.content();
        let serve = move || server.serve();
        let thread = thread::Builder::new().name("live".to_owned()).spawn(serve);
        thread.map_err(|error| CommandError::Failed(error.into()))?;
        Ok(Self { content })
    }

    /// Lets a browser that follows the run have its last page.
    pub(crate) fn end(&self) {
        self.content.page.let_it_end();
    }
}

fn start(port: u16, run: &Path, files: Vec<Served>) -> Result<Server, CommandError> {
    let content = Arc::new(Content { files, run: run.to_owned(), page: LivePage::of(run) });
    Server::start(port, content).map_err(|why| {
        CommandError::bad_input(format!("cannot listen on port {port}: {why}; choose another"))
    })
}

fn page(server: &Server) -> String {
    format!("http://{}{PAGE}", server.address())
}

/// Where a viewer has its layout.
fn layout(server: &Server) -> String {
    format!("http://{}{LAYOUT}", server.address())
}

/// Where a viewer has the messages of the run.
fn stream(server: &Server) -> String {
    format!("ws://{}", server.address())
}

/// The logs of `run`. Those of one that goes on are served when it has ended: viewers read the index first, which
/// stands at the end of a log.
fn served(run: &Path) -> Result<Vec<Served>, CommandError> {
    let (files, so_far) = (RunFiles::of(run), RunFiles::so_far(run));
    if !so_far.log.is_file() {
        return Err(CommandError::bad_input(format!("{} is not there", files.log.display())));
    }
    let grains = so_far.grains.is_file().then_some((GRAINS, files.grains));
    let all = std::iter::once((RUN, files.log)).chain(grains);
    Ok(all.map(|(name, path)| Served { name, path }).collect())
}

fn as_text(run: &Path, files: &[Served], urls: &[String], server: &Server) -> String {
    let mut text = "Served on this machine until Ctrl-C:\n\n".to_owned();
    let (page, stream) = (page(server), stream(server));
    text.push_str(&format!("  {page}  its page, anew as it goes on\n"));
    text.push_str(&format!("  {stream}  its messages from the start, as it goes on\n"));
    for (file, url) in files.iter().zip(urls) {
        text.push_str(&format!("  {url}  {}\n", file.path.display()));
    }
    let (log, url) = (&files[0].path, &urls[0]);
    if !log.is_file() {
        let partial = RunFiles::of(run).partial().log;
        text.push_str(&format!(
            "\nThe run has not ended; its logs are there when it has. What viewers can read now:\n\n  \
             plunge recover {} now.mcap\n",
            partial.display()
        ));
    }
    text.push_str(&format!(
        "\n  Foxglove     https://app.foxglove.dev/?ds=remote-file&ds.url={url}\n  \
         Lichtblick   the address of its web build, then ?ds=remote-file{every}&layoutUrl={layout}\n  \
         both         likewise with ?ds=foxglove-websocket&ds.url={stream}\n\
         \nFoxglove imports its layout: {layout}, or from `plunge new viewers`. These open the files themselves:\n\n  \
         Rerun        python viewers/rerun_impact.py {run}    (`plunge new viewers`)\n  \
         PlotJuggler  File > Load\n  \
         Python       python scripts/read_log.py {log}    (`plunge new scripts`)\n",
        layout = layout(server),
        every = urls.iter().map(|url| format!("&ds.url={url}")).collect::<String>(),
        run = run.display(),
        log = log.display()
    ));
    text
}
