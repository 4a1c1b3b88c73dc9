//! Orthonormal bases, and what is left beside them.

use nalgebra::{DMatrix, DVector};

/// A column of which less than this share is new adds nothing to a basis.
const NEW: f64 = 1e-5;

/// Orthonormal columns.
#[derive(Clone, Debug)]
pub(crate) struct Basis {
    columns: Vec<DVector<f64>>,
}

impl Basis {
    /// A basis of what the columns of `matrix` span.
    pub(crate) fn of(matrix: &DMatrix<f64>) -> Self {
        Self::beside(matrix, &Self::none())
    }

    /// Nothing.
    pub(crate) fn none() -> Self {
        Self { columns: Vec::new() }
    }

    /// A basis of what the columns of `matrix` span beside `other`.
    pub(crate) fn beside(matrix: &DMatrix<f64>, other: &Self) -> Self {
        let mut basis = Self::none();
        basis.extend(matrix, other);
        basis
    }

    /// Adds what the columns of `matrix` span beside it and `other`.
    pub(crate) fn extend(&mut self, matrix: &DMatrix<f64>, other: &Self) {
        for column in matrix.column_iter() {
            let whole = column.norm();
            let mut rest = column.into_owned();
            // Twice is enough to be orthogonal to rounding (Kahan; Parlett 1998, §6.9).
            for _ in 0..2 {
                rest = self.rest(&other.rest(&rest));
            }
            let left = rest.norm();
            if left > NEW * whole {
                self.columns.push(rest / left);
            }
        }
    }

    /// How many columns it has.
    pub(crate) fn len(&self) -> usize {
        self.columns.len()
    }

    /// What of `vector` lies beside the basis.
    pub(crate) fn rest(&self, vector: &DVector<f64>) -> DVector<f64> {
        let mut rest = vector.clone();
        for column in &self.columns {
            let along = column.dot(&rest);
            rest.axpy(-along, column, 1.0);
        }
        rest
    }

    /// Its columns, `rows` long.
    pub(crate) fn to_matrix(&self, rows: usize) -> DMatrix<f64> {
        let mut matrix = DMatrix::zeros(rows, self.columns.len());
        for (mut column, unit) in matrix.column_iter_mut().zip(&self.columns) {
            column.copy_from(unit);
        }
        matrix
    }
}
