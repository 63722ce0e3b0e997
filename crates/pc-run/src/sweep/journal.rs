//! The finished members of a sweep, kept on disk until its table is complete.
//!
//! ```text
//! pc sweep journal\n
//! frame of the header: the model and the options, [[what, value], …] in JSON
//! frame of a record, for members 0, 1, 2, …
//! ```
//! A frame consists of a length, a CRC-32 and the bytes. Records are only ever appended, those of short motions many at a
//! time; an incomplete record at the end is cut off.

use std::fs::{File, OpenOptions, TryLockError};
use std::io::{self, BufReader, Read, Seek, SeekFrom, Write};
use std::path::{Path, PathBuf};
use std::sync::mpsc::{RecvTimeoutError, channel};
use std::sync::{Mutex, PoisonError};
use std::thread;
use std::time::Duration;

use super::error::SweepError;
use super::record::{Record, Status};
use super::shard::Shard;
use crate::files::so_far;
use crate::motion::identity;
use crate::motion::identity::Identity;

const MAGIC: &[u8] = b"pc sweep journal\n";

/// A journal, locked until it is dropped.
#[derive(Debug)]
pub struct Journal {
    path: PathBuf,
    file: File,
    /// Frames that are not yet in the file, and where each of them ends.
    waiting: Vec<u8>,
    ends: Vec<u64>,
    /// Why frames could not be written between two appends.
    failed: Option<SweepError>,
    /// How many members are in the file, and its length.
    kept: u64,
    length: u64,
    /// The offset at which the records begin.
    records: u64,
    /// The members to which the records belong.
    shard: Shard,
    tally: Tally,
}

/// The records of finished members, in order.
pub trait Records {
    /// The records.
    ///
    /// # Errors
    /// [`io::Error`] from the file.
    fn records(&self) -> io::Result<Box<dyn Iterator<Item = io::Result<Record>> + '_>>;

    /// The file that keeps the records if the table cannot be written; none if they stay in their shards
    /// anyway.
    fn kept(&self) -> Option<&Path>;
}

/// Records wait for others until they are as many bytes, or for so long: a system call takes as long as some short motions.
const WAITING: usize = 1 << 16;
const LONGEST_WAIT: Duration = Duration::from_millis(50);

/// How many members ended in each of the possible ways.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Tally {
    /// The number of members that are finished.
    pub done: u64,
    /// The number of finished members that were completed.
    pub completed: u64,
    /// The number of members that were ended by a terminal event.
    pub by_event: u64,
    /// The first few of the members that ended otherwise, with their messages.
    pub others: Vec<(u64, Status, String)>,
}

/// The largest number of messages that are kept.
const MESSAGES: usize = 5;

impl Tally {
    /// The sum of the tallies of several journals.
    pub(crate) fn sum<'t>(parts: impl Iterator<Item = &'t Tally>) -> Tally {
        let mut sum = Tally::default();
        for part in parts {
            sum.done += part.done;
            sum.completed += part.completed;
            sum.by_event += part.by_event;
            sum.others.extend(part.others.iter().cloned());
        }
        sum.others.sort_by_key(|(member, ..)| *member);
        sum.others.truncate(MESSAGES);
        sum
    }

    fn count(&mut self, record: &Record) {
        self.done += 1;
        match record.status {
            Status::Completed => self.completed += 1,
            Status::Event => self.by_event += 1,
            status if self.others.len() < MESSAGES => {
                self.others.push((record.member, status, record.message.clone()));
            }
            Status::Failed | Status::Refused | Status::Panicked => {}
        }
    }
}

impl Journal {
    /// The path of the journal of a whole sweep, beside its table.
    pub(crate) fn beside(table: &Path) -> PathBuf {
        so_far::beside(table)
    }

    /// The journal of a shard: a new one, or the one that the same sweep left behind.
    ///
    /// # Errors
    /// [`SweepError`] if it belongs to another sweep or is in use.
    pub(crate) fn open(path: PathBuf, shard: Shard, header: &Identity) -> Result<Journal, SweepError> {
        let refused = |source| SweepError::Journal { journal: path.clone(), source };
        if std::fs::metadata(&path).is_ok_and(|found| !found.is_file()) {
            return Err(SweepError::Foreign { journal: path });
        }
        let file = OpenOptions::new().read(true).append(true).create(true).open(&path).map_err(refused)?;
        match file.try_lock() {
            Ok(()) => {}
            Err(TryLockError::WouldBlock) => return Err(SweepError::InUse { journal: path }),
            Err(TryLockError::Error(source)) => return Err(refused(source)),
        }
        let mut beginning = MAGIC.to_vec();
        let text = serde_json::to_vec(header).map_err(|error| refused(error.into()))?;
        beginning.extend(frame(&text));
        let records = beginning.len() as u64;
        let mut journal = Journal::of(path, file, records, shard);
        journal.begin(&beginning, header)?;
        let refused = |source| SweepError::Journal { journal: journal.path.clone(), source };
        let (tally, end) = journal.scan().map_err(refused)?;
        journal.file.set_len(end).map_err(refused)?;
        Ok(Journal { kept: tally.done, length: end, tally, ..journal })
    }

