//! Rates and their Jacobian at a state, or at each of many states in an array.

use std::ops::RangeInclusive;
use std::time::{Duration, Instant};

use numpy::prelude::*;
use numpy::{PyArray1, PyArray2, PyArrayDyn, PyReadonlyArray2, PyReadonlyArrayDyn};
use pc_mech::Failure;
use pc_model::Flow;
use pc_solve::VectorField;
use pyo3::exceptions::PyValueError;
use pyo3::intern;
use pyo3::prelude::*;

use crate::error::Error;
use crate::system::SystemCore;

/// Number of states computed before the first check for signals; after that the number depends on the time
/// they take.
const FIRST_PART: usize = 1 << 8;

/// Time between two checks for signals: well below the tenth of a second within which Ctrl-C is to end work, and long
/// compared with a check.
const BETWEEN_SIGNALS: RangeInclusive<Duration> = Duration::from_millis(5)..=Duration::from_millis(20);

/// Number of states that are gathered at once if an array stores component after component, so that they stay
/// in the nearest cache.
const BLOCK: usize = 64;

/// Number of components up to which the rates of a state need no memory of their own.
const FEW: usize = 64;

/// One time, or one for each state.
#[derive(Clone, Copy)]
enum Times<'a> {
    One(f64),
    Each(&'a [f64]),
}

impl Times<'_> {
    fn at(&self, i: usize) -> f64 {
        match self {
            Times::One(t) => *t,
            Times::Each(times) => times[i],
        }
    }
}

/// How an array of n × N numbers is laid out in memory.
#[derive(Clone, Copy)]
enum Order {
    /// One state after the other.
    States,
    /// One component after the other.
    Components,
}

/// The quantity computed from a state.
pub(crate) struct Quantity<F> {
    /// The shape for one state; empty for a number.
    pub(crate) shape: Vec<usize>,
    pub(crate) evaluate: F,
}

/// The numbers of an argument as an array of floats.
pub(crate) fn floats<'py>(argument: &Bound<'py, PyAny>) -> PyResult<PyReadonlyArrayDyn<'py, f64>> {
    if let Ok(array) = argument.cast::<PyArrayDyn<f64>>() {
        return Ok(array.try_readonly()?);
    }
    let numpy = argument.py().import(intern!(argument.py(), "numpy"))?;
    let converted = numpy.call_method1(intern!(argument.py(), "asarray"), (argument, "float64"))?;
    Ok(converted.cast_into::<PyArrayDyn<f64>>()?.try_readonly()?)
}

