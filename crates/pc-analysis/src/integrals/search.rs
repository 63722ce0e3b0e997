//! The integrals of a motion: declared ones, the energy, momenta, Casimirs, and those of an ansatz.

use pc_mech::{Equations, Expr, Graph, Identity, Neighbourhood, System};

use crate::brackets::poisson_bracket::PoissonBracket;
use crate::integrals::ansatz::Ansatz;
use crate::integrals::cyclic_displacements::CyclicDisplacement;
use crate::integrals::integral::{ConservationVerdict, Integral, Integrals, Origin};
use crate::integrals::polynomials::combination;
use crate::integrals::rates::{Conservation, Rates};

/// The largest number of functions with unknown coefficients in an ansatz; a search with this many takes some
/// hundredths of a second.
const MOST_FUNCTIONS: usize = 150;

impl<'g> Integrals<'g> {
    /// The declared integrals, the energy, and others that are found, each with a verdict: momenta of cyclic
    /// displacements, Casimirs, and integrals linear in η with polynomials of low degree as coefficients.
    /// `near` gives values of time, state and parameters.
    ///
    /// ```
    /// use pc_analysis::Integrals;
    /// use pc_mech::{Graph, Neighbourhood, System};
    ///
    /// // A particle on a line, free.
    /// let graph = Graph::new();
    /// let particle =
    ///     System::builder(&graph).coordinates(["x"]).lagrangian(|_, _, v| v[0].square() / 2.0).build()?;
    /// let at: Vec<_> = ["t", "x", "x'"].map(|name| (graph.symbol(name), 0.5)).into();
    /// let found = Integrals::find(&particle.poincare()?, &Neighbourhood { centre: at });
    /// assert!(found.list().iter().all(|integral| integral.is_conserved()));
    /// assert_eq!(found.list()[1].value, graph.symbol("x'"));
    /// # Ok::<(), pc_mech::MechError>(())
    /// ```
    pub fn find(equations: &Equations<'g>, near: &Neighbourhood<'g>) -> Integrals<'g> {
        let mut integrals = Integrals::known(equations, near);
        Search::new(equations, near).add_found(&mut integrals.list);
        integrals
    }

    /// As [`find`](Integrals::find), without an ansatz.
    pub fn known(equations: &Equations<'g>, near: &Neighbourhood<'g>) -> Integrals<'g> {
        let search = Search::new(equations, near);
        let mut list = search.declared();
        list.push(search.energy());
        list.extend(search.cyclic_momenta());
        search.add_casimirs(&mut list);
        Integrals { list }
    }

    /// Adds the energy formed with all velocities, which a run observes; the integral y·η − L of the
    /// independent velocities is then named `Jacobi's`.
    pub fn add_energy_of_all(
        &mut self,
        equations: &Equations<'g>,
        near: &Neighbourhood<'g>,
        value: Expr<'g>,
    ) {
        for integral in self.list.iter_mut().filter(|integral| integral.is_energy()) {
            integral.name = "Jacobi's".to_owned();
        }
        let verdict = Search::new(equations, near).verdict(value);
        let origin = Origin::EnergyOfAll;
        self.list.push(Integral {
            name: "energy".to_owned(),
            value,
            origin,
            verdict,
            jumps: false,
            dependent: false,
            level: Vec::new(),
        });
    }
}

/// The equations in which integrals are sought.
pub(super) struct Search<'a, 'g> {
    pub(super) graph: &'g Graph,
    equations: &'a Equations<'g>,
    /// The system with its parameters replaced by numbers.
    bound: System<'g>,
    pub(super) rates: Rates<'g>,
    pub(super) near: &'a Neighbourhood<'g>,
    /// (t, x, η, z)
    variables: Vec<Expr<'g>>,
    /// Whether the brackets include all operators, so that the Lagrangian determines the motion.
    unconstrained: bool,
}

