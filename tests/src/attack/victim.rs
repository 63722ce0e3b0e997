//! The program under attack.

pub mod usage;

use std::fs::{self, File};
use std::io;
use std::os::unix::process::ExitStatusExt;
use std::path::{Path, PathBuf};
use std::process::{Child, Command, ExitStatus, Stdio};
use std::thread;
use std::time::{Duration, Instant};

use crate::attack::victim::usage::Usage;

/// The exit codes that the program has names for.
const KNOWN: &[i32] = &[0, 2, 3, 4, 5, 6, 7, 130];
/// Address space of a run in KiB: its limit on expressions, and what machine code, threads and tables may take beside it.
const ADDRESS_SPACE: u64 = 6 << 20;

/// After which it is called hanging: no machine is so slow.
const PATIENCE: Duration = Duration::from_secs(600);

/// The program with a directory of its own to work in.
#[derive(Clone, Debug)]
pub struct Victim {
    program: PathBuf,
    directory: PathBuf,
    patience: Duration,
}

/// What is wrong, and how to see it again.
#[derive(Clone, Debug)]
pub struct Finding {
    /// What happened.
    pub what: String,
    /// The command line.
    pub command: String,
    /// Standard error, its end.
    pub said: String,
}

/// What is no fault of the program, because of what was done to it.
#[derive(Clone, Copy, Debug, Default)]
pub struct Pardon<'s> {
    /// Signals that may end it.
    pub signals: &'s [i32],
    /// Whether it may fail without a word.
    pub silence: bool,
}

/// How a run of the program ended.
#[derive(Debug)]
pub struct Ended {
    /// Its exit code; None if a signal ended it.
    pub code: Option<i32>,
    /// Standard error.
    pub said: String,
    /// What it took.
    pub usage: Usage,
    command: String,
}

impl Ended {
    /// A finding about this run.
    pub fn finding(&self, what: impl Into<String>) -> Finding {
        let tail = self.said.char_indices().rev().nth(600).map_or(0, |(start, _)| start);
        Finding { what: what.into(), command: self.command.clone(), said: self.said[tail..].to_owned() }
    }
}

impl Victim {
    /// `program` in `directory`, which exists.
    pub fn new(program: &Path, directory: &Path) -> Victim {
        Victim { program: program.to_path_buf(), directory: directory.to_path_buf(), patience: PATIENCE }
    }

    /// The same, of which a run is called hanging after so much time of its own.
    pub fn patient(self, patience: Duration) -> Victim {
        Victim { patience, ..self }
    }

    /// A file in its directory.
    pub fn file(&self, name: &str) -> PathBuf {
        self.directory.join(name)
    }

    /// The same program in a directory of its own within this one.
    ///
    /// # Errors
    /// If it cannot be made.
    pub fn room(&self, name: &str) -> io::Result<Victim> {
        let directory = self.file(name);
        fs::create_dir(&directory)?;
        Ok(Victim { directory, ..self.clone() })
    }

    /// Begins a run, with as much memory as it may have.
    ///
    /// # Errors
    /// If there is no shell.
    pub fn begin(&self, arguments: &[&str]) -> io::Result<Child> {
        self.begin_after("", arguments)
    }

    /// The same after the shell has done something more, such as `ulimit`.
    ///
    /// # Errors
    /// As of [`begin`](Victim::begin).
    pub fn begin_after(&self, prelude: &str, arguments: &[&str]) -> io::Result<Child> {
        self.command(prelude, arguments)?.spawn()
    }

    /// Begins a run whose standard output can be read.
    ///
    /// # Errors
    /// As of [`begin`](Victim::begin).
    pub fn begin_piped(&self, arguments: &[&str]) -> io::Result<Child> {
        self.command("", arguments)?.stdout(Stdio::piped()).spawn()
    }

    fn command(&self, prelude: &str, arguments: &[&str]) -> io::Result<Command> {
        let mut command = Command::new("sh");
        command
            .args(["-c", &format!("{prelude}\nulimit -c 0; ulimit -v {ADDRESS_SPACE}; exec \"$0\" \"$@\"")])
            .arg(&self.program)
            .args(arguments)
            .current_dir(&self.directory)
            .stdin(Stdio::null())
            .stdout(File::create(self.file(".stdout"))?)
            .stderr(File::create(self.file(".stderr"))?);
        Ok(command)
    }

    /// A whole run.
    ///
    /// # Errors
    /// Of [`begin`](Victim::begin); what the program does wrong is a finding.
    pub fn run(&self, arguments: &[&str]) -> io::Result<Result<Ended, Finding>> {
        let child = self.begin(arguments)?;
        self.end(child, arguments, Pardon::default())
    }

    /// A whole run that has a file of the directory for standard input.
    ///
    /// # Errors
    /// As of [`run`](Victim::run).
    pub fn run_on(&self, input: &str, arguments: &[&str]) -> io::Result<Result<Ended, Finding>> {
        let child = self.command("", arguments)?.stdin(File::open(self.file(input))?).spawn()?;
        self.end(child, arguments, Pardon::default())
    }

    /// Waits for a run that was begun with these arguments; what is pardoned is no finding.
    ///
    /// # Errors
    /// If it cannot be waited for.
    pub fn end(
        &self,
        mut child: Child,
        arguments: &[&str],
        pardon: Pardon<'_>,
    ) -> io::Result<Result<Ended, Finding>> {
        let (status, usage) = self.wait(&mut child)?;
        let said = String::from_utf8_lossy(&fs::read(self.file(".stderr"))?).into_owned();
        let command = format!("pc {}", arguments.join(" "));
        let ended = Ended { code: status.and_then(|status| status.code()), said, usage, command };
        Ok(match status {
            None => Err(ended.finding(format!("still running after {:.0} s", usage.seconds()))),
            Some(status) => judged(status, ended, pardon),
        })
    }

    /// How it ended, None if it had to be killed; and what it took.
    fn wait(&self, child: &mut Child) -> io::Result<(Option<ExitStatus>, Usage)> {
        let begin = Instant::now();
        let mut usage = Usage::new();
        let mut pause = Duration::from_micros(200);
        loop {
            usage.look(child.id());
            if let Some(status) = child.try_wait()? {
                return Ok((Some(status), usage));
            }
            if usage.seconds() > self.patience.as_secs_f64() || begin.elapsed() > PATIENCE {
                child.kill()?;
                child.wait()?;
                return Ok((None, usage));
            }
            thread::sleep(pause);
            pause = (2 * pause).min(Duration::from_millis(10));
        }
    }
}

fn judged(status: ExitStatus, ended: Ended, pardon: Pardon<'_>) -> Result<Ended, Finding> {
    let what = match (status.signal(), ended.code) {
        (Some(signal), _) if pardon.signals.contains(&signal) => return Ok(ended),
        (Some(signal), _) => format!("ended by signal {signal}"),
        (None, Some(code)) if !KNOWN.contains(&code) => format!("exit code {code}, which means nothing"),
        _ if ended.said.contains("panicked at") => "a panic".to_owned(),
        _ if ended.said.contains("derivations disagree") => "the two derivations disagree".to_owned(),
        (None, Some(code)) if code != 0 && !pardon.silence && ended.said.trim().is_empty() => {
            format!("exit code {code} without a word")
        }
        _ => return Ok(ended),
    };
    Err(ended.finding(what))
}
