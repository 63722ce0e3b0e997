//! The record of a member.

/// How a member ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Status {
    /// The motion of the member reached its end time.
    Completed,
    /// The integration of the member failed.
    Failed,
    /// The member could not start.
    Refused,
    /// The computation of the member panicked.
    Panicked,
    /// A terminal event ended it.
    Event,
}

impl Status {
    const ALL: [Status; 5] =
        [Status::Completed, Status::Failed, Status::Refused, Status::Panicked, Status::Event];

    /// The name of the status in the table.
    pub fn word(self) -> &'static str {
        match self {
            Status::Completed => "completed",
            Status::Failed => "failed",
            Status::Refused => "refused",
            Status::Panicked => "panicked",
            Status::Event => "event",
        }
    }
}

/// A finished member.
#[derive(Clone, Debug, PartialEq)]
pub struct Record {
    /// The number of the member, counted from 0.
    pub member: u64,
    /// How the member ended.
    pub status: Status,
    /// Internal steps.
    pub steps: u64,
    /// Why the member was not completed, or which event ended it; otherwise empty.
    pub message: String,
    /// The values of the varied quantities.
    pub values: Vec<f64>,
    /// The numbers in its rows, one row after the other.
    pub rows: Vec<f64>,
    /// The words in its rows, one row after the other.
    pub words: Vec<String>,
}

impl Record {
    /// The record as bytes, with all numbers little-endian.
    pub(crate) fn to_bytes(&self) -> Vec<u8> {
        let mut bytes =
            Vec::with_capacity(64 + self.message.len() + 8 * (self.values.len() + self.rows.len()));
        let text = |bytes: &mut Vec<u8>, text: &str| {
            bytes.extend((text.len() as u64).to_le_bytes());
            bytes.extend(text.as_bytes());
        };
        bytes.extend(self.member.to_le_bytes());
        bytes.push(Status::ALL.iter().position(|&status| status == self.status).unwrap_or(0) as u8);
        bytes.extend(self.steps.to_le_bytes());
        text(&mut bytes, &self.message);
        for numbers in [&self.values, &self.rows] {
            bytes.extend((numbers.len() as u64).to_le_bytes());
            bytes.extend(numbers.iter().flat_map(|number| number.to_le_bytes()));
        }
        bytes.extend((self.words.len() as u64).to_le_bytes());
        self.words.iter().for_each(|word| text(&mut bytes, word));
        bytes
    }

    /// Reads a record from its bytes.
    pub(crate) fn from_bytes(mut bytes: &[u8]) -> Option<Record> {
        let bytes = &mut bytes;
        let record = Record {
            member: integer(bytes)?,
            status: *Status::ALL.get(usize::from(*bytes.split_off_first()?))?,
            steps: integer(bytes)?,
            message: text(bytes)?,
            values: numbers(bytes)?,
            rows: numbers(bytes)?,
            words: (0..integer(bytes)?).map(|_| text(bytes)).collect::<Option<_>>()?,
        };
        bytes.is_empty().then_some(record)
    }
}

fn integer(bytes: &mut &[u8]) -> Option<u64> {
    Some(u64::from_le_bytes(bytes.split_off(..8)?.try_into().ok()?))
}

fn text(bytes: &mut &[u8]) -> Option<String> {
    let length = usize::try_from(integer(bytes)?).ok()?;
    String::from_utf8(bytes.split_off(..length)?.to_vec()).ok()
}

fn numbers(bytes: &mut &[u8]) -> Option<Vec<f64>> {
    let length = usize::try_from(integer(bytes)?).ok()?.checked_mul(8)?;
    let numbers = bytes.split_off(..length)?.chunks_exact(8);
    numbers.map(|number| Some(f64::from_le_bytes(number.try_into().ok()?))).collect()
}
