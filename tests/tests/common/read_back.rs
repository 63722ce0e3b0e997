//! What `pc derive` prints for programs, read back and computed.

use std::collections::HashMap;

use pc_expr::Function;
use pc_expr::parse::{Ast, AstKind, Factor, Sign, parse};
use serde_json::Value;

/// Two ways to round a sum of products: some units in the last place of the largest that was computed on the way.
pub(crate) const ROUNDING: f64 = 1e-12;

/// A number with the size of what was summed and multiplied on the way to it, in its units.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Sized {
    pub(crate) value: f64,
    pub(crate) size: f64,
}

impl Sized {
    fn of(value: f64) -> Sized {
        Sized { value, size: value.abs() }
    }
}

/// The value of a syntax tree.
fn value(ast: &Ast, names: &HashMap<String, Sized>) -> Sized {
    let of = |ast: &Ast| value(ast, names);
    match &ast.kind {
        AstKind::Number(x) => Sized::of(*x),
        AstKind::Name(name) => *names.get(name).unwrap_or_else(|| panic!("`{name}` is not known")),
        AstKind::Velocity(name) => {
            *names.get(&format!("{name}'")).unwrap_or_else(|| panic!("{name}' is not known"))
        }
        AstKind::Negate(x) => {
            let x = of(x);
            Sized { value: -x.value, size: x.size }
        }
        AstKind::Sum(terms) => terms.iter().fold(Sized::of(0.0), |sum, (sign, term)| {
            let (term, sign) = (of(term), if *sign == Sign::Plus { 1.0 } else { -1.0 });
            Sized { value: sum.value + sign * term.value, size: sum.size + term.size }
        }),
        AstKind::Product(factors) => factors.iter().fold(Sized::of(1.0), |product, (side, factor)| {
            let x = of(factor);
            let factor = match side {
                Factor::Times => x,
                Factor::Over => Sized { value: 1.0 / x.value, size: x.size / (x.value * x.value) },
            };
            let size = product.size * factor.value.abs() + product.value.abs() * factor.size;
            Sized { value: product.value * factor.value, size }
        }),
        AstKind::Power(base, exponent) => call(Function::Pow, &[of(base), of(exponent)]),
        AstKind::Call(function, _, arguments) => {
            let function = Function::ALL.into_iter().find(|f| f.name() == function).unwrap();
            call(function, &arguments.iter().map(of).collect::<Vec<_>>())
        }
        AstKind::TotalDerivative(x) => match &x.kind {
            AstKind::Velocity(name) => {
                *names.get(&format!("{name}''")).unwrap_or_else(|| panic!("d({name}') is not known"))
            }
            other => panic!("d({other:?}) is no acceleration"),
        },
    }
}

fn call(function: Function, arguments: &[Sized]) -> Sized {
    let values: Vec<f64> = arguments.iter().map(|x| x.value).collect();
    let value = function.eval(&values);
    let slopes = (0..values.len()).map(|i| {
        let (mut aside, step) = (values.clone(), 1e-6 * (1.0 + values[i].abs()));
        aside[i] += step;
        let slope = (function.eval(&aside) - value) / step;
        if slope.is_finite() { slope.abs() * arguments[i].size } else { 0.0 }
    });
    Sized { value, size: value.abs() + slopes.sum::<f64>() }
}

/// A page for programs with the values of its symbols.
pub(crate) struct Read {
    object: Value,
    names: HashMap<String, Sized>,
}

impl Read {
    /// The page where symbols have these values.
    pub(crate) fn at(object: &Value, symbols: &[(String, f64)]) -> Read {
        let names = symbols.iter().map(|(name, value)| (name.clone(), Sized::of(*value))).collect();
        let mut read = Read { object: object.clone(), names };
        for definition in object["definitions"].as_array().into_iter().flatten() {
            let text = definition["value"].as_str().unwrap();
            let value = read.text(text);
            read.names.insert(definition["name"].as_str().unwrap().to_owned(), value);
        }
        read
    }

    pub(crate) fn text(&self, text: &str) -> Sized {
        value(&parse(text).unwrap_or_else(|error| panic!("{text}: {error}")), &self.names)
    }

    pub(crate) fn list(&self, key: &str) -> Vec<Sized> {
        fn leaves(value: &Value, out: &mut Vec<String>) {
            match value {
                Value::Array(list) => list.iter().for_each(|value| leaves(value, out)),
                value => out.push(value.as_str().unwrap().to_owned()),
            }
        }
        let mut texts = Vec::new();
        leaves(&self.object[key], &mut texts);
        texts.iter().map(|text| self.text(text)).collect()
    }
}
