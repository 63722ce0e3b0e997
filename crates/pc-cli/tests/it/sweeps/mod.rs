//! Sweeps in a directory of their own, and what cuts them short.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Output, Stdio};

use crate::patience::{ended, started};

/// A directory with a model in it.
pub(crate) struct Place(tempfile::TempDir);

impl Place {
    pub(crate) fn new(model: &str) -> Place {
        let directory = tempfile::tempdir().expect("a directory");
        fs::write(directory.path().join("model.toml"), model).expect("written");
        Place(directory)
    }

    pub(crate) fn at(&self, name: &str) -> PathBuf {
        self.0.path().join(name)
    }

    /// As [`cut`], with the journal `name`.
    pub(crate) fn cut(&self, arguments: &[&str], name: &str, bytes: u64) -> bool {
        cut(self.0.path(), arguments, &self.at(name), bytes)
    }

    pub(crate) fn pc(&self, arguments: &[&str]) -> Command {
        let mut command = Command::new(env!("CARGO_BIN_EXE_pc"));
        command.args(arguments).current_dir(self.0.path()).stdin(Stdio::null());
        command
    }

    #[track_caller]
    pub(crate) fn ends(&self, arguments: &[&str], code: i32, mentions: &[&str]) -> Output {
        let output = self.pc(arguments).output().expect("pc runs");
        let text = String::from_utf8_lossy(&output.stderr).into_owned();
        assert_eq!(output.status.code(), Some(code), "{arguments:?}: {text}");
        for mention in mentions {
            assert!(text.contains(mention), "{arguments:?} should mention {mention}: {text}");
        }
        output
    }

    /// The bytes of a sweep of `model.toml`.
    #[track_caller]
    pub(crate) fn swept(&self, table: &str, options: &[&str]) -> Vec<u8> {
        self.ends(&[&["sweep", "model.toml", "-o", table][..], options].concat(), 0, &[]);
        assert!(!self.at(&format!("{table}.partial")).exists(), "the journal is gone");
        fs::read(self.at(table)).expect("a table")
    }
}

/// Runs `pc` in `directory` until its journal has grown by `bytes`, up to a block more; whether it was cut short before its end.
///
/// The limit on the size of files cuts the journal in the midst of a record, at the same byte on each machine: nothing of what is
/// then on disk would be different if the program were killed there.
pub(crate) fn cut(directory: &Path, arguments: &[&str], journal: &Path, bytes: u64) -> bool {
    let length = fs::metadata(journal).map_or(0, |metadata| metadata.len());
    let limits = format!("ulimit -f {}", (length + bytes) / 512 + 1);
    let mut shell = Command::new("sh");
    shell.args(["-c", &format!("{limits}; exec \"$0\" \"$@\""), env!("CARGO_BIN_EXE_pc")]).args(arguments);
    shell.current_dir(directory).stdin(Stdio::null()).stdout(Stdio::null()).stderr(Stdio::null());
    let status = ended(started(&mut shell)).status;
    assert!(matches!(status.code(), Some(0 | 6)), "it neither ends well nor is cut short: {status}");
    !status.success()
}
