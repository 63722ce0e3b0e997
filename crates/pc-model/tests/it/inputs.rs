//! `[inputs]`: constants that a program sets, and tables.

use std::fs;

use pc_analysis::{Conservation, Rates};
use pc_expr::Events;
use pc_mech::{Graph, VectorField};
use pc_model::{Category, Document, Flow, Model, Source, Variables};

use crate::verified::derived_twice;

fn text(inputs: &str) -> String {
    format!(
        "[parameters]\nm = 2\n[inputs]\n{inputs}\n[coordinates]\nx = 0\n[lagrangian]\nkinetic = \"m/2*x'^2\"\n\
         potential = \"-u*x\"\n[outputs]\npull = \"u\"\n[events.pulled]\nwhen = \"u - 1\"\n"
    )
}

fn model(text: &str) -> Model {
    derived_twice(Document::parse(Source::new("m.toml", text)).unwrap_or_else(|error| panic!("{error}")))
}

fn flow(model: &Model, variables: Variables) -> Flow {
    let graph = Graph::new();
    let assembly = model.assemble(&graph).unwrap_or_else(|error| panic!("{error}"));
    Flow::new(model, &assembly, variables).unwrap_or_else(|error| panic!("{error}"))
}

/// ẍ and the output at a time.
fn pull(flow: &mut Flow, t: f64) -> [f64; 2] {
    let mut rates = [f64::NAN; 2];
    flow.motion.rhs(t, &[0.0, 0.0], &mut rates).unwrap();
    [rates[1], flow.row(t, &[0.0, 0.0])[3]]
}

/// An input is listed with the parameters, and set like them.
#[test]
fn a_constant_is_set_like_a_parameter() {
    let mut model = model(&text("u = \"m + 1\""));
    assert_eq!(model.parameters().collect::<Vec<_>>(), [("m", 2.0), ("u", 3.0)]);
    assert_eq!(pull(&mut flow(&model, Variables::QuasiVelocities), 0.0), [1.5, 3.0]);
    model.set("u", 5.0).unwrap();
    model.set("m", 4.0).unwrap();
    let mut flow = flow(&model, Variables::Momenta);
    assert_eq!(pull(&mut flow, 0.0), [5.0, 5.0]); // of the momentum
    flow.motion.parameters_mut()[1] = 7.0;
    assert_eq!(pull(&mut flow, 0.0), [7.0, 7.0]);
    let mut value = [f64::NAN];
    flow.events.evaluate(0.0, &[0.0; 2], &mut value).unwrap();
    assert_eq!(value, [4.0]);
}

/// A parabola is its own spline; so is a line through two values.
#[test]
fn tables_are_read_between_their_times() {
    let squares = "times = [0, 1, 2.5, 3, 4], values = [0, 1, 6.25, 9, 16]";
    for (interpolation, t, expected) in [
        ("linear", 2.0, 1.0 + 5.25 / 1.5),
        ("linear", 3.0, 9.0),
        ("cubic", 2.0, 4.0),
        ("cubic", 0.3, 0.09),
        ("cubic", 3.9, 15.21),
        ("hold", 2.0, 1.0),
        ("hold", 2.5, 6.25),
        ("hold", 9.0, 16.0),
    ] {
        let model = model(&text(&format!("u = {{ {squares}, interpolation = \"{interpolation}\" }}")));
        for variables in [Variables::QuasiVelocities, Variables::Momenta] {
            let mass = if variables == Variables::Momenta { 1.0 } else { 2.0 };
            let mut flow = flow(&model, variables);
            let found = pull(&mut flow, t);
            let close = (found[0] * mass - expected).abs() < 1e-13 && (found[1] - expected).abs() < 1e-13;
            assert!(close, "{interpolation} at {t}: {found:?}, not {expected}");
            let mut value = [f64::NAN];
            flow.events.evaluate(t, &[0.0; 2], &mut value).unwrap();
            assert!((value[0] - expected + 1.0).abs() < 1e-13);
        }
        assert_eq!(flow(&model, Variables::QuasiVelocities).motion.breaks(), [0.0, 1.0, 2.5, 3.0, 4.0]);
    }
}

