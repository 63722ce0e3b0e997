//! Apache Parquet.

use std::io;
use std::sync::Arc;

use parquet::basic::{LogicalType, Repetition, Type as Physical};
use parquet::data_type::{ByteArray, ByteArrayType, DoubleType, Int64Type};
use parquet::errors::ParquetError;
use parquet::file::metadata::KeyValue;
use parquet::file::properties::WriterProperties;
use parquet::file::writer::{SerializedFileWriter, SerializedRowGroupWriter};
use parquet::schema::types::Type;

use crate::table::rows::{self, Cell, CellKind, Rows};

/// The largest number of rows held in memory.
const GROUP: usize = 65_536;

/// One column of a group of rows.
enum Column {
    Integers(Vec<i64>),
    Numbers(Vec<f64>),
    Texts(Vec<ByteArray>),
}

/// Writes a table, with metadata as pairs of a key and a value, and with required columns of types INT64 (unsigned), DOUBLE and BYTE_ARRAY (UTF-8), without
/// compression.
///
/// # Errors
/// [`io::Error`]
pub(crate) fn write(
    name: &str,
    table: &dyn Rows,
    said: &[(&str, String)],
    out: impl io::Write + Send,
) -> io::Result<()> {
    let columns = table.columns();
    let schema = schema(name, &columns).map_err(io::Error::other)?;
    let said = said.iter().map(|(key, value)| KeyValue::new((*key).to_owned(), value.clone())).collect();
    let properties = Arc::new(WriterProperties::builder().set_key_value_metadata(Some(said)).build());
    let mut file = SerializedFileWriter::new(out, Arc::new(schema), properties).map_err(io::Error::other)?;
    let (mut group, mut rows) = (empty(&columns), 0);
    table.each(&mut |row| {
        group.iter_mut().zip(row).for_each(|(column, cell)| column.push(*cell));
        rows += 1;
        if rows == GROUP {
            flush(file.next_row_group().map_err(io::Error::other)?, &group).map_err(io::Error::other)?;
            (group, rows) = (empty(&columns), 0);
        }
        Ok(())
    })?;
    if rows > 0 {
        flush(file.next_row_group().map_err(io::Error::other)?, &group).map_err(io::Error::other)?;
    }
    file.close().map(drop).map_err(io::Error::other)
}

fn schema(name: &str, columns: &[rows::Column]) -> Result<Type, ParquetError> {
    let field = |rows::Column { name, kind }: &rows::Column| {
        let (physical, logical) = match kind {
            CellKind::Integer => (Physical::INT64, Some(LogicalType::integer(64, false))),
            CellKind::Number => (Physical::DOUBLE, None),
            CellKind::Text => (Physical::BYTE_ARRAY, Some(LogicalType::String)),
        };
        let builder = Type::primitive_type_builder(name, physical).with_repetition(Repetition::REQUIRED);
        builder.with_logical_type(logical).build().map(Arc::new)
    };
    let fields = columns.iter().map(field).collect::<Result<_, _>>()?;
    Type::group_type_builder(name).with_fields(fields).build()
}

fn empty(columns: &[rows::Column]) -> Vec<Column> {
    let column = |column: &rows::Column| match column.kind {
        CellKind::Integer => Column::Integers(Vec::new()),
        CellKind::Number => Column::Numbers(Vec::new()),
        CellKind::Text => Column::Texts(Vec::new()),
    };
    columns.iter().map(column).collect()
}

impl Column {
    fn push(&mut self, cell: Cell<'_>) {
        match (self, cell) {
            (Column::Integers(column), Cell::Integer(value)) => column.push(value.cast_signed()),
            (Column::Numbers(column), Cell::Number(value)) => column.push(value),
            (Column::Texts(column), Cell::Text(text)) => column.push(ByteArray::from(text)),
            // A cell always has the kind of its column.
            _ => {}
        }
    }
}

fn flush<W: io::Write + Send>(
    mut group: SerializedRowGroupWriter<'_, W>,
    columns: &[Column],
) -> Result<(), ParquetError> {
    for values in columns {
        let Some(mut column) = group.next_column()? else { break };
        match values {
            Column::Integers(values) => column.typed::<Int64Type>().write_batch(values, None, None)?,
            Column::Numbers(values) => column.typed::<DoubleType>().write_batch(values, None, None)?,
            Column::Texts(values) => column.typed::<ByteArrayType>().write_batch(values, None, None)?,
        };
        column.close()?;
    }
    group.close().map(drop)
}
