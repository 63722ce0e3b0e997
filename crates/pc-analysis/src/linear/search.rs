//! The equilibrium or steady motion near a state.

use pc_expr::{Deadline, ExprError};
use pc_mech::Matrix;

use crate::error::AnalysisError;
use crate::linear::linearizer::Linearizer;
use crate::linear::statics::{Balance, Unknowns, without_rounding};
use crate::numeric::dense::norm;
use crate::numeric::newton::{self, Iterate, Way};
use crate::stability::steady_motion::{NEAR, SteadyMotion, SteadyOptions};

/// The end of a search for values of unknowns that satisfy the conditions of steady motion.
pub(super) struct Balanced {
    pub(super) end: Iterate,
    pub(super) point: Balance,
}

/// The largest number of steps in which the reactions at a steady state are found.
pub(super) const FEW: usize = 5;

impl Linearizer {
    /// Ends searches for equilibria and steady motions at a deadline: no such state is found after it.
    pub fn until(&mut self, deadline: &Deadline) {
        self.until = Some(deadline.clone());
    }

    /// The equilibrium or steady motion near a state, on the leaf of that state.
    ///
    /// # Errors
    /// [`AnalysisError::DependsOnTime`]; [`AnalysisError::LeafUnknown`] if Newton's method would need
    /// functions of the coordinates that motions keep constant but that are unknown, and the state itself is
    /// not steady; otherwise as [`SteadyMotion::near`].
    pub(super) fn find(
        &mut self,
        t: f64,
        guess: &[f64],
        options: &SteadyOptions,
    ) -> Result<SteadyMotion, AnalysisError> {
        if self.depends_on_time() {
            return Err(AnalysisError::DependsOnTime);
        }
        // Unless all functions of the leaf are known, coordinates are not moved.
        let options = match self.is_leaf_known {
            true => options.clone(),
            false => options.clone().fixed(self.names()[..self.sizes.coordinates].to_vec()),
        };
        let cyclic = self.cyclic.clone();
        let residual = match self.find_on(t, guess, guess, &options, &cyclic) {
            Err(AnalysisError::NoSteadyMotion { residual, .. }) if !self.is_leaf_known => residual,
            Err(failure @ AnalysisError::NoSteadyMotion { .. }) => {
                // From a fast start the same place at rest may be closer.
                let mut at_rest = guess.to_vec();
                at_rest[self.quasi_velocities()].fill(0.0);
                let is_free = !self.names()[self.quasi_velocities()].iter().any(|name| options.holds(name));
                let again =
                    is_free.then(|| self.find_on(t, guess, &at_rest, &options, &cyclic).ok()).flatten();
                return again.ok_or(failure);
            }
            found => return found,
        };
        Err(AnalysisError::LeafUnknown { residual })
    }

    /// The equilibrium or steady motion near a guess, on the leaf of a state, at which only the coordinates `moving` may
    /// move.
    ///
    /// # Errors
    /// As [`SteadyMotion::near`].
    pub(super) fn find_on(
        &mut self,
        t: f64,
        leaf: &[f64],
        guess: &[f64],
        options: &SteadyOptions,
        moving: &[usize],
    ) -> Result<SteadyMotion, AnalysisError> {
        let levels = self.levels(t, leaf)?;
        let fixed = options.fixed_among(self.names())?;
        let mut free = self.all_unknowns(t, guess, moving)?;
        free.components.retain(|j| !fixed.contains(j));
        let unknowns = |varying: &[usize]| Unknowns { varying: varying.to_vec(), ..free.clone() };
        let dependent = self.dependent.clone();
        // Of steady motions that start from the guess itself the nearest is wanted.
        let nearest = !moving.is_empty() || leaf == guess;
        match self.steady_by(t, guess, &levels, options, (&unknowns(&[]), nearest)) {
            Err(failure @ AnalysisError::NoSteadyMotion { .. })
                if !dependent.is_empty() && !moving.is_empty() =>
            {
                let unknowns = unknowns(&dependent);
                self.steady_by(t, guess, &levels, options, (&unknowns, nearest)).map_err(|_| failure)
            }
            found => found,
        }
    }

