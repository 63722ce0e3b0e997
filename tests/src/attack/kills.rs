//! Ends at any moment: what was finished is kept, the rest goes on, nothing is left lying about.

use std::collections::BTreeSet;
use std::fs;
use std::io;
use std::thread;
use std::time::{Duration, Instant};

use crate::attack::victim::{Finding, Victim};
use crate::fuzz::random::Random;

const RUN: &[&str] =
    &["run", "heavy-top-lagrange", "--t-end", "40", "--rows", "4000", "--no-verify", "--every", "200"];
const SWEEP: &[&str] = &["sweep", "heavy-top-lagrange", "--t-end", "2", "--vary", "mg=5:15:40"];

/// Kills runs and sweeps so many times, each at another moment, and has them go on.
///
/// # Errors
/// If files cannot be read.
pub fn kills(victim: &Victim, count: usize, random: &mut Random) -> io::Result<Vec<Finding>> {
    let mut findings = Vec::new();
    let run = |output: &'static str| [RUN, &["--checkpoint", "point", "-o", output]].concat();
    let resumed = [RUN, &["--resume", "point", "-o", "killed.csv"]].concat();
    let sweep = |output: &'static str| [SWEEP, &["-o", output]].concat();
    let mut whole = |arguments: &[&str], output: &str| -> io::Result<Option<(Vec<u8>, Duration)>> {
        let begin = Instant::now();
        match victim.run(arguments)? {
            Ok(ended) if ended.code == Some(0) => Ok(Some((fs::read(victim.file(output))?, begin.elapsed()))),
            Ok(ended) => {
                findings.push(ended.finding("not done"));
                Ok(None)
            }
            Err(finding) => {
                findings.push(finding);
                Ok(None)
            }
        }
    };
    let (Some((run_whole, run_time)), Some((sweep_whole, sweep_time))) =
        (whole(&run("whole.csv"), "whole.csv")?, whole(&sweep("all.csv"), "all.csv")?)
    else {
        return Ok(findings);
    };
    let _ = fs::remove_file(victim.file("point"));
    let before = listed(victim)?;
    for number in 0..count {
        let is_run = number % 2 == 0;
        let (first, time) =
            if is_run { (run("killed.csv"), run_time) } else { (sweep("killed.csv"), sweep_time) };
        let mut child = victim.begin(&first)?;
        thread::sleep(time.mul_f64(random.number(0.0, 1.1)));
        child.kill()?;
        child.wait()?;
        let has_point = victim.file("point").exists();
        let again = if is_run && has_point { resumed.clone() } else { first };
        let expected = if is_run { &run_whole } else { &sweep_whole };
        match victim.run(&again)? {
            Err(finding) => findings.push(finding),
            Ok(ended) if ended.code != Some(0) => findings.push(ended.finding("does not go on after a kill")),
            Ok(ended) if fs::read(victim.file("killed.csv"))? != *expected => {
                findings.push(ended.finding("another result after a kill"));
            }
            Ok(ended) => {
                fs::remove_file(victim.file("killed.csv"))?;
                let _ = fs::remove_file(victim.file("point"));
                let left: Vec<String> = listed(victim)?.difference(&before).cloned().collect();
                if !left.is_empty() {
                    findings.push(ended.finding(format!("left lying about: {}", left.join(", "))));
                    left.iter().try_for_each(|name| fs::remove_file(victim.file(name)))?;
                }
            }
        }
    }
    Ok(findings)
}

fn listed(victim: &Victim) -> io::Result<BTreeSet<String>> {
    fs::read_dir(victim.file("."))?
        .map(|entry| Ok(entry?.file_name().to_string_lossy().into_owned()))
        .collect()
}
