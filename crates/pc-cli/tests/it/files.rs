//! Files: which are replaced, which are refused, and what is kept of a result that cannot be
//! written.

#![cfg(unix)]

use std::fs::{self, File, Permissions};
use std::os::unix::fs::{FileTypeExt, MetadataExt, PermissionsExt, chown, symlink};
use std::os::unix::net::UnixListener;
use std::os::unix::process::ExitStatusExt;
use std::path::{Path, PathBuf};
use std::process::{Command, ExitStatus, Output, Stdio};
use std::sync::mpsc;
use std::thread;

use tempfile::TempDir;

use crate::patience::{PATIENCE, Reaped, ended, started, until};

/// A directory, with another one for temporary files.
struct Place(TempDir, TempDir);

impl Place {
    fn new() -> Place {
        Place(tempfile::tempdir().expect("a directory"), tempfile::tempdir().expect("a directory"))
    }

    fn at(&self, name: &str) -> PathBuf {
        self.0.path().join(name)
    }

    fn name(&self, name: &str) -> String {
        self.at(name).display().to_string()
    }

    /// `pc` in the directory.
    fn pc(&self, arguments: &[&str]) -> Command {
        let mut command = Command::new(env!("CARGO_BIN_EXE_pc"));
        command.args(arguments).current_dir(self.0.path()).env("TMPDIR", self.1.path()).stdin(Stdio::null());
        command
    }

    /// The same in a shell, after the commands `before`.
    fn shell(&self, before: &str, arguments: &[&str]) -> Output {
        let mut command = Command::new("sh");
        command
            .args(["-c", &format!("{before}; exec \"$0\" \"$@\""), env!("CARGO_BIN_EXE_pc")])
            .args(arguments);
        command.current_dir(self.0.path()).env("TMPDIR", self.1.path()).stdin(Stdio::null());
        ended(started(command.stdout(Stdio::piped()).stderr(Stdio::piped())))
    }

    /// The names of the files in the directory, and of the temporary files.
    fn entries(&self) -> (Vec<String>, Vec<String>) {
        (entries(self.0.path()), entries(self.1.path()))
    }
}

fn entries(directory: &Path) -> Vec<String> {
    let all = fs::read_dir(directory).expect("a directory");
    let mut names: Vec<String> =
        all.map(|entry| entry.expect("an entry").file_name().into_string().expect("UTF-8")).collect();
    names.sort();
    names
}

fn said(output: &Output) -> String {
    String::from_utf8(output.stderr.clone()).expect("UTF-8")
}

#[track_caller]
fn ends(command: &mut Command, code: i32, message: &str) {
    let output = ended(started(command.stderr(Stdio::piped())));
    assert_eq!((output.status.code(), said(&output).as_str()), (Some(code), message));
}

fn status(command: &mut Command) -> ExitStatus {
    ended(started(command)).status
}

/// What `work` with a FIFO gives, which waits for the other end: for as long as `pc` may still come to it.
#[track_caller]
fn met<T: Send + 'static>(pc: &mut Reaped, work: impl FnOnce() -> T + Send + 'static) -> T {
    let (sender, receiver) = mpsc::channel();
    thread::spawn(move || sender.send(work()));
    let mut done = None;
    until("the other end of the FIFO", || {
        done = receiver.try_recv().ok();
        done.is_some() || pc.has_ended()
    });
    // What it has written may still be on its way.
    done.or_else(|| receiver.recv_timeout(PATIENCE / 10).ok()).expect("pc opens the FIFO")
}

/// The table of a run on standard output.
fn table(place: &Place, arguments: &[&str]) -> Vec<u8> {
    let output = place.pc(&[&["run", "euler-top"], arguments].concat()).output().expect("pc starts");
    assert!(output.status.success(), "{}", said(&output));
    output.stdout
}