    /// All components of the state as unknowns, except the cyclic coordinates that no relation ties to others.
    ///
    /// # Errors
    /// [`AnalysisError`] if the relations are not defined at the state.
    pub(super) fn all_unknowns(
        &mut self,
        t: f64,
        state: &[f64],
        moving: &[usize],
    ) -> Result<Unknowns, AnalysisError> {
        let tied = self.tied(t, state)?;
        let is_free = |j: &usize| !self.cyclic.contains(j) || tied.contains(j);
        let components = (0..state.len()).filter(is_free).collect();
        Ok(Unknowns { components, inputs: Vec::new(), moving: moving.to_vec(), varying: Vec::new() })
    }

    fn steady_by(
        &mut self,
        t: f64,
        guess: &[f64],
        levels: &[f64],
        options: &SteadyOptions,
        (unknowns, nearest): (&Unknowns, bool),
    ) -> Result<SteadyMotion, AnalysisError> {
        let Balanced { end, point } =
            self.balanced(t, guess, levels, (options.most_iterations(), nearest), unknowns)?;
        let varying: Vec<usize> = unknowns.varying.iter().map(|s| self.sizes.coordinates + s).collect();
        let mut motion = self.motion.clone();
        if !end.is_solution(options.residual()) || end.error > NEAR {
            let residual = self.residual(t, &point.state, &unknowns.moving, &varying);
            let state = self.names().iter().cloned().zip(point.state).collect();
            return Err(AnalysisError::NoSteadyMotion { residual, iterations: end.iterations, t, state });
        }
        let uncertainty = end.relative_residual().max(end.error);
        SteadyMotion::at(
            &mut motion,
            (t, point.state),
            &self.units,
            (&unknowns.moving, &varying),
            uncertainty,
        )
    }

    /// Solves the conditions of steady motion for the unknowns, by Newton's method from a guess, in at most `most` steps; of a
    /// family of solutions, a near member is found, or the `nearest`.
    ///
    /// # Errors
    /// [`AnalysisError`] if the conditions are not defined at the guess.
    pub(super) fn balanced(
        &mut self,
        t: f64,
        guess: &[f64],
        levels: &[f64],
        (most, nearest): (usize, bool),
        unknowns: &Unknowns,
    ) -> Result<Balanced, AnalysisError> {
        let start = self.values_of(unknowns, guess);
        let measured = start.len() - self.statics.reactions() - unknowns.varying.len();
        let mut point = self.at_guess(guess);
        let mut solved = |way: Way| {
            newton::solve_by(way, start.clone(), (most, measured), |z| {
                self.conditions(t, &mut point, levels, unknowns, z)
            })
        };
        let mut end = solved(Way::Newton)?;
        if nearest {
            // Newton's steps may pass over a near family to where it meets another, or lead nowhere.
            let distance =
                |end: &Iterate| norm(&(0..measured).map(|i| end.point[i] - start[i]).collect::<Vec<_>>());
            let is_solution = |end: &Iterate| end.is_solution(newton::SMALL) && end.error <= NEAR;
            let others: &[Way] =
                if is_solution(&end) { &[Way::Damped] } else { &[Way::Shortened, Way::Damped] };
            for &way in others {
                let is_better = |other: &Iterate| {
                    is_solution(other) && (!is_solution(&end) || distance(other) < distance(&end))
                };
                end = solved(way).ok().filter(is_better).unwrap_or(end);
            }
        }
        if nearest && end.is_solution(newton::SMALL) {
            end = newton::nearest(end, &start, measured, |z| {
                self.conditions(t, &mut point, levels, unknowns, z)
            })?;
        }
        self.give(&mut point, unknowns, &end.point);
        Ok(Balanced { end, point })
    }

    /// The member of the family of a steady state that is nearest to another state.
    ///
    /// # Errors
    /// As for [`balanced`](Linearizer::balanced).
    pub(super) fn balanced_near(
        &mut self,
        t: f64,
        (member, other): (&[f64], &[f64]),
        levels: &[f64],
        unknowns: &Unknowns,
    ) -> Result<Balanced, AnalysisError> {
        let Balanced { end, mut point } = self.balanced(t, member, levels, (FEW, false), unknowns)?;
        let aim = self.values_of(unknowns, other);
        let end = newton::nearest(end, &aim, unknowns.components.len(), |z| {
            self.conditions(t, &mut point, levels, unknowns, z)
        })?;
        self.give(&mut point, unknowns, &end.point);
        Ok(Balanced { end, point })
    }

