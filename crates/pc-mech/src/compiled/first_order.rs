//! First-order systems whose rates contain the solution of linear equations.

use std::cell::OnceCell;
use std::collections::{BTreeMap, BTreeSet, HashMap};
use std::rc::Rc;

use pc_algebra::Matrix;
use pc_expr::{Expr, Graph, Inputs, Pattern, Program, Substitution, SymbolPlaces};

use crate::compiled::elimination::columns::{SparseColumn, nonzeros};
use crate::compiled::elimination::symbolic_ldl::Factors;
use crate::compiled::options::TreeElimination;
use crate::compiled::projection::unit_quaternions::UnitQuaternions;
use crate::equations::poincare::Equations;
use crate::points::equations::PointEquations;
use crate::system::holds::Hold;
use crate::tree::equations::TreeEquations;

/// The system ẏ = g(t, y, w), whose unknowns w solve M(t, y) w = r(t, y) with M symmetric, or, more
/// generally,
///
///   p(t, y, w) = r(t, y),   M(t, y, w) = ∂p/∂w.
///
/// Poincaré's equations (9) are the case w = η̇ of y = (x, η), g = (b η + b_0, w). Parameters may occur in
/// g, p, M and r.
#[derive(Clone, Debug)]
pub(crate) struct FirstOrder<'g> {
    pub(crate) graph: &'g Graph,
    pub(crate) time: Expr<'g>,
    /// The symbols for the components of y, coordinates first.
    pub(crate) state: Vec<Expr<'g>>,
    /// Number of coordinates.
    pub(crate) coordinates: usize,
    /// Number of first-order states, which come last.
    pub(crate) states: usize,
    /// The parameters with their values.
    pub(crate) parameters: Vec<(Expr<'g>, f64)>,
    /// Parameters that may change at each evaluation: functions of time, and external forces.
    pub(crate) varying: Vec<Expr<'g>>,
    /// The k symbols of w.
    pub(crate) unknowns: Vec<Expr<'g>>,
    /// The names of the unknowns in messages: the quasi-velocities.
    pub(crate) names: Vec<String>,
    /// The number of multipliers, which are the last unknowns: their block of M is zero.
    pub(crate) multipliers: usize,
    /// The number of independent constraints, whose multipliers come first.
    pub(crate) rank: usize,
    /// The k × k matrix M; it has no entries for a tree, which is eliminated joint by joint.
    pub(crate) mass: Matrix<Expr<'g>>,
    /// The equations M w = r of a tree, if M and r are not written out.
    pub(crate) tree: Option<Rc<TreeEquations<'g>>>,
    /// The same equations for bodies that carry one another, which are eliminated link by link.
    pub(crate) points: Option<Rc<PointEquations<'g>>>,
    /// The function p, if it differs from M w.
    pub(crate) implicit: Option<Implicit<'g>>,
    /// r, in t and y.
    pub(crate) right: Vec<Expr<'g>>,
    /// The rates g as functions of t, y and w, one per component of the state.
    pub(crate) rates: Vec<Expr<'g>>,
    /// Symbols by whose powers the unknowns are collected.
    pub(crate) collected_by: Vec<Expr<'g>>,
    /// Functions of t, y and w, with their names; the first `conserved` should not change along a motion.
    pub(crate) observables: Vec<(String, Expr<'g>)>,
    pub(crate) conserved: usize,
    /// The quaternions among the coordinates.
    pub(crate) quaternions: UnitQuaternions,
    /// What holds velocities at zero.
    pub(crate) holds: Vec<Hold<'g>>,
}

/// The left-hand side of p(t, y, w) = r(t, y), which is not linear in w.
#[derive(Clone, Debug)]
pub(crate) struct Implicit<'g> {
    /// The k components of p.
    pub(crate) left: Vec<Expr<'g>>,
    /// The w from which the iteration starts.
    pub(crate) guess: Vec<f64>,
}

