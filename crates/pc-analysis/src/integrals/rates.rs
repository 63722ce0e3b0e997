//! Rates of change along the motion, and whether they vanish.

use pc_algebra::may_jump;
use pc_mech::{Canonical, Equations, Expr, Graph, System};

use crate::error::{AnalysisError, check_variables};
use crate::integrals::long_constants::{symbols_with_numbers, with_symbols};
use crate::integrals::present_values::present_values;

/// The largest number of long constants that are replaced by symbols.
const MOST_LONG: usize = 8;

/// The verdict on whether a function is constant along the motion.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Conservation<'g> {
    /// The rate of the function vanishes identically: the function is an integral.
    Conserved,
    /// The rate of the function vanishes identically for the present values of the parameters.
    ConservedHere,
    /// The rate of the function vanishes identically, possibly only for the present values of the parameters, but
    /// the function jumps where a sign or a step in it jumps, which the rate does not show.
    ConservedBetweenJumps,
    /// The graph does not fold the rate of the function to zero.
    Changing(Expr<'g>),
}

impl Conservation<'_> {
    /// Whether the function is proved to be an integral, possibly only for the present values of the
    /// parameters.
    pub fn is_conserved(self) -> bool {
        matches!(self, Conservation::Conserved | Conservation::ConservedHere)
    }
}

/// The derivative along the motion, df/dt = ∂f/∂t + ẋ_i ∂f/∂x_i + η̇_s ∂f/∂η_s, or with y_s in place of η_s.
///
/// For functions of (t, x, η, η̇) it follows from [`Equations`], including nonholonomic ones, and for
/// functions of (t, x, y) from [`Canonical`] equations. Where these are not [closed](Canonical::is_closed),
/// the functions may contain η too, and the rates are in (t, x, η).
#[derive(Clone, Debug)]
pub struct Rates<'g> {
    pub(crate) graph: &'g Graph,
    pub(crate) time: Expr<'g>,
    pub(crate) coordinates: Vec<Expr<'g>>,
    /// η or y
    pub(crate) moving: Vec<Expr<'g>>,
    /// What takes the place of parameters at their [present values](present_values).
    present: Vec<(Expr<'g>, Expr<'g>)>,
    /// The parameters with their numbers.
    numbers: Vec<(Expr<'g>, Expr<'g>)>,
    /// The parameters that stand for any value: coefficients of integrals may be functions of them.
    pub(crate) indeterminates: Vec<Expr<'g>>,
    /// The symbols of η̇ with their expressions in (t, x, η).
    accelerations: Vec<(Expr<'g>, Expr<'g>)>,
    /// The symbols of y with their expressions in (t, x, η), if y = ∂L/∂η is not solved for η.
    momenta: Vec<(Expr<'g>, Expr<'g>)>,
    /// Each symbol that changes, with its rate.
    pub(crate) flow: Vec<(Expr<'g>, Expr<'g>)>,
    /// The constants: parameters, external forces and any other symbol of the system.
    constants: Vec<Expr<'g>>,
}

