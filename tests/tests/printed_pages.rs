//! What `pc derive` prints for programs is read back and computed: it has the values of the expressions it was written from,
//! and of the equations that are run.

#![expect(clippy::unwrap_used, reason = "a test that cannot go on fails")]

use std::collections::HashMap;
use std::fs;
use std::path::Path;

use nalgebra::{DMatrix, DVector};
use pc_expr::parse::{Ast, AstKind, Factor, Sign, parse};
use pc_expr::{Folding, Function};
use pc_mech::{Backend, Graph, VectorField};
use pc_model::{BUILTIN, Document, Model, Source};
use pc_print::{Balance, Derived, Form, Layout, Page, Sheet, page};
use pc_tests::classical::SplitMix64;
use serde_json::Value;

/// A number with the size of what was summed and multiplied on the way to it, in its units.
#[derive(Clone, Copy, Debug)]
struct Sized {
    value: f64,
    size: f64,
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
struct Read {
    object: Value,
    names: HashMap<String, Sized>,
}

impl Read {
    /// The page where symbols have these values.
    fn at(object: &Value, symbols: &[(String, f64)]) -> Read {
        let names = symbols.iter().map(|(name, value)| (name.clone(), Sized::of(*value))).collect();
        let mut read = Read { object: object.clone(), names };
        for definition in object["definitions"].as_array().into_iter().flatten() {
            let text = definition["value"].as_str().unwrap();
            let value = read.text(text);
            read.names.insert(definition["name"].as_str().unwrap().to_owned(), value);
        }
        read
    }

    fn text(&self, text: &str) -> Sized {
        value(&parse(text).unwrap_or_else(|error| panic!("{text}: {error}")), &self.names)
    }

