//! A linearization as text for people.

use std::fmt::Write as _;

use pc_analysis::{Linearization, Stability};
use pc_mech::Matrix;
use pc_print::{columns, eigenvalues_in_words, one_line, stability_in_words};

use pc_print::{labelled, short, small, wrapped};

/// The width at which a line is wrapped, not counting its label.
const WIDTH: usize = 84;
const LABEL: usize = 13;

/// The largest value that Newton's method may leave in place of a zero.
const ZERO: f64 = 1e-9;

/// The digits of inputs that were found, with which they may be given again.
const DIGITS: usize = 10;

/// The value with six digits; 0 for what Newton's method leaves in place of a zero.
pub(crate) fn rounded(value: f64) -> String {
    in_digits(value, 6)
}

/// The value with this number of digits; 0 for what Newton's method leaves in place of a zero.
pub(crate) fn in_digits(value: f64, digits: usize) -> String {
    if value.abs() <= ZERO { "0".to_owned() } else { short(value, digits) }
}

/// The whole page, with the inputs that were `chosen`; `moved` says whether the state was found by moving away from the start.
pub(crate) fn page(
    title: &str,
    chosen: &[(String, f64)],
    linear: &Linearization,
    stability: Option<&Stability>,
    moved: bool,
) -> String {
    let mut text = format!("{}\n", one_line(title));
    let mut line = |label: &str, lines: &[String]| text += &labelled(label, LABEL, lines);
    let state = linear.state.iter().map(|(name, value)| format!("{name} = {}", rounded(*value)));
    line("state", &wrapped(state, WIDTH));
    line("", &[place(linear, moved)]);
    if !chosen.is_empty() {
        let inputs = chosen.iter().map(|(name, value)| format!("{name} = {}", short(*value, DIGITS)));
        line("inputs", &wrapped(inputs, WIDTH));
    }
    if !linear.cyclic.is_empty() {
        let rates = linear.cyclic.iter().map(|(name, rate)| format!("{name}' = {}", rounded(*rate)));
        line("left out", &wrapped(rates, WIDTH));
    }
    line("components", &wrapped(linear.components.iter().cloned(), WIDTH));
    line("eigenvalues", &wrapped(eigenvalues_in_words(linear.spectrum.eigenvalues(), 0.0), WIDTH));
    if let Some(stability) = stability {
        line("stability", &[stability_in_words(stability)]);
    }
    if !linear.outputs.is_empty() {
        let outputs = linear.outputs.iter().zip(&linear.output_values);
        let outputs = outputs.map(|(name, value)| format!("{name} = {}", rounded(*value)));
        line("outputs", &wrapped(outputs, WIDTH));
    }
    modes(&mut text, linear);
    let (y, u, h) = (&linear.components, &linear.inputs, &linear.outputs);
    matrix(&mut text, "A", &linear.state_matrix, y, y);
    if !u.is_empty() {
        matrix(&mut text, "B", &linear.input_matrix, y, u);
    }
    if !h.is_empty() {
        matrix(&mut text, "C", &linear.output_matrix, h, y);
        if !u.is_empty() {
            matrix(&mut text, "D", &linear.feedthrough, h, u);
        }
    }
    if !linear.other_outputs.is_empty() {
        let names = linear.other_outputs.join(", ");
        let _ = writeln!(
            text,
            "\nnot among the outputs, for they depend on what is left out or have no derivative here: {names}"
        );
    }
    match &linear.second_order {
        Ok(second) => {
            let q = &second.coordinates;
            text += "\nM q'' + G q' + K q = ";
            text += if u.is_empty() { "0\n" } else { "F u\n" };
            let all = [("M", &second.mass), ("G", &second.velocity), ("K", &second.stiffness)];
            all.into_iter().for_each(|(name, of)| matrix(&mut text, name, of, q, q));
            if !u.is_empty() {
                matrix(&mut text, "F", &second.input, q, u);
            }
        }
        Err(reason) => {
            let _ = writeln!(text, "\nM q'' + G q' + K q = F u is not defined: {reason}");
        }
    }
    text
}

