//! NumPy's archive: `numpy.load(FILE)["name"]` is the column of that name.

use std::io::{self, Error, ErrorKind};

use npyz::{DType, WriterBuilder};
use zip::write::SimpleFileOptions;
use zip::{CompressionMethod, DateTime, ZipWriter};

use crate::output::atomic::FileWriter;
use crate::output::npz::entry;
use crate::sweep::journal::Records;
use crate::sweep::sheet::{Cell, Column, Kind, Sheet};

/// One array for each column, of `f64`, `u64` or text; the archive has no date.
pub(super) fn write(sheet: &Sheet, members: &dyn Records, out: &mut FileWriter<'_>) -> io::Result<()> {
    let (rows, lengths) = extent(sheet, members)?;
    let options = SimpleFileOptions::default()
        .compression_method(CompressionMethod::Stored)
        .last_modified_time(DateTime::default())
        .large_file(true);
    let mut archive = ZipWriter::new(out);
    for (j, Column { name, kind }) in sheet.columns().iter().enumerate() {
        archive.start_file(format!("{}.npy", entry(name)), options)?;
        let dtype = match kind {
            Kind::Integer => "<u8".to_owned(),
            Kind::Number => "<f8".to_owned(),
            Kind::Text => format!("<U{}", lengths[j].max(1)),
        };
        let dtype = DType::new_scalar(dtype.parse().map_err(|e| Error::new(ErrorKind::InvalidInput, e))?);
        let table = (sheet, members, rows);
        match kind {
            Kind::Integer => fill(&mut archive, dtype, table, |row| match row[j] {
                Cell::Integer(value) => value,
                Cell::Number(_) | Cell::Text(_) => 0,
            })?,
            Kind::Number => fill(&mut archive, dtype, table, |row| match row[j] {
                Cell::Number(value) => value,
                Cell::Integer(_) | Cell::Text(_) => f64::NAN,
            })?,
            Kind::Text => fill(&mut archive, dtype, table, |row| match row[j] {
                Cell::Text(text) => text.to_owned(),
                Cell::Integer(_) | Cell::Number(_) => String::new(),
            })?,
        }
    }
    archive.finish()?;
    Ok(())
}

/// The number of rows, and of characters of the longest text of each column.
fn extent(sheet: &Sheet, members: &dyn Records) -> io::Result<(u64, Vec<usize>)> {
    let (mut rows, mut lengths) = (0, vec![0; sheet.columns().len()]);
    for record in members.records()? {
        for row in sheet.rows(&record?)? {
            rows += 1;
            for (longest, cell) in lengths.iter_mut().zip(row) {
                if let Cell::Text(text) = cell {
                    *longest = text.chars().count().max(*longest);
                }
            }
        }
    }
    Ok((rows, lengths))
}

/// Writes one column as an array.
fn fill<T: npyz::Serialize>(
    archive: &mut ZipWriter<&mut FileWriter<'_>>,
    dtype: DType,
    (sheet, members, rows): (&Sheet, &dyn Records, u64),
    value: impl Fn(&[Cell<'_>]) -> T,
) -> io::Result<()> {
    let mut array = npyz::WriteOptions::new().dtype(dtype).shape(&[rows]).writer(archive).begin_nd()?;
    for record in members.records()? {
        for row in sheet.rows(&record?)? {
            array.push(&value(&row))?;
        }
    }
    array.finish()
}
