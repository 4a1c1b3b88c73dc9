//! Impacts of a disc on a plane of discs at an angle: Wang, Ye & Zheng, Eur. Phys. J. E 35, 7 (2012).

pub mod curves;
pub mod force;
pub mod headline;
pub mod matrix;
pub mod own_depths;
#[cfg(test)]
pub(crate) mod records;
pub mod tables;
