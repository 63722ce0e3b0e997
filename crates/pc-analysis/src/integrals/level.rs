//! Functions that are conserved where constraints hold, or on a level of other integrals.

use pc_mech::{Equations, Expr, Identity, Neighbourhood, Number};

use crate::integrals::integral::{ConservationVerdict, Integral, Integrals, LevelEquation, Origin};
use crate::integrals::present_values::is_short;
use crate::integrals::search::Search;
use crate::integrals::vanishing::vanishes_where;

/// A value of an integral at the start is taken for a number this close to it, as a fraction of the terms of the integral.
const CLOSE: f64 = 1e-9;
/// The digits of that number.
const DIGITS: usize = 6;

impl<'g> Integrals<'g> {
    /// Judges the functions whose rates do not vanish identically where the `constraints` vanish, and on levels of the
    /// integrals: on that of the start, and where one of them is zero.
    ///
    /// A rate vanishes there if it is Σ q_i (f_i − c_i) with polynomials q_i, divided by its common denominator. A
    /// function whose rate vanishes with the constraints is conserved.
    ///
    /// ```
    /// use pc_analysis::{ConservationVerdict, Integrals};
    /// use pc_mech::{Graph, Neighbourhood, System};
    ///
    /// // A particle on a line, free: x x' changes at the rate x'², so it is conserved where x' = 0.
    /// let graph = Graph::new();
    /// let particle = System::builder(&graph)
    ///     .coordinates(["x"])
    ///     .lagrangian(|_, _, v| v[0].square() / 2.0)
    ///     .integral("impulse", |_, _, v| v[0])
    ///     .integral("virial", |_, x, v| x[0] * v[0])
    ///     .build()?;
    /// let at: Vec<_> = [("t", 0.0), ("x", 0.5), ("x'", 0.0)].map(|(name, z)| (graph.symbol(name), z)).into();
    /// let (equations, near) = (particle.poincare()?, Neighbourhood { centre: at });
    /// let mut integrals = Integrals::known(&equations, &near);
    /// integrals.judge_on_levels(&equations, &near, &[]);
    /// let virial = &integrals.list()[1];
    /// assert_eq!(virial.verdict, ConservationVerdict::OnLevel { always: true });
    /// assert_eq!(virial.level[0].name, "impulse");
    /// # Ok::<(), pc_mech::MechError>(())
    /// ```
    pub fn judge_on_levels(
        &mut self,
        equations: &Equations<'g>,
        near: &Neighbourhood<'g>,
        constraints: &[Expr<'g>],
    ) {
        let is_open = |integral: &Integral<'g>| {
            integral.origin == Origin::Declared
                && matches!(integral.verdict, ConservationVerdict::Rate { .. })
        };
        if !self.list.iter().any(is_open) {
            return;
        }
        let search = Search::new(equations, near);
        let kept = self.list.iter().filter(|f| f.is_conserved() && !f.jumps);
        let always = kept.clone().filter(|f| f.verdict == ConservationVerdict::Conserved);
        let levels = Levels {
            at_start: kept.filter_map(|f| Levels::equation(&search, f)).collect(),
            at_zero: always.clone().map(|f| LevelEquation::new(f, Number::ZERO)).collect(),
            always: always.map(|f| f.name.clone()).collect(),
            search,
            constraints,
        };
        for integral in self.list.iter_mut().filter(|integral| is_open(integral)) {
            levels.judge(integral);
        }
    }
}

/// The levels on which functions are judged.
struct Levels<'a, 'g> {
    search: Search<'a, 'g>,
    constraints: &'a [Expr<'g>],
    /// The integrals with their values at the start, as far as these are short numbers.
    at_start: Vec<LevelEquation<'g>>,
    /// The integrals for all values of the parameters, with the value zero.
    at_zero: Vec<LevelEquation<'g>>,
    /// The names of the integrals for all values of the parameters.
    always: Vec<String>,
}