#[test]
fn only_regular_files_are_replaced() {
    let place = Place::new();
    symlink("/dev/null", place.at("null.csv")).expect("a link");
    let _socket = UnixListener::bind(place.at("socket.csv")).expect("a socket");
    fs::create_dir(place.at("directory.csv")).expect("a directory");
    symlink("circle.csv", place.at("circle.csv")).expect("a link");
    assert!(Command::new("mkfifo").arg(place.at("fifo")).status().expect("mkfifo").success());
    let refuses = |arguments: &[&str], file: &str, reason: &str| {
        let message = format!("pc: cannot write {file}; nothing was computed\n  because: {reason}\n");
        ends(&mut place.pc(arguments), 2, &message);
    };
    let run = |option, file| ["run", "euler-top", option, file];
    let neither = "it is neither a regular file nor a character device or FIFO";
    refuses(&run("-o", "socket.csv"), "socket.csv", neither);
    refuses(&run("-o", "directory.csv"), "directory.csv", "it is a directory");
    refuses(&run("-o", "circle.csv"), "circle.csv", "Too many levels of symbolic links (os error 40)");
    // A checkpoint is written repeatedly, and a sweep writes a journal beside its table.
    for file in ["fifo", "null.csv"] {
        refuses(&run("--checkpoint", file), file, "it is not a regular file");
    }
    refuses(&["run", "euler-top", "--resume", "null.csv"], "null.csv", "it is not a regular file");
    refuses(
        &["sweep", "euler-top", "--vary", "I1=1:2:2", "-o", "null.csv"],
        "null.csv",
        "it is not a regular file",
    );
    assert!(status(&mut place.pc(&run("-o", "null.csv"))).success(), "written through");
    assert!(status(&mut place.pc(&run("--checkpoint", "/dev/null"))).code() == Some(2));
    for device in [place.at("null.csv"), "/dev/null".into()] {
        assert!(fs::metadata(device).expect("still there").file_type().is_char_device());
    }
    assert!(fs::symlink_metadata(place.at("null.csv")).expect("still there").is_symlink());
}

#[test]
fn a_fifo_is_written_directly() {
    let place = Place::new();
    assert!(Command::new("mkfifo").arg(place.at("a.csv")).status().expect("mkfifo").success());
    let mut child = started(place.pc(&["run", "euler-top", "-o", "a.csv"]).stderr(Stdio::null()));
    let fifo = place.at("a.csv");
    let read = met(&mut child, || fs::read(fifo)).expect("a FIFO");
    assert!(ended(child).status.success());
    assert!(read == table(&place, &[]));
    assert!(fs::metadata(place.at("a.csv")).expect("still there").file_type().is_fifo());
}

#[test]
fn links_are_followed_to_files_that_do_not_exist_yet() {
    let place = Place::new();
    fs::create_dir(place.at("results")).expect("a directory");
    symlink("results/b.csv", place.at("a.csv")).expect("a link");
    symlink("../c.csv", place.at("results/b.csv")).expect("a link");
    assert!(place.pc(&["run", "euler-top", "-o", "a.csv"]).status().expect("pc").success());
    assert!(fs::symlink_metadata(place.at("c.csv")).expect("a file").is_file());
    for link in ["a.csv", "results/b.csv"] {
        assert!(fs::symlink_metadata(place.at(link)).expect("still there").is_symlink());
    }
}

#[test]
fn the_mode_and_the_owner_of_a_replaced_file_are_kept() {
    let place = Place::new();
    let file = place.at("a.csv");
    for mode in [0o600, 0o666, 0o640] {
        fs::write(&file, "old").expect("written");
        // Only root may change the owner of a file; for other users it stays the same.
        let _ = chown(&file, Some(12345), Some(54321));
        fs::set_permissions(&file, Permissions::from_mode(mode)).expect("its own");
        let before = fs::metadata(&file).expect("a file");
        assert!(place.pc(&["run", "euler-top", "-o", "a.csv"]).status().expect("pc").success());
        let after = fs::metadata(&file).expect("a file");
        assert!(after.len() > before.len());
        assert_eq!((after.mode(), after.uid(), after.gid()), (before.mode(), before.uid(), before.gid()));
    }
    fs::set_permissions(&file, Permissions::from_mode(0o444)).expect("its own");
    let before = fs::read(&file).expect("a file");
    let message = "pc: cannot write a.csv; nothing was computed\n  because: it is read-only\n";
    ends(&mut place.pc(&["run", "euler-top", "--t-end", "1", "-o", "a.csv"]), 2, message);
    assert!(fs::read(&file).expect("a file") == before);
}