    fn list(&self, key: &str) -> Vec<Sized> {
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

const FORMS: [Form; 4] = [Form::Poincare, Form::Canonical, Form::Lagrange, Form::Voronets];
/// Two ways to round a sum of products: some units in the last place of the largest that was computed on the way.
const ROUNDING: f64 = 1e-12;

fn assert_close(read: &[Sized], written: &[f64], what: &str) {
    assert_eq!(read.len(), written.len(), "{what}");
    for (i, (read, written)) in read.iter().zip(written).enumerate() {
        let same = (read.value - written).abs() <= ROUNDING * read.size.max(written.abs());
        assert!(same || !written.is_finite(), "{what} {i}: read {read:?}, written from {written}");
    }
}

/// Compares each text of a form's page with the expression it was written from, at random places around the start.
fn compare(name: &str, model: &Model, form: Form, states: usize) -> bool {
    let graph = Graph::new();
    let assembly = model.assemble(&graph).unwrap_or_else(|error| panic!("{name}: {error}"));
    let Ok((_, derived)) = Derived::new(form, &assembly) else { return false };
    let paper = graph.page(Folding::Structural);
    let sheet = if form == Form::Canonical {
        let Ok(equations) = assembly.free_system().unwrap().canonical() else { return false };
        Sheet::of_momenta(&assembly, &derived, &equations, &paper)
    } else {
        Sheet::of_velocities(&assembly, &derived, &paper)
    };
    // In a graph of its own, as the program has it: what was made before may be a shorter form of what is made now.
    let other = Graph::new();
    let anew = model.assemble(&other).unwrap();
    let printed = page(form, Page::Json, &Layout::default(), name, &anew).unwrap();
    assert!(!printed.contains('…'), "{name}: something is left out");
    let object: Value = serde_json::from_str(&printed).unwrap();
    let (names, expressions) = match &sheet.balance {
        Balance::Velocities { mass, right, .. } => {
            (vec!["mass_matrix", "equations"], vec![mass.entries().into_owned(), right.clone()])
        }
        Balance::Momenta { of_velocities, right, .. } => {
            (vec!["momenta_of_velocities", "equations"], vec![of_velocities.clone(), right.clone()])
        }
    };
    let energy = if form == Form::Canonical { "hamiltonian" } else { "energy" };
    let mut everything = expressions.concat();
    everything.push(sheet.energy);
    everything.extend(sheet.reactions.iter().map(|&(_, value)| value));
    everything.extend(sheet.constraints.iter().map(|&(_, left, _)| left));
    everything.extend(sheet.frame.0.nonzero_entries().into_iter().chain(sheet.frame.1.clone()));
    everything
        .extend(sheet.brackets.nonzero.iter().flat_map(|bracket| bracket.components.iter().map(|&(_, c)| c)));
    everything.extend(sheet.rates.iter().chain(&sheet.states).map(|&(_, value)| value));
    everything.extend(sheet.definitions.iter().map(|given| given.value));
    let known: HashMap<String, f64> = assembly
        .at_start()
        .into_iter()
        .chain(assembly.system.parameters().iter().copied())
        .map(|(symbol, value)| (symbol.to_string(), value))
        .collect();
    let parameters: Vec<String> = sheet.parameters.iter().map(|(name, _)| name.clone()).collect();
    let symbols = paper.symbols_of(&everything);
    let mut random = SplitMix64::new(11);
    for _ in 0..states {
        let at: Vec<_> = symbols
            .iter()
            .map(|&symbol| {
                let name = symbol.symbol_name().unwrap();
                let start = known.get(&name).copied().unwrap_or(0.3);
                let moved =
                    if parameters.contains(&name) { start } else { start + random.uniform(-0.2, 0.2) };
                (symbol, moved)
            })
            .collect();
        let named: Vec<(String, f64)> =
            at.iter().map(|(symbol, value)| (symbol.to_string(), *value)).collect();
        let read = Read::at(&object, &named);
        for (key, list) in names.iter().zip(&expressions) {
            assert_close(
                &read.list(key),
                &paper.evaluate(list, &at).unwrap(),
                &format!("{name}, {form:?}, {key}"),
            );
        }
        let value = paper.evaluate(&[sheet.energy], &at).unwrap();
        assert_close(
            &[read.text(object[energy].as_str().unwrap())],
            &value,
            &format!("{name}, {form:?}, {energy}"),
        );
        for (reaction, value) in &sheet.reactions {
            let text = object["reactions"][reaction.to_string()].as_str().unwrap();
            let value = paper.evaluate(&[*value], &at).unwrap();
            assert_close(&[read.text(text)], &value, &format!("{name}, {form:?}, {reaction}"));
        }
    }
    true
}

fn mechanisms() -> Vec<(String, Model)> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("mechanisms");
    let mut files: Vec<_> = fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path()).collect();
    files.sort();
    let model = |path: std::path::PathBuf| {
        let name = path.file_stem().unwrap().to_string_lossy().into_owned();
        let document = Document::parse(Source::new(&name, fs::read_to_string(&path).unwrap())).unwrap();
        (name, Model::new(document))
    };
    files.into_iter().map(model).collect()
}

#[test]
fn pages_of_built_in_models_agree_with_their_equations() {
    let mut compared = 0;
    for builtin in BUILTIN {
        let model = Model::new(builtin.document().unwrap());
        compared += FORMS.iter().filter(|&&form| compare(builtin.name, &model, form, 20)).count();
    }
    assert!(compared >= 3 * BUILTIN.len(), "{compared} pages");
}

#[test]
fn pages_of_mechanisms_agree_with_their_equations() {
    for (name, model) in mechanisms() {
        for form in FORMS {
            assert!(compare(&name, &model, form, 20), "{name} has no form {form:?}");
        }
    }
}

/// M η̇ = r as it is read back has the accelerations of the run, at 1000 states of each mechanism.
#[test]
fn accelerations_that_are_read_back_are_those_of_the_run() {
    for (name, model) in mechanisms() {
        let graph = Graph::new();
        let assembly = model.assemble(&graph).unwrap();
        let printed = page(Form::Poincare, Page::Json, &Layout::default(), &name, &assembly).unwrap();
        let object: Value = serde_json::from_str(&printed).unwrap();
        let equations = assembly.equations().unwrap();
        let mut motion = equations.compile_for(Backend::default()).unwrap();
        let system = equations.system();
        let state = system.state();
        let (names, start) = (motion.names().to_vec(), assembly.start_of(&state));
        let k = system.quasi_velocities().len();
        let mut random = SplitMix64::new(5);
        for _ in 0..1000 {
            let y: Vec<f64> = start.iter().map(|x| x + random.uniform(-0.1, 0.1)).collect();
            let mut rates = vec![0.0; y.len()];
            if motion.rhs(assembly.t_start, &y, &mut rates).is_err() {
                continue;
            }
            let parameters = system.parameters().iter().map(|(symbol, value)| (symbol.to_string(), *value));
            let mut symbols: Vec<(String, f64)> = names.iter().cloned().zip(y).chain(parameters).collect();
            symbols.push(("t".to_owned(), assembly.t_start));
            // Constraints and reactions, and their definitions, may have rates in them that are not read here.
            let rates_of = names
                .iter()
                .chain(assembly.system.state().iter().map(ToString::to_string).collect::<Vec<_>>().iter())
                .map(|name| (format!("{name}'"), 0.0))
                .collect::<Vec<_>>();
            symbols.extend(rates_of);
            let read = Read::at(&object, &symbols);
            let (mass, right) = (read.list("mass_matrix"), read.list("equations"));
            let matrix = DMatrix::from_fn(k, k, |r, s| mass[r * k + s].value);
            let vector = DVector::from_iterator(k, right.iter().map(|r| r.value));
            let scale = right.iter().fold(1.0f64, |size, r| size.max(r.size));
            let inverse = matrix.clone().try_inverse().unwrap();
            let solved = matrix.lu().solve(&vector).unwrap();
            let n = system.frame().coordinates().len();
            for s in 0..k {
                let difference = (solved[s] - rates[n + s]).abs();
                // What is summed on the right, rounded in another order, and its effect through M⁻¹.
                let allowed = ROUNDING * (scale * inverse.norm()).max(rates[n + s].abs());
                assert!(
                    difference <= allowed,
                    "{name}: {} is {}, read back {}",
                    names[n + s],
                    rates[n + s],
                    solved[s]
                );
            }
        }
    }
}
