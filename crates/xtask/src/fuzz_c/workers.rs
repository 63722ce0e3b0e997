//! The program on all cores: one after the other where one falls, and the sums of what they have called.

use std::fmt::Write;
use std::fs::{self, File};
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Stdio};
use std::thread;
use std::time::{Duration, Instant};

use crate::error::Error;

/// What is played.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub(crate) struct Play {
    pub(crate) calls: u64,
    pub(crate) seed: u64,
    /// The one sequence that is played again, every call of which is shown.
    pub(crate) replayed: Option<u64>,
    /// Whether the calls of each function are shown.
    pub(crate) table: bool,
}

/// Falls after which a worker gives up.
const FALLS: u64 = 20;

/// How often the sums are shown, and how often it is looked whether a worker has ended.
const PROGRESS: Duration = Duration::from_secs(10);
const GLANCE: Duration = Duration::from_millis(50);

/// The part of the calls that is to succeed, in hundredths.
const LEAST: u64 = 40;

/// The calls from which on every function is to have succeeded.
const ENOUGH: u64 = 20_000;

/// Numbers before those of the functions, and numbers of each, as in `counts.c`.
const HEAD: usize = 8;
const EACH: usize = 4;

/// Functions that may never succeed, and why.
const HARD: [(&str, &str); 0] = [];

/// What a worker has counted, or all of them.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
struct Counts {
    calls: u64,
    succeeded: u64,
    falls: u64,
    sequence: u64,
    done: bool,
    sequences: u64,
    functions: Vec<[u64; EACH]>,
}

impl Counts {
    /// Those of the file of a worker; none where it has not begun.
    fn read(path: &Path, functions: usize) -> Counts {
        let bytes = fs::read(path).unwrap_or_default();
        let mut numbers: Vec<u64> = bytes
            .chunks_exact(8)
            .map(|chunk| u64::from_ne_bytes(chunk.try_into().unwrap_or_default()))
            .collect();
        numbers.resize(HEAD + EACH * functions, 0);
        let (head, rest) = numbers.split_at(HEAD);
        Counts {
            calls: head[0],
            succeeded: head[1],
            falls: head[2],
            sequence: head[3],
            done: head[4] != 0,
            sequences: head[5],
            functions: rest.chunks_exact(EACH).map(|chunk| chunk.try_into().unwrap_or_default()).collect(),
        }
    }

    fn add(&mut self, other: &Counts) {
        self.calls += other.calls;
        self.succeeded += other.succeeded;
        self.falls += other.falls;
        self.sequences += other.sequences;
        self.functions.resize(other.functions.len(), [0; EACH]);
        for (sum, more) in self.functions.iter_mut().zip(&other.functions) {
            for (sum, more) in sum[..3].iter_mut().zip(more) {
                *sum += more;
            }
            sum[3] = sum[3].max(more[3]);
        }
    }

    /// A line for each function: calls, successes, milliseconds of a call, and of the longest.
    fn table(&self, names: &[&str]) -> String {
        let mut text =
            format!("{:>10} {:>10} {:>10} {:>10}  function\n", "calls", "succeeded", "ms", "at most");
        for (name, [calls, succeeded, took, longest]) in names.iter().zip(&self.functions) {
            let mean = *took as f64 / 1e6 / (*calls).max(1) as f64;
            let _ = writeln!(
                text,
                "{calls:>10} {succeeded:>10} {mean:>10.3} {:>10.1}  {name}",
                *longest as f64 / 1e6
            );
        }
        text
    }

