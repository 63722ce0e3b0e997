//! Poincaré's equations (9) of random frames and Lagrangians against Lagrange's, which need no frame.

use pc_mech::{Expr, Folding, Frame, Graph, Motion, System, VectorField};
use pc_tests::classical::SplitMix64;

use crate::definition::assert_definition;
use crate::jet::{Jet, VARIABLES, solve};

/// Sums of some dozens of terms and the solution of two systems of condition below 10: at most a few thousand units
/// of rounding of the largest term. A forgotten or turned term makes an error of order one.
const TOLERANCE: f64 = 1e-12;
const POINTS: usize = 5;

/// How quasi-velocities are described.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Form {
    /// ẋ = b η + b_0
    Velocities,
    /// η = a ẋ + a_0
    Definitions,
    /// The first, with one coordinate more, z = f(t, x), which the Lagrangian may use: n = k + 1.
    Redundant,
}

/// A random system with what is needed to write down Lagrange's equations for it.
struct Sample<'g> {
    system: System<'g>,
    form: Form,
    /// ẋ of the first k coordinates, or η, in terms of the other.
    relation: Vec<Expr<'g>>,
    /// z = f(t, x) of the redundant form.
    constraint: Expr<'g>,
}

/// Random functions of t and x, with coefficients that are multiples of 1/16.
struct Functions<'g, 'r> {
    random: &'r mut SplitMix64,
    t: Expr<'g>,
    x: Vec<Expr<'g>>,
}

impl<'g> Functions<'g, '_> {
    fn coefficient(&mut self, size: f64) -> Expr<'g> {
        Expr::ratio((16.0 * self.random.uniform(-size, size)).round() as i64, 16)
    }

    fn coordinate(&mut self) -> Expr<'g> {
        self.x[self.random.next_bits() as usize % self.x.len()]
    }

    /// A polynomial or a wave, at most 1 in size for |t|, |x| ≤ 1.
    fn function(&mut self) -> Expr<'g> {
        let (t, x, y) = (self.t, self.coordinate(), self.coordinate());
        let (a, b) = (self.coefficient(2.0), self.coefficient(2.0));
        match self.random.next_bits() % 6 {
            0 => (a * x + b * t + 0.5).sin(),
            1 => (a * x + b * y + t).cos(),
            2 => x * y,
            3 => t * x,
            4 => (x * x - t) / 2.0,
            _ => (t + a * x).sin() * y,
        }
    }

    /// `centre` plus something random, at most `size`.
    fn near(&mut self, centre: f64, size: f64) -> Expr<'g> {
        let amplitude = size * 0.6 + self.coefficient(size * 0.4);
        centre + amplitude * self.function()
    }

    /// ½ M_rs η_r η_s + l_s η_s − V, M within 1.2 ± 0.5 on and ± 0.2 off the diagonal, and for some also
    /// κ √(1 + η_s² + ½ η_1 η_2) + (η_1² + 2 η_2²)²/20 + w η_1² η_2/20.
    fn lagrangian(&mut self, eta: &[Expr<'g>], quadratic: bool) -> Expr<'g> {
        let k = eta.len();
        let mut lagrangian = -2.0 * self.function() + self.function();
        for r in 0..k {
            lagrangian += self.near(1.2, 0.5) * eta[r].square() / 2.0 + self.near(0.0, 1.5) * eta[r];
            for s in r + 1..k {
                lagrangian += self.near(0.0, 0.2) * eta[r] * eta[s];
            }
        }
        if !quadratic {
            let squares: Expr<'g> = eta.iter().map(|eta| eta.square()).sum();
            lagrangian += self.near(0.6, 0.3) * (1.0 + squares + eta[0] * eta[1] / 2.0).sqrt();
            lagrangian += (eta[0].square() + 2.0 * eta[1].square()).square() / 20.0;
            lagrangian += self.function() * eta[0].square() * eta[1] / 20.0;
        }
        lagrangian
    }
}

fn names(letter: &str, count: usize) -> Vec<String> {
    (1..=count).map(|i| format!("{letter}{i}")).collect()
}

/// The random system number `seed` with k quasi-velocities.
fn sample(graph: &Graph, seed: u64, k: usize, form: Form) -> Sample<'_> {
    let mut random = SplitMix64::new(seed);
    let symbols =
        |letter: &str| -> Vec<Expr<'_>> { names(letter, k).iter().map(|name| graph.symbol(name)).collect() };
    let (t, x, rates, eta) = (graph.symbol("t"), symbols("x"), symbols("v"), symbols("w"));
    let mut functions = Functions { random: &mut random, t, x: x.clone() };

    // Dominated by its diagonal, so that it can be inverted everywhere.
    let given = if form == Form::Definitions { &rates } else { &eta };
    let relation: Vec<Expr<'_>> = (0..k)
        .map(|i| {
            let entry = |j: usize| if i == j { (1.5, 0.4) } else { (0.0, 0.4) };
            let linear: Vec<Expr<'_>> =
                (0..k).map(|j| functions.near(entry(j).0, entry(j).1) * given[j]).collect();
            graph.sum(linear) + functions.near(0.0, 1.0)
        })
        .collect();

    let mut coordinates = names("x", k);
    let mut velocities = relation.clone();
    let constraint = functions.function() + functions.function();
    if form == Form::Redundant {
        coordinates.push("z".to_owned());
        let along = (0..k).map(|i| constraint.derivative(x[i]) * relation[i]);
        velocities.push(graph.sum(along) + constraint.derivative(t));
        functions.x.push(graph.symbol("z"));
    }
    let quadratic = functions.random.next_bits().is_multiple_of(3);
    let lagrangian = functions.lagrangian(&eta, quadratic);
    let forces: Vec<Expr<'_>> =
        (0..k).map(|s| functions.function() + functions.function() * eta[(s + 1) % k]).collect();

    let builder = System::builder(graph)
        .coordinates(&coordinates)
        .quasi_velocities(names("w", k))
        .lagrangian(|_, _, _| lagrangian)
        .forces(|_, _, _| forces);
    let builder = match form {
        Form::Definitions => builder.frame(Frame::from_definitions(graph, t, x, &rates, &relation).unwrap()),
        Form::Velocities | Form::Redundant => builder.kinematics(|_, _, _| velocities),
    };
    let near = |name: &String, value: f64| (graph.symbol(name), value);
    let builder = builder.near(coordinates.iter().map(|name| near(name, 0.3)));
    Sample { system: builder.build().unwrap(), form, relation, constraint }
}

