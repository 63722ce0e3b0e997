//! The equations as they are printed, as numbers: the very expressions that `pc derive` writes, and the sums of products that
//! the right sides are written as, in the graph of a page.

use nalgebra::DMatrix;
use pc_expr::ExprError;
use pc_mech::{Canonical, Expr, Graph};
use pc_model::{Assembly, FreeForm, Variables};
use pc_print::{Derived, Form};

use crate::derivation::Derivation;
use crate::error::Irregular;
use crate::here::Here;
use crate::linear::solve;
use crate::quantity::{Free, Quantity};
use crate::rounding::Rounding;
use crate::second::Second;

/// The forms that are printed.
pub(crate) const FORMS: [Form; 8] = [
    Form::Poincare,
    Form::Canonical,
    Form::Lagrange,
    Form::Voronets,
    Form::Reduced,
    Form::LiePoisson,
    Form::Orthonormal,
    Form::Hamel,
];

/// What a printed form is called.
pub(crate) fn printed_name(form: Form) -> String {
    format!("{} as printed", form.name())
}

/// What is compared, with its name.
pub(crate) type Candidates = Vec<(String, Option<Quantity>)>;

/// The expressions of one form.
pub(crate) struct Printed<'g> {
    form: Form,
    graph: &'g Graph,
    page: &'g Graph,
    /// Names of the free quasi-velocities.
    quasi_velocities: Vec<String>,
    /// What expressions are equal to, each with its name.
    direct: Vec<(Side, Expr<'g>)>,
    /// M by rows; none in the canonical form, where the right sides are rates of momenta.
    mass: Vec<Expr<'g>>,
    right: Vec<Expr<'g>>,
    written: Vec<Option<Expr<'g>>>,
    /// The symbols of the momenta.
    momenta: Vec<String>,
    /// The symbols in both graphs, with what they stand for.
    inputs: Vec<(Expr<'g>, Expr<'g>, Input)>,
    /// Where the quasi-velocities are not those of the model.
    change: Option<Change<'g>>,
}

/// Quasi-velocities that are not those of the model.
struct Change<'g> {
    /// They and their rates, in both graphs for the former.
    symbols: Vec<(Expr<'g>, Expr<'g>)>,
    accelerations: Vec<Expr<'g>>,
    /// What they are in terms of the independent ones of the model.
    definitions: Vec<Expr<'g>>,
    /// The rates of these in terms of them.
    rates: Vec<Expr<'g>>,
}

/// A left side.
#[derive(Clone, Debug)]
enum Side {
    /// The rate of a coordinate or first-order state, by its name.
    Rate(String),
    /// A quasi-velocity, by its name.
    QuasiVelocity(String),
    /// Momentum number s, as a function of the quasi-velocities.
    Momentum(usize),
    Energy,
    /// By its name.
    Reaction(String),
}

impl Second {
    /// What a name of the model stands for.
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

    /// Whether there are as many of these as velocities, or as velocities that the constraints leave.
    fn are_free(&self, free: &[Free]) -> bool {
        let k = self.start.w.len();
        free.len() == k || free.len() + self.derivation.kept.len() == k
    }
}

/// What a symbol stands for.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Input {
    Time,
    Coordinate(usize),
    State(usize),
    Parameter(usize),
    Velocity(Free),
    Momentum(usize),
    Reaction(usize),
    /// A force computed outside.
    External,
}

