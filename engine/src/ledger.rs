//! The energy ledger: every joule of a run, by channel, at every step.

/// How a channel enters the closure identity
/// `kinetic + potential + Σ stored + Σ dissipated − Σ input = E₀ + unaccounted`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ChannelKind {
    /// Energy held now [J].
    Stored,
    /// Energy lost since the start [J].
    Dissipated,
    /// Energy put in since the start [J].
    Input,
}

/// A named account of the ledger.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Channel {
    /// kebab-case, as in reports; files spell it in `snake_case` with a unit.
    pub name: &'static str,
    /// How it enters the closure.
    pub kind: ChannelKind,
}
