//! Ctrl-C: what there is of a result is put beside its file, which stays as it was.

#![cfg(unix)]

use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Output, Stdio};
use std::thread;
use std::time::Duration;

use serde_json::Value;
use tempfile::TempDir;

use crate::patience::{Reaped, ended, started, until};

/// A directory, with another one for temporary files.
struct Place(TempDir, TempDir);

impl Place {
    fn new() -> Place {
        Place(tempfile::tempdir().expect("a directory"), tempfile::tempdir().expect("a directory"))
    }

    fn at(&self, name: &str) -> PathBuf {
        self.0.path().join(name)
    }

    fn read(&self, name: &str) -> String {
        fs::read_to_string(self.at(name)).expect(name)
    }

    /// `pc` in the directory, with a motion to `t_end` that takes minutes or hours.
    fn pc(&self, arguments: &[&str], t_end: &str) -> Reaped {
        let mut command = Command::new(env!("CARGO_BIN_EXE_pc"));
        command.args(arguments).args(["--t-end", t_end, "--rows", "1000000"]).current_dir(self.0.path());
        command.env("TMPDIR", self.1.path()).stdin(Stdio::null()).stdout(Stdio::null());
        started(command.stderr(Stdio::piped()))
    }

    fn entries(&self) -> Vec<String> {
        let mut names: Vec<String> = paths(self.0.path()).iter().map(|path| name(path)).collect();
        names.sort();
        names
    }

    /// Interrupts a run whose rows are written as they are computed, once some are on disk in this directory.
    fn streamed(&self, directory: &Path) -> String {
        let mut child = self.pc(&["run", "euler-top", "-o", "a.csv"], "1e7");
        let has_rows = |path: &PathBuf| {
            name(path).ends_with(".part") && fs::metadata(path).is_ok_and(|part| part.len() > 0)
        };
        until("rows on disk", || paths(directory).iter().any(has_rows) || child.has_ended());
        child.signal("-INT");
        interrupted(&ended(child))
    }
}

fn paths(directory: &Path) -> Vec<PathBuf> {
    let entries = fs::read_dir(directory).expect("a directory");
    entries.map(|entry| entry.expect("an entry").path()).collect()
}

fn name(path: &Path) -> String {
    path.file_name().expect("a name").to_str().expect("UTF-8").to_owned()
}

/// What an interrupted command says.
#[track_caller]
fn interrupted(output: &Output) -> String {
    let text = String::from_utf8(output.stderr.clone()).expect("UTF-8");
    assert_eq!(output.status.code(), Some(130), "{text}");
    assert!(text.contains("\npc: interrupted at t = "), "{text}");
    text
}

fn beside(name: &str) -> String {
    format!("note: the result up to the interruption is in {name}.partial; {name} stays as it was\n")
}

#[test]
fn a_table_and_a_picture_of_the_rows_reached_are_beside_their_files() {
    let place = Place::new();
    fs::write(place.at("a.json"), "old").expect("written");
    let files = ["-o", "a.json", "--plot", "b.svg", "--checkpoint", "c"];
    let mut child = place.pc(&[&["run", "euler-top"][..], &files].concat(), "1e9");
    // The first checkpoint is that of the start, the second one shows that the motion is under way.
    let mut first = None;
    until("a second checkpoint", || {
        let now = fs::read(place.at("c")).ok();
        let changed = first.is_some() && now != first;
        first = first.take().or(now);
        changed || child.has_ended()
    });
    child.signal("-INT");
    let text = interrupted(&ended(child));
    assert!(text.contains(&beside("a.json")) && text.contains(&beside("b.svg")), "{text}");
    assert_eq!(place.entries(), ["a.json", "a.json.partial", "b.svg.partial", "c"]);
    assert_eq!(place.read("a.json"), "old");
    let json: Value = serde_json::from_str(&place.read("a.json.partial")).expect("JSON");
    assert_eq!(json["summary"]["ending"], "interrupted");
    assert!(!json["rows"].as_array().expect("rows").is_empty());
    assert!(place.read("b.svg.partial").starts_with("<svg"));
}

#[test]
fn rows_written_during_the_run_are_beside_the_file() {
    let place = Place::new();
    let text = place.streamed(place.0.path());
    assert!(text.contains(&beside("a.csv")), "{text}");
    assert_eq!(place.entries(), ["a.csv.partial"], "a.csv is never a part");
    let part = place.read("a.csv.partial");
    assert!(part.starts_with("t,") && part.ends_with('\n') && part.lines().count() > 1000);

    // Neither the file nor what was kept before is replaced.
    fs::write(place.at("a.csv"), "old").expect("written");
    let text = place.streamed(place.0.path());
    let kept = paths(place.1.path()).pop().expect("a file");
    let message = format!(
        "pc: cannot write a.csv.partial; what could be written of it is in {}\n  because: it is there already\n",
        kept.display()
    );
    assert!(text.contains(&message), "{text}");
    assert_eq!(place.entries(), ["a.csv", "a.csv.partial"]);
    assert_eq!(place.read("a.csv"), "old");
    assert!(place.read("a.csv.partial") == part);
    let again = fs::read_to_string(kept).expect("rows");
    assert!(again.starts_with(&part) || part.starts_with(&again), "the same rows, as far as they go");
}

#[test]
fn a_private_table_has_a_private_part_beside_the_file_to_which_links_lead() {
    use std::os::unix::fs::{PermissionsExt, symlink};
    let place = Place::new();
    fs::create_dir(place.at("results")).expect("a directory");
    fs::write(place.at("results/b.csv"), "old").expect("written");
    fs::set_permissions(place.at("results/b.csv"), fs::Permissions::from_mode(0o600)).expect("its own");
    symlink("results/b.csv", place.at("a.csv")).expect("a link");
    let text = place.streamed(&place.at("results"));
    assert!(text.contains("results/b.csv.partial; a.csv stays as it was\n"), "{text}");
    assert_eq!(place.read("results/b.csv"), "old");
    let part = fs::metadata(place.at("results/b.csv.partial")).expect("a part");
    assert_eq!(part.permissions().mode() & 0o777, 0o600);
}

#[test]
fn a_page_of_the_motion_reached_is_beside_its_file() {
    for command in ["report", "animate"] {
        let place = Place::new();
        fs::write(place.at("a.html"), "old").expect("written");
        // Before the motion has begun, Ctrl-C ends the program at once.
        let text = (0..10).find_map(|k| {
            let mut child = place.pc(&[command, "tilted-disk", "-o", "a.html"], "1e9");
            thread::sleep(Duration::from_millis(250 << k));
            child.signal("-INT");
            let output = ended(child);
            output.status.code().map(|_| interrupted(&output))
        });
        assert!(text.expect("a motion").contains(&beside("a.html")), "{command}");
        assert_eq!(place.entries(), ["a.html", "a.html.partial"], "{command}");
        assert_eq!(place.read("a.html"), "old");
        assert!(place.read("a.html.partial").trim_end().ends_with("</html>"));
    }
}
