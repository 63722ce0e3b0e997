//! NumPy archives: `numpy.load(FILE)["name"]` is the array with that name.

use std::io::{self, Error, ErrorKind, Seek, Write};

use npyz::{DType, WriterBuilder};
use zip::write::SimpleFileOptions;
use zip::{CompressionMethod, DateTime, ZipWriter};

use crate::table::array::Array;
use crate::table::rows::{Cell, CellKind, Rows};

/// The smallest number of values for which an entry needs the archive format for more than 4 GiB.
const LARGE: u64 = (1 << 29) - 1024;

/// The options for entries. The archive has no date, so that the same numbers give the same bytes.
fn options() -> SimpleFileOptions {
    SimpleFileOptions::default()
        .compression_method(CompressionMethod::Stored)
        .last_modified_time(DateTime::default())
}

/// Writes an array of `f64`, `u64` or text for each column, then the `lists`.
///
/// # Errors
/// [`io::Error`]
pub(crate) fn write(
    table: &dyn Rows,
    lists: &[(String, Vec<f64>)],
    out: &mut (impl Write + Seek),
) -> io::Result<()> {
    let columns = table.columns();
    let texts = columns.iter().any(|column| column.kind == CellKind::Text);
    let (rows, lengths) = match table.count() {
        Some(rows) if !texts => (rows, vec![0; columns.len()]),
        _ => extent(table, columns.len())?,
    };
    // Where the length is found by reading, an entry is large whatever it is.
    let is_large = |length: u64| table.count().is_none() || length >= LARGE;
    let mut archive = ZipWriter::new(out);
    for (j, column) in columns.iter().enumerate() {
        let options = options().large_file(is_large(rows));
        archive.start_file(format!("{}.npy", entry(&column.name)), options)?;
        let dtype = match column.kind {
            CellKind::Integer => "<u8".to_owned(),
            CellKind::Number => "<f8".to_owned(),
            CellKind::Text => format!("<U{}", lengths[j].max(1)),
        };
        let dtype = DType::new_scalar(dtype.parse().map_err(|e| Error::new(ErrorKind::InvalidInput, e))?);
        match column.kind {
            CellKind::Integer => fill(&mut archive, dtype, (table, j, rows), |cell| match cell {
                Cell::Integer(value) => value,
                Cell::Number(_) | Cell::Text(_) => 0,
            })?,
            CellKind::Number => fill(&mut archive, dtype, (table, j, rows), |cell| match cell {
                Cell::Number(value) => value,
                Cell::Integer(_) | Cell::Text(_) => f64::NAN,
            })?,
            CellKind::Text => fill(&mut archive, dtype, (table, j, rows), |cell| match cell {
                Cell::Text(text) => text.to_owned(),
                Cell::Integer(_) | Cell::Number(_) => String::new(),
            })?,
        }
    }
    for (name, values) in lists {
        let length = values.len() as u64;
        archive.start_file(format!("{}.npy", entry(name)), options().large_file(is_large(length)))?;
        numbers(&mut archive, &[length], values.iter().copied())?;
    }
    archive.finish()?;
    Ok(())
}

/// Writes each of the arrays; a complex array has a final axis for the real and imaginary parts.
///
/// # Errors
/// [`io::Error`]
pub(crate) fn write_arrays(arrays: &[Array], out: &mut (impl Write + Seek)) -> io::Result<()> {
    let mut archive = ZipWriter::new(out);
    for array in arrays {
        archive.start_file(format!("{}.npy", entry(&array.name)), options())?;
        let columns = (!array.is_list).then_some(array.columns as u64);
        let parts = array.imaginary.as_ref().map(|_| 2);
        let shape: Vec<u64> = [Some(array.rows as u64), columns, parts].into_iter().flatten().collect();
        match &array.imaginary {
            Some(imaginary) => {
                let parts = array.real.iter().zip(imaginary).flat_map(|(&re, &im)| [re, im]);
                numbers(&mut archive, &shape, parts)?;
            }
            None => numbers(&mut archive, &shape, array.real.iter().copied())?,
        }
    }
    archive.finish()?;
    Ok(())
}

fn numbers<W: Write + Seek>(
    archive: &mut ZipWriter<W>,
    shape: &[u64],
    values: impl Iterator<Item = f64>,
) -> io::Result<()> {
    let mut array = npyz::WriteOptions::new().default_dtype().shape(shape).writer(archive).begin_nd()?;
    array.extend(values)?;
    array.finish()
}

/// The number of rows, and the number of characters in the longest text of each column.
fn extent(table: &dyn Rows, columns: usize) -> io::Result<(u64, Vec<usize>)> {
    let (mut rows, mut lengths) = (0, vec![0; columns]);
    table.each(&mut |row| {
        rows += 1;
        for (longest, cell) in lengths.iter_mut().zip(row) {
            if let Cell::Text(text) = cell {
                *longest = text.chars().count().max(*longest);
            }
        }
        Ok(())
    })?;
    Ok((rows, lengths))
}

/// Writes one column as an array.
fn fill<T: npyz::Serialize, W: Write + Seek>(
    archive: &mut ZipWriter<W>,
    dtype: DType,
    (table, j, rows): (&dyn Rows, usize, u64),
    value: impl Fn(Cell<'_>) -> T,
) -> io::Result<()> {
    let mut array = npyz::WriteOptions::new().dtype(dtype).shape(&[rows]).writer(archive).begin_nd()?;
    table.each_of(j, &mut |cell| array.push(&value(cell)))?;
    array.finish()
}

/// The name of a column as the name of an archive entry, which cannot leave the directory in which the
/// archive is unpacked: `%` and everything that could lead out of it, such as the slash in `../x`, are
/// percent-encoded.
fn entry(name: &str) -> String {
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