impl SystemCore {
    /// A quantity at one state, or at each state of an array, with states as columns; `t` is a number, or one
    /// for each state.
    pub(crate) fn quantity<'py, F>(
        &self,
        t: &Bound<'py, PyAny>,
        y: &Bound<'py, PyAny>,
        quantity: Quantity<F>,
    ) -> PyResult<Bound<'py, PyAny>>
    where
        F: FnMut(&mut Flow, f64, &[f64], &mut [f64]) -> Result<(), Failure> + Send,
    {
        let y = floats(y)?;
        match y.ndim() {
            1 => self.at_one(t.extract()?, &y, quantity),
            2 => {
                let y: PyReadonlyArray2<'py, f64> = y.extract()?;
                self.at_many(t, &y, quantity)
            }
            dimensions => {
                let message = format!(
                    "the state has {dimensions} dimensions; it is a vector of n, or an array of n × N"
                );
                Err(PyValueError::new_err(message))
            }
        }
    }

    fn at_one<'py, F>(
        &self,
        t: f64,
        y: &PyReadonlyArrayDyn<'py, f64>,
        mut quantity: Quantity<F>,
    ) -> PyResult<Bound<'py, PyAny>>
    where
        F: FnMut(&mut Flow, f64, &[f64], &mut [f64]) -> Result<(), Failure>,
    {
        let state: Vec<f64> = y.as_array().iter().copied().collect();
        self.check_length(state.len())?;
        let mut values = vec![f64::NAN; quantity.shape.iter().product()];
        let outcome = (quantity.evaluate)(&mut self.state().derived.flow, t, &state, &mut values);
        outcome.map_err(Error::from)?;
        if quantity.shape.is_empty() {
            return Ok(values[0].into_pyobject(y.py())?.into_any());
        }
        Ok(PyArray1::from_vec(y.py(), values).reshape(quantity.shape)?.into_any())
    }

    /// Values that cannot be evaluated are NaN; if no state can be evaluated, the error says why.
    fn at_many<'py, F>(
        &self,
        t: &Bound<'py, PyAny>,
        y: &PyReadonlyArray2<'py, f64>,
        mut quantity: Quantity<F>,
    ) -> PyResult<Bound<'py, PyAny>>
    where
        F: FnMut(&mut Flow, f64, &[f64], &mut [f64]) -> Result<(), Failure> + Send,
    {
        let py = y.py();
        let [n, count] = [y.shape()[0], y.shape()[1]];
        self.check_length(n)?;
        let each = match t.extract::<f64>() {
            Ok(_) => None,
            Err(_) => Some(floats(t)?.as_array().iter().copied().collect::<Vec<f64>>()),
        };
        let times = match &each {
            None => Times::One(t.extract()?),
            Some(times) if times.len() == count => Times::Each(times),
            Some(times) => {
                let error = Error::Length { what: "t", given: times.len(), expected: count };
                return Err(error.into());
            }
        };
        let copy;
        let (order, states) = match y.as_slice() {
            Ok(states) if y.is_fortran_contiguous() && n > 0 => (Order::States, states),
            Ok(states) => (Order::Components, states),
            Err(_) => {
                copy = y.as_array().iter().copied().collect::<Vec<f64>>();
                (Order::Components, &copy[..])
            }
        };
        let width: usize = quantity.shape.iter().product();
        // Memory of numpy, which asks for large pages: to be given small ones takes longer than the rates of a top.
        let flat = PyArray1::<f64>::zeros(py, width * count, false);
        let mut target = flat.try_readwrite()?;
        let values = target.as_slice_mut()?;
        let mut flow = self.take();
        let mut outcome = Ok(());
        let mut failed = 0;
        let (mut from, mut length) = (0, FIRST_PART);
        while from < count {
            let (to, began) = ((from + length).min(count), Instant::now());
            let (flow, values, evaluate) = (&mut flow.1, &mut *values, &mut quantity.evaluate);
            let mut guarded = |t: f64, y: &[f64], target: &mut [f64]| match evaluate(flow, t, y, target) {
                Ok(()) => Ok(()),
                Err(failure) if failure.is_recoverable() && failed + 1 < count => {
                    failed += 1;
                    target.fill(f64::NAN);
                    Ok(())
                }
                Err(failure) => Err(failure),
            };
            let part = Part { range: from..to, n, width, count };
            outcome = py.detach(|| match order {
                Order::States => along(&part, times, states, values, &mut guarded),
                Order::Components => across(&part, times, states, values, &mut guarded),
            });
            if outcome.is_err() {
                break;
            }
            let took = began.elapsed();
            if took < *BETWEEN_SIGNALS.start() {
                length *= 2;
            } else if took > *BETWEEN_SIGNALS.end() {
                length = (length / 2).max(BLOCK);
            }
            from = to;
            py.check_signals()?;
        }
        self.put_back(flow);
        outcome.map_err(Error::from)?;
        drop(target);
        let mut shape = quantity.shape;
        let dimensions = shape.len();
        Ok(match order {
            Order::Components => {
                shape.push(count);
                flat.reshape(shape)?.into_any()
            }
            Order::States => {
                shape.insert(0, count);
                let axes: Vec<usize> = (1..=dimensions).chain([0]).collect();
                flat.reshape(shape)?.permute(Some(axes))?.into_any()
            }
        })
    }

    pub(crate) fn check_length(&self, given: usize) -> Result<(), Error> {
        let expected = self.dim();
        if given == expected { Ok(()) } else { Err(Error::Length { what: "the state", given, expected }) }
    }
}

/// Some states of an array, with the lengths of a state and of its result.
struct Part {
    range: std::ops::Range<usize>,
    n: usize,
    width: usize,
    count: usize,
}

