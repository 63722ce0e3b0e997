//! Formulas of several pieces: as text, as numbers on given sides of their surfaces, and differentiated.

use std::fmt::Write as _;

/// A formula in time, parameters, inputs and the state. A piece changes where the surface of this number is passed.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum Formula {
    Number(f64),
    Time,
    Parameter(usize),
    /// Coordinates, their velocities, then first-order states.
    Variable(usize),
    Input(usize),
    /// The rate of an input, which texts do not have.
    Rate(usize),
    Sum(Vec<Formula>),
    Product(Vec<Formula>),
    Power(Box<Formula>, u8),
    Sin(Box<Formula>),
    Cos(Box<Formula>),
    /// The sign of the function of a surface.
    Sign(usize),
    /// Its absolute value.
    Abs(usize),
    /// One formula where it is positive, another where it is negative.
    Step(usize, Box<Formula>, Box<Formula>),
    /// The smaller of two formulas, whose difference is the function.
    Min(usize, Box<Formula>, Box<Formula>),
    /// The larger of them.
    Max(usize, Box<Formula>, Box<Formula>),
}

/// What a formula is differentiated by.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum By {
    Time,
    Variable(usize),
}

/// The values that a formula is evaluated with.
#[derive(Clone, Copy, Debug)]
pub(super) struct Place<'a> {
    pub(super) t: f64,
    pub(super) y: &'a [f64],
    pub(super) parameters: &'a [f64],
    /// Value and rate of each input.
    pub(super) inputs: &'a [[f64; 2]],
    /// A number from -1 to 1 for each surface: within, both sides in these parts.
    pub(super) sides: &'a [f64],
    pub(super) surfaces: &'a [Formula],
}

/// The names that a formula is written with.
#[derive(Clone, Copy, Debug)]
pub(super) struct Names<'a> {
    pub(super) parameters: &'a [String],
    pub(super) variables: &'a [String],
    pub(super) inputs: &'a [String],
    pub(super) surfaces: &'a [Formula],
}

impl Formula {
    pub(super) fn minus(self) -> Formula {
        Formula::Product(vec![Formula::Number(-1.0), self])
    }

    pub(super) fn times(self, factor: Formula) -> Formula {
        Formula::Product(vec![self, factor])
    }

    pub(super) fn plus(self, other: Formula) -> Formula {
        Formula::Sum(vec![self, other])
    }

    pub(super) fn less(self, other: Formula) -> Formula {
        self.plus(other.minus())
    }

    pub(super) fn squared(self) -> Formula {
        Formula::Power(Box::new(self), 2)
    }

    pub(super) fn half(self) -> Formula {
        Formula::Product(vec![Formula::Number(0.5), self])
    }

    /// Its value; that of a piece on sides σ is multilinear in these.
    pub(super) fn value(&self, at: Place<'_>) -> f64 {
        let between = |k: usize, above: &Formula, below: &Formula| {
            let side = at.sides[k];
            // The side that is not met may have no value.
            let above = if side == -1.0 { 0.0 } else { 0.5 * (1.0 + side) * above.value(at) };
            let below = if side == 1.0 { 0.0 } else { 0.5 * (1.0 - side) * below.value(at) };
            above + below
        };
        match self {
            Formula::Number(value) => *value,
            Formula::Time => at.t,
            Formula::Parameter(i) => at.parameters[*i],
            Formula::Variable(i) => at.y[*i],
            Formula::Input(i) => at.inputs[*i][0],
            Formula::Rate(i) => at.inputs[*i][1],
            Formula::Sum(terms) => terms.iter().map(|term| term.value(at)).sum(),
            Formula::Product(factors) => factors.iter().map(|factor| factor.value(at)).product(),
            Formula::Power(base, exponent) => base.value(at).powi(i32::from(*exponent)),
            Formula::Sin(x) => x.value(at).sin(),
            Formula::Cos(x) => x.value(at).cos(),
            Formula::Sign(k) => at.sides[*k],
            Formula::Abs(k) => at.sides[*k] * at.surfaces[*k].value(at),
            Formula::Step(k, above, below) | Formula::Max(k, above, below) => between(*k, above, below),
            Formula::Min(k, a, b) => between(*k, b, a),
        }
    }

