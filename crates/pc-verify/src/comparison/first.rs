//! The numerical values of the equations of the first derivation, in each of their forms.

use std::sync::Arc;

use pc_mech::{Backend, Expr, Graph, Motion, Table, VectorField};
use pc_model::{Assembly, Flow};

use crate::comparison::agreement::Agreement;
use crate::comparison::printed::Printed;
use crate::comparison::second::Second;
use crate::derivation::derivation::Derivation;
use crate::derivation::here::Here;
use crate::derivation::quantity::{Free, Quantity};
use crate::error::{Disagreement, Irregular};
use crate::numbers::rounding::Rounding;

/// The equations of the first derivation in one form.
pub(crate) struct First<'g> {
    pub(crate) form: String,
    /// The compared quantities with their names.
    pub(crate) wanted: Vec<(String, Quantity)>,
    /// The indices of the compared quantities among the values of the first derivation.
    places: Vec<usize>,
    /// The free quasi-velocities, if their momenta or energies are compared.
    pub(crate) free: Option<Vec<Free>>,
    source: Values<'g>,
    /// The number of states at which the form was compared, and the reason why there was no comparison at the
    /// last state that was left out.
    pub(crate) compared: usize,
    pub(crate) reason: Option<String>,
    /// The disagreement at the last state at which the values of the form were mere noise.
    pub(crate) noise: Option<Box<Disagreement>>,
}

/// The source of the values of a form.
enum Values<'g> {
    /// The printed expressions.
    Printed(Box<Printed<'g>>),
    /// The integrated equations, with the meaning of each quasi-velocity of the system.
    Flow { flow: Box<Flow>, coordinates: Vec<usize>, quasi_velocities: Vec<Option<Free>> },
    /// The emitted source, run by the interpreter, with the meaning of the quasi-velocities in its state and
    /// the rate of the energy at t and state.
    Emitted {
        motion: Box<Motion>,
        free: Vec<Free>,
        energy_rate: EnergyRate<'g>,
        /// The inputs that are read from tables, with their indices among the parameters.
        tables: Vec<(usize, Arc<Table>)>,
    },
}

/// dH/dt as a function of time, coordinates, quasi-velocities and parameters.
struct EnergyRate<'g> {
    page: &'g Graph,
    rate: Expr<'g>,
    inputs: Vec<Expr<'g>>,
    parameters: Vec<(Expr<'g>, f64)>,
}

impl EnergyRate<'_> {
    fn at(&self, t: f64, state: &[f64]) -> f64 {
        let values = std::iter::once(t).chain(state.iter().copied());
        let mut place: Vec<_> = self.inputs.iter().copied().zip(values).collect();
        place.extend(&self.parameters);
        self.page.evaluate(&[self.rate], &place).map_or(f64::NAN, |values| values[0])
    }
}

