//! Typed access to TOML values, with errors that show where a type is wrong.

use std::ops::Range;

use pc_expr::parse::{Ast, AstKind, Declared, FUNCTIONS, Span, is_name, nearest, parse_with};
use toml::Spanned;
use toml::de::{DeArray, DeInteger, DeString, DeTable, DeValue};

use super::hidden::is_hidden;
use super::text_map::TextMap;
use crate::diagnostics::error::ModelError;
use crate::diagnostics::error_kind::ErrorKind;
use crate::diagnostics::source::{Place, Source};
use crate::document::expression::{Expression, Located, Name, NamedExpression};

/// A TOML table and the path of its entries.
#[derive(Clone)]
pub(super) struct Table<'a> {
    source: &'a Source,
    /// The functions that expressions may call besides those of the language.
    functions: &'a [Declared],
    pub(super) place: Place,
    entries: &'a DeTable<'a>,
}

/// One entry of a table, or one element of an array.
#[derive(Clone)]
pub(super) struct Item<'a> {
    source: &'a Source,
    functions: &'a [Declared],
    key: &'a str,
    /// The bytes of the key as written, including quotes.
    key_span: Range<usize>,
    /// The path of the entry, and the bytes of its value.
    place: Place,
    value: &'a DeValue<'a>,
}

/// Whether a name has a fixed meaning.
pub(super) fn is_reserved(name: &str) -> bool {
    matches!(name, "t" | "pi" | "energy") || FUNCTIONS.iter().any(|function| function.name == name)
}

impl<'a> Table<'a> {
    /// The whole file.
    pub(super) fn root(source: &'a Source, entries: &'a DeTable<'a>, functions: &'a [Declared]) -> Self {
        Self { source, functions, place: Place::default(), entries }
    }

    pub(super) fn items(&self) -> impl Iterator<Item = Item<'a>> {
        let (source, functions, path) = (self.source, self.functions, self.place.entry.clone());
        self.entries.iter().map(move |(key, value): (&Spanned<DeString<'a>>, _)| {
            let name = key.get_ref();
            let entry = match path.as_str() {
                "" => String::new(),
                section if section.ends_with(']') => format!("{section} {name}"),
                outer => format!("{outer}.{name}"),
            };
            let place = Place { entry, span: value.span() };
            Item { source, functions, key: name, key_span: key.span(), place, value: value.get_ref() }
        })
    }

    pub(super) fn error(&self, kind: ErrorKind) -> ModelError {
        self.source.error(&self.place, kind)
    }

    pub(super) fn has(&self, key: &str) -> bool {
        self.entries.contains_key(key)
    }

    /// An expression implied by the text at a place in the file.
    pub(super) fn following(&self, text: String, place: &Place) -> Result<Expression, ModelError> {
        Expression::following(self.source, text, place)
    }

    /// The entries as `name = "expression"`, whose names are declared elsewhere; the velocity `x'` of a
    /// coordinate stands for the coordinate.
    pub(super) fn on_velocities(&self) -> Result<Vec<NamedExpression>, ModelError> {
        let entry = |item: Item<'a>| {
            let name = item.velocity().map_or_else(|| item.name(), Ok)?;
            Ok(NamedExpression { name, expression: item.expression()? })
        };
        self.items().map(entry).collect()
    }

    /// The entries as `name = "expression"`, whose names are declared elsewhere.
    pub(super) fn expressions(&self) -> Result<Vec<NamedExpression>, ModelError> {
        self.items()
            .map(|item| Ok(NamedExpression { name: item.name()?, expression: item.expression()? }))
            .collect()
    }

    /// The entries as `name = "expression"`, which declare these names.
    pub(super) fn declarations(&self) -> Result<Vec<NamedExpression>, ModelError> {
        self.items()
            .map(|item| Ok(NamedExpression { name: item.new_name()?, expression: item.expression()? }))
            .collect()
    }
}

impl<'a> Item<'a> {
    pub(super) fn place(&self) -> Place {
        self.place.clone()
    }

