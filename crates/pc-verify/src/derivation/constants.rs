//! Structure coefficients that are constant, and those of named algebras.

/// c_rs^m with r, s = 0..k and m = 1..k, stored at the index m − 1.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Constants {
    pub(crate) k: usize,
    values: Vec<f64>,
}

impl Constants {
    pub(crate) fn zero(k: usize) -> Constants {
        Constants { k, values: vec![0.0; (k + 1) * (k + 1) * k] }
    }

    pub(crate) fn get(&self, r: usize, s: usize, m: usize) -> f64 {
        self.values[(r * (self.k + 1) + s) * self.k + m]
    }

    /// Sets c_rs^m and c_sr^m.
    pub(crate) fn set(&mut self, r: usize, s: usize, m: usize, value: f64) {
        let k = self.k;
        self.values[(r * (k + 1) + s) * k + m] = value;
        self.values[(s * (k + 1) + r) * k + m] = -value;
    }

    /// The constants with [X_r, X_s] = value X_m for each entry, in which r, s and m are counted from 1.
    fn of(k: usize, brackets: &[(usize, usize, usize, f64)]) -> Constants {
        let mut constants = Constants::zero(k);
        brackets.iter().for_each(|&(r, s, m, value)| constants.set(r, s, m - 1, value));
        constants
    }

    /// The constants of a named algebra, as listed by `pc models --algebras`.
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

/// [X_1, X_2] = −a X_2 + n X_3, [X_1, X_3] = −X_2 − a X_3, where the latter lacks −X_2 if n = 0.
fn bianchi(a: f64, n: f64) -> Constants {
    Constants::of(3, &[(1, 2, 2, -a), (1, 2, 3, n), (1, 3, 2, -n.abs()), (1, 3, 3, -a)])
}

/// The constants of rotations L_i and translations P_i: [L_i, L_j] = ε_ijk L_k, [L_i, P_j] = ε_ijk P_k.
fn motions_of_space() -> Constants {
    let mut constants = Constants::zero(6);
    for (i, j, k) in [(1, 2, 3), (2, 3, 1), (3, 1, 2)] {
        constants.set(i, j, k - 1, 1.0);
        constants.set(i, j + 3, k + 2, 1.0);
        constants.set(j, i + 3, k + 2, -1.0);
    }
    constants
}

/// The constants of R_23, R_31, R_12, R_14, R_24, R_34, R_15, …, where R_ij turns axis i towards axis j:
/// [R_ij, R_jl] = −R_il, R_ji = −R_ij.
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
