//! The structure coefficients, where the frame does not determine them at each point.

use nalgebra::DMatrix;

use crate::derivation::{Derivation, Direction, Place};
use crate::error::{Irregular, Unable};
use crate::linear::pseudo_inverse;
use crate::rounding::{Random, Rounding, within};
use crate::term::Term;
use crate::text::{Brackets, Text};

/// Where the brackets come from.
#[derive(Clone, Debug)]
pub(crate) enum Structure {
    /// From the frame: b has as many independent columns as there are quasi-velocities.
    Frame,
    /// They are constants.
    Constant(Constants),
    /// A table, whose values may depend on parameters and time.
    Table(Vec<(usize, usize, Term)>),
    /// Constants for which [X_r, X_s] = c_rs^m X_m holds everywhere.
    Fitted,
}

/// c_rs^m with r, s = 0..k and m = 1..k, which stands at m − 1.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Constants {
    k: usize,
    values: Vec<f64>,
}

impl Constants {
    fn zero(k: usize) -> Constants {
        Constants { k, values: vec![0.0; (k + 1) * (k + 1) * k] }
    }

    pub(crate) fn get(&self, r: usize, s: usize, m: usize) -> f64 {
        self.values[(r * (self.k + 1) + s) * self.k + m]
    }

    /// Sets c_rs^m and c_sr^m.
    fn set(&mut self, r: usize, s: usize, m: usize, value: f64) {
        let k = self.k;
        self.values[(r * (k + 1) + s) * k + m] = value;
        self.values[(s * (k + 1) + r) * k + m] = -value;
    }

    /// [X_r, X_s] = value X_m for each, numbers from 1.
    fn of(k: usize, brackets: &[(usize, usize, usize, f64)]) -> Constants {
        let mut constants = Constants::zero(k);
        brackets.iter().for_each(|&(r, s, m, value)| constants.set(r, s, m - 1, value));
        constants
    }

    /// Those of an algebra with a name, as `pc models --algebras` lists them.
    pub(crate) fn named(name: &str) -> Option<Constants> {
        let cyclic = [(1, 2, 3, 1.0), (2, 3, 1, 1.0), (3, 1, 2, 1.0)];
        Some(match name {
            "so3" | "su2" | "bianchi9" => Constants::of(3, &cyclic),
            "se2" | "bianchi7" => Constants::of(3, &[(1, 2, 3, 1.0), (1, 3, 2, -1.0)]),
            "sl2" => Constants::of(3, &[(1, 2, 2, 2.0), (1, 3, 3, -2.0), (2, 3, 1, 1.0)]),
            "se3" => motions_of_space(),
            "heisenberg" => Constants::of(3, &[(1, 2, 3, 1.0)]),
            "aff1" => Constants::of(2, &[(1, 2, 2, 1.0)]),
            "bianchi1" => Constants::zero(3),
            "bianchi2" => Constants::of(3, &[(2, 3, 1, 1.0)]),
            "bianchi3" => bianchi(1.0, -1.0),
            "bianchi4" => Constants::of(3, &[(1, 2, 2, -1.0), (1, 2, 3, 1.0), (1, 3, 3, -1.0)]),
            "bianchi5" => bianchi(1.0, 0.0),
            "bianchi6" => bianchi(0.0, -1.0),
            "bianchi8" => Constants::of(3, &[(1, 2, 3, -1.0), (2, 3, 1, 1.0), (3, 1, 2, 1.0)]),
            _ => return Constants::of_family(name),
        })
    }

    fn of_family(name: &str) -> Option<Constants> {
        let size = |family: &str| name.strip_prefix(family)?.parse::<usize>().ok();
        if let Some(dim) = size("heisenberg").filter(|dim| dim % 2 == 1 && *dim <= 65) {
            let half = dim / 2;
            let pairs: Vec<_> = (1..=half).map(|i| (i, half + i, dim, 1.0)).collect();
            return Some(Constants::of(dim, &pairs));
        }
        if let Some(n) = size("so").filter(|n| (4..=12).contains(n)) {
            return Some(rotations(n));
        }
        if let Some(n) = size("gl").filter(|n| (1..=8).contains(n)) {
            // [E_ij, E_kl] = δ_jk E_il − δ_li E_kj
            let mut constants = Constants::zero(n * n);
            let unit = |i: usize, j: usize| 1 + n * i + j;
            let each = || (0..n).flat_map(|i| (0..n).map(move |j| (i, j)));
            for ((i, j), (k, l)) in each().flat_map(|a| each().map(move |b| (a, b))) {
                let (a, b) = (unit(i, j), unit(k, l));
                if a < b && j == k {
                    constants.add(a, b, unit(i, l) - 1, 1.0);
                }
                if a < b && l == i {
                    constants.add(a, b, unit(k, j) - 1, -1.0);
                }
            }
            return Some(constants);
        }
        let parameter = |kind: &str| {
            let text = name.strip_prefix(kind)?.trim().strip_prefix('(')?.strip_suffix(')')?;
            match text.split_once('/') {
                Some((num, den)) => Some(num.trim().parse::<f64>().ok()? / den.trim().parse::<f64>().ok()?),
                None => text.trim().parse::<f64>().ok(),
            }
        };
        let of_six = parameter("bianchi6").map(|h| bianchi((-h).sqrt(), -1.0));
        of_six.or_else(|| parameter("bianchi7").map(|h| bianchi(h.sqrt(), 1.0)))
    }

