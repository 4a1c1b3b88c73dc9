//! How well each effect, alone or with another, explains what noise does not.

pub(crate) mod marginal;
pub mod pair;
pub(crate) mod score;
pub(crate) mod signature;
pub(crate) mod significance;