impl<'g> FirstOrder<'g> {
    /// The inverse M⁻¹ in the form in which it is applied.
    pub(crate) fn factors(&self) -> Factors<'g> {
        match (&self.tree, &self.points) {
            (Some(tree), _) => Factors::Tree(Rc::clone(tree)),
            (None, Some(points)) => Factors::Points(Rc::clone(points)),
            (None, None) => Factors::of(self.graph, &self.mass),
        }
    }

    /// The number of operations needed to compute ẏ when it is written out.
    pub(crate) fn operations(&self) -> usize {
        let unknowns = self.solve(&self.factors());
        let values: Vec<_> = self.unknowns.iter().copied().zip(unknowns).collect();
        let rates = self.graph.substitute(&self.rates, &values);
        Program::new(self.graph, &self.inputs(&[]), &rates)
            .map_or(usize::MAX, |program| program.cost().total())
    }

    /// The inputs (t, (y, `more`), p) of a program.
    pub(crate) fn inputs(&self, more: &[Expr<'g>]) -> Inputs<'g> {
        Inputs {
            time: Some(self.time),
            state: self.state.iter().chain(more).copied().collect(),
            parameters: self.parameter_symbols(),
        }
    }

    pub(crate) fn parameter_symbols(&self) -> Vec<Expr<'g>> {
        self.parameters.iter().map(|&(symbol, _)| symbol).collect()
    }

    /// The unknowns w = M⁻¹ r; an unknown that is a single quotient is then simplified once more.
    pub(crate) fn solve(&self, factors: &Factors<'g>) -> Vec<Expr<'g>> {
        if let Some(tree) = &self.tree {
            return tree.system.in_order(&tree.dynamics.accelerations());
        }
        if let Some(points) = &self.points {
            return points.accelerations();
        }
        let mut unknowns = factors.solve(self.graph, &self.right);
        let decoupled = |s: usize| self.mass.nonzero(s).all(|(r, _)| r == s);
        let single: Vec<usize> = (0..unknowns.len()).filter(|&s| decoupled(s)).collect();
        let fixed = self.are_fixed(&single.iter().map(|&s| self.mass[(s, s)]).collect::<Vec<_>>());
        let single: Vec<usize> =
            single.into_iter().zip(fixed).filter_map(|(s, is_fixed)| (!is_fixed).then_some(s)).collect();
        let long: Vec<Expr<'g>> = single.iter().map(|&s| unknowns[s]).collect();
        for (s, short) in single.into_iter().zip(self.graph.shorten(&long, &self.collected_by)) {
            unknowns[s] = short;
        }
        unknowns
    }

    /// Whether each of the expressions contains parameters only.
    pub(crate) fn are_fixed(&self, expressions: &[Expr<'g>]) -> Vec<bool> {
        self.graph.are_made_of(expressions, &self.parameter_symbols())
    }

    /// The pattern of the lower triangle of M, and its nonzero entries.
    pub(crate) fn lower_triangle(&self) -> (Pattern, Vec<Expr<'g>>) {
        let k = self.unknowns.len();
        let mut columns = vec![Vec::new(); k];
        for i in 0..k {
            let below = self.mass.nonzero(i).filter(|&(j, _)| j <= i);
            below.for_each(|(j, entry)| columns[j].push((i, entry)));
        }
        nonzeros(k, columns)
    }

    /// The residual F = r − M w or r − p, as a function of t, y and w.
    pub(crate) fn balance(&self) -> Vec<Expr<'g>> {
        if let Some(tree) = &self.tree {
            return tree.system.in_order(&tree.dynamics.balance(&tree.system.by_link(&self.unknowns)));
        }
        let product = |s: usize| self.graph.sum(self.mass.nonzero(s).map(|(r, m)| m * self.unknowns[r]));
        let left = |s: usize| self.implicit.as_ref().map_or_else(|| product(s), |p| p.left[s]);
        self.right.iter().enumerate().map(|(s, &right)| right - left(s)).collect()
    }

    /// The expressions of which the equations consist: M, r, the forces of a tree, g and p.
    pub(crate) fn terms(&self) -> Vec<Expr<'g>> {
        let of_tree = self.tree.iter().flat_map(|tree| tree.dynamics.forces());
        let left = self.implicit.iter().flat_map(|implicit| implicit.left.iter().copied());
        let own = self.right.iter().chain(&self.rates).copied();
        self.mass.nonzero_entries().into_iter().chain(of_tree).chain(own).chain(left).collect()
    }

    /// The system with others in place of its [`terms`](FirstOrder::terms).
    pub(crate) fn with_terms(&self, terms: &[Expr<'g>]) -> FirstOrder<'g> {
        let (mass, mut rest) = terms.split_at(self.mass.nonzero_entries().len());
        let mut take = |count: usize| {
            let (taken, left) = rest.split_at(count);
            rest = left;
            taken.to_vec()
        };
        let tree = self.tree.as_ref().map(|tree| {
            let forces = take(tree.dynamics.forces().len());
            let dynamics = tree.dynamics.clone().with_forces(&forces);
            Rc::new(TreeEquations { dynamics, system: tree.system.clone() })
        });
        let (right, rates) = (take(self.right.len()), take(self.rates.len()));
        let left = self.implicit.as_ref().map_or(0, |implicit| implicit.left.len());
        let left = take(left);
        let implicit = self.implicit.clone().map(|implicit| Implicit { left, ..implicit });
        FirstOrder {
            mass: self.mass.with_nonzero_entries(mass),
            tree,
            right,
            rates,
            implicit,
            ..self.clone()
        }
    }

    /// The system with further forces on its quasi-velocities.
    pub(crate) fn pushed(&self, forces: &[Expr<'g>]) -> FirstOrder<'g> {
        if let Some(tree) = &self.tree {
            let further = tree.system.by_link(forces).into_iter().flatten();
            let further = vec![Expr::ZERO; 3].into_iter().chain(further);
            let all = tree.dynamics.forces().into_iter().zip(further).map(|(force, more)| force + more);
            let dynamics = tree.dynamics.clone().with_forces(&all.collect::<Vec<_>>());
            let tree = Some(Rc::new(TreeEquations { dynamics, system: tree.system.clone() }));
            return FirstOrder { tree, ..self.clone() };
        }
        let mut pushed = self.clone();
        pushed.right.iter_mut().zip(forces).for_each(|(right, force)| *right += *force);
        pushed
    }

    /// The system with its observables in place of its rates, to differentiate them.
    pub(crate) fn with_observables_as_rates(&self) -> FirstOrder<'g> {
        let rates = self.observables.iter().map(|&(_, value)| value).collect();
        FirstOrder { rates, ..self.clone() }
    }

    /// The nonzero entries of each row of ∂g/∂w with their columns.
    pub(crate) fn coupling(&self) -> Vec<SparseColumn<'g>> {
        self.graph.jacobian(&self.rates, &self.unknowns)
    }

    /// One new symbol for each of `symbols`, with `mark` prefixed to its name.
    pub(crate) fn fresh(&self, mark: &str, symbols: &[Expr<'g>]) -> Vec<Expr<'g>> {
        let equations = [self.balance(), self.rates.clone(), self.mass.nonzero_entries()].concat();
        let inputs = self.inputs(&self.unknowns);
        let mut taken = self.graph.symbols_of(&equations);
        taken.extend(inputs.time.iter().chain(&inputs.state).chain(&inputs.parameters));
        let taken = SymbolPlaces::of(&taken);
        let free = |symbol: &Expr<'g>| {
            let longer =
                std::iter::successors(Some(format!("{mark}{symbol}")), |name| Some(format!("{mark}{name}")));
            longer.map(|name| self.graph.symbol(&name)).find(|&name| !taken.contains(name)).unwrap_or(*symbol)
        };
        symbols.iter().map(free).collect()
    }
}

impl<'g> Equations<'g> {
    /// The k accelerations η̇ = M⁻¹ r.
    pub fn accelerations(&self) -> Vec<Expr<'g>> {
        let first_order = self.written_first_order();
        first_order.solve(&first_order.factors())
    }

    /// The system with M and r written out.
    fn written_first_order(&self) -> FirstOrder<'g> {
        let is_large = self.system.tree.as_ref().is_some_and(|tree| tree.is_large());
        self.shortest_first_order(if is_large { TreeElimination::ByJoints } else { TreeElimination::Whole })
    }

    /// One new symbol for each of `symbols`, with `mark` prefixed to its name.
    pub(crate) fn new_symbols(&self, mark: &str, symbols: &[Expr<'g>]) -> Vec<Expr<'g>> {
        self.written_first_order().fresh(mark, symbols)
    }

    /// Inverse dynamics: the k generalised forces M η̇ − r that have to be added to Q to obtain the
    /// accelerations η̇, whose [symbols](crate::System::accelerations) they contain. For a large tree the
    /// forces are computed body by body, in O(N) operations.
    pub fn inverse_dynamics(&self) -> Vec<Expr<'g>> {
        self.written_first_order().balance().into_iter().map(|left| -left).collect()
    }

    /// The first-order system; for a tree it is solved joint by joint if that takes fewer operations.
    pub(crate) fn shortest_first_order(&self, elimination: TreeElimination) -> FirstOrder<'g> {
        let Some(tree) = self.system.tree.as_ref().filter(|_| elimination != TreeElimination::Whole) else {
            return self.first_order();
        };
        let dynamics = TreeEquations {
            dynamics: tree.dynamics(&self.system.frame, &self.system.forces),
            system: (**tree).clone(),
        };
        let by_joints = self.first_order_with(Matrix::from_fn(0, 0, |_, _| Expr::ZERO), Vec::new());
        let by_joints = FirstOrder { tree: Some(Rc::new(dynamics)), ..by_joints };
        if elimination == TreeElimination::ByJoints || tree.is_large() {
            return by_joints;
        }
        let whole = self.first_order();
        if by_joints.operations() <= whole.operations() { by_joints } else { whole }
    }

    /// The case w = η̇, g = (b η + b_0, w).
    pub(crate) fn first_order(&self) -> FirstOrder<'g> {
        self.first_order_with(self.mass_matrix().clone(), self.right_hand_side().to_vec())
    }

    fn first_order_with(&self, mass: Matrix<Expr<'g>>, right: Vec<Expr<'g>>) -> FirstOrder<'g> {
        let system = &self.system;
        let x = system.frame.coordinates();
        let unknowns = system.accelerations();
        let energy = ("energy".to_owned(), self.energy());
        FirstOrder {
            graph: system.graph(),
            time: system.frame.time(),
            state: system.state(),
            coordinates: x.len(),
            states: system.states.len(),
            parameters: system.run_time_inputs(),
            varying: system.varying_inputs(),
            names: system.quasi_velocities.iter().map(Expr::to_string).collect(),
            multipliers: 0,
            rank: 0,
            mass,
            tree: None,
            points: None,
            implicit: None,
            right,
            rates: self
                .velocities()
                .iter()
                .chain(&unknowns)
                .chain(system.states.iter().map(|(_, rate)| rate))
                .copied()
                .collect(),
            unknowns,
            collected_by: system.collecting_order(),
            observables: system.integrals.iter().chain([&energy]).chain(&system.outputs).cloned().collect(),
            conserved: system.integrals.len() + 1,
            quaternions: UnitQuaternions::of(system),
            holds: system.holds.clone(),
        }
    }
}

