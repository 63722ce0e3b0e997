//! Random linear systems in random units: their equilibrium takes one step of Newton's method.

use pc_analysis::{Conserved, EquilibriumSearch, Leaf, Linearizer, SteadyOptions};
use pc_mech::{Constraint, Expr, Graph, System};

/// Numbers between 0 and 1, the same on every run (D. H. Lehmer).
struct Random(u64);

impl Random {
    fn next(&mut self) -> f64 {
        self.0 = self.0 * 48_271 % 2_147_483_647;
        self.0 as f64 / 2_147_483_647.0
    }

    /// Between −1 and 1.
    fn signed(&mut self) -> f64 {
        2.0 * self.next() - 1.0
    }

    /// A power of ten between 10⁻ᵐ and 10ᵐ.
    fn unit(&mut self, m: i32) -> f64 {
        10f64.powi((f64::from(2 * m + 1) * self.next()) as i32 - m)
    }
}

/// In units of its own each system is moderate: M = 1, K = 1 + Bᵀ B, f and the constraint row c of order one. The equilibrium
/// and the reaction satisfy K x = f + cᵀ λ, c x = d.
struct Balance {
    stiffness: Vec<Vec<f64>>,
    force: Vec<f64>,
    row: Vec<f64>,
    level: f64,
}

impl Balance {
    fn random(n: usize, random: &mut Random) -> Balance {
        let b: Vec<Vec<f64>> = (0..n).map(|_| (0..n).map(|_| random.signed()).collect()).collect();
        let unit = |i: usize, j: usize| f64::from(u8::from(i == j));
        let entry = |i: usize, j: usize| unit(i, j) + (0..n).map(|l| b[l][i] * b[l][j]).sum::<f64>();
        let side = |random: &mut Random| random.signed().signum() * (0.3 + random.next());
        Balance {
            stiffness: (0..n).map(|i| (0..n).map(|j| entry(i, j)).collect()).collect(),
            force: (0..n).map(|_| random.signed()).collect(),
            row: (0..n).map(|_| side(random)).collect(),
            level: random.signed(),
        }
    }

    /// x and λ, by elimination with pivots.
    fn solved(&self) -> (Vec<f64>, f64) {
        let n = self.force.len();
        let mut rows: Vec<Vec<f64>> = (0..n)
            .map(|i| [self.stiffness[i].as_slice(), &[-self.row[i], self.force[i]]].concat())
            .chain([[self.row.as_slice(), &[0.0, self.level]].concat()])
            .collect();
        for step in 0..=n {
            let best = (step..=n).max_by(|&a, &b| rows[a][step].abs().total_cmp(&rows[b][step].abs()));
            rows.swap(step, best.unwrap());
            let pivot = rows[step].clone();
            for (_, row) in rows.iter_mut().enumerate().filter(|&(i, _)| i != step) {
                let factor = row[step] / pivot[step];
                row.iter_mut().zip(&pivot).for_each(|(x, p)| *x -= factor * p);
            }
        }
        let value = |i: usize| rows[i][n + 1] / rows[i][i];
        ((0..n).map(value).collect(), value(n))
    }
}

/// Systems of two to five coordinates with one constraint and a state that lags behind one of them, in units of energy between
/// 10⁻⁸ and 10⁸ and of length between 10⁻⁷ and 10⁷: beside a mass 10³¹ times as large, another would be taken for the square
/// of a rounding error.
#[test]
fn each_takes_one_step() {
    let mut random = Random(20_261_128);
    for number in 0..200 {
        let n = 2 + number % 4;
        let balance = Balance::random(n, &mut random);
        let (place, reaction) = balance.solved();
        let lengths: Vec<f64> = (0..n).map(|_| random.unit(7)).collect();
        let (energy, row_unit, state_unit) = (random.unit(8), random.unit(8), random.unit(8));

        let graph = Graph::new();
        let names: Vec<String> = (0..n).map(|i| format!("x{i}")).collect();
        let tie = graph.symbol("λ_tie");
        let lag = graph.symbol("z");
        let system = System::builder(&graph)
            .coordinates(names.iter().map(String::as_str))
            .lagrangian(|_, x, v| {
                let own = |i: usize| x[i] / lengths[i];
                let kinetic = (0..n).fold(Expr::ZERO, |sum, i| sum + (v[i] / lengths[i]).square() / 2.0);
                let potential = (0..n).fold(Expr::ZERO, |sum, i| {
                    let row = (0..n).fold(Expr::ZERO, |sum, j| sum + balance.stiffness[i][j] * own(j));
                    sum + own(i) * row / 2.0 - balance.force[i] * own(i)
                });
                energy * (kinetic - potential)
            })
            .state(lag, |_, x, _| state_unit * x[0] / lengths[0] - 3.0 * lag)
            .output("reaction", |_, _, _| tie)
            .build()
            .unwrap();
        let coordinates = system.frame().coordinates().to_vec();
        let sum = (0..n).fold(Expr::ZERO, |sum, i| sum + balance.row[i] * coordinates[i] / lengths[i]);
        let position = row_unit * (sum - balance.level);
        let held = system.with_multipliers(&[Constraint::new("tie", position)]).unwrap();
        let leaf = Leaf { positions: vec![position], ..Leaf::of(&system) };
        let mut linearizer = Linearizer::with_multipliers(&held, &leaf, &[]).unwrap();

        // From a place off the constraint by as much as its own size.
        let start: Vec<f64> = (0..n).map(|i| lengths[i] * random.signed()).collect();
        let start = [start, vec![0.0; n], vec![state_unit]].concat();
        let one = SteadyOptions::default().iterations(1);
        let found = linearizer.steady(0.0, &start, &one).unwrap_or_else(|error| panic!("{number}: {error}"));
        // The condition of the balance in its own units is below some thousands.
        for (i, &(_, value)) in found.state[..n].iter().enumerate() {
            assert!((value / lengths[i] - place[i]).abs() < 1e-11, "{number}: {value} {}", place[i]);
        }
        let state = found.state[2 * n].1 / state_unit;
        assert!((state - place[0] / 3.0).abs() < 1e-11, "{number}: {state}");
        let pull = found.output_values[0] * row_unit / energy;
        assert!((pull - reaction).abs() < 1e-10 * (1.0 + reaction.abs()), "{number}: {pull} {reaction}");

        if number % 10 == 0 {
            let conserved = Conserved::of(held.equations(), Some(&held), &leaf, &[]);
            let search = EquilibriumSearch::default().starts(20);
            let all = search.run(&mut linearizer, (0.0, &start), &conserved).unwrap();
            assert_eq!(all.list.len(), 1, "{number}");
            assert_eq!(all.converged, 20, "{number}");
        }
    }
}