impl<'a, 'g> Search<'a, 'g> {
    pub(super) fn new(equations: &'a Equations<'g>, near: &'a Neighbourhood<'g>) -> Search<'a, 'g> {
        let system = equations.system();
        let (frame, k) = (system.frame(), system.quasi_velocities().len());
        Search {
            graph: system.graph(),
            equations,
            bound: system.with_parameters_bound(),
            rates: Rates::poincare(equations),
            near,
            variables: [frame.time()].into_iter().chain(system.state()).collect(),
            unconstrained: system.structure().operators() == k,
        }
    }

    pub(super) fn system(&self) -> &'a System<'g> {
        self.equations.system()
    }

    fn verdict(&self, function: Expr<'g>) -> ConservationVerdict<'g> {
        match self.rates.verdict(function) {
            Ok(Conservation::Conserved) => ConservationVerdict::Conserved,
            Ok(Conservation::ConservedHere) => ConservationVerdict::ConservedHere,
            Ok(Conservation::ConservedBetweenJumps) => ConservationVerdict::BetweenJumps,
            Ok(Conservation::Changing(rate)) => self.changing(function, rate),
            Err(_) => ConservationVerdict::NoFunction,
        }
    }

    fn changing(&self, function: Expr<'g>, rate: Expr<'g>) -> ConservationVerdict<'g> {
        let value = self.graph.evaluate(&[rate], &self.near.centre).ok();
        let at_start = value.map(|values| values[0]).filter(|value| value.is_finite());
        let part_left = self.rates.part_left(function, &self.near.centre).ok().flatten();
        let is_refuted =
            part_left.is_some_and(|left| matches!(Identity::of(left), Identity::Disproved { .. }));
        let near = match is_refuted {
            true => None,
            false if self.is_free() => Some(self.near.residual(self.graph, &[vec![rate]])),
            false => self.refuted_by_velocities(rate),
        };
        ConservationVerdict::Rate { rate, at_start, part_left, near }
    }

    /// The size of the rate at the position of the start with other velocities, which are independent under
    /// constraints too, if it shows that the rate does not vanish.
    fn refuted_by_velocities(&self, rate: Expr<'g>) -> Option<f64> {
        let eta = self.system().quasi_velocities();
        let place = self.near.centre.iter().filter(|(symbol, _)| !eta.contains(symbol));
        let place: Vec<_> = place.map(|&(symbol, value)| (symbol, Expr::from(value))).collect();
        let there = self.graph.substitute(&[rate], &place)[0];
        let left = self.near.residual(self.graph, &[vec![there]]);
        matches!(Identity::of(left), Identity::Disproved { .. }).then_some(left)
    }

    /// Whether every state near the start is possible: no constraints, and no relations among the coordinates.
    fn is_free(&self) -> bool {
        let frame = self.system().frame();
        self.unconstrained && frame.coordinates().len() == frame.rank()
    }

    /// The function for the present values of the parameters.
    pub(super) fn bind(&self, function: Expr<'g>) -> Expr<'g> {
        self.rates.at_present(function)
    }

    fn declared(&self) -> Vec<Integral<'g>> {
        let integrals = self.system().integrals().iter();
        let with_verdict = |&(ref name, value): &(String, Expr<'g>)| Integral {
            name: name.clone(),
            value,
            origin: Origin::Declared,
            verdict: self.verdict(value),
            jumps: false,
            dependent: false,
            level: Vec::new(),
        };
        integrals.map(with_verdict).collect()
    }

