//! `pc run --checkpoint` and `--resume`: an interrupted run ends as if it had not been interrupted.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Output, Stdio};
use std::thread;
use std::time::Duration;

use crate::patience::{Reaped, ended, started, until};

fn pc(arguments: &[String]) -> Command {
    let mut command = Command::new(env!("CARGO_BIN_EXE_pc"));
    command.args(arguments).stdin(Stdio::null()).stderr(Stdio::piped());
    command
}

fn stderr(output: &Output) -> String {
    String::from_utf8(output.stderr.clone()).expect("UTF-8")
}

/// A run of `model` in a temporary directory.
struct Run {
    directory: tempfile::TempDir,
    options: Vec<String>,
}

impl Run {
    fn new(model: &str, options: &[&str]) -> Run {
        let directory = tempfile::tempdir().expect("a directory");
        let options = [&["run", model], options].concat();
        Run { directory, options: options.into_iter().map(str::to_owned).collect() }
    }

    fn at(&self, name: &str) -> PathBuf {
        self.directory.path().join(name)
    }

    /// Arguments for a run into the file `output`, with `how` (`--checkpoint` or `--resume`) for
    /// the file `checkpoint`.
    fn arguments(&self, output: &str, how: &str, checkpoint: &str, more: &[&str]) -> Vec<String> {
        let mut arguments = self.options.clone();
        for (option, file) in [("-o", output), (how, checkpoint)] {
            arguments.extend([option.to_owned(), self.at(file).display().to_string()]);
        }
        arguments.extend(more.iter().map(ToString::to_string));
        arguments
    }

    /// The file of a run that succeeds.
    #[track_caller]
    fn whole(&self, output: &str, how: &str, checkpoint: &str, more: &[&str]) -> Vec<u8> {
        let output_of = pc(&self.arguments(output, how, checkpoint, more)).output().expect("pc runs");
        assert!(output_of.status.success(), "{}", stderr(&output_of));
        fs::read(self.at(output)).expect("a table")
    }

    #[track_caller]
    fn refused(&self, checkpoint: &str, more: &[&str], mention: &str) {
        let before = fs::read(self.at(checkpoint)).ok();
        let output =
            pc(&self.arguments("refused.csv", "--resume", checkpoint, more)).output().expect("pc runs");
        let text = stderr(&output);
        assert_eq!(output.status.code(), Some(2), "{text}");
        assert!(text.contains(mention) && !text.contains("panicked"), "{mention}: {text}");
        assert!(!self.at("refused.csv").exists());
        assert_eq!(fs::read(self.at(checkpoint)).ok(), before, "it is left as it was");
    }
}

/// Signals `child` once `path` differs from `before`, unless the child ends first.
#[cfg(unix)]
fn signalled(mut child: Reaped, signal: &str, path: &Path, before: &[u8]) -> Output {
    let is_other = || fs::read(path).is_ok_and(|bytes| bytes != before);
    until("another checkpoint", || is_other() || child.has_ended());
    child.signal(signal);
    ended(child)
}

/// Begins the run and continues it, ended by a signal each time; how often a signal came before its end.
#[cfg(unix)]
fn kills(run: &Run, signals: &[&str]) -> u32 {
    let (mut how, mut kills, mut before) = ("--checkpoint", 0, Vec::new());
    for signal in signals {
        let child = started(&mut pc(&run.arguments("b.json", how, "b.check", &[])));
        let output = signalled(child, signal, &run.at("b.check"), &before);
        if output.status.code() == Some(130) {
            assert!(stderr(&output).contains("--resume"), "{}", stderr(&output));
        }
        kills += u32::from(!output.status.success());
        before = fs::read(run.at("b.check")).expect("a checkpoint");
        how = "--resume";
    }
    kills
}

