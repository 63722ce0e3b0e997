//! What the motion keeps: declared integrals, the energy, momenta, Casimirs, and what an ansatz finds.

use pc_analysis::{Conservation, CyclicDisplacement, PoissonBracket, Rates};
use pc_mech::{Equations, Expr, Graph, Neighbourhood, Number, Style, System};
use pc_model::{Assembly, ConstraintFormulation};
use pc_print::{columns, combination};
use serde_json::{Value, json};

use crate::report::text::short;

/// The most functions with unknown coefficients in an ansatz: some hundredths of a second.
const MOST_FUNCTIONS: usize = 150;

/// A formula of more columns is not printed behind what is said of it.
const WIDEST: usize = 100;

/// A function that may keep its value.
#[derive(Clone, Debug)]
pub(super) struct Integral<'g> {
    /// What it is called.
    pub(super) name: String,
    /// The function of (t, x, η).
    pub(super) value: Expr<'g>,
    /// Where it comes from.
    how: &'static str,
    verdict: ConservationVerdict<'g>,
    /// Whether an event may change it.
    jumps: bool,
}

/// What is known of the rate of change of a function along the motion.
#[derive(Clone, Copy, Debug, PartialEq)]
enum ConservationVerdict<'g> {
    /// It vanishes identically.
    Conserved,
    /// It vanishes identically for these values of the parameters.
    ConservedHere,
    /// It vanishes identically, if only for these values, where the function does not jump.
    BetweenJumps,
    /// It is not known: the function is none of time and state alone, as one with reactions.
    NoFunction,
    /// It is not seen to vanish.
    Rate {
        rate: Expr<'g>,
        /// Its value at the start, if it has one.
        at_start: Option<f64>,
    },
}

const DECLARED: &str = "declared";
const DECLARED_CASIMIR: &str = "declared; a Casimir";
const ENERGY: &str = "energy";
const ENERGY_OF_ALL: &str = "energy of all velocities";
const CYCLIC: &str = "cyclic displacement";
const CASIMIR: &str = "Casimir";
const FOUND: &str = "found";

/// The declared integrals, the energy, and what else is found, each with a verdict.
pub(super) fn integrals<'g>(equations: &Equations<'g>, near: &Neighbourhood<'g>) -> Vec<Integral<'g>> {
    let search = Search::new(equations, near);
    let mut list = search.declared();
    list.push(search.energy());
    list.extend(search.cyclic_momenta());
    search.add_casimirs(&mut list);
    search.add_found(&mut list);
    list
}

/// Says that the energy is proved to be kept, by a theorem where its rate along the equations is not seen to vanish.
pub(super) fn say_energy_is_kept<'g>(list: &mut [Integral<'g>], equations: &Equations<'g>) {
    let open = |integral: &&mut Integral<'g>| {
        integral.is_energy() && matches!(integral.verdict, ConservationVerdict::Rate { .. })
    };
    for integral in list.iter_mut().filter(open) {
        let jumps = Rates::poincare(equations).has_jumps(integral.value);
        integral.verdict =
            if jumps { ConservationVerdict::BetweenJumps } else { ConservationVerdict::Conserved };
    }
}

/// Says of what keeps its value between events that resets may change it: those that do not leave it as it is whatever the
/// state, or that end with a projection to the constraints.
pub(super) fn say_what_jumps<'g>(list: &mut [Integral<'g>], assembly: &Assembly<'g>) {
    let system = &assembly.system;
    let state = system.state();
    let projected = matches!(assembly.constraints.formulation(), ConstraintFormulation::Multipliers(_));
    for reset in assembly.events.iter().map(|event| &event.resets).filter(|reset| !reset.is_empty()) {
        let new: Vec<_> = reset.iter().map(|&(place, value)| (state[place], value)).collect();
        for integral in &mut *list {
            let after = system.graph().substitute(&[integral.value], &new)[0];
            let jump = after - integral.value;
            if projected || !bind(system, jump).is_zero() {
                integral.jumps = true;
            } else if integral.verdict == ConservationVerdict::Conserved && !jump.is_zero() {
                integral.verdict = ConservationVerdict::ConservedHere;
            }
        }
    }
}

