//! The attack: `cargo xtask attack [--minutes N | --count N] [--seed S]`.
//!
//! It runs the program `pc` that lies beside it on giants, on what is no file, with results under the names of what is read, on
//! damaged checkpoints, with kills and signals, on large models within small limits, and on changed models for the rest of the
//! time. With `--count` it makes so many rounds of a fixed number of attempts, the same on each machine. It ends with 1 if
//! anything was found.

use std::path::{Path, PathBuf};
use std::process::ExitCode;
use std::time::{Duration, Instant};
use std::{fs, io};

use pc_tests::attack::limits::Worst;
use pc_tests::attack::victim::{Finding, Victim};
use pc_tests::attack::{damage, giants, kills, limits, overwrites, places, signals, texts};
use pc_tests::fuzz::random::Random;
use tempfile::TempDir;

const USAGE: &str = "usage: attack [--minutes N | --count N] [--seed S]";
/// What each command may take.
const LIMITS: &[&str] = &["--limit-time", "3", "--limit-memory", "500M"];
/// The shares of the time of damaged checkpoints, of kills, of signals and of limits; the rest is for changed models.
const SHARE: f64 = 0.15;
/// Kills a minute, however long they take: what goes wrong between two writes seldom does.
const KILLS: f64 = 100.0;
/// The attempts of a round: damaged checkpoints, kills, changed models, results in the place of what is read, signals, limits.
const ROUND: [usize; 6] = [40, 10, 4, 10, 2, 1];
/// Signals and runs with limits for one command and one model in the time of an attack.
const EACH: [usize; 2] = [10, 5];

/// After which a run with limits is called hanging.
const HANGING: Duration = Duration::from_secs(30);

/// How much is attempted.
#[derive(Clone, Copy, Debug)]
enum Amount {
    Time(Duration),
    Rounds(usize),
}

impl Amount {
    /// The amount and the seed of a command line.
    fn of(words: &[String]) -> Option<(Amount, u64)> {
        let number = |name: &str| match words.iter().position(|word| word == name) {
            None => Some(None),
            Some(i) => words.get(i + 1)?.parse::<f64>().ok().map(Some),
        };
        let amount = match (number("--minutes")?, number("--count")?) {
            (Some(_), Some(_)) => return None,
            (None, Some(rounds)) => Amount::Rounds(rounds as usize),
            (minutes, None) => {
                Amount::Time(Duration::try_from_secs_f64(60.0 * minutes.unwrap_or(10.0)).ok()?)
            }
        };
        words.len().is_multiple_of(2).then_some((amount, number("--seed")?.unwrap_or(1.0) as u64))
    }

    /// The commands for giant `number`: a single one where all of them would take too long.
    fn commands(self, number: usize) -> &'static [&'static [&'static str]] {
        match self {
            Amount::Time(time) if time >= Duration::from_secs(60) => COMMANDS,
            _ => &COMMANDS[number % COMMANDS.len()..][..1],
        }
    }

    /// A part of it: `round` attempts a round, or as many as there is time for, at least `least`.
    fn part(self, round: usize, least: usize, end: impl FnOnce(Duration) -> Instant) -> Part {
        match self {
            Amount::Time(time) => Part { least, end: Some(end(time)) },
            Amount::Rounds(rounds) => Part { least: round * rounds, end: None },
        }
    }

    /// How many of `all` results in the place of what is read are attempted: few where all would take too long.
    fn overwrites(self, all: usize) -> usize {
        match self {
            Amount::Time(time) if time >= Duration::from_secs(300) => all,
            Amount::Time(_) => all.min(100),
            Amount::Rounds(rounds) => all.min(ROUND[3] * rounds),
        }
    }

    /// How often something is done with the same command or model.
    fn each(self, round: usize, in_time: usize) -> usize {
        match self {
            Amount::Time(_) => in_time,
            Amount::Rounds(_) => round,
        }
    }

    /// The least number of kills in a time.
    fn kills(self) -> usize {
        match self {
            Amount::Time(time) if time >= Duration::from_secs(60) => {
                (KILLS * time.as_secs_f64() / 60.0) as usize
            }
            _ => 1,
        }
    }
}