/// A run of the model to ever later ends, until `least` signals come before its end and it gives the same bytes all the same; then
/// its bytes.
#[cfg(unix)]
#[track_caller]
fn killed_often(model: &str, options: &[&str], t_end: f64, signals: &[&str], least: u32) -> (Run, Vec<u8>) {
    for k in 0..8 {
        let t_end = (t_end * f64::from(1 << k)).to_string();
        let run = Run::new(model, &[options, &["--t-end", &t_end]].concat());
        let undisturbed = run.whole("a.json", "--checkpoint", "a.check", &[]);
        let kills = kills(&run, signals);
        assert!(run.whole("b.json", "--resume", "b.check", &[]) == undisturbed);
        if kills >= least {
            return (run, undisturbed);
        }
    }
    panic!("{model}: all runs are over too soon for this test");
}

#[cfg(unix)]
#[test]
fn a_run_killed_again_and_again_gives_the_same_bytes() {
    let options = ["--rows", "40", "--every", "100", "--rtol", "1e-8"];
    let signals = ["-KILL", "-TERM", "-INT", "-KILL", "-KILL", "-TERM", "-KILL", "-INT"];
    let (run, undisturbed) = killed_often("heavy-top-lagrange", &options, 60_000.0, &signals, 4);
    // From the last checkpoint of a complete run, with another place for the next ones.
    let again =
        run.whole("b.json", "--resume", "a.check", &["--checkpoint", run.at("c").to_str().expect("UTF-8")]);
    assert!(again == undisturbed);
}

/// Two risks: momenta are solved for velocities by iterations that begin at the last solution; a
/// projection moves the states.
#[cfg(unix)]
#[test]
fn a_resumed_run_depends_only_on_the_checkpoint() {
    let held = "[coordinates]\nx = 1.0\ny = 0.0\n[constraints]\nrod = \"x^2 + y^2 - 1\"\n[lagrangian]\n\
                kinetic = \"(x'^2 + y'^2)/2\"\npotential = \"y\"\n";
    let implicit = "[coordinates]\nx = 1.0\n[lagrangian]\nlagrangian = \"x'^2/2 + x'^4/4 - x^2/2\"\n";
    let file = tempfile::NamedTempFile::new().expect("a file");
    let model = file.path().to_str().expect("UTF-8");
    for (text, form, method) in [
        (held, "poincare", "auto"),
        (held, "poincare", "adams"),
        (held, "poincare", "bdf"),
        (implicit, "canonical", "auto"),
        (implicit, "canonical", "adams"),
        (implicit, "canonical", "bdf"),
    ] {
        fs::write(model, text).expect("written");
        let options = [
            "--t-end", "60", "--rows", "30", "--every", "40", "--form", form, "--method", method, "--rtol",
            "1e-7",
        ];
        let run = Run::new(model, &options);
        let undisturbed = run.whole("a.csv", "--checkpoint", "a.check", &[]);
        let child = started(&mut pc(&run.arguments("b.csv", "--checkpoint", "b.check", &[])));
        let first = signalled(child, "-INT", &run.at("b.check"), &[]);
        assert!(
            run.whole("b.csv", "--resume", "b.check", &[]) == undisturbed,
            "{form} {method}: {}",
            stderr(&first)
        );
        // The last checkpoint lies inside the motion.
        assert!(run.whole("c.csv", "--resume", "a.check", &[]) == undisturbed, "{form} {method}");
    }
}

#[test]
fn checkpoints_change_a_run_within_its_tolerance() {
    let run = Run::new("heavy-top-lagrange", &["--t-end", "10", "--rows", "11"]);
    let saved = run.whole("a.csv", "--checkpoint", "a.check", &["--every", "50"]);
    let plain = run.whole("a.csv", "--plot", "a.svg", &[]);
    let numbers = |csv: &[u8]| -> Vec<f64> {
        let text = String::from_utf8(csv.to_vec()).expect("UTF-8");
        text.lines()
            .skip(1)
            .flat_map(|line| line.split(',').map(|cell| cell.parse().expect("a number")))
            .collect()
    };
    let (saved, plain) = (numbers(&saved), numbers(&plain));
    assert!(saved != plain && saved.len() == plain.len());
    // Local errors of 1e-9 in a few hundred steps, which grow no faster than linearly.
    assert!(saved.iter().zip(&plain).all(|(a, b)| (a - b).abs() < 1e-5));
}

