//! Where the rates of a motion jump.

use pc_algebra::discontinuities;
use pc_expr::{Expr, ExprError, RateJump};

use crate::compiled::first_order::FirstOrder;

impl<'g> FirstOrder<'g> {
    /// The [jumps](discontinuities) of r − M w or r − p, and of the rates g, that a motion crosses as its
    /// state or time changes. A state variable whose rate is zero changes only at events, which are handled
    /// separately, and so does not cross a jump.
    ///
    /// # Errors
    /// [`ExprError::UnboundSymbol`] for a symbol that is neither state nor declared parameter.
    pub(crate) fn jumps(&self) -> Result<Vec<RateJump>, ExprError> {
        let rows = [self.balance(), self.rates.clone()].concat();
        let names: Vec<String> =
            self.names.iter().cloned().chain(self.state.iter().map(Expr::to_string)).collect();
        let moving = self.moving();
        let passing = self.passing();
        let mut numbers = self.parameters.clone();
        numbers.retain(|&(symbol, value)| value != 0.0 && !self.varying.contains(&symbol));
        let rate_jump = |found: pc_algebra::Discontinuity<'g>| {
            let in_it = |symbol: &Expr<'g>| found.surface.depends_on(*symbol);
            let parameters = self.parameters.iter().enumerate();
            let parameters =
                parameters.filter(|(_, (symbol, _))| in_it(symbol) && !self.varying.contains(symbol));
            RateJump {
                surface: found.surface.to_string(),
                component: names[found.function].clone(),
                of_state: moving.iter().any(in_it),
                parameters: parameters.map(|(j, (symbol, _))| (j, symbol.to_string())).collect(),
            }
        };
        let found = discontinuities(self.graph, &rows, &passing, &numbers)?;
        Ok(found.into_iter().map(rate_jump).collect())
    }

    /// The variables that change along a motion because their rates are not zero.
    fn moving(&self) -> Vec<Expr<'g>> {
        let flowing = self.state.iter().zip(&self.rates).filter(|(_, rate)| !rate.is_zero());
        // In momenta, velocities are unknowns: functions of the state that change along the motion.
        flowing.map(|(&symbol, _)| symbol).chain(self.unknowns.iter().copied()).collect()
    }

    /// The variables that change along a motion.
    pub(crate) fn passing(&self) -> Vec<Expr<'g>> {
        [&[self.time], &self.varying[..], &self.moving()[..]].concat()
    }
}
