//! Finds and checks the structure coefficients (6) of a frame, and checks that the frame is closed.

use std::collections::{BTreeMap, BTreeSet};

use pc_expr::{Expr, Number};

use crate::error::AlgebraError;
use crate::frame::frame::Frame;
use crate::frame::structure::StructureCoefficients;
use crate::identity::sample::{HIDDEN, Neighbourhood, TRIALS};
use crate::lie_algebra::jacobi::{check_jacobi, cyclic};
use crate::linear_algebra::inverse::inverse;
use crate::linear_algebra::matrix::Matrix;

/// The terms of each component m of Jacobi's identity, for each triple r < s < u.
type JacobiDefects<'g> = BTreeMap<(usize, usize, usize), BTreeMap<usize, Vec<Expr<'g>>>>;

impl<'g> Frame<'g> {
    /// The structure coefficients of the frame (6), found from b and b_0 alone.
    ///
    /// If rank b = k, the coefficients solve b c_rs = [X_r, X_s] in the least-squares sense, c_rs =
    /// (bᵀb)⁻¹bᵀ[X_r, X_s]. If rank b < k, least squares would lose the part of c along ker b; so coefficients
    /// are sought that hold at all points and depend only on parameters and time. The frame determines these
    /// coefficients if no combination of the operators with coefficients of this kind vanishes. In both cases
    /// the result reproduces every commutator.
    ///
    /// `near` is a neighbourhood in which the expressions of the frame are regular.
    ///
    /// # Errors
    /// [`AlgebraError::NotClosed`] and [`AlgebraError::RankDeficient`], both with the pair (r, s);
    /// [`AlgebraError::Undetermined`] with the combination that vanishes; [`AlgebraError::AlgebraNeeded`] if
    /// there are operators but no coordinates.
    pub fn structure_coefficients(
        &self,
        near: &Neighbourhood<'g>,
    ) -> Result<StructureCoefficients<'g>, AlgebraError> {
        self.graph().stage("the brackets of the frame", || self.brackets(near))
    }

    fn brackets(&self, near: &Neighbourhood<'g>) -> Result<StructureCoefficients<'g>, AlgebraError> {
        let k = self.operators();
        let rank = self.rank();
        if self.coordinates().is_empty() && k > 0 {
            return Err(AlgebraError::AlgebraNeeded);
        }
        if rank < k {
            return self.constant_coefficients(rank, near);
        }
        let mut left_inverse = None;
        StructureCoefficients::from_pairs(k, self.coupled_pairs(), |r, s| {
            let terms = self.commutator_terms(r, s);
            let commutator: Vec<Expr<'g>> = terms.iter().map(|&[forth, back]| forth + back).collect();
            if commutator.iter().all(|x| x.is_zero()) {
                return Ok(vec![Expr::ZERO; k]);
            }
            let Some(solve) = left_inverse.get_or_insert_with(|| self.left_inverse()) else {
                return Err(AlgebraError::RankDeficient { rank: rank - 1, operators: k, pair: (r, s) });
            };
            let component = |m: usize| {
                let pairs = solve.nonzero(m).filter(|&(i, _)| !commutator[i].is_zero());
                let (row, along): (Vec<Expr<'g>>, Vec<Expr<'g>>) =
                    pairs.map(|(i, entry)| (entry, commutator[i])).unzip();
                self.graph().dot(row, along)
            };
            let c: Vec<Expr<'g>> = (0..k).map(component).collect();
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
    /// [`AlgebraError::Contradiction`] with the pair (r, s); [`AlgebraError::Dimension`].
    pub fn check(
        &self,
        structure: &StructureCoefficients<'g>,
        near: &Neighbourhood<'g>,
    ) -> Result<(), AlgebraError> {
        self.check_dimension(structure)?;
        for (r, s) in self.pairs_with(structure) {
            let c = structure.of_pair(r, s);
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
        let residual = |(r, s)| self.residual(&self.commutator_terms(r, s), &structure.of_pair(r, s), near);
        self.pairs_with(structure).into_iter().map(residual).fold(0.0, f64::max)
    }

    /// The largest defect of the Jacobi identity c_rs^p c_pu^m − X_u c_rs^m + cyclic = 0 for the operators
    /// 0..k, relative to its terms, as [`Neighbourhood::residual`] measures it.
    pub fn jacobi_residual(&self, structure: &StructureCoefficients<'g>, near: &Neighbourhood<'g>) -> f64 {
        let residual = |defects: BTreeMap<usize, Vec<Expr<'g>>>| {
            near.residual(self.graph(), &defects.into_values().collect::<Vec<_>>())
        };
        self.jacobi_defects(structure).into_values().map(residual).fold(0.0, f64::max)
    }

    /// Checks the Jacobi identity of given structure coefficients, X_u c_rs^m included.
    ///
    /// # Errors
    /// [`AlgebraError::Jacobi`] with the operators, 0 for time; [`AlgebraError::Dimension`].
    pub fn check_jacobi(
        &self,
        structure: &StructureCoefficients<'g>,
        near: &Neighbourhood<'g>,
    ) -> Result<(), AlgebraError> {
        self.check_dimension(structure)?;
        let graph = self.graph();
        if structure.are_constant() {
            let number =
                |(r, s, m, c): (_, _, _, Expr<'g>)| (r, s, m, c.constant().unwrap_or(Number::UNDEFINED));
            return check_jacobi(
                self.operators(),
                &structure.both_ways().into_iter().map(number).collect::<Vec<_>>(),
            );
        }
        for (triple, defects) in self.jacobi_defects(structure) {
            for (component, terms) in defects {
                if near.residual(graph, std::slice::from_ref(&terms)) > Neighbourhood::ROUNDING {
                    let defect = graph.shorten(&[graph.sum(terms)], &[])[0].to_string();
                    return Err(AlgebraError::Jacobi { triple, component, defect });
                }
            }
        }
        Ok(())
    }

    /// Returns an error unless the frame has as many operators as the structure coefficients.
    fn check_dimension(&self, structure: &StructureCoefficients<'g>) -> Result<(), AlgebraError> {
        let (algebra, operators) = (structure.operators(), self.operators());
        if algebra == operators { Ok(()) } else { Err(AlgebraError::Dimension { algebra, operators }) }
    }

    /// The pairs r < s of 0..k whose commutator or brackets may not vanish.
    fn pairs_with(&self, structure: &StructureCoefficients<'g>) -> BTreeSet<(usize, usize)> {
        let given = structure.nonzero().map(|(r, s, ..)| (r, s));
        self.coupled_pairs().into_iter().chain(given).collect()
    }

    /// The terms of c_rs^p c_pu^m − X_u c_rs^m + cyclic that are not 0, for each triple r < s < u and each m.
    fn jacobi_defects(&self, structure: &StructureCoefficients<'g>) -> JacobiDefects<'g> {
        let all = structure.both_ways();
        let mut of_first = vec![Vec::new(); self.operators() + 1];
        for &(p, u, m, c) in &all {
            of_first[p].push((u, m, c));
        }
        let mut defects = JacobiDefects::new();
        let mut add = |(r, s, u), m, term: Expr<'g>| {
            if let Some(triple) = cyclic(r, s, u).filter(|_| !term.is_zero()) {
                defects.entry(triple).or_default().entry(m).or_default().push(term);
            }
        };
        for &(r, s, p, first) in &all {
            for &(u, m, second) in &of_first[p] {
                add((r, s, u), m, first * second);
            }
        }
        let movers = self.movers();
        for &(r, s, m, c) in all.iter().filter(|(.., c)| c.constant().is_none()) {
            for u in movers.of(&[c]) {
                add((r, s, u), m, -self.apply(u, &[c])[0]);
            }
        }
        defects
    }

    /// The left inverse (bᵀWb)⁻¹bᵀW with the [weights](Self::weights) W of the coordinates, or b⁻¹ if b is
    /// square; `None` if rank b < k.
    ///
    /// Coordinates that [follow](Self::followers) others are left out, because, if the remaining b is square,
    /// b⁻¹ is as accurate as b itself, while bᵀb squares the condition number of b and, with rounded
    /// constants, hides cancellations.
    pub(crate) fn left_inverse(&self) -> Option<Matrix<Expr<'g>>> {
        let (graph, b, k) = (self.graph(), self.b(), self.operators());
        if b.rows() == k {
            return inverse(graph, b);
        }
        let follows = self.followers();
        let leading: Vec<usize> = (0..b.rows()).filter(|&i| !follows[i]).collect();
        if leading.len() == k {
            let square = leading.iter().map(|&i| b.nonzero(i).collect()).collect();
            let inverted = inverse(graph, &Matrix::from_rows(k, square))?;
            let row = |m: usize| inverted.nonzero(m).map(|(i, entry)| (leading[i], entry)).collect();
            return Some(Matrix::from_rows(b.rows(), (0..k).map(row).collect()));
        }
        let weights: Vec<Expr<'g>> =
            (0..).zip(self.weights()).map(|(i, w)| if follows[i] { Expr::ZERO } else { w }).collect();
        let row = |i: usize| b.nonzero(i).map(|(s, entry)| (s, weights[i] * entry)).collect();
        let weighted = Matrix::from_rows(k, (0..b.rows()).map(row).collect());
        let inverted = inverse(graph, &b.transpose().times(graph, &weighted))?;
        Some(inverted.times(graph, &weighted.transpose()))
    }

    /// The weights of the coordinates. Most weights are 1. Coordinates in whose units the velocities are so
    /// small that bᵀb would lose them among the others are weighted with powers of 2, and coordinates whose
    /// velocities are only rounding errors with 0.
    fn weights(&self) -> Vec<Expr<'g>> {
        const SMALL: f64 = 1e-3;
        let b = self.b();
        let entries: Vec<(usize, usize, Expr<'g>)> =
            (0..b.rows()).flat_map(|i| b.nonzero(i).map(move |(s, entry)| (i, s, entry))).collect();
        let values: Vec<Expr<'g>> = entries.iter().map(|&(_, _, entry)| entry).collect();
        let near = Neighbourhood::anywhere(self.graph(), &values);
        let samples = near.weighed(self.graph(), &values, TRIALS);
        if samples.is_empty() {
            return vec![Expr::ONE; b.rows()];
        }
        let largest = |place: usize| {
            let known = samples.iter().map(|sample| sample[place]).filter(|entry| entry.rest() > HIDDEN);
            known.fold(0.0, |most, entry| f64::max(most, entry.value.abs()))
        };
        let sizes: Vec<f64> = (0..entries.len()).map(largest).collect();
        let mut columns = vec![0.0; self.operators()];
        for (&(_, s, _), &size) in entries.iter().zip(&sizes) {
            columns[s] = f64::max(columns[s], size);
        }
        let (mut shares, mut is_noise) = (vec![0.0; b.rows()], vec![false; b.rows()]);
        for (place, &(i, s, _)) in entries.iter().enumerate() {
            if columns[s] > 0.0 {
                shares[i] = f64::max(shares[i], sizes[place] / columns[s]);
            }
            is_noise[i] |= samples.iter().any(|sample| sample[place].value != 0.0);
        }
        let weight = |(share, is_noise): (f64, bool)| match share {
            0.0 if is_noise => Expr::ZERO,
            share if (f64::MIN_POSITIVE.sqrt()..SMALL).contains(&share) => {
                Expr::from(2f64.powi(-2 * share.log2().round() as i32))
            }
            _ => Expr::ONE,
        };
        shares.into_iter().zip(is_noise).map(weight).collect()
    }

    /// The largest component of Y − c^m X_m relative to its terms, for an operator Y such as [X_r, X_s] whose
    /// components are sums.
    pub(crate) fn residual<const N: usize>(
        &self,
        y: &[[Expr<'g>; N]],
        c: &[Expr<'g>],
        near: &Neighbourhood<'g>,
    ) -> f64 {
        let difference = |(i, terms): (usize, &[Expr<'g>; N])| -> Vec<Expr<'g>> {
            // There are fewer c^m than operators if some operators are combinations of others.
            let combination = self.b().nonzero(i).filter_map(|(s, b)| Some(-(b * *c.get(s)?)));
            terms.iter().copied().chain(combination).filter(|term| !term.is_zero()).collect()
        };
        near.residual(self.graph(), &y.iter().enumerate().map(difference).collect::<Vec<_>>())
    }
}
