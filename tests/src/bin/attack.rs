//! The attack: `cargo xtask attack [--minutes N] [--seed S]`.
//!
//! It runs the program `pc` that lies beside it on giants, on what is no file, on damaged checkpoints and with kills, and on
//! changed models for the rest of the time. It ends with 1 if anything was found.

use std::path::PathBuf;
use std::process::ExitCode;
use std::time::{Duration, Instant};
use std::{fs, io};

use pc_tests::attack::victim::{Finding, Victim};
use pc_tests::attack::{damage, giants, kills, places, texts};
use pc_tests::fuzz::random::Random;

const USAGE: &str = "usage: attack [--minutes N] [--seed S]";
/// What each command may take: its limits are to hold before patience ends.
const LIMITS: &[&str] = &["--limit-time", "3", "--limit-memory", "500M"];
/// The shares of the time of damaged checkpoints and of kills; the rest is for changed models.
const SHARE: f64 = 0.15;
/// Kills a minute, however long they take: what goes wrong between two writes seldom does.
const KILLS: f64 = 100.0;

fn main() -> ExitCode {
    let words: Vec<String> = std::env::args().skip(1).collect();
    let number = |name: &str, default: f64| match words.iter().position(|word| word == name) {
        None => Some(default),
        Some(i) => words.get(i + 1)?.parse().ok(),
    };
    let (Some(minutes), Some(seed), true) =
        (number("--minutes", 10.0), number("--seed", 1.0), words.len().is_multiple_of(2))
    else {
        eprintln!("attack: {USAGE}");
        return ExitCode::from(2);
    };
    match attack(Duration::from_secs_f64(60.0 * minutes), seed as u64) {
        Ok(0) => ExitCode::SUCCESS,
        Ok(_) => ExitCode::FAILURE,
        Err(error) => {
            eprintln!("attack: {error}");
            ExitCode::FAILURE
        }
    }
}

/// The number of findings.
fn attack(time: Duration, seed: u64) -> io::Result<usize> {
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
        let commands = match time < Duration::from_secs(60) {
            true => &COMMANDS[number % COMMANDS.len()..][..1],
            false => COMMANDS,
        };
        for command in commands {
            count += 1;
            findings.extend(
                victim
                    .patient(Duration::from_secs(30))
                    .run(&[&[command[0], &name], &command[1..], LIMITS].concat())?
                    .err(),
            );
        }
    }
    tell("giants", count, &findings);
    tell("places", 8, &places::places(&room("places")?)?);

    let victim = room("damage")?;
    let (mut findings, mut count) = (Vec::new(), 0);
    let end = begin.elapsed() + time.mul_f64(SHARE);
    while count == 0 || begin.elapsed() < end {
        findings.extend(damage::damage(&victim, 20, &mut of_damage)?);
        count += 20;
    }
    tell("damaged checkpoints", count, &findings);

    let (mut findings, mut count) = (Vec::new(), 0);
    let end = begin.elapsed() + time.mul_f64(SHARE);
    let minutes = time.as_secs_f64() / 60.0;
    let least = if minutes < 1.0 { 1 } else { (KILLS * minutes) as usize };
    while count < least || begin.elapsed() < end {
        let victim = room(&format!("kills{count}"))?.patient(Duration::from_secs(60));
        findings.extend(kills::kills(&victim, 10, &mut of_kills)?);
        count += 10;
    }
    tell("kills", count, &findings);

    let victim = room("texts")?;
    let (mut findings, mut count) = (Vec::new(), 0);
    while count < 20 || begin.elapsed() < time {
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
