//! One comparison of a row: what was published, what came out, the band between them and the verdict.

use std::fmt;

use serde::Serialize;

/// Standard errors by which a sign or a difference counts, and by which a deviation may be explained.
pub const SIGMAS: f64 = 2.0;

/// What became of a comparison, or of a row: of several, the last in this order decides.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Verdict {
    /// The source does not give the numbers, or they are lost.
    NotPublished,
    /// The source has what plunge does not model.
    NotModelled,
    /// Plunge can run it, and it was not run.
    NotRun,
    /// Within the band, or the trend holds.
    Pass,
    /// The impacts that were run allow either answer ([`Check::undecided_if`]).
    Undecided,
    /// Outside of the band, by a cause and an amount that a source stated before the comparison.
    Deviates,
    /// Outside of the band.
    Fail,
}

impl Verdict {
    /// Every verdict on what could be held against something, then those on what could not.
    pub const ALL: [Self; 7] = [
        Self::Pass,
        Self::Undecided,
        Self::Deviates,
        Self::Fail,
        Self::NotPublished,
        Self::NotModelled,
        Self::NotRun,
    ];

    /// Its name, as `validation.json` and the command line have it.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::NotPublished => "not-published",
            Self::NotModelled => "not-modelled",
            Self::NotRun => "not-run",
            Self::Pass => "pass",
            Self::Undecided => "undecided",
            Self::Deviates => "deviates",
            Self::Fail => "fail",
        }
    }
}

impl fmt::Display for Verdict {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.pad(self.name())
    }
}

/// A number with its standard error, both in the unit that the check names.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Estimate {
    /// The number.
    pub value: f64,
    /// Its standard error or scatter; 0 where none is known.
    pub error: f64,
}

impl Estimate {
    /// A number and its standard error.
    pub fn new(value: f64, error: f64) -> Self {
        Self { value, error }
    }

    /// Both times `factor`.
    #[must_use]
    pub fn times(self, factor: f64) -> Self {
        Self { value: factor * self.value, error: factor.abs() * self.error }
    }
}

impl fmt::Display for Estimate {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        // Two digits of the error, and as many of the value; four digits where there is no error.
        let size = if self.error > 0.0 { 0.1 * self.error } else { 1e-3 * self.value.abs() };
        let digits =
            if size > 0.0 && size.is_finite() { -libm::floor(libm::log10(size)) } else { 1.0 };
        let digits = digits.clamp(0.0, 9.0) as usize;
        if self.error > 0.0 {
            return write!(f, "{:.digits$} ± {:.digits$}", self.value, self.error);
        }
        write!(f, "{:.digits$}", self.value)
    }
}

/// One side of a comparison.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[serde(untagged)]
pub enum Side {
    /// A number.
    Number(Estimate),
    /// What is stated or seen, in words.
    Words(String),
}

impl fmt::Display for Side {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Number(estimate) => write!(f, "{estimate}"),
            Self::Words(words) => f.write_str(words),
        }
    }
}

/// How far from a published number is still right, and why.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Band {
    /// Half its width, in the unit of the check.
    pub half: f64,
    /// Where it comes from.
    pub reason: &'static str,
}

/// A disagreement that was known before the comparison: its cause, and how large it was.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Known {
    /// Least and greatest of ours over the published number.
    pub ratio: [f64; 2],
    /// Why.
    pub cause: &'static str,
}

impl Known {
    /// Whether it covers ours being `ratio` times the published number, which is known to within `margin`.
    pub fn covers(&self, ratio: f64, margin: f64) -> bool {
        ratio + margin >= self.ratio[0] && ratio - margin <= self.ratio[1]
    }
}

/// Half a band, endless where it is not known: without any freedom left, an infinite factor times an error of nought is
/// not a number.
pub fn or_endless(half: f64) -> f64 {
    if half.is_nan() { f64::INFINITY } else { half }
}