    pub(super) fn key(&self) -> &'a str {
        self.key
    }

    pub(super) fn is_table(&self) -> bool {
        self.value.is_table()
    }

    /// The entry, whose expressions may call only the first `count` of the declared functions.
    pub(super) fn with_functions_before(&self, count: usize) -> Item<'a> {
        Item { functions: &self.functions[..count.min(self.functions.len())], ..self.clone() }
    }

    /// An error about the value.
    pub(super) fn error(&self, kind: impl Into<ErrorKind>) -> ModelError {
        self.source.error(&self.place, kind)
    }

    /// An error about the key.
    pub(super) fn key_error(&self, kind: ErrorKind) -> ModelError {
        self.source.error(&Place { entry: self.place.entry.clone(), span: self.key_span.clone() }, kind)
    }

    pub(super) fn unknown(&self, allowed: &'static [&'static str]) -> ModelError {
        let nearest = nearest(self.key, allowed.iter().copied());
        self.key_error(ErrorKind::UnknownKey { key: self.key.into(), allowed, nearest })
    }

    fn wrong_type(&self, expected: &'static str, example: &str) -> ModelError {
        let found = match self.value {
            DeValue::String(_) => "a string",
            DeValue::Integer(_) | DeValue::Float(_) => "a number",
            DeValue::Boolean(_) => "a boolean",
            DeValue::Datetime(_) => "a date",
            DeValue::Array(array) if array.iter().all(|element| element.get_ref().is_table()) => {
                "an array of tables"
            }
            DeValue::Array(_) => "an array",
            DeValue::Table(_) => "a table",
        };
        let example = match self.source.slice(self.key_span.clone()) {
            "" => example.into(),
            key => format!("{key} = {example}"),
        };
        self.error(ErrorKind::WrongType { expected, found, example })
    }

    /// The key as a label, such as that of a body.
    pub(super) fn label(&self) -> Name {
        let raw = self.source.slice(self.key_span.clone());
        let span = TextMap::new(raw, self.key_span.start, self.key).locate(0..self.key.len());
        Name { text: self.key.into(), place: Place { entry: self.place.entry.clone(), span } }
    }

    /// The key as a label, which need not be a name but must not contain hidden characters.
    pub(super) fn new_label(&self) -> Result<Name, ModelError> {
        if self.key.contains(is_hidden) {
            return Err(self.key_error(ErrorKind::HiddenInLabel { label: self.key.into() }));
        }
        Ok(self.label())
    }

    /// The key as the name of something declared elsewhere.
    pub(super) fn name(&self) -> Result<Name, ModelError> {
        if is_name(self.key) {
            return Ok(self.label());
        }
        Err(self.key_error(ErrorKind::NotAName { key: self.key.into() }))
    }

    /// The key as a name declared by this entry.
    pub(super) fn new_name(&self) -> Result<Name, ModelError> {
        let name = self.name()?;
        match is_reserved(&name.text) {
            true => Err(self.key_error(ErrorKind::Reserved { name: name.text })),
            false => Ok(name),
        }
    }

    /// A name derived from the key, with the place of the key.
    pub(super) fn derived_name(&self, text: String) -> Result<Name, ModelError> {
        match text.as_str() {
            name if !is_name(name) => Err(self.key_error(ErrorKind::NotAName { key: text })),
            name if is_reserved(name) => Err(self.key_error(ErrorKind::Reserved { name: text })),
            _ => Ok(Name { text, place: self.label().place }),
        }
    }

    /// The value as a name declared by this entry.
    pub(super) fn value_as_name(&self) -> Result<Name, ModelError> {
        let Located { value: text, place } = self.text()?;
        match text.as_str() {
            name if !is_name(name) => Err(self.error(ErrorKind::NotAName { key: text })),
            name if is_reserved(name) => Err(self.error(ErrorKind::Reserved { name: text })),
            _ => Ok(Name { text, place }),
        }
    }

    /// The key `x'`, as the name `x`.
    pub(super) fn velocity(&self) -> Option<Name> {
        let coordinate = self.key.strip_suffix('\'').filter(|name| is_name(name))?;
        Some(Name { text: coordinate.into(), place: self.label().place })
    }

    /// The two names of a key such as `w1,w2`.
    pub(super) fn pair(&self) -> Result<(Name, Name), ModelError> {
        let not_a_pair = || self.key_error(ErrorKind::NotAPair { key: self.key.into() });
        let (left, right) = self.key.split_once(',').ok_or_else(not_a_pair)?;
        let raw = self.source.slice(self.key_span.clone());
        let map = TextMap::new(raw, self.key_span.start, self.key);
        let name = |part: &str, from: usize| {
            let text = part.trim();
            let start = from + (part.len() - part.trim_start().len());
            let span = map.locate(start..start + text.len());
            let place = Place { entry: self.place.entry.clone(), span };
            is_name(text).then(|| Name { text: text.into(), place }).ok_or_else(not_a_pair)
        };
        Ok((name(left, 0)?, name(right, left.len() + 1)?))
    }

    pub(super) fn located<T>(&self, value: T) -> Located<T> {
        Located { value, place: self.place.clone() }
    }

    /// The value as a separate table.
    pub(super) fn table(&self, expected: &'static str, example: &str) -> Result<Table<'a>, ModelError> {
        match self.value {
            DeValue::Table(entries) => {
                let (source, functions) = (self.source, self.functions);
                Ok(Table { source, functions, place: self.place.clone(), entries })
            }
            _ => Err(self.wrong_type(expected, example)),
        }
    }

    /// The value as a section of the file, under the header `[name]`.
    pub(super) fn section(&self, name: &str, example: &str) -> Result<Table<'a>, ModelError> {
        if self.is_table() {
            let mut section = self.table("", "")?;
            section.place.entry = format!("[{name}]");
            return Ok(section);
        }
        Err(Item { key_span: 0..0, ..self.clone() }.wrong_type("a section", example))
    }

    /// The value as the entries under headers such as `[[name]]`.
    pub(super) fn entries(&self, header: &'static str) -> Result<Vec<Item<'a>>, ModelError> {
        match self.value {
            DeValue::Array(array) if array.iter().all(|element| element.get_ref().is_table()) => {
                let entry = |item: Item<'a>| Item {
                    place: Place { entry: header.to_owned(), ..item.place.clone() },
                    ..item
                };
                Ok(self.elements(array).map(entry).collect())
            }
            _ => Err(Item { key_span: 0..0, ..self.clone() }.wrong_type(header, header)),
        }
    }

    pub(super) fn text(&self) -> Result<Located<String>, ModelError> {
        match self.value {
            DeValue::String(text) => Ok(self.located(text.to_string())),
            _ => Err(self.wrong_type("a string", "\"…\"")),
        }
    }

    pub(super) fn is_boolean(&self) -> bool {
        matches!(self.value, DeValue::Boolean(_))
    }

    pub(super) fn is_number(&self) -> bool {
        matches!(self.value, DeValue::Integer(_) | DeValue::Float(_))
    }

    pub(super) fn boolean(&self) -> Result<Located<bool>, ModelError> {
        match self.value {
            DeValue::Boolean(value) => Ok(self.located(*value)),
            _ => Err(self.wrong_type("a boolean", "true")),
        }
    }

    /// The value, which must be one of the words in `choices`.
    pub(super) fn choice<T: Copy>(&self, choices: &[(&'static str, T)]) -> Result<Located<T>, ModelError> {
        let text = self.text()?.value;
        if let Some((_, value)) = choices.iter().find(|(word, _)| *word == text) {
            return Ok(self.located(*value));
        }
        let allowed: Vec<_> = choices.iter().map(|(word, _)| *word).collect();
        let nearest = nearest(&text, allowed.iter().copied());
        Err(self.error(ErrorKind::UnknownChoice { found: text, allowed, nearest }))
    }

    /// The value as a finite number.
    pub(super) fn number(&self) -> Result<Located<f64>, ModelError> {
        match self.numeric()? {
            Some(value) => Ok(self.located(value)),
            None => Err(self.wrong_type("a number", "1.0")),
        }
    }

    /// The value as a whole number.
    pub(super) fn integer(&self) -> Result<Located<i64>, ModelError> {
        match self.value {
            DeValue::Integer(digits) => Ok(self.located(self.exact(digits)?)),
            DeValue::Float(_) => Err(self.error(ErrorKind::OutOfRange {
                expected: "a whole number",
                found: self.raw().into(),
                example: "samples = 101",
            })),
            _ => Err(self.wrong_type("a whole number", "101")),
        }
    }

    pub(super) fn raw(&self) -> &'a str {
        self.source.slice(self.place.span.clone())
    }

    fn numeric(&self) -> Result<Option<f64>, ModelError> {
        match self.value {
            DeValue::Integer(digits) => Ok(Some(self.exact(digits)? as f64)),
            DeValue::Float(digits) => match digits.as_str().parse::<f64>() {
                Ok(value) if value.is_finite() => Ok(Some(value)),
                _ => Err(self.error(ErrorKind::NotFinite { text: self.raw().into() })),
            },
            _ => Ok(None),
        }
    }

    /// An integer that a floating-point number holds exactly.
    fn exact(&self, digits: &DeInteger<'_>) -> Result<i64, ModelError> {
        match i64::from_str_radix(digits.as_str(), digits.radix()) {
            Ok(value) if value.unsigned_abs() <= 1 << f64::MANTISSA_DIGITS => Ok(value),
            _ => Err(self.error(ErrorKind::IntegerTooLarge { text: self.raw().into() })),
        }
    }

    /// The value as an expression: a string, or a number.
    pub(super) fn expression(&self) -> Result<Expression, ModelError> {
        let entry = self.place.entry.clone();
        let (raw, start) = (self.raw(), self.place.span.start);
        if let DeValue::String(text) = self.value {
            let map = TextMap::new(raw, start, text);
            let ast = parse_with(text, self.functions).map_err(|error| {
                let span = map.locate(error.span.start..error.span.end);
                self.source.error(&Place { entry: entry.clone(), span }, error)
            })?;
            return Ok(Expression { text: text.to_string(), ast, entry, map });
        }
        let Some(value) = self.numeric()? else {
            return Err(self.wrong_type("an expression (a string or a number)", "\"…\""));
        };
        let ast = Ast { span: Span { start: 0, end: raw.len() }, kind: AstKind::Number(value) };
        Ok(Expression { text: raw.into(), ast, entry, map: TextMap::new(raw, start, raw) })
    }

    /// The value as a list that has one of the given lengths.
    pub(super) fn list(
        &self,
        lengths: &[usize],
        expected: &'static str,
        example: &'static str,
    ) -> Result<Vec<Expression>, ModelError> {
        let DeValue::Array(array) = self.value else {
            let found = self.wrong_type(expected, "[…]");
            return match found.kind() {
                ErrorKind::WrongType { found, .. } => {
                    Err(self.error(ErrorKind::WrongType { expected, found, example: example.into() }))
                }
                _ => Err(found),
            };
        };
        if !lengths.contains(&array.len()) {
            return Err(self.error(ErrorKind::WrongLength { expected, found: array.len(), example }));
        }
        self.elements(array).map(|element| element.expression()).collect()
    }

    /// The value as a list that has one of the given lengths and elements of any type.
    pub(super) fn parts(
        &self,
        lengths: &[usize],
        expected: &'static str,
        example: &'static str,
    ) -> Result<Vec<Item<'a>>, ModelError> {
        let DeValue::Array(array) = self.value else {
            let value = example.split_once(" = ").map_or(example, |(_, value)| value);
            return Err(self.wrong_type(expected, value));
        };
        if !lengths.contains(&array.len()) {
            return Err(self.error(ErrorKind::WrongLength { expected, found: array.len(), example }));
        }
        Ok(self.elements(array).collect())
    }

    fn elements(&self, array: &'a DeArray<'a>) -> impl Iterator<Item = Item<'a>> {
        array.iter().map(|element| {
            let place = Place { entry: self.place.entry.clone(), span: element.span() };
            Item { key_span: 0..0, place, value: element.get_ref(), ..self.clone() }
        })
    }

    /// The value as a list of strings; the list may have any length.
    pub(super) fn texts(
        &self,
        expected: &'static str,
        example: &'static str,
    ) -> Result<Vec<Located<String>>, ModelError> {
        match self.value {
            DeValue::Array(array) => self.elements(array).map(|element| element.text()).collect(),
            _ => Err(self.wrong_type(expected, example)),
        }
    }

    /// The value as a list of finite numbers; the list may have any length.
    pub(super) fn numbers(
        &self,
        expected: &'static str,
        example: &'static str,
    ) -> Result<Vec<f64>, ModelError> {
        match self.value {
            DeValue::Array(array) => {
                self.elements(array).map(|element| Ok(element.number()?.value)).collect()
            }
            _ => Err(self.wrong_type(expected, example.split_once(" = ").map_or(example, |(_, list)| list))),
        }
    }

    /// The value as a list of `N` expressions.
    pub(super) fn array<const N: usize>(
        &self,
        expected: &'static str,
        example: &'static str,
    ) -> Result<[Expression; N], ModelError> {
        let list = self.list(&[N], expected, example)?;
        list.try_into().map_err(|list: Vec<_>| {
            self.error(ErrorKind::WrongLength { expected, found: list.len(), example })
        })
    }
}
