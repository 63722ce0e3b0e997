//! Derivatives of motions of models with events by their parameters, against differences of whole motions, on random models.

use pc_mech::Graph;
use pc_model::{Document, Flow, Model, Source, Variables};
use pc_solve::{Method, Options, Sensitivities, SensitivitySolution, Solve};
use pc_tests::fuzz::random::Random;

const T_END: f64 = 4.0;

/// A point with a quartic potential, a wall that leans and swings, and a switch that moves; written in velocities or in
/// quasi-velocities, or on a rod that a multiplier holds. Event functions, resets and starts depend on parameters, states and t.
fn text(random: &mut Random) -> String {
    let mut number = |low: f64, high: f64| format!("{:?}", random.decimal(low, high));
    let parameters = format!(
        "[parameters]\nm = {}\nk = {}\ne = {}\nw = {}\nh = {}\n",
        number(0.5, 2.0),
        number(1.0, 6.0),
        number(0.4, 0.9),
        number(0.2, 0.9),
        number(0.5, 1.2),
    );
    let (speed, lean, swing, push) =
        (number(-0.8, 0.8), number(-0.4, 0.4), number(-0.2, 0.2), number(0.1, 0.4));
    let wall = format!("when = \"x + {lean}*w*z - {swing}*w*sin(t) + 0.2*w\"\ndirection = \"falling\"\n");
    let rod = |reset: &str| {
        format!(
            "{parameters}[coordinates]\nx = \"h*sin(0.9)\"\nz = \"-h*cos(0.9)\"\n[quasi_velocities]\n\
             \"x'\" = \"h*{speed}*cos(0.9)\"\n\"z'\" = \"h*{speed}*sin(0.9)\"\n[constraints]\n\
             rod = \"(x^2 + z^2 - h^2)/2\"\n[lagrangian]\nkinetic = \"m*(x'^2 + z'^2)/2\"\npotential = \"k*z\"\n\
             [events.wall]\nwhen = \"x - {swing}*w*sin(t)\"\ndirection = \"falling\"\nreset = {{ {reset} }}\n"
        )
    };
    match random.below(4) {
        0 => format!(
            "{parameters}[coordinates]\nx = \"h\"\nz = 0.2\n[quasi_velocities]\n\"x'\" = {speed}\n\"z'\" = \"h/2\"\n\
             [lagrangian]\nkinetic = \"m*x'^2/2 + z'^2/2 + x*x'*z'/5\"\n\
             potential = \"k*x^2/2 + z^4/4 + w*x*z\"\n[events.wall]\n{wall}\
             reset = {{ \"x'\" = \"-e*x' + 0.1*w*z'\" }}\n[events.switch]\nwhen = \"z - 0.1*w*t\"\n\
             reset = {{ \"z'\" = \"z' + {push}*w*cos(t)\", x = \"x + 0.01*k*w\" }}\n"
        ),
        1 => format!(
            "{parameters}[coordinates]\nx = \"h\"\nz = 0.2\n[quasi_velocities]\n\
             u = {{ is = \"x' + x*z'\", start = {speed} }}\nv = {{ is = \"z' - 0.3*x'\", start = \"h/2\" }}\n\
             [lagrangian]\nkinetic = \"m*x'^2/2 + z'^2/2\"\npotential = \"k*x^2/2 + z^4/4 + w*x*z\"\n\
             [events.wall]\n{wall}reset = {{ u = \"-e*u\", v = \"v*(1 - 0.1*w)\" }}\n"
        ),
        2 => rod("\"x'\" = \"-e*x'\", \"z'\" = \"-e*z'\""),
        // To another place on the circle, where the velocities are then those that the rod allows.
        _ => rod("x = \"x + 0.2*h\", z = \"-sqrt(h^2 - (x + 0.2*h)^2)\", \"x'\" = \"-e*x'\""),
    }
}

fn options() -> Options {
    Options::new(Method::Adams).relative_tolerance(1e-12).absolute_tolerance(1e-14)
}

fn parsed(text: &str) -> Model {
    Model::new(Document::parse(Source::new("m.toml", text)).unwrap_or_else(|error| panic!("{error}\n{text}")))
}

fn flow(model: &Model, variables: Variables) -> Option<Flow> {
    let graph = Graph::new();
    Flow::new(model, &model.assemble(&graph).ok()?, variables).ok()
}

