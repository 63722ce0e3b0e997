//! NumPy's archive: `numpy.load(FILE)["name"]` is the column of that name.

use std::io::{self, Cursor, Write};

use npyz::WriterBuilder;
use zip::write::SimpleFileOptions;
use zip::{CompressionMethod, DateTime, ZipWriter};

use crate::table::Table;

/// One array of `f64` for each column; the archive bears no date, so that the same table gives the same bytes.
pub(super) fn write(table: &Table, out: &mut dyn Write) -> io::Result<()> {
    let options = SimpleFileOptions::default()
        .compression_method(CompressionMethod::Stored)
        .last_modified_time(DateTime::default());
    let mut archive = ZipWriter::new(Cursor::new(Vec::new()));
    for (j, name) in table.columns().iter().enumerate() {
        archive.start_file(format!("{name}.npy"), options)?;
        let mut array = npyz::WriteOptions::new()
            .default_dtype()
            .shape(&[table.len() as u64])
            .writer(&mut archive)
            .begin_nd()?;
        array.extend(table.column(j))?;
        array.finish()?;
    }
    out.write_all(archive.finish()?.get_ref())
}