impl<'g> Printed<'g> {
    /// What is printed in a form; none where there is no such form of the equations.
    pub(crate) fn new(form: Form, assembly: &Assembly<'g>, page: &'g Graph) -> Option<Printed<'g>> {
        match form {
            // The same as Lagrange's.
            Form::Voronets if assembly.constraints.multipliers().is_none() => None,
            Form::Hamel if assembly.given.is_empty() => None,
            Form::Reduced | Form::LiePoisson if !is_reduced(assembly) => None,
            _ if form.variables().is_some_and(Variables::has_momenta) => {
                Printed::canonical(form, assembly, page)
            }
            _ => Printed::in_velocities(form, assembly, page),
        }
    }

    fn in_velocities(form: Form, assembly: &Assembly<'g>, page: &'g Graph) -> Option<Printed<'g>> {
        let (_, derived) = Derived::new(form, assembly).ok()?;
        let (equations, system) = (&derived.equations, derived.equations.system());
        let change = match form {
            Form::Orthonormal | Form::Hamel => Some(assembly.free_form(form.variables()?).ok()?),
            _ => None,
        };
        let coordinates = system.frame().coordinates().iter();
        let rate = |(x, &value): (&Expr<'g>, &Expr<'g>)| (Side::Rate(x.to_string()), value);
        let mut direct: Vec<_> = coordinates.zip(equations.velocities()).map(rate).collect();
        direct.extend(system.states().iter().map(|(z, value)| (Side::Rate(z.to_string()), *value)));
        direct.push((Side::Energy, equations.energy()));
        let reactions = derived.reactions.iter();
        direct.extend(reactions.map(|(name, value)| (Side::Reaction(name.to_string()), *value)));
        Some(Printed {
            form,
            graph: system.graph(),
            page,
            quasi_velocities: match &change {
                Some(change) => change.independent.iter().map(Expr::to_string).collect(),
                None => system.quasi_velocities().iter().map(Expr::to_string).collect(),
            },
            change: change.map(|change| Change::of(&change, page)),
            direct,
            mass: equations.mass_matrix().entries().to_vec(),
            right: equations.right_hand_side().to_vec(),
            written: equations.written(page),
            momenta: Vec::new(),
            inputs: Vec::new(),
        })
    }

    fn canonical(form: Form, assembly: &Assembly<'g>, page: &'g Graph) -> Option<Printed<'g>> {
        let equations: Canonical<'g> = assembly.free_form(form.variables()?).ok()?.system.canonical().ok()?;
        let system = equations.system();
        let quasi_velocities: Vec<String> = system.quasi_velocities().iter().map(Expr::to_string).collect();
        let coordinates = system.frame().coordinates().iter();
        let states = system.states().iter().map(|(z, _)| z);
        let rate = |(x, &value): (&Expr<'g>, &Expr<'g>)| (Side::Rate(x.to_string()), value);
        let mut direct: Vec<_> = coordinates.zip(equations.velocities()).map(rate).collect();
        direct.extend(states.zip(equations.state_rates()).map(rate));
        direct.push((Side::Energy, equations.hamiltonian()));
        direct.extend((0..).zip(equations.momenta_of_velocities()).map(|(s, &y)| (Side::Momentum(s), y)));
        let solved = quasi_velocities.iter().zip(equations.quasi_velocities());
        direct.extend(solved.map(|(eta, &value)| (Side::QuasiVelocity(eta.clone()), value)));
        Some(Printed {
            form,
            change: None,
            graph: system.graph(),
            page,
            direct,
            mass: Vec::new(),
            right: equations.right_hand_side().to_vec(),
            written: equations.written(page),
            momenta: equations.momenta().iter().map(Expr::to_string).collect(),
            inputs: Vec::new(),
            quasi_velocities,
        })
    }

    fn has_momenta(&self) -> bool {
        self.form.variables().is_some_and(Variables::has_momenta)
    }

    /// The name of the form.
    pub(crate) fn name(&self) -> String {
        printed_name(self.form)
    }

    /// What is compared, in the order of the [values](Printed::values), with the free quasi-velocities.
    pub(crate) fn prepare(
        &mut self,
        second: &Second,
        external: &[String],
    ) -> Result<(Candidates, Vec<Free>), String> {
        let unknown = |name: &String| format!("`{name}` is not known to it");
        let free = |name: &String| second.free(name).ok_or_else(|| unknown(name));
        let free: Vec<Free> = self.quasi_velocities.iter().map(free).collect::<Result<_, String>>()?;
        if !second.are_free(&free) {
            return Err("its velocities are not the independent ones".to_owned());
        }
        let definitions =
            self.change.iter().flat_map(|change| change.definitions.iter().chain(&change.rates));
        let expressions: Vec<Expr<'g>> = self
            .direct
            .iter()
            .map(|(_, value)| *value)
            .chain(self.mass.iter().chain(definitions).copied())
            .collect();
        for symbol in self.graph.symbols_of(&[expressions, self.right.clone()].concat()) {
            let name = symbol.symbol_name().unwrap_or_default();
            if self.change.as_ref().is_some_and(|change| change.has(symbol)) {
                continue; // it follows from the definitions
            }
            let momentum = self.momenta.iter().position(|y| *y == name).map(Input::Momentum);
            let outside = || external.contains(&name).then_some(Input::External);
            let input = momentum.or_else(|| second.input(&name)).or_else(outside);
            let input = input.ok_or_else(|| unknown(&name))?;
            self.inputs.push((symbol, self.page.symbol(&name), input));
        }
        let direct = self.direct.iter().map(|(side, _)| match side {
            Side::Rate(name) => (format!("the rate of {name}"), second.rate(name)),
            Side::QuasiVelocity(name) => (name.clone(), second.velocity(name)),
            Side::Momentum(s) => (self.momenta[*s].clone(), Some(Quantity::Momentum(*s))),
            Side::Energy => ("energy".to_owned(), Some(Quantity::FreeEnergy)),
            Side::Reaction(name) => (name.clone(), second.observable(name)),
        });
        let mut candidates: Candidates = direct.collect();
        for way in ["", ", multiplied out"] {
            if self.has_momenta() {
                let rates = (0..).zip(&self.momenta);
                candidates.extend(
                    rates.map(|(s, y)| (format!("the rate of {y}{way}"), Some(Quantity::MomentumRate(s)))),
                );
            } else {
                let rates = self.quasi_velocities.iter();
                candidates.extend(rates.map(|eta| (format!("the rate of {eta}{way}"), second.rate(eta))));
            }
        }
        Ok((candidates, free))
    }

    /// The right sides of what is printed, M η̇ = r being solved, with the momenta of the second derivation where these are the
    /// variables, and its multipliers where these stand in the equations.
    pub(crate) fn values(
        &self,
        second: &Derivation,
        here: &Here,
        free: &[Free],
    ) -> Result<Vec<f64>, Irregular> {
        let exact = Rounding::none();
        let wanted: Vec<Quantity> = (0..self.momenta.len()).map(Quantity::Momentum).collect();
        let momenta = second.quantities(&here.derived, &wanted, Some(free), &exact)?;
        let still = second.still(&here.derived.place, &exact);
        let value = |input: &Input| match *input {
            Input::Time => here.derived.place.t,
            Input::Coordinate(i) => here.derived.place.x[i],
            Input::State(j) => here.derived.place.z[j],
            Input::Parameter(j) => still.parameter(j),
            Input::Velocity(free) => here.velocity(free),
            Input::Momentum(s) => momenta[s].value,
            Input::Reaction(a) => {
                let place = second.kept.iter().position(|&kept| kept == a);
                place.map_or(0.0, |place| here.derived.reactions[place])
            }
            Input::External => 0.0,
        };
        let numbers: Vec<f64> = self.inputs.iter().map(|(.., input)| value(input)).collect();
        let mut there: Vec<_> =
            self.inputs.iter().zip(&numbers).map(|((symbol, ..), &x)| (*symbol, x)).collect();
        let mut on_page: Vec<_> =
            self.inputs.iter().zip(&numbers).map(|((_, symbol, _), &x)| (*symbol, x)).collect();
        let refused = |error: ExprError| Irregular::Refused { form: self.name(), message: error.to_string() };
        if let Some(change) = &self.change {
            let values = self.graph.evaluate(&change.definitions, &there).map_err(refused)?;
            there.extend(change.symbols.iter().zip(&values).map(|(&(symbol, _), &value)| (symbol, value)));
            on_page.extend(change.symbols.iter().zip(&values).map(|(&(_, symbol), &value)| (symbol, value)));
        }
        let all =
            [&self.direct.iter().map(|(_, value)| *value).collect::<Vec<_>>()[..], &self.mass, &self.right];
        let mut values = self.graph.evaluate(&all.concat(), &there).map_err(refused)?;
        let right = values.split_off(self.direct.len() + self.mass.len());
        let mass = values.split_off(self.direct.len());
        let of_page: Vec<Expr<'g>> = self.written.iter().map(|value| value.unwrap_or(Expr::ZERO)).collect();
        let of_page = self.page.evaluate(&of_page, &on_page).map_err(refused)?;
        let written = self.written.iter().zip(of_page).zip(&right);
        let written: Vec<f64> =
            written.map(|((known, value), &as_is)| if known.is_some() { value } else { as_is }).collect();
        for right in [right, written] {
            if self.has_momenta() {
                values.extend(right);
            } else {
                let k = right.len();
                let mass = DMatrix::from_fn(k, k, |r, s| mass[r * k + s]);
                let solved = solve(&mass, &right, &right)?.values;
                match &self.change {
                    None => values.extend(solved),
                    Some(change) => {
                        let rates = change.accelerations.iter().copied().zip(solved);
                        let moving: Vec<_> = there.iter().copied().chain(rates).collect();
                        values.extend(self.graph.evaluate(&change.rates, &moving).map_err(refused)?);
                    }
                }
            }
        }
        match values.iter().all(|value| value.is_finite()) {
            true => Ok(values),
            false => Err(Irregular::NotFinite { what: "what is printed" }),
        }
    }
}

