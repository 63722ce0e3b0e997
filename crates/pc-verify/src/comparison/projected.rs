//! The equations of large models, compared along a few virtual velocities that are drawn at random.
//!
//! Evaluating all equations at a state requires all n² second derivatives of L with respect to the
//! velocities. Along one virtual velocity v that the constraints allow, they reduce to one equation without
//! multipliers,
//!
//!   v_s (D_t p_s − p·δw_s − X_s L − Q_s) = 0,
//!
//! which takes about five evaluations of L along the motion of the first derivation. An error in any equation
//! shows up in this one, except for special v; the rates of the constraints along the motion, to which v is
//! insensitive, are checked in addition.

use nalgebra::DMatrix;
use pc_mech::VectorField;
use pc_model::Flow;

use crate::comparison::quantities::REPETITIONS;
use crate::comparison::second::Second;
use crate::comparison::tolerance::ORDINARY;
use crate::derivation::derivation::Derivation;
use crate::derivation::place::{Direction, Place, Virtual};
use crate::error::{Irregular, Unable};
use crate::numbers::linear::{fitting_inverse, matrix, solving_inverse};
use crate::numbers::rounding::{Random, Rounding, UNIT};
use crate::numbers::sized::Sized;
use crate::text::friction::Friction;
use crate::text::text::Velocities;

/// The number of virtual velocities.
pub(crate) const DIRECTIONS: usize = 3;

/// The motion of the first derivation from a state.
struct Moving {
    place: Place,
    velocities: Vec<f64>,
    accelerations: Vec<f64>,
    state_rates: Vec<f64>,
    energy: Option<f64>,
    /// The normal forces of contacts with friction.
    normal_forces: Vec<f64>,
}

/// A value that should vanish, with the largest of its terms.
type Residual = Sized;

/// The positions of quantities in the state and the observables of the first derivation.
pub(crate) struct Layout {
    /// The indices, among the rates, of the columns for quasi-velocities.
    columns: Vec<Option<usize>>,
    energy: Option<usize>,
    /// The indices, among the observables, of the normal forces of contacts with friction.
    normal_forces: Vec<Option<usize>>,
}

impl Layout {
    /// The layout of a flow in quasi-velocities.
    pub(crate) fn of(flow: &Flow, second: &Second) -> Layout {
        let place = |list: &[String], name: &String| list.iter().position(|known| known == name);
        let observables = flow.motion.observable_names();
        Layout {
            columns: second.columns.iter().map(|column| place(flow.motion.names(), column)).collect(),
            normal_forces: (second.derivation.text.frictions.iter())
                .map(|friction| &second.derivation.text.names.constraints[friction.constraint])
                .map(|constraint| place(observables, &format!("N_{constraint}")))
                .collect(),
            energy: observables.iter().position(|name| name == "energy" && !second.has_free_energy),
        }
    }
}

impl Derivation {
    /// The values that should vanish at a state of the first derivation, with their names: the equations
    /// along random virtual velocities, the rates of constraints, ẋ and ż, and the energy.
    pub(crate) fn projected(
        &self,
        flow: &mut Flow,
        layout: &Layout,
        at: &Place,
        columns: &dyn Fn(&Place) -> Result<Vec<f64>, Irregular>,
    ) -> Result<Vec<(String, Residual)>, Irregular> {
        let exact = Rounding::none();
        let here = self.moving(flow, layout, at, columns)?;
        let allowed = self.allowed(at)?;
        let pressed = self.pressed(at)?;
        let names = self.residual_names(&here);
        let mut all = self.residuals(&here, &allowed, &pressed, &exact)?;
        if all.iter().all(|residual| residual.value.abs() <= ORDINARY * residual.size) {
            return Ok(names.into_iter().zip(all).collect());
        }
        // The change by rounding in either derivation.
        let sizes: Vec<f64> = at.w.iter().map(|w| w.abs()).collect();
        for seed in 1..=REPETITIONS {
            let rounding = Rounding::made(seed);
            let near = self.near(at, &sizes, &rounding);
            let moved = self.moving(flow, layout, &near, columns)?;
            for (residual, moved) in
                all.iter_mut().zip(self.residuals(&moved, &allowed, &pressed, &rounding)?)
            {
                residual.size = residual.size.max((moved.value - residual.value).abs() / UNIT);
            }
        }
        match all.iter().all(|residual| residual.value.is_finite() && residual.size.is_finite()) {
            true => Ok(names.into_iter().zip(all).collect()),
            false => Err(Irregular::NotFinite { what: "an equation" }),
        }
    }

