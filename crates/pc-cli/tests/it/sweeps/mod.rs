//! Sweeps in a directory of their own, and what kills them.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Output, Stdio};
use std::time::{Duration, Instant};

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

/// Kills the process as soon as its journal has grown by `bytes`; whether it was killed before its end.
pub(crate) fn killed(place: &Place, arguments: &[&str], journal: &Path, bytes: u64) -> bool {
    let length = || fs::metadata(journal).map_or(0, |metadata| metadata.len());
    let before = length();
    let mut child = place.pc(arguments).stderr(Stdio::null()).spawn().expect("pc starts");
    let start = Instant::now();
    while length() < before + bytes {
        if child.try_wait().expect("a child").is_some() {
            return false;
        }
        assert!(start.elapsed() < Duration::from_secs(60), "nothing happens");
        std::thread::sleep(Duration::from_micros(200));
    }
    let _ = child.kill();
    child.wait().expect("ended").code().is_none()
}