/// Adds the energy of all velocities, that of a run; y·η − L of the independent ones is called Jacobi's then.
pub(super) fn add_energy_of_all<'g>(
    list: &mut Vec<Integral<'g>>,
    equations: &Equations<'g>,
    near: &Neighbourhood<'g>,
    value: Expr<'g>,
) {
    for integral in list.iter_mut().filter(|integral| integral.is_energy()) {
        integral.name = "Jacobi's".to_owned();
    }
    let verdict = Search::new(equations, near).verdict(value);
    list.push(Integral { name: "energy".to_owned(), value, how: ENERGY_OF_ALL, verdict, jumps: false });
}

/// Where integrals are looked for.
struct Search<'a, 'g> {
    graph: &'g Graph,
    equations: &'a Equations<'g>,
    /// With the parameters as numbers.
    bound: System<'g>,
    rates: Rates<'g>,
    near: &'a Neighbourhood<'g>,
    /// (t, x, η, z)
    variables: Vec<Expr<'g>>,
    /// Whether the brackets are those of all operators, so that the Lagrangian says everything.
    unconstrained: bool,
}

impl<'a, 'g> Search<'a, 'g> {
    fn new(equations: &'a Equations<'g>, near: &'a Neighbourhood<'g>) -> Search<'a, 'g> {
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

    fn system(&self) -> &'a System<'g> {
        self.equations.system()
    }

    fn verdict(&self, function: Expr<'g>) -> ConservationVerdict<'g> {
        match self.rates.verdict(function) {
            Ok(Conservation::Conserved) => ConservationVerdict::Conserved,
            Ok(Conservation::ConservedHere) => ConservationVerdict::ConservedHere,
            Ok(Conservation::ConservedBetweenJumps) => ConservationVerdict::BetweenJumps,
            Ok(Conservation::Changing(rate)) => self.changing(rate),
            Err(_) => ConservationVerdict::NoFunction,
        }
    }

    fn changing(&self, rate: Expr<'g>) -> ConservationVerdict<'g> {
        let value = self.graph.evaluate(&[rate], &self.near.centre).ok();
        let at_start = value.map(|values| values[0]).filter(|value| value.is_finite());
        ConservationVerdict::Rate { rate, at_start }
    }

    fn bind(&self, function: Expr<'g>) -> Expr<'g> {
        bind(self.system(), function)
    }

    fn declared(&self) -> Vec<Integral<'g>> {
        let integrals = self.system().integrals().iter();
        let with_verdict = |&(ref name, value): &(String, Expr<'g>)| Integral {
            name: name.clone(),
            value,
            how: DECLARED,
            verdict: self.verdict(value),
            jumps: false,
        };
        integrals.map(with_verdict).collect()
    }

    /// The energy, whose rate needs no accelerations.
    fn energy(&self) -> Integral<'g> {
        let value = self.equations.energy();
        let verdict = match self.verdict(value) {
            ConservationVerdict::Rate { .. } if self.unconstrained => {
                let rate = self.system().energy_rate();
                let vanishes_here = self.bind(rate).is_zero();
                if vanishes_here && self.rates.has_jumps(value) {
                    ConservationVerdict::BetweenJumps
                } else if rate.is_zero() {
                    ConservationVerdict::Conserved
                } else if vanishes_here {
                    ConservationVerdict::ConservedHere
                } else {
                    self.changing(rate)
                }
            }
            verdict => verdict,
        };
        Integral { name: "energy".to_owned(), value, how: ENERGY, verdict, jumps: false }
    }

    /// The momenta of cyclic displacements that are not declared, for the values of the parameters.
    fn cyclic_momenta(&self) -> Vec<Integral<'g>> {
        if !self.unconstrained {
            return Vec::new();
        }
        let is_declared = |momentum: Expr<'g>| {
            let mut known = self.bound.integrals().iter().filter(|(_, known)| !known.is_zero());
            known.any(|&(_, known)| (momentum / known).constant().is_some())
        };
        let name = |coefficients: &[Number]| {
            let names = self.bound.quasi_velocities().iter().map(ToString::to_string);
            format!("momentum of {}", combination(coefficients.iter().map(ToString::to_string).zip(names)))
        };
        let new =
            CyclicDisplacement::all(&self.bound).into_iter().filter(|cyclic| !is_declared(cyclic.momentum));
        new.map(|cyclic| Integral {
            name: name(&cyclic.coefficients),
            value: cyclic.momentum,
            how: CYCLIC,
            verdict: self.proved(cyclic.momentum),
            jumps: false,
        })
        .collect()
    }

