//! Derivatives of the motions of built-in models by their parameters and starts, against differences of motions.

use pc_mech::{CompileOptions, Graph, Motion};
use pc_model::{Builtin, ConstraintFormulation, Document, Model};
use pc_solve::{
    AdjointOptions, Failure, Functional, Method, Options, Sensitivities, Solve, VectorField,
    adjoint_gradient, solve,
};
use pc_tests::verified::derived_twice;

/// A motion with its start, compiled with these derivatives.
fn motion(name: &str, options: CompileOptions) -> (Motion, Vec<f64>) {
    let model = Model::new(Builtin::named(name).unwrap().document().unwrap());
    let graph = Graph::new();
    let assembly = model.assemble(&graph).unwrap();
    let equations = assembly.equations().unwrap();
    let system = equations.system();
    let state = [system.frame().coordinates(), system.quasi_velocities()].concat();
    (equations.compile_for(options).unwrap(), assembly.start_of(&state))
}

fn options(method: Method) -> Options {
    Options::new(method).relative_tolerance(1e-12).absolute_tolerance(1e-14)
}

fn end(motion: &mut Motion, start: &[f64], t: f64) -> Vec<f64> {
    solve(motion, 0.0, start, &[t], &options(Method::Adams)).unwrap().state(0).to_vec()
}

/// The derivative of an end state by a number that was `at`, by differences of order 4.
///
/// Their truncation goes as the fourth power of the step: for the disk, whose small moments of inertia are moved by a
/// part that counts, it is 5e-7 of the largest derivative with steps of 2e-3 and 4e-3, so 2e-9 with a quarter of them.
/// The errors of the integrations, a few 1e-12, become about 1e-8.
fn difference(at: f64, mut end: impl FnMut(f64) -> Vec<f64>) -> Vec<f64> {
    let mut slope = |step: f64| -> Vec<f64> {
        let (ahead, behind) = (end(at + step), end(at - step));
        ahead.iter().zip(behind).map(|(a, b)| (a - b) / (2.0 * step)).collect()
    };
    let (fine, coarse) = (slope(5e-4), slope(1e-3));
    fine.iter().zip(coarse).map(|(fine, coarse)| (4.0 * fine - coarse) / 3.0).collect()
}

/// All columns by parameters and by starts, at time t.
fn expected(motion: &mut Motion, start: &[f64], t: f64) -> Vec<Vec<f64>> {
    let parameters = motion.parameters().to_vec();
    let mut columns = Vec::new();
    for (j, &p) in parameters.iter().enumerate() {
        columns.push(difference(p, |p| {
            motion.parameters_mut()[j] = p;
            end(motion, start, t)
        }));
        motion.parameters_mut()[j] = parameters[j];
    }
    for i in 0..start.len() {
        columns.push(difference(start[i], |y| {
            let mut start = start.to_vec();
            start[i] = y;
            end(motion, &start, t)
        }));
    }
    columns
}

/// The largest difference, as a part of the largest derivative, which grows with time.
fn error(found: &[f64], expected: &[Vec<f64>]) -> f64 {
    let expected = expected.concat();
    assert_eq!(found.len(), expected.len());
    let size = expected.iter().fold(1.0, |size: f64, x| size.max(x.abs()));
    found.iter().zip(&expected).fold(0.0, |error: f64, (a, b)| error.max((a - b).abs())) / size
}

/// Lagrange's top in γ and the disk that rolls and leans, by both methods, with all derivatives, with the Jacobian only,
/// and with difference quotients in their place.
#[test]
fn derivatives_of_built_in_models() {
    for name in ["heavy-top-lagrange", "tilted-disk"] {
        let by_parameters = CompileOptions::default().parameter_jacobian(true);
        let (mut plain, start) = motion(name, by_parameters);
        let t = 2.0;
        let expected = expected(&mut plain, &start, t);
        let mut first: Option<Vec<f64>> = None;
        for compiled in [by_parameters.jvp(true), by_parameters, by_parameters.jacobian(false)] {
            for method in [Method::Adams, Method::Bdf] {
                let (mut motion, start) = motion(name, compiled);
                let wanted =
                    Sensitivities::new().by_parameters(0..motion.parameters_len()).by_starts(0..start.len());
                // What quotients leave of accuracy, 1e-10, is no use of steps for 1e-12.
                let options = options(method).relative_tolerance(1e-11).absolute_tolerance(1e-13);
                let found = Solve::new(&mut motion, 0.0, &start)
                    .method(&options)
                    .sensitivities(&wanted)
                    .run(&[t])
                    .unwrap();
                let error = error(found.trajectory.matrix(0), &expected);
                assert!(error < 3e-8, "{name} {compiled:?} {method}: {error:e}");
                // Among each other they are better than the differences: 1e-11 of some hundred steps.
                let first = first.get_or_insert_with(|| found.trajectory.matrix(0).to_vec());
                let apart = self::error(found.trajectory.matrix(0), std::slice::from_ref(first));
                assert!(apart < 1e-9, "{name} {compiled:?} {method}: {apart:e}");
            }
        }
    }
}

