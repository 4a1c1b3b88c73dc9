//! How much a verdict rests on, in words of the results.

use serde::Serialize;

/// What a verdict rests on.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Strength {
    /// The scatter of repeats, amplitudes that one would expect, and better predictions of what was not fitted to.
    Confirmed,
    /// Less than that: each [`StrengthReason`] says what is missing.
    Suggested,
}

/// Why a verdict is only suggested.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum StrengthReason {
    /// Errors are stated and not seen in repeats.
    StatedErrors,
    /// Nothing was repeated, and the scatter from run to run is assumed.
    AssumedScatter,
    /// The repeats give fewer than eight independent deviations, so that the scatter is known to no better than a
    /// quarter.
    FewRepeats,
    /// What was held out is not predicted better by more than chance.
    HeldOutNoBetter,
    /// Held-out conditions are missed by more than the scatter of their repeats, though nothing is found: conditions
    /// differ by more than their runs do.
    HeldOutAboveNoise,
    /// The model is rejected unless conditions differ by more than their repeats show, as beds that are poured anew.
    ConditionsDiffer,
    /// Nothing that was held out could be predicted both without and with what is named.
    HeldOutNotJudged,
    /// What is named cannot predict a condition that the model without it predicts.
    ConditionsNotPredicted,
    /// An amplitude of what is named lies outside of the usual range of its effect, by more than two standard errors.
    AmplitudeOutsideUsualRange,
    /// The fit with what is named moves an error of the apparatus by more than four standard deviations of what is known
    /// of it.
    ApparatusFarFromStated,
    /// Something is left over beside what is named: it is of another form than its formula, or there is more.
    OfAnotherForm,
    /// The best of the listed effects explains the data, and a force of another form is about as likely.
    NoLikelierThanAnyForce,
    /// The plan of impacts was too small to confirm anything.
    SmallPlan,
    /// Half of the effects or more could not be tested, and so are not excluded.
    FewTested,
    /// Impacts with it, on fresh beds, are no nearer to what was held out.
    FreshBedsNoNearer,
}

impl Strength {
    /// That of a verdict with these `doubts`.
    pub(crate) fn of(doubts: &[StrengthReason]) -> Self {
        if doubts.is_empty() { Self::Confirmed } else { Self::Suggested }
    }
}

impl StrengthReason {
    /// Whether it is of the measurements, whatever effect is named.
    pub(crate) fn is_of_measurements(self) -> bool {
        matches!(self, Self::StatedErrors | Self::AssumedScatter | Self::FewRepeats)
    }
}