/// The limit on the size of files stands for a full disk.
const FULL: &str = "ulimit -f 16";

#[test]
fn rows_that_fit_on_a_full_disk_are_kept_beside_the_file() {
    let place = Place::new();
    fs::write(place.at("a.csv"), "old").expect("written");
    let whole = table(&place, &["--rows", "1000"]);
    let output = place.shell(FULL, &["run", "euler-top", "--rows", "1000", "-o", "a.csv"]);
    let (text, end) = (said(&output), "pc: cannot write a.csv; what could be written of it is in ");
    let (summary, message) = text.split_once(end).expect(&text);
    assert_eq!(output.status.code(), Some(6));
    assert!(summary.contains("1000 rows"), "the rest is said all the same");
    assert!(message.ends_with("a.csv.partial\n  because: File too large (os error 27)\n"), "{message}");
    let part = fs::read(place.at("a.csv.partial")).expect("a part");
    assert!(part.len() > 4000 && part.len() < whole.len(), "{} of {}", part.len(), whole.len());
    assert!(whole.starts_with(&part) && part.ends_with(b"\n"));
    assert_eq!(fs::read(place.at("a.csv")).expect("the old one"), b"old");
    assert_eq!(place.entries(), (vec!["a.csv".into(), "a.csv.partial".into()], Vec::new()), "nothing else");
    // A kept part is never overwritten.
    let again = place.shell(FULL, &["run", "euler-top", "--rows", "999", "-o", "a.csv"]);
    assert_eq!(again.status.code(), Some(6));
    assert!(fs::read(place.at("a.csv.partial")).expect("a part") == part);
    // Part of a picture is of no use, and is not kept.
    let output = place.shell(FULL, &["run", "euler-top", "--plot", "a.png"]);
    let message = "pc: cannot write a.png\n  because: File too large (os error 27)\n";
    assert!(output.status.code() == Some(6) && said(&output).ends_with(message), "{}", said(&output));
}

#[test]
fn a_result_that_a_device_refuses_is_kept_elsewhere() {
    let place = Place::new();
    symlink("/dev/full", place.at("a.csv")).expect("a link");
    let output = place.pc(&["run", "euler-top", "-o", "a.csv"]).output().expect("pc starts");
    let kept = place.entries().1.pop().expect("a file");
    let file = place.1.path().join(&kept);
    assert!(kept.starts_with("pc-") && kept.ends_with("-a.csv"), "{kept}");
    let message = format!(
        "pc: cannot write a.csv; the result is in {}\n  because: No space left on device (os error 28)\n",
        file.display()
    );
    assert!(output.status.code() == Some(6) && said(&output).ends_with(&message), "{}", said(&output));
    assert!(fs::read(&file).expect("a table") == table(&place, &[]));
}

/// The directory is removed while the program runs.
#[test]
fn a_result_whose_directory_has_gone_is_kept_elsewhere() {
    let place = Place::new();
    fs::create_dir(place.at("gone")).expect("a directory");
    assert!(Command::new("mkfifo").arg(place.at("model")).status().expect("mkfifo").success());
    let model = place.name("model");
    let mut child = started(place.pc(&["run", &model, "-o", "gone/a.json"]).stderr(Stdio::piped()));
    // This opens once pc reads the FIFO, after it has examined the place of the result.
    let mut fifo = met(&mut child, || File::create(model)).expect("a FIFO");
    fs::remove_dir_all(place.at("gone")).expect("removed");
    let text = "[coordinates]\nx = 1.0\n[lagrangian]\nkinetic = \"x'^2/2\"\n[simulation]\nt_end = 1.0\n";
    std::io::Write::write_all(&mut fifo, text.as_bytes()).expect("written");
    drop(fifo);
    let output = ended(child);
    let kept = place.entries().1.pop().expect("a file");
    let file = place.1.path().join(&kept);
    let message = format!(
        "pc: cannot write gone/a.json; the result is in {}\n  because: no file can be created in gone: entity not found\n",
        file.display()
    );
    assert!(output.status.code() == Some(6) && said(&output).ends_with(&message), "{}", said(&output));
    assert!(serde_json::from_slice::<serde_json::Value>(&fs::read(file).expect("a table")).is_ok());
}

