//! Derivatives of terms with respect to a coordinate.

use crate::text::arithmetic::{difference, negative, quotient, root, sum, times};
use crate::text::names::Declared;
use crate::text::term::{Function, Term};

/// The derivative with respect to the coordinate `x` of a term that contains no velocities and no definitions.
pub(crate) fn slope(term: &Term, x: usize, functions: &[Declared]) -> Term {
    let of = |term: &Term| slope(term, x, functions);
    match term {
        Term::Coordinate(i) => Term::Number(f64::from(u8::from(*i == x))),
        Term::Sum(parts) => sum(parts
            .iter()
            .map(|(subtracted, part)| if *subtracted { negative(of(part)) } else { of(part) })
            .collect()),
        Term::Product(factors) => {
            let changed = |k: usize| {
                let (divided, factor) = &factors[k];
                let own = of(factor);
                if is_zero(&own) {
                    return own;
                }
                // (1/f)' = −f'/f²
                let others =
                    factors.iter().enumerate().filter(|(i, _)| *i != k).map(|(_, part)| part.clone());
                let mut all: Vec<(bool, Term)> = others.chain([(false, own)]).collect();
                if *divided {
                    all.extend([(true, factor.clone()), (true, factor.clone())]);
                    negative(Term::Product(all))
                } else {
                    Term::Product(all)
                }
            };
            sum((0..factors.len()).map(changed).collect())
        }
        Term::Negative(inner) => negative(of(inner)),
        Term::Power(base, exponent) => of_power(base, exponent, of),
        Term::Call(function, arguments) => of_call(*function, arguments, of, functions),
        _ => Term::Number(0.0),
    }
}

fn is_zero(term: &Term) -> bool {
    matches!(term, Term::Number(value) if *value == 0.0)
}

fn of_power(base: &Term, exponent: &Term, of: impl Fn(&Term) -> Term) -> Term {
    let lower = match exponent {
        Term::Number(value) => Term::Number(value - 1.0),
        exponent => difference(exponent.clone(), Term::Number(1.0)),
    };
    let power = Term::Power(Box::new(base.clone()), Box::new(lower));
    let by_base = times([exponent, &power, &of(base)]);
    let by_exponent = of(exponent);
    if is_zero(&by_exponent) {
        return by_base;
    }
    let whole = Term::Power(Box::new(base.clone()), Box::new(exponent.clone()));
    sum(vec![by_base, times([&whole, &Term::Call(Function::Log, vec![base.clone()]), &by_exponent])])
}

fn of_call(
    function: Function,
    arguments: &[Term],
    of: impl Fn(&Term) -> Term,
    functions: &[Declared],
) -> Term {
    let inner: Vec<Term> = arguments.iter().map(of).collect();
    if inner.iter().skip(usize::from(function == Function::Step)).all(is_zero) {
        return Term::Number(0.0);
    }
    let u = &arguments[0];
    let one = Term::Number(1.0);
    let call = |function: Function| Term::Call(function, vec![u.clone()]);
    let square = |term: &Term| times([term, term]);
    let outer = match function {
        Function::Sin => call(Function::Cos),
        Function::Cos => negative(call(Function::Sin)),
        Function::Tan => sum(vec![one, square(&call(Function::Tan))]),
        Function::Cot => negative(sum(vec![one, square(&call(Function::Cot))])),
        Function::Asin => quotient(one.clone(), &root(difference(one, square(u)))),
        Function::Acos => negative(quotient(one.clone(), &root(difference(one, square(u))))),
        Function::Atan => quotient(one.clone(), &sum(vec![one, square(u)])),
        Function::Sinh => call(Function::Cosh),
        Function::Cosh => call(Function::Sinh),
        Function::Tanh => difference(one, square(&call(Function::Tanh))),
        Function::Exp => call(Function::Exp),
        Function::Log => quotient(one, u),
        Function::Sqrt => quotient(Term::Number(0.5), &call(Function::Sqrt)),
        Function::Abs => call(Function::Sign),
        Function::Sign => Term::Number(0.0),
        Function::Atan2 => {
            let v = &arguments[1];
            let across = difference(times([v, &inner[0]]), times([u, &inner[1]]));
            return quotient(across, &sum(vec![square(u), square(v)]));
        }
        Function::Min | Function::Max => {
            let v = &arguments[1];
            let first = match function {
                Function::Min => difference(v.clone(), u.clone()),
                _ => difference(u.clone(), v.clone()),
            };
            return Term::Call(Function::Step, vec![first, inner[0].clone(), inner[1].clone()]);
        }
        Function::Step => {
            return Term::Call(Function::Step, vec![u.clone(), inner[1].clone(), inner[2].clone()]);
        }
        Function::Undetermined(place) => return of_stand_in(&functions[place], arguments, &inner),
    };
    times([&outer, &inner[0]])
}

/// Σ a f·u' cos(φ + f·u) for the waves a sin(φ + f·u) of the function that takes the place of an undetermined one.
fn of_stand_in(function: &Declared, arguments: &[Term], inner: &[Term]) -> Term {
    let waves = function.stand_in.waves.iter().map(|wave| {
        let along = |terms: &[Term]| {
            let terms = wave.frequencies.iter().zip(terms);
            terms.map(|(&frequency, term)| times([&Term::Number(frequency), term])).collect::<Vec<_>>()
        };
        let angle = sum(along(arguments).into_iter().chain([Term::Number(wave.phase)]).collect());
        let cosine = Term::Call(Function::Cos, vec![angle]);
        times([&Term::Number(wave.amplitude), &cosine, &sum(along(inner))])
    });
    sum(waves.collect())
}