/// Evaluates states that are stored one after the other.
fn along(
    part: &Part,
    times: Times<'_>,
    states: &[f64],
    values: &mut [f64],
    mut evaluate: impl FnMut(f64, &[f64], &mut [f64]) -> Result<(), Failure>,
) -> Result<(), Failure> {
    let Part { range, n, width, .. } = part;
    for i in range.clone() {
        evaluate(times.at(i), &states[i * n..(i + 1) * n], &mut values[i * width..(i + 1) * width])?;
    }
    Ok(())
}

/// Evaluates states that are stored component by component, gathering them in blocks.
fn across(
    part: &Part,
    times: Times<'_>,
    states: &[f64],
    values: &mut [f64],
    mut evaluate: impl FnMut(f64, &[f64], &mut [f64]) -> Result<(), Failure>,
) -> Result<(), Failure> {
    let &Part { ref range, n, width, count } = part;
    let (mut gathered, mut computed) = (vec![0.0; n * BLOCK], vec![0.0; width * BLOCK]);
    for from in range.clone().step_by(BLOCK) {
        let len = BLOCK.min(range.end - from);
        for i in 0..n {
            let row = &states[i * count + from..][..len];
            gathered[i..].iter_mut().step_by(n).zip(row).for_each(|(place, &value)| *place = value);
        }
        let pairs = gathered.chunks_exact(n.max(1)).zip(computed.chunks_exact_mut(width.max(1))).take(len);
        for (k, (y, target)) in pairs.enumerate() {
            evaluate(times.at(from + k), y, target)?;
        }
        for i in 0..width {
            let row = &mut values[i * count + from..][..len];
            row.iter_mut()
                .zip(computed[i..].iter().step_by(width))
                .for_each(|(place, &value)| *place = value);
        }
    }
    Ok(())
}

/// Reorders a square matrix from column by column to row by row.
fn transpose(matrix: &mut [f64], n: usize) {
    for i in 0..n {
        for j in 0..i {
            matrix.swap(i + j * n, j + i * n);
        }
    }
}

#[pymethods]
impl SystemCore {
    /// ẏ at one state, or at each state of an array.
    fn __call__<'py>(&self, t: &Bound<'py, PyAny>, y: &Bound<'py, PyAny>) -> PyResult<Bound<'py, PyAny>> {
        // As an integrator calls it: nothing is converted, and one array made.
        if let Ok(array) = y.cast::<PyArray1<f64>>()
            && let Ok(t) = t.extract::<f64>()
        {
            let y = array.try_readonly()?;
            if let Ok(y) = y.as_slice() {
                self.check_length(y.len())?;
                let mut few = [0.0; FEW];
                let mut many = Vec::new();
                let rates = match few.get_mut(..y.len()) {
                    Some(rates) => rates,
                    None => {
                        many.resize(y.len(), 0.0);
                        &mut many[..]
                    }
                };
                let outcome = self.state().derived.flow.motion.rhs(t, y, rates);
                outcome.map_err(Error::from)?;
                return Ok(PyArray1::from_slice(array.py(), rates).into_any());
            }
        }
        let evaluate = |flow: &mut Flow, t: f64, y: &[f64], rates: &mut [f64]| flow.motion.rhs(t, y, rates);
        self.quantity(t, y, Quantity { shape: vec![self.dim()], evaluate })
    }

    /// ∂f/∂y at one state, or at each state of an array: entry (i, j) is ∂f_i/∂y_j.
    fn jac<'py>(&self, t: &Bound<'py, PyAny>, y: &Bound<'py, PyAny>) -> PyResult<Bound<'py, PyAny>> {
        let n = self.dim();
        let evaluate = |flow: &mut Flow, t: f64, y: &[f64], jacobian: &mut [f64]| {
            flow.motion.jacobian(t, y, jacobian)?;
            transpose(jacobian, n);
            Ok(())
        };
        self.quantity(t, y, Quantity { shape: vec![n, n], evaluate })
    }

    /// For each entry of ∂f/∂y, whether it can be nonzero.
    fn jac_sparsity<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray2<bool>>> {
        let n = self.dim();
        let mut entries = vec![true; n * n];
        if let Some(pattern) = self.state().derived.flow.motion.sparsity() {
            entries.fill(false);
            for j in 0..n {
                for &i in pattern.column(j) {
                    entries[i * n + j] = true;
                }
            }
        }
        PyArray1::from_vec(py, entries).reshape([n, n])
    }
}
