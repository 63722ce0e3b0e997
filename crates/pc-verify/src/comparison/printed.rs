//! The numerical values of the printed equations, computed from exactly the expressions that `pc derive`
//! prints.

use nalgebra::DMatrix;
use pc_expr::ExprError;
use pc_mech::{Expr, Graph};
use pc_model::{Assembly, FreeForm, Variables};
use pc_print::{Balance, Derived, Form, Sheet};

use crate::comparison::second::Second;
use crate::comparison::ways::{Way, by_b, ways};
use crate::derivation::derivation::Derivation;
use crate::derivation::here::Here;
use crate::derivation::quantity::{Free, Quantity};
use crate::error::Irregular;
use crate::numbers::linear::solve;
use crate::numbers::rounding::Rounding;

/// The name of a printed form.
pub(crate) fn printed_name(form: Form) -> String {
    format!("{} as printed", form.name())
}

/// The quantities to compare, with their names.
pub(crate) type Candidates = Vec<(String, Option<Quantity>)>;

/// The expressions of one form.
pub(crate) struct Printed<'g> {
    form: Form,
    page: &'g Graph,
    sheet: Sheet<'g>,
    /// The names of the free quasi-velocities.
    quasi_velocities: Vec<String>,
    /// The left-hand sides of equations and the expressions that they equal, without reactions.
    direct: Vec<(Side, Expr<'g>)>,
    /// The equations for the accelerations or the rates of momenta, in each way in which they are printed.
    ways: Vec<Way<'g>>,
    /// The symbols with their meanings.
    inputs: Vec<(Expr<'g>, Input)>,
    /// The change of quasi-velocities, if the equations do not use those of the model.
    change: Option<Change<'g>>,
}

/// Quasi-velocities on the page that are not those of the model.
struct Change<'g> {
    /// The symbols of these quasi-velocities, and the symbols of their rates.
    symbols: Vec<Expr<'g>>,
    accelerations: Vec<Expr<'g>>,
    /// The definitions of these quasi-velocities in terms of the independent quasi-velocities of the model.
    definitions: Vec<Expr<'g>>,
    /// The rates of the independent quasi-velocities of the model, in terms of the new quasi-velocities and
    /// their rates.
    rates: Vec<Expr<'g>>,
    /// η°, the independent quasi-velocities of the model where the new ones are zero. It differs from zero if
    /// constraints are affine.
    at_rest: Vec<Expr<'g>>,
}

/// A left side.
#[derive(Clone, Debug)]
enum Side {
    /// The rate of a coordinate or first-order state with this name.
    Rate(String),
    /// A quasi-velocity with this name.
    QuasiVelocity(String),
    /// Momentum number s, as a function of the quasi-velocities.
    Momentum(usize),
    Energy,
}

impl Second {
    /// The meaning of a name of the model.
    fn input(&self, name: &str) -> Option<Input> {
        let names = &self.derivation.text.names;
        let place = |list: &[String], name: &str| list.iter().position(|known| known == name);
        let reaction = || place(&names.constraints, name.strip_prefix("λ_")?).map(Input::Reaction);
        let time = (name == "t").then_some(Input::Time);
        time.or_else(|| place(&names.coordinates, name).map(Input::Coordinate))
            .or_else(|| place(&names.parameters, name).map(Input::Parameter))
            .or_else(|| place(&names.states, name).map(Input::State))
            .or_else(|| self.free(name).map(Input::Velocity))
            .or_else(reaction)
    }

    /// Whether there are as many of these quasi-velocities as there are velocities, or as there are
    /// velocities that the constraints leave free.
    fn are_free(&self, free: &[Free]) -> bool {
        let k = self.start.w.len();
        free.len() == k || free.len() + self.derivation.kept.len() == k
    }
}

/// The meaning of a symbol on the page.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Input {
    Time,
    Coordinate(usize),
    State(usize),
    Parameter(usize),
    Velocity(Free),
    Momentum(usize),
    Reaction(usize),
    /// A force that is computed outside the model.
    External,
}