    fn of(path: PathBuf, file: File, records: u64, shard: Shard) -> Journal {
        let tally = Tally::default();
        Journal {
            path,
            file,
            waiting: Vec::new(),
            ends: Vec::new(),
            failed: None,
            kept: 0,
            length: records,
            records,
            shard,
            tally,
        }
    }

    /// Opens a journal for reading only and returns it with its header, from which `shard` finds out which
    /// shard it is.
    ///
    /// # Errors
    /// [`SweepError`] if the file is not a journal, or is in use.
    pub(crate) fn finished(
        path: &Path,
        shard: impl FnOnce(&Identity) -> Option<Shard>,
    ) -> Result<(Journal, Identity), SweepError> {
        let path = path.to_owned();
        let refused = |source| SweepError::Journal { journal: path.clone(), source };
        let file = File::open(&path).map_err(refused)?;
        match file.try_lock_shared() {
            Ok(()) => {}
            Err(TryLockError::WouldBlock) => return Err(SweepError::InUse { journal: path }),
            Err(TryLockError::Error(source)) => return Err(refused(source)),
        }
        let mut journal = Journal::of(path, file, 0, Shard::ALL);
        let mut reader = journal
            .reader(0)
            .map_err(|source| SweepError::Journal { journal: journal.path.clone(), source })?;
        let text = read_magic(&mut reader).and_then(|()| Ok(read_frame(&mut reader)?.unwrap_or_default()));
        let header = text.ok().and_then(|text| {
            let header = serde_json::from_slice::<Identity>(&text).ok()?;
            Some(((MAGIC.len() + text.len()) as u64 + FRAME, shard(&header)?, header))
        });
        let Some((records, shard, header)) = header else {
            return Err(SweepError::NoShard { path: journal.path });
        };
        (journal.records, journal.shard) = (records, shard);
        match journal.scan() {
            Ok((tally, _)) => Ok((Journal { tally, ..journal }, header)),
            Err(source) => Err(SweepError::Journal { journal: journal.path, source }),
        }
    }

    /// Writes the `beginning`, unless the file already has it.
    fn begin(&mut self, beginning: &[u8], header: &Identity) -> Result<(), SweepError> {
        let refused = |source| SweepError::Journal { journal: self.path.clone(), source };
        let mut found = Vec::new();
        let reader = self.reader(0).map_err(refused)?;
        reader.take(beginning.len() as u64).read_to_end(&mut found).map_err(refused)?;
        if found == beginning {
            return Ok(());
        }
        if beginning.starts_with(&found) {
            // A new file, or an incomplete beginning.
            self.file.set_len(0).map_err(refused)?;
            return self.file.write_all(beginning).map_err(refused);
        }
        let mut reader = self.reader(0).map_err(refused)?;
        let other = read_magic(&mut reader).and_then(|()| Ok(read_frame(&mut reader)?.unwrap_or_default()));
        let other = other.ok().and_then(|text| serde_json::from_slice::<Identity>(&text).ok());
        Err(match other.and_then(|other| identity::difference(&other, header)) {
            Some(what) => SweepError::OtherSweep { journal: self.path.clone(), what },
            None => SweepError::Foreign { journal: self.path.clone() },
        })
    }

    /// How many of the recorded members ended in each way, and the offset at which the records end.
    fn scan(&self) -> io::Result<(Tally, u64)> {
        let (mut tally, mut end) = (Tally::default(), self.records);
        let mut reader = self.reader(self.records)?;
        while let Some(bytes) = read_frame(&mut reader)? {
            match Record::from_bytes(&bytes) {
                Some(record) if record.member == self.shard.member(tally.done) => tally.count(&record),
                _ => break,
            }
            end += FRAME + bytes.len() as u64;
        }
        Ok((tally, end))
    }

    /// Appends the record of the next member, which is in the file after [`flush`](Journal::flush) at the latest.
    ///
    /// # Errors
    /// [`SweepError::Append`]
    pub(crate) fn append(&mut self, record: &Record) -> Result<(), SweepError> {
        if let Some(error) = self.failed.take() {
            return Err(error);
        }
        self.waiting.extend(frame(&record.to_bytes()));
        self.ends.push(self.waiting.len() as u64);
        self.tally.count(record);
        if self.waiting.len() >= WAITING { self.write_waiting() } else { Ok(()) }
    }

    /// Does some work that appends records, and writes those that wait at least every 50 ms meanwhile, however long the next
    /// one takes.
    pub(crate) fn while_writing<T>(journal: &Mutex<&mut Journal>, work: impl FnOnce() -> T) -> T {
        thread::scope(|scope| {
            let (working, is_over) = channel::<()>();
            scope.spawn(move || {
                while is_over.recv_timeout(LONGEST_WAIT) == Err(RecvTimeoutError::Timeout) {
                    let mut journal = journal.lock().unwrap_or_else(PoisonError::into_inner);
                    if journal.failed.is_none()
                        && let Err(error) = journal.write_waiting()
                    {
                        journal.failed = Some(error);
                    }
                }
            });
            // Closed at the end of the work, also if it panics.
            let _working = working;
            work()
        })
    }