    /// The motion of the first derivation at a state; ẇ is solved for if η̇ and the constraints determine it.
    fn moving(
        &self,
        flow: &mut Flow,
        layout: &Layout,
        at: &Place,
        columns: &dyn Fn(&Place) -> Result<Vec<f64>, Irregular>,
    ) -> Result<Moving, Irregular> {
        let refused = |message: String| Irregular::Refused { form: "poincare".to_owned(), message };
        let (n, k) = (at.x.len(), at.w.len());
        let mut all = at.x.clone();
        all.extend(columns(at)?);
        all.extend(&at.z);
        let state = flow.state_of(at.t, &all).map_err(|error| refused(error.to_string()))?;
        let mut rates = vec![f64::NAN; state.len()];
        flow.motion.rhs(at.t, &state, &mut rates).map_err(|failure| refused(failure.to_string()))?;
        let is_observed = layout.energy.is_some() || !layout.normal_forces.is_empty();
        let observed = if is_observed { flow.motion.observe_beside(at.t, &state) } else { Vec::new() };
        let energy = layout.energy.map(|place| observed[place]);
        let normal_force = |place: &Option<usize>| place.map_or(f64::NAN, |place| observed[place]);
        let normal_forces = layout.normal_forces.iter().map(normal_force).collect();
        let velocities = rates[..n].to_vec();
        let state_rates = rates[rates.len() - at.z.len()..].to_vec();
        let known: Vec<(usize, f64)> =
            layout.columns.iter().enumerate().filter_map(|(s, place)| Some((s, rates[(*place)?]))).collect();
        let accelerations = if known.len() == k && !self.has_definitions() {
            known.iter().map(|&(_, rate)| rate).collect()
        } else {
            self.accelerations(at, &velocities, &state_rates, &known)?
        };
        Ok(Moving { place: at.clone(), velocities, accelerations, state_rates, energy, normal_forces })
    }

    /// ẇ, computed from η̇ and from the condition that the constraints stay satisfied.
    fn accelerations(
        &self,
        at: &Place,
        velocities: &[f64],
        state_rates: &[f64],
        known: &[(usize, f64)],
    ) -> Result<Vec<f64>, Irregular> {
        let exact = Rounding::none();
        let in_time = Direction { z: state_rates.to_vec(), ..at.in_time(velocities) };
        let matrix_of_columns = self.quasi_velocity_matrix(at, &exact)?;
        let drift = self.columns(&self.once(at, &in_time, &exact))?;
        let mut rows: Vec<Vec<f64>> = known.iter().map(|&(s, _)| matrix_of_columns[s].clone()).collect();
        let mut right: Vec<f64> = known.iter().map(|&(s, rate)| rate - drift[s].eps).collect();
        rows.extend(self.constraint_matrix(&self.kept, at, &exact)?);
        right.extend(self.constraint_rates(&self.kept, at, &in_time, &exact)?.iter().map(|rate| -rate));
        let (inverse, rank) = solving_inverse(&matrix(&rows, at.w.len())).ok_or(Irregular::Singular)?;
        if rank < at.w.len() {
            return Err(Irregular::IllConditioned);
        }
        Ok((inverse * DMatrix::from_column_slice(right.len(), 1, &right)).iter().copied().collect())
    }

    /// Whether η is defined as a function of w, rather than being w itself.
    pub(crate) fn has_definitions(&self) -> bool {
        matches!(&self.text.velocities, Velocities::Ordinary(definitions) if !definitions.is_empty())
    }