impl<'g> Rates<'g> {
    /// The derivative along the motion of functions of (t, x, η, η̇), according to Poincaré's equations.
    pub fn poincare(equations: &Equations<'g>) -> Rates<'g> {
        let (system, accelerations) = (equations.system(), equations.accelerations());
        let symbols = system.accelerations().into_iter().zip(accelerations.iter().copied()).collect();
        let states = system.states().iter().map(|&(_, rate)| rate).collect();
        let rates =
            Rates::new(system, system.quasi_velocities(), equations.velocities(), &accelerations, states);
        Rates { accelerations: symbols, ..rates }
    }

    /// The derivative along the motion of functions of (t, x, y), according to the canonical equations.
    pub fn canonical(equations: &Canonical<'g>) -> Rates<'g> {
        let (system, y) = (equations.system(), equations.momenta());
        let states = equations.state_rates().to_vec();
        let mut rates = Rates::new(system, y, equations.velocities(), equations.right_hand_side(), states);
        if !equations.is_closed() {
            let accelerations = equations.accelerations();
            rates.flow.extend(system.quasi_velocities().iter().copied().zip(accelerations));
            rates.momenta = equations.values_of_momenta();
        }
        rates
    }

    fn new(
        system: &System<'g>,
        moving: &[Expr<'g>],
        velocities: &[Expr<'g>],
        right: &[Expr<'g>],
        states: Vec<Expr<'g>>,
    ) -> Rates<'g> {
        let (time, x) = (system.frame().time(), system.frame().coordinates());
        let mut constants = system.symbols();
        let state = system.state();
        constants.retain(|z| *z != time && !state.contains(z));
        let state = system.state_with(moving).into_iter();
        let flow = state.zip(velocities.iter().chain(right).copied().chain(states));
        let flow = flow.chain([(time, Expr::ONE)]).chain(system.signal_rates());
        Rates {
            graph: system.graph(),
            time,
            coordinates: x.to_vec(),
            moving: moving.to_vec(),
            present: present_values(system),
            numbers: system.numbers(),
            indeterminates: system.numbers().into_iter().map(|(parameter, _)| parameter).collect(),
            accelerations: Vec::new(),
            momenta: Vec::new(),
            flow: flow.collect(),
            constants,
        }
    }

    /// Checks that functions contain only constants and symbols that have a rate.
    ///
    /// # Errors
    /// [`AnalysisError::NotAVariable`] naming the first other symbol.
    fn check(&self, functions: &[Expr<'g>]) -> Result<(), AnalysisError> {
        let first =
            |pairs: &[(Expr<'g>, Expr<'g>)]| pairs.iter().map(|&(symbol, _)| symbol).collect::<Vec<_>>();
        let known = [first(&self.flow), first(&self.accelerations), self.constants.clone()].concat();
        check_variables("a function along the motion", self.graph, functions, &known)
    }

    /// The rate df/dt, as an expression in (t, x, η) or (t, x, y).
    ///
    /// # Errors
    /// [`AnalysisError::NotAVariable`] for a function of a symbol that does not belong to the motion: the symbol
    /// neither changes along the motion nor appears in its equations.
    pub fn of(&self, f: Expr<'g>) -> Result<Expr<'g>, AnalysisError> {
        Ok(self.of_all(&[f])?[0])
    }

    /// The rates of several functions, one for each.
    ///
    /// # Errors
    /// As for [`of`](Rates::of).
    pub fn of_all(&self, functions: &[Expr<'g>]) -> Result<Vec<Expr<'g>>, AnalysisError> {
        self.check(functions)?;
        Ok(self.along(functions))
    }

    /// [`of_all`](Rates::of_all) for functions already checked.
    pub(crate) fn along(&self, functions: &[Expr<'g>]) -> Vec<Expr<'g>> {
        let functions = self.graph.substitute(functions, &self.accelerations);
        self.graph.substitute(&self.graph.directional(&functions, &self.flow), &self.momenta)
    }

    /// Whether f is constant along the motion. If the rate contains roots, logarithms or the like,
    /// [`Conservation::Changing`] is not a proof of the contrary: the graph knows few of their identities.
    ///
    /// # Errors
    /// As for [`of`](Rates::of).
    pub fn verdict(&self, f: Expr<'g>) -> Result<Conservation<'g>, AnalysisError> {
        let rate = self.of(f)?;
        let (always, here) = (rate.is_zero(), self.at_present(rate).is_zero());
        Ok(if here && self.has_jumps(f) {
            Conservation::ConservedBetweenJumps
        } else if always {
            Conservation::Conserved
        } else if here {
            Conservation::ConservedHere
        } else {
            Conservation::Changing(rate)
        })
    }

    /// The rate relative to its terms, |df/dt|/Σ|∂f/∂z_i ż_i|, at a point, from 0 to 1: at most rounding
    /// error if f is an integral. `None` if all terms vanish, or if a term is not a number.
    ///
    /// # Errors
    /// As for [`of`](Rates::of).
    pub fn part_left(&self, f: Expr<'g>, at: &[(Expr<'g>, f64)]) -> Result<Option<f64>, AnalysisError> {
        self.check(&[f])?;
        let f = self.graph.substitute(&[f], &self.accelerations)[0];
        let symbols: Vec<Expr<'g>> = self.flow.iter().map(|&(symbol, _)| symbol).collect();
        let slopes = self.graph.gradient(f, &symbols);
        let terms = slopes.iter().zip(&self.flow).map(|(&slope, &(_, rate))| slope * rate);
        let terms = self.graph.substitute(&terms.collect::<Vec<_>>(), &self.momenta);
        let values = self.graph.evaluate(&terms, at)?;
        let size: f64 = values.iter().map(|term| term.abs()).sum();
        let left = values.iter().sum::<f64>().abs() / size;
        Ok(Some(left).filter(|left| left.is_finite()))
    }

    /// Whether f may jump, because it contains a sign, a step or an angle of changing quantities, or is seen
    /// to jump.
    pub fn has_jumps(&self, f: Expr<'g>) -> bool {
        let f = self.graph.substitute(&[f], &self.accelerations)[0];
        let changing: Vec<Expr<'g>> = self.flow.iter().map(|&(symbol, _)| symbol).collect();
        let number = |&(symbol, value): &(Expr<'g>, Expr<'g>)| Some((symbol, value.constant()?.to_f64()));
        let numbers: Vec<(Expr<'g>, f64)> = self.numbers.iter().filter_map(number).collect();
        // What cannot be evaluated is not known to be without jumps.
        may_jump(self.graph, f, &changing, &numbers).unwrap_or(true)
    }

    /// The function for the present values of the parameters: those that are short rationals are replaced by
    /// them, and multiples of each other by one of them.
    pub fn at_present(&self, f: Expr<'g>) -> Expr<'g> {
        self.graph.substitute(&[f], &self.present)[0]
    }

    /// The derivative for the present values of the parameters. Those that are no short rationals, such as √2, stay
    /// symbols, and those that are simple multiples of each other become multiples of one.
    #[must_use]
    pub fn with_parameters_bound(&self) -> Rates<'g> {
        let bind = |pairs: &[(Expr<'g>, Expr<'g>)]| -> Vec<_> {
            pairs.iter().map(|&(s, rate)| (s, self.at_present(rate))).collect()
        };
        let is_replaced = |p: &Expr<'g>| self.present.iter().any(|(replaced, _)| replaced == p);
        Rates {
            flow: bind(&self.flow),
            accelerations: bind(&self.accelerations),
            momenta: bind(&self.momenta),
            present: Vec::new(),
            indeterminates: self.indeterminates.iter().copied().filter(|p| !is_replaced(p)).collect(),
            ..self.clone()
        }
    }

    /// The derivative with a symbol that stands for any value in the place of each long constant; `None` if there are none in the
    /// rates and in these functions, or too many.
    pub(crate) fn with_long_constants_free(&self, functions: &[Expr<'g>]) -> Option<Rates<'g>> {
        let free = |pairs: &[(Expr<'g>, Expr<'g>)]| -> Vec<(Expr<'g>, Expr<'g>)> {
            let (symbols, rates): (Vec<_>, Vec<_>) = pairs.iter().copied().unzip();
            symbols.into_iter().zip(with_symbols(self.graph, &rates)).collect()
        };
        let (flow, accelerations, momenta) =
            (free(&self.flow), free(&self.accelerations), free(&self.momenta));
        let written = flow.iter().map(|&(_, rate)| rate).chain(with_symbols(self.graph, functions));
        let new = symbols_with_numbers(self.graph, &written.collect::<Vec<_>>()).into_iter();
        let new: Vec<Expr<'g>> = new.map(|(symbol, _)| symbol).collect();
        (1..=MOST_LONG).contains(&new.len()).then(|| Rates {
            flow,
            accelerations,
            momenta,
            constants: [self.constants.as_slice(), &new].concat(),
            indeterminates: [self.indeterminates.as_slice(), &new].concat(),
            ..self.clone()
        })
    }

    /// Whether parameters that are replaced at their present values occur in the rates, or in these functions.
    pub(crate) fn depend_on_present_values(&self, functions: &[Expr<'g>]) -> bool {
        let flow = self.flow.iter().map(|&(_, rate)| rate).chain(functions.iter().copied());
        self.are_of_present_values(&flow.collect::<Vec<_>>())
    }

    /// Whether parameters that are replaced at their present values occur in the functions.
    pub(crate) fn are_of_present_values(&self, functions: &[Expr<'g>]) -> bool {
        let written = self.graph.symbols_of(functions);
        self.present.iter().any(|(replaced, _)| written.contains(replaced))
    }
}