impl<'g> Printed<'g> {
    /// The printed equations of a form; `None` if there is no such form.
    pub(crate) fn new(
        (form, reactions): (Form, bool),
        assembly: &Assembly<'_>,
        page: &'g Graph,
    ) -> Option<Printed<'g>> {
        if assembly.system.large_tree().is_some() {
            return None; // bodies are printed instead of equations
        }
        let (_, derived) = Derived::new(form, assembly).ok()?;
        let derived = if reactions { derived.with_reactions(form, assembly).ok()? } else { derived };
        let sheet = match form {
            // They equal Lagrange's equations.
            Form::Voronets if assembly.constraints.multipliers().is_none() => return None,
            Form::Hamel if assembly.given.is_empty() => return None,
            Form::Reduced | Form::LiePoisson if !is_reduced(assembly) => return None,
            _ if form.variables().is_some_and(Variables::has_momenta) => {
                let free = assembly.free_form(form.variables()?).ok()?;
                let equations = free.system.canonical().ok()?;
                Sheet::of_momenta(assembly, &derived, &equations, page)
            }
            _ => Sheet::of_velocities(assembly, &derived, page),
        };
        let change = match form {
            Form::Orthonormal | Form::Hamel => Some(assembly.free_form(form.variables()?).ok()?),
            _ => None,
        };
        let quasi_velocities: Vec<String> = match &change {
            Some(change) => change.independent.iter().map(Expr::to_string).collect(),
            None => sheet.quasi_velocities.iter().map(Expr::to_string).collect(),
        };
        let change = change.map(|change| Change::of(&change, page));
        let rate = |&(rate, value): &(Expr<'g>, Expr<'g>)| {
            (Side::Rate(rate.to_string().trim_end_matches('\'').to_owned()), value)
        };
        let mut direct: Vec<_> = sheet.rates.iter().chain(&sheet.states).map(rate).collect();
        direct.push((Side::Energy, sheet.energy));
        let of_coordinate = |(x, value): (&Expr<'g>, Expr<'g>)| (Side::Rate(x.to_string()), value);
        direct.extend(sheet.coordinates.iter().zip(by_b(&sheet, page)).map(of_coordinate));
        if let Balance::Momenta { of_velocities, velocities, .. } = &sheet.balance {
            direct.extend((0..).zip(of_velocities).map(|(s, &y)| (Side::Momentum(s), y)));
            // If the equations are not closed, quasi-velocities are their own values.
            let solved = velocities.as_ref().unwrap_or(&sheet.quasi_velocities);
            let solved = quasi_velocities.iter().zip(solved);
            direct.extend(solved.map(|(eta, &value)| (Side::QuasiVelocity(eta.clone()), value)));
        }
        let time = page.symbol(&assembly.system.frame().time().to_string());
        let ways = ways(&sheet, time, page);
        Some(Printed { form, page, sheet, quasi_velocities, direct, ways, inputs: Vec::new(), change })
    }

    /// The name of the form.
    pub(crate) fn name(&self) -> String {
        printed_name(self.form)
    }

    /// The compared quantities, in the order of the [values](Printed::values), with the free
    /// quasi-velocities.
    pub(crate) fn prepare(
        &mut self,
        second: &Second,
        external: &[String],
    ) -> Result<(Candidates, Vec<Free>), String> {
        let unknown = |name: &String| format!("`{name}` is unknown to the second derivation");
        let free = |name: &String| second.free(name).ok_or_else(|| unknown(name));
        let free: Vec<Free> = self.quasi_velocities.iter().map(free).collect::<Result<_, String>>()?;
        if !second.are_free(&free) {
            return Err("its velocities are not the independent ones".to_owned());
        }
        let momenta = self.momenta();
        for symbol in self.page.symbols_of(&self.all()) {
            let name = symbol.symbol_name().unwrap_or_default();
            if name
                .strip_suffix('\'')
                .is_some_and(|eta| self.quasi_velocities.iter().any(|known| known == eta))
            {
                continue; // an acceleration, which the equations give
            }
            if self.change.as_ref().is_some_and(|change| change.has(symbol)) {
                continue; // it follows from the definitions
            }
            let momentum = momenta.iter().position(|y| *y == name).map(Input::Momentum);
            let outside = || external.contains(&name).then_some(Input::External);
            let input = momentum.or_else(|| second.input(&name)).or_else(outside);
            self.inputs.push((symbol, input.ok_or_else(|| unknown(&name))?));
        }
        let direct = self.direct.iter().map(|(side, _)| match side {
            Side::Rate(name) => (format!("the rate of {name}"), second.rate(name)),
            Side::QuasiVelocity(name) => (name.clone(), second.velocity(name)),
            Side::Momentum(s) => (momenta[*s].clone(), Some(Quantity::Momentum(*s))),
            Side::Energy => ("energy".to_owned(), Some(Quantity::FreeEnergy)),
        });
        let mut candidates: Candidates = direct.collect();
        for Way { label: way, .. } in &self.ways {
            if self.has_momenta() {
                let rates = (0..).zip(&momenta);
                candidates.extend(
                    rates.map(|(s, y)| (format!("the rate of {y}{way}"), Some(Quantity::MomentumRate(s)))),
                );
            } else {
                let rates = self.quasi_velocities.iter();
                candidates.extend(rates.map(|eta| (format!("the rate of {eta}{way}"), second.rate(eta))));
            }
        }
        let reactions = self.sheet.reactions.iter().map(|(name, _)| name.to_string());
        candidates.extend(reactions.map(|name| {
            let observable = second.observable(&name);
            (name, observable)
        }));
        Ok((candidates, free))
    }

    /// The symbols of the momenta.
    fn momenta(&self) -> Vec<String> {
        match &self.sheet.balance {
            Balance::Momenta { momenta, .. } => momenta.iter().map(Expr::to_string).collect(),
            Balance::Velocities { .. } | Balance::Maggi(_) | Balance::Forces(_) => Vec::new(),
        }
    }

    /// All expressions.
    fn all(&self) -> Vec<Expr<'g>> {
        let direct = self.direct.iter().map(|&(_, value)| value);
        let ways = self.ways.iter().flat_map(|way| way.mass.iter().chain(&way.right)).copied();
        let reactions = self.sheet.reactions.iter().map(|&(_, value)| value);
        let change = self.change.iter().flat_map(Change::all);
        direct.chain(ways).chain(reactions).chain(change.copied()).collect()
    }

    fn has_momenta(&self) -> bool {
        self.form.variables().is_some_and(Variables::has_momenta)
    }

    /// The values of the printed equations: M η̇ = r is solved; momenta, if they are the variables, and
    /// multipliers, if the equations contain them, are taken from the second derivation.
    pub(crate) fn values(
        &self,
        second: &Derivation,
        here: &Here,
        free: &[Free],
        rounding: &Rounding,
    ) -> Result<Vec<f64>, Irregular> {
        let exact = Rounding::none();
        let wanted: Vec<Quantity> = (0..self.momenta().len()).map(Quantity::Momentum).collect();
        let momenta = second.quantities(&here.derived, &wanted, Some(free), &exact)?;
        let still = second.still(&here.derived.place, &exact);
        let value = |input: &Input| match *input {
            Input::Time => here.derived.place.t,
            Input::Coordinate(i) => here.derived.place.x[i],
            Input::State(j) => here.derived.place.z[j],
            Input::Parameter(j) => still.parameter(j),
            Input::Velocity(free) => here.velocity(free),
            // Momenta are rounded as well, which may change many digits of the velocities.
            Input::Momentum(s) => rounding.of(momenta[s].value),
            Input::Reaction(a) => {
                let place = second.kept.iter().position(|&kept| kept == a);
                place.map_or(0.0, |place| here.derived.reactions[place])
            }
            Input::External => 0.0,
        };
        let mut at: Vec<_> = self.inputs.iter().map(|(symbol, input)| (*symbol, value(input))).collect();
        let refused = |error: ExprError| Irregular::Refused { form: self.name(), message: error.to_string() };
        let evaluate =
            |list: &[Expr<'g>], at: &[(Expr<'g>, f64)]| self.page.evaluate(list, at).map_err(refused);
        if let Some(change) = &self.change {
            let values = evaluate(&change.definitions, &at)?;
            at.extend(change.symbols.iter().copied().zip(values));
        }
        let direct: Vec<Expr<'g>> = self.direct.iter().map(|&(_, value)| value).collect();
        let mut values = evaluate(&direct, &at)?;
        if let Some(change) = self.change.as_ref().filter(|change| change.shifts()) {
            // η = η° + A⁻¹V and Y = A⁻ᵀy, hence y·η − L = Y·V − L + y·η°.
            let momenta: Vec<Quantity> = (0..free.len()).map(Quantity::Momentum).collect();
            let momenta = second.quantities(&here.derived, &momenta, Some(free), &exact)?;
            let at_rest = evaluate(&change.at_rest, &at)?;
            let shift: f64 = momenta.iter().zip(at_rest).map(|(y, eta)| y.value * eta).sum();
            let energies = self.direct.iter().zip(&mut values);
            energies
                .filter(|((side, _), _)| matches!(side, Side::Energy))
                .for_each(|(_, energy)| *energy += shift);
        }
        let mut rates = Vec::new();
        for way in &self.ways {
            let right = evaluate(&way.right, &at)?;
            rates = if self.has_momenta() {
                right
            } else {
                let k = right.len();
                let mass = evaluate(&way.mass, &at)?;
                let mass = DMatrix::from_fn(k, k, |r, s| mass[r * k + s]);
                solve(&mass, &right, &right)?.values
            };
            match &self.change {
                None => values.extend(&rates),
                Some(change) => {
                    let moving = change.accelerations.iter().copied().zip(rates.iter().copied());
                    values.extend(evaluate(
                        &change.rates,
                        &at.iter().copied().chain(moving).collect::<Vec<_>>(),
                    )?);
                }
            }
        }
        let accelerations = self.sheet.quasi_velocities.iter();
        let accelerations = accelerations.map(|eta| self.page.symbol(&format!("{eta}'")));
        at.extend(accelerations.zip(rates));
        let reactions: Vec<Expr<'g>> = self.sheet.reactions.iter().map(|&(_, value)| value).collect();
        values.extend(evaluate(&reactions, &at)?);
        match values.iter().all(|value| value.is_finite()) {
            true => Ok(values),
            false => Err(Irregular::NotFinite { what: "what is printed" }),
        }
    }
}

