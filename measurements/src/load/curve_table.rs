//! Tables of curves: one row for each reading, in long form.

use std::io::BufRead;

use configs::Diagnostic;

use crate::curves::curve::Curve;
use crate::document::Missing;
use crate::load::trajectories::{Readings, Source};
use crate::table::Format;
use crate::table::findings::Findings;
use crate::table::row::Row;
use crate::{Run, Sample};

// The places of the columns of every kind, behind that of runs.
const AT: usize = 1;
const VALUE: usize = 2;
const SIGMA: usize = 3;

/// Reads the readings of `curve` into their runs, after `before` rows of other tables; faults are reported. Gives
/// what is understood of the table, `None` if nothing of it can be read.
pub(crate) fn read(
    curve: &'static Curve,
    source: Source<'_, impl BufRead>,
    runs: &mut [Run],
    (format, missing): (&Format, Missing),
    (before, findings): (&mut usize, &mut Findings),
) -> Option<String> {
    let mut row = Row::default();
    let columns = |_: &Source<'_, _>, is_of_one_run| -> &'static [_] {
        curve.columns[usize::from(is_of_one_run)]
    };
    let known = (&*runs, *before);
    let mut readings = Readings::open(source, columns, known, format, (&mut row, findings))?;
    while let Some(run) = readings.next(&mut row, findings) {
        let columns = [(AT, true), (VALUE, true), (SIGMA, false)];
        let Some([at, value, sigma]) = readings.numbers(columns, &row, findings) else { continue };
        let (Some(run), Some(at), Some(value)) = (run, at, value) else { continue };
        if sigma.is_some_and(|sigma| sigma <= 0.0) {
            let span = readings.table.place(&row, SIGMA, findings);
            let expected = "expected a number above 0; leave it empty if it is not known";
            findings.report(Diagnostic::error("an error that is not above 0").at(span, expected));
        }
        runs[run].samples.push(Sample { at, value, sigma });
    }
    Some(readings.conclude(missing, (before, findings)))
}
