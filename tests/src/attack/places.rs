//! What is no file to write to, or cannot be read.

use std::fs;
use std::io;
use std::os::unix::fs::{FileTypeExt, symlink};

use crate::attack::victim::{Finding, Victim};

const RUN: &[&str] = &["run", "heavy-top-lagrange", "--t-end", "0.1", "--no-verify"];

/// Writes to devices, directories and full disks, reads without end.
///
/// # Errors
/// If files cannot be made.
pub fn places(victim: &Victim) -> io::Result<Vec<Finding>> {
    let mut findings = Vec::new();
    let mut attempt = |arguments: &[&str], code: Option<i32>| -> io::Result<()> {
        match victim.run(arguments)? {
            Err(finding) => findings.push(finding),
            Ok(ended) => match code {
                Some(code) if ended.code != Some(code) => {
                    findings.push(ended.finding(format!("exit code {:?}, not {code}", ended.code)));
                }
                None if ended.code == Some(0) => findings.push(ended.finding("a failure that is not said")),
                _ => {}
            },
        }
        Ok(())
    };
    let run = |more: &[&'static str]| -> Vec<&str> { [RUN, more].concat() };
    fs::create_dir_all(victim.file("directory"))?;
    attempt(&run(&["-o", "directory"]), None)?;
    attempt(&run(&["-o", "directory/none/x.csv"]), None)?;
    attempt(&run(&["-o", "/dev/full"]), None)?;
    attempt(&run(&["--plot", "directory"]), None)?;
    attempt(&["check", "/dev/zero"], None)?;
    attempt(&["check", "directory"], None)?;
    attempt(&["emit", "heavy-top-lagrange", "--lang", "c", "-o", "/dev/null"], None)?;

    fs::write(victim.file("kept.csv"), "before")?;
    symlink("kept.csv", victim.file("link.csv"))?;
    attempt(&run(&["-o", "link.csv"]), Some(0))?;
    if !fs::symlink_metadata(victim.file("link.csv"))?.is_symlink()
        || fs::read(victim.file("kept.csv"))? == b"before"
    {
        findings.push(Finding {
            what: "a link was replaced, not followed".to_owned(),
            command: run(&["-o", "link.csv"]).join(" "),
            said: String::new(),
        });
    }
    // A device that is replaced stays replaced: this one is a copy, where copies may be made.
    let null = victim.file("null");
    let made = std::process::Command::new("mknod").arg(&null).args(["c", "1", "3"]).output()?;
    if made.status.success() {
        let checkpoint = ["--checkpoint", "null", "--every", "10", "-o", "kept.csv"];
        let arguments = run(&checkpoint);
        let ended = victim.run(&arguments)?;
        if !fs::metadata(&null)?.file_type().is_char_device() {
            let said = ended.map_or_else(|finding| finding.said, |ended| ended.said);
            findings.push(Finding {
                what: "a device was replaced".to_owned(),
                command: arguments.join(" "),
                said,
            });
        }
    }
    Ok(findings)
}
