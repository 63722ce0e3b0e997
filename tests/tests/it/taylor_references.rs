//! End states of the built-in models by Taylor's method, forwards and back again, against references of 16 digits.

use pc_mech::{Graph, VectorField};
use pc_model::{Builtin, Flow, Model, Variables};
use pc_solve::{Integration, Method, Options, Solve, Taylor};
use pc_tests::reference::{reference, references};

/// What is asked at rtol = 1e-15: the references have 16 digits, and motions magnify the rounding of the start, 1e-16, by at most a few
/// hundred.
const TOLERANCE: f64 = 1e-13;

/// There and back it is magnified again, by the damping of some.
const THERE_AND_BACK: f64 = 1e-11;

/// Against time this one runs away from its slow motion, at a rate of 10⁷.
const IRREVERSIBLE: &str = "stiff-sleigh";

/// Multipliers are solved for in numbers.
const REFUSED: [&str; 3] = ["appell-hamel", "carriage", "vertical-disk"];

#[test]
fn taylor_reaches_the_references_and_comes_back() {
    let mut refused = Vec::new();
    for reference in references() {
        let name = reference.model;
        let model = Model::new(Builtin::named(name).unwrap().document().unwrap());
        let graph = Graph::new();
        let assembly = model.assemble(&graph).unwrap();
        let (mut motion, start) = model.compile(&assembly).unwrap();
        if let Err(failure) = motion.series() {
            assert!(failure.to_string().contains("solved for in numbers"), "{failure}");
            refused.push(name);
            continue;
        }
        let mut watch = motion.clone();
        let options = Options::new(Method::Taylor).relative_tolerance(1e-15).absolute_tolerance(1e-16);
        let stepper = Taylor::new(&mut motion, assembly.t_start, &start, &options).unwrap();
        let mut integration = Integration::of(stepper);
        let end = integration.state_at(reference.t_end).unwrap().to_vec();
        let mut compared = 0;
        for (column, expected) in reference.columns.iter().zip(reference.state) {
            let Some(i) = watch.names().iter().position(|name| name == column) else { continue };
            let error = (end[i] - expected).abs() / (1.0 + expected.abs());
            assert!(error <= TOLERANCE, "{name}: {column} is {}, not {expected}", end[i]);
            compared += 1;
        }
        assert_eq!(compared, watch.names().len().min(reference.state.len()), "{name}");
        let first = watch.observe(assembly.t_start, &start);
        let last = watch.observe(reference.t_end, &end);
        let names = watch.observable_names();
        for conserved in reference.conserved {
            let i = names.iter().position(|name| name == conserved).unwrap();
            let drift = (last[i] - first[i]).abs() / (1.0 + first[i].abs());
            assert!(drift <= TOLERANCE, "{name}: {conserved} drifts by {drift:e}");
        }
        if name == IRREVERSIBLE {
            continue;
        }
        integration.restart(reference.t_end, &end).unwrap();
        let back = integration.state_at(assembly.t_start).unwrap();
        for (i, (back, start)) in back.iter().zip(&start).enumerate() {
            let error = (back - start).abs();
            assert!(
                error <= THERE_AND_BACK,
                "{name}: {} comes back to {back}, not {start}",
                watch.names()[i]
            );
        }
    }
    assert_eq!(refused, REFUSED);
}

/// The models whose events bounce, stick, slip and rock.
const EVENTFUL: [&str; 4] = ["bouncing-ball", "rocking-block", "stick-slip-block", "stick-slip-sleigh"];

/// Every method comes to the same events and the same end: at rtol = 1e-12 an event of the motion by Adams is known to some 1e-12 of the
/// state over its speed there.
#[test]
fn models_with_events_agree_with_adams() {
    for name in EVENTFUL {
        let model = Model::new(Builtin::named(name).unwrap().document().unwrap());
        let graph = Graph::new();
        let assembly = model.assemble(&graph).unwrap();
        let end = reference(name).unwrap().t_end;
        let run = |method: Method| {
            let mut flow = Flow::new(&model, &assembly, Variables::QuasiVelocities).unwrap();
            let options = Options::new(method).relative_tolerance(1e-13).absolute_tolerance(1e-15);
            let start = flow.start.clone();
            let solve = Solve::new(&mut flow.motion, assembly.t_start, &start);
            let solution = solve.method(&options).events(&mut flow.events).run(&[end]).unwrap();
            let events: Vec<(usize, f64)> =
                solution.occurrences.iter().map(|occurrence| (occurrence.event, occurrence.time)).collect();
            (events, solution.trajectory.last().unwrap().1.to_vec())
        };
        let (taylor, adams) = (run(Method::Taylor), run(Method::Adams));
        assert_eq!(taylor.0.len(), adams.0.len(), "{name}: {:?} {:?}", taylor.0, adams.0);
        for (found, expected) in taylor.0.iter().zip(&adams.0) {
            assert_eq!(found.0, expected.0, "{name}");
            assert!((found.1 - expected.1).abs() < 1e-10, "{name}: {found:?} {expected:?}");
        }
        for (found, expected) in taylor.1.iter().zip(&adams.1) {
            assert!((found - expected).abs() < 1e-10, "{name}: {:?} {:?}", taylor.1, adams.1);
        }
    }
}
