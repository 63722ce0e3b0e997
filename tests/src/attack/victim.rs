//! The program under attack.

use std::fs::File;
use std::io;
use std::os::unix::process::ExitStatusExt;
use std::path::{Path, PathBuf};
use std::process::{Child, Command, ExitStatus, Stdio};
use std::thread;
use std::time::{Duration, Instant};

/// The exit codes that the program has names for.
const KNOWN: &[i32] = &[0, 2, 3, 4, 5, 6, 130];
/// Address space of a run in KiB: its limit on expressions, and what machine code, threads and tables may take beside it.
const ADDRESS_SPACE: u64 = 6 << 20;

/// After which it is called hanging: no machine is so slow.
const PATIENCE: Duration = Duration::from_secs(600);

/// The program with a directory of its own to work in.
#[derive(Clone, Debug)]
pub struct Victim {
    program: PathBuf,
    directory: PathBuf,
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

/// How a run of the program ended.
#[derive(Debug)]
pub struct Ended {
    /// Its exit code; None if a signal ended it.
    pub code: Option<i32>,
    /// Standard error.
    pub said: String,
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
        Victim { program: program.to_path_buf(), directory: directory.to_path_buf() }
    }

    /// A file in its directory.
    pub fn file(&self, name: &str) -> PathBuf {
        self.directory.join(name)
    }

    /// Begins a run, with as much memory as it may have.
    ///
    /// # Errors
    /// If there is no shell.
    pub fn begin(&self, arguments: &[&str]) -> io::Result<Child> {
        Command::new("sh")
            .args(["-c", &format!("ulimit -c 0; ulimit -v {ADDRESS_SPACE}; exec \"$0\" \"$@\"")])
            .arg(&self.program)
            .args(arguments)
            .current_dir(&self.directory)
            .stdin(Stdio::null())
            .stdout(File::create(self.file(".stdout"))?)
            .stderr(File::create(self.file(".stderr"))?)
            .spawn()
    }

    /// A whole run.
    ///
    /// # Errors
    /// Of [`begin`](Victim::begin); what the program does wrong is a finding.
    pub fn run(&self, arguments: &[&str]) -> io::Result<Result<Ended, Finding>> {
        let mut child = self.begin(arguments)?;
        let status = self.wait(&mut child)?;
        let said = String::from_utf8_lossy(&std::fs::read(self.file(".stderr"))?).into_owned();
        let command = format!("pc {}", arguments.join(" "));
        let ended = Ended { code: status.and_then(|status| status.code()), said, command };
        Ok(match status {
            None => Err(ended.finding(format!("still running after {} s", PATIENCE.as_secs()))),
            Some(status) => judged(status, ended),
        })
    }

    /// How it ended; None if it had to be killed.
    fn wait(&self, child: &mut Child) -> io::Result<Option<ExitStatus>> {
        let begin = Instant::now();
        let mut pause = Duration::from_micros(200);
        loop {
            if let Some(status) = child.try_wait()? {
                return Ok(Some(status));
            }
            if begin.elapsed() > PATIENCE {
                child.kill()?;
                child.wait()?;
                return Ok(None);
            }
            thread::sleep(pause);
            pause = (2 * pause).min(Duration::from_millis(20));
        }
    }
}

fn judged(status: ExitStatus, ended: Ended) -> Result<Ended, Finding> {
    let what = match (status.signal(), ended.code) {
        (Some(signal), _) => format!("ended by signal {signal}"),
        (None, Some(code)) if !KNOWN.contains(&code) => format!("exit code {code}, which means nothing"),
        _ if ended.said.contains("panicked at") => "a panic".to_owned(),
        _ if ended.said.contains("derivations disagree") => "the two derivations disagree".to_owned(),
        (None, Some(code)) if code != 0 && ended.said.trim().is_empty() => {
            format!("exit code {code} without a word")
        }
        _ => return Ok(ended),
    };
    Err(ended.finding(what))
}