/// At the end of a step the value before the jump counts, at its start the one after it; outputs show the one
/// after it.
#[test]
fn a_jump_has_two_sides() {
    let held = "u = { times = [0, 1, 2], values = [3, 5, 5], interpolation = \"hold\" }";
    let mut flow = flow(&model(&text(held)), Variables::QuasiVelocities);
    assert!(!flow.motion.enter(0.0, 3.0), "there was nothing before");
    assert_eq!(pull(&mut flow, 1.0), [1.5, 5.0]);
    assert!(flow.motion.enter(1.0, 3.0));
    assert_eq!(pull(&mut flow, 1.0)[0], 2.5);
    assert_eq!(pull(&mut flow, 0.5)[0], 1.5, "wherever it is evaluated");
    assert!(!flow.motion.enter(2.0, 3.0), "the value stays");
    assert!(!flow.motion.enter(2.0, 0.0), "backward likewise");
    assert!(flow.motion.enter(1.0, 0.0));
    assert_eq!(pull(&mut flow, 1.0)[0], 1.5);
}

#[test]
fn a_table_has_no_value_outside_its_times() {
    let mut flow = flow(&model(&text("u = { times = [0, 1], values = [3, 5] }")), Variables::QuasiVelocities);
    let failure = flow.motion.rhs(1.5, &[0.0; 2], &mut [0.0; 2]).unwrap_err();
    assert_eq!(failure.to_string(), "the input `u` has no value at t = 1.5: its table goes from 0 to 1");
    assert!(flow.row(1.5, &[0.0; 2])[3].is_nan());

    let late = model(&text("u = { times = [1, 2], values = [3, 5] }"));
    let error = late.assemble(&Graph::new()).err().unwrap().to_string();
    let message =
        "m.toml:4:1: [inputs] u: the table of `u` goes from 1 to 2, and the motion starts outside\n";
    assert!(error.starts_with(message), "{error}");
}

/// Neither by the rate of the energy, nor by that of other functions.
#[test]
fn a_function_driven_by_a_table_is_not_an_integral() {
    let graph = Graph::new();
    let table = "u = { times = [0, 1], values = [3, 5] }";
    for (inputs, kept) in [("u = 3", true), (table, false)] {
        let assembly = model(&text(inputs)).assemble(&graph).unwrap();
        assert_eq!(assembly.keeps_energy(), kept);
        let equations = assembly.equations().unwrap();
        let verdict = Rates::poincare(&equations).verdict(equations.energy());
        assert_eq!(matches!(verdict, Ok(Conservation::Conserved)), kept, "{verdict:?}");
        let bound = equations.with_parameters_bound();
        assert_eq!(
            matches!(Rates::poincare(&bound).verdict(bound.energy()), Ok(Conservation::Conserved)),
            kept
        );
    }
    let projected = text(table) + "[simulation]\nproject = [\"energy\"]\n";
    let model = model(&projected);
    let assembly = model.assemble(&graph).unwrap();
    let error = Flow::new(&model, &assembly, Variables::QuasiVelocities).unwrap_err().to_string();
    assert!(error.contains("`energy` cannot be kept where inputs change with time"), "{error}");
}