impl<'g> Sample<'g> {
    /// `expressions` as functions of (t, x, ẋ); what stands for them in `also` has values of its own.
    fn at(&self, expressions: &[Expr<'g>], point: &[Jet], also: &[(Expr<'g>, Jet)]) -> Vec<Jet> {
        let graph = self.system.graph();
        let k = self.system.quasi_velocities().len();
        let mut values = vec![(graph.symbol("t"), point[0])];
        values.extend(names("x", k).iter().zip(&point[1..]).map(|(name, &jet)| (graph.symbol(name), jet)));
        values.extend(also);
        graph.evaluate(expressions, &values).unwrap()
    }

    /// η(t, x, ẋ).
    fn quasi_velocities(&self, point: &[Jet]) -> Vec<Jet> {
        let k = self.relation.len();
        let graph = self.system.graph();
        let symbols =
            |letter: &str| -> Vec<Expr<'g>> { names(letter, k).iter().map(|n| graph.symbol(n)).collect() };
        if self.form == Form::Definitions {
            let velocities: Vec<_> = symbols("v").into_iter().zip(point[1 + k..].iter().copied()).collect();
            return self.at(&self.relation, point, &velocities);
        }
        // ẋ at η = 0 is b_0, and at the unit vectors b_0 + b_s.
        let eta = symbols("w");
        let columns: Vec<Vec<Jet>> = (0..=k)
            .map(|s| {
                let unit = |r: usize| Jet::constant(if r + 1 == s { 1.0 } else { 0.0 });
                let values: Vec<_> = eta.iter().enumerate().map(|(r, &eta)| (eta, unit(r))).collect();
                self.at(&self.relation, point, &values)
            })
            .collect();
        let b = (0..k).map(|i| (1..=k).map(|s| columns[s][i] - columns[0][i]).collect()).collect();
        let moving = (0..k).map(|i| point[1 + k + i] - columns[0][i]).collect();
        solve(b, moving)
    }

    /// η̇ by Lagrange's equations M̂ ẍ = ∂L̂/∂x − (∂²L̂/∂ẋ∂x) ẋ − ∂²L̂/∂ẋ∂t + Q̂, with Q̂ = Q ∂η/∂ẋ and
    /// L̂(t, x, ẋ) = L(t, x, η(t, x, ẋ)); and the size of the largest term. `place` is (t, x, ẋ).
    fn lagrange(&self, place: &[f64]) -> (Vec<f64>, f64) {
        let k = self.relation.len();
        let point: Vec<Jet> = place.iter().enumerate().map(|(i, &v)| Jet::variable(v, i)).collect();
        let eta = self.quasi_velocities(&point);
        let mut also: Vec<_> =
            self.system.quasi_velocities().iter().copied().zip(eta.iter().copied()).collect();
        if self.form == Form::Redundant {
            also.push((self.system.graph().symbol("z"), self.at(&[self.constraint], &point, &[])[0]));
        }
        let lagrangian = self.at(&[self.system.lagrangian()], &point, &also)[0];
        let forces = self.at(self.system.forces(), &point, &also);

        let mut size = 1.0f64;
        let mut term = |value: f64| {
            size = size.max(value.abs());
            value
        };
        let (x, v) = (|i: usize| 1 + i, |i: usize| 1 + k + i);
        let mut right = Vec::with_capacity(k);
        for i in 0..k {
            let second = lagrangian.hessian[v(i)];
            let mut sum = term(lagrangian.gradient[x(i)]) - term(second[0]);
            for j in 0..k {
                sum += term(forces[j].value * eta[j].gradient[v(i)]) - term(second[x(j)] * place[v(j)]);
            }
            right.push(Jet::constant(sum));
        }
        let mass =
            (0..k).map(|i| (0..k).map(|j| Jet::constant(lagrangian.hessian[v(i)][v(j)])).collect()).collect();
        let acceleration = solve(mass, right);
        let mut rates = Vec::with_capacity(k);
        for s in 0..k {
            let slope = eta[s].gradient;
            let mut rate = term(slope[0]);
            for j in 0..k {
                rate += term(slope[x(j)] * place[v(j)]) + term(slope[v(j)] * acceleration[j].value);
            }
            rates.push(rate);
        }
        (rates, size)
    }

    /// The derived equations at `place` = (t, x, η) are Lagrange's.
    fn assert_lagrange(&self, motion: &mut Motion, random: &mut SplitMix64, label: &str) {
        let k = self.relation.len();
        let place: Vec<f64> = (0..1 + 2 * k).map(|_| random.uniform(-1.0, 1.0)).collect();
        let point: Vec<Jet> = place.iter().enumerate().map(|(i, &v)| Jet::variable(v, i)).collect();
        let mut state = place[1..=k].to_vec();
        if self.form == Form::Redundant {
            state.push(self.at(&[self.constraint], &point, &[])[0].value);
        }
        state.extend(self.quasi_velocities(&point).iter().map(|eta| eta.value));
        let mut derived = vec![f64::NAN; state.len()];
        motion.rhs(place[0], &state, &mut derived).unwrap_or_else(|error| panic!("{error}"));
        let (expected, size) = self.lagrange(&place);
        let (velocities, accelerations) = derived.split_at(state.len() - k);
        let kinematics = velocities.iter().zip(&place[1 + k..]);
        for (found, expected) in kinematics.chain(accelerations.iter().zip(&expected)) {
            let error = (found - expected).abs() / size;
            assert!(error <= TOLERANCE, "{label} at {place:?}: {found}, not {expected}: {error:e}");
        }
    }
}