    /// Random virtual velocities that the constraints allow at a state.
    fn allowed(&self, at: &Place) -> Result<Vec<Vec<f64>>, Irregular> {
        let k = at.w.len();
        let rows = self.constraint_matrix(&self.kept, at, &Rounding::none())?;
        let constraints = matrix(&rows, k);
        let (inverse, _) =
            solving_inverse(&constraints).ok_or(Irregular::NotFinite { what: "a constraint" })?;
        let mut random = Random::new(k as u64);
        let allowed = |_| {
            let mut v = DMatrix::from_fn(k, 1, |_, _| random.signed());
            // Twice, as the first pass leaves rounding of the removed part.
            for _ in 0..2 {
                v -= &inverse * (&constraints * &v);
            }
            v.iter().copied().collect()
        };
        Ok((0..DIRECTIONS).map(allowed).collect())
    }

    /// For each contact with friction a virtual velocity along which its constraint alone does work, of 1 for a normal force of 1.
    fn pressed(&self, at: &Place) -> Result<Vec<Vec<f64>>, Irregular> {
        if self.text.frictions.is_empty() {
            return Ok(Vec::new());
        }
        let rows = self.constraint_matrix(&self.kept, at, &Rounding::none())?;
        let inverse = solving_inverse(&matrix(&rows, at.w.len()));
        let (inverse, _) = inverse.ok_or(Irregular::NotFinite { what: "a constraint" })?;
        let place = |a: usize| self.kept.iter().position(|&kept| kept == a).ok_or(Unable::NoReaction);
        let column =
            |friction: &Friction| Ok(inverse.column(place(friction.constraint)?).iter().copied().collect());
        self.text.frictions.iter().map(column).collect()
    }

    fn residual_names(&self, here: &Moving) -> Vec<String> {
        let names = &self.text.names;
        let mut all: Vec<String> =
            (1..=DIRECTIONS).map(|i| format!("the equation along random virtual velocity {i}")).collect();
        let pressing = self.text.frictions.iter().map(|friction| &names.constraints[friction.constraint]);
        all.extend(pressing.map(|name| format!("N_{name}")));
        all.extend(self.kept.iter().map(|&a| format!("the rate of constraint {}", names.constraints[a])));
        all.extend(names.coordinates.iter().chain(&names.states).map(|x| format!("the rate of {x}")));
        all.extend(here.energy.filter(|_| !self.has_definitions()).map(|_| "energy".to_owned()));
        all
    }

    fn residuals(
        &self,
        here: &Moving,
        allowed: &[Vec<f64>],
        pressed: &[Vec<f64>],
        rounding: &Rounding,
    ) -> Result<Vec<Residual>, Irregular> {
        let at = &here.place;
        let in_time = Direction {
            w: here.accelerations.clone(),
            z: here.state_rates.clone(),
            ..at.in_time(&here.velocities)
        };
        let mut all = Vec::new();
        for v in allowed {
            all.push(self.along(here, &in_time, v, rounding)?);
        }
        for (v, normal_force) in pressed.iter().zip(&here.normal_forces) {
            let found = self.along(here, &in_time, v, rounding)?;
            all.push(Sized { value: found.value - normal_force, size: found.size.max(normal_force.abs()) });
        }
        let rates = self.constraint_rates(&self.kept, at, &in_time, rounding)?;
        let largest = |list: &[f64]| list.iter().fold(0.0f64, |size, x| size.max(x.abs()));
        // A value that vanishes has the size of its terms, or that of its scatter.
        let rows = match rates.iter().all(|&rate| rate == 0.0) {
            true => vec![Vec::new(); rates.len()],
            false => self.constraint_matrix(&self.kept, at, rounding)?,
        };
        let point = self.still(at, rounding);
        // At rest, the accelerations are what remains of those of free fall.
        let fall = largest(&point.all(&self.text.gravity)?);
        let size = |row: &[f64]| {
            let terms: Vec<f64> = row.iter().zip(&in_time.w).map(|(a, w)| a * w).collect();
            largest(&terms).max(fall * largest(row))
        };
        all.extend(rates.iter().zip(&rows).map(|(&value, row)| Sized { value, size: size(row) }));
        let size = largest(&here.velocities);
        let both = here.velocities.iter().zip(point.velocities()?);
        all.extend(both.map(|(one, two)| Sized { value: one - two, size }));
        let two = point.all(&self.text.state_rates)?;
        let both = here.state_rates.iter().zip(&two);
        all.extend(both.map(|(one, two)| Sized { value: one - two, size: two.abs() }));
        if let Some(energy) = here.energy.filter(|_| !self.has_definitions()) {
            let w = Direction { w: at.w.clone(), ..at.along(vec![0.0; at.x.len()]) };
            let lagrangian = self.once(at, &w, rounding).lagrangian()?;
            let size = lagrangian.eps.abs().max(lagrangian.re.abs());
            all.push(Sized { value: energy - (lagrangian.eps - lagrangian.re), size });
        }
        Ok(all)
    }

