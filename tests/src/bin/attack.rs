//! The attack: `cargo xtask attack [--minutes N | --count N] [--seed S]`.
//!
//! It runs the program `pc` that lies beside it on giants, on what is no file, on damaged checkpoints and with kills, and on
//! changed models for the rest of the time. With `--count` it makes so many rounds of a fixed number of attempts, the same on each
//! machine. It ends with 1 if anything was found.

use std::path::PathBuf;
use std::process::ExitCode;
use std::time::{Duration, Instant};
use std::{fs, io};

use pc_tests::attack::victim::{Finding, Victim};
use pc_tests::attack::{damage, giants, kills, places, texts};
use pc_tests::fuzz::random::Random;

const USAGE: &str = "usage: attack [--minutes N | --count N] [--seed S]";
/// What each command may take.
const LIMITS: &[&str] = &["--limit-time", "3", "--limit-memory", "500M"];
/// The shares of the time of damaged checkpoints and of kills; the rest is for changed models.
const SHARE: f64 = 0.15;
/// Kills a minute, however long they take: what goes wrong between two writes seldom does.
const KILLS: f64 = 100.0;
/// The attempts of a round: damaged checkpoints, kills, changed models.
const ROUND: [usize; 3] = [40, 10, 4];

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
    let begin = Instant::now();
    let program = beside()?;
    // Each attack has choices of its own: how many there was time for does not change those of the others.
    let [mut of_damage, mut of_kills, mut of_texts] = [0, 1, 2].map(|attack| Random::new(seed, attack));
    let mut found = 0;
    let mut tell = |what: &str, count: usize, findings: &[Finding]| {
        println!("{what}: {count}, findings {}", findings.len());
        for finding in findings {
            println!(
                "  {}\n    {}\n    {}",
                finding.what,
                finding.command,
                finding.said.trim().replace('\n', "\n    ")
            );
        }
        found += findings.len();
    };
    let directory = tempfile::tempdir()?;
    let room = |name: &str| -> io::Result<Victim> {
        let path = directory.path().join(name);
        fs::create_dir(&path)?;
        Ok(Victim::new(&program, &path))
    };

    let victim = room("giants")?;
    let (mut findings, mut count) = (Vec::new(), 0);
    let all = giants::giants();
    for (number, giant) in all.iter().enumerate() {
        let name = format!("{}.toml", giant.name);
        fs::write(victim.file(&name), &giant.text)?;
        for command in amount.commands(number) {
            count += 1;
            findings.extend(victim.run(&[&[command[0], &name], &command[1..], LIMITS].concat())?.err());
        }
    }
    tell("giants", count, &findings);
    tell("places", 8, &places::places(&room("places")?)?);

    let victim = room("damage")?;
    let (mut findings, mut count) = (Vec::new(), 0);
    let part = amount.part(ROUND[0], 1, |time| Instant::now() + time.mul_f64(SHARE));
    while part.goes_on(count) {
        findings.extend(damage::damage(&victim, 20, &mut of_damage)?);
        count += 20;
    }
    tell("damaged checkpoints", count, &findings);

    let (mut findings, mut count) = (Vec::new(), 0);
    let part = amount.part(ROUND[1], amount.kills(), |time| Instant::now() + time.mul_f64(SHARE));
    while part.goes_on(count) {
        let victim = room(&format!("kills{count}"))?;
        findings.extend(kills::kills(&victim, 10, &mut of_kills)?);
        count += 10;
    }
    tell("kills", count, &findings);

    let victim = room("texts")?;
    let (mut findings, mut count) = (Vec::new(), 0);
    let part = amount.part(ROUND[2], 20, |time| begin + time);
    while part.goes_on(count) {
        fs::write(victim.file("changed.toml"), texts::changed(&mut of_texts))?;
        let command = COMMANDS[of_texts.below(COMMANDS.len())];
        let arguments = [&[command[0], "changed.toml"], &command[1..], LIMITS].concat();
        if let Err(mut finding) = victim.run(&arguments)? {
            let kept = std::env::temp_dir().join(format!("attack-{seed}-{count}.toml"));
            fs::copy(victim.file("changed.toml"), &kept)?;
            finding.command = finding.command.replace("changed.toml", &kept.display().to_string());
            findings.push(finding);
        }
        count += 1;
    }
    tell("changed models", count, &findings);
    println!("{:.0} s", begin.elapsed().as_secs_f64());
    Ok(found)
}

const COMMANDS: &[&[&str]] = &[
    &["check"],
    &["derive"],
    &["derive", "--form", "canonical", "--format", "latex"],
    &["run", "--t-end", "0.01", "-o", "out.csv"],
    &["emit", "--lang", "c", "-o", "emitted"],
    &["sweep", "--t-end", "0.01", "--random", "x=uniform(0,1)", "--samples", "2", "-o", "swept.csv"],
];

/// The program that was built with this one.
fn beside() -> io::Result<PathBuf> {
    Ok(std::env::current_exe()?.with_file_name("pc"))
}
