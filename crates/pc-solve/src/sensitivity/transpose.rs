//! Products with the transposed Jacobian of a vector field, from whatever the field offers.

use pc_expr::{Colouring, Failure, Pattern, VectorField};

use crate::cvode::forward::linearisation::Linearisation;
use crate::error::NonFinite;
use crate::settings::options::Options;

/// The matrix (∂f/∂y)ᵀ of a field, from the products that the field computes, else from its sparse
/// Jacobian, which may be assembled from products for the colours of its pattern, else from its
/// dense Jacobian.
#[derive(Debug)]
pub(crate) struct Transpose {
    linearisation: Linearisation,
    has_products: bool,
    sparse: Option<Sparse>,
}

/// The entries of a matrix ∂f/∂y whose pattern is known.
#[derive(Debug)]
struct Sparse {
    pattern: Pattern,
    /// The colours, for a field that does not write the entries.
    colouring: Option<Colouring>,
    entries: Vec<f64>,
    /// The pattern of the transposed matrix, and the position of each of its entries in `entries`.
    transposed: Pattern,
    places: Vec<usize>,
}

impl Sparse {
    fn new(field: &impl VectorField, pattern: &Pattern) -> Sparse {
        let mut rows: Vec<Vec<(usize, usize)>> = vec![Vec::new(); pattern.rows()];
        for (place, (i, j)) in pattern.entries().enumerate() {
            rows[i].push((j, place)); // j ascends
        }
        let columns = rows.iter().map(|row| row.iter().map(|&(j, _)| j).collect::<Vec<_>>());
        Sparse {
            transposed: Pattern::from_columns(pattern.columns(), columns),
            places: rows.iter().flatten().map(|&(_, place)| place).collect(),
            colouring: (!field.has_jacobian()).then(|| pattern.colouring()),
            entries: vec![0.0; pattern.len()],
            pattern: pattern.clone(),
        }
    }

    /// Evaluates the entries.
    fn evaluate(
        &mut self,
        linearisation: &mut Linearisation,
        field: &mut impl VectorField,
        t: f64,
        y: &[f64],
    ) -> Result<(), Failure> {
        let Sparse { pattern, colouring, entries, .. } = self;
        match colouring {
            None => {
                entries.fill(f64::NAN);
                field.sparse_jacobian(t, y, entries)?;
            }
            Some(colouring) => {
                linearisation.prepare(field, t, y)?;
                let (mut seed, mut product) = (vec![0.0; y.len()], vec![0.0; y.len()]);
                let starts = pattern.column_starts();
                for colour in 0..colouring.len() {
                    seed.fill(0.0);
                    colouring.columns(colour).for_each(|j| seed[j] = 1.0);
                    linearisation.product(field, t, y, &seed, &mut product)?;
                    for j in colouring.columns(colour) {
                        let column = entries[starts[j]..starts[j + 1]].iter_mut();
                        column.zip(pattern.column(j)).for_each(|(entry, &i)| *entry = product[i]);
                    }
                }
            }
        }
        match pattern.entries().zip(entries.iter()).find(|(_, entry)| !entry.is_finite()) {
            None => Ok(()),
            Some(((i, j), &value)) => Err(Failure::recoverable(NonFinite::Jacobian {
                row: field.component_name(i),
                column: field.component_name(j),
                value,
                t,
            })),
        }
    }
}

impl Transpose {
    pub(crate) fn new(field: &impl VectorField, options: &Options) -> Transpose {
        let dim = field.dim();
        let is_square = |pattern: &&Pattern| pattern.rows() == dim && pattern.columns() == dim;
        let pattern = field.sparsity().filter(is_square).filter(|pattern| !pattern.is_full());
        Transpose {
            linearisation: Linearisation::new(field, options),
            has_products: field.has_vjp(),
            sparse: pattern.map(|pattern| Sparse::new(field, pattern)),
        }
    }

    /// The pattern of (∂f/∂y)ᵀ, if it is known to have zeros.
    pub(crate) fn pattern(&self) -> Option<&Pattern> {
        self.sparse.as_ref().map(|sparse| &sparse.transposed)
    }

    /// Whether computing the entries costs no more than a product.
    pub(crate) fn has_entries(&self, field: &impl VectorField) -> bool {
        !self.has_products || self.sparse.is_some() || field.has_jacobian()
    }

    /// Writes (∂f/∂y)ᵀ w at (t, y).
    pub(crate) fn product(
        &mut self,
        field: &mut impl VectorField,
        (t, y): (f64, &[f64]),
        w: &[f64],
        product: &mut [f64],
    ) -> Result<(), Failure> {
        if self.has_products {
            product.fill(f64::NAN);
            return field.vjp(t, y, w, product);
        }
        if let Some(sparse) = &mut self.sparse {
            sparse.evaluate(&mut self.linearisation, field, t, y)?;
            let Sparse { pattern, entries, .. } = sparse;
            for (j, product) in product.iter_mut().enumerate() {
                let column = pattern.column_starts()[j]..pattern.column_starts()[j + 1];
                let terms = pattern.column(j).iter().zip(&entries[column]);
                *product = terms.map(|(&i, entry)| entry * w[i]).sum();
            }
            return Ok(());
        }
        let jacobian = self.linearisation.jacobian(field, t, y)?;
        for (product, column) in product.iter_mut().zip(jacobian.chunks_exact(w.len())) {
            *product = column.iter().zip(w).map(|(a, b)| a * b).sum();
        }
        Ok(())
    }

    /// Writes all entries of −(∂f/∂y)ᵀ, column-major.
    pub(crate) fn negative(
        &mut self,
        field: &mut impl VectorField,
        (t, y): (f64, &[f64]),
        matrix: &mut [f64],
    ) -> Result<(), Failure> {
        let dim = y.len();
        if let Some(sparse) = &mut self.sparse {
            sparse.evaluate(&mut self.linearisation, field, t, y)?;
            matrix.fill(0.0);
            for ((i, j), entry) in sparse.pattern.entries().zip(&sparse.entries) {
                matrix[j + i * dim] = -entry;
            }
            return Ok(());
        }
        let jacobian = self.linearisation.jacobian(field, t, y)?;
        for (j, column) in matrix.chunks_exact_mut(dim).enumerate() {
            for (i, entry) in column.iter_mut().enumerate() {
                *entry = -jacobian[j + i * dim];
            }
        }
        Ok(())
    }

    /// Writes the entries of −(∂f/∂y)ᵀ in the order of its [pattern](Transpose::pattern); writes
    /// nothing if the pattern is unknown.
    pub(crate) fn negative_entries(
        &mut self,
        field: &mut impl VectorField,
        (t, y): (f64, &[f64]),
        values: &mut [f64],
    ) -> Result<(), Failure> {
        let Some(sparse) = &mut self.sparse else { return Ok(()) };
        sparse.evaluate(&mut self.linearisation, field, t, y)?;
        for (value, &place) in values.iter_mut().zip(&sparse.places) {
            *value = -sparse.entries[place];
        }
        Ok(())
    }
}
