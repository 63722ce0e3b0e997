//! The equations in independent quasi-velocities, in the coordinates and quasi-velocities of a form.

use pc_mech::{Equations, Expr, Graph, Matrix, MechError, Motion, QuasiVelocityChange, System, determinant};

use crate::assembly::assembly::Assembly;
use crate::assembly::constraint_treatment::ConstraintFormulation;
use crate::diagnostics::error::ModelError;
use crate::diagnostics::meaning::MeaningError;
use crate::variables::Variables;

/// A definition of a quasi-velocity counts as dependent on the preceding definitions if no more than this
/// fraction of it is independent of them.
const DEPENDENT: f64 = 1e-6;

/// A system whose equations (9) are the equations of motion, with the relation between its quasi-velocities and those
/// of the model.
#[derive(Clone, Debug)]
pub struct FreeForm<'g> {
    /// The system.
    pub system: System<'g>,
    /// The k independent quasi-velocities of the model from which the form was made.
    pub independent: Vec<Expr<'g>>,
    /// Each of the independent quasi-velocities as a function of time, coordinates and the quasi-velocities
    /// of the system.
    pub values: Vec<Expr<'g>>,
    /// The quasi-velocities of the system as functions of time, coordinates and the independent ones.
    pub definitions: Vec<Expr<'g>>,
    /// The k × k matrix A in η' = A η; `None` if the quasi-velocities are those of the model.
    pub(crate) matrix: Option<Matrix<Expr<'g>>>,
}

