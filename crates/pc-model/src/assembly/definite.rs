//! The sign of the kinetic energy at the start.

use pc_expr::independent_blocks;
use pc_mech::Expr;

use crate::assembly::assembly::Assembly;

/// An entry this small relative to the largest entry of its matrix is treated as rounding error.
const ROUNDING: f64 = 1e-12;

impl<'g> Assembly<'g> {
    /// Whether δη·M δη < 0, where M = ∂²L/∂η∂η, for some velocity that the constraints allow at the start: if so, a
    /// mass or a moment of inertia has the wrong sign.
    pub fn has_negative_energy(&self) -> bool {
        let (system, graph) = (&self.system, self.system.graph());
        // M is a sum over bodies, which for a long chain is longer than the integrated equations.
        if system.tree().is_some_and(|tree| tree.is_nowhere_negative(system.parameters())) {
            return false;
        }
        let eta = system.quasi_velocities();
        let k = eta.len();
        let hessian = graph.jacobian(&system.momenta(), eta);
        let bound = self.constraints.multipliers().map(|multipliers| multipliers.coefficients().entries());
        let bound = bound.unwrap_or_default();
        let entries = hessian.iter().flatten().map(|&(_, entry)| entry);
        let expressions: Vec<Expr<'g>> = entries.chain(bound.iter().copied()).collect();
        let at = [system.parameters(), &self.at_start()].concat();
        let Ok(values) = graph.evaluate(&expressions, &at) else { return false };
        let (mass, constraints) = values.split_at(values.len() - bound.len());
        let mut mass = mass.iter().copied();
        let with_numbers =
            |row: &Vec<(usize, Expr<'g>)>| row.iter().zip(mass.by_ref()).map(|(&(s, _), m)| (s, m)).collect();
        let mass: Vec<Vec<(usize, f64)>> = hessian.iter().map(with_numbers).collect();
        let whole = |row: &Vec<(usize, f64)>, columns: &[usize]| {
            let mut whole = vec![0.0; columns.len()];
            for (s, entry) in row {
                if let Ok(place) = columns.binary_search(s) {
                    whole[place] = *entry;
                }
            }
            whole
        };
        if constraints.is_empty() {
            let size = mass.iter().flatten().fold(0.0f64, |size, (_, x)| size.max(x.abs()));
            let columns = |row: &Vec<(usize, f64)>| row.iter().map(|&(s, _)| s).collect();
            let blocks = independent_blocks(k, &mass.iter().map(columns).collect::<Vec<_>>());
            // M is symmetric, and so are its blocks.
            let form = |rows: &[usize]| rows.iter().map(|&r| whole(&mass[r], rows)).collect();
            return blocks.iter().any(|(rows, _)| is_negative_somewhere(form(rows), size));
        }
        let all: Vec<usize> = (0..k).collect();
        let form: Vec<Vec<f64>> = mass.iter().map(|row| whole(row, &all)).collect();
        let allowed = complement(constraints.chunks(k), k);
        let momenta: Vec<Vec<f64>> =
            allowed.iter().map(|v| form.iter().map(|row| dot(row, v)).collect()).collect();
        let form: Vec<Vec<f64>> =
            allowed.iter().map(|u| momenta.iter().map(|p| dot(u, p)).collect()).collect();
        let size = form.iter().flatten().fold(0.0f64, |size, x| size.max(x.abs()));
        is_negative_somewhere(form, size)
    }
}

fn dot(u: &[f64], v: &[f64]) -> f64 {
    u.iter().zip(v).map(|(u, v)| u * v).sum()
}

/// An orthonormal basis of the vectors of k components that are normal to all rows (Gram–Schmidt).
fn complement<'a>(rows: impl Iterator<Item = &'a [f64]>, k: usize) -> Vec<Vec<f64>> {
    let mut basis: Vec<Vec<f64>> = Vec::new();
    let add = |basis: &mut Vec<Vec<f64>>, vector: &[f64]| {
        let mut rest = vector.to_vec();
        // Two passes are enough.
        for _ in 0..2 {
            for known in basis.iter() {
                let share = dot(&rest, known);
                rest.iter_mut().zip(known).for_each(|(x, known)| *x -= share * known);
            }
        }
        let (length, before) = (dot(&rest, &rest).sqrt(), dot(vector, vector).sqrt());
        if length > ROUNDING.sqrt() * before {
            basis.push(rest.iter().map(|x| x / length).collect());
        }
    };
    rows.for_each(|row| add(&mut basis, row));
    let normals = basis.len(); // dependent rows add no normal
    for i in 0..k {
        add(&mut basis, &(0..k).map(|j| f64::from(u8::from(i == j))).collect::<Vec<_>>());
    }
    basis.split_off(normals)
}

/// Whether Gaussian elimination meets a negative pivot that is not negligible relative to `size`.
fn is_negative_somewhere(mut form: Vec<Vec<f64>>, size: f64) -> bool {
    for p in 0..form.len() {
        let pivot = form[p][p];
        if pivot.is_nan() || pivot.abs() <= ROUNDING * size {
            continue;
        }
        if pivot < 0.0 {
            return true;
        }
        for i in p + 1..form.len() {
            let share = form[i][p] / pivot;
            if share != 0.0 {
                for j in p..form.len() {
                    form[i][j] -= share * form[p][j];
                }
            }
        }
    }
    false
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn signs_are_those_of_the_allowed_velocities() {
        let indefinite = vec![vec![1.0, 2.0], vec![2.0, 1.0]];
        assert!(is_negative_somewhere(indefinite, 2.0));
        assert!(!is_negative_somewhere(vec![vec![2.0, 1.0], vec![1.0, 2.0]], 2.0));
        assert!(
            !is_negative_somewhere(vec![vec![1.0, 0.0], vec![0.0, 0.0]], 1.0),
            "degenerate is another matter"
        );
        let rows = [3.0, 0.0, 4.0];
        let basis = complement([&rows[..]].into_iter(), 3);
        assert_eq!(basis.len(), 2);
        assert!(basis.iter().all(|v| dot(v, &rows).abs() < 1e-15));
        assert_eq!(
            complement([&rows[..], &rows[..]].into_iter(), 3).len(),
            2,
            "a row that follows binds nothing"
        );
    }
}
