//! A program with all that it starts, killed where it takes longer than it may.

use std::io::{self, Read};
use std::process::{Child, Command, ExitStatus, Stdio};
use std::sync::mpsc::{self, RecvTimeoutError};
use std::thread;
use std::time::{Duration, Instant};

use crate::command::program_of;
use crate::error::Error;

/// How often it is looked whether the program has ended while something it started still holds its output.
const GLANCE: Duration = Duration::from_millis(100);

/// How long after the end the output is read on: what has left the group may hold it for ever.
const REST: Duration = Duration::from_secs(10);

/// How a program ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Ending {
    /// By itself.
    Exited(ExitStatus),
    /// By us, after its time.
    Killed,
}

/// Runs a program in a process group of its own, each line of its output given to `sink` with the time it came.
///
/// Both its streams are read, but for a standard output that goes elsewhere by `output`. After `limit`, and whenever the program
/// has ended or we have, the group is killed: nothing of it runs on.
///
/// # Errors
/// [`Error::Start`], and [`Error::Output`] where its output cannot be read.
pub(crate) fn run(
    command: &mut Command,
    limit: Duration,
    output: Option<Stdio>,
    mut sink: impl FnMut(&str, Instant),
) -> Result<Ending, Error> {
    let program = program_of(command);
    let start = |source| Error::Start { program: program.clone(), source };
    let lost = |source| Error::Output { program: program.clone(), source };
    let (reader, writer) = io::pipe().map_err(start)?;
    let own = writer.try_clone().map_err(start)?;
    command.stdin(Stdio::null()).stderr(writer).stdout(output.unwrap_or_else(|| own.into()));
    let group = Group::start(command).map_err(start);
    // The command holds ends of the pipe of its own, without which there would be no end of the output.
    command.stdout(Stdio::null()).stderr(Stdio::null());
    let mut group = group?;
    let deadline = Instant::now() + limit;
    let pieces = pieces(reader);
    let mut lines = Lines::default();
    loop {
        let now = Instant::now();
        let wait = deadline.saturating_duration_since(now).min(GLANCE);
        match pieces.recv_timeout(wait) {
            Ok(piece) => lines.feed(&piece.map_err(lost)?, |line| sink(line, Instant::now())),
            Err(RecvTimeoutError::Disconnected) => thread::sleep(wait.min(GLANCE / 20)),
            Err(RecvTimeoutError::Timeout) => {}
        }
        let status = group.leader.try_wait().map_err(lost)?;
        if status.is_none() && Instant::now() < deadline {
            continue;
        }
        group.kill();
        let end = Instant::now() + REST;
        while let Ok(piece) = pieces.recv_timeout(end.saturating_duration_since(Instant::now())) {
            lines.feed(&piece.map_err(lost)?, |line| sink(line, Instant::now()));
            if Instant::now() > end {
                break;
            }
        }
        lines.end(|line| sink(line, Instant::now()));
        return Ok(status.map_or(Ending::Killed, Ending::Exited));
    }
}

/// What comes through a pipe, read by a thread of its own, which ends with the pipe.
fn pieces(mut reader: io::PipeReader) -> mpsc::Receiver<io::Result<Vec<u8>>> {
    let (sender, receiver) = mpsc::channel();
    thread::spawn(move || {
        let mut piece = vec![0; 8192];
        loop {
            let read = match reader.read(&mut piece) {
                Ok(0) => return,
                Ok(length) => Ok(piece[..length].to_vec()),
                Err(error) if error.kind() == io::ErrorKind::Interrupted => continue,
                Err(error) => Err(error),
            };
            let failed = read.is_err();
            if sender.send(read).is_err() || failed {
                return;
            }
        }
    });
    receiver
}

/// A process group with its first process, and one outside of it that kills it when we are gone.
struct Group {
    leader: Child,
    guardian: Option<Child>,
}

