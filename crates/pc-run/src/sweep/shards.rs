//! Puts all shards of a sweep together as one table.

use std::io;
use std::path::{Path, PathBuf};

use crate::motion::identity::{self, Identity};
use crate::sweep::error::SweepError;
use crate::sweep::journal::{Journal, Records, Tally};
use crate::sweep::shard::Shard;
use crate::sweep::sweep_columns::SweepColumns;

/// The names of the entries in the header of a shard, in addition to those in the header of any sweep.
const SHARD: &str = "--shard";
const MEMBERS: &str = "the number of members:";
const TITLE: &str = "the title";
const SHEET: &str = "the columns";
const RANDOM: &str = "--random";

/// The header of a shard, which contains enough to merge shards without the model.
pub(crate) fn described(
    mut header: Identity,
    shard: Shard,
    members: u64,
    title: &str,
    sweep_columns: &SweepColumns,
) -> Identity {
    let entries = [
        (SHARD, shard.to_string()),
        (MEMBERS, members.to_string()),
        (TITLE, title.to_owned()),
        (SHEET, sweep_columns.to_text()),
    ];
    header.extend(entries.map(|(name, value)| (name.to_owned(), value)));
    header
}

/// Complete shards, in order.
#[derive(Debug)]
pub struct Shards {
    journals: Vec<Journal>,
    members: u64,
    /// The title of the model.
    pub title: String,
    /// The columns.
    pub sweep_columns: SweepColumns,
    /// Whether the members were drawn at random.
    pub is_random: bool,
}

impl Shards {
    /// Opens the shards in these files, in any order.
    ///
    /// # Errors
    /// [`SweepError`] if a shard is missing, given twice, incomplete, or from another sweep.
    pub fn open(paths: &[PathBuf]) -> Result<Shards, SweepError> {
        let mut first: Option<(Identity, PathBuf)> = None;
        let mut found: Vec<(Shard, Journal)> = Vec::new();
        for path in paths {
            let (journal, mut header) =
                Journal::finished(path, |header| shard(header).map(|(shard, _)| shard))?;
            let Some((shard, members)) = shard(&header) else {
                return Err(SweepError::NoShard { path: path.clone() });
            };
            header.retain(|(name, _)| name != SHARD);
            if let Some((other, its)) = &first
                && let Some(what) = identity::difference(&header, other)
            {
                return Err(SweepError::OtherShard { path: path.clone(), other: its.clone(), what });
            }
            let (done, wanted) = (journal.tally().done, shard.members(members));
            if done < wanted {
                return Err(SweepError::Unfinished { path: path.clone(), shard, done, members: wanted });
            }
            if let Some((_, twice)) =
                found.iter().find(|(known, _)| known.number == shard.number && known.of == shard.of)
            {
                let paths = [twice.path().to_owned(), path.clone()];
                return Err(SweepError::ShardTwice { shard, paths });
            }
            if let Some((known, other)) = found.iter().find(|(known, _)| known.of != shard.of) {
                let what = format!("{SHARD} {shard}, where there it is {known}");
                return Err(SweepError::OtherShard {
                    path: path.clone(),
                    other: other.path().to_owned(),
                    what,
                });
            }
            first.get_or_insert((header, path.clone()));
            found.push((shard, journal));
        }
        found.sort_by_key(|(shard, _)| shard.number);
        let (Some((header, path)), Some(of)) = (first, found.first().map(|(shard, _)| shard.of)) else {
            return Err(SweepError::NoShards);
        };
        let missing: Vec<u64> =
            (1..=of).filter(|number| found.iter().all(|(shard, _)| shard.number != *number)).collect();
        if !missing.is_empty() {
            return Err(SweepError::Missing { shards: missing, of });
        }
        let value = |name: &str| entry(&header, name).unwrap_or_default().to_owned();
        let sweep_columns = SweepColumns::from_text(&value(SHEET)).ok_or(SweepError::NoShard { path })?;
        Ok(Shards {
            members: value(MEMBERS).parse().unwrap_or(0),
            title: value(TITLE),
            sweep_columns,
            is_random: !value(RANDOM).is_empty(),
            journals: found.into_iter().map(|(_, journal)| journal).collect(),
        })
    }

    /// How many members ended in each of the possible ways.
    pub fn tally(&self) -> Tally {
        Tally::sum(self.journals.iter().map(Journal::tally))
    }
}

fn entry<'i>(header: &'i Identity, name: &str) -> Option<&'i str> {
    header.iter().find(|(known, _)| known == name).map(|(_, value)| value.as_str())
}

/// Which shard this is, and the total number of members.
fn shard(header: &Identity) -> Option<(Shard, u64)> {
    let shard = Shard::parse(entry(header, SHARD)?).ok()?;
    Some((shard, entry(header, MEMBERS)?.parse().ok()?))
}

impl Records for Shards {
    fn records(&self) -> io::Result<Box<dyn Iterator<Item = io::Result<crate::sweep::record::Record>> + '_>> {
        let mut parts = self.journals.iter().map(Records::records).collect::<io::Result<Vec<_>>>()?;
        let count = parts.len() as u64;
        let next = move |member: u64| {
            let record = parts[(member % count) as usize].next();
            record.unwrap_or_else(|| {
                Err(io::Error::new(io::ErrorKind::InvalidData, "a shard has changed on disk"))
            })
        };
        Ok(Box::new((0..self.members).map(next)))
    }

    fn kept(&self) -> Option<&Path> {
        None
    }
}