    /// Writes the records that wait for others.
    ///
    /// # Errors
    /// [`SweepError::Append`]
    pub(crate) fn flush(&mut self) -> Result<(), SweepError> {
        self.failed.take().map_or(Ok(()), Err)?;
        self.write_waiting()
    }

    fn write_waiting(&mut self) -> Result<(), SweepError> {
        let outcome = self.file.write_all(&self.waiting);
        let written = match &outcome {
            Ok(()) => self.waiting.len() as u64,
            // As much as there was room for.
            Err(_) => self.file.metadata().map_or(0, |file| file.len().saturating_sub(self.length)),
        };
        self.kept += self.ends.partition_point(|&end| end <= written) as u64;
        self.length += written;
        self.waiting.clear();
        self.ends.clear();
        let done = self.kept;
        outcome.map_err(|source| SweepError::Append { journal: self.path.clone(), done, source })
    }

    /// The shard whose members the journal contains.
    pub(crate) fn shard(&self) -> Shard {
        self.shard
    }

    /// The path of the file.
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// How many members ended in each of the possible ways.
    pub fn tally(&self) -> &Tally {
        &self.tally
    }

    /// Removes the journal once the table is complete.
    ///
    /// # Errors
    /// [`SweepError::Journal`]
    pub fn remove(self) -> Result<(), SweepError> {
        std::fs::remove_file(&self.path)
            .map_err(|source| SweepError::Journal { journal: self.path.clone(), source })
    }

    fn reader(&self, from: u64) -> io::Result<BufReader<&File>> {
        let mut file = &self.file;
        file.seek(SeekFrom::Start(from))?;
        Ok(BufReader::new(file))
    }
}

impl Records for Journal {
    fn records(&self) -> io::Result<Box<dyn Iterator<Item = io::Result<Record>> + '_>> {
        let mut reader = self.reader(self.records)?;
        let mut left = self.tally.done;
        Ok(Box::new(std::iter::from_fn(move || {
            left = left.checked_sub(1)?;
            let bytes = match read_frame(&mut reader) {
                Ok(bytes) => bytes,
                Err(error) => return Some(Err(error)),
            };
            let record = bytes.as_deref().and_then(Record::from_bytes);
            Some(
                record.ok_or_else(|| {
                    io::Error::new(io::ErrorKind::InvalidData, "a record has changed on disk")
                }),
            )
        })))
    }

    fn kept(&self) -> Option<&Path> {
        Some(&self.path)
    }
}

/// The length of a frame without its bytes.
const FRAME: u64 = 12;

fn frame(bytes: &[u8]) -> Vec<u8> {
    let mut frame = Vec::with_capacity(FRAME as usize + bytes.len());
    frame.extend((bytes.len() as u64).to_le_bytes());
    frame.extend(crc32fast::hash(bytes).to_le_bytes());
    frame.extend(bytes);
    frame
}

/// The bytes of the next frame; none if it is incomplete or damaged.
fn read_frame(reader: &mut impl Read) -> io::Result<Option<Vec<u8>>> {
    let mut head = Vec::new();
    reader.by_ref().take(FRAME).read_to_end(&mut head)?;
    let Some((length, crc)) = head.split_first_chunk::<8>() else { return Ok(None) };
    let (length, mut bytes) = (u64::from_le_bytes(*length), Vec::new());
    reader.by_ref().take(length).read_to_end(&mut bytes)?;
    let whole = bytes.len() as u64 == length && crc == crc32fast::hash(&bytes).to_le_bytes();
    Ok(whole.then_some(bytes))
}

fn read_magic(reader: &mut impl Read) -> io::Result<()> {
    let mut magic = [0; MAGIC.len()];
    reader.read_exact(&mut magic)?;
    if magic == MAGIC { Ok(()) } else { Err(io::ErrorKind::InvalidData.into()) }
}

#[cfg(test)]
mod tests {
    use std::time::Instant;

    use super::*;

    /// Records that come together are in the file soon, even if no other follows.
    #[test]
    fn records_do_not_wait_for_the_next_one() {
        let directory = tempfile::tempdir().expect("a directory");
        let path = directory.path().join("a.csv.partial");
        let mut journal = Journal::open(path.clone(), Shard::ALL, &Identity::new()).expect("a journal");
        let record = |member| Record {
            member,
            status: Status::Completed,
            steps: 1,
            message: String::new(),
            values: Vec::new(),
            rows: vec![1.0],
            words: Vec::new(),
        };
        let (empty, each) = (journal.length, frame(&record(0).to_bytes()).len() as u64);
        let shared = Mutex::new(&mut journal);
        Journal::while_writing(&shared, || {
            for member in 0..3 {
                shared.lock().expect("no panic").append(&record(member)).expect("written");
            }
            let begun = Instant::now();
            while std::fs::metadata(&path).expect("a file").len() < empty + 3 * each {
                assert!(begun.elapsed() < Duration::from_secs(30), "they are never written");
                thread::sleep(Duration::from_millis(5));
            }
        });
        assert_eq!((journal.kept, journal.tally.done), (3, 3));
    }
}