/// The derivatives of ẏ = g(t, y, w(t, y)) as expressions in t and y. No inverse is differentiated: with
/// F = r − M w at fixed w,
///
///   w′ = M⁻¹ F′,   ẏ′ = g′ + (∂g/∂w) w′
///
/// where ′ is the derivative along any direction in which y and the parameters change.
pub(crate) struct Linearised<'a, 'g> {
    graph: &'g Graph,
    factors: &'a Factors<'g>,
    /// g, then F.
    rows: Vec<Expr<'g>>,
    /// The rows that contain each symbol, by its name; found when a derivative with respect to a single
    /// symbol is first needed.
    rows_with: OnceCell<HashMap<Option<String>, Vec<usize>>>,
    /// The nonzero entries of each row of ∂g/∂w, with their columns.
    coupling: Vec<SparseColumn<'g>>,
    /// The rows with nonzero entries in each column of ∂g/∂w.
    coupled: Vec<Vec<usize>>,
    /// The symbols w with their expressions in t and y.
    values: Substitution<'g>,
}

impl<'a, 'g> Linearised<'a, 'g> {
    /// `unknowns` expresses w in terms of t and y.
    pub(crate) fn new(
        system: &FirstOrder<'g>,
        factors: &'a Factors<'g>,
        unknowns: &[Expr<'g>],
    ) -> Linearised<'a, 'g> {
        let graph = system.graph;
        let values: Vec<_> = system.unknowns.iter().copied().zip(unknowns.iter().copied()).collect();
        let values = graph.substitution(&values);
        let with_values = |row: SparseColumn<'g>| -> SparseColumn<'g> {
            let entries: Vec<Expr<'g>> = row.iter().map(|&(_, entry)| entry).collect();
            let entries = row.iter().map(|&(column, _)| column).zip(values.apply(&entries));
            entries.filter(|(_, entry)| !entry.is_zero()).collect()
        };
        let coupling: Vec<SparseColumn<'g>> = system.coupling().into_iter().map(with_values).collect();
        let mut coupled = vec![Vec::new(); system.unknowns.len()];
        for (place, row) in coupling.iter().enumerate() {
            row.iter().for_each(|&(column, _)| coupled[column].push(place));
        }
        let rows: Vec<Expr<'g>> = system.rates.iter().copied().chain(system.balance()).collect();
        Linearised { graph, factors, rows, rows_with: OnceCell::new(), coupling, coupled, values }
    }

    fn rows_with(&self) -> &HashMap<Option<String>, Vec<usize>> {
        self.rows_with.get_or_init(|| {
            let mut rows_with: HashMap<_, Vec<usize>> = HashMap::new();
            for (place, &row) in self.rows.iter().enumerate() {
                for symbol in self.graph.symbols_of(&[row]) {
                    rows_with.entry(symbol.symbol_name()).or_default().push(place);
                }
            }
            rows_with
        })
    }

    /// The nonzero components of ẏ′, with their indices, when each symbol of `direction` changes at the
    /// given rate.
    fn nonzero_along(&self, direction: &[(Expr<'g>, Expr<'g>)]) -> SparseColumn<'g> {
        let graph = self.graph;
        // Along the full state every row changes.
        let places: BTreeSet<usize> = if direction.len() >= self.coupling.len() {
            (0..self.rows.len()).collect()
        } else {
            let of = |(symbol, _): &(Expr<'g>, Expr<'g>)| self.rows_with().get(&symbol.symbol_name());
            direction.iter().filter_map(of).flatten().copied().collect()
        };
        let moved: Vec<Expr<'g>> = places.iter().map(|&place| self.rows[place]).collect();
        let moved = self.values.apply(&graph.directional(&moved, direction));
        let (mut rates, mut balance) = (BTreeMap::new(), Vec::new());
        for (place, moved) in places.into_iter().zip(moved).filter(|(_, moved)| !moved.is_zero()) {
            match place.checked_sub(self.coupling.len()) {
                None => drop(rates.insert(place, moved)),
                Some(place) => balance.push((place, moved)),
            }
        }
        let unknowns: BTreeMap<usize, Expr<'g>> =
            self.factors.solve_nonzero(graph, &balance).into_iter().collect();
        for &place in unknowns.keys().flat_map(|&column| &self.coupled[column]) {
            rates.entry(place).or_insert(Expr::ZERO);
        }
        let through = |row: &SparseColumn<'g>| -> Vec<Expr<'g>> {
            let term = |&(column, coefficient)| Some(coefficient * *unknowns.get(&column)?);
            row.iter().filter_map(term).collect()
        };
        let total = |(place, rate)| match through(&self.coupling[place]) {
            terms if terms.is_empty() => (place, rate),
            terms => (place, graph.sum([rate, graph.sum(terms)])),
        };
        rates.into_iter().map(total).filter(|(_, total)| !total.is_zero()).collect()
    }

    /// The derivative ẏ′ when each symbol of `direction` changes at the given rate.
    pub(crate) fn along(&self, direction: &[(Expr<'g>, Expr<'g>)]) -> Vec<Expr<'g>> {
        let mut all = vec![Expr::ZERO; self.coupling.len()];
        self.nonzero_along(direction).into_iter().for_each(|(place, rate)| all[place] = rate);
        all
    }

    /// A direction v in which some `symbols` of the system change, and the derivative ẏ′ along it.
    pub(crate) fn product(
        &self,
        system: &FirstOrder<'g>,
        symbols: &[Expr<'g>],
    ) -> (Vec<Expr<'g>>, Vec<Expr<'g>>) {
        let v = system.fresh("δ", symbols);
        let along: Vec<_> = symbols.iter().copied().zip(v.iter().copied()).collect();
        let product = self.along(&along);
        (v, product)
    }

    /// The derivatives ∂ẏ/∂q for each symbol q in `symbols`, column by column.
    pub(crate) fn columns(&self, symbols: &[Expr<'g>]) -> Vec<SparseColumn<'g>> {
        symbols.iter().map(|&symbol| self.nonzero_along(&[(symbol, Expr::ONE)])).collect()
    }
}