#[test]
fn a_column_of_a_file_beside_the_model() {
    let directory = std::env::temp_dir().join(format!("pc-inputs-{}", std::process::id()));
    fs::create_dir_all(&directory).unwrap();
    fs::write(directory.join("x.csv"), "# force on the cart\n\"s\",u,t\n9, 1,0\n9,2,1.5\n\n9,4, 2e0\n")
        .unwrap();
    let read = |column: &str| {
        let text = text(&format!("u = {{ file = \"x.csv\", {column} }}"));
        let name = directory.join("m.toml").display().to_string();
        derived_twice(Document::parse(Source::new(&name, text)).unwrap())
    };
    let mut good = flow(&read("column = \"u\""), Variables::QuasiVelocities);
    assert_eq!(pull(&mut good, 1.75), [1.5, 3.0]);
    let message = |model: Model| {
        let error = model.assemble(&Graph::new()).err().unwrap();
        assert_eq!(error.category(), Category::Text);
        error.diagnostic().message.clone()
    };
    assert_eq!(message(read("column = \"v\"")), "`x.csv` has no column `v`; its columns are s, u, t");
    assert_eq!(
        message(read("column = \"u\", time = \"s\"")),
        "line 4 of `x.csv`: the times must increase, but 9 follows 9"
    );
    fs::write(directory.join("x.csv"), "t,u\n0,1\n1,two\n").unwrap();
    assert_eq!(message(read("column = \"u\"")), "line 3 of `x.csv`: `two` is not a finite number");
    fs::write(directory.join("x.csv"), "t,u\n0,1\n1\n").unwrap();
    assert_eq!(message(read("column = \"u\"")), "line 3 of `x.csv` has 1 entries, not 2");
    fs::remove_dir_all(&directory).unwrap();
    assert!(message(read("column = \"u\"")).starts_with("`x.csv` cannot be read: "));
}

/// A table of a hundred thousand rows costs as much at each evaluation as one of ten.
#[test]
fn tables_may_be_long() {
    let list = |value: &dyn Fn(usize) -> f64| {
        (0..100_000).map(|i| format!("{:?}", value(i))).collect::<Vec<_>>().join(", ")
    };
    let (times, values) = (list(&|i| i as f64 / 1000.0), list(&|i| (i as f64 / 1000.0).sin()));
    let table = format!("u = {{ times = [{times}], values = [{values}], interpolation = \"cubic\" }}");
    let mut flow = flow(&model(&text(&table)), Variables::QuasiVelocities);
    let [rate, shown] = pull(&mut flow, 12.345_67);
    let exact = 12.345_67_f64.sin(); // the spline is off by h⁴ ≈ 1e-12
    assert!((2.0 * rate - exact).abs() < 1e-12 && (shown - exact).abs() < 1e-12);
}

fn refused(text: &str) -> (Category, String) {
    match model(text).assemble(&Graph::new()) {
        Ok(_) => panic!("accepted: {text}"),
        Err(error) => (error.category(), error.to_string()),
    }
}

#[test]
fn errors_in_inputs_are_located_there() {
    for (inputs, message) in [
        (
            "u = { times = [0, 1], values = [1] }",
            "a table needs as many values as times, but has 2 times and 1 values",
        ),
        ("u = { times = [0, 0], values = [1, 2] }", "the times of a table must increase: 0 follows 0"),
        ("u = { times = [0], values = [1] }", "a table needs at least 2 times, not 1"),
        ("u = \"x\"", "`x` cannot be used in the value of a parameter"),
        ("v = 1\nu = \"v\"", "`v` cannot be used in the value of a parameter"),
    ] {
        let (category, error) = refused(&text(inputs));
        assert!(error.contains(&format!("[inputs] u: {message}\n")), "{error}");
        assert_eq!(category, Category::Text);
    }
    let (_, error) = refused(&text("u = 1").replace("pull = \"u\"", "pull = \"d(u*x)\""));
    assert!(error.contains("[outputs] pull: the rate of the input `u` is not known\n"), "{error}");
    let (_, error) = refused(&text("u = 1").replace("potential = \"-u*x\"", "potential = \"-u*x'^2\""));
    assert!(error.contains("momenta depend on the input `u`, whose rate is not known\n"), "{error}");
    let (_, error) = refused(&text("u = 1").replace("x = 0\n", "x = \"u\"\n"));
    assert!(error.contains("`u` cannot be used in a start value\n"), "{error}");
    let (_, error) = refused(&(text("u = 1") + "[constraints]\nc = \"x - u\"\n"));
    assert!(error.contains("`u` cannot be used in a constraint\n"), "{error}");
    let mut driven = model(&text("u = { times = [0, 1], values = [1, 2] }"));
    let error = driven.set("u", 1.0).unwrap_err().to_string();
    assert_eq!(error, "`u` is not a parameter of this model; its parameters are m");
}