/// How long a part goes on.
#[derive(Clone, Copy, Debug)]
struct Part {
    least: usize,
    end: Option<Instant>,
}

impl Part {
    fn goes_on(self, count: usize) -> bool {
        count < self.least || self.end.is_some_and(|end| Instant::now() < end)
    }
}

fn main() -> ExitCode {
    let words: Vec<String> = std::env::args().skip(1).collect();
    let Some((amount, seed)) = Amount::of(&words) else {
        eprintln!("attack: {USAGE}");
        return ExitCode::from(2);
    };
    match attack(amount, seed) {
        Ok(0) => ExitCode::SUCCESS,
        Ok(_) => ExitCode::FAILURE,
        Err(error) => {
            eprintln!("attack: {error}");
            ExitCode::FAILURE
        }
    }
}

/// The number of findings.
fn attack(amount: Amount, seed: u64) -> io::Result<usize> {
    let mut attack = Attack {
        amount,
        seed,
        begin: Instant::now(),
        program: beside()?,
        directory: tempfile::tempdir()?,
        found: 0,
    };
    attack.giants()?;
    let found = places::places(&attack.room("places")?)?;
    attack.tell("places", 8, &found);
    attack.overwrites()?;
    attack.damage()?;
    attack.kills()?;
    attack.signals()?;
    attack.limits()?;
    attack.texts()?;
    println!("{:.0} s", attack.begin.elapsed().as_secs_f64());
    Ok(attack.found)
}

/// An attack as far as it has come.
struct Attack {
    amount: Amount,
    seed: u64,
    begin: Instant,
    program: PathBuf,
    directory: TempDir,
    found: usize,
}

impl Attack {
    /// The choices of a kind of attack, its own: how many there was time for does not change those of the others.
    fn choices(&self, kind: u64) -> Random {
        Random::new(self.seed, kind)
    }

    fn room(&self, name: &str) -> io::Result<Victim> {
        let path = self.directory.path().join(name);
        fs::create_dir(&path)?;
        Ok(Victim::new(&self.program, &path))
    }

    /// A part of so many attempts a round, or of its share of the time.
    fn part(&self, round: usize, least: usize) -> Part {
        self.amount.part(round, least, |time| Instant::now() + time.mul_f64(SHARE))
    }

    fn tell(&mut self, what: &str, count: usize, findings: &[Finding]) {
        println!("{what}: {count}, findings {}", findings.len());
        for finding in findings {
            println!(
                "  {}\n    {}\n    {}",
                finding.what,
                finding.command,
                finding.said.trim().replace('\n', "\n    ")
            );
        }
        self.found += findings.len();
    }

    /// Keeps a model for those who look into a finding.
    fn keep(&self, model: &Path, count: usize, finding: &mut Finding) -> io::Result<()> {
        let Some(name) = model.file_name().and_then(|name| name.to_str()) else { return Ok(()) };
        let kept = std::env::temp_dir().join(format!("attack-{}-{count}-{name}", self.seed));
        fs::copy(model, &kept)?;
        finding.command = finding.command.replace(name, &kept.display().to_string());
        Ok(())
    }

    fn giants(&mut self) -> io::Result<()> {
        let victim = self.room("giants")?;
        let (mut findings, mut count) = (Vec::new(), 0);
        for (number, giant) in giants::giants().iter().enumerate() {
            let name = format!("{}.toml", giant.name);
            fs::write(victim.file(&name), &giant.text)?;
            for command in self.amount.commands(number) {
                count += 1;
                findings.extend(victim.run(&[&[command[0], &name], &command[1..], LIMITS].concat())?.err());
            }
        }
        self.tell("giants", count, &findings);
        Ok(())
    }

    fn overwrites(&mut self) -> io::Result<()> {
        let all = overwrites::attempts(&mut self.choices(3));
        let count = self.amount.overwrites(all.len());
        let findings = overwrites::overwrites(&self.room("overwrites")?, &all[..count])?;
        self.tell("results in the place of what is read", count, &findings);
        Ok(())
    }

