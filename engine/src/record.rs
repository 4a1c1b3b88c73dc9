//! The log of a run, in MCAP.
