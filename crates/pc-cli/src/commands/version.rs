//! `pc --version`: the version, and what is built in.

use std::io::{self, Write};

use crate::error::CliError;
use crate::output::standard_output::print;
use crate::terminal::text::labelled;

/// Prints the version; where `verbose`, also what was built in, for which system, and what the processor offers.
///
/// # Errors
/// `FileError::Write`
pub fn command(verbose: bool) -> Result<(), CliError> {
    print(|out| write(verbose, out))
}

fn write(verbose: bool, out: &mut dyn Write) -> io::Result<()> {
    writeln!(out, "pc {}", env!("CARGO_PKG_VERSION"))?;
    if !verbose {
        return Ok(());
    }
    let mut features = vec!["machine code by Cranelift"];
    if cfg!(feature = "parquet") {
        features.push("parquet");
    }
    let build = if cfg!(debug_assertions) { "without optimisation: slow" } else { "optimised" };
    let lines = [
        ("features", features.join(", ")),
        ("SUNDIALS", pc_solve::sundials_version()),
        ("target", env!("PC_TARGET").to_owned()),
        ("build", build.to_owned()),
        ("processor", processor().join(" ")),
    ];
    lines.into_iter().try_for_each(|(label, line)| write!(out, "{}", labelled(label, 11, &[line])))
}

/// The instruction sets of this processor that make kernels fast.
#[cfg(target_arch = "x86_64")]
fn processor() -> Vec<&'static str> {
    let known = [
        ("sse4.1", is_x86_feature_detected!("sse4.1")),
        ("avx", is_x86_feature_detected!("avx")),
        ("avx2", is_x86_feature_detected!("avx2")),
        ("fma", is_x86_feature_detected!("fma")),
        ("avx512f", is_x86_feature_detected!("avx512f")),
    ];
    known.into_iter().filter(|(_, seen)| *seen).map(|(name, _)| name).collect()
}

#[cfg(not(target_arch = "x86_64"))]
fn processor() -> Vec<&'static str> {
    vec![std::env::consts::ARCH]
}