impl<'g> Levels<'_, 'g> {
    /// The equation f = c with the value at the start, if it is a short number to within rounding errors.
    fn equation(search: &Search<'_, 'g>, integral: &Integral<'g>) -> Option<LevelEquation<'g>> {
        let graph = search.graph;
        let symbols = graph.symbols_of(&[integral.value]);
        let slopes = graph.gradient(integral.value, &symbols);
        let terms = slopes.iter().zip(&symbols).map(|(&slope, &z)| slope * z);
        let outputs: Vec<Expr<'g>> = [integral.value].into_iter().chain(terms).collect();
        let values = graph.evaluate(&outputs, &search.near.centre).ok()?;
        let (value, size) = (values[0], values[1..].iter().map(|term| term.abs()).sum::<f64>());
        let near: f64 = format!("{value:.DIGITS$}").parse().ok()?;
        let is_close = (value - near).abs() <= CLOSE * size.max(f64::MIN_POSITIVE);
        let number = Number::from(near);
        (is_close && is_short(number)).then(|| LevelEquation::new(integral, number))
    }

    /// Gives the integral its verdict where the constraints hold, or on the smallest set of equations on which it is
    /// conserved.
    fn judge(&self, integral: &mut Integral<'g>) {
        let ConservationVerdict::Rate { part_left, .. } = integral.verdict else { return };
        let Ok(rate) = self.search.rates.of(integral.value) else { return };
        let is_refuted =
            part_left.is_some_and(|left| matches!(Identity::of(left), Identity::Disproved { .. }));
        if !is_refuted {
            if let Some(always) = self.vanishes(rate, &[]).filter(|_| !self.constraints.is_empty()) {
                integral.verdict = match (self.search.rates.has_jumps(integral.value), always) {
                    (true, _) => ConservationVerdict::BetweenJumps,
                    (false, true) => ConservationVerdict::Conserved,
                    (false, false) => ConservationVerdict::ConservedHere,
                };
                return;
            }
            if let Some((level, always)) = self.least(rate)
                && !self.search.rates.has_jumps(integral.value)
            {
                let always = always && level.iter().all(|equation| self.always.contains(&equation.name));
                (integral.level, integral.verdict) = (level, ConservationVerdict::OnLevel { always });
                return;
            }
        }
        let at_zero = |equation: &&LevelEquation<'g>| {
            !self.at_start.contains(equation) && self.vanishes(rate, &[equation]) == Some(true)
        };
        integral.level = self.at_zero.iter().find(at_zero).cloned().into_iter().collect();
    }

    /// The equations of the level of the start on which the rate vanishes, as few as possible, and whether it does so for
    /// all values of the parameters.
    fn least(&self, rate: Expr<'g>) -> Option<(Vec<LevelEquation<'g>>, bool)> {
        let alone = self
            .at_start
            .iter()
            .find_map(|equation| Some((vec![equation], self.vanishes(rate, &[equation])?)));
        let (equations, always) = alone.or_else(|| {
            let mut all: Vec<&LevelEquation<'g>> = self.at_start.iter().collect();
            let mut always = self.vanishes(rate, &all)?;
            for equation in &self.at_start {
                let rest: Vec<_> = all.iter().copied().filter(|&kept| kept != equation).collect();
                if let Some(still) = self.vanishes(rate, &rest) {
                    (all, always) = (rest, still);
                }
            }
            Some((all, always))
        })?;
        Some((equations.into_iter().cloned().collect(), always))
    }

    /// Whether the rate vanishes where the constraints and these equations hold: for all values of the parameters, or only
    /// for the present ones.
    fn vanishes(&self, rate: Expr<'g>, equations: &[&LevelEquation<'g>]) -> Option<bool> {
        let rates = &self.search.rates;
        let levels = equations.iter().map(|equation| equation.function - Expr::from(equation.value));
        let levels: Vec<Expr<'g>> = self.constraints.iter().copied().chain(levels).collect();
        if levels.is_empty() {
            return None;
        }
        if vanishes_where(rates, rate, &levels) {
            return Some(true);
        }
        let all = [levels.as_slice(), &[rate]].concat();
        if !rates.are_of_present_values(&all) {
            return None;
        }
        let levels: Vec<Expr<'g>> = levels.into_iter().map(|level| rates.at_present(level)).collect();
        let here = vanishes_where(&rates.with_parameters_bound(), rates.at_present(rate), &levels);
        here.then_some(false)
    }
}

impl<'g> LevelEquation<'g> {
    fn new(integral: &Integral<'g>, value: Number) -> LevelEquation<'g> {
        LevelEquation { name: integral.name.clone(), function: integral.value, value }
    }
}