/// The kind of state, and where it was found.
fn place(linear: &Linearization, moved: bool) -> String {
    let kind = match (linear.is_steady, linear.cyclic.is_empty()) {
        (false, _) => return format!("the start, not steady: rates of norm {}", small(linear.residual)),
        (true, true) => "steady",
        (true, false) => "steady but for cyclic coordinates",
    };
    match rounded(linear.distance).as_str() {
        "0" if moved => format!("{kind}: the start itself"),
        "0" => format!("{kind}: the start"),
        _ => format!("{kind}, {} from the start", short(linear.distance, 3)),
    }
}

/// A line for each eigenvalue, or for two conjugate ones together, with the nonzero components of the
/// eigenvector.
fn modes(text: &mut String, linear: &Linearization) {
    let modes = linear.modes.iter().filter(|mode| mode.eigenvalue.imaginary >= 0.0);
    let shown = modes.filter_map(|mode| {
        let vector = mode.vector.as_ref()?;
        let value = eigenvalues_in_words(&[mode.eigenvalue], 0.0).pop()?;
        let parts = linear.components.iter().zip(vector).filter(|(_, (re, im))| re.hypot(*im) > ZERO);
        Some((value, parts.map(|(name, &part)| format!("{name} {}", complex(part))).collect::<Vec<_>>()))
    });
    let shown: Vec<(String, Vec<String>)> = shown.collect();
    let width = shown.iter().map(|(value, _)| columns(value)).max().unwrap_or(0);
    for (i, (value, parts)) in shown.into_iter().enumerate() {
        let label = if i == 0 { "modes" } else { "" };
        let lines = wrapped(parts, WIDTH.saturating_sub(width + 2));
        for (j, line) in lines.into_iter().enumerate() {
            let value = if j == 0 { value.as_str() } else { "" };
            let label = if j == 0 { label } else { "" };
            *text += &labelled(label, LABEL, &[format!("{value}{}  {line}", pad(value, width))]);
        }
    }
}

fn pad(text: &str, width: usize) -> String {
    " ".repeat(width.saturating_sub(columns(text)))
}

/// The value with four digits for each part.
pub(crate) fn complex((re, im): (f64, f64)) -> String {
    let part = |value: f64| if value.abs() <= ZERO { "0".to_owned() } else { short(value, 4) };
    match (part(re).as_str(), part(im.abs()).as_str()) {
        (re, "0") => re.to_owned(),
        ("0", size) => format!("{}{size}i", if im < 0.0 { "-" } else { "" }),
        (re, size) => format!("{re} {} {size}i", if im < 0.0 { "-" } else { "+" }),
    }
}

/// A matrix with the names of its rows and columns.
fn matrix(text: &mut String, name: &str, matrix: &Matrix<f64>, rows: &[String], across: &[String]) {
    let mut table = vec![std::iter::once(name.to_owned()).chain(across.iter().cloned()).collect::<Vec<_>>()];
    for (i, row) in rows.iter().enumerate() {
        let numbers = (0..matrix.columns()).map(|j| rounded(matrix[(i, j)]));
        table.push(std::iter::once(format!("  {row}")).chain(numbers).collect());
    }
    text.push('\n');
    *text += &aligned(&table);
}

/// Cells in columns, the first aligned to the left, the others to the right.
pub(crate) fn aligned(table: &[Vec<String>]) -> String {
    let count = table.first().map_or(0, Vec::len);
    let width = |j: usize| table.iter().map(|row| columns(&row[j])).max().unwrap_or(0);
    let widths: Vec<usize> = (0..count).map(width).collect();
    let mut text = String::new();
    for row in table {
        let mut line = String::new();
        for (j, (cell, &width)) in row.iter().zip(&widths).enumerate() {
            let space = pad(cell, width);
            line += &if j == 0 { format!("{cell}{space}") } else { format!("  {space}{cell}") };
        }
        text += line.trim_end();
        text.push('\n');
    }
    text
}