/// One comparison.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Check {
    /// What is compared, with its unit.
    pub what: String,
    /// What the source has.
    pub published: Side,
    /// What came out here.
    pub ours: Side,
    /// The band and its reason; of a trend, what decides.
    pub band: String,
    /// The verdict.
    pub verdict: Verdict,
    /// The cause of a deviation, or why there is no answer; may be empty.
    pub cause: String,
}

/// Why a check is undecided.
const TOO_FEW: &str = "the scatter of the impacts that were run allows either";

impl Check {
    /// A number that has to come out as published within `band`; undecided where zero would pass as well.
    pub fn number(
        what: impl Into<String>,
        published: Estimate,
        ours: Estimate,
        band: Band,
    ) -> Self {
        let band = Band { half: or_endless(band.half), ..band };
        let within = (ours.value - published.value).abs() <= band.half;
        let half = Estimate::new(band.half, 0.0);
        let check = Self {
            what: what.into(),
            published: Side::Number(published),
            ours: Side::Number(ours),
            band: format!("± {half}: {}", band.reason),
            verdict: if within { Verdict::Pass } else { Verdict::Fail },
            cause: String::new(),
        };
        check.undecided_if(within && published.value.abs() <= band.half)
    }

    /// A mean deviation from a curve, to which the scatter of ours alone adds up to `by_scatter`
    /// ([`regression::deviation_by_scatter`](super::regression::deviation_by_scatter)): it passes within `band`, and
    /// fails where that scatter does not explain what is beyond; between, it is undecided.
    pub fn deviation(
        what: impl Into<String>,
        published: impl Into<String>,
        ours: Estimate,
        by_scatter: f64,
        band: Band,
    ) -> Self {
        let (excess, by_scatter) = (ours.value - band.half, or_endless(by_scatter));
        Self::at_most(what, published, ours, band)
            .undecided_if(excess > 0.0 && excess <= by_scatter)
    }

    /// A number that must not be greater than `band` is wide.
    pub fn at_most(
        what: impl Into<String>,
        published: impl Into<String>,
        ours: Estimate,
        band: Band,
    ) -> Self {
        let limit = Estimate::new(band.half, 0.0);
        Self {
            what: what.into(),
            published: Side::Words(published.into()),
            ours: Side::Number(ours),
            band: format!("at most {limit}: {}", band.reason),
            verdict: if ours.value <= band.half { Verdict::Pass } else { Verdict::Fail },
            cause: String::new(),
        }
    }

    /// A number of ours against words of the source; `band` says what decides.
    fn in_words(
        what: impl Into<String>,
        published: impl Into<String>,
        ours: Estimate,
        band: String,
        passes: bool,
    ) -> Self {
        Self {
            what: what.into(),
            published: Side::Words(published.into()),
            ours: Side::Number(ours),
            band,
            verdict: if passes { Verdict::Pass } else { Verdict::Fail },
            cause: String::new(),
        }
    }

    /// A number that the source has positive, known to within `band`: it passes where it is positive all through the band and
    /// fails where it is negative all through it; between, it is undecided.
    pub fn positive(
        what: impl Into<String>,
        published: impl Into<String>,
        ours: Estimate,
        band: Band,
    ) -> Self {
        let band = Band { half: or_endless(band.half), ..band };
        let half = Estimate::new(band.half, 0.0);
        let decides = format!("positive by {half}: {}", band.reason);
        let check = Self::in_words(what, published, ours, decides, ours.value > band.half);
        check.undecided_if(ours.value.abs() <= band.half)
    }

    /// A number that the source has zero, known to within `band`: it fails beyond. Within, it passes where the band does
    /// not reach `contrary`, the least number that contradicts the source's words; it is undecided where it does.
    pub fn zero(
        what: impl Into<String>,
        published: impl Into<String>,
        ours: Estimate,
        band: Band,
        contrary: f64,
    ) -> Self {
        let band = Band { half: or_endless(band.half), ..band };
        let half = Estimate::new(band.half, 0.0);
        let decides = format!("zero to {half}: {}", band.reason);
        let check = Self::in_words(what, published, ours, decides, ours.value.abs() <= band.half);
        let within = check.verdict == Verdict::Pass;
        check.undecided_if(within && band.half >= contrary.abs())
    }

