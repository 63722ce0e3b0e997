//! Rates that occur in expressions: x' and d(f).

use pc_expr::Expr;
use pc_expr::parse::{Ast, Span};

use crate::diagnostics::error::ModelError;
use crate::diagnostics::meaning::MeaningError;
use crate::document::{Contact, Expression};
use crate::names::scope::Scope;
use crate::names::stage::Stage;

impl<'g> Scope<'g, '_> {
    /// The velocity of a coordinate or of a point, or the rate of an input.
    pub(super) fn velocity_of(
        &mut self,
        expression: &Expression,
        span: Span,
        name: &str,
        stage: Stage,
    ) -> Result<Expr<'g>, ModelError> {
        if let Some(rate) = self.rate_of_input(name) {
            let refused = matches!(
                stage,
                Stage::Parameter | Stage::Body | Stage::Height | Stage::Start | Stage::Joint | Stage::Action
            );
            return match refused {
                false => Ok(rate),
                true => Err(self.error(expression, span, |text| MeaningError::NotHere {
                    name: text,
                    place: stage.place(),
                    allowed: stage.allowed(),
                })),
            };
        }
        let coordinates = &self.document.coordinates;
        let of_contact = self.contact_of(name).filter(|&(_, component)| component <= Contact::GAP);
        let is_point = self.is_point(name);
        if of_contact.is_none() && !is_point && !coordinates.iter().any(|c| c.name.text == name) {
            let fault = |_| MeaningError::NotACoordinate {
                name: name.to_owned(),
                coordinates: coordinates.iter().map(|c| c.name.text.clone()).collect(),
            };
            return Err(self.error(expression, span, fault));
        }
        match stage {
            Stage::Parameter
            | Stage::Body
            | Stage::Height
            | Stage::Start
            | Stage::Joint
            | Stage::Kinematics
            | Stage::Position
            | Stage::Inertia
            | Stage::Action
            | Stage::Gravity => Err(self.error(expression, span, |text| MeaningError::NotHere {
                name: text,
                place: stage.place(),
                allowed: stage.allowed(),
            })),
            _ if of_contact.is_some() => {
                let value = self.name(expression, span, name, stage)?;
                Ok(self.graph.directional(&[value], &self.rates())[0])
            }
            _ if is_point => {
                let place = self.point(name)?;
                let rates: Vec<_> = self.coordinates().into_iter().zip(self.velocities()).collect();
                Ok(self.graph.directional(&[place], &rates)[0])
            }
            _ => Ok(self.velocity(name)),
        }
    }

    /// The rate d(f) = ∂f/∂t + x_i' ∂f/∂x_i + ż ∂f/∂z, which also has terms with accelerations if f contains
    /// velocities.
    pub(super) fn total_derivative(
        &mut self,
        expression: &Expression,
        span: Span,
        inner: &Ast,
        stage: Stage,
    ) -> Result<Expr<'g>, ModelError> {
        let refused = match stage {
            Stage::Parameter
            | Stage::Body
            | Stage::Height
            | Stage::Start
            | Stage::Joint
            | Stage::Kinematics
            | Stage::Position
            | Stage::Inertia
            | Stage::Action
            | Stage::Gravity => true,
            Stage::Definition
            | Stage::Constraint
            | Stage::Rate
            | Stage::Dynamics
            | Stage::Event
            | Stage::Function
            | Stage::Drawing
            | Stage::Observation => false,
        };
        if refused {
            let fault =
                |text| MeaningError::NotHere { name: text, place: stage.place(), allowed: stage.allowed() };
            return Err(self.error(expression, span, fault));
        }
        let value = self.ast(expression, inner, stage)?;
        self.rate_of(expression, span, value, stage)
    }

    /// The rate of a value that the part `span` of an expression denotes.
    pub(super) fn rate_of(
        &mut self,
        expression: &Expression,
        span: Span,
        value: Expr<'g>,
        stage: Stage,
    ) -> Result<Expr<'g>, ModelError> {
        for input in &self.document.inputs {
            let name = &input.name.text;
            if value.depends_on(self.graph.symbol(name)) && self.rate_of_input(name).is_none() {
                let fault = |_| MeaningError::UnknownRate { what: "input", name: name.clone() };
                return Err(self.error(expression, span, fault));
            }
        }
        let (x, velocities, eta) = (self.coordinates(), self.velocities(), self.quasi_velocities());
        let moves = |z: &Expr<'g>| value.depends_on(*z);
        if stage != Stage::Observation && velocities.iter().chain(&eta).any(moves) {
            return Err(self.error(expression, span, |_| MeaningError::Acceleration { place: stage.place() }));
        }
        let rate = |symbol: &Expr<'g>| (*symbol, self.graph.symbol(&format!("{symbol}'")));
        let mut rates: Vec<_> = x.iter().copied().zip(velocities.iter().copied()).collect();
        rates.extend(velocities.iter().map(rate));
        rates.extend(eta.iter().filter(|eta| !velocities.contains(eta)).map(rate));
        let accelerations = rates[x.len()..].iter().map(|&(_, rate)| rate);
        if let Some((what, unknown)) = self.without_rate(value, accelerations) {
            let name = unknown.to_string();
            return Err(self.error(expression, span, |_| MeaningError::UnknownRate { what, name }));
        }
        rates.extend(self.graph.in_time(self.time));
        for (z, state) in self.states().into_iter().zip(&self.document.states) {
            if !value.depends_on(z) {
                continue;
            }
            if stage == Stage::Rate {
                // The rates of two states may each contain the rate of the other.
                let fault = |text| MeaningError::NotHere {
                    name: text,
                    place: stage.place(),
                    allowed: "rates written out",
                };
                return Err(self.error(expression, span, fault));
            }
            rates.push((z, self.resolve(&state.rate, Stage::Rate)?));
        }
        Ok(self.graph.directional(&[value], &rates)[0])
    }

    /// The rate u' of an input u, if its table is a curve.
    pub(super) fn rate_of_input(&mut self, name: &str) -> Option<Expr<'g>> {
        let input = self.document.inputs.iter().find(|input| input.name.text == name)?;
        let input = self.graph.symbol(&input.name.text);
        let rate = self.graph.rate_of(input)?;
        self.rates_in_use.push(input);
        Some(rate)
    }

    /// The first acceleration or reaction found in a function, if any: these are known along a motion, but not as
    /// functions of the state, so that they cannot be differentiated.
    fn without_rate(
        &self,
        value: Expr<'g>,
        accelerations: impl Iterator<Item = Expr<'g>>,
    ) -> Option<(&'static str, Expr<'g>)> {
        let own = [self.velocities(), self.quasi_velocities()].concat();
        let mut accelerations = accelerations.filter(|rate| !own.contains(rate));
        if let Some(acceleration) = accelerations.find(|&rate| value.depends_on(rate)) {
            return Some(("acceleration", acceleration));
        }
        let is_reaction = |symbol: &Expr<'g>| {
            let name = symbol.to_string();
            self.is_reaction(&name) || self.is_resultant(&name)
        };
        self.graph.symbols_of(&[value]).into_iter().find(is_reaction).map(|reaction| ("reaction", reaction))
    }
}