#[test]
fn a_sweep_on_a_full_disk_continues_later() {
    let place = Place::new();
    let sweep =
        ["sweep", "euler-top", "--vary", "I1=1:2:200", "--t-end", "1", "--threads", "1", "-o", "a.csv"];
    let output = place.shell(FULL, &sweep);
    let (text, journal) = (said(&output), "a.csv.partial");
    assert_eq!(output.status.code(), Some(6), "{text}");
    let message = text.strip_prefix(&format!("pc: cannot write {journal}; the ")).expect(&text);
    let (done, rest) = message.split_once(' ').expect(message);
    let done: u64 = done.parse().expect("a number");
    assert!((10..200).contains(&done), "{done}");
    let after = "members finished before are kept there, and the same command continues after them\n  because: File too large \
                 (os error 27)\n";
    assert_eq!(rest, after);
    let output = place.pc(&sweep).output().expect("pc starts");
    assert!(output.status.success() && said(&output).contains(&format!("{done} were finished before")));
    let gone_on = fs::read(place.at("a.csv")).expect("a table");
    assert!(place.pc(&sweep).status().expect("pc starts").success());
    assert!(fs::read(place.at("a.csv")).expect("a table") == gone_on);
    assert_eq!(place.entries().0, ["a.csv"]);
}

#[test]
fn files_of_a_killed_run_are_removed_by_the_next_one() {
    let place = Place::new();
    let [left, in_use, of_another, of_somebody] =
        [".a.csv.pc-AbCdE1.part", ".a.csv.pc-AbCdE2.part", ".b.csv.pc-AbCdE1.part", ".a.csv.pc-mine.part"];
    for name in [left, in_use, of_another, of_somebody] {
        fs::write(place.at(name), "t,").expect("written");
    }
    let other = File::open(place.at(in_use)).expect("a file");
    other.try_lock().expect("the lock of a live run");
    assert!(place.pc(&["run", "euler-top", "-o", "a.csv"]).status().expect("pc").success());
    assert_eq!(place.entries().0, [in_use, of_somebody, of_another, "a.csv"]);
    // A process of another test that is just being started has the descriptor, too.
    other.unlock().expect("unlocked");
    drop(other);
    // A name of the greatest length.
    let long = format!("{}.csv", "x".repeat(251));
    assert!(place.pc(&["run", "euler-top", "-o", &long]).status().expect("pc").success());
    assert!(place.pc(&["run", "euler-top", "-o", "a.csv"]).status().expect("pc").success());
    assert_eq!(place.entries().0, [of_somebody, of_another, "a.csv", &long]);
}

#[test]
fn a_full_standard_output_is_an_error() {
    let place = Place::new();
    let full = || File::options().write(true).open("/dev/full").expect("a device");
    let message = "pc: cannot write standard output\n  because: No space left on device (os error 28)\n";
    for arguments in [
        &["--help"][..],
        &["--version"],
        &["run", "--help"],
        &["models"],
        &["models", "euler-top"],
        &["derive", "euler-top"],
        &["check", "euler-top", "--format", "json"],
    ] {
        ends(place.pc(arguments).stdout(full()), 6, message);
    }
    let output = place.pc(&["run", "euler-top"]).stdout(full()).output().expect("pc starts");
    let kept = place.1.path().join(place.entries().1.pop().expect("a file"));
    let kept_in = format!("standard output; the result is in {}", kept.display());
    let message = message.replace("standard output", &kept_in);
    assert!(output.status.code() == Some(6) && said(&output).ends_with(&message), "{}", said(&output));
    assert!(fs::read(kept).expect("a table") == table(&place, &[]));
}