    /// A statement that `holds` or does not, as `ours` shows by the test `decided`.
    pub fn trend(
        what: impl Into<String>,
        (published, ours): (&str, String),
        decided: &str,
        holds: bool,
    ) -> Self {
        Self {
            what: what.into(),
            published: Side::Words(published.to_owned()),
            ours: Side::Words(ours),
            band: decided.to_owned(),
            verdict: if holds { Verdict::Pass } else { Verdict::Fail },
            cause: String::new(),
        }
    }

    /// What has no answer, with the `verdict` that says of what kind, and `why`.
    pub fn unanswered(
        what: impl Into<String>,
        published: &str,
        verdict: Verdict,
        why: &str,
    ) -> Self {
        Self {
            what: what.into(),
            published: Side::Words(published.to_owned()),
            ours: Side::Words("–".to_owned()),
            band: "–".to_owned(),
            verdict,
            cause: why.to_owned(),
        }
    }

    /// What the source does not give, or what of it is lost.
    pub fn not_published(what: impl Into<String>, published: &str, why: &str) -> Self {
        Self::unanswered(what, published, Verdict::NotPublished, why)
    }

    /// What there are too few impacts for.
    pub fn undecided(what: impl Into<String>, published: &str, why: &str) -> Self {
        Self::unanswered(what, published, Verdict::Undecided, why)
    }

    /// The same, neither passed nor failed where the impacts allow `either`.
    #[must_use]
    pub fn undecided_if(mut self, either: bool) -> Self {
        if either {
            self.verdict = Verdict::Undecided;
            self.cause = TOO_FEW.to_owned();
        }
        self
    }

    /// A failure turns into a deviation with a cause that a source stated beforehand, where `is_known`. An earlier run of
    /// plunge is no source.
    #[must_use]
    pub fn listed(mut self, is_known: bool, cause: &str) -> Self {
        if self.verdict == Verdict::Fail && is_known {
            self.verdict = Verdict::Deviates;
            self.cause = cause.to_owned();
        }
        self
    }

