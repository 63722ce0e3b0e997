//! Models with events by Taylor's method. (That it reaches the references is a claim of the program `models`.)

use pc_mech::Graph;
use pc_model::{Builtin, Flow, Model, Variables};
use pc_solve::{Method, Options, Solve};
use pc_tests::reference::reference;

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