#[test]
fn foreign_checkpoints_are_refused() {
    let run = Run::new("heavy-top-lagrange", &["--t-end", "30", "--rows", "5"]);
    let undisturbed = run.whole("a.csv", "--checkpoint", "a.check", &["--every", "20"]);
    let bytes = fs::read(run.at("a.check")).expect("a checkpoint");
    for k in 0..50 {
        let mut damaged = bytes.clone();
        let place = (k * 7919 + 13) % bytes.len();
        if k % 2 == 0 {
            damaged.truncate(place);
        } else {
            damaged[place] ^= 1 << (k % 8);
        }
        fs::write(run.at("b.check"), &damaged).expect("written");
        run.refused("b.check", &[], "start afresh without --resume");
    }
    fs::write(run.at("b.check"), "t,x\n0,1\n").expect("written");
    run.refused("b.check", &[], "it is not a checkpoint");
    run.refused("missing.check", &[], "the file cannot be read");
    for (more, mention) in [
        (["--rtol", "1e-6"], "--rtol 1e-9, where now it is 1e-6"),
        (["--every", "21"], "--every 20, where now it is 21"),
        (["--set", "I3=2"], "the parameter I3 = 0.5, where now it is 2"),
        (["--form", "canonical"], "--form poincare, where now it is canonical"),
        (["--method", "bdf"], "--method auto, where now it is bdf"),
    ] {
        run.refused("a.check", &more, mention);
    }
    let other = Run::new("heavy-top-euler", &["--t-end", "30", "--rows", "5"]);
    fs::copy(run.at("a.check"), other.at("a.check")).expect("copied");
    other.refused("a.check", &[], "the checkpoint is from a run with");
    let nowhere = Run::new("euler-top", &["--every", "10"]);
    let output = pc(&nowhere.options).output().expect("pc runs");
    assert!(output.status.code() == Some(2) && stderr(&output).contains("--checkpoint FILE"));
    // The file contains the value of --every.
    assert!(run.whole("b.csv", "--resume", "a.check", &[]) == undisturbed);
}

/// The checkpoints seen while a run writes them, and its output. On a busy machine a run may end
/// before two are seen, and is then repeated.
fn seen(run: &Run, output: &str) -> (Vec<Vec<u8>>, Vec<u8>) {
    let mut all: Vec<Vec<u8>> = Vec::new();
    let look = |all: &mut Vec<Vec<u8>>| {
        let now = fs::read(run.at("seen.check")).unwrap_or_default();
        if !now.is_empty() && all.last() != Some(&now) {
            all.push(now);
        }
    };
    for _ in 0..20 {
        let arguments = run.arguments(output, "--checkpoint", "seen.check", &[]);
        all.clear();
        let _ = fs::remove_file(run.at("seen.check"));
        let mut child = started(&mut pc(&arguments));
        while !child.has_ended() {
            look(&mut all);
            thread::sleep(Duration::from_millis(1));
        }
        look(&mut all);
        let output_of = ended(child);
        assert!(output_of.status.success(), "{}", stderr(&output_of));
        if all.len() > 1 {
            break;
        }
    }
    (all, fs::read(run.at(output)).expect("a table"))
}

const WITH_EVENTS: [(&str, &[&str]); 4] = [
    ("bouncing-ball", &["--set", "e=1", "--t-end", "8000"]),
    ("stick-slip-block", &["--t-end", "6000"]),
    ("rocking-block", &["--set", "r=1", "--t-end", "12000"]),
    ("stick-slip-sleigh", &["--set", "V=0.5", "--t-end", "2500"]),
];

