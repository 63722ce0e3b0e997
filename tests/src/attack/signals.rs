//! Signals, limits on the size of files and readers that go away, at any moment: what was there is as it was or wholly replaced.

use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::io::{self, Read};
use std::path::Path;
use std::process::{Command, Stdio};
use std::thread;
use std::time::{Duration, Instant};

use crate::attack::victim::{Ended, Finding, Pardon, Victim};
use crate::fuzz::random::Random;

/// What every command finds beside it: a robot, a model of one, and a shard.
const MAKE: &[&[&str]] = &[
    &["new", "joints", "-o", "arm.toml"],
    &["export", "arm.toml", "-o", "robot.urdf"],
    &[
        "sweep",
        "heavy-top-lagrange",
        "--t-end",
        "1",
        "--vary",
        "mg=5:15:2000",
        "-o",
        "all.csv",
        "--shard",
        "1/1",
    ],
];
/// What files hold before.
const BEFORE: &[u8] = b"before";
const RUN: &[&str] = &["run", "heavy-top-lagrange", "--t-end", "40", "--no-verify"];
const SWEEP: &[&str] = &["sweep", "heavy-top-lagrange", "--t-end", "2", "--vary", "mg=5:15:400"];

/// A command and the files that it writes.
struct Writing(&'static [&'static [&'static str]], &'static [&'static str]);

const WRITINGS: &[Writing] = &[
    Writing(&[RUN, &["--rows", "4001", "-o", "out.csv"]], &["out.csv"]),
    Writing(&[RUN, &["--rows", "40001", "-o", "out.csv"]], &["out.csv"]),
    Writing(&[RUN, &["--rows", "4001", "-o", "out.json", "--plot", "out.svg"]], &["out.json", "out.svg"]),
    Writing(&[RUN, &["--rows", "4001", "-o", "out.npz", "--plot", "out.pdf"]], &["out.npz", "out.pdf"]),
    Writing(
        &[RUN, &["--rows", "4001", "-o", "out.parquet", "--plot", "out.png"]],
        &["out.parquet", "out.png"],
    ),
    Writing(&[RUN, &["-o", "out.csv", "--every", "100", "--checkpoint", "point"]], &["out.csv"]),
    Writing(&[&["report", "euler-top", "-o", "out.html"]], &["out.html"]),
    Writing(&[&["animate", "tilted-disk", "-o", "out.html"]], &["out.html"]),
    Writing(&[&["animate", "tilted-disk", "--t-end", "1", "-o", "out.gif"]], &["out.gif"]),
    Writing(&[SWEEP, &["-o", "out.csv"]], &["out.csv"]),
    Writing(&[SWEEP, &["-o", "out.npz", "--plot", "out.svg"]], &["out.npz", "out.svg"]),
    Writing(&[SWEEP, &["-o", "out.json", "--rows", "20"]], &["out.json"]),
    Writing(
        &[&["sweep", "cart-pole", "--of", "check", "--vary", "l=0.5:1:5"], &["-o", "out.parquet"]],
        &["out.parquet"],
    ),
    Writing(
        &[&["merge", "all.csv.shard-1-of-1", "-o", "out.csv", "--plot", "out.svg"]],
        &["out.csv", "out.svg"],
    ),
    Writing(&[&["linearize", "cart-pole", "-o", "out.mat"]], &["out.mat"]),
    Writing(
        &[&["linearize", "cart-pole", "--vary", "l=0.5:1:5"], &["-o", "out.csv", "--plot", "out.svg"]],
        &["out.csv", "out.svg"],
    ),
    Writing(&[&["equilibria", "furuta-pendulum", "--starts", "50", "-o", "out.json"]], &["out.json"]),
    Writing(&[&["emit", "puma-560", "--lang", "c", "-o", "out"]], &["out/puma_560.c", "out/puma_560.h"]),
    Writing(&[&["emit", "puma-560", "--lang", "rust", "-o", "out"]], &["out/puma_560.rs"]),
    Writing(&[&["emit", "euler-top", "--fmu", "2", "-o", "out.fmu"]], &["out.fmu"]),
    Writing(&[&["emit", "puma-560", "--fmu", "3", "--sources-only", "-o", "out.fmu"]], &["out.fmu"]),
    Writing(&[&["export", "arm.toml", "-o", "out.urdf"]], &["out.urdf"]),
    Writing(&[&["import", "robot.urdf", "-o", "out.toml"]], &["out.toml"]),
    Writing(&[&["schema", "-o", "out.json"]], &["out.json"]),
    Writing(&[&["man", "-o", "out"]], &["out/pc.1", "out/pc-run.1", "out/pc-sweep.1"]),
];

/// Commands that print, and what they write beside that.
const PRINTING: &[Writing] = &[
    Writing(&[RUN], &[]),
    Writing(&[RUN, &["--plot", "out.svg"]], &["out.svg"]),
    Writing(&[&["derive", "puma-560"]], &[]),
    Writing(&[&["check", "puma-560", "--format", "json"]], &[]),
    Writing(&[&["theory", "heavy-top-euler"]], &[]),
    Writing(&[&["linearize", "cart-pole", "--format", "csv"]], &[]),
    Writing(&[&["equilibria", "furuta-pendulum"]], &[]),
    Writing(&[&["report", "tilted-disk"]], &[]),
    Writing(&[&["animate", "tilted-disk"]], &[]),
    Writing(&[&["compare", "heavy-top-euler", "--form", "poincare,canonical"]], &[]),
    Writing(&[&["bench", "heavy-top-euler", "--seconds", "0.1"]], &[]),
    Writing(&[&["emit", "puma-560", "--lang", "rust", "-o", "-"]], &[]),
    Writing(&[&["export", "arm.toml"]], &[]),
    Writing(&[&["import", "robot.urdf"]], &[]),
    Writing(&[&["models", "--long"]], &[]),
    Writing(&[&["new", "joints"]], &[]),
    Writing(&[&["schema"]], &[]),
    Writing(&[&["completions", "zsh"]], &[]),
    Writing(&[&["man", "run"]], &[]),
];

/// What comes in between.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Blow {
    /// A signal, by its number and its name.
    Signal(i32, &'static str),
    /// Two signals, the second while the first is heeded.
    Twice,
    /// No file may be longer than so many blocks of 512 bytes.
    Size(usize),
}

/// Strikes one command so many times, each time in another way.
///
/// # Errors
/// If files cannot be made.
pub fn signals(victim: &Victim, count: usize, random: &mut Random) -> io::Result<Vec<Finding>> {
    for command in MAKE {
        match victim.run(command)? {
            Ok(ended) if ended.code == Some(0) => {}
            Ok(ended) => return Ok(vec![ended.finding("not done")]),
            Err(finding) => return Ok(vec![finding]),
        }
    }
    fs::create_dir(victim.file("tmp"))?;
    fs::create_dir(victim.file("out"))?;
    let mut findings = Vec::new();
    if random.chance(25) {
        let writing = random.pick(PRINTING);
        for _ in 0..count {
            findings.extend(writing.unread(victim, random)?);
        }
        return Ok(findings);
    }
    let writing = random.pick(WRITINGS);
    let whole = match writing.whole(victim)? {
        Ok(whole) => whole,
        Err(finding) => return Ok(vec![finding]),
    };
    for _ in 0..count {
        findings.extend(writing.struck(victim, &whole, random)?);
    }
    Ok(findings)
}

/// What an undisturbed command leaves, and how long it takes.
struct Whole {
    files: BTreeMap<&'static str, Vec<u8>>,
    beside: BTreeSet<String>,
    time: Duration,
}

impl Writing {
    fn arguments(&self) -> Vec<&'static str> {
        self.0.concat()
    }

    fn is_sweep(&self) -> bool {
        self.0[0][0] == "sweep"
    }

    fn whole(&self, victim: &Victim) -> io::Result<Result<Whole, Finding>> {
        let begin = Instant::now();
        match victim.run(&self.arguments())? {
            Err(finding) => return Ok(Err(finding)),
            Ok(ended) if ended.code != Some(0) => return Ok(Err(ended.finding("not done"))),
            Ok(_) => {}
        }
        let time = begin.elapsed();
        let read = |&name: &&'static str| Ok((name, fs::read(victim.file(name))?));
        let files = self.1.iter().map(read).collect::<io::Result<_>>()?;
        let _ = fs::remove_file(victim.file("point"));
        Ok(Ok(Whole { files, beside: listed(victim)?, time }))
    }

    /// One blow, and what is wrong after it.
    fn struck(&self, victim: &Victim, whole: &Whole, random: &mut Random) -> io::Result<Vec<Finding>> {
        for name in self.1 {
            fs::write(victim.file(name), BEFORE)?;
        }
        let largest = whole.files.values().map(Vec::len).max().unwrap_or(0);
        let blow = match random.below(10) {
            0..=2 => Blow::Signal(2, "INT"),
            3 | 4 => Blow::Signal(15, "TERM"),
            5 => Blow::Signal(1, "HUP"),
            6 | 7 => Blow::Twice,
            _ => Blow::Size(random.below(largest / 512 + 8)),
        };
        let ended = match self.blown(victim, whole, blow, random)? {
            Ok(ended) => ended,
            Err(finding) => return Ok(vec![finding]),
        };
        let mut wrong = self.wrong(victim, whole, blow, &ended)?;
        let has_point = victim.file("point").exists();
        let again = if has_point {
            [&self.arguments()[..], &["--resume", "point"]].concat()
        } else {
            self.arguments()
        };
        match victim.run(&again)? {
            Err(finding) => return Ok(vec![finding]),
            Ok(again) if again.code != Some(0) => wrong.push("cannot be done again".to_owned()),
            Ok(_) => {
                for (name, bytes) in &whole.files {
                    if fs::read(victim.file(name))? != *bytes {
                        wrong.push(format!("{name} is another one when it is done again"));
                    }
                }
                wrong.extend(self.left(victim, whole, true)?);
            }
        }
        for name in listed(victim)?.difference(&whole.beside) {
            fs::remove_file(victim.file(name))?;
        }
        Ok(wrong.into_iter().map(|what| ended.finding(format!("{blow:?}: {what}"))).collect())
    }

    fn blown(
        &self,
        victim: &Victim,
        whole: &Whole,
        blow: Blow,
        random: &mut Random,
    ) -> io::Result<Result<Ended, Finding>> {
        let prelude = match blow {
            Blow::Size(blocks) => format!("export TMPDIR=tmp; ulimit -f {blocks}"),
            _ => "export TMPDIR=tmp".to_owned(),
        };
        let child = victim.begin_after(&prelude, &self.arguments())?;
        let wait = whole.time.mul_f64(random.number(0.0, 1.1));
        let signals: &[(i32, &str)] = match blow {
            Blow::Size(_) => &[],
            Blow::Signal(number, name) => &[(number, name)],
            Blow::Twice => &[(2, "INT"), (15, "TERM")],
        };
        if !signals.is_empty() {
            thread::sleep(wait);
        }
        for &(_, name) in signals {
            let pause = Duration::from_micros(random.below(20_000) as u64);
            Command::new("kill")
                .args(["-s", name, &child.id().to_string()])
                .stderr(Stdio::null())
                .status()?;
            thread::sleep(pause);
        }
        let numbers: Vec<i32> = signals.iter().map(|&(number, _)| number).collect();
        // The second signal ends the program at once, and what it says goes to a file.
        let pardon = Pardon { signals: &numbers, silence: matches!(blow, Blow::Twice | Blow::Size(0)) };
        victim.end(child, &self.arguments(), pardon)
    }

    /// What is wrong with the end of a command that was struck, and with what it has left.
    fn wrong(&self, victim: &Victim, whole: &Whole, blow: Blow, ended: &Ended) -> io::Result<Vec<String>> {
        let mut wrong = Vec::new();
        let may_end = match blow {
            Blow::Size(_) => [Some(0), Some(6)].contains(&ended.code),
            _ => [None, Some(0), Some(130)].contains(&ended.code),
        };
        if !may_end {
            wrong.push(format!("exit code {:?}", ended.code));
        }
        for (name, bytes) in &whole.files {
            let is = fs::read(victim.file(name))?;
            if is != *bytes && (is != BEFORE || ended.code == Some(0)) {
                wrong.push(format!("{name} has {} bytes after exit code {:?}", is.len(), ended.code));
            }
        }
        let is_orderly = ended.code.is_some() && blow != Blow::Twice;
        if is_orderly {
            wrong.extend(self.left(victim, whole, ended.code == Some(0))?);
        }
        Ok(wrong)
    }

    /// Files that nobody needs; parts of what is not done are needed.
    fn left(&self, victim: &Victim, whole: &Whole, is_done: bool) -> io::Result<Option<String>> {
        let is_needed = |name: &String| {
            let is_part = name.ends_with(".partial") || name.starts_with("tmp/");
            name == "point" || is_part && !(is_done && self.is_sweep())
        };
        let left: Vec<String> =
            listed(victim)?.difference(&whole.beside).filter(|name| !is_needed(name)).cloned().collect();
        Ok((!left.is_empty()).then(|| format!("left lying about: {}", left.join(", "))))
    }

    /// A reader that goes away after some bytes.
    fn unread(&self, victim: &Victim, random: &mut Random) -> io::Result<Option<Finding>> {
        for name in self.1 {
            fs::write(victim.file(name), BEFORE)?;
        }
        let beside = listed(victim)?;
        let arguments = self.arguments();
        let mut child = victim.begin_piped(&arguments)?;
        let mut read = vec![0; random.below(10) * random.below(20_000)];
        if let Some(mut out) = child.stdout.take() {
            // Less may come than is asked for.
            let _ = out.read_exact(&mut read);
        }
        let pardon = Pardon { silence: true, ..Pardon::default() };
        let ended = match victim.end(child, &arguments, pardon)? {
            Ok(ended) => ended,
            Err(finding) => return Ok(Some(finding)),
        };
        let is_known =
            |name: &&str| fs::read(victim.file(name)).is_ok_and(|is| is == BEFORE || is.starts_with(b"<svg"));
        let left: Vec<String> = listed(victim)?.difference(&beside).cloned().collect();
        Ok(if ![Some(0), Some(6)].contains(&ended.code) {
            Some(ended.finding(format!("exit code {:?} where nobody reads", ended.code)))
        } else if !self.1.iter().all(is_known) {
            Some(ended.finding("neither the old file nor a new one, where nobody reads"))
        } else if !left.is_empty() {
            Some(ended.finding(format!("left lying about: {}", left.join(", "))))
        } else {
            None
        })
    }
}

/// All files, by their paths within the directory.
fn listed(victim: &Victim) -> io::Result<BTreeSet<String>> {
    fn below(directory: &Path, within: &str, all: &mut BTreeSet<String>) -> io::Result<()> {
        for entry in fs::read_dir(directory)? {
            let entry = entry?;
            let name = format!("{within}{}", entry.file_name().to_string_lossy());
            if entry.file_type()?.is_dir() {
                below(&entry.path(), &format!("{name}/"), all)?;
            } else {
                all.insert(name);
            }
        }
        Ok(())
    }
    let mut all = BTreeSet::new();
    below(&victim.file(""), "", &mut all)?;
    Ok(all)
}
