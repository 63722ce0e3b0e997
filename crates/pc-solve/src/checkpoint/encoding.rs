//! Checkpoints as bytes.
//!
//! ```text
//! pc checkpoint 1\n
//! length of the label, label
//! t, dim, y; number of outputs, times, states; the work
//! CRC-32 of all that is before
//! ```
//! All numbers are little-endian, integers and floats of 64 bits.

use super::Checkpoint;
use crate::statistics::Statistics;
use crate::trajectory::Trajectory;

const MAGIC: &[u8] = b"pc checkpoint ";
const VERSION: &[u8] = b"1\n";

/// Why bytes are not a checkpoint.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum CheckpointError {
    /// Something else.
    #[error("it is not a checkpoint")]
    Foreign,
    /// A checkpoint of another version of the format.
    #[error("it is a checkpoint of another version of the format")]
    Version,
    /// A checkpoint of which a part is missing or changed.
    #[error("the checkpoint is damaged: a part of it is missing or changed")]
    Damaged,
}

impl Checkpoint {
    /// The checkpoint as bytes. The `label` says what it is a checkpoint of.
    pub fn to_bytes(&self, label: &str) -> Vec<u8> {
        let mut bytes = [MAGIC, VERSION].concat();
        let integer = |bytes: &mut Vec<u8>, value: u64| bytes.extend(value.to_le_bytes());
        let numbers = |bytes: &mut Vec<u8>, values: &[f64]| {
            bytes.extend(values.iter().flat_map(|value| value.to_le_bytes()));
        };
        integer(&mut bytes, label.len() as u64);
        bytes.extend(label.as_bytes());
        numbers(&mut bytes, &[self.time]);
        integer(&mut bytes, self.state.len() as u64);
        numbers(&mut bytes, &self.state);
        integer(&mut bytes, self.outputs.len() as u64);
        numbers(&mut bytes, self.outputs.times());
        numbers(&mut bytes, self.outputs.states());
        let work = &self.statistics;
        for count in [
            work.steps,
            work.rhs_evaluations,
            work.jacobian_evaluations,
            work.error_test_failures,
            work.nonlinear_iterations,
            work.nonlinear_failures,
            work.step_failures,
            work.linear_setups,
            work.linear_iterations,
            work.linear_failures,
            work.jacobian_products,
            work.preconditioner_evaluations,
            work.preconditioner_solves,
            u64::from(work.last_order),
            u64::from(work.current_order),
            self.steps_since_output,
        ] {
            integer(&mut bytes, count);
        }
        numbers(&mut bytes, &[work.first_step, work.last_step, work.current_step, work.current_time]);
        bytes.extend(crc32fast::hash(&bytes).to_le_bytes());
        bytes
    }

    /// Whether these bytes begin as a checkpoint does, of whatever version.
    pub fn is_one(bytes: &[u8]) -> bool {
        bytes.starts_with(MAGIC)
    }

    /// The checkpoint that these bytes are, and its label.
    ///
    /// # Errors
    /// [`CheckpointError`] unless they are all that [`to_bytes`](Checkpoint::to_bytes) wrote, unchanged.
    pub fn from_bytes(bytes: &[u8]) -> Result<(Checkpoint, String), CheckpointError> {
        let rest = bytes.strip_prefix(MAGIC).ok_or(CheckpointError::Foreign)?;
        let (content, crc) = bytes.split_last_chunk::<4>().ok_or(CheckpointError::Damaged)?;
        if crc32fast::hash(content).to_le_bytes() != *crc {
            return Err(CheckpointError::Damaged);
        }
        let rest = rest.strip_prefix(VERSION).ok_or(CheckpointError::Version)?;
        let mut rest = rest.get(..rest.len().saturating_sub(4)).ok_or(CheckpointError::Damaged)?;
        let read = decode(&mut rest).filter(|_| rest.is_empty());
        read.ok_or(CheckpointError::Damaged)
    }
}

fn decode(bytes: &mut &[u8]) -> Option<(Checkpoint, String)> {
    let length = usize::try_from(integer(bytes)?).ok()?;
    let label = String::from_utf8(bytes.split_off(..length)?.to_vec()).ok()?;
    let time = numbers(bytes, 1)?[0];
    let dim = usize::try_from(integer(bytes)?).ok()?;
    let mut checkpoint = Checkpoint::start(time, &numbers(bytes, dim)?);
    let outputs = usize::try_from(integer(bytes)?).ok()?;
    let times = numbers(bytes, outputs)?;
    let states = numbers(bytes, outputs.checked_mul(dim)?)?;
    let mut trajectory = Trajectory::new(dim);
    if dim > 0 {
        times.iter().zip(states.chunks_exact(dim)).for_each(|(&t, y)| trajectory.push(t, y));
    }
    checkpoint.outputs = trajectory;
    checkpoint.statistics = Statistics {
        steps: integer(bytes)?,
        rhs_evaluations: integer(bytes)?,
        jacobian_evaluations: integer(bytes)?,
        error_test_failures: integer(bytes)?,
        nonlinear_iterations: integer(bytes)?,
        nonlinear_failures: integer(bytes)?,
        step_failures: integer(bytes)?,
        linear_setups: integer(bytes)?,
        linear_iterations: integer(bytes)?,
        linear_failures: integer(bytes)?,
        jacobian_products: integer(bytes)?,
        preconditioner_evaluations: integer(bytes)?,
        preconditioner_solves: integer(bytes)?,
        last_order: u32::try_from(integer(bytes)?).ok()?,
        current_order: u32::try_from(integer(bytes)?).ok()?,
        ..Statistics::default()
    };
    checkpoint.steps_since_output = integer(bytes)?;
    checkpoint.statistics = Statistics {
        first_step: numbers(bytes, 1)?[0],
        last_step: numbers(bytes, 1)?[0],
        current_step: numbers(bytes, 1)?[0],
        current_time: numbers(bytes, 1)?[0],
        ..checkpoint.statistics
    };
    Some((checkpoint, label))
}

fn integer(bytes: &mut &[u8]) -> Option<u64> {
    Some(u64::from_le_bytes(bytes.split_off(..8)?.try_into().ok()?))
}

fn numbers(bytes: &mut &[u8], count: usize) -> Option<Vec<f64>> {
    let numbers = bytes.split_off(..count.checked_mul(8)?)?.chunks_exact(8);
    numbers.map(|number| Some(f64::from_le_bytes(number.try_into().ok()?))).collect()
}
