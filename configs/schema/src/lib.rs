//! plunge.