    /// Its derivative on fixed sides.
    pub(super) fn derivative(&self, by: By, surfaces: &[Formula]) -> Formula {
        let of = |formula: &Formula| formula.derivative(by, surfaces);
        let one_if = |is: bool| Formula::Number(f64::from(u8::from(is)));
        let chosen = |k: usize, above: &Formula, below: &Formula| match (of(above), of(below)) {
            (above, below) if above.is_zero() && below.is_zero() => above,
            (above, below) => Formula::Step(k, Box::new(above), Box::new(below)),
        };
        match self {
            Formula::Number(_) | Formula::Parameter(_) | Formula::Sign(_) => Formula::Number(0.0),
            Formula::Time => one_if(by == By::Time),
            Formula::Variable(i) => one_if(by == By::Variable(*i)),
            Formula::Input(i) if by == By::Time => Formula::Rate(*i),
            // Tables are lines.
            Formula::Input(_) | Formula::Rate(_) => Formula::Number(0.0),
            Formula::Sum(terms) => sum(terms.iter().map(of)),
            Formula::Product(factors) => sum((0..factors.len()).map(|i| {
                let others = factors.iter().enumerate().filter(|(j, _)| *j != i);
                product(std::iter::once(of(&factors[i])).chain(others.map(|(_, factor)| factor.clone())))
            })),
            Formula::Power(base, exponent) => {
                let factor = Formula::Number(f64::from(*exponent));
                product([factor, Formula::Power(base.clone(), exponent - 1), of(base)].into_iter())
            }
            Formula::Sin(x) => product([Formula::Cos(x.clone()), of(x)].into_iter()),
            Formula::Cos(x) => product([Formula::Number(-1.0), Formula::Sin(x.clone()), of(x)].into_iter()),
            Formula::Abs(k) => product([Formula::Sign(*k), of(&surfaces[*k])].into_iter()),
            Formula::Step(k, above, below) | Formula::Max(k, above, below) => chosen(*k, above, below),
            Formula::Min(k, a, b) => chosen(*k, b, a),
        }
    }

    fn is_zero(&self) -> bool {
        *self == Formula::Number(0.0)
    }

    /// The text of the format.
    pub(super) fn text(&self, names: Names<'_>) -> String {
        let list = |formulas: &[Formula], between: &str| {
            let texts: Vec<String> = formulas.iter().map(|formula| formula.text(names)).collect();
            texts.join(between)
        };
        let of = |k: usize| names.surfaces[k].text(names);
        let pair =
            |name: &str, a: &Formula, b: &Formula| format!("{name}({}, {})", a.text(names), b.text(names));
        match self {
            Formula::Number(value) if *value < 0.0 => format!("({value:?})"),
            Formula::Number(value) => format!("{value:?}"),
            Formula::Time => "t".to_owned(),
            Formula::Parameter(i) => names.parameters[*i].clone(),
            Formula::Variable(i) => names.variables[*i].clone(),
            Formula::Input(i) => names.inputs[*i].clone(),
            Formula::Rate(i) => format!("d({})", names.inputs[*i]),
            Formula::Sum(terms) => {
                let mut text = String::from("(");
                for (i, term) in terms.iter().enumerate() {
                    let (sign, rest) = match term {
                        Formula::Product(factors) if factors.first() == Some(&Formula::Number(-1.0)) => {
                            (" - ", list(&factors[1..], "*"))
                        }
                        term => (" + ", term.text(names)),
                    };
                    let sign = if i == 0 { sign.trim().trim_start_matches('+') } else { sign };
                    let _ = write!(text, "{sign}{rest}");
                }
                text + ")"
            }
            Formula::Product(factors) if factors.first() == Some(&Formula::Number(-1.0)) => {
                format!("(-{})", list(&factors[1..], "*"))
            }
            Formula::Product(factors) => list(factors, "*"),
            Formula::Power(base, exponent) => format!("({})^{exponent}", base.text(names)),
            Formula::Sin(x) => format!("sin({})", x.text(names)),
            Formula::Cos(x) => format!("cos({})", x.text(names)),
            Formula::Sign(k) => format!("sign({})", of(*k)),
            Formula::Abs(k) => format!("abs({})", of(*k)),
            Formula::Step(k, above, below) => {
                format!("step({}, {}, {})", of(*k), above.text(names), below.text(names))
            }
            Formula::Min(_, a, b) => pair("min", a, b),
            Formula::Max(_, a, b) => pair("max", a, b),
        }
    }

    /// Marks the surfaces that it changes on, and those that these change on.
    pub(super) fn mark(&self, surfaces: &[Formula], marked: &mut [bool]) {
        let mut passed = |k: usize| {
            if !std::mem::replace(&mut marked[k], true) {
                surfaces[k].mark(surfaces, marked);
            }
        };
        match self {
            Formula::Sign(k) | Formula::Abs(k) => passed(*k),
            Formula::Step(k, a, b) | Formula::Min(k, a, b) | Formula::Max(k, a, b) => {
                passed(*k);
                a.mark(surfaces, marked);
                b.mark(surfaces, marked);
            }
            Formula::Sum(parts) | Formula::Product(parts) => {
                parts.iter().for_each(|part| part.mark(surfaces, marked));
            }
            Formula::Power(x, _) | Formula::Sin(x) | Formula::Cos(x) => x.mark(surfaces, marked),
            _ => {}
        }
    }
}

/// A sum without zeros.
pub(super) fn sum(terms: impl Iterator<Item = Formula>) -> Formula {
    let mut terms: Vec<Formula> = terms.filter(|term| !term.is_zero()).collect();
    match terms.len() {
        0 => Formula::Number(0.0),
        1 => terms.remove(0),
        _ => Formula::Sum(terms),
    }
}

/// A product without ones, zero if a factor is.
fn product(factors: impl Iterator<Item = Formula>) -> Formula {
    let mut factors: Vec<Formula> = factors.filter(|factor| *factor != Formula::Number(1.0)).collect();
    match factors.len() {
        _ if factors.iter().any(Formula::is_zero) => Formula::Number(0.0),
        0 => Formula::Number(1.0),
        1 => factors.remove(0),
        _ => Formula::Product(factors),
    }
}