impl<'g> Change<'g> {
    fn of(form: &FreeForm<'g>, page: &'g Graph) -> Change<'g> {
        let (system, graph) = (&form.system, form.system.graph());
        let (eta, frame, accelerations) = (system.quasi_velocities(), system.frame(), system.accelerations());
        let along: Vec<_> = (frame.coordinates().iter().copied().zip(frame.velocities(eta)))
            .chain(eta.iter().copied().zip(accelerations.iter().copied()))
            .chain([(frame.time(), 1.into())])
            .collect();
        Change {
            symbols: eta.iter().map(|&eta| (eta, page.symbol(&eta.to_string()))).collect(),
            rates: graph.directional(&form.values, &along),
            definitions: form.definitions.clone(),
            accelerations,
        }
    }

    /// Whether a symbol is one of them, and none of the model, or the rate of one.
    fn has(&self, symbol: Expr<'g>) -> bool {
        let place = self.symbols.iter().position(|(eta, _)| *eta == symbol);
        place.is_some_and(|place| self.definitions[place] != symbol) || self.accelerations.contains(&symbol)
    }
}

/// Whether there are coordinates that nothing depends on.
pub(crate) fn is_reduced(assembly: &Assembly<'_>) -> bool {
    let left = assembly.free_form(Variables::Reduced);
    let all = assembly.system.frame().coordinates().len();
    left.is_ok_and(|left| left.system.frame().coordinates().len() < all)
}
