//! How what is computed depends on what is known: directly on which variables, and how these enter.

use pc_expr::Expr;

use crate::contents::{Contents, OF_STATES, ParameterKind};
use crate::options::FmiVersion;

/// By what a known variable is multiplied where it enters.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Factor {
    Constant,
    /// An expression in parameters that stay as they are at the start.
    Fixed,
    /// An expression in parameters that can be changed.
    Tunable,
    /// The variable enters otherwise.
    Dependent,
}

impl Factor {
    /// Its word in FMI.
    pub(crate) fn word(self) -> &'static str {
        match self {
            Factor::Constant => "constant",
            Factor::Fixed => "fixed",
            Factor::Tunable => "tunable",
            Factor::Dependent => "dependent",
        }
    }
}

/// A known variable, by its value reference, in something that is computed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Dependency {
    pub(crate) on: usize,
    pub(crate) factor: Factor,
}

/// What is known.
pub(crate) struct Knowns<'g> {
    /// Its symbols in the order of their value references.
    symbols: Vec<Expr<'g>>,
    references: Vec<usize>,
    /// What follows it, to be substituted one list after the other.
    following: Vec<Vec<(Expr<'g>, Expr<'g>)>>,
    /// The parameters of a factor.
    parameters: Vec<Expr<'g>>,
    of_parameters: Factor,
    has_slopes: bool,
}

impl<'g> Knowns<'g> {
    /// Time, states, inputs, and in FMI 3 parameters.
    pub(crate) fn in_motion(contents: &Contents<'g>, version: FmiVersion) -> Knowns<'g> {
        let is_known = |kind| match kind {
            ParameterKind::Input => true,
            ParameterKind::Given => version == FmiVersion::V3,
            ParameterKind::Follows => false,
        };
        let given = contents.parameters.iter().filter(|parameter| parameter.kind != ParameterKind::Input);
        let of_parameters = if contents.is_fixed { Factor::Fixed } else { Factor::Tunable };
        Knowns {
            parameters: given.map(|parameter| parameter.symbol).collect(),
            of_parameters,
            ..Knowns::new(contents, |_| true, is_known, Vec::new())
        }
    }

    /// Time, states whose start can be set, inputs and parameters: all before the motion begins.
    pub(crate) fn at_start(contents: &Contents<'g>) -> Knowns<'g> {
        let starts =
            contents.symbols.iter().zip(&contents.states).filter(|(_, state)| state.number.is_none());
        let starts = starts.map(|(&symbol, state)| (symbol, state.start)).collect();
        let is_known = |kind| kind != ParameterKind::Follows;
        Knowns::new(contents, |place| contents.states[place].number.is_some(), is_known, starts)
    }

    fn new(
        contents: &Contents<'g>,
        is_known_state: impl Fn(usize) -> bool,
        is_known: impl Fn(ParameterKind) -> bool,
        starts: Vec<(Expr<'g>, Expr<'g>)>,
    ) -> Knowns<'g> {
        let states = contents.symbols.iter().enumerate().filter(|&(place, _)| is_known_state(place));
        let parameters = contents.parameters.iter().enumerate().filter(|(_, it)| is_known(it.kind));
        let (symbols, references) = std::iter::once((contents.time, 0))
            .chain(states.map(|(place, &symbol)| (symbol, OF_STATES + place)))
            .chain(parameters.map(|(place, it)| (it.symbol, contents.of_parameters() + place)))
            .unzip();
        let calculated = contents.calculated.iter();
        let calculated = calculated.map(|&(place, value)| (contents.parameters[place].symbol, value));
        Knowns {
            symbols,
            references,
            following: vec![contents.accelerations.clone(), starts, calculated.collect()],
            parameters: Vec::new(),
            of_parameters: Factor::Constant,
            has_slopes: contents.has_derivatives,
        }
    }

    /// On what a value depends directly, and how. Without derivatives, which are left out where they are long, nothing is said of
    /// factors.
    pub(crate) fn of(&self, contents: &Contents<'g>, value: Expr<'g>) -> Vec<Dependency> {
        let graph = contents.equations.system().graph();
        let value = (self.following.iter()).fold(value, |value, list| graph.substitute(&[value], list)[0]);
        let within = graph.symbols_of(&[value]);
        let places: Vec<usize> =
            (0..self.symbols.len()).filter(|&place| within.contains(&self.symbols[place])).collect();
        let symbols: Vec<Expr<'g>> = places.iter().map(|&place| self.symbols[place]).collect();
        let mut factors = vec![Factor::Dependent; places.len()];
        if self.has_slopes && !symbols.is_empty() {
            let slopes = graph.gradient(value, &symbols);
            let constant = graph.are_made_of(&slopes, &[]);
            let of_parameters = graph.are_made_of(&slopes, &self.parameters);
            for (n, factor) in factors.iter_mut().enumerate() {
                // The slope does not know of jumps.
                *factor = match () {
                    () if graph.applies(value, &symbols[n..=n], |f| !f.is_continuous()) => Factor::Dependent,
                    () if constant[n] => Factor::Constant,
                    () if of_parameters[n] && !slopes[n].depends_on(symbols[n]) => self.of_parameters,
                    () => Factor::Dependent,
                };
            }
        }
        let references = places.into_iter().map(|place| self.references[place]);
        references.zip(factors).map(|(on, factor)| Dependency { on, factor }).collect()
    }
}
