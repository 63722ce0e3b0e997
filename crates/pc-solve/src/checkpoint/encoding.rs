//! Checkpoints as bytes.
//!
//! ```text
//! pc checkpoint 6\n
//! length of the label, label
//! t, dim, y; number of outputs, times, states
//! number of occurrences, of each: event, t, y⁻, y⁺
//! the work
//! 1 if the motion was restarted, as after a jump, else 0
//! number of entries of S, these; number of those at the outputs, these
//! 0, or 1 and the status of events: number of events, of each: side, noise, count, longest
//!     interval, number of latest times, these; number of events due, of each: event, noise, side
//! CRC-32 of all the above
//! ```
//! All numbers are little-endian 64-bit integers or floats.

use crate::checkpoint::checkpoint::{Checkpoint, EventPast, Past};
use crate::events::events::{History, Occurrence};
use crate::integration::statistics::Statistics;
use crate::integration::trajectory::Trajectory;

const MAGIC: &[u8] = b"pc checkpoint ";
const VERSION: u64 = 6;

/// Why the bytes cannot be read as a checkpoint.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum CheckpointError {
    /// The bytes are not a checkpoint.
    #[error("it is not a checkpoint")]
    Foreign,
    /// The checkpoint is in another version of the format.
    #[error("it is a checkpoint of version {found} of the format, not {VERSION}")]
    Version {
        /// Its version.
        found: u64,
    },
    /// The checkpoint has a missing or altered part.
    #[error("the checkpoint is damaged: a part of it is missing or changed")]
    Damaged,
}

impl Checkpoint {
    /// The checkpoint as bytes. The `label` says what the checkpoint belongs to.
    pub fn to_bytes(&self, label: &str) -> Vec<u8> {
        let mut bytes = [MAGIC, format!("{VERSION}\n").as_bytes()].concat();
        put_integer(&mut bytes, label.len() as u64);
        bytes.extend(label.as_bytes());
        put_numbers(&mut bytes, &[self.time]);
        put_integer(&mut bytes, self.state.len() as u64);
        put_numbers(&mut bytes, &self.state);
        put_integer(&mut bytes, self.outputs.len() as u64);
        put_numbers(&mut bytes, self.outputs.times());
        put_numbers(&mut bytes, self.outputs.states());
        put_integer(&mut bytes, self.occurrences.len() as u64);
        for occurrence in &self.occurrences {
            put_integer(&mut bytes, occurrence.event as u64);
            put_numbers(&mut bytes, &[occurrence.time]);
            put_numbers(&mut bytes, &occurrence.state_before);
            put_numbers(&mut bytes, &occurrence.state_after);
        }
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
            work.limited_steps,
            work.implicit_steps,
            work.changes,
            u64::from(work.stiff_from.is_some()),
            u64::from(work.last_order),
            u64::from(work.current_order),
            self.steps_since_output,
        ] {
            put_integer(&mut bytes, count);
        }
        put_numbers(&mut bytes, &[work.first_step, work.last_step, work.current_step, work.current_time]);
        put_numbers(&mut bytes, &[work.stiff_from.unwrap_or(0.0)]);
        put_integer(&mut bytes, u64::from(self.jumped));
        put_integer(&mut bytes, self.sensitivities.len() as u64);
        put_numbers(&mut bytes, &self.sensitivities);
        put_integer(&mut bytes, self.output_sensitivities.len() as u64);
        put_numbers(&mut bytes, &self.output_sensitivities);
        put_integer(&mut bytes, u64::from(self.past.is_some()));
        if let Some(past) = &self.past {
            past.put(&mut bytes);
        }
        bytes.extend(crc32fast::hash(&bytes).to_le_bytes());
        bytes
    }

    /// Whether these bytes begin like a checkpoint, of any version.
    pub fn is_one(bytes: &[u8]) -> bool {
        bytes.starts_with(MAGIC)
    }

    /// The checkpoint in these bytes, and its label.
    ///
    /// # Errors
    /// [`CheckpointError`] unless the bytes are exactly what [`to_bytes`](Checkpoint::to_bytes)
    /// wrote.
    pub fn from_bytes(bytes: &[u8]) -> Result<(Checkpoint, String), CheckpointError> {
        let rest = bytes.strip_prefix(MAGIC).ok_or(CheckpointError::Foreign)?;
        // Other versions may have another format from here on.
        let line = rest.iter().position(|&byte| byte == b'\n').ok_or(CheckpointError::Damaged)?;
        let found = std::str::from_utf8(&rest[..line]).ok().and_then(|version| version.parse().ok());
        match found.ok_or(CheckpointError::Damaged)? {
            VERSION => {}
            found => return Err(CheckpointError::Version { found }),
        }
        let (content, crc) = bytes.split_last_chunk::<4>().ok_or(CheckpointError::Damaged)?;
        if crc32fast::hash(content).to_le_bytes() != *crc {
            return Err(CheckpointError::Damaged);
        }
        let mut rest = content.get(MAGIC.len() + line + 1..).ok_or(CheckpointError::Damaged)?;
        let read = decode(&mut rest).filter(|_| rest.is_empty());
        read.ok_or(CheckpointError::Damaged)
    }
}

