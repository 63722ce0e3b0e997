//! Named arrays of numbers.

use pc_mech::Matrix;

/// A matrix of real or complex numbers.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Array {
    pub(crate) name: String,
    pub(crate) rows: usize,
    pub(crate) columns: usize,
    /// Whether it is a vector: a column written as a list.
    pub(crate) is_list: bool,
    /// The entries, row by row.
    pub(crate) real: Vec<f64>,
    pub(crate) imaginary: Option<Vec<f64>>,
}

impl Array {
    pub(crate) fn of(name: &str, matrix: &Matrix<f64>) -> Array {
        Array {
            name: name.to_owned(),
            rows: matrix.rows(),
            columns: matrix.columns(),
            is_list: false,
            real: matrix.entries().to_vec(),
            imaginary: None,
        }
    }

    pub(crate) fn column(name: &str, values: impl IntoIterator<Item = f64>) -> Array {
        let real: Vec<f64> = values.into_iter().collect();
        Array { name: name.to_owned(), rows: real.len(), columns: 1, is_list: true, real, imaginary: None }
    }

    /// A complex array, made from rows of pairs of real and imaginary parts.
    pub(crate) fn complex(name: &str, rows: &[Vec<(f64, f64)>]) -> Array {
        let (real, imaginary) = rows.iter().flatten().copied().unzip();
        let columns = rows.first().map_or(0, Vec::len);
        Array {
            name: name.to_owned(),
            rows: rows.len(),
            columns,
            is_list: false,
            real,
            imaginary: Some(imaginary),
        }
    }
}
