//! The Coriolis matrix, and the Jacobians of bodies and of their momenta, each derived on the first request.

use std::sync::PoisonError;

use pc_mech::VelocityMap;
use pc_model::{CentreOfMass, Model, Variables};
use pyo3::prelude::*;

use crate::error::Error;
use crate::kinematics::{Kinematics, Made};
use crate::mechanics::{evaluate, read};
use crate::system::SystemCore;

impl SystemCore {
    /// Derives something unless it is known, and evaluates it at a state with quasi-velocities.
    fn with_kinematics<T: Send + 'static, R>(
        &self,
        py: Python<'_>,
        (t, y): (f64, &[f64]),
        known: impl Fn(&mut Kinematics) -> Option<&mut T>,
        derive: impl FnOnce(&Model, Variables) -> Result<Made<T>, Error> + Send + 'static,
        keep: impl FnOnce(&mut Kinematics, T),
        evaluate: impl FnOnce(&mut T, &[f64], &[f64]) -> Result<R, Error>,
    ) -> PyResult<R> {
        self.check_length(y.len())?;
        let lock = || self.kinematics.lock().unwrap_or_else(PoisonError::into_inner);
        let missing = known(&mut lock()).is_none();
        if missing {
            let variables = self.variables;
            let Made(derived, transform) = self.derive(py, move |model| derive(model, variables))?;
            let mut all = lock();
            if known(&mut all).is_none() {
                keep(&mut all, derived);
                all.transform = transform;
            }
        }
        let parameters = self.state().derived.flow.motion.parameters().to_vec();
        let mut all = lock();
        let state = read(all.transform.as_mut(), t, y, &parameters)?;
        let Some(known) = known(&mut all) else {
            return Err(Error::Busy.into()); // it has just been derived, and nobody takes it away
        };
        Ok(evaluate(known, &state, &parameters)?)
    }
}

/// The number of rows, then A column by column, a_0 and the rates for η̇ = 0.
type Columns = (usize, Vec<f64>);

fn columns(map: &mut VelocityMap, t: f64, state: &[f64], parameters: &[f64]) -> Result<Columns, Error> {
    map.parameters_mut().copy_from_slice(parameters);
    let (rows, k) = (map.functions(), map.quasi_velocities());
    let mut values = vec![f64::NAN; rows * (k + 2)];
    let (matrix, others) = values.split_at_mut(rows * k);
    let (rest, rates) = others.split_at_mut(rows);
    map.map(t, state, matrix, rest)?;
    map.rates(t, state, rates)?;
    Ok((rows, values))
}

#[pymethods]
impl SystemCore {
    /// C at a state: its size, and its entries column by column.
    #[pyo3(name = "_coriolis_entries")]
    fn coriolis_entries(&self, py: Python<'_>, t: f64, y: Vec<f64>) -> PyResult<(usize, Vec<f64>)> {
        self.with_kinematics(
            py,
            (t, &y),
            |all| all.coriolis.as_mut(),
            |model, variables| {
                Made::new(model, variables, |assembly| {
                    let equations = assembly.equations_in(variables)?;
                    Ok(assembly.placed(equations.coriolis_of_motion())?)
                })
            },
            |all, derived| all.coriolis = Some(derived),
            |coriolis, state, parameters| {
                coriolis.parameters_mut().copy_from_slice(parameters);
                let mut entries = vec![f64::NAN; coriolis.len() * coriolis.len()];
                coriolis.eval(t, state, &mut entries)?;
                Ok((coriolis.len(), entries))
            },
        )
    }

    /// The centroidal momentum matrix, with its two further columns.
    #[pyo3(name = "_centroidal")]
    fn centroidal(&self, py: Python<'_>, t: f64, y: Vec<f64>) -> PyResult<Columns> {
        self.with_kinematics(
            py,
            (t, &y),
            |all| all.centroidal.as_mut(),
            |model, variables| {
                Made::new(model, variables, |assembly| Ok(model.centroidal_map(assembly, variables)?))
            },
            |all, derived| all.centroidal = Some(derived),
            |map, state, parameters| columns(map, t, state, parameters),
        )
    }

    /// The mass centre, then the columns of its Jacobian.
    #[pyo3(name = "_centre_of_mass")]
    fn centre_of_mass(&self, py: Python<'_>, t: f64, y: Vec<f64>) -> PyResult<(Vec<f64>, Columns)> {
        self.with_kinematics(
            py,
            (t, &y),
            |all| all.centre.as_mut(),
            |model, variables| {
                Made::new(model, variables, |assembly| Ok(model.centre_of_mass(assembly, variables)?))
            },
            |all, derived| all.centre = Some(derived),
            |CentreOfMass { position, velocity }, state, parameters| {
                let mut centre = vec![f64::NAN; 3];
                evaluate(position, (t, state, parameters), &mut centre)?;
                Ok((centre, columns(velocity, t, state, parameters)?))
            },
        )
    }

    /// The Jacobian of a point of a body, with its two further columns.
    #[pyo3(name = "_body_jacobian")]
    fn body_jacobian(
        &self,
        py: Python<'_>,
        t: f64,
        y: Vec<f64>,
        body: String,
        point: [f64; 3],
    ) -> PyResult<Columns> {
        let name = body.clone();
        let kept = body.clone();
        self.with_kinematics(
            py,
            (t, &y),
            |all| all.bodies.iter_mut().find(|(known, _)| *known == body).map(|(_, map)| map),
            move |model, variables| {
                Made::new(model, variables, |assembly| Ok(model.body_map(assembly, variables, &name)?))
            },
            |all, derived| all.bodies.push((kept, derived)),
            |map, state, parameters| {
                map.arguments_mut().copy_from_slice(&point);
                columns(map, t, state, parameters)
            },
        )
    }
}