impl<'g> First<'g> {
    /// The integrated equations, prepared for the comparison.
    pub(crate) fn flow(
        form: &str,
        flow: Flow,
        second: &Second,
        assembly: &Assembly<'_>,
        agreement: &mut Agreement,
    ) -> First<'g> {
        let system = &assembly.system;
        let names: Vec<String> = system.quasi_velocities().iter().map(ToString::to_string).collect();
        let quasi_velocities = names.iter().map(|name| second.free(name)).collect();
        let n = flow.motion.coordinates();
        let state = flow.motion.names();
        let place = |name: &String| second.derivation.text.names.coordinates.iter().position(|x| x == name);
        let coordinates = state[..n].iter().filter_map(place).collect();
        let (canonical, is_changed) = (flow.has_momenta(), !flow.has_own_variables());
        let columns = flow.free_quasi_velocities().iter().map(|&s| second.free(&names[s]));
        let free: Option<Vec<Free>> =
            if canonical || second.has_free_energy { columns.collect() } else { None };
        let mut candidates: Vec<(String, Option<Quantity>)> = Vec::new();
        let moving = n..state.len() - flow.motion.states();
        // Quasi-velocities absent from the model, and their rates, are compared as those of the model.
        let is_strange = |i: &usize| is_changed && moving.contains(i);
        for (i, name) in state.iter().enumerate() {
            let momentum = (canonical && moving.contains(&i)).then(|| {
                let known = free.is_some();
                known.then(|| Quantity::Momentum(i - n))
            });
            candidates.push((name.clone(), momentum.unwrap_or(Some(Quantity::Zero))));
        }
        for (i, name) in state.iter().enumerate() {
            let momentum = || free.is_some().then(|| Quantity::MomentumRate(i - n));
            let rate = match canonical && moving.contains(&i) {
                true => momentum(),
                false if is_strange(&i) => Some(Quantity::Zero),
                false => second.rate(name),
            };
            candidates.push((format!("the rate of {name}"), rate));
        }
        let shown = flow.names.len() - flow.motion.states();
        for (i, name) in flow.names.iter().enumerate() {
            let is_velocity = (n..shown).contains(&i);
            candidates
                .push((name.clone(), if is_velocity { second.velocity(name) } else { Some(Quantity::Zero) }));
        }
        candidates.extend(
            flow.motion.observable_names().iter().map(|name| (name.clone(), second.observable(name))),
        );
        if is_changed {
            candidates.extend(names.iter().map(|name| (format!("the rate of {name}"), second.rate(name))));
        }
        // The values given to it: coordinates, first-order states, and the quasi-velocities if they are its
        // state.
        let (dim, columns) = (state.len(), 2 * state.len());
        let inputs = [
            0..if canonical { n } else { dim },
            moving.end..dim,
            if is_changed { dim + n..dim + moving.end } else { 0..0 },
            columns..columns + n,
            columns + shown..columns + flow.names.len(),
        ];
        let source = Values::Flow { flow: Box::new(flow), coordinates, quasi_velocities };
        First::comparing(form, candidates, &inputs, free, source, agreement)
    }

    /// The emitted source, prepared for the comparison.
    pub(crate) fn emitted(
        assembly: &Assembly<'_>,
        second: &Second,
        page: &'g Graph,
        agreement: &mut Agreement,
    ) -> Result<First<'g>, String> {
        let equations = assembly.equations().map_err(|error| error.diagnostic().message.clone())?;
        let system = equations.system();
        let motion = equations.compile_for(Backend::Interpreter).map_err(|error| error.to_string())?;
        let column = |eta: &Expr<'_>| {
            let name = eta.to_string();
            second.free(&name).ok_or_else(|| format!("`{name}` is not a column"))
        };
        let free: Vec<Free> = system.quasi_velocities().iter().map(column).collect::<Result<_, _>>()?;
        let rates = motion.names().iter().map(|name| (format!("the rate of {name}"), second.rate(name)));
        let observables = motion.observable_names().iter().map(|name| match second.observable(name) {
            Some(Quantity::Energy) => (name.clone(), Some(Quantity::FreeEnergy)),
            other => (name.clone(), other),
        });
        let mut candidates: Vec<(String, Option<Quantity>)> = rates.chain(observables).collect();
        if second.derivation.text.tables.is_empty() {
            candidates.push(("the rate of energy".to_owned(), Some(Quantity::FreeEnergyRate)));
        } else {
            agreement.leave_out("the rate of energy", "that of an input is not known");
        }
        let system = assembly.constraints.free_system(&assembly.system, &assembly.at_start());
        let system = system.map_err(|error| error.to_string())?;
        if !system.quasi_velocities().iter().map(column).eq(free.iter().map(|&f| Ok(f))) {
            return Err("its quasi-velocities are not those of the free system".to_owned());
        }
        let frame = system.frame();
        let on_page = |list: &[Expr<'_>]| system.graph().transcribe(list, page);
        // Forces computed outside are 0 in either derivation.
        let external = assembly.system.external_forces().iter().map(|&(_, force)| (force, 0.0));
        let (parameters, values): (Vec<_>, Vec<_>) =
            system.parameters().iter().copied().chain(external).unzip();
        let energy_rate = EnergyRate {
            page,
            rate: on_page(&[system.energy_rate()])[0],
            inputs: on_page(&[&[frame.time()], system.state().as_slice()].concat()),
            parameters: on_page(&parameters).into_iter().zip(values).collect(),
        };
        let tables = second.derivation.text.tables.clone();
        let source = Values::Emitted { motion: Box::new(motion), free: free.clone(), energy_rate, tables };
        Ok(First::comparing("emit", candidates, &[], Some(free), source, agreement))
    }

    /// The printed equations of a form, with all reactions if `reactions`, prepared for the comparison.
    pub(crate) fn printed(
        (form, reactions): (pc_print::Form, bool),
        assembly: &Assembly<'_>,
        second: &Second,
        page: &'g Graph,
        agreement: &mut Agreement,
    ) -> Option<First<'g>> {
        let mut printed = Printed::new((form, reactions), assembly, page)?;
        let name = printed.name();
        let external = assembly.system.external_forces();
        let external: Vec<String> = external.iter().map(|(_, force)| force.to_string()).collect();
        match printed.prepare(second, &external) {
            Ok((candidates, free)) => {
                let source = Values::Printed(Box::new(printed));
                Some(First::comparing(&name, candidates, &[], Some(free), source, agreement))
            }
            Err(reason) => {
                agreement.leave_out(&name, &reason);
                None
            }
        }
    }

    /// The equations with the quantities to compare: those of the `candidates` that the second derivation
    /// also has, except the `inputs`, which are given to the first.
    fn comparing(
        form: &str,
        candidates: Vec<(String, Option<Quantity>)>,
        inputs: &[std::ops::Range<usize>],
        free: Option<Vec<Free>>,
        source: Values<'g>,
        agreement: &mut Agreement,
    ) -> First<'g> {
        let (mut wanted, mut places) = (Vec::new(), Vec::new());
        for (place, (label, quantity)) in candidates.into_iter().enumerate() {
            match quantity {
                _ if inputs.iter().any(|inputs| inputs.contains(&place)) => {}
                Some(quantity) => {
                    wanted.push((label, quantity));
                    places.push(place);
                }
                None => agreement.leave_out(&label, "this form does not have it"),
            }
        }
        First { form: form.to_owned(), wanted, places, free, source, compared: 0, reason: None, noise: None }
    }

    pub(crate) fn quantities(&self) -> Vec<Quantity> {
        self.wanted.iter().map(|(_, quantity)| quantity.clone()).collect()
    }

    /// The values to be compared, at one state.
    pub(crate) fn values(
        &mut self,
        second: &Derivation,
        here: &Here,
        rounding: &Rounding,
    ) -> Result<Vec<f64>, Irregular> {
        let (form, at, free) = (&self.form, &here.derived.place, self.free.as_deref());
        let velocity = |free: &Free| here.velocity(*free);
        let refused = |message: String| Irregular::Refused { form: form.clone(), message };
        let values = match &mut self.source {
            Values::Printed(printed) => printed.values(second, here, free.unwrap_or_default(), rounding)?,
            Values::Flow { flow, coordinates, quasi_velocities } => {
                let mut all: Vec<f64> = coordinates.iter().map(|&i| at.x[i]).collect();
                all.extend(quasi_velocities.iter().map(|free| free.as_ref().map_or(0.0, velocity)));
                all.extend(&at.z);
                let mut state = flow.state_of(at.t, &all).map_err(|error| refused(error.to_string()))?;
                // Momenta are rounded as well, which may change many digits of the velocities.
                if flow.has_momenta() {
                    state.iter_mut().for_each(|y| *y = rounding.of(*y));
                }
                let mut rates = vec![f64::NAN; state.len()];
                let evaluated = flow.motion.rhs(at.t, &state, &mut rates);
                evaluated.map_err(|failure| refused(failure.to_string()))?;
                let row = flow.row_beside(at.t, &state);
                let own = flow.rates_of_quasi_velocities(at.t, &state, &rates).unwrap_or_default();
                [state, rates, row, own].concat()
            }
            Values::Emitted { motion, free, energy_rate, tables } => {
                for (place, table) in tables {
                    motion.parameters_mut()[*place] = table.at(at.t).unwrap_or(f64::NAN);
                }
                let mut state = at.x.clone();
                state.extend(free.iter().map(velocity));
                state.extend(&at.z);
                let mut rates = vec![f64::NAN; state.len()];
                let evaluated = motion.rhs(at.t, &state, &mut rates);
                evaluated.map_err(|failure| refused(failure.to_string()))?;
                let observed = motion.observe_beside(at.t, &state);
                let rate = energy_rate.at(at.t, &state);
                [rates, observed, vec![rate]].concat()
            }
        };
        Ok(self.places.iter().map(|&place| values[place]).collect())
    }
}
