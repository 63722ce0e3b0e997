//! Equations (30) and their reactions against Lagrange's multipliers, and against the forms (32), (34) and (35).

use pc_mech::{Constraint, Expr, Graph, Multipliers, System, VectorField};
use pc_nonholo::{Constrained, Voronets};
use pc_tests::classical::SplitMix64;
use pc_tests::nonholonomic::{Nonholonomic, SYSTEMS};

const STATES: usize = 1000;

/// Rounding of the factorisation of matrices whose condition is some hundreds, times that of the random states.
const TOLERANCE: f64 = 1e-11;

fn assert_near(found: f64, expected: f64, size: f64, what: &str) {
    assert!((found - expected).abs() <= TOLERANCE * (1.0 + size), "{what}: {found} instead of {expected}");
}

fn largest(values: &[f64]) -> f64 {
    values.iter().fold(0.0, |size, value| size.max(value.abs()))
}

/// The rates of the free quasi-velocities and the reactions by (30), then by multipliers in the quasi-velocities.
fn compare(described: &Nonholonomic) {
    let graph = Graph::new();
    let system = (described.system)(&graph).unwrap();
    let vanishing = described.constraints(&graph);
    let constrained = Constrained::new(&system, &vanishing).unwrap();
    let mut motion = constrained.equations().compile().unwrap();
    let reactions = constrained.reactions();
    let constraints: Vec<Constraint<'_>> =
        described.vanishing.iter().zip(&vanishing).map(|(name, &eta)| Constraint::new(*name, eta)).collect();
    let multipliers = system.with_multipliers(&constraints).unwrap().observe_reactions();
    let mut held = multipliers.compile().unwrap();

    let n = motion.coordinates();
    let (l, m) = (motion.dim() - n, vanishing.len());
    let mut random = SplitMix64::new(0x51ed);
    for _ in 0..STATES {
        let (t, y) = (described.sample)(&mut random);
        let mut whole = y.clone();
        whole.extend(std::iter::repeat_n(0.0, m));
        let (mut expected, mut found) = (vec![0.0; n + l], vec![0.0; n + l + m]);
        motion.rhs(t, &y, &mut expected).unwrap();
        held.rhs(t, &whole, &mut found).unwrap();
        let size = largest(&expected);
        for i in 0..n + l {
            assert_near(found[i], expected[i], size, described.name);
        }
        assert!(found[n + l..].iter().all(|rate| rate.abs() <= TOLERANCE * (1.0 + size)));

        let state = motion.names().iter().map(|name| graph.symbol(name)).zip(y.iter().copied());
        let parameters = system.parameters().iter().copied();
        let values: Vec<(Expr<'_>, f64)> = state.chain(parameters).chain([(graph.symbol("t"), t)]).collect();
        let reactions = graph.evaluate(&reactions, &values).unwrap();
        let observed = held.observe(t, &whole);
        for (reaction, multiplier) in reactions.iter().zip(&observed[observed.len() - m..]) {
            assert_near(*multiplier, *reaction, size.max(reaction.abs()), described.name);
        }
    }
}

/// A system with its constraints, (30), and what they say of the rates of functions.
struct Case<'g> {
    graph: &'g Graph,
    system: System<'g>,
    constrained: Constrained<'g>,
    /// ẋ and η̇ by (30), and ṫ = 1.
    along: Vec<(Expr<'g>, Expr<'g>)>,
}

