//! The formats of tables.

use std::path::Path;

use crate::files::error::FileError;

/// The format of a table.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Format {
    /// Lines for people.
    Text,
    /// Comma-separated values, 17 significant digits.
    Csv,
    /// One JSON object.
    Json,
    /// NumPy's archive.
    Npz,
    /// A MAT-file.
    Mat,
    /// Apache Parquet.
    #[cfg(feature = "parquet")]
    Parquet,
}

impl Format {
    /// All formats.
    pub const ALL: &'static [Format] = &[
        Format::Text,
        Format::Csv,
        Format::Json,
        Format::Npz,
        Format::Mat,
        #[cfg(feature = "parquet")]
        Format::Parquet,
    ];
    /// The formats of tables of numbers and text.
    pub const OF_TABLES: &'static [Format] = &[
        Format::Csv,
        Format::Json,
        Format::Npz,
        #[cfg(feature = "parquet")]
        Format::Parquet,
    ];
    /// The formats of arrays.
    pub const OF_ARRAYS: &'static [Format] =
        &[Format::Text, Format::Json, Format::Csv, Format::Npz, Format::Mat];
    /// The formats of lists.
    pub const OF_LISTS: &'static [Format] = &[Format::Text, Format::Json, Format::Csv];
    /// The formats of comparisons.
    pub const OF_COMPARISONS: &'static [Format] = &[
        Format::Text,
        Format::Json,
        Format::Csv,
        Format::Npz,
        #[cfg(feature = "parquet")]
        Format::Parquet,
    ];

    /// Its name on the command line.
    pub fn name(self) -> &'static str {
        match self {
            Format::Text => "text",
            other => other.extension(),
        }
    }

    /// The extension of file names in this format.
    pub fn extension(self) -> &'static str {
        match self {
            Format::Text => "txt",
            Format::Csv => "csv",
            Format::Json => "json",
            Format::Npz => "npz",
            Format::Mat => "mat",
            #[cfg(feature = "parquet")]
            Format::Parquet => "parquet",
        }
    }

    /// Whether its bytes are no text.
    pub fn is_binary(self) -> bool {
        match self {
            Format::Text | Format::Csv | Format::Json => false,
            Format::Npz | Format::Mat => true,
            #[cfg(feature = "parquet")]
            Format::Parquet => true,
        }
    }

    /// The format in which a result that has some formats is written: the one that is asked for, whatever the name of the file,
    /// else the one of its ending; on standard output the first.
    ///
    /// # Errors
    /// [`FileError::Format`], [`FileError::UnknownExtension`]
    pub fn of(path: Option<&Path>, asked: Option<Format>, formats: &[Format]) -> Result<Format, FileError> {
        match (asked, path) {
            (Some(format), _) if formats.contains(&format) => Ok(format),
            (Some(format), _) => {
                let names: Vec<&str> = formats.iter().map(|format| format.name()).collect();
                Err(FileError::Format { format: format.name(), expected: listed(&names) })
            }
            (None, Some(path)) => {
                let extension = path.extension().and_then(|e| e.to_str()).map(str::to_ascii_lowercase);
                let format = formats.iter().find(|format| extension.as_deref() == Some(format.extension()));
                format.copied().ok_or_else(|| FileError::UnknownExtension {
                    option: "-o",
                    path: path.to_owned(),
                    expected: Format::expected(formats),
                })
            }
            (None, None) => Ok(formats.first().copied().unwrap_or(Format::Csv)),
        }
    }

    /// A phrase that lists the extensions of some formats.
    fn expected(formats: &[Format]) -> String {
        let endings: Vec<String> = formats.iter().map(|format| format!(".{}", format.extension())).collect();
        let listed = listed(&endings.iter().map(String::as_str).collect::<Vec<_>>());
        let is_missing = cfg!(not(feature = "parquet")) && formats == Format::OF_TABLES;
        let feature = " (.parquet where pc is built with its feature `parquet`)";
        if is_missing { listed + feature } else { listed }
    }
}

/// `a, b or c`
fn listed(names: &[&str]) -> String {
    match names.split_last() {
        Some((last, rest)) if !rest.is_empty() => format!("{} or {last}", rest.join(", ")),
        _ => names.concat(),
    }
}
