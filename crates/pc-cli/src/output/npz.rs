//! NumPy's archive: `numpy.load(FILE)["name"]` is the column of that name.

use std::io::{self, Cursor, Write};

use npyz::WriterBuilder;
use zip::write::SimpleFileOptions;
use zip::{CompressionMethod, DateTime, ZipWriter};

use crate::motion::run::Run;

/// One array of `f64` for each column, and `events/NAME` with its times for each event; the archive bears no date, so that
/// the same run gives the same bytes.
pub(super) fn write(run: &Run, out: &mut dyn Write) -> io::Result<()> {
    let options = SimpleFileOptions::default()
        .compression_method(CompressionMethod::Stored)
        .last_modified_time(DateTime::default());
    let mut archive = ZipWriter::new(Cursor::new(Vec::new()));
    let mut add = |name: String, values: Vec<f64>| {
        archive.start_file(format!("{name}.npy"), options)?;
        let mut array = npyz::WriteOptions::new()
            .default_dtype()
            .shape(&[values.len() as u64])
            .writer(&mut archive)
            .begin_nd()?;
        array.extend(values)?;
        array.finish()
    };
    for (j, name) in run.table.columns().iter().enumerate() {
        add(name.clone(), run.table.column(j).collect())?;
    }
    for (event, name) in run.events.iter().enumerate() {
        let times = run.occurrences.iter().filter(|(number, _)| *number == event);
        add(format!("events/{name}"), times.map(|&(_, t)| t).collect())?;
    }
    out.write_all(archive.finish()?.get_ref())
}
