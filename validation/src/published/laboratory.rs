//! Where the rows get their impacts from.

use std::path::PathBuf;

use runner::CampaignError;
use runner::beds::{Impacts, Job, Place, Record};

use crate::three_shapes;

/// How much is run.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Effort {
    /// Every row at a reduced cost: minutes, with beds that are there.
    Quick,
    /// What the sources ran: hours.
    Full,
}

/// What becomes of impacts that are not kept yet.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Missing {
    /// They are run.
    Run,
    /// They are left out: rows are judged by those that are there.
    LeaveOut,
}

/// What the rows are judged with.
#[derive(Clone)]
pub struct Laboratory<'a> {
    /// How much is run.
    pub effort: Effort,
    /// What becomes of impacts that are not kept yet.
    pub missing: Missing,
    /// Where impacts on beds of grains are run and kept: what is there is not run again.
    pub place: Place<'a>,
    /// Where the impacts of three shapes are kept, likewise.
    pub shapes: three_shapes::Places,
    /// The folder of measurement sets.
    pub sets: PathBuf,
}

impl Laboratory<'_> {
    /// The records of `jobs`, in their order: run now where they are not kept, or left out. None of an impact whose
    /// steps cannot be trusted.
    pub fn impacts(&self, jobs: &[Job]) -> Result<Vec<Option<Record>>, CampaignError> {
        match self.missing {
            Missing::Run => self.place.run(jobs),
            Missing::LeaveOut => self.place.kept(jobs),
        }
    }

    /// The first of a pair when quick, else the second.
    pub fn quick_or_full<T>(&self, quick: T, full: T) -> T {
        match self.effort {
            Effort::Quick => quick,
            Effort::Full => full,
        }
    }
}