    fn damage(&mut self) -> io::Result<()> {
        let (victim, mut random) = (self.room("damage")?, self.choices(0));
        let (mut findings, mut count) = (Vec::new(), 0);
        let part = self.part(ROUND[0], 1);
        while part.goes_on(count) {
            findings.extend(damage::damage(&victim, 20, &mut random)?);
            count += 20;
        }
        self.tell("damaged checkpoints", count, &findings);
        Ok(())
    }

    fn kills(&mut self) -> io::Result<()> {
        let mut random = self.choices(1);
        let (mut findings, mut count) = (Vec::new(), 0);
        let part = self.part(ROUND[1], self.amount.kills());
        while part.goes_on(count) {
            let victim = self.room(&format!("kills{count}"))?;
            findings.extend(kills::kills(&victim, 10, &mut random)?);
            count += 10;
        }
        self.tell("kills", count, &findings);
        Ok(())
    }

    fn signals(&mut self) -> io::Result<()> {
        let mut random = self.choices(4);
        let (mut findings, mut count) = (Vec::new(), 0);
        let (part, each) = (self.part(ROUND[4], 1), self.amount.each(ROUND[4], EACH[0]));
        while part.goes_on(count) {
            let victim = self.room(&format!("signals{count}"))?;
            findings.extend(signals::signals(&victim, each, &mut random)?);
            count += each;
        }
        self.tell("signals and readers that go away", count, &findings);
        Ok(())
    }

    fn limits(&mut self) -> io::Result<()> {
        let (mut victim, mut random) = (self.room("limits")?, self.choices(5));
        // Rounds are the same on each machine, however slow it is: what they do is judged, not how long it takes.
        let is_timed = matches!(self.amount, Amount::Time(_));
        if is_timed {
            victim = victim.patient(HANGING);
        }
        let (mut findings, mut count, mut worst) = (Vec::new(), 0, Worst::default());
        let (part, each) = (self.part(ROUND[5], 1), self.amount.each(ROUND[5], EACH[1]));
        while part.goes_on(count) {
            let model = victim.file("large.toml");
            fs::write(&model, limits::model(&mut random))?;
            for mut finding in
                limits::limits(&victim, "large.toml", (each, is_timed), &mut worst, &mut random)?
            {
                self.keep(&model, count, &mut finding)?;
                findings.push(finding);
            }
            count += each;
        }
        self.tell("large models within limits", count, &findings);
        if is_timed {
            println!("  exceeded by {:.2} s and {:.0} MB at most", worst.seconds, worst.megabytes);
        }
        Ok(())
    }

    fn texts(&mut self) -> io::Result<()> {
        let (victim, mut random) = (self.room("texts")?, self.choices(2));
        let (mut findings, mut count) = (Vec::new(), 0);
        let part = self.amount.part(ROUND[2], 20, |time| self.begin + time);
        while part.goes_on(count) {
            let model = victim.file("changed.toml");
            fs::write(&model, texts::changed(&mut random))?;
            let command = COMMANDS[random.below(COMMANDS.len())];
            let arguments = [&[command[0], "changed.toml"], &command[1..], LIMITS].concat();
            if let Err(mut finding) = victim.run(&arguments)? {
                self.keep(&model, count, &mut finding)?;
                findings.push(finding);
            }
            count += 1;
        }
        self.tell("changed models", count, &findings);
        Ok(())
    }
}

const COMMANDS: &[&[&str]] = &[
    &["check"],
    &["derive"],
    &["derive", "--form", "canonical", "--format", "latex"],
    &["run", "--t-end", "0.01", "-o", "out.csv"],
    &["emit", "--lang", "c", "-o", "emitted"],
    &["sweep", "--t-end", "0.01", "--random", "x=uniform(0,1)", "--members", "2", "-o", "swept.csv"],
];

/// The program that was built with this one.
fn beside() -> io::Result<PathBuf> {
    Ok(std::env::current_exe()?.with_file_name("pc"))
}
