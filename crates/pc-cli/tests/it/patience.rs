//! Waiting with an end: for programs, and for what they are to do.

use std::io::{BufRead, BufReader};
use std::ops::{Deref, DerefMut};
use std::process::{Child, Command, Output, Stdio};
use std::sync::mpsc::{self, RecvTimeoutError};
use std::thread;
use std::time::{Duration, Instant};

/// Far more than anything waited for takes on the slowest machine: what takes longer hangs.
pub(crate) const PATIENCE: Duration = Duration::from_secs(600);
/// Between two looks at what is waited for.
const GLANCE: Duration = Duration::from_millis(2);

/// A process that is killed and reaped where its test gives up.
pub(crate) struct Reaped(Option<Child>);

impl Deref for Reaped {
    type Target = Child;

    fn deref(&self) -> &Child {
        self.0.as_ref().expect("a child")
    }
}

impl DerefMut for Reaped {
    fn deref_mut(&mut self) -> &mut Child {
        self.0.as_mut().expect("a child")
    }
}

impl Reaped {
    pub(crate) fn has_ended(&mut self) -> bool {
        self.try_wait().expect("a child").is_some()
    }

    /// Sends a signal; to a process that has ended it does nothing.
    pub(crate) fn signal(&mut self, signal: &str) {
        // Until it is reaped, its number is of no other process.
        if !self.has_ended() {
            send(signal, &self.id().to_string());
        }
    }
}

impl Drop for Reaped {
    fn drop(&mut self) {
        if let Some(child) = &mut self.0 {
            let _ = child.kill();
            let _ = child.wait();
        }
    }
}

/// Sends a signal to a process, or to a group by its number after `-`.
pub(crate) fn send(signal: &str, to: &str) {
    let _ = Command::new("kill").args([signal, "--", to]).stderr(Stdio::null()).status();
}

pub(crate) fn started(command: &mut Command) -> Reaped {
    Reaped(Some(command.spawn().expect("the program starts")))
}

/// The first line that a program prints, which runs on: a server prints its address.
#[track_caller]
pub(crate) fn first_line(program: &mut Reaped) -> String {
    let mut line = String::new();
    let printed = program.stdout.take().expect("a pipe");
    BufReader::new(printed).read_line(&mut line).expect("a line");
    line
}

/// How a process ends, and what comes through its pipes; one that hangs is killed.
#[track_caller]
pub(crate) fn ended(mut child: Reaped) -> Output {
    let child = child.0.take().expect("a child");
    let id = child.id().to_string();
    let (end, ends) = mpsc::channel::<()>();
    let watch = thread::spawn(move || {
        let hangs = ends.recv_timeout(PATIENCE) == Err(RecvTimeoutError::Timeout);
        if hangs {
            send("-KILL", &id);
        }
        hangs
    });
    let output = child.wait_with_output().expect("an end");
    drop(end);
    assert!(!watch.join().expect("a watch"), "still running after {PATIENCE:?}: {output:?}");
    output
}

/// Waits until it is done, which `what` names.
#[track_caller]
pub(crate) fn until(what: &str, mut done: impl FnMut() -> bool) {
    let begun = Instant::now();
    while !done() {
        assert!(begun.elapsed() < PATIENCE, "nothing after {PATIENCE:?}: {what}");
        thread::sleep(GLANCE);
    }
}