    /// What is wrong with the sums, in lines.
    fn wrong(&self, names: &[&str]) -> Vec<String> {
        let mut wrong = Vec::new();
        let missing = |place: usize| {
            let lacking = names.iter().zip(&self.functions).filter(|(_, counts)| counts[place] == 0);
            lacking.map(|(name, _)| *name).filter(|name| !HARD.iter().any(|(hard, _)| hard == name)).collect()
        };
        let (uncalled, unsuccessful): (Vec<&str>, Vec<&str>) = (missing(0), missing(1));
        if self.falls > 0 {
            wrong.push(format!("{} falls", self.falls));
        }
        if self.calls >= ENOUGH && !uncalled.is_empty() {
            wrong.push(format!("never called: {}", uncalled.join(", ")));
        }
        if self.calls >= ENOUGH && !unsuccessful.is_empty() {
            wrong.push(format!(
                "never successful: {}: right calls of them belong into program/recipes.c",
                unsuccessful.join(", ")
            ));
        }
        if self.calls >= ENOUGH && self.succeeded * 100 < self.calls * LEAST {
            wrong.push(format!(
                "fewer than {LEAST} of 100 calls succeed: the program draws too many wrong arguments"
            ));
        }
        wrong
    }
}

/// A process with its share of the calls.
struct Worker<'a> {
    play: &'a Play,
    program: &'a Path,
    /// A directory of its own, in which it runs.
    place: PathBuf,
    step: u64,
    calls: u64,
    child: Child,
}

impl<'a> Worker<'a> {
    fn start(
        play: &'a Play,
        program: &'a Path,
        place: PathBuf,
        [first, step, calls]: [u64; 3],
    ) -> Result<Worker<'a>, Error> {
        fs::create_dir_all(&place).map_err(|source| Error::of_file(&place, source))?;
        for name in ["counts", "falls"] {
            let _ = fs::remove_file(place.join(name)); // of an earlier run
        }
        let child = spawn(play, program, &place, [first, step, calls])?;
        Ok(Worker { play, program, place, step, calls, child })
    }

    fn counts(&self, functions: usize) -> Counts {
        Counts::read(&self.place.join("counts"), functions)
    }

    /// Shows what it has told.
    fn tell(&self) {
        let told = fs::read(self.place.join("falls")).unwrap_or_default();
        print!("{}", String::from_utf8_lossy(&told));
    }

    /// Whether it has done its share. Where it has ended before, the next sequence is begun.
    fn is_done(&mut self, functions: usize) -> Result<bool, Error> {
        let lost = |source| Error::Output { program: "fuzz".to_owned(), source };
        let Some(status) = self.child.try_wait().map_err(lost)? else { return Ok(false) };
        let counts = self.counts(functions);
        if counts.done && status.success() || self.play.replayed.is_some() {
            return Ok(true);
        }
        if counts.falls == 0 {
            // It ended otherwise than by a fall, such as by a leak that is found at its end.
            self.tell();
            return Err(Error::Failed { command: format!("{}", self.program.display()), status });
        }
        if counts.falls >= FALLS || counts.calls >= self.calls {
            return Ok(true);
        }
        let next = counts.sequence + self.step;
        self.child = spawn(self.play, self.program, &self.place, [next, self.step, self.calls])?;
        Ok(false)
    }
}

impl Drop for Worker<'_> {
    fn drop(&mut self) {
        let _ = self.child.kill();
        let _ = self.child.wait();
    }
}

fn spawn(play: &Play, program: &Path, place: &Path, [first, step, calls]: [u64; 3]) -> Result<Child, Error> {
    let falls = place.join("falls");
    let log = File::options().create(true).append(true).open(&falls);
    let log = log.map_err(|source| Error::of_file(&falls, source))?;
    let mut command = Command::new(program);
    command.current_dir(place).args([play.seed, first, step, calls].map(|number| number.to_string()));
    command.arg("counts").stdin(Stdio::null());
    if play.replayed.is_some() {
        command.arg("trace");
    } else {
        command.stderr(log);
    }
    command.spawn().map_err(|source| Error::Start { program: "fuzz".to_owned(), source })
}