impl Group {
    #[cfg(unix)]
    fn start(command: &mut Command) -> io::Result<Group> {
        use std::os::unix::process::CommandExt;
        let leader = command.process_group(0).spawn()?;
        // Its input ends with us, by whatever we end; the signals that a terminal sends to our group do not end it.
        // After a signal by its own letters, such as -KILL, dash does not know `--`.
        let watch = format!("trap '' INT TERM HUP; read -r _; kill -s KILL -- -{}", leader.id());
        let guardian = Command::new("sh")
            .args(["-c", &watch])
            .stdin(Stdio::piped())
            .stdout(Stdio::null())
            .stderr(Stdio::null())
            .spawn()
            .ok();
        Ok(Group { leader, guardian })
    }

    #[cfg(not(unix))]
    fn start(command: &mut Command) -> io::Result<Group> {
        Ok(Group { leader: command.spawn()?, guardian: None })
    }

    /// Kills what is left of the group; a group that has ended stays as it is.
    fn kill(&mut self) {
        let _ = match &mut self.guardian {
            // Its input ends, and it does its work.
            Some(guardian) => {
                drop(guardian.stdin.take());
                guardian.wait().map(|_| ())
            }
            None => self.leader.kill(),
        };
        let _ = self.leader.wait();
    }
}

impl Drop for Group {
    fn drop(&mut self) {
        self.kill();
    }
}

/// Pieces of output, put together to lines.
#[derive(Default)]
struct Lines {
    begun: Vec<u8>,
}

impl Lines {
    fn feed(&mut self, piece: &[u8], mut sink: impl FnMut(&str)) {
        for part in piece.split_inclusive(|&byte| byte == b'\n') {
            self.begun.extend_from_slice(part);
            if part.ends_with(b"\n") {
                self.begun.pop();
                sink(&String::from_utf8_lossy(&self.begun));
                self.begun.clear();
            }
        }
    }

    /// The last line, where it has no end.
    fn end(&mut self, mut sink: impl FnMut(&str)) {
        if !self.begun.is_empty() {
            sink(&String::from_utf8_lossy(&self.begun));
            self.begun.clear();
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::command::succeeds;

    fn shell(script: &str, limit: Duration) -> (Ending, Vec<String>) {
        let mut lines = Vec::new();
        let ending =
            run(Command::new("sh").args(["-c", script]), limit, None, |line, _| lines.push(line.to_owned()));
        (ending.unwrap(), lines)
    }

    #[test]
    fn both_streams_are_heard_and_the_exit_code_is_told() {
        let (ending, lines) = shell("echo one; echo two >&2; printf three; exit 3", Duration::from_secs(60));
        assert_eq!(lines, ["one", "two", "three"]);
        assert!(matches!(ending, Ending::Exited(status) if status.code() == Some(3)));
    }

    #[test]
    fn what_takes_too_long_is_killed_with_all_it_started() {
        // On a busy machine it may have said nothing yet when the least limit ends it.
        let sleeper = [1, 10, 100].map(Duration::from_secs).into_iter().find_map(|limit| {
            let begin = Instant::now();
            let (ending, lines) = shell("sleep 600 & echo $!; sleep 600", limit);
            assert_eq!(ending, Ending::Killed);
            assert!(begin.elapsed() < limit + Duration::from_secs(300));
            lines.into_iter().next()
        });
        let sleeper = sleeper.expect("a line within the longest limit");
        let gone = (0..600).any(|_| {
            thread::sleep(GLANCE);
            !succeeds(Command::new("kill").args(["-0", &sleeper]))
        });
        assert!(gone, "{sleeper} sleeps on");
    }

    #[test]
    fn who_stays_behind_is_not_waited_for() {
        let (ending, lines) = shell("sleep 600 & echo started", Duration::from_secs(500));
        assert!(matches!(ending, Ending::Exited(status) if status.success()));
        assert_eq!(lines, ["started"]);
    }
}