    /// The energy, with a verdict on its rate, which needs no accelerations.
    fn energy(&self) -> Integral<'g> {
        let value = self.equations.energy();
        let verdict = match self.verdict(value) {
            ConservationVerdict::Rate { rate, .. } => {
                let rate = self.power(rate).unwrap_or(rate);
                let vanishes_here = self.bind(rate).is_zero();
                if vanishes_here && self.rates.has_jumps(value) {
                    ConservationVerdict::BetweenJumps
                } else if rate.is_zero() {
                    ConservationVerdict::Conserved
                } else if vanishes_here {
                    ConservationVerdict::ConservedHere
                } else {
                    self.changing(value, rate)
                }
            }
            verdict => verdict,
        };
        Integral {
            name: "energy".to_owned(),
            value,
            origin: Origin::Energy,
            verdict,
            jumps: false,
            dependent: false,
            level: Vec::new(),
        }
    }

    /// The rate of the energy without accelerations: the power of the forces and the explicit time dependence. Under constraints
    /// that are homogeneous in the velocities, c_0r^m = 0, reactions have no power; in that case this rate is checked
    /// to equal the `rate` along the equations.
    fn power(&self, rate: Expr<'g>) -> Option<Expr<'g>> {
        if self.unconstrained {
            return Some(self.system().energy_rate());
        }
        let is_homogeneous = self.system().structure().nonzero().all(|(r, ..)| r > 0);
        let power = is_homogeneous.then(|| self.system().energy_rate())?;
        self.near.vanishes(self.graph, rate - power).then_some(power)
    }

    /// The momenta of cyclic displacements that are not declared as integrals, for the present values of the
    /// parameters.
    fn cyclic_momenta(&self) -> Vec<Integral<'g>> {
        if !self.unconstrained {
            return Vec::new();
        }
        let is_declared = |momentum: Expr<'g>| {
            let mut known = self.bound.integrals().iter().filter(|(_, known)| !known.is_zero());
            known.any(|&(_, known)| (momentum / known).constant().is_some())
        };
        let new =
            CyclicDisplacement::all(&self.bound).into_iter().filter(|cyclic| !is_declared(cyclic.momentum));
        let momenta = self.system().momenta();
        let with_parameters = |(number, cyclic): (usize, CyclicDisplacement<'g>)| {
            let value = combination(self.graph, &cyclic.coefficients, &momenta);
            Integral {
                name: format!("momentum {number}"),
                value,
                verdict: self.proved(value),
                origin: Origin::CyclicDisplacement { coefficients: cyclic.coefficients },
                jumps: false,
                dependent: false,
                level: Vec::new(),
            }
        };
        (1..).zip(new).map(with_parameters).collect()
    }

    /// The verdict on a function that is proved to be conserved at least for the present values of the
    /// parameters.
    pub(super) fn proved(&self, function: Expr<'g>) -> ConservationVerdict<'g> {
        match self.verdict(function) {
            known @ (ConservationVerdict::Conserved | ConservationVerdict::BetweenJumps) => known,
            _ if self.rates.has_jumps(function) => ConservationVerdict::BetweenJumps,
            _ => ConservationVerdict::ConservedHere,
        }
    }

    /// The Casimirs of the bracket (12) in terms of (x, η) that are independent of the integrals in the list;
    /// integrals in the list that are functions of Casimirs are marked as such.
    ///
    /// If b_0 = 0, c_0s = 0 and Q = 0, they are integrals for any Lagrangian.
    fn add_casimirs(&self, list: &mut Vec<Integral<'g>>) {
        let (frame, structure) = (self.bound.frame(), self.bound.structure());
        let stationary = frame.b0().iter().all(|b| b.is_zero()) && structure.nonzero().all(|(r, ..)| r > 0);
        let forced = self.bound.forces().iter().any(|q| !q.is_zero());
        if !(self.unconstrained && stationary) {
            return;
        }
        let variables = frame.coordinates().len() + frame.operators();
        let Some(degree) = (1..=2).rev().find(|&d| binomial(variables + d, d) <= MOST_FUNCTIONS) else {
            return;
        };
        let bracket = PoissonBracket::new(self.system());
        let momenta: Vec<_> =
            self.bound.momentum_symbols().into_iter().zip(self.system().momenta()).collect();
        let mut found = bracket.casimirs(degree as u32);
        if self.rates.are_of_present_values(&bracket.tensor().nonzero_entries()) {
            found.extend(PoissonBracket::new(&self.bound).casimirs(degree as u32));
        }
        let casimirs: Vec<(Expr<'g>, ConservationVerdict<'g>)> = found
            .into_iter()
            .map(|casimir| (casimir, self.graph.substitute(&[casimir], &momenta)[0]))
            .map(|(casimir, value)| {
                let here = if forced { self.verdict(value) } else { self.proved(value) };
                let always = !forced && bracket.is_casimir(casimir).unwrap_or(false);
                (value, if always { ConservationVerdict::Conserved } else { here })
            })
            .filter(|(_, verdict)| verdict.is_conserved())
            .collect();

        let values: Vec<Expr<'g>> = casimirs.iter().map(|&(value, _)| self.bind(value)).collect();
        let mut known = Vec::new();
        for integral in list.iter_mut().filter(|integral| integral.verdict.is_conserved()) {
            let value = self.bind(integral.value);
            if self.rank(&[value]) == 1 && !self.is_new(&values, value) {
                known.push(value);
                if integral.origin == Origin::Declared {
                    integral.origin = Origin::DeclaredCasimir;
                }
            }
        }
        let mut number = 0;
        for ((value, verdict), bound) in casimirs.into_iter().zip(values) {
            if self.is_new(&known, bound) {
                number += 1;
                let name = format!("Casimir {number}");
                list.push(Integral {
                    name,
                    value,
                    origin: Origin::Casimir,
                    verdict,
                    jumps: false,
                    dependent: false,
                    level: Vec::new(),
                });
                known.push(bound);
            }
        }
    }

    /// Adds integrals that are linear in η, with coefficients of low degree in x, and independent of those in
    /// the list.
    fn add_found(&self, list: &mut Vec<Integral<'g>>) {
        let (n, k) = (self.bound.frame().coordinates().len(), self.bound.quasi_velocities().len());
        let largest = if n <= 4 { 2 } else { 1 };
        let degree = (0..=largest).rev().find(|&d| (1 + k) * binomial(n + d, d) <= MOST_FUNCTIONS);
        let Some(degree) = degree else { return };
        let conserved = list.iter().filter(|integral| integral.verdict.is_conserved());
        let mut known: Vec<Expr<'g>> = conserved.map(|integral| self.bind(integral.value)).collect();
        let found = |rates: &Rates<'g>, known: Vec<Expr<'g>>| {
            rates.integrals(&Ansatz { known, ..rates.ansatz(1, degree as u32) }).unwrap_or_default()
        };
        let mut new = found(&self.rates.with_parameters_bound(), known.clone());
        // An integral for all values of the parameters is one for the present values.
        if !new.is_empty() && self.rates.depend_on_present_values(&[]) {
            new.splice(0..0, found(&self.rates, Vec::new()));
        }
        let mut number = 0;
        for value in new {
            let bound = self.bind(value);
            if !self.is_new(&known, bound) {
                continue;
            }
            known.push(bound);
            number += 1;
            list.push(Integral {
                name: format!("found {number}"),
                value: self.graph.shorten(&[value], self.bound.quasi_velocities())[0],
                origin: Origin::Found,
                verdict: self.proved(value),
                jumps: false,
                dependent: false,
                level: Vec::new(),
            });
        }
    }

    /// Whether f is independent of the known functions.
    pub(super) fn is_new(&self, known: &[Expr<'g>], f: Expr<'g>) -> bool {
        self.rank(&[known, &[f]].concat()) > self.rank(known)
    }

    /// The number of independent functions among these.
    fn rank(&self, functions: &[Expr<'g>]) -> usize {
        rank_of_gradients(self.graph, functions, &self.variables)
    }
}

/// The rank of ∂f/∂z at almost all points, which is the number of independent functions.
pub(crate) fn rank_of_gradients<'g>(
    graph: &'g Graph,
    functions: &[Expr<'g>],
    variables: &[Expr<'g>],
) -> usize {
    let rows: Vec<Vec<Expr<'g>>> = functions.iter().map(|&f| graph.gradient(f, variables)).collect();
    graph.generic_rank(&rows)
}

/// n over d
pub(crate) fn binomial(n: usize, d: usize) -> usize {
    (1..=d).fold(1, |product: usize, i| product.saturating_mul(n + 1 - i) / i)
}