    fn add(&mut self, r: usize, s: usize, m: usize, value: f64) {
        self.set(r, s, m, self.get(r, s, m) + value);
    }
}

/// [X_1, X_2] = −a X_2 + n X_3, [X_1, X_3] = −X_2 − a X_3, without the −X_2 of the latter where n = 0.
fn bianchi(a: f64, n: f64) -> Constants {
    Constants::of(3, &[(1, 2, 2, -a), (1, 2, 3, n), (1, 3, 2, -n.abs()), (1, 3, 3, -a)])
}

/// Rotations L_i and translations P_i: [L_i, L_j] = ε_ijk L_k, [L_i, P_j] = ε_ijk P_k.
fn motions_of_space() -> Constants {
    let mut constants = Constants::zero(6);
    for (i, j, k) in [(1, 2, 3), (2, 3, 1), (3, 1, 2)] {
        constants.set(i, j, k - 1, 1.0);
        constants.set(i, j + 3, k + 2, 1.0);
        constants.set(j, i + 3, k + 2, -1.0);
    }
    constants
}

/// R_23, R_31, R_12, R_14, R_24, R_34, R_15, … where R_ij turns axis i towards axis j: [R_ij, R_jl] = −R_il, R_ji = −R_ij.
fn rotations(n: usize) -> Constants {
    let mut basis = vec![(2, 3), (3, 1), (1, 2)];
    basis.extend((4..=n).flat_map(|j| (1..j).map(move |i| (i, j))));
    let mut constants = Constants::zero(basis.len());
    let mut add = |a: usize, b: usize, (i, l): (usize, usize), sign: f64| {
        let place = |pair| basis.iter().position(|known| *known == pair);
        match (place((i, l)), place((l, i))) {
            (Some(m), _) => constants.add(a + 1, b + 1, m, sign),
            (_, Some(m)) => constants.add(a + 1, b + 1, m, -sign),
            (None, None) => {} // i = l
        }
    };
    for (a, &(i, j)) in basis.iter().enumerate() {
        for (b, &(k, l)) in basis.iter().enumerate().skip(a + 1) {
            match () {
                () if j == k => add(a, b, (i, l), -1.0),
                () if j == l => add(a, b, (i, k), 1.0),
                () if i == k => add(a, b, (j, l), 1.0),
                () if i == l => add(a, b, (j, k), -1.0),
                () => {}
            }
        }
    }
    constants
}

impl Structure {
    /// Where the brackets come from if `rank` of the `k` fields are independent at a point.
    pub(crate) fn new(text: &Text, rank: usize, k: usize) -> Result<Structure, Unable> {
        if rank == k {
            return Ok(Structure::Frame);
        }
        match &text.brackets {
            Some(Brackets::Catalogue(name)) => {
                let unknown = || Unable::UnknownAlgebra { name: name.clone() };
                let constants = Constants::named(name).filter(|c| c.k == k).ok_or_else(unknown)?;
                Ok(Structure::Constant(constants))
            }
            Some(Brackets::Table(table)) => Ok(Structure::Table(table.clone())),
            None if text.coordinates() == 0 => Err(Unable::NoBrackets),
            None => Ok(Structure::Fitted),
        }
    }

    /// The c_rs^m, unless they come from the frame.
    pub(crate) fn constants(
        &self,
        derivation: &Derivation,
        at: &Place,
    ) -> Result<Option<Constants>, Irregular> {
        match self {
            Structure::Frame => Ok(None),
            Structure::Constant(constants) => Ok(Some(constants.clone())),
            Structure::Table(table) => tabulated(derivation, table, at).map(Some),
            Structure::Fitted => fitted(derivation, at).map(Some),
        }
    }
}

fn tabulated(
    derivation: &Derivation,
    table: &[(usize, usize, Term)],
    at: &Place,
) -> Result<Constants, Irregular> {
    let exact = Rounding::none();
    let mut constants = Constants::zero(at.w.len());
    for m in 0..at.w.len() {
        let point = derivation.once(at, &at.along_velocity(m), &exact);
        for (r, s, value) in table {
            constants.set(*r, *s, m, point.value(value)?.eps);
        }
    }
    Ok(constants)
}