impl<'g> Case<'g> {
    fn new(described: &Nonholonomic, graph: &'g Graph) -> Case<'g> {
        let system = (described.system)(graph).unwrap();
        let constrained = Constrained::new(&system, &described.constraints(graph)).unwrap();
        let equations = constrained.equations();
        let x = system.frame().coordinates().iter().copied().zip(equations.velocities().iter().copied());
        let eta = equations.system().quasi_velocities().iter().copied().zip(equations.accelerations());
        let along = x.chain(eta).chain([(graph.symbol("t"), Expr::ONE)]).collect();
        Case { graph, system, constrained, along }
    }

    fn rates(&self, functions: &[Expr<'g>]) -> Vec<Expr<'g>> {
        self.graph.directional(functions, &self.along)
    }

    /// The constraints in the velocities of the coordinates.
    fn in_velocities(&self, described: &Nonholonomic) -> Multipliers<'g> {
        let (a, a0) = self.system.frame().definitions().unwrap();
        let x = self.system.frame().coordinates();
        let velocities: Vec<Expr<'g>> = x.iter().map(|x| self.graph.symbol(&format!("{x}'"))).collect();
        let constraint = |name: &&str| {
            let slip = self.graph.symbol(name);
            let row = self.system.quasi_velocities().iter().position(|eta| *eta == slip).unwrap();
            let moving = self.graph.dot(a.row(row).iter().copied(), velocities.iter().copied());
            Constraint::new(*name, moving + a0[row])
        };
        let constraints: Vec<Constraint<'g>> = described.vanishing.iter().map(constraint).collect();
        self.system.in_velocities().unwrap().with_multipliers(&constraints).unwrap()
    }

    /// Values of time, coordinates, free quasi-velocities and parameters.
    fn values(&self, (t, y): (f64, &[f64])) -> Vec<(Expr<'g>, f64)> {
        let eta = self.constrained.equations().system().quasi_velocities();
        let state = self.system.frame().coordinates().iter().chain(eta).copied().zip(y.iter().copied());
        state.chain(self.system.parameters().iter().copied()).chain([(self.graph.symbol("t"), t)]).collect()
    }
}

/// Those systems that have as many quasi-velocities as coordinates.
fn square(described: &&Nonholonomic) -> bool {
    let graph = Graph::new();
    let system = (described.system)(&graph).unwrap();
    system.frame().coordinates().len() == system.quasi_velocities().len()
}

/// ẍ by (30), then by multipliers in the velocities ẋ: a mass matrix and constraints that are full.
fn compare_in_velocities(described: &Nonholonomic) {
    let graph = Graph::new();
    let case = Case::new(described, &graph);
    let velocities = case.constrained.equations().velocities();
    let accelerations = case.rates(velocities);
    let mut held = case.in_velocities(described).compile().unwrap();
    let n = velocities.len();
    let mut random = SplitMix64::new(0xd15c);
    for _ in 0..STATES {
        let (t, y) = (described.sample)(&mut random);
        let values = case.values((t, &y));
        let expected = graph.evaluate(&accelerations, &values).unwrap();
        let rates = graph.evaluate(velocities, &values).unwrap();
        let whole = [&y[..n], &rates].concat();
        let mut found = vec![0.0; 2 * n];
        held.rhs(t, &whole, &mut found).unwrap();
        let size = largest(&expected).max(largest(&rates).powi(2));
        for (found, expected) in found[n..].iter().zip(&expected) {
            assert_near(*found, *expected, size, described.name);
        }
    }
}

/// (32): mass matrix and right-hand side are the same functions.
#[test]
fn equation_32_with_the_constrained_energy_is_equation_30() {
    for described in SYSTEMS {
        let graph = Graph::new();
        let case = Case::new(described, &graph);
        let (found, expected) =
            (case.constrained.free_system().unwrap().poincare().unwrap(), case.constrained.equations());
        let masses = [&found, expected].map(|equations| equations.mass_matrix().entries().into_owned());
        let pairs = masses[0].iter().zip(&masses[1]);
        for (found, expected) in pairs.chain(found.right_hand_side().iter().zip(expected.right_hand_side())) {
            assert!((*found - *expected).is_zero(), "{}: {found} instead of {expected}", described.name);
        }
        assert!((found.energy() - expected.energy()).is_zero(), "{}", described.name);
    }
}

/// (34): ẏ_s is the rate of ∂θ/∂η_s by (30).
#[test]
fn equation_34_in_momenta_is_equation_30() {
    for described in SYSTEMS {
        let graph = Graph::new();
        let case = Case::new(described, &graph);
        let canonical = case.constrained.free_system().unwrap().canonical().unwrap();
        let momenta = canonical.momenta_of_velocities().to_vec();
        let expected = case.rates(&momenta);
        let known: Vec<_> = canonical.momenta().iter().copied().zip(momenta).collect();
        let found = graph.substitute(canonical.right_hand_side(), &known);
        let velocities = graph.substitute(canonical.velocities(), &known);
        let mut random = SplitMix64::new(0x34);
        for _ in 0..STATES {
            let (t, y) = (described.sample)(&mut random);
            let values = case.values((t, &y));
            let (found, expected) =
                (graph.evaluate(&found, &values).unwrap(), graph.evaluate(&expected, &values).unwrap());
            let speeds = graph.evaluate(&velocities, &values).unwrap();
            let rates = graph.evaluate(case.constrained.equations().velocities(), &values).unwrap();
            let size = largest(&expected).max(largest(&rates).powi(2));
            for (found, expected) in found.iter().zip(&expected).chain(speeds.iter().zip(&rates)) {
                assert_near(*found, *expected, size, described.name);
            }
        }
    }
}

/// Where neither L nor the constraints nor the forces depend on the coordinates whose velocities the constraints give.
const CHAPLYGIN: [&str; 7] = [
    "chaplygin-sleigh",
    "stiff-sleigh",
    "tilted-disk",
    "vertical-disk",
    "particle",
    "snakeboard",
    "snakeboard-driven",
];

/// (35): the ẍ_i of Voronets' equations, which are Chaplygin's for some systems.
#[test]
fn equation_35_of_voronets_is_equation_30() {
    for described in SYSTEMS.iter().filter(square) {
        let graph = Graph::new();
        let case = Case::new(described, &graph);
        let (t, y) = (described.sample)(&mut SplitMix64::new(1));
        let mut at = case.values((t, &y));
        let velocities = case.system.frame().coordinates().iter().map(|x| graph.symbol(&format!("{x}'")));
        at.extend(velocities.map(|v| (v, 1.0)));
        let voronets = Voronets::new(&case.in_velocities(described), &at).unwrap();
        assert_eq!(voronets.is_chaplygin(), CHAPLYGIN.contains(&described.name), "{}", described.name);
        let equations = voronets.system().unwrap().poincare().unwrap();
        let found = equations.accelerations();
        let x = case.system.frame().coordinates();
        let place = |v: &Expr<'_>| x.iter().position(|x| format!("{x}'") == v.to_string()).unwrap();
        let places: Vec<usize> = equations.system().quasi_velocities().iter().map(place).collect();
        let speeds = case.constrained.equations().velocities();
        let accelerations = case.rates(speeds);
        let expected: Vec<Expr<'_>> = places.iter().map(|&i| accelerations[i]).collect();
        let known: Vec<_> = equations
            .system()
            .quasi_velocities()
            .iter()
            .copied()
            .zip(places.iter().map(|&i| speeds[i]))
            .collect();
        let found = graph.substitute(&found, &known);
        let mut random = SplitMix64::new(0x35);
        let mut compared = 0;
        for _ in 0..STATES {
            let (t, y) = (described.sample)(&mut random);
            let values = case.values((t, &y));
            let (found, expected) =
                (graph.evaluate(&found, &values).unwrap(), graph.evaluate(&expected, &values).unwrap());
            let speeds = graph.evaluate(speeds, &values).unwrap();
            // The choice of the independent velocities is singular at states of measure zero; near them rounding grows.
            let regular = y.iter().all(|y| y.cos().abs() > 0.05 && y.sin().abs() > 0.05);
            if !regular {
                continue;
            }
            compared += 1;
            let size = 100.0 * (largest(&expected) + largest(&speeds).powi(2));
            for (found, expected) in found.iter().zip(&expected) {
                assert_near(*found, *expected, size, described.name);
            }
        }
        assert!(compared > STATES / 4);
    }
}

#[test]
fn equation_30_is_that_with_multipliers() {
    for described in SYSTEMS {
        compare(described);
    }
}

/// All but the balls and Suslov's body, whose attitude is a quaternion.
#[test]
fn equation_30_is_that_with_multipliers_in_velocities() {
    let compared: Vec<&Nonholonomic> = SYSTEMS.iter().filter(square).collect();
    assert_eq!(compared.len(), SYSTEMS.len() - 4);
    compared.into_iter().for_each(compare_in_velocities);
}
