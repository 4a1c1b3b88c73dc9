//! What only the whole set shows: signs, magnitudes, whether its errors can be known.

pub(crate) mod agreement;
pub(crate) mod confounded;
pub(crate) mod contradicted;
pub(crate) mod contradictions;
pub(crate) mod magnitudes;
pub(crate) mod ranges;
pub(crate) mod signs;

use crate::contradiction::Contradiction;
use crate::document::Document;
use crate::table::findings::Findings;
use crate::{Kind, MeasurementSet};

impl MeasurementSet {
    /// Whether the set states the error of any number that it compares: of readings, if it has
    /// trajectories, else of scalars.
    pub fn states_errors(&self) -> bool {
        match self.kind {
            Kind::Scalar => {
                let stated = &self.stated;
                [stated.stop_time, stated.final_z, stated.final_x].iter().any(Option::is_some)
            }
            Kind::Trajectory => {
                let mut frames = self.runs.iter().flat_map(|run| &run.frames);
                let one = frames.any(|frame| frame.sigma.is_some());
                self.instrument.position_sigma.is_some() || one
            }
            _ => self.kind.curve().is_some_and(|curve| curve.has_stated_errors(self)),
        }
    }
}

/// Checks a set whose tables were read; faults are reported. Gives the magnitudes that no impact has.
pub(crate) fn check(
    set: &MeasurementSet,
    document: &Document,
    findings: &mut Findings,
) -> Vec<Contradiction> {
    ranges::check(set, &document.places, findings);
    if findings.errors() > 0 {
        return Vec::new();
    }
    let written = (&document.places[..], &document.files.format.columns);
    let contradictions = match set.kind.curve() {
        Some(curve) => (curve.check)(set, written, findings),
        None => {
            signs::check(set, written, findings);
            let contradictions = magnitudes::check(set, &document.places, findings);
            // In another unit everything contradicts everything.
            if contradictions.is_empty() {
                contradicted::check(set, &document.places, findings);
            }
            contradictions
        }
    };
    if !document.is_exported {
        confounded::note(set, findings);
        note_errors(set, findings);
        note_late_starts(set, findings);
    }
    contradictions
}

/// Without repeats and stated errors there is nothing to weigh a difference with.
fn note_errors(set: &MeasurementSet, findings: &mut Findings) {
    // Every condition has a run.
    let repeated = set.runs.len() > set.conditions.len();
    if !repeated && !set.states_errors() {
        findings.note(
            "No stated errors and no repeats: chi-squared is not possible, differences can be \
             given as rms only."
                .to_owned(),
        );
    }
}

fn note_late_starts(set: &MeasurementSet, findings: &mut Findings) {
    let starts = set.runs.iter().filter_map(|run| run.frames.first()).map(|frame| frame.t);
    let late: Vec<f64> = starts.filter(|t| *t > 0.0).collect();
    if let Some(latest) = late.iter().copied().reduce(f64::max) {
        findings.note(format!(
            "{} of {} runs begin after first contact, the last of them at {latest} s.",
            late.len(),
            set.runs.len()
        ));
    }
}