    /// The verdict on what is proved to be conserved at least for these parameters.
    fn proved(&self, function: Expr<'g>) -> ConservationVerdict<'g> {
        match self.verdict(function) {
            known @ (ConservationVerdict::Conserved | ConservationVerdict::BetweenJumps) => known,
            _ if self.rates.has_jumps(function) => ConservationVerdict::BetweenJumps,
            _ => ConservationVerdict::ConservedHere,
        }
    }

    /// The Casimirs of the bracket (12) in terms of (x, η), those that are no functions of integrals in the
    /// list; what in the list is a function of Casimirs is called one.
    ///
    /// Where b_0 = 0, c_0s = 0 and Q = 0, the motion keeps them whatever the Lagrangian.
    fn add_casimirs(&self, list: &mut Vec<Integral<'g>>) {
        let (frame, structure) = (self.bound.frame(), self.bound.structure());
        let stationary = frame.b0().iter().all(|b| b.is_zero()) && structure.nonzero().all(|(r, ..)| r > 0);
        let forced = self.bound.forces().iter().any(|q| !q.is_zero());
        if !(self.unconstrained && stationary) {
            return;
        }
        let bracket = PoissonBracket::new(&self.bound);
        let degree = (1..=2).rev().find(|&d| binomial(bracket.variables().len() + d, d) <= MOST_FUNCTIONS);
        let momenta: Vec<_> =
            self.bound.momentum_symbols().into_iter().zip(self.system().momenta()).collect();
        let casimirs: Vec<(Expr<'g>, ConservationVerdict<'g>)> = degree
            .map_or_else(Vec::new, |degree| bracket.casimirs(degree as u32))
            .into_iter()
            .map(|casimir| (casimir, self.graph.substitute(&[casimir], &momenta)[0]))
            .map(|(casimir, value)| {
                let here = if forced { self.verdict(value) } else { self.proved(value) };
                let always =
                    !forced && PoissonBracket::new(self.system()).is_casimir(casimir).unwrap_or(false);
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
                if integral.how == DECLARED {
                    integral.how = DECLARED_CASIMIR;
                }
            }
        }
        let mut number = 0;
        for ((value, verdict), bound) in casimirs.into_iter().zip(values) {
            if self.is_new(&known, bound) {
                number += 1;
                let name = format!("Casimir {number}");
                list.push(Integral { name, value, how: CASIMIR, verdict, jumps: false });
                known.push(bound);
            }
        }
    }

    /// Integrals linear in η with coefficients of low degree in x, those that are no functions of integrals in
    /// the list.
    fn add_found(&self, list: &mut Vec<Integral<'g>>) {
        let (n, k) = (self.bound.frame().coordinates().len(), self.bound.quasi_velocities().len());
        let largest = if n <= 4 { 2 } else { 1 };
        let degree = (0..=largest).rev().find(|&d| (1 + k) * binomial(n + d, d) <= MOST_FUNCTIONS);
        let Some(degree) = degree else { return };
        let rates = self.rates.with_parameters_bound();
        let mut ansatz = rates.ansatz(1, degree as u32);
        let conserved = list.iter().filter(|integral| integral.verdict.is_conserved());
        ansatz.known = conserved.map(|integral| self.bind(integral.value)).collect();
        for (number, value) in (1..).zip(rates.integrals(&ansatz).unwrap_or_default()) {
            let verdict = self.proved(value);
            let value = self.graph.shorten(&[value], self.bound.quasi_velocities())[0];
            let name = format!("found {number}");
            list.push(Integral { name, value, how: FOUND, verdict, jumps: false });
        }
    }

    /// Whether f is no function of the known ones.
    fn is_new(&self, known: &[Expr<'g>], f: Expr<'g>) -> bool {
        self.rank(&[known, &[f]].concat()) > self.rank(known)
    }

    /// How many of the functions are independent.
    fn rank(&self, functions: &[Expr<'g>]) -> usize {
        rank_of_gradients(self.graph, functions, &self.variables)
    }
}

/// The function with the parameters of a system replaced by their numbers.
pub(super) fn bind<'g>(system: &System<'g>, function: Expr<'g>) -> Expr<'g> {
    let numbers: Vec<_> = system
        .parameters()
        .iter()
        .filter(|(symbol, _)| !system.signals().contains(symbol))
        .map(|&(symbol, value)| (symbol, value.into()))
        .collect();
    system.graph().substitute(&[function], &numbers)[0]
}

/// Rank of ∂f/∂z at almost all points: how many of the functions are independent.
pub(super) fn rank_of_gradients<'g>(
    graph: &'g Graph,
    functions: &[Expr<'g>],
    variables: &[Expr<'g>],
) -> usize {
    let rows: Vec<Vec<Expr<'g>>> = functions.iter().map(|&f| graph.gradient(f, variables)).collect();
    graph.generic_rank(&rows)
}

/// n over d
fn binomial(n: usize, d: usize) -> usize {
    (1..=d).fold(1, |product, i| product * (n + 1 - i) / i)
}

impl ConservationVerdict<'_> {
    fn is_conserved(self) -> bool {
        matches!(self, ConservationVerdict::Conserved | ConservationVerdict::ConservedHere)
    }

    /// `jumps`: whether an event may change it.
    fn words(self, jumps: bool) -> String {
        let between = if jumps { " between events" } else { "" };
        match self {
            ConservationVerdict::Conserved => format!("conserved{between} (proved)"),
            ConservationVerdict::ConservedHere => format!("conserved{between} for these parameters (proved)"),
            ConservationVerdict::BetweenJumps => "conserved where it does not jump (proved)".to_owned(),
            ConservationVerdict::NoFunction => {
                "not decided: it is no function of time and state alone".to_owned()
            }
            // Rounding of a rate that is zero there.
            ConservationVerdict::Rate { at_start: Some(rate), .. } if rate.abs() < 1e-12 => {
                "not proved to be conserved, though it does not change at the start".to_owned()
            }
            ConservationVerdict::Rate { at_start: Some(rate), .. } => {
                format!("not proved to be conserved: changes at the rate {} at the start", short(rate, 4))
            }
            ConservationVerdict::Rate { at_start: None, .. } => "not proved to be conserved".to_owned(),
        }
    }
}

impl Integral<'_> {
    /// Whether it is proved to keep its value, if only for these parameters.
    pub(super) fn is_conserved(&self) -> bool {
        self.verdict.is_conserved()
    }

    /// Whether it is the energy.
    pub(super) fn is_energy(&self) -> bool {
        self.how == ENERGY
    }

    /// Whether it is a Casimir, declared or not.
    pub(super) fn is_casimir(&self) -> bool {
        [CASIMIR, DECLARED_CASIMIR].contains(&self.how)
    }

    /// The verdict, with the formula of what is not declared, and of the rate of the energy.
    pub(super) fn lines(&self) -> Vec<String> {
        let words = self.verdict.words(self.jumps);
        if let (ENERGY, ConservationVerdict::Rate { rate, at_start }) = (self.how, self.verdict) {
            let formula = rate.display(Style::Book);
            let at_start =
                at_start.map_or_else(String::new, |rate| format!(", {} at the start", short(rate, 4)));
            return vec![if columns(&formula) <= WIDEST {
                format!("dE/dt = {formula}{at_start}")
            } else {
                words
            }];
        }
        match self.how {
            DECLARED_CASIMIR => vec![format!("{words}, a Casimir")],
            CYCLIC | CASIMIR | FOUND => {
                let formula = self.value.display(Style::Book);
                let whole = format!("{words}: {formula}");
                match columns(&formula) {
                    _ if columns(&whole) <= WIDEST => vec![whole],
                    width if width <= WIDEST => vec![format!("{words}:"), formula],
                    _ => vec![words],
                }
            }
            _ => vec![words],
        }
    }

    /// The integral for programs.
    pub(super) fn object(&self) -> Value {
        let mut object = json!({
            "name": self.name,
            "expression": self.value.to_string(),
            "how": self.how,
            "verdict": self.verdict.words(self.jumps),
        });
        if let ConservationVerdict::Rate { rate, at_start } = self.verdict {
            object["rate"] = json!(rate.to_string());
            object["rate_at_start"] = json!(at_start);
        }
        object
    }
}