/// The constants with which the brackets close at many points at the time of a place: least squares, refused unless they
/// are the only ones and leave nothing.
fn fitted(derivation: &Derivation, at: &Place) -> Result<Constants, Irregular> {
    let (n, k) = (at.x.len(), at.w.len());
    let exact = Rounding::none();
    let mut random = Random::new(k as u64);
    let (mut fields, mut brackets): (Vec<f64>, Vec<Vec<f64>>) = (Vec::new(), Vec::new());
    let resting = |x: Vec<f64>| Place { x, w: vec![0.0; k], ..at.clone() };
    let points = 4 + 2 * k;
    let mut found = 0;
    for attempt in 0..8 * points {
        let scale = if attempt == 0 { 0.0 } else { 0.5 };
        let place = resting(at.x.iter().map(|x| x + scale * (1.0 + x.abs()) * random.signed()).collect());
        let Ok((frame, commutators)) = commutators(derivation, &place, &exact) else { continue };
        if frame.iter().chain(&commutators).flatten().any(|value| !value.is_finite()) {
            continue;
        }
        for i in 0..n {
            fields.extend(frame.iter().map(|b| b[i]));
            brackets.push(commutators.iter().map(|bracket| bracket[i]).collect());
        }
        found += 1;
        if found == points {
            break;
        }
    }
    let pairs = (k + 1) * k / 2;
    let b = DMatrix::from_row_slice(brackets.len(), k, &fields);
    let right = DMatrix::from_fn(brackets.len(), pairs, |i, j| brackets[i][j]);
    let (inverse, rank) = pseudo_inverse(&b).ok_or(Irregular::NotFinite { what: "the frame" })?;
    let mut solved = &inverse * &right;
    solved -= &inverse * (&b * &solved - &right); // takes away what the pseudo-inverse is wrong by
    let rest = &b * &solved - &right;
    if rank < k || !within(rest.amax(), 1e-8 * (1.0 + right.amax())) {
        return Err(Unable::NoBrackets.into());
    }
    let mut constants = Constants::zero(k);
    for (j, (r, s)) in (0..=k).flat_map(|r| (r + 1..=k).map(move |s| (r, s))).enumerate() {
        (0..k).for_each(|m| constants.set(r, s, m, solved[(m, j)]));
    }
    Ok(constants)
}

/// b_s, and [X_r, X_s] for r < s, time being 0, in the order of the pairs.
#[allow(clippy::type_complexity)] // two lists of vectors
fn commutators(
    derivation: &Derivation,
    at: &Place,
    rounding: &Rounding,
) -> Result<(Vec<Vec<f64>>, Vec<Vec<f64>>), Irregular> {
    let k = at.w.len();
    let drift = derivation.still(at, rounding).velocities()?.to_vec();
    let frame = derivation.frame(at, rounding)?;
    // X_0 = ∂/∂t + b_i0 ∂/∂x_i
    let direction =
        |r: usize| -> Direction { if r == 0 { at.in_time(&drift) } else { at.along(frame[r - 1].clone()) } };
    // X_r of the components of X_s, s > 0, and of b_0
    let moved = |r: usize, s: usize| -> Result<Vec<f64>, Irregular> {
        if s == 0 {
            let point = derivation.once(at, &direction(r), rounding);
            return Ok(point.velocities()?.iter().map(|u| u.eps).collect());
        }
        let point = derivation.twice(at, &at.along_velocity(s - 1), &direction(r), rounding);
        Ok(point.velocities()?.iter().map(|u| u.eps.eps).collect())
    };
    let mut brackets = Vec::new();
    for (r, s) in (0..=k).flat_map(|r| (r + 1..=k).map(move |s| (r, s))) {
        let (left, right) = (moved(r, s)?, moved(s, r)?);
        brackets.push(left.iter().zip(right).map(|(a, b)| a - b).collect());
    }
    Ok((frame, brackets))
}

#[cfg(test)]
mod tests {
    use pc_algebra::{CATALOGUE, LieAlgebra};

    use super::*;

    #[test]
    fn the_table_is_that_of_the_catalogue() {
        let families = ["so5", "so6", "gl1", "gl3", "heisenberg5", "heisenberg7", "bianchi1"];
        let parameters = ["bianchi6(-1/4)", "bianchi6(-2)", "bianchi7(0.25)", "bianchi7( 3/4 )"];
        for name in CATALOGUE.iter().map(|entry| entry.name).chain(families).chain(parameters) {
            let (ours, known) = (Constants::named(name).unwrap(), LieAlgebra::named(name).unwrap());
            assert_eq!(ours.k, known.dim(), "{name}");
            for (r, s, m) in
                (0..ours.k).flat_map(|r| (0..ours.k).flat_map(move |s| (0..ours.k).map(move |m| (r, s, m))))
            {
                assert_eq!(
                    ours.get(r + 1, s + 1, m),
                    known.constant(r, s, m).to_f64(),
                    "{name}: [{r}, {s}], {m}"
                );
            }
        }
        assert_eq!(Constants::named("so17"), None);
    }
}