impl<'g> Change<'g> {
    fn of(form: &FreeForm<'_>, page: &'g Graph) -> Change<'g> {
        let (system, graph) = (&form.system, form.system.graph());
        let (eta, frame, accelerations) = (system.quasi_velocities(), system.frame(), system.accelerations());
        let zero: Vec<_> = eta.iter().map(|&eta| (eta, 0.into())).collect();
        let along: Vec<_> = (frame.coordinates().iter().copied().zip(frame.velocities(eta)))
            .chain(eta.iter().copied().zip(accelerations.iter().copied()))
            .chain([(frame.time(), 1.into())])
            .collect();
        Change {
            symbols: graph.transcribe(eta, page),
            rates: graph.transcribe(&graph.directional(&form.values, &along), page),
            definitions: graph.transcribe(&form.definitions, page),
            accelerations: graph.transcribe(&accelerations, page),
            at_rest: graph.transcribe(&graph.substitute(&form.values, &zero), page),
        }
    }

    /// All expressions.
    fn all(&self) -> impl Iterator<Item = &Expr<'g>> {
        self.definitions.iter().chain(&self.rates).chain(&self.at_rest)
    }

    /// Whether the quasi-velocities of the model differ from zero where the new ones are zero.
    fn shifts(&self) -> bool {
        self.at_rest.iter().any(|eta| !eta.is_zero())
    }

    /// Whether a symbol is a quasi-velocity that does not belong to the model, or the rate of one.
    fn has(&self, symbol: Expr<'g>) -> bool {
        let place = self.symbols.iter().position(|&eta| eta == symbol);
        place.is_some_and(|place| self.definitions[place] != symbol) || self.accelerations.contains(&symbol)
    }
}

/// Whether the model has ignorable coordinates.
pub(crate) fn is_reduced(assembly: &Assembly<'_>) -> bool {
    let left = assembly.free_form(Variables::Reduced);
    let all = assembly.system.frame().coordinates().len();
    left.is_ok_and(|left| left.system.frame().coordinates().len() < all)
}
