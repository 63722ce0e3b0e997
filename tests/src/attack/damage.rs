//! Checkpoints changed by chance: refused, or as good as before.

use std::fs;
use std::io;

use crate::attack::victim::{Finding, Victim};
use crate::fuzz::random::Random;

const RUN: &[&str] = &["run", "heavy-top-lagrange", "--t-end", "2", "--no-verify", "--every", "20"];

/// Damages a checkpoint in so many ways, and resumes from each.
///
/// # Errors
/// If files cannot be made.
pub fn damage(victim: &Victim, count: usize, random: &mut Random) -> io::Result<Vec<Finding>> {
    let resumed = |output: &'static str| [RUN, &["--resume", "point", "-o", output]].concat();
    if let Err(finding) = victim.run(&[RUN, &["--checkpoint", "point", "-o", "whole.csv"]].concat())? {
        return Ok(vec![finding]);
    }
    let whole = fs::read(victim.file("whole.csv"))?;
    let sound = fs::read(victim.file("point"))?;
    let mut findings = Vec::new();
    for _ in 0..count {
        let mut bytes = sound.clone();
        match random.below(4) {
            0 => bytes.truncate(random.below(sound.len())),
            1 => bytes.extend((0..=random.below(50)).map(|_| random.below(256) as u8).collect::<Vec<_>>()),
            _ => {
                for _ in 0..=random.below(3) {
                    let at = random.below(bytes.len());
                    bytes[at] ^= 1 << random.below(8);
                }
            }
        }
        fs::write(victim.file("point"), &bytes)?;
        match victim.run(&resumed("resumed.csv"))? {
            Err(finding) => findings.push(finding),
            Ok(ended) if ended.code == Some(0) && fs::read(victim.file("resumed.csv"))? != whole => {
                findings.push(ended.finding("another motion from a damaged checkpoint"));
            }
            Ok(_) => {}
        }
    }
    fs::write(victim.file("point"), &sound)?;
    match victim.run(&resumed("resumed.csv"))? {
        Err(finding) => findings.push(finding),
        Ok(ended) if ended.code != Some(0) => findings.push(ended.finding("a sound checkpoint is refused")),
        Ok(_) => {}
    }
    Ok(findings)
}
