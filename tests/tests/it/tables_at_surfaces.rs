//! Tables in the functions of surfaces: belts whose speed jumps, and bodies that stick to them.

use pc_mech::Graph;
use pc_model::{Document, Flow, Model, Source, Variables};
use pc_solve::{Method, Options, Sensitivities, Solve};

const METHODS: [Method; 4] = [Method::Auto, Method::Dop853, Method::Adams, Method::Bdf];

/// A body lies on a belt that begins to move with speed 1 at t = 1: it slides for 1/F, then it sticks.
const BELT: &str = "[parameters]\nF = 2\n[coordinates]\nx = 0\n[inputs]\n\
    r = { times = [0, 1], values = [0, 1], interpolation = \"hold\" }\n\
    [lagrangian]\nkinetic = \"x'^2/2\"\n[forces]\nx = \"-F*sign(x' - r)\"\n";

fn model(text: &str) -> Model {
    Model::new(Document::parse(Source::new("model.toml", text)).expect("a text"))
}

fn flow(model: &Model) -> Flow {
    let graph = Graph::new();
    let assembly = model.assemble(&graph).expect("a model");
    Flow::new(model, &assembly, Variables::QuasiVelocities).expect("equations")
}

fn end(text: &str, method: Method, t: f64) -> Vec<f64> {
    let mut flow = flow(&model(text));
    let (options, start) = (Options::new(method), flow.start.clone());
    let solved = Solve::new(&mut flow.motion, 0.0, &start).method(&options).run(&[t]);
    let solved = solved.unwrap_or_else(|failure| panic!("{method}: {}", failure.error));
    solved.trajectory.last().expect("a row").1.to_vec()
}

/// x(3) = 2 - 1/(2F)
#[test]
fn a_body_slides_on_a_belt_that_starts() {
    for method in METHODS {
        let y = end(BELT, method, 3.0);
        assert!((y[0] - 1.75).abs() < 1e-7 && (y[1] - 1.0).abs() < 1e-7, "{method}: {y:?}");
    }
}

/// ∂x(3)/∂F = 1/(2F²): the time at which the belt starts does not move.
#[test]
fn the_time_of_a_table_does_not_move_with_parameters() {
    for method in [Method::Adams, Method::Dop853] {
        let mut model = model(BELT);
        model.differentiate_by_parameters(true);
        let mut flow = flow(&model);
        let start = flow.start.clone();
        let column = model.derived(|assembly| flow.start_by_parameter(&model, assembly, 0));
        let column = column.expect("a column");
        let solved = Solve::new(&mut flow.motion, 0.0, &start)
            .method(&Options::new(method))
            .events(&mut flow.events)
            .sensitivities(&Sensitivities::new().by_parameter_from(0, column))
            .run(&[3.0]);
        let solved = solved.unwrap_or_else(|failure| panic!("{method}: {}", failure.error));
        let slope = solved.trajectory.column(0, 0)[0];
        assert!((slope - 0.125).abs() < 1e-7, "{method}: {slope}");
    }
}

/// At 0.05 a belt is switched to a speed that a body reaches with the rate 2.75; beyond it the rate is 2.2.
#[test]
fn a_passage_soon_after_a_jump_is_located_to_rounding() {
    let text = "[coordinates]\nx = 0\n[inputs]\n\
        r = { times = [0, 0.05], values = [-1, 0.3], interpolation = \"hold\" }\n\
        [lagrangian]\nkinetic = \"x'^2\"\n[forces]\nx = \"5 + step(x' - r, -0.6, 0.5)\"\n";
    for method in METHODS {
        let y = end(text, method, 0.4);
        let reached = 0.05 + (0.3 - 0.05 * 2.2) / 2.75;
        let speed = 0.3 + 2.2 * (0.4 - reached);
        // Multistep methods make errors of their tolerance at each step.
        let allowed = if method == Method::Dop853 { 1e-13 } else { 1e-8 };
        assert!((y[1] - speed).abs() < allowed, "{method}: {} is not {speed}", y[1]);
    }
}

/// A belt whose speed rises by 0.1, then by 3 a second carries a body with friction 1 along, and leaves it behind.
#[test]
fn a_body_sticks_to_a_belt_with_a_ramp() {
    let text = "[coordinates]\nx = 0\n[inputs]\nr = { times = [0, 1, 3], values = [0, 0.1, 6.1] }\n\
        [lagrangian]\nkinetic = \"x'^2/2\"\n[forces]\nx = \"-sign(x' - r)\"\n";
    for method in METHODS {
        let y = end(text, method, 2.0);
        assert!((y[0] - 0.65).abs() < 1e-7 && (y[1] - 1.1).abs() < 1e-7, "{method}: {y:?}");
    }
}
