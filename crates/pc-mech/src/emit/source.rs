//! The contents of source files, independent of their language.

use pc_expr::{Calls, Chain, FunctionBody, Language};

/// The maximum width of a line in a list.
const WIDTH: usize = 106;

/// Options for emitted source.
#[derive(Clone, Debug)]
pub struct EmitOptions {
    pub(super) language: Language,
    pub(super) name: String,
    pub(super) title: String,
    remark: String,
    pub(super) start: Option<Start>,
    pub(super) fused: bool,
    pub(super) jacobian: bool,
}

/// The initial state and the times of a sample motion.
#[derive(Clone, Debug)]
pub(super) struct Start {
    pub(super) t: f64,
    pub(super) state: Vec<f64>,
    pub(super) t_end: f64,
}

impl EmitOptions {
    /// Source in `language`; files and functions are called `name`, changed into an identifier if it is not
    /// one.
    pub fn new(language: Language, name: impl Into<String>) -> EmitOptions {
        let name = name.into();
        EmitOptions {
            language,
            title: name.clone(),
            name,
            remark: String::new(),
            start: None,
            fused: false,
            jacobian: true,
        }
    }

    /// Sets the title of the system, which appears on the first line; the default is the name.
    #[must_use]
    pub fn title(mut self, title: impl Into<String>) -> EmitOptions {
        self.title = title.into();
        self
    }

    /// Adds a remark for the reader to the comment at the head.
    #[must_use]
    pub fn remark(mut self, remark: impl Into<String>) -> EmitOptions {
        self.remark = remark.into();
        self
    }

    /// Sets an initial state (coordinates, quasi-velocities, then first-order states) and the times of a motion.
    /// With these the source has a `main` that integrates the motion.
    #[must_use]
    pub fn start(mut self, t_start: f64, state: &[f64], t_end: f64) -> EmitOptions {
        self.start = Some(Start { t: t_start, state: state.to_vec(), t_end });
        self
    }

    /// Whether to write the Jacobian of the right-hand side, which is the default.
    #[must_use]
    pub fn jacobian(mut self, jacobian: bool) -> EmitOptions {
        self.jacobian = jacobian;
        self
    }

    /// Whether to write a·b + c as a single operation, with a single rounding. This is fast only where the
    /// processor has such an operation and the compiler may use it, and the results then differ from the
    /// library's by rounding errors.
    #[must_use]
    pub fn fused(mut self, fused: bool) -> EmitOptions {
        self.fused = fused;
        self
    }
}

/// A source file.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct EmittedFile {
    /// The name of the file, without its directory.
    pub name: String,
    /// Its text.
    pub text: String,
}

/// The number of values that a routine writes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Extent {
    /// One, which is returned.
    One,
    /// One for each component of the state.
    State,
    /// A square matrix with a row and a column for each component of the state.
    StateSquared,
    /// A square matrix with a row and a column for each quasi-velocity.
    QuasiVelocitiesSquared,
    Integrals,
    Outputs,
    /// A fixed number of values.
    Count(usize),
}

/// A function in the source.
pub(super) struct Routine {
    pub(super) name: String,
    pub(super) purpose: String,
    /// The array that it writes.
    pub(super) array: &'static str,
    pub(super) extent: Extent,
    /// Whether a direction follows the parameters.
    pub(super) directional: bool,
    /// Whether the array has to be filled with zeros first.
    pub(super) sparse: bool,
    pub(super) body: FunctionBody,
}

/// All parts of the files in a language.
pub(super) struct Source<'a> {
    pub(super) options: &'a EmitOptions,
    /// The name as an identifier.
    pub(super) name: String,
    pub(super) state: Vec<String>,
    pub(super) coordinates: usize,
    /// Number of first-order states.
    pub(super) states: usize,
    pub(super) parameters: Vec<(String, f64)>,
    pub(super) integrals: Vec<String>,
    pub(super) outputs: Vec<String>,
    /// The equations as text, unless they are long.
    pub(super) equations: Vec<String>,
    pub(super) routines: Vec<Routine>,
    /// A table of operations that the functions share, for a long right-hand side.
    pub(super) shared: Option<Chain>,
}

impl Source<'_> {
    /// The functions that all routines call.
    pub(super) fn calls(&self) -> Calls {
        let shared = self.shared.iter().fold(Calls::default(), |calls, chain| calls.and(&chain.calls));
        self.routines.iter().fold(shared, |calls, routine| calls.and(&routine.body.calls))
    }

    /// The comment at the head: title, equations, state and parameters, line by line.
    pub(super) fn head(&self) -> Vec<String> {
        let comment = |text: &str| self.options.language.comment(text);
        let mut lines = vec![
            comment(&self.options.title),
            String::new(),
            format!(
                "Generated by pc {} from the Lagrangian: derive it again rather than edit it.",
                env!("CARGO_PKG_VERSION")
            ),
        ];
        if !self.options.remark.is_empty() {
            lines.push(String::new());
            lines.extend(self.options.remark.lines().map(comment));
        }
        if !self.equations.is_empty() {
            lines.extend([
                String::new(),
                "Equations of motion, with ' for the derivative by time:".to_owned(),
            ]);
            lines.extend(self.equations.iter().map(|line| format!("    {}", comment(line))));
        }
        let count = |number: usize, one: &str, many: &str| match number {
            1 => format!("one {one}"),
            _ => format!("{number} {many}"),
        };
        let quasi_velocities = count(self.quasi_velocities(), "quasi-velocity", "quasi-velocities");
        lines.push(String::new());
        let coordinates =
            (self.coordinates > 0).then(|| count(self.coordinates, "coordinate", "coordinates"));
        let states = (self.states > 0).then(|| count(self.states, "first-order state", "first-order states"));
        let parts: Vec<String> = coordinates.into_iter().chain([quasi_velocities]).chain(states).collect();
        lines.push(format!("State: {}.", parts.join(", then ")));
        lines.extend(self.state.iter().enumerate().map(|(i, name)| format!("    y[{i}]  {}", comment(name))));
        if !self.parameters.is_empty() {
            lines.extend([String::new(), "Parameters, with their default values:".to_owned()]);
            let parameters = self.parameters.iter().enumerate();
            lines.extend(
                parameters.map(|(i, (name, value))| format!("    p[{i}]  {} = {value}", comment(name))),
            );
        }
        lines
    }

    pub(super) fn quasi_velocities(&self) -> usize {
        self.state.len() - self.coordinates - self.states
    }

    pub(super) fn constants(&self, values: impl Iterator<Item = f64>) -> String {
        listed(values.map(|value| self.options.language.constant(value)))
    }

    pub(super) fn strings<'s>(&self, texts: impl Iterator<Item = &'s String>) -> String {
        listed(texts.map(|text| self.options.language.string(text)))
    }
}

/// A list of entries, on lines of bounded length.
fn listed(entries: impl Iterator<Item = String>) -> String {
    let (mut text, mut width) = (String::new(), 0);
    for entry in entries {
        let length = entry.chars().count() + 2;
        if !text.is_empty() {
            text += if width + length > WIDTH { ",\n    " } else { ", " };
            width = if width + length > WIDTH { 0 } else { width };
        }
        width += length;
        text += &entry;
    }
    text
}
