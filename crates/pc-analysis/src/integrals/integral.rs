//! Functions that are constant along a motion, or may be, with their verdicts.

use pc_mech::{Equations, Expr, Number, System};

use crate::integrals::rates::Rates;

/// A function that may be an integral.
#[derive(Clone, Debug)]
pub struct Integral<'g> {
    /// The name of the integral: as declared, or `energy`, `momentum 1`, `Casimir 1`, `found 1`.
    pub name: String,
    /// The function of (t, x, η).
    pub value: Expr<'g>,
    /// Its origin.
    pub origin: Origin,
    /// The verdict on its rate.
    pub verdict: ConservationVerdict<'g>,
    /// Whether an event may change the integral.
    pub jumps: bool,
    /// Whether it is known to be a function of the integrals before it in the list.
    pub dependent: bool,
    /// The equations where it is conserved, if that is not everywhere.
    pub level: Vec<LevelEquation<'g>>,
}

/// The equation f = c of a level of an integral.
#[derive(Clone, Debug, PartialEq)]
pub struct LevelEquation<'g> {
    /// The name of the integral.
    pub name: String,
    /// f, a function of (t, x, η).
    pub function: Expr<'g>,
    /// c
    pub value: Number,
}

/// The origin of an integral.
#[derive(Clone, Debug, PartialEq)]
pub enum Origin {
    /// The integral is declared with the system.
    Declared,
    /// The integral is declared, and is a function of Casimirs.
    DeclaredCasimir,
    /// The integral is the energy formed with the velocities in the equations.
    Energy,
    /// The integral is the energy formed with all velocities, while the equations contain only independent
    /// ones.
    EnergyOfAll,
    /// The integral is the momentum a_s y_s of a [`CyclicDisplacement`](crate::CyclicDisplacement).
    CyclicDisplacement {
        /// a_1..a_k
        coefficients: Vec<Number>,
    },
    /// The integral is a Casimir of the bracket (12).
    Casimir,
    /// The integral was found by an ansatz.
    Found,
}

/// The verdict on the rate of change of a function along the motion.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum ConservationVerdict<'g> {
    /// The rate vanishes identically.
    Conserved,
    /// The rate vanishes identically for these values of the parameters.
    ConservedHere,
    /// The rate vanishes identically, possibly only for these values of the parameters, wherever the function
    /// does not jump.
    BetweenJumps,
    /// The rate vanishes on a [level](Integral::level) of other integrals that contains the start, so that the function is
    /// constant along the motion from there.
    OnLevel {
        /// Whether it does so for all values of the parameters.
        always: bool,
    },
    /// The rate is unknown, because the function depends on more than time and state, for example on
    /// reactions.
    NoFunction,
    /// The rate was not found to vanish.
    Rate {
        /// The rate in terms of (t, x, η).
        rate: Expr<'g>,
        /// The value of the rate at the start, if it has one.
        at_start: Option<f64>,
        /// The absolute value of the rate at the start, divided by the sum of the absolute values of its terms, from 0
        /// to 1: only rounding error if the function is an integral.
        part_left: Option<f64>,
        /// The same quotient at states near the start, if the start alone does not refute conservation and every nearby
        /// state is possible; otherwise at other velocities at the start, if it refutes conservation there.
        near: Option<f64>,
    },
}

/// The functions that are integrals, or may be; none by default.
#[derive(Clone, Debug, Default)]
pub struct Integrals<'g> {
    pub(super) list: Vec<Integral<'g>>,
}

impl<'g> Integrals<'g> {
    /// All functions, the declared ones first.
    pub fn list(&self) -> &[Integral<'g>] {
        &self.list
    }

    /// The functions that are proved to be conserved, possibly only for the present values of the parameters.
    pub fn conserved(&self) -> impl Iterator<Item = &Integral<'g>> {
        self.list.iter().filter(|integral| integral.is_conserved())
    }

    pub(super) fn push(&mut self, integral: Integral<'g>) {
        self.list.push(integral);
    }

    /// Renames each integral for which `name` returns a name.
    pub fn rename(&mut self, name: impl Fn(&Integral<'g>) -> Option<String>) {
        for integral in &mut self.list {
            if let Some(name) = name(integral) {
                integral.name = name;
            }
        }
    }

    /// Drops integrals that were found, by an ansatz or as Casimirs, and are functions of quantities that are `known` to be constant, such as
    /// the constraints.
    pub fn drop_functions_of(&mut self, system: &System<'g>, known: &[Expr<'g>]) {
        let (graph, state) = (system.graph(), system.state());
        let known: Vec<Vec<Expr<'g>>> = known.iter().map(|&f| graph.gradient(f, &state)).collect();
        let rank = graph.generic_rank(&known);
        self.list.retain(|integral| {
            let rows = || [known.as_slice(), &[graph.gradient(integral.value, &state)]].concat();
            !matches!(integral.origin, Origin::Found | Origin::Casimir) || graph.generic_rank(&rows()) > rank
        });
    }

    /// Marks the energy as proved to be conserved, by a theorem, if its rate along the equations was not
    /// found to vanish.
    pub fn keep_energy(&mut self, equations: &Equations<'g>) {
        let open = |integral: &&mut Integral<'g>| {
            integral.is_energy() && matches!(integral.verdict, ConservationVerdict::Rate { .. })
        };
        for integral in self.list.iter_mut().filter(open) {
            let jumps = Rates::poincare(equations).has_jumps(integral.value);
            integral.verdict =
                if jumps { ConservationVerdict::BetweenJumps } else { ConservationVerdict::Conserved };
        }
    }

    /// Marks the conserved functions that resets may change: resets that do not leave the function unchanged for every
    /// state, or whose results are `projected` onto constraints. A reset is a list of components of the `system`'s
    /// state, each with its new value.
    pub fn jump<'r>(
        &mut self,
        system: &System<'g>,
        resets: impl Iterator<Item = &'r [(usize, Expr<'g>)]>,
        projected: bool,
    ) where
        'g: 'r,
    {
        let state = system.state();
        for reset in resets.filter(|reset| !reset.is_empty()) {
            let new: Vec<_> = reset.iter().map(|&(place, value)| (state[place], value)).collect();
            for integral in &mut self.list {
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
}

/// The function with the parameters of a system replaced by their numbers.
pub(crate) fn bind<'g>(system: &System<'g>, function: Expr<'g>) -> Expr<'g> {
    system.graph().substitute(&[function], &system.numbers())[0]
}

impl ConservationVerdict<'_> {
    /// Whether the function is proved to be an integral, possibly only for the present values of the
    /// parameters.
    pub fn is_conserved(self) -> bool {
        matches!(self, ConservationVerdict::Conserved | ConservationVerdict::ConservedHere)
    }
}

impl Integral<'_> {
    /// Whether it is proved to be conserved, possibly only for the present values of the parameters.
    pub fn is_conserved(&self) -> bool {
        self.verdict.is_conserved()
    }

    /// Whether it is proved to be constant along the motion from the start: conserved, or conserved on a level of other
    /// integrals that contains the start.
    pub fn is_constant_from_start(&self) -> bool {
        self.is_conserved() || matches!(self.verdict, ConservationVerdict::OnLevel { .. })
    }

    /// Whether it is the energy formed with the velocities in the equations.
    pub fn is_energy(&self) -> bool {
        self.origin == Origin::Energy
    }

    /// Whether it is a Casimir, declared or not.
    pub fn is_casimir(&self) -> bool {
        matches!(self.origin, Origin::Casimir | Origin::DeclaredCasimir)
    }
}
