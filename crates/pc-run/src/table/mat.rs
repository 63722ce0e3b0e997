//! MAT-files of level 5, which MATLAB, GNU Octave and SciPy can read (The MathWorks, MAT-File Format).

use std::io::{self, Write};

use crate::table::array::Array;

/// Types of data.
const INT8: u32 = 1;
const INT32: u32 = 5;
const UINT32: u32 = 6;
const DOUBLE: u32 = 9;
const UINT16: u32 = 4;
const MATRIX: u32 = 14;

/// Classes of arrays, and the flag that marks complex ones.
const CHARACTERS: u32 = 4;
const DOUBLES: u32 = 6;
const COMPLEX: u32 = 1 << 11;

/// Writes arrays of numbers, then strings, each as one row of characters. The file has no date: the same
/// numbers give the same bytes.
pub(crate) fn write(arrays: &[Array], texts: &[(&str, String)], out: &mut dyn Write) -> io::Result<()> {
    let mut header = b"MATLAB 5.0 MAT-file, written by pc".to_vec();
    header.resize(124, b' ');
    header.extend(0x0100u16.to_le_bytes());
    header.extend(b"IM"); // little-endian
    out.write_all(&header)?;
    for array in arrays {
        let flags = DOUBLES | array.imaginary.as_ref().map_or(0, |_| COMPLEX);
        let parts = [Some(&array.real), array.imaginary.as_ref()];
        let parts = parts.into_iter().flatten().map(|part| element(DOUBLE, &by_columns(array, part)));
        variable(&array.name, flags, (array.rows, array.columns), &parts.collect::<Vec<_>>().concat(), out)?;
    }
    for (name, text) in texts {
        let units: Vec<u16> = text.encode_utf16().collect();
        let bytes: Vec<u8> = units.iter().flat_map(|unit| unit.to_le_bytes()).collect();
        let rows = usize::from(!units.is_empty());
        variable(name, CHARACTERS, (rows, units.len()), &element(UINT16, &bytes), out)?;
    }
    Ok(())
}

fn variable(
    name: &str,
    flags: u32,
    (rows, columns): (usize, usize),
    data: &[u8],
    out: &mut dyn Write,
) -> io::Result<()> {
    let too_large = |_| io::Error::new(io::ErrorKind::InvalidInput, "too large for a MAT-file of level 5");
    let rows = i32::try_from(rows).map_err(too_large)?;
    let columns = i32::try_from(columns).map_err(too_large)?;
    let body = [
        element(UINT32, &[flags.to_le_bytes(), [0; 4]].concat()),
        element(INT32, &[rows.to_le_bytes(), columns.to_le_bytes()].concat()),
        element(INT8, name.as_bytes()),
        data.to_vec(),
    ]
    .concat();
    u32::try_from(body.len()).map_err(too_large)?;
    out.write_all(&element(MATRIX, &body))
}

/// A tag of eight bytes, then the data, padded to a multiple of eight bytes.
fn element(kind: u32, data: &[u8]) -> Vec<u8> {
    let mut bytes = kind.to_le_bytes().to_vec();
    bytes.extend((data.len() as u32).to_le_bytes());
    bytes.extend(data);
    bytes.resize(bytes.len().next_multiple_of(8), 0);
    bytes
}

fn by_columns(array: &Array, numbers: &[f64]) -> Vec<u8> {
    let order = (0..array.columns).flat_map(|j| (0..array.rows).map(move |i| i * array.columns + j));
    order.flat_map(|place| numbers[place].to_le_bytes()).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The file is compared byte by byte with what the format prescribes.
    #[test]
    fn an_array_is_a_matrix_by_columns() {
        let array = Array {
            name: "A".to_owned(),
            rows: 1,
            columns: 2,
            is_list: false,
            real: vec![1.0, 2.0],
            imaginary: None,
        };
        let mut bytes = Vec::new();
        write(&[array], &[("n", "δ,x".to_owned())], &mut bytes).expect("written");
        assert_eq!((bytes.len() % 8, &bytes[124..128]), (0, &[0, 1, b'I', b'M'][..]));
        let word = |place: usize| u32::from_le_bytes(bytes[place..place + 4].try_into().expect("four"));
        let number = |place: usize| f64::from_le_bytes(bytes[place..place + 8].try_into().expect("eight"));
        // Tag of the matrix; flags; dimensions; name; numbers.
        assert_eq!([word(128), word(132)], [14, 16 + 16 + 16 + 8 + 16]);
        assert_eq!([word(136), word(140), word(144)], [6, 8, 6]);
        assert_eq!([word(152), word(156), word(160), word(164)], [5, 8, 1, 2]);
        assert_eq!([word(168), word(172), u32::from(bytes[176])], [1, 1, u32::from(b'A')]);
        assert_eq!([word(184), word(188)], [9, 16]);
        assert_eq!([number(192), number(200)], [1.0, 2.0]);
        assert_eq!(word(208 + 8 + 8), 4, "characters");
    }
}