/// Tables and times of events are the same for bouncing, sticking and rocking from any checkpoint.
#[test]
fn a_run_with_events_gives_the_same_bytes_from_each_checkpoint() {
    for (model, options) in WITH_EVENTS {
        let run = Run::new(model, &[options, &["--rows", "40", "--every", "97", "--rtol", "1e-7"]].concat());
        let (checkpoints, json) = seen(&run, "a.json");
        let csv = run.whole("a.csv", "--checkpoint", "a.check", &[]);
        let text = String::from_utf8(json.clone()).expect("UTF-8");
        assert!(text.matches("\"time\"").count() > 100, "{model} has events");
        assert!(checkpoints.len() > 1, "{model} is over too soon: {}", checkpoints.len());
        for bytes in checkpoints.iter().step_by(checkpoints.len().div_ceil(4)).chain(checkpoints.last()) {
            for (output, expected) in [("b.json", &json), ("b.csv", &csv)] {
                fs::write(run.at("b.check"), bytes).expect("written");
                assert!(run.whole(output, "--resume", "b.check", &[]) == *expected, "{model}: {output}");
            }
        }
    }
}

#[cfg(unix)]
#[test]
fn a_run_with_events_killed_again_and_again_gives_the_same_bytes() {
    let options = ["--set", "e=1", "--rows", "40", "--every", "97"];
    killed_often("bouncing-ball", &options, 3000.0, &["-KILL", "-INT", "-TERM", "-KILL"], 2);
}

#[test]
fn foreign_checkpoints_of_runs_with_events_are_refused() {
    let run = Run::new("rocking-block", &["--every", "20"]);
    let undisturbed = run.whole("a.csv", "--checkpoint", "a.check", &[]);
    let bytes = fs::read(run.at("a.check")).expect("a checkpoint");
    for k in 0..50 {
        let mut damaged = bytes.clone();
        let place = (k * 7919 + 13) % bytes.len();
        if k % 2 == 0 {
            damaged.truncate(place);
        } else {
            damaged[place] ^= 1 << (k % 8);
        }
        fs::write(run.at("b.check"), &damaged).expect("written");
        run.refused("b.check", &[], "start afresh without --resume");
    }
    // A checkpoint of an earlier version of the format.
    let old = [b"pc checkpoint 2\n", &bytes[16..]].concat();
    fs::write(run.at("b.check"), old).expect("written");
    run.refused(
        "b.check",
        &[],
        "it is a checkpoint of version 2 of the format, not 6; start afresh without --resume",
    );
    let other = Run::new("bouncing-ball", &["--every", "20"]);
    fs::copy(run.at("a.check"), other.at("a.check")).expect("copied");
    other.refused("a.check", &[], "the checkpoint is from a run with");
    assert!(run.whole("b.csv", "--resume", "a.check", &[]) == undisturbed);
}

/// A run that events end, by a terminal event or by accumulation, ends in the same way when
/// resumed.
#[test]
fn a_resumed_run_that_an_event_ended_ends_in_the_same_way() {
    let fall = "[coordinates]\ny = 1.0\n[lagrangian]\nkinetic = \"y'^2/2\"\npotential = \"y\"\n\
                [events.floor]\nwhen = \"y\"\nterminal = true\n[simulation]\nt_end = 3.0\n";
    let file = tempfile::NamedTempFile::new().expect("a file");
    fs::write(file.path(), fall).expect("written");
    let run = Run::new(file.path().to_str().expect("UTF-8"), &["--every", "10"]);
    let ended = run.whole("a.json", "--checkpoint", "a.check", &[]);
    assert!(
        String::from_utf8_lossy(&ended).contains("\"ending\":\"event\""),
        "{}",
        String::from_utf8_lossy(&ended)
    );
    assert!(run.whole("b.json", "--resume", "a.check", &[]) == ended);

    let run = Run::new("bouncing-ball", &["--t-end", "9", "--set", "e=0.5", "--every", "50"]);
    let failed = |output: &str, how| {
        let output_of = pc(&run.arguments(output, how, "a.check", &[])).output().expect("pc runs");
        assert_eq!(output_of.status.code(), Some(5));
        assert!(
            stderr(&output_of).contains("the event bounce occurs at ever shorter intervals near t = 1.35457")
        );
        fs::read(run.at(output)).expect("a table")
    };
    assert!(failed("a.csv", "--checkpoint") == failed("b.csv", "--resume"));
}