/// Plays, and shows the falls and the sums.
///
/// # Errors
/// [`Error::Unfit`] where something fell, or was not called.
pub(crate) fn run(play: &Play, program: &Path, place: &Path, names: &[&str]) -> Result<(), Error> {
    let count = if play.replayed.is_some() {
        1
    } else {
        thread::available_parallelism().map_or(1, |n| n.get() as u64)
    };
    let share = play.calls.div_ceil(count);
    let shares = (0..count).map(|number| {
        let first = play.replayed.unwrap_or(number);
        Worker::start(play, program, place.join(format!("worker-{number}")), [first, count, share])
    });
    let mut workers = shares.collect::<Result<Vec<_>, Error>>()?;
    let (start, mut shown) = (Instant::now(), Instant::now());
    loop {
        let mut at_work = 0;
        for worker in &mut workers {
            at_work += usize::from(!worker.is_done(names.len())?);
        }
        if at_work == 0 {
            break;
        }
        thread::sleep(GLANCE);
        if shown.elapsed() > PROGRESS {
            shown = Instant::now();
            let sums = sums(&workers, names.len());
            println!(
                "{} calls, {} succeeded, {} falls, {} s",
                sums.calls,
                sums.succeeded,
                sums.falls,
                start.elapsed().as_secs()
            );
        }
    }
    workers.iter().for_each(Worker::tell);
    let sums = sums(&workers, names.len());
    if play.table {
        print!("{}", sums.table(names));
    }
    println!(
        "{} calls in {} sequences, {} succeeded, {} falls",
        sums.calls, sums.sequences, sums.succeeded, sums.falls
    );
    let wrong = sums.wrong(names);
    if wrong.is_empty() { Ok(()) } else { Err(Error::Unfit { wrong: wrong.join("; ") }) }
}

fn sums(workers: &[Worker<'_>], functions: usize) -> Counts {
    let mut sums = Counts::default();
    for worker in workers {
        sums.add(&worker.counts(functions));
    }
    sums
}

#[cfg(test)]
mod tests {
    use super::*;

    fn counts(calls: u64, functions: Vec<[u64; EACH]>) -> Counts {
        Counts { calls, succeeded: calls / 2, functions, ..Counts::default() }
    }

    #[test]
    fn sums_are_those_of_all_workers() {
        let mut sums = Counts::default();
        sums.add(&counts(10, vec![[6, 2, 100, 30], [4, 3, 8, 2]]));
        sums.add(&counts(20, vec![[1, 1, 50, 50], [0, 0, 0, 0]]));
        assert_eq!(sums, counts(30, vec![[7, 3, 150, 50], [4, 3, 8, 2]]));
        assert!(
            sums.table(&["pc_a", "pc_b"]).contains("         7          3      0.000        0.0  pc_a\n")
        );
    }

    #[test]
    fn counts_are_read_as_they_are_written() {
        let directory = tempfile::tempdir().unwrap();
        let path = directory.path().join("counts");
        assert_eq!(Counts::read(&path, 1), counts(0, vec![[0; EACH]]));
        let numbers: [u64; 12] = [9, 4, 1, 77, 1, 3, 0, 0, 5, 6, 7, 8];
        fs::write(&path, numbers.map(u64::to_ne_bytes).concat()).unwrap();
        let expected =
            Counts { falls: 1, sequence: 77, done: true, sequences: 3, ..counts(9, vec![[5, 6, 7, 8]]) };
        assert_eq!(Counts::read(&path, 1), expected);
    }

    #[test]
    fn a_function_that_never_succeeds_is_named_after_many_calls() {
        let names = ["pc_a", "pc_b"];
        let few = counts(100, vec![[100, 50, 0, 0], [0, 0, 0, 0]]);
        assert_eq!(few.wrong(&names), [""; 0]);
        let many = counts(ENOUGH, vec![[ENOUGH, 0, 0, 0], [0, 0, 0, 0]]);
        assert_eq!(
            many.wrong(&names),
            [
                "never called: pc_b",
                "never successful: pc_a, pc_b: right calls of them belong into program/recipes.c"
            ]
        );
        let fallen = Counts { falls: 2, succeeded: 0, ..counts(ENOUGH, vec![[1, 1, 0, 0], [1, 1, 0, 0]]) };
        assert_eq!(fallen.wrong(&names).len(), 2);
        assert_eq!(fallen.wrong(&names)[0], "2 falls");
    }
}
