//! What a benchmark prints and leaves behind.

use std::env;
use std::fmt::Display;
use std::fs;
use std::path::PathBuf;

use crate::error::Error;
use crate::measure::Times;

/// Markdown that is printed line by line and saved at the end.
pub(crate) struct Report {
    name: &'static str,
    text: String,
}

impl Report {
    /// A report with its heading.
    pub(crate) fn new(name: &'static str, about: &str) -> Report {
        let mut report = Report { name, text: String::new() };
        report.line(format!("# bench {name}: {about}\n"));
        if cfg!(debug_assertions) {
            report.line("**Compiled without optimisation: these times mean nothing.**\n");
        }
        report
    }

    /// Adds and prints a line.
    pub(crate) fn line(&mut self, line: impl Display) {
        println!("{line}");
        self.text.push_str(&format!("{line}\n"));
    }

    /// Adds a table's heading.
    pub(crate) fn columns(&mut self, names: &[&str]) {
        self.line(format!("| {} |", names.join(" | ")));
        let rules: Vec<&str> =
            names.iter().enumerate().map(|(i, _)| if i == 0 { "---" } else { "---:" }).collect();
        self.line(format!("| {} |", rules.join(" | ")));
    }

    /// Adds a row of a table.
    pub(crate) fn row(&mut self, cells: &[String]) {
        self.line(format!("| {} |", cells.join(" | ")));
    }

    /// Writes the report to `bench/NAME.md` in the target directory.
    pub(crate) fn save(&self) -> Result<(), Error> {
        let directory = target_directory().join("bench");
        let path = directory.join(format!("{}.md", self.name));
        fs::create_dir_all(&directory)
            .and_then(|()| fs::write(&path, &self.text))
            .map_err(|source| Error::Write { path: path.clone(), source })?;
        eprintln!("\nwritten to {}\n", path.display());
        Ok(())
    }
}

/// The target directory we were built in.
pub(crate) fn target_directory() -> PathBuf {
    let program = env::current_exe().unwrap_or_default();
    program.ancestors().nth(2).map_or_else(|| PathBuf::from("target"), PathBuf::from)
}

/// `min / p10 / median` with so many decimals.
pub(crate) fn triple(times: &Times, decimals: usize) -> String {
    format!("{:.decimals$} / {:.decimals$} / {:.decimals$}", times.min(), times.p10(), times.median())
}