impl Past {
    fn put(&self, bytes: &mut Vec<u8>) {
        put_integer(bytes, self.events.len() as u64);
        for EventPast { side, noise, history } in &self.events {
            put_numbers(bytes, &[*side, *noise]);
            put_integer(bytes, history.occurrences);
            put_numbers(bytes, &[history.longest]);
            put_integer(bytes, history.times.len() as u64);
            history.times.iter().for_each(|&t| put_numbers(bytes, &[t]));
        }
        put_integer(bytes, self.due.len() as u64);
        for &(event, noise, side) in &self.due {
            put_integer(bytes, event as u64);
            put_numbers(bytes, &[noise, side]);
        }
    }

    fn take(bytes: &mut &[u8]) -> Option<Past> {
        let events = list(bytes, |bytes| {
            let (side, noise, occurrences) = (number(bytes)?, number(bytes)?, integer(bytes)?);
            let longest = number(bytes)?;
            let history = History { times: list(bytes, number)?.into(), occurrences, longest };
            Some(EventPast { side, noise, history })
        })?;
        let due = list(bytes, |bytes| Some((index(bytes)?, number(bytes)?, number(bytes)?)))?;
        due.iter().all(|&(event, ..)| event < events.len()).then_some(Past { events, due })
    }
}

fn decode(bytes: &mut &[u8]) -> Option<(Checkpoint, String)> {
    let length = index(bytes)?;
    let label = String::from_utf8(bytes.split_off(..length)?.to_vec()).ok()?;
    let time = number(bytes)?;
    let dim = index(bytes)?;
    let mut checkpoint = Checkpoint::start(time, &numbers(bytes, dim)?);
    let outputs = index(bytes)?;
    let times = numbers(bytes, outputs)?;
    let states = numbers(bytes, outputs.checked_mul(dim)?)?;
    let mut trajectory = Trajectory::new(dim);
    if dim > 0 {
        times.iter().zip(states.chunks_exact(dim)).for_each(|(&t, y)| trajectory.push(t, y));
    }
    checkpoint.outputs = trajectory;
    checkpoint.occurrences = list(bytes, |bytes| {
        let (event, time) = (index(bytes)?, number(bytes)?);
        let (state_before, state_after) = (numbers(bytes, dim)?, numbers(bytes, dim)?);
        Some(Occurrence { event, time, state_before, state_after })
    })?;
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
        limited_steps: integer(bytes)?,
        implicit_steps: integer(bytes)?,
        changes: integer(bytes)?,
        stiff_from: flag(bytes)?.then_some(0.0),
        last_order: u32::try_from(integer(bytes)?).ok()?,
        current_order: u32::try_from(integer(bytes)?).ok()?,
        ..Statistics::default()
    };
    checkpoint.steps_since_output = integer(bytes)?;
    checkpoint.statistics = Statistics {
        first_step: number(bytes)?,
        last_step: number(bytes)?,
        current_step: number(bytes)?,
        current_time: number(bytes)?,
        ..checkpoint.statistics
    };
    let stiff_from = number(bytes)?;
    checkpoint.statistics.stiff_from = checkpoint.statistics.stiff_from.map(|_| stiff_from);
    checkpoint.jumped = flag(bytes)?;
    let entries = index(bytes)?;
    checkpoint.sensitivities = numbers(bytes, entries)?;
    let at_outputs = index(bytes)?;
    checkpoint.output_sensitivities = numbers(bytes, at_outputs)?;
    checkpoint.past = if flag(bytes)? { Some(Past::take(bytes)?) } else { None };
    let events = checkpoint.past.as_ref().map_or(0, |past| past.events.len());
    let known = checkpoint.occurrences.iter().all(|occurrence| occurrence.event < events);
    known.then_some((checkpoint, label))
}

fn put_integer(bytes: &mut Vec<u8>, value: u64) {
    bytes.extend(value.to_le_bytes());
}

fn put_numbers(bytes: &mut Vec<u8>, values: &[f64]) {
    bytes.extend(values.iter().flat_map(|value| value.to_le_bytes()));
}

fn integer(bytes: &mut &[u8]) -> Option<u64> {
    Some(u64::from_le_bytes(bytes.split_off(..8)?.try_into().ok()?))
}

fn flag(bytes: &mut &[u8]) -> Option<bool> {
    match integer(bytes)? {
        0 => Some(false),
        1 => Some(true),
        _ => None,
    }
}

fn index(bytes: &mut &[u8]) -> Option<usize> {
    usize::try_from(integer(bytes)?).ok()
}

fn number(bytes: &mut &[u8]) -> Option<f64> {
    Some(f64::from_le_bytes(bytes.split_off(..8)?.try_into().ok()?))
}

fn numbers(bytes: &mut &[u8], count: usize) -> Option<Vec<f64>> {
    let numbers = bytes.split_off(..count.checked_mul(8)?)?.chunks_exact(8);
    numbers.map(|number| Some(f64::from_le_bytes(number.try_into().ok()?))).collect()
}

/// Reads a list that is preceded by its length.
fn list<T>(bytes: &mut &[u8], mut one: impl FnMut(&mut &[u8]) -> Option<T>) -> Option<Vec<T>> {
    (0..integer(bytes)?).map(|_| one(bytes)).collect()
}
