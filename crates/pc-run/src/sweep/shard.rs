//! The part of a sweep that one process computes.

use std::fmt;
use std::path::{Path, PathBuf};

/// A part of a sweep: every `of`-th member, since neighbouring members often cost the same.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Shard {
    /// The number of the shard, counted from 1.
    pub number: u64,
    /// How many shards there are.
    pub of: u64,
}

impl Shard {
    /// The whole sweep.
    pub(crate) const ALL: Shard = Shard { number: 1, of: 1 };

    /// Reads a shard as written on the command line, such as `3/8`.
    ///
    /// # Errors
    /// The message shows the correct form.
    pub fn parse(text: &str) -> Result<Shard, String> {
        let parts =
            text.split_once('/').and_then(|(number, of)| Some((number.parse().ok()?, of.parse().ok()?)));
        match parts {
            Some((number, of)) if (1..=of).contains(&number) => Ok(Shard { number, of }),
            _ => Err("write I/N, the number of the shard from 1 and how many there are, as in `--shard 3/8`"
                .to_owned()),
        }
    }

    /// The number in the sweep of the shard's member number `place`; both are counted from 0.
    pub(crate) fn member(self, place: u64) -> u64 {
        self.number - 1 + place * self.of
    }

    /// How many of `all` members belong to the shard.
    pub(crate) fn members(self, all: u64) -> u64 {
        (all + self.of - self.number) / self.of
    }

    /// The path of its journal, beside the table of the whole sweep.
    pub(crate) fn beside(self, table: &Path) -> PathBuf {
        let mut name = table.as_os_str().to_owned();
        name.push(format!(".shard-{}-of-{}", self.number, self.of));
        PathBuf::from(name)
    }
}

impl fmt::Display for Shard {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}/{}", self.number, self.of)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn shards_have_each_member_once() {
        for (all, of) in [(10, 3), (3, 3), (2, 5), (1, 1), (0, 2)] {
            let mut members: Vec<u64> = Vec::new();
            for number in 1..=of {
                let shard = Shard { number, of };
                members.extend((0..shard.members(all)).map(|place| shard.member(place)));
            }
            members.sort_unstable();
            assert!(members.into_iter().eq(0..all), "{all} in {of}");
        }
    }

    #[test]
    fn shards_are_read_or_refused() {
        assert_eq!(Shard::parse("3/8"), Ok(Shard { number: 3, of: 8 }));
        for wrong in ["3", "0/8", "9/8", "1/0", "a/b", "1/2/3", "-1/2"] {
            assert!(Shard::parse(wrong).is_err(), "{wrong}");
        }
    }
}