    /// Likewise where ours over the published number is a `ratio` that `known` covers within a `margin`.
    #[must_use]
    pub fn unless_known(self, known: Option<&Known>, (ratio, margin): (f64, f64)) -> Self {
        match known {
            Some(known) => self.listed(known.covers(ratio, margin), known.cause),
            None => self,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn of_several_verdicts_failing_is_worst_and_undecided_is_worse_than_a_pass() {
        use Verdict::{Deviates, Fail, NotModelled, NotPublished, NotRun, Pass, Undecided};
        let worst = |of: &[Verdict]| of.iter().max().copied();
        assert_eq!(worst(&[Pass, Undecided, Deviates, Fail]), Some(Fail));
        assert_eq!(worst(&[Pass, Undecided, Deviates]), Some(Deviates));
        assert_eq!(worst(&[Pass, Undecided, Pass]), Some(Undecided));
        // What has no answer stands apart: it does not make a pass of a row that has none, nor lower one.
        assert_eq!(worst(&[NotPublished, NotModelled, NotRun, Pass]), Some(Pass));
        assert_eq!(worst(&[NotPublished, NotRun]), Some(NotRun));
    }

    const BAND: Band = Band { half: 0.1, reason: "a test" };
    const KNOWN: Known = Known { ratio: [1.1, 1.3], cause: "the source says so" };

    fn compared(ours: f64) -> Check {
        Check::number("depth (m)", Estimate::new(1.0, 0.0), Estimate::new(ours, 0.0), BAND)
    }

    #[test]
    fn only_what_was_listed_beforehand_deviates_and_the_rest_fails() {
        let within =
            |ours, margin| compared(ours).unless_known(Some(&KNOWN), (ours, margin)).verdict;
        let verdict = |ours| within(ours, 0.0);
        assert_eq!(verdict(1.05), Verdict::Pass);
        assert_eq!(verdict(1.2), Verdict::Deviates);
        assert_eq!(verdict(1.4), Verdict::Fail);
        assert_eq!(verdict(0.8), Verdict::Fail);
        // An error of ours that reaches what was listed.
        assert_eq!(within(1.35, 0.06), Verdict::Deviates);
        assert_eq!(within(1.35, 0.04), Verdict::Fail);
        assert_eq!(compared(1.2).unless_known(None, (1.2, 0.0)).verdict, Verdict::Fail);
    }

    #[test]
    fn a_number_that_might_as_well_be_zero_is_undecided_and_one_beyond_its_band_still_fails() {
        let verdict = |ours: f64, half: f64| {
            let check = Check::number(
                "",
                Estimate::new(1.0, 0.0),
                Estimate::new(ours, 0.0),
                Band { half, reason: "a test" },
            );
            check.verdict
        };
        assert_eq!(verdict(1.5, 0.9), Verdict::Pass);
        assert_eq!(verdict(1.5, 1.1), Verdict::Undecided);
        assert_eq!(verdict(2.5, 1.1), Verdict::Fail);
    }

    #[test]
    fn a_deviation_fails_only_by_more_than_the_scatter_of_ours_explains() {
        let verdict = |ours| Check::deviation("", "", Estimate::new(ours, 0.0), 0.05, BAND).verdict;
        assert_eq!(verdict(0.09), Verdict::Pass);
        assert_eq!(verdict(0.14), Verdict::Undecided);
        assert_eq!(verdict(0.16), Verdict::Fail);
        assert_eq!(verdict(f64::NAN), Verdict::Fail);
    }

    #[test]
    fn what_is_not_a_number_fails() {
        assert_eq!(compared(f64::NAN).verdict, Verdict::Fail);
        let none = Check::at_most("", "", Estimate::new(f64::NAN, 0.0), BAND);
        assert_eq!(none.verdict, Verdict::Fail);
    }

    #[test]
    fn a_sign_is_decided_only_beyond_the_band() {
        let verdict = |value: f64| Check::positive("", "", Estimate::new(value, 0.0), BAND).verdict;
        assert_eq!(verdict(0.11), Verdict::Pass);
        assert_eq!(verdict(0.09), Verdict::Undecided);
        assert_eq!(verdict(-0.09), Verdict::Undecided);
        assert_eq!(verdict(-0.11), Verdict::Fail);
        assert_eq!(verdict(f64::NAN), Verdict::Fail);
    }

    #[test]
    fn zero_is_decided_only_where_the_band_is_narrower_than_what_contradicts_it() {
        let verdict = |value: f64, contrary: f64| {
            Check::zero("", "", Estimate::new(value, 0.0), BAND, contrary).verdict
        };
        assert_eq!(verdict(0.05, 1.0), Verdict::Pass);
        assert_eq!(verdict(0.05, 0.1), Verdict::Undecided);
        assert_eq!(verdict(-0.11, 1.0), Verdict::Fail);
        assert_eq!(verdict(0.11, 0.1), Verdict::Fail);
        assert_eq!(verdict(f64::NAN, 1.0), Verdict::Fail);
    }

    #[test]
    fn a_number_is_shown_with_two_digits_of_its_error() {
        assert_eq!(Estimate::new(0.123_456, 0.0123).to_string(), "0.123 ± 0.012");
        assert_eq!(Estimate::new(12.3456, 0.0).to_string(), "12.35");
        assert_eq!(Estimate::new(0.0, 0.0).to_string(), "0.0");
    }
}
