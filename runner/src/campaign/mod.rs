//! Campaigns: many impacts that are planned first, run side by side, and read together.
//!
//! A [`Plan`] lists every point of a campaign file ([`mod@file`]): a model, what is set in it, and the hash of what
//! comes out, by which its folder is called. A [`Folder`] keeps the plan, which never changes, and beside
//! it a folder per point; what is done there has a `done.json`, renamed into place last. [`run`] does what
//! is not done, so that a campaign that was killed goes on with the same command; [`submit`] has other
//! machines do it. [`Results`] reads what there is, at any time.

mod done;
pub mod file;
mod folder;
pub mod pace;
mod plan;
mod results;
mod run;
mod sampling;
mod scheduler;
mod table;

pub use done::{Cost, Done, Headline, Status};
pub use folder::{Folder, FolderError, Held, PLAN, POINTS_FOLDER};
pub use plan::{Need, Plan, Planned, Point, split};
pub use results::{Counts, Outcome, Results};
pub use run::SweepError;
pub use run::{run, run_one};
pub use scheduler::{SCRIPT, SubmitError, Task, submit};
pub use table::{Cells, FILE as TABLE, TableColumn, Values, Varied, columns, varied};
