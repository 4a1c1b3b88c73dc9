//! What other methods reach.

/// A method with what it reaches.
#[derive(Clone, Copy, Debug)]
pub(super) struct Peer {
    /// The method.
    pub(super) method: &'static str,
    /// Share of sets with the truth ranked first (of its terms the largest) at 6 and 12 %.
    pub(super) first: [&'static str; 2],
    /// Share of sets with the truth among the selected terms.
    pub(super) selected: &'static str,
    /// What it finds where nothing is hidden.
    pub(super) nulls: &'static str,
}

/// Measured in the feasibility study on its own sets (means over a camera's runs, 19 effects that are
/// forces), not on the sets of this benchmark.
pub(super) static PEERS: [Peer; 3] = [
    Peer {
        method: "weak-form regression with stability selection",
        first: ["0.58", "0.74"],
        selected: "-",
        nulls: "a stable term in 33 %",
    },
    Peer {
        method: "PySINDy, ensemble STLSQ, thresholds chosen on held-out runs",
        first: ["0.00", "0.11"],
        selected: "0.84 / 0.95, with about 9 further terms",
        nulls: "8 terms in each",
    },
    Peer {
        method: "PySINDy, FROLS on the residual acceleration",
        first: ["0.16", "0.32"],
        selected: "-",
        nulls: "-",
    },
];