/// The end of a motion with a parameter moved, and how often what has occurred.
fn end(model: &Model, variables: Variables, (name, value): (&str, f64)) -> Option<(Vec<f64>, Vec<usize>)> {
    let mut moved = model.clone();
    moved.set(name, value).ok()?;
    let mut flow = flow(&moved, variables)?;
    let (motion, start) = (&mut flow.motion, flow.start.clone());
    let motion =
        Solve::new(motion, 0.0, &start).method(&options()).events(&mut flow.events).run(&[T_END]).ok()?;
    let events = motion.occurrences.iter().map(|occurrence| occurrence.event).collect();
    Some((motion.trajectory.last()?.1.to_vec(), events))
}

/// Differences of order 4 of motions on which the same occurs; none where it does not. Their truncation, of steps of 5e-4 and
/// 1e-3, goes with their fourth power, and the errors 1e-12 of the motions, grown by their impacts, become 1e-8.
fn difference(
    model: &Model,
    variables: Variables,
    name: &str,
    value: f64,
    events: &[usize],
) -> Option<Vec<f64>> {
    let slope = |step: f64| -> Option<Vec<f64>> {
        let (ahead, then) = end(model, variables, (name, value + step))?;
        let (behind, before) = end(model, variables, (name, value - step))?;
        let same = then == events && before == events;
        same.then(|| ahead.iter().zip(behind).map(|(a, b)| (a - b) / (2.0 * step)).collect())
    };
    let (fine, coarse) = (slope(2.5e-4)?, slope(5e-4)?);
    Some(fine.iter().zip(coarse).map(|(fine, coarse)| (4.0 * fine - coarse) / 3.0).collect())
}

#[test]
fn derivatives_over_events_are_those_of_whole_motions() {
    let (mut compared, mut resets, mut kinds) = (0, 0, [0; 4]);
    for index in 0..28 {
        let mut random = Random::new(16, index);
        let text = text(&mut random);
        let kind = match (text.contains("rod"), text.contains("sqrt")) {
            (true, moves) => 2 + usize::from(moves),
            (false, _) => usize::from(text.contains("is =")),
        };
        let mut model = parsed(&text);
        let values: Vec<(String, f64)> =
            model.parameters().map(|(name, value)| (name.to_owned(), value)).collect();
        for variables in [Variables::QuasiVelocities, Variables::Momenta] {
            model.differentiate_by_parameters(true);
            let Some(mut differentiated) = flow(&model, variables) else { continue };
            let columns: Vec<Vec<f64>> = (0..values.len())
                .map(|j| {
                    let column =
                        model.derived(|assembly| differentiated.start_by_parameter(&model, assembly, j));
                    column.unwrap_or_else(|error| panic!("{error}\n{text}"))
                })
                .collect();
            let wanted = columns.into_iter().enumerate();
            let wanted = wanted.fold(Sensitivities::new(), |s, (j, start)| s.by_parameter_from(j, start));
            model.differentiate_by_parameters(false);
            let (motion, start) = (&mut differentiated.motion, differentiated.start.clone());
            let run = Solve::new(motion, 0.0, &start)
                .method(&options())
                .events(&mut differentiated.events)
                .sensitivities(&wanted)
                .run(&[T_END]);
            // One that grazes, or whose events accumulate, has no derivatives.
            let Ok(SensitivitySolution { trajectory, occurrences, .. }) = run else { continue };
            let events: Vec<usize> = occurrences.iter().map(|occurrence| occurrence.event).collect();
            for (j, (name, value)) in values.iter().enumerate() {
                let Some(expected) = difference(&model, variables, name, *value, &events) else { continue };
                let size = expected.iter().fold(1.0, |size: f64, s| size.max(s.abs()));
                let found = trajectory.column(0, j);
                for (found, expected) in found.iter().zip(&expected) {
                    // Up to 1e-7; where an event is nearly grazed the fifth derivatives, which the truncation has, are large.
                    assert!(
                        (found - expected).abs() < 2e-6 * size,
                        "model {index}, {variables:?}, by {name}, over {events:?}: {found} is not {expected}\n{text}"
                    );
                }
                compared += 1;
                resets += events.len();
                kinds[kind] += 1;
            }
        }
    }
    assert!(
        compared > 180 && resets > 2 * compared && kinds.iter().all(|&n| n > 20),
        "{compared} {resets} {kinds:?}"
    );
}