    /// The values of the unknowns at a state: those of the components, in their units, and of the inputs, zero for reactions and
    /// accelerations.
    fn values_of(&self, unknowns: &Unknowns, state: &[f64]) -> Vec<f64> {
        let parameters = self.motion.parameters();
        let others = self.statics.reactions() + unknowns.varying.len();
        (unknowns.components.iter().map(|&i| state[i] / self.units[i]))
            .chain(unknowns.inputs.iter().map(|&j| parameters[self.inputs[j].1]))
            .chain(vec![0.0; others])
            .collect()
    }

    fn at_guess(&self, guess: &[f64]) -> Balance {
        Balance {
            state: guess.to_vec(),
            accelerations: vec![0.0; self.sizes.velocities],
            reactions: vec![0.0; self.statics.reactions()],
        }
    }

    /// The conditions of steady motion and the distances from the leaf, with their slopes by the unknowns.
    fn conditions(
        &mut self,
        t: f64,
        point: &mut Balance,
        levels: &[f64],
        unknowns: &Unknowns,
        z: &[f64],
    ) -> Result<(Vec<f64>, Matrix<f64>), AnalysisError> {
        if let Some(what) = self.until.as_ref().and_then(Deadline::passed) {
            return Err(ExprError::Spent { what, stage: "the search for steady motions", nodes: 0 }.into());
        }
        self.give(point, unknowns, z);
        let (mut values, slopes) = self.statics.at(t, point, self.motion.parameters(), unknowns)?;
        let (distances, normals) = self.surface_at(t, &point.state, Some(levels))?;
        let (rows, held) = (values.len(), self.sizes.positions + self.sizes.kept);
        values.extend((0..held).map(|a| {
            let slopes: Vec<f64> = (0..point.state.len()).map(|j| normals[(a, j)]).collect();
            let is_given = unknowns.components.iter().all(|&j| slopes[j] == 0.0);
            if is_given { without_rounding(distances[a], &slopes, &point.state) } else { distances[a] }
        }));
        let slope = |i: usize, j: usize| match (i.checked_sub(rows), unknowns.components.get(j)) {
            (None, None) => slopes[(i, j)],
            (None, Some(&component)) => slopes[(i, j)] * self.units[component],
            (Some(a), Some(&component)) => normals[(a, component)] * self.units[component],
            (Some(_), None) => 0.0, // relations contain neither inputs nor reactions
        };
        Ok((values, Matrix::from_fn(rows + held, z.len(), slope)))
    }

    /// Writes the values of the unknowns into the point and the parameters.
    fn give(&mut self, point: &mut Balance, unknowns: &Unknowns, values: &[f64]) {
        let (components, rest) = values.split_at(unknowns.components.len());
        let (inputs, rest) = rest.split_at(unknowns.inputs.len());
        let (reactions, accelerations) = rest.split_at(point.reactions.len());
        unknowns
            .components
            .iter()
            .zip(components)
            .for_each(|(&i, &value)| point.state[i] = value * self.units[i]);
        for (&j, &value) in unknowns.inputs.iter().zip(inputs) {
            self.motion.parameters_mut()[self.inputs[j].1] = value;
        }
        point.reactions.copy_from_slice(reactions);
        unknowns.varying.iter().zip(accelerations).for_each(|(&s, &value)| point.accelerations[s] = value);
    }

    /// The norm of the rates at a state, except those of the components that may change; NaN where there are none.
    pub(super) fn residual(&mut self, t: f64, state: &[f64], moving: &[usize], varying: &[usize]) -> f64 {
        let Ok(rates) = self.motion.rates(t, state) else { return f64::NAN };
        let is_constant = |i: &usize| !moving.contains(i) && !varying.contains(i);
        norm(&(0..rates.len()).filter(is_constant).map(|i| rates[i]).collect::<Vec<_>>())
    }

    /// The components that relations tie to others at a state.
    fn tied(&mut self, t: f64, state: &[f64]) -> Result<Vec<usize>, AnalysisError> {
        let (_, normals) = self.surface_at(t, state, None)?;
        let held = self.sizes.positions + self.sizes.kept;
        Ok((0..state.len()).filter(|&j| (0..held).any(|a| normals[(a, j)] != 0.0)).collect())
    }
}
