//! The cost of one evaluation of a right-hand side.

use pc_expr::{Cost, ExprError, Inputs, Program};
use pc_mech::{Canonical, Equations, Expr, System};
use serde_json::{Value, json};

/// The operations of one evaluation of the right-hand side ẋ, η̇.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Operations {
    /// The cost with parameters as run-time inputs.
    pub free: Cost,
    /// The cost with parameters replaced by their numbers.
    pub bound: Cost,
    /// The functions without a value, which are counted as two waves each.
    pub undetermined: Vec<String>,
}

impl Operations {
    /// The operations of Poincaré's equations.
    ///
    /// # Errors
    /// [`ExprError`] if the right-hand side cannot be compiled.
    pub fn of(equations: &Equations<'_>) -> Result<Operations, ExprError> {
        let system = equations.system();
        let rates = [equations.velocities(), &equations.accelerations(), &rates_of_states(system)].concat();
        Operations::counted(system, system.quasi_velocities(), &rates)
    }

    /// The operations of the canonical equations; if these are not closed, those for given values of the
    /// quasi-velocities.
    ///
    /// # Errors
    /// As [`of`](Operations::of).
    pub fn of_canonical(equations: &Canonical<'_>) -> Result<Operations, ExprError> {
        let rates = [equations.velocities(), equations.right_hand_side(), equations.state_rates()].concat();
        let system = equations.system();
        let implicit = if equations.is_closed() { &[] } else { system.quasi_velocities() };
        Operations::counted(system, &[equations.momenta(), implicit].concat(), &rates)
    }

    /// The operations of `rates`, functions of time, coordinates, `moving` and parameters.
    fn counted<'g>(
        system: &System<'g>,
        moving: &[Expr<'g>],
        rates: &[Expr<'g>],
    ) -> Result<Operations, ExprError> {
        let graph = system.graph();
        let time = system.frame().time();
        let states = system.states().iter().map(|(z, _)| z);
        let state: Vec<Expr<'g>> =
            system.frame().coordinates().iter().chain(moving).chain(states).copied().collect();
        // Parameters, and other symbols in the equations: external forces, reactions.
        let others = graph.symbols_of(rates).into_iter().filter(|x| *x != time && !state.contains(x));
        let inputs = Inputs { time: Some(time), parameters: others.collect(), state };
        let numbers = system.parameters();
        let free = Program::new(graph, &inputs, rates)?;
        // The rest of the free program is shorter if multiplied-out numbers would make more sums than
        // parameters do.
        let folded = free.bound_where(|name| {
            let number = numbers.iter().find(|(symbol, _)| symbol.symbol_name().as_deref() == Some(name));
            number.map(|&(_, value)| value)
        });
        let substituted: Vec<_> = numbers.iter().map(|&(symbol, value)| (symbol, value.into())).collect();
        let substituted = Program::new(graph, &inputs, &graph.substitute(rates, &substituted))?;
        let bound = [substituted.cost(), folded.cost()].into_iter().min_by_key(Cost::total);
        let undetermined = graph.undetermined_in(rates);
        Ok(Operations { bound: bound.unwrap_or_default(), free: free.cost(), undetermined })
    }
}

/// The rates ż of the first-order states.
fn rates_of_states<'g>(system: &System<'g>) -> Vec<Expr<'g>> {
    system.states().iter().map(|&(_, rate)| rate).collect()
}

impl Operations {
    /// One line of text for free parameters and one for bound ones, and one on functions without a value.
    pub fn lines(&self) -> Vec<String> {
        let both = [counted("parameters free ", &self.free), counted("parameters bound", &self.bound)];
        let names = self.undetermined.join(", ");
        let waves =
            (!names.is_empty()).then(|| format!("with two sines or cosines for each call of {names}"));
        both.into_iter().chain(waves).collect()
    }
}

/// A cost as text: `what`, the total, and the counts of each kind of operation.
pub fn counted(what: &str, cost: &Cost) -> String {
    let kinds: Vec<String> = cost.iter().map(|(kind, count)| format!("{count} {kind}")).collect();
    match kinds.as_slice() {
        [] => format!("{what}  0"),
        kinds => format!("{what}  {} = {}", cost.total(), kinds.join(" + ")),
    }
}

impl Operations {
    /// As JSON.
    pub fn object(&self) -> Value {
        json!({ "free": counts(&self.free), "bound": counts(&self.bound) })
    }
}

fn counts(cost: &Cost) -> Value {
    let kinds = cost.iter().map(|(kind, count)| (kind.to_owned(), json!(count)));
    Value::Object(std::iter::once(("total".to_owned(), json!(cost.total()))).chain(kinds).collect())
}