fn assert_lagrange(seeds: std::ops::Range<u64>, k: usize, form: Form, folding: Folding) {
    assert!(2 * k < VARIABLES);
    let (mut drifting, mut varying) = (0, 0);
    for seed in seeds.clone() {
        let graph = Graph::with_folding(folding);
        let sample = sample(&graph, seed, k, form);
        let brackets: Vec<_> = sample.system.structure().nonzero().collect();
        drifting += usize::from(brackets.iter().any(|&(r, ..)| r == 0));
        varying += usize::from(brackets.iter().any(|&(r, _, _, c)| r > 0 && c.constant().is_none()));
        let mut motion = sample.system.poincare().unwrap().compile().unwrap();
        let mut random = SplitMix64::new(1000 + seed);
        for _ in 0..POINTS {
            sample.assert_lagrange(&mut motion, &mut random, &format!("{form:?}, k = {k}, seed {seed}"));
        }
    }
    let systems = seeds.count();
    assert!(
        drifting * 10 >= systems * 9 && varying * 10 >= systems * 9,
        "{drifting}, {varying} of {systems}"
    );
}

#[test]
fn equation_9_of_two_velocities_in_a_random_frame() {
    assert_lagrange(0..64, 2, Form::Velocities, Folding::ByValue);
}

#[test]
fn equation_9_of_three_velocities_in_a_random_frame() {
    assert_lagrange(100..164, 3, Form::Velocities, Folding::ByValue);
}

#[test]
fn equation_9_of_two_velocities_by_random_definitions() {
    assert_lagrange(200..264, 2, Form::Definitions, Folding::ByValue);
}

#[test]
fn equation_9_of_three_velocities_by_random_definitions() {
    assert_lagrange(300..332, 3, Form::Definitions, Folding::ByValue);
}

#[test]
fn equation_9_of_two_velocities_and_a_redundant_coordinate() {
    assert_lagrange(400..464, 2, Form::Redundant, Folding::ByValue);
}

#[test]
fn equation_9_without_folding_by_value() {
    assert_lagrange(0..16, 2, Form::Velocities, Folding::Structural);
    assert_lagrange(100..104, 3, Form::Velocities, Folding::Structural);
    assert_lagrange(200..208, 2, Form::Definitions, Folding::Structural);
    assert_lagrange(400..408, 2, Form::Redundant, Folding::Structural);
}

#[test]
fn equation_9_of_random_frames_is_that_of_the_definition() {
    let kinds = [(0, 2, Form::Velocities), (100, 3, Form::Velocities), (200, 2, Form::Definitions)];
    for (first, k, form) in kinds.into_iter().chain([(400, 2, Form::Redundant)]) {
        for seed in first..first + 6 {
            let coordinates = if form == Form::Redundant { k + 1 } else { k };
            let name = format!("{form:?}, k = {k}, seed {seed}");
            assert_definition(
                &name,
                |graph| sample(graph, seed, k, form).system,
                &vec![0.2; coordinates + k],
            );
        }
    }
}
