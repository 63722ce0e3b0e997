//! Finding and checking the structure coefficients of a frame (6), and its closure.

use nalgebra::{DMatrix, DVector};
use pc_expr::{Expr, Number};

use crate::error::AlgebraError;
use crate::frame::Frame;
use crate::inverse::inverse;
use crate::matrix::Matrix;
use crate::sample::{HIDDEN, Neighbourhood};
use crate::structure::StructureCoefficients;

/// Points at which an identity that the graph cannot decide is tried numerically.
pub(crate) const TRIALS: usize = 8;

impl<'g> Frame<'g> {
    /// The structure coefficients of the frame (6), found from b and b_0 alone.
    ///
    /// Where rank b = k they solve b c_rs = [X_r, X_s] in the least-squares sense, c_rs = (bᵀb)⁻¹bᵀ[X_r,
    /// X_s]. Where rank b < k that would lose the part of c along ker b, so constant coefficients are looked
    /// for that hold at many points at once. Either way the result must reproduce every commutator.
    ///
    /// `near` says where the expressions of the frame are regular.
    ///
    /// # Errors
    /// [`AlgebraError::NotClosed`] and [`AlgebraError::RankDeficient`], both naming the pair (r, s);
    /// [`AlgebraError::AlgebraNeeded`] if there are operators but no coordinates.
    pub fn structure_coefficients(
        &self,
        near: &Neighbourhood<'g>,
    ) -> Result<StructureCoefficients<'g>, AlgebraError> {
        let k = self.operators();
        let rank = self.rank();
        if rank == 0 && k > 0 {
            return Err(AlgebraError::AlgebraNeeded);
        }
        if rank < k {
            return self.constant_coefficients(rank, near);
        }
        let mut left_inverse = None;
        StructureCoefficients::from_pairs(k, |r, s| {
            let terms = self.commutator_terms(r, s);
            let commutator: Vec<Expr<'g>> = terms.iter().map(|&[forth, back]| forth + back).collect();
            if commutator.iter().all(|x| x.is_zero()) {
                return Ok(vec![Expr::ZERO; k]);
            }
            let Some(solve) = left_inverse.get_or_insert_with(|| self.left_inverse()) else {
                return Err(AlgebraError::RankDeficient { rank: rank - 1, operators: k, pair: (r, s) });
            };
            let c: Vec<Expr<'g>> = (0..k)
                .map(|m| self.graph().dot(solve.row(m).iter().copied(), commutator.iter().copied()))
                .collect();
            match self.residual(&terms, &c, near) {
                residual if residual > Neighbourhood::ROUNDING => {
                    Err(AlgebraError::NotClosed { pair: (r, s), residual })
                }
                _ => Ok(self.graph().shorten(&c, &[])),
            }
        })
    }

    /// Checks given structure coefficients against the commutators of the frame.
    ///
    /// # Errors
    /// [`AlgebraError::Contradiction`] naming the pair; [`AlgebraError::Dimension`].
    pub fn check(
        &self,
        structure: &StructureCoefficients<'g>,
        near: &Neighbourhood<'g>,
    ) -> Result<(), AlgebraError> {
        let k = self.operators();
        if structure.operators() != k {
            return Err(AlgebraError::Dimension { algebra: structure.operators(), operators: k });
        }
        for (r, s) in pairs(k) {
            let c: Vec<Expr<'g>> = (1..=k).map(|m| structure.get(r, s, m)).collect();
            let residual = self.residual(&self.commutator_terms(r, s), &c, near);
            if residual > Neighbourhood::ROUNDING {
                return Err(AlgebraError::Contradiction { pair: (r, s), residual });
            }
        }
        Ok(())
    }

    /// The largest residual of [X_r, X_s] = c_rs^m X_m relative to its terms, as
    /// [`Neighbourhood::residual`] measures it, over all pairs.
    pub fn closure_residual(&self, structure: &StructureCoefficients<'g>, near: &Neighbourhood<'g>) -> f64 {
        let k = self.operators();
        pairs(k)
            .map(|(r, s)| {
                let c: Vec<Expr<'g>> = (1..=k).map(|m| structure.get(r, s, m)).collect();
                self.residual(&self.commutator_terms(r, s), &c, near)
            })
            .fold(0.0, f64::max)
    }

    /// The largest defect of the Jacobi identity c_rs^p c_pu^m − X_u c_rs^m + cyclic = 0 for the operators
    /// 0..k, relative to its terms, as [`Neighbourhood::residual`] measures it.
    pub fn jacobi_residual(&self, structure: &StructureCoefficients<'g>, near: &Neighbourhood<'g>) -> f64 {
        if structure.nonzero().next().is_none() {
            return 0.0;
        }
        let k = self.operators();
        let mut worst = 0.0f64;
        for r in 0..=k {
            for s in r + 1..=k {
                for u in s + 1..=k {
                    let cycles = [(r, s, u), (s, u, r), (u, r, s)];
                    let defect = |m: usize| -> Vec<Expr<'g>> {
                        let terms = cycles.iter().flat_map(|&(r, s, u)| {
                            let transport = self.apply(u, &[structure.get(r, s, m)])[0];
                            let nested =
                                (1..=k).map(move |p| structure.get(r, s, p) * structure.get(p, u, m));
                            nested.chain([-transport])
                        });
                        terms.filter(|term| !term.is_zero()).collect()
                    };
                    let defects: Vec<Vec<Expr<'g>>> = (1..=k).map(defect).collect();
                    worst = worst.max(near.residual(self.graph(), &defects));
                }
            }
        }
        worst
    }

    /// (bᵀWb)⁻¹bᵀW with the [weights](Self::weights) W of the coordinates, or b⁻¹ where b is square; `None` if rank b < k.
    pub(crate) fn left_inverse(&self) -> Option<Matrix<Expr<'g>>> {
        let (graph, b, k) = (self.graph(), self.b(), self.operators());
        if b.rows() == k {
            return inverse(graph, b);
        }
        let weights = self.weights();
        let weighted = Matrix::from_fn(b.rows(), k, |i, s| weights[i] * b[(i, s)]);
        let gram = Matrix::from_fn(k, k, |i, j| graph.dot(b.column(i), weighted.column(j)));
        let inverted = inverse(graph, &gram)?;
        Some(Matrix::from_fn(k, b.rows(), |m, i| {
            graph.dot(inverted.row(m).iter().copied(), weighted.row(i).iter().copied())
        }))
    }

    /// 1, but powers of 2 for the coordinates in whose units velocities are small numbers: in bᵀb they would be lost beside
    /// the others. 0 for those of which nothing but rounding moves.
    fn weights(&self) -> Vec<Expr<'g>> {
        const SMALL: f64 = 1e-3;
        let (b, k) = (self.b(), self.operators());
        let ones = || vec![Expr::ONE; b.rows()];
        let near = Neighbourhood::anywhere(self.graph(), b.entries());
        let samples = near.weighed(self.graph(), b.entries(), TRIALS);
        if samples.is_empty() {
            return ones();
        }
        let largest = |of: &mut dyn Iterator<Item = usize>| {
            let sizes = of.flat_map(|place| samples.iter().map(move |sample| sample[place]));
            sizes
                .filter(|entry| entry.rest() > HIDDEN)
                .fold(0.0, |most, entry| f64::max(most, entry.value.abs()))
        };
        let columns: Vec<f64> = (0..k).map(|s| largest(&mut (0..b.rows()).map(|i| i * k + s))).collect();
        let share = |i: usize| {
            let entry = |s: usize| largest(&mut std::iter::once(i * k + s)) / columns[s];
            (0..k).filter(|&s| columns[s] > 0.0).map(entry).fold(0.0, f64::max)
        };
        let is_noise =
            |i: usize| samples.iter().any(|sample| sample[i * k..][..k].iter().any(|x| x.value != 0.0));
        let weight = |i: usize| match share(i) {
            0.0 if is_noise(i) => Expr::ZERO,
            share if (f64::MIN_POSITIVE.sqrt()..SMALL).contains(&share) => {
                Expr::from(2f64.powi(-2 * share.log2().round() as i32))
            }
            _ => Expr::ONE,
        };
        (0..b.rows()).map(weight).collect()
    }

    /// Largest component of Y − c^m X_m relative to its terms, for an operator Y such as [X_r, X_s] whose components are sums.
    pub(crate) fn residual<const N: usize>(
        &self,
        y: &[[Expr<'g>; N]],
        c: &[Expr<'g>],
        near: &Neighbourhood<'g>,
    ) -> f64 {
        let difference = |(i, terms): (usize, &[Expr<'g>; N])| -> Vec<Expr<'g>> {
            let combination = self.b().row(i).iter().zip(c).map(|(&b, &c)| -(b * c));
            terms.iter().copied().chain(combination).filter(|term| !term.is_zero()).collect()
        };
        near.residual(self.graph(), &y.iter().enumerate().map(difference).collect::<Vec<_>>())
    }

    /// Constant c with b c_rs = [X_r, X_s]: one linear system over many points, rounded to rationals and then
    /// proved exactly.
    fn constant_coefficients(
        &self,
        rank: usize,
        near: &Neighbourhood<'g>,
    ) -> Result<StructureCoefficients<'g>, AlgebraError> {
        let k = self.operators();
        StructureCoefficients::from_pairs(k, |r, s| {
            let terms = self.commutator_terms(r, s);
            let commutator: Vec<Expr<'g>> = terms.iter().map(|&[forth, back]| forth + back).collect();
            let refusal = AlgebraError::RankDeficient { rank, operators: k, pair: (r, s) };
            if commutator.iter().all(|x| x.is_zero()) {
                return Ok(vec![Expr::ZERO; k]);
            }
            let c = self.fit_constants(&commutator, near).ok_or_else(|| refusal.clone())?;
            if self.residual(&terms, &c, near) > Neighbourhood::ROUNDING { Err(refusal) } else { Ok(c) }
        })
    }

    fn fit_constants(&self, commutator: &[Expr<'g>], near: &Neighbourhood<'g>) -> Option<Vec<Expr<'g>>> {
        let (n, k) = (self.b().rows(), self.operators());
        let entries: Vec<Expr<'g>> = self.b().entries().iter().chain(commutator).copied().collect();
        let samples = near.samples(self.graph(), &entries, 4 * (k + 1));
        let rows = samples.len() * n;
        let matrix = DMatrix::from_fn(rows, k, |row, m| samples[row / n][row % n * k + m]);
        let right = DVector::from_fn(rows, |row, _| samples[row / n][n * k + row % n]);
        let svd = matrix.svd(true, true);
        let largest = svd.singular_values.iter().copied().fold(0.0, f64::max);
        if svd.rank(1e-10 * largest) < k {
            return None; // dependent over the constants too: c is not unique
        }
        let solution = svd.solve(&right, 0.0).ok()?;
        solution.iter().map(|&value| nearest_rational(value).map(Expr::from)).collect()
    }
}

/// The pairs r < s of 0..=k.
pub(crate) fn pairs(k: usize) -> impl Iterator<Item = (usize, usize)> {
    (0..=k).flat_map(move |r| (r + 1..=k).map(move |s| (r, s)))
}

/// The rational with a denominator up to 64 that equals `value` to ten digits, if there is one.
fn nearest_rational(value: f64) -> Option<Number> {
    (1..=64i64).find_map(|den| {
        let num = (value * den as f64).round();
        ((num / den as f64 - value).abs() < 1e-10 * (1.0 + value.abs()))
            .then(|| Number::ratio(num as i64, den))
    })
}