/// A heavy point on a spheroid x² + y² + a z² = l², in Cartesian coordinates.
const SPHEROID: &str = r#"
[parameters]
a = 1.5
l = 1.0
g = 2.0
[coordinates]
x = 0.8
y = 0.0
z = "sqrt((l^2 - 0.64)/a)"
[quasi_velocities]
u = { is = "x'", start = 0.0 }
v = { is = "y'", start = 0.7 }
w = { is = "z'", start = 0.0 }
[constraints]
spheroid = "x^2 + y^2 + a*z^2 - l^2"
[lagrangian]
kinetic = "(u^2 + v^2 + w^2)/2"
potential = "g*z"
[simulation]
t_end = 1.5
"#;

/// A point kept on a surface by a multiplier: where the surface depends on parameters so does the start, which is the
/// nearest on the surface.
#[test]
fn derivatives_on_a_surface() {
    let model = derived_twice(Document::from_bytes("spheroid.toml", SPHEROID.as_bytes()).unwrap());
    let graph = Graph::new();
    let assembly = model.assemble(&graph).unwrap();
    let ConstraintFormulation::Multipliers(held) = assembly.constraints.formulation() else {
        panic!("no multipliers")
    };
    let compiled = CompileOptions::default().parameter_jacobian(true).jvp(true);
    let mut motion = held.multipliers.compile_for(compiled).unwrap();
    assert!(motion.has_projection());
    let (base, parameters) = (assembly.start.clone(), motion.parameters().to_vec());
    let t = 1.5;
    let on_surface = |motion: &mut Motion, j: usize, p: f64| {
        motion.parameters_mut()[j] = p;
        let mut start = base.clone();
        motion.project(0.0, &mut start).unwrap();
        start
    };
    for (j, &p) in parameters.iter().enumerate() {
        let by_parameter = difference(p, |p| on_surface(&mut motion, j, p));
        let expected = difference(p, |p| {
            let start = on_surface(&mut motion, j, p);
            end(&mut motion, &start, t)
        });
        let start = on_surface(&mut motion, j, p);
        for method in [Method::Adams, Method::Bdf] {
            let wanted = Sensitivities::new().by_parameter_from(j, by_parameter.clone());
            let found = Solve::new(&mut motion, 0.0, &start)
                .method(&options(method))
                .sensitivities(&wanted)
                .run(&[t])
                .unwrap();
            let error = error(found.trajectory.matrix(0), std::slice::from_ref(&expected));
            assert!(error < 1e-8, "parameter {j}, {method}: {error:e}");
        }
    }
}

/// G = ∫ γ3 dt + ω1(T)² of the top.
struct Nutation;

impl Functional for Nutation {
    fn density(&mut self, _t: f64, y: &[f64], by_y: &mut [f64], by_p: &mut [f64]) -> Result<f64, Failure> {
        by_y.fill(0.0);
        by_p.fill(0.0);
        by_y[2] = 1.0;
        Ok(y[2])
    }
    fn end(&mut self, _t: f64, y: &[f64], by_y: &mut [f64], by_p: &mut [f64]) -> Result<f64, Failure> {
        by_y.fill(0.0);
        by_p.fill(0.0);
        by_y[3] = 2.0 * y[3];
        Ok(y[3] * y[3])
    }
}

/// The gradient by the adjoint equations, of the top of Lagrange, against differences of G.
#[test]
fn gradient_of_a_functional_of_the_top() {
    let (mut top, start) = motion("heavy-top-lagrange", CompileOptions::default().parameter_jacobian(true));
    let t = 3.0;
    let found = {
        let options = AdjointOptions::new(options(Method::Adams));
        adjoint_gradient(&mut top, Nutation, 0.0, &start, t, &options).unwrap()
    };
    let mut value = |parameters: &[f64], start: &[f64]| {
        top.parameters_mut().copy_from_slice(parameters);
        let options = AdjointOptions::new(options(Method::Adams));
        vec![adjoint_gradient(&mut top, Nutation, 0.0, start, t, &options).unwrap().value]
    };
    let parameters = [1.0, 1.0, 0.5, 1.0, 1.0];
    for (j, found) in found.by_parameters.iter().enumerate() {
        let expected = difference(parameters[j], |p| {
            let mut parameters = parameters;
            parameters[j] = p;
            value(&parameters, &start)
        })[0];
        assert!((found - expected).abs() < 1e-8 * (1.0 + expected.abs()), "{j}: {found}, not {expected}");
    }
    for (i, found) in found.by_start.iter().enumerate() {
        let expected = difference(start[i], |y| {
            let mut start = start.clone();
            start[i] = y;
            value(&parameters, &start)
        })[0];
        assert!((found - expected).abs() < 1e-8 * (1.0 + expected.abs()), "{i}: {found}, not {expected}");
    }
}
