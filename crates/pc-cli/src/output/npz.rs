//! NumPy's archive: `numpy.load(FILE)["name"]` is the column of that name.

use std::io;

use npyz::WriterBuilder;
use zip::write::SimpleFileOptions;
use zip::{CompressionMethod, DateTime, ZipWriter};

use crate::motion::run::Run;
use crate::output::atomic::FileWriter;

/// The length in numbers from which an entry needs the archive format for more than 4 GiB.
const LARGE: u64 = (1 << 29) - 1024;

/// One array of `f64` for each column, and `events/NAME` with the times of each event; the archive
/// has no date, so that the same run gives the same bytes.
pub(super) fn write(run: &Run, out: &mut FileWriter<'_>) -> io::Result<()> {
    let options = SimpleFileOptions::default()
        .compression_method(CompressionMethod::Stored)
        .last_modified_time(DateTime::default());
    let mut archive = ZipWriter::new(out);
    let mut add = |name: &str, values: &mut dyn ExactSizeIterator<Item = f64>| {
        let large = values.len() as u64 >= LARGE;
        archive.start_file(format!("{}.npy", entry(name)), options.large_file(large))?;
        let mut array = npyz::WriteOptions::new()
            .default_dtype()
            .shape(&[values.len() as u64])
            .writer(&mut archive)
            .begin_nd()?;
        array.extend(values)?;
        array.finish()
    };
    for (j, name) in run.table.columns().iter().enumerate() {
        add(name, &mut run.table.column(j))?;
    }
    for (event, name) in run.events.iter().enumerate() {
        let times = run.occurrences.iter().filter(|(number, _)| *number == event);
        let times: Vec<f64> = times.map(|&(_, t)| t).collect();
        add(&format!("events/{name}"), &mut times.into_iter())?;
    }
    archive.finish()?;
    Ok(())
}

/// The name of a column as that of an entry of an archive, which stays in the directory where it is
/// unpacked: `%` and what could leave it, such as the slash in `../x`, are percent-encoded.
pub(crate) fn entry(name: &str) -> String {
    let leads = |c: Option<char>| matches!(c, None | Some('.' | '/'));
    let mut entry = String::with_capacity(name.len());
    let (mut before, mut chars) = (None, name.chars().peekable());
    while let Some(c) = chars.next() {
        let acts = match c {
            '/' => leads(before) || leads(chars.peek().copied()),
            c => matches!(c, '%' | '\\' | ':') || c.is_control(),
        };
        if acts {
            let mut bytes = [0; 4];
            entry.extend(c.encode_utf8(&mut bytes).bytes().map(|byte| format!("%{byte:02X}")));
        } else {
            entry.push(c);
        }
        before = Some(c);
    }
    entry
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn entries_stay_inside_the_archive() {
        for same in ["x", "x'", "∂x/∂p", "events/bounce", "λ_no slip", ".."] {
            assert_eq!(entry(same), same);
        }
        assert_eq!(entry("events/../../x"), "events%2F..%2F..%2Fx");
        assert_eq!(entry("/etc/x"), "%2Fetc/x");
        assert_eq!(entry("λ_a//b\\c%2F\n"), "λ_a%2F%2Fb%5Cc%252F%0A");
    }
}