    /// The residual of the equation along a virtual velocity.
    fn along(
        &self,
        here: &Moving,
        in_time: &Direction,
        v: &[f64],
        rounding: &Rounding,
    ) -> Result<Residual, Irregular> {
        let at = &here.place;
        let still = at.along(vec![0.0; at.x.len()]);
        let varied = Direction { w: v.to_vec(), ..still.clone() };
        let displacement: Vec<f64> =
            self.once(at, &varied, rounding).velocities()?.iter().map(|u| u.eps).collect();
        let inertia = self.twice(at, &varied, in_time, rounding).lagrangian()?.eps.eps;
        let work = self.once(at, &at.along(displacement.clone()), rounding).lagrangian()?.eps;
        let variation = self.variation(here, in_time, v, &displacement, rounding)?;
        let transposed = match variation {
            Some(w) => self.once(at, &Direction { w, ..still }, rounding).lagrangian()?.eps,
            None => 0.0,
        };
        let virtual_velocity = [Virtual { w: varied, x: displacement }];
        let forces = self.forces(at, &virtual_velocity, rounding)?;
        let drags = self.drags(at, &virtual_velocity, rounding)?;
        let drags = drags.iter().zip(&here.normal_forces).map(|(drag, n)| drag.per_normal_force[0] * n);
        let force = forces.first().map_or(0.0, |balance| balance.sum) + drags.sum::<f64>();
        let terms = [inertia, -transposed, -work, -force];
        let largest = forces.first().map_or(0.0, |balance| balance.largest);
        Ok(Sized {
            value: terms.iter().sum(),
            size: terms.iter().fold(largest, |size, term| size.max(term.abs())),
        })
    }

    /// δw from b δw = D_t (b v) − (∂u/∂x) b v, or from the brackets; `None` if w = ẋ, for which it vanishes.
    fn variation(
        &self,
        here: &Moving,
        in_time: &Direction,
        v: &[f64],
        displacement: &[f64],
        rounding: &Rounding,
    ) -> Result<Option<Vec<f64>>, Irregular> {
        let (at, k) = (&here.place, v.len());
        if let Velocities::Ordinary(_) = self.text.velocities {
            return Ok(None);
        }
        if let Some(c) = self.structure.constants(self, at)? {
            let rate = |r: usize| if r == 0 { 1.0 } else { at.w[r - 1] };
            let of = |m: usize| {
                let terms = (0..=k).flat_map(|r| (0..k).map(move |s| (r, s)));
                terms.map(|(r, s)| c.get(r, s + 1, m) * rate(r) * v[s]).sum()
            };
            return Ok(Some((0..k).map(of).collect()));
        }
        let varied = Direction { w: v.to_vec(), ..at.along(vec![0.0; at.x.len()]) };
        let moved = self.twice(at, &varied, in_time, rounding);
        let transported: Vec<f64> = moved.velocities()?.iter().map(|u| u.eps.eps).collect();
        let displaced = self.once(at, &at.along(displacement.to_vec()), rounding);
        let displaced: Vec<f64> = displaced.velocities()?.iter().map(|u| u.eps).collect();
        let frame = self.frame(at, rounding)?;
        let b = DMatrix::from_fn(at.x.len(), k, |i, s| frame[s][i]);
        let (inverse, rank) = fitting_inverse(&b).ok_or(Irregular::NotFinite { what: "the frame" })?;
        if rank < k {
            return Err(Irregular::Frame);
        }
        let difference = DMatrix::from_fn(at.x.len(), 1, |i, _| transported[i] - displaced[i]);
        Ok(Some((inverse * difference).iter().copied().collect()))
    }
}