#[test]
fn endless_input_is_not_read_to_the_end() {
    let place = Place::new();
    let message = |name: &str| {
        format!("pc: cannot read {name}\n  because: it has more than 64 MiB, the most that is read\n")
    };
    ends(&mut place.pc(&["check", "/dev/zero"]), 2, &message("/dev/zero"));
    let zeros = File::open("/dev/zero").expect("a device");
    ends(place.pc(&["check", "-"]).stdin(zeros), 2, &message("standard input"));
    let text = "[inputs]\nu = { file = \"/dev/zero\", column = \"u\" }\n[coordinates]\nx = 1.0\n[lagrangian]\n\
                kinetic = \"x'^2/2\"\n[forces]\nx = \"u\"\n";
    fs::write(place.at("a.toml"), text).expect("written");
    let message = "pc: a.toml:2:14: [inputs] u.file: `/dev/zero` cannot be read: it has more than 64 MiB, the most that is \
                   read\n    u = { file = \"/dev/zero\", column = \"u\" }\n                 ^^^^^^^^^^^\n  help: paths are \
                   relative to the model's file\n";
    ends(&mut place.pc(&["check", "a.toml"]), 3, message);
}

#[test]
fn rows_beyond_the_memory_limit_are_refused_in_advance() {
    let place = Place::new();
    let message = "pc: 10000000 rows of 11 numbers would take 840 MiB, more than the limit of 512 MiB; ask for fewer, give \
                   --limit-memory 840M, or for a single motion only -o FILE.csv, whose rows are written as they are computed\n";
    let arguments = ["run", "euler-top", "--rows", "10000000", "--limit-memory", "512M", "-o", "a.json"];
    ends(&mut place.pc(&arguments), 4, message);
    let message = "pc: 10000000 rows of 96 numbers would take 7325 MiB, more than the limit of 4096 MiB; ask for fewer, \
                   give --limit-memory 7325M, or for a single motion only -o FILE.csv, whose rows are written as they are computed\n";
    let arguments =
        ["sweep", "euler-top", "--vary", "I1=1:2:2", "--threads", "4", "--rows", "10000000", "-o", "a.csv"];
    ends(&mut place.pc(&arguments), 4, message);
    assert!(place.entries().0.is_empty());
}

/// Many rows, with a memory limit below their size.
const MANY: [&str; 6] = ["run", "euler-top", "--rows", "200000", "--limit-memory", "16M"];

#[test]
fn rows_beyond_the_memory_limit_are_written_during_the_run() {
    let place = Place::new();
    let held = place.pc(&["run", "euler-top", "--rows", "200000"]).output().expect("pc starts");
    let message = "pc: 200000 rows of 11 numbers would take 17 MiB, more than the limit of 16 MiB; ask for fewer, give \
                   --limit-memory 17M, or for a single motion only -o FILE.csv, whose rows are written as they are computed\n";
    ends(&mut place.pc(&MANY), 4, message);
    let given = place.pc(&[&MANY[..], &["-o", "a.csv"]].concat()).output().expect("pc starts");
    assert!(given.status.success(), "{}", said(&given));
    assert!(fs::read(place.at("a.csv")).expect("a table") == held.stdout, "the same bytes");
    let without_work = |output: &Output| -> Vec<String> {
        said(output).lines().filter(|line| !line.contains("  work ")).map(str::to_owned).collect()
    };
    assert_eq!(without_work(&given), without_work(&held));
}