/// A ball with the energy (y'² + x'²)/2 + 9.81 y, and this reset at a bounce.
fn ball(reset: &str) -> tempfile::NamedTempFile {
    let text = format!(
        "[coordinates]\ny = 1.0\nx = 0.0\n[quasi_velocities]\n\"x'\" = 1.0\n[lagrangian]\n\
         kinetic = \"(y'^2 + x'^2)/2\"\npotential = \"9.81*y\"\n[events.bounce]\nwhen = \"y\"\n\
         direction = \"falling\"\nreset = {reset}\n"
    );
    let file = tempfile::NamedTempFile::new().expect("a file");
    fs::write(file.path(), text).expect("written");
    file
}

/// The columns t and energy.
fn energies(csv: &[u8]) -> Vec<(f64, f64)> {
    let text = std::str::from_utf8(csv).expect("UTF-8");
    let mut lines = text.lines().map(|line| line.split(',').collect::<Vec<_>>());
    let head = lines.next().expect("a head");
    let [t, energy] = ["t", "energy"].map(|name| head.iter().position(|&h| h == name).expect("a column"));
    lines.map(|row| [t, energy].map(|i| row[i].parse().expect("a number")).into()).collect()
}

/// A kept integral has a new value after each reset, and the legs after it keep this value.
#[test]
fn the_kept_energy_is_that_after_the_last_bounce() {
    let file = ball("{ \"y'\" = \"-0.8*y'\" }");
    let options = ["--t-end", "2", "--rows", "41", "--every", "10", "--project", "energy"];
    let run = Run::new(file.path().to_str().expect("UTF-8"), &options);
    let csv = run.whole("a.csv", "--checkpoint", "a.check", &[]);
    // The ball lands after √(2/9.81), and a flight that begins with the speed v takes 2 v/9.81.
    let landing = (2.0_f64 / 9.81).sqrt();
    let (mut next, mut part) = (landing, 1.0);
    for (t, energy) in energies(&csv) {
        while next < t {
            part *= 0.8;
            next += 2.0 * part * landing;
        }
        // Keeping the energy changes x' and y' by errors of 1e-9 in each of a few hundred steps.
        let expected = 9.81 * part * part + 0.5;
        assert!((energy - expected).abs() < 1e-6, "{energy} at {t}, not {expected}");
    }
    assert!(part < 0.6, "it has bounced more than twice");
}

/// The checkpoint contains the value kept since the last reset: x' alternates between 1 and 2.
#[test]
fn a_run_that_keeps_the_energy_gives_the_same_bytes_from_each_checkpoint() {
    let file = ball("{ \"y'\" = \"-y'\", \"x'\" = \"3 - x'\" }");
    let options =
        ["--t-end", "4000", "--rows", "60", "--every", "97", "--rtol", "1e-7", "--project", "energy"];
    let run = Run::new(file.path().to_str().expect("UTF-8"), &options);
    let (checkpoints, csv) = seen(&run, "a.csv");
    assert!(checkpoints.len() > 1, "it is over too soon: {}", checkpoints.len());
    for bytes in checkpoints.iter().step_by(checkpoints.len().div_ceil(4)).chain(checkpoints.last()) {
        fs::write(run.at("b.check"), bytes).expect("written");
        assert!(run.whole("b.csv", "--resume", "b.check", &[]) == csv);
    }
    let (mut slow, mut fast) = (0, 0);
    for (t, energy) in energies(&csv) {
        // The tolerance of 1e-7 over about ten thousand steps.
        if (energy - 10.31).abs() < 0.01 {
            slow += 1;
        } else if (energy - 11.81).abs() < 0.01 {
            fast += 1;
        } else {
            panic!("{energy} at {t}");
        }
    }
    assert!(slow > 9 && fast > 9, "{slow} {fast}");
}