impl<'g> FreeForm<'g> {
    /// The form of a system in its own quasi-velocities.
    pub(crate) fn own(system: System<'g>) -> FreeForm<'g> {
        let eta = system.quasi_velocities().to_vec();
        FreeForm { independent: eta.clone(), values: eta.clone(), definitions: eta, matrix: None, system }
    }

    /// The form in all quasi-velocities of a system whose constraints have multipliers.
    pub(crate) fn all(assembly: &Assembly<'g>) -> FreeForm<'g> {
        FreeForm::own(assembly.system.clone())
    }

    pub(super) fn changed(independent: &[Expr<'g>], change: &QuasiVelocityChange<'g>) -> FreeForm<'g> {
        FreeForm {
            independent: independent.to_vec(),
            values: change.old_quasi_velocities().to_vec(),
            definitions: change.definitions().to_vec(),
            matrix: Some(change.matrix().clone()),
            system: change.system().clone(),
        }
    }

    /// The quasi-velocities that are not those of the model, each with its definition.
    pub fn defined(&self) -> Vec<(Expr<'g>, Expr<'g>)> {
        let all = self.system.quasi_velocities().iter().copied().zip(self.definitions.iter().copied());
        all.filter(|(eta, definition)| eta != definition).collect()
    }
}

impl<'g> Assembly<'g> {
    /// The system in independent quasi-velocities, with the coordinates and quasi-velocities of these variables;
    /// for momenta, the quasi-velocities are those to which the momenta belong.
    ///
    /// # Errors
    /// [`ModelError`] if there is no such form.
    pub fn free_form(&self, variables: Variables) -> Result<FreeForm<'g>, ModelError> {
        let free = self.observed(self.free_system()?)?;
        match variables {
            Variables::QuasiVelocities | Variables::Momenta => Ok(FreeForm::own(free)),
            Variables::Reduced | Variables::ReducedMomenta => {
                self.placed(free.reduced()).map(|reduced| FreeForm { system: reduced, ..FreeForm::own(free) })
            }
            Variables::Orthonormal => self.orthonormal(&free),
            Variables::Given => self.in_given(&free),
            Variables::IndependentVelocities => self.in_velocities(&free),
        }
    }

    /// The equations of motion in independent quasi-velocities, in these variables, which must not be momenta, and the
    /// form that defines the quasi-velocities.
    ///
    /// # Errors
    /// [`ModelError`] if there is no such form.
    pub fn equations_of(&self, variables: Variables) -> Result<(Equations<'g>, FreeForm<'g>), ModelError> {
        if variables == Variables::QuasiVelocities {
            let equations = self.equations()?;
            let form = FreeForm::own(equations.system().clone());
            return Ok((equations, form));
        }
        let form = self.free_form(variables)?;
        Ok((self.placed(form.system.poincare())?, form))
    }

    /// The system with the observed reactions substituted.
    fn observed(&self, free: System<'g>) -> Result<System<'g>, ModelError> {
        match self.constraints.formulation() {
            ConstraintFormulation::Multipliers(_) => Ok(free.observing(self.equations()?.system())),
            ConstraintFormulation::Free | ConstraintFormulation::Vanishing(_) => Ok(free),
        }
    }

    /// The form in quasi-velocities η1, η2, … that are orthonormal in the kinetic metric.
    fn orthonormal(&self, free: &System<'g>) -> Result<FreeForm<'g>, ModelError> {
        let taken: Vec<String> = free.symbols().iter().map(Expr::to_string).collect();
        let name = |s: usize| {
            let mut name = format!("η{s}");
            while taken.contains(&name) {
                name.push('_');
            }
            name
        };
        let names = (1..=free.quasi_velocities().len()).map(name);
        let change = free.orthonormal_change(names).map_err(|error| match error.is_not_quadratic() {
            true => {
                let message = "there is no frame that is orthonormal in the kinetic metric: L is not quadratic in the velocities";
                self.no_form(message.to_owned(), "use another form: poincare, canonical, or hamel")
            }
            false => self.document.derivation_error(error),
        })?;
        let form = FreeForm::changed(free.quasi_velocities(), &change);
        let entries: Vec<Expr<'g>> = change.matrix().nonzero_entries();
        if self.numbers_at_start(free, &entries)?.iter().all(|entry| entry.is_finite()) {
            return Ok(form);
        }
        let message = "there are no quasi-velocities that are orthonormal in the kinetic metric: it is not positive at the start";
        Err(self.no_form(message.to_owned(), "use another form: poincare, canonical, or hamel"))
    }

    /// The form in the quasi-velocities given in addition to the text, completed by quasi-velocities of the
    /// model.
    fn in_given(&self, free: &System<'g>) -> Result<FreeForm<'g>, ModelError> {
        let (graph, eta) = (free.graph(), free.quasi_velocities());
        let help = "give them after the model, as in `pc derive MODEL --form hamel \"v = r*φ'\"`, each independent of those before";
        if self.given.is_empty() {
            return Err(self.no_form("no quasi-velocities are given".to_owned(), help));
        }
        let all = self.quasi_velocities_of(eta)?;
        let follow: Vec<_> = self.system.quasi_velocities().iter().copied().zip(all).collect();
        let definitions: Vec<Expr<'g>> = self.given.iter().map(|&(_, definition)| definition).collect();
        let definitions = graph.substitute(&definitions, &follow);
        let rows = |functions: &[Expr<'g>]| -> Result<Vec<Vec<f64>>, ModelError> {
            let slopes: Vec<Expr<'g>> = functions.iter().flat_map(|&f| graph.gradient(f, eta)).collect();
            let slopes = self.numbers_at_start(free, &slopes)?;
            Ok(slopes.chunks(eta.len().max(1)).map(<[f64]>::to_vec).collect())
        };
        let given = rows(&definitions)?;
        let mut known: Vec<Vec<f64>> = Vec::new();
        let mut known_alike: Vec<Vec<f64>> = Vec::new();
        let mut chosen: Vec<(Expr<'g>, Expr<'g>)> = Vec::new();
        let alike = in_alike_units(&given);
        for (s, (&(name, _), &definition)) in self.given.iter().zip(&definitions).enumerate() {
            let (rest_alike, left) = rest(&known_alike, &alike[s]);
            if left.is_nan() || left <= DEPENDENT {
                let message = match chosen.len() == eta.len() {
                    true => format!("`{name}` is one quasi-velocity too many: {} are independent", eta.len()),
                    false => format!("at the start `{name}` depends on those before it"),
                };
                return Err(self.no_form(message, help));
            }
            known_alike.push(rest_alike);
            known.push(rest(&known, &given[s]).0);
            chosen.push((name, definition));
        }
        // Each time the one least determined by those present; the first among equals.
        let units = rows(eta)?;
        while chosen.len() < eta.len() {
            let left = |s: usize| rest(&known, &units[s]).1;
            let least =
                (0..eta.len()).fold(0, |least, s| if left(s) > left(least) + DEPENDENT { s } else { least });
            known.push(rest(&known, &units[least]).0);
            chosen.push((eta[least], eta[least]));
        }
        let (names, definitions): (Vec<String>, Vec<Expr<'g>>) =
            chosen.into_iter().map(|(name, definition)| (name.to_string(), definition)).unzip();
        let change = self.placed(free.quasi_velocity_change(names, &definitions))?;
        Ok(FreeForm::changed(eta, &change))
    }

    pub(crate) fn no_form(&self, message: String, help: &'static str) -> ModelError {
        self.document.error(&self.document.energy_place(), MeaningError::NoForm { message, help })
    }

    /// The initial values of functions of time, coordinates, the quasi-velocities of a free system and
    /// parameters.
    fn numbers_at_start(&self, free: &System<'g>, functions: &[Expr<'g>]) -> Result<Vec<f64>, ModelError> {
        let at = [free.parameters(), &self.at_start()].concat();
        self.placed(free.graph().evaluate(functions, &at).map_err(MechError::from))
    }

    /// The start of a form, in its coordinates, quasi-velocities and first-order states.
    ///
    /// # Errors
    /// [`ModelError`] if a definition has no value at the start.
    pub fn start_in(&self, form: &FreeForm<'g>) -> Result<Vec<f64>, ModelError> {
        let eta = self.numbers_at_start(&form.system, &form.definitions)?;
        let states: Vec<Expr<'g>> = form.system.states().iter().map(|&(z, _)| z).collect();
        Ok([self.start_of(form.system.frame().coordinates()), eta, self.start_of(&states)].concat())
    }

    /// Whether the constraints have multipliers because they do more than make quasi-velocities vanish.
    pub fn has_multipliers(&self) -> bool {
        matches!(self.constraints.formulation(), ConstraintFormulation::Multipliers(_))
    }

    /// The determinants, as functions of time, coordinates and parameters, that vanish where the state of a
    /// form does not determine the velocities; `within_chart` monitors them. `None` stands for the
    /// determinant of a matrix of more than four rows, which is not a short expression.
    pub fn chart_determinants(&self, form: &FreeForm<'g>) -> Vec<Option<Expr<'g>>> {
        let (graph, frame, all) = (self.system.graph(), self.system.frame(), self.system.quasi_velocities());
        if form.system.frame().coordinates() != frame.coordinates() {
            return Vec::new();
        }
        let mut squares: Vec<Matrix<Expr<'g>>> = Vec::new();
        squares.extend(frame.definition_matrix().cloned());
        squares.extend(form.matrix.clone());
        if let ConstraintFormulation::Multipliers(held) = self.constraints.formulation()
            && !held.multipliers.is_nonlinear()
        {
            squares.push(dependent_columns(held.multipliers.coefficients(), all, &form.independent));
        }
        let is_fixed = |x: &Expr<'g>| {
            !frame.coordinates().iter().chain([&frame.time()]).any(|&symbol| x.depends_on(symbol))
        };
        let moving = squares.iter().filter(|square| !square.nonzero_entries().iter().all(is_fixed));
        let determinants = moving.map(|square| short_determinant(graph, square));
        determinants.filter(|value| !value.as_ref().is_some_and(is_fixed)).collect()
    }

    /// The motion of a form, made to stop at states that do not determine the velocities.
    ///
    /// # Errors
    /// [`ModelError`]; it does not occur for a form of this system.
    pub(crate) fn within_chart(&self, motion: Motion, form: &FreeForm<'g>) -> Result<Motion, ModelError> {
        let all = self.system.quasi_velocities();
        if form.system.frame().coordinates() != self.system.frame().coordinates() {
            return Ok(motion); // what is left out does not matter
        }
        let motion = match &form.matrix {
            None => motion.within_chart(&self.system),
            Some(matrix) => {
                let place = |eta: &Expr<'g>| form.independent.iter().position(|known| known == eta);
                let whole =
                    Matrix::from_fn(all.len(), all.len(), |i, j| match (place(&all[i]), place(&all[j])) {
                        (Some(u), Some(s)) => matrix[(u, s)],
                        _ if i == j => Expr::ONE,
                        _ => Expr::ZERO,
                    });
                motion.within_chart_of_change(&self.system, &whole)
            }
        };
        let motion = self.placed(motion)?;
        let ConstraintFormulation::Multipliers(held) = self.constraints.formulation() else {
            return Ok(motion);
        };
        if held.multipliers.is_nonlinear() || self.constraints.held().is_some() {
            return Ok(motion);
        }
        let square = dependent_columns(held.multipliers.coefficients(), all, &form.independent);
        self.placed(motion.within_choice(&self.system, &square))
    }
}

/// The columns of the constraint matrix that belong to dependent quasi-velocities.
fn dependent_columns<'g>(
    c: &Matrix<Expr<'g>>,
    all: &[Expr<'g>],
    independent: &[Expr<'g>],
) -> Matrix<Expr<'g>> {
    let dependent: Vec<usize> = (0..all.len()).filter(|&s| !independent.contains(&all[s])).collect();
    Matrix::from_fn(c.rows(), dependent.len(), |a, d| c[(a, dependent[d])])
}

/// A determinant up to its sign, after elimination of rows and columns with a single entry; `None` if more
/// than four rows remain.
fn short_determinant<'g>(graph: &'g Graph, square: &Matrix<Expr<'g>>) -> Option<Expr<'g>> {
    let (mut rows, mut columns): (Vec<usize>, Vec<usize>) =
        ((0..square.rows()).collect(), (0..square.columns()).collect());
    let mut factors = Vec::new();
    loop {
        let filled = |&(r, c): &(usize, usize)| !square[(r, c)].is_zero();
        let of_row = |r: usize| columns.iter().map(move |&c| (r, c)).filter(filled).collect::<Vec<_>>();
        let of_column = |c: usize| rows.iter().map(move |&r| (r, c)).filter(filled).collect::<Vec<_>>();
        let lines = rows.iter().map(|&r| of_row(r)).chain(columns.iter().map(|&c| of_column(c)));
        let alone = lines.map(|line| (line.len(), line)).find(|&(entries, _)| entries == 1);
        let Some((r, c)) = alone.map(|(_, line)| line[0]) else { break };
        factors.push(square[(r, c)]);
        rows.retain(|&row| row != r);
        columns.retain(|&column| column != c);
    }
    let rest = Matrix::from_fn(rows.len(), columns.len(), |r, c| square[(rows[r], columns[c])]);
    let rest = if rows.is_empty() { Expr::ONE } else { determinant(graph, &rest)? };
    Some(factors.into_iter().fold(rest, |product, factor| product * factor))
}

/// Rows of derivatives in units of the quasi-velocities for which the largest entry of each column is 1, so that r' + r φ'
/// does not count as dependent on r', however small r is.
fn in_alike_units(rows: &[Vec<f64>]) -> Vec<Vec<f64>> {
    let largest = |s: usize| rows.iter().fold(0.0f64, |most, row| most.max(row[s].abs()));
    let unit = |s: usize| Some(largest(s)).filter(|&most| most > 0.0).unwrap_or(1.0);
    let in_units = |row: &Vec<f64>| row.iter().enumerate().map(|(s, entry)| entry / unit(s)).collect();
    rows.iter().map(in_units).collect()
}

/// The part of a row that is orthogonal to the known rows, which all have length one, and the length of this
/// part relative to that of the row.
fn rest(known: &[Vec<f64>], row: &[f64]) -> (Vec<f64>, f64) {
    let size = |row: &[f64]| row.iter().fold(0.0f64, |size, entry| size.hypot(*entry));
    let mut rest = row.to_vec();
    // Two passes are enough.
    for known in known.iter().chain(known) {
        let along: f64 = known.iter().zip(&rest).map(|(a, b)| a * b).sum();
        rest.iter_mut().zip(known).for_each(|(rest, known)| *rest -= along * known);
    }
    let left = size(&rest);
    (rest.iter().map(|entry| entry / left).collect(), left / size(row))
}