/// The ending and the last row of a motion that an event ends, and of one that fails.
#[test]
fn rows_written_during_the_run_end_with_the_motion() {
    let place = Place::new();
    let text = "[coordinates]\ny = 1.0\n[lagrangian]\nkinetic = \"y'^2/2\"\npotential = \"POTENTIAL\"\n[events.low]\nwhen \
                = \"y - 0.4\"\nterminal = true\n[simulation]\nt_end = 3.0\nsamples = 100000\n";
    for (potential, code) in [("y", 0), ("y + sqrt(y - 0.5)/1000", 5)] {
        fs::write(place.at("m.toml"), text.replace("POTENTIAL", potential)).expect("written");
        let held = place.pc(&["run", "m.toml"]).output().expect("pc starts");
        let run = ["run", "m.toml", "--limit-memory", "4M", "-o", "a.csv"];
        let given = place.pc(&run).output().expect("pc starts");
        assert_eq!((held.status.code(), given.status.code()), (Some(code), Some(code)), "{}", said(&given));
        assert!(held.stdout.len() > 1_000_000);
        assert!(fs::read(place.at("a.csv")).expect("a table") == held.stdout);
    }
}

#[test]
fn rows_written_during_the_run_are_kept_on_a_full_disk() {
    let place = Place::new();
    fs::write(place.at("a.csv"), "old").expect("written");
    let held = place.pc(&["run", "euler-top", "--rows", "200000"]).output().expect("pc starts").stdout;
    let output = place.shell("ulimit -f 6000", &[&MANY[..], &["-o", "a.csv"]].concat());
    let message = "pc: cannot write a.csv; what could be written of it is in ";
    assert!(output.status.code() == Some(6) && said(&output).contains(message), "{}", said(&output));
    let part = fs::read(place.at("a.csv.partial")).expect("a part");
    assert!(part.len() > 2_000_000 && part.ends_with(b"\n") && held.starts_with(&part), "{}", part.len());
    assert_eq!(place.entries().0, ["a.csv", "a.csv.partial"]);
    assert_eq!(fs::read(place.at("a.csv")).expect("the old one"), b"old");
}

/// By itself, the signal of the system at the limit would end the program without a word.
#[test]
fn a_limit_on_the_size_of_files_is_an_error_of_the_result() {
    let place = Place::new();
    fs::write(place.at("a.json"), "old").expect("written");
    let run = ["run", "euler-top", "--rows", "1000"];
    let refused = |before: &str, arguments: &[&str], file: &str| {
        let output = place.shell(before, &[&run[..], arguments].concat());
        let message = format!("pc: cannot write {file}\n  because: File too large (os error 27)\n");
        let said = said(&output);
        assert!(output.status.code() == Some(6) && said.ends_with(&message), "{}: {said}", output.status);
    };
    refused(FULL, &["-o", "a.json"], "a.json");
    assert_eq!(fs::read(place.at("a.json")).expect("the old one"), b"old");
    refused(&format!("exec > table; {FULL}"), &[], "standard output");
    assert_eq!(place.entries(), (vec!["a.json".into(), "table".into()], Vec::new()));
}

#[test]
fn leftovers_of_a_run_killed_while_writing_are_removed_by_the_next_one() {
    let place = Place::new();
    fs::write(place.at("a.csv"), "old").expect("written");
    for _ in 0..5 {
        let long = ["run", "euler-top", "--t-end", "1e7", "--rows", "1000000", "-o", "a.csv"];
        // What the run before has left is there until this one begins.
        let left = place.entries().0;
        let mut child = started(place.pc(&long).stderr(Stdio::null()));
        let has_rows = |name: &String| {
            let is_own = name.ends_with(".part") && !left.contains(name);
            is_own && fs::metadata(place.at(name)).is_ok_and(|part| part.len() > 0)
        };
        until("rows on disk", || place.entries().0.iter().any(has_rows) || child.has_ended());
        child.signal("-KILL");
        let status = ended(child).status;
        assert!(status.signal().is_some(), "{status}");
        let names = place.entries().0;
        assert!(names.len() == 2 && names[0].ends_with(".part"), "{names:?}");
        assert!(fs::metadata(place.at(&names[0])).expect("a part").len() > 0, "it has rows");
        assert_eq!(fs::read(place.at("a.csv")).expect("the old one"), b"old");
    }
    assert!(place.pc(&["run", "euler-top", "-o", "a.csv"]).status().expect("pc").success());
    assert_eq!(place.entries().0, ["a.csv"]);
}
