//! Motions on constraints.

use super::{agree, pc, run};

fn chain(links: usize) -> String {
    let (mut start, mut constraints) = (String::new(), String::new());
    for i in 1..=links {
        start += &format!("x{i} = {}\ny{i} = {}\n", i as f64 * 0.6, i as f64 * -0.8);
        let (x, y) =
            if i == 1 { ("0".into(), "0".into()) } else { (format!("x{}", i - 1), format!("y{}", i - 1)) };
        constraints += &format!("link{i} = \"(x{i} - {x})^2 + (y{i} - {y})^2 - 1\"\n");
    }
    let kinetic: Vec<String> = (1..=links).map(|i| format!("x{i}'^2 + y{i}'^2")).collect();
    let height: Vec<String> = (1..=links).map(|i| format!("y{i}")).collect();
    format!(
        "[coordinates]\n{start}[constraints]\n{constraints}[lagrangian]\nkinetic = \"({})/2\"\npotential = \"9.8*({})\"\n\
         [simulation]\nt_end = 1.0\nsamples = 3\n",
        kinetic.join(" + "),
        height.join(" + ")
    )
}

/// Thirty links in Cartesian coordinates keep their lengths and their energy.
#[test]
fn a_long_chain_keeps_its_constraints() {
    let (columns, rows) = run(&chain(30), &[]);
    assert_eq!(columns.len(), 1 + 4 * 30 + 1);
    let energy = |row: &Vec<f64>| *row.last().expect("an energy");
    // −9.8 · 0.8 · Σ i at the start; errors of 10⁻⁹ of its terms in each of a few hundred steps.
    assert!((energy(&rows[2]) - energy(&rows[0])).abs() < 1e-7 * energy(&rows[0]).abs(), "{rows:?}");
    let end = &rows[2];
    for i in 1..30 {
        let (x, y) = (end[1 + 2 * i] - end[2 * i - 1], end[2 + 2 * i] - end[2 * i]);
        assert!((x.hypot(y) - 1.0).abs() < 1e-13, "link {i}: rounding of coordinates up to 30");
    }
    assert_eq!(pc(&chain(30), &["derive", "-", "--form", "lagrange"]).status.code(), Some(0));
    assert_eq!(pc(&chain(10), &["check", "-"]).status.code(), Some(0));
}

/// A bead on a circle with L = −√(1 − v²) − y: M depends on the velocities, in the equations and in the metric of the
/// projection. In the angle, the same motion has one equation.
#[test]
fn a_fast_bead_moves_as_in_its_angle() {
    let cartesian = "[coordinates]\nx = 0.6\ny = -0.8\n[quasi_velocities]\n\"x'\" = 0.64\n\"y'\" = 0.48\n[constraints]\n\
                     circle = \"x^2 + y^2 - 1\"\n[lagrangian]\nlagrangian = \"-sqrt(1 - x'^2 - y'^2) - 0.4*y\"\n\
                     [simulation]\nt_end = 5.0\nsamples = 6\n";
    let by_angle = "[coordinates]\nq = \"atan2(-0.8, 0.6)\"\n[quasi_velocities]\n\"q'\" = 0.8\n[lagrangian]\n\
                    lagrangian = \"-sqrt(1 - q'^2) - 0.4*sin(q)\"\n[outputs]\nx = \"cos(q)\"\ny = \"sin(q)\"\n\
                    [simulation]\nt_end = 5.0\nsamples = 6\n";
    let exact = ["--rtol", "1e-12", "--atol", "1e-14"];
    // A few hundred steps with errors of 10⁻¹², amplified by the motion.
    agree(&run(cartesian, &exact), &run(by_angle, &exact), 1e-9);
}

/// A stiff damped spring at a pendulum held by its length: BDF with the Jacobian does as well as
/// with difference quotients.
#[test]
fn the_jacobian_of_held_motions_serves_bdf() {
    use pc_mech::{CompileOptions, Graph};
    use pc_model::{ConstraintFormulation, Document, Model, Source};
    use pc_solve::{Method, Options, solve};
    let text = "[coordinates]\nx = 0.6\ny = -0.8\nu = 0.7\n[quasi_velocities]\n\"u'\" = 0.0\n[constraints]\n\
                length = \"x^2 + y^2 - 1\"\n[lagrangian]\nkinetic = \"(x'^2 + y'^2 + u'^2)/2\"\n\
                potential = \"9.8*y + 1e6*(u - x)^2/2\"\ndissipation = \"1e4*(u' - x')^2/2\"\n";
    let model = Model::new(Document::parse(Source::new("m.toml", text)).expect("a model"));
    let graph = Graph::new();
    let assembly = model.assemble(&graph).expect("a system");
    let ConstraintFormulation::Multipliers(held) = assembly.constraints.formulation() else {
        panic!("held by a multiplier")
    };
    let solved = |jacobian: bool| {
        let options = CompileOptions::default().jacobian(jacobian);
        let mut motion = held.multipliers.compile_for(options).expect("a motion");
        let options = Options::new(Method::Bdf).relative_tolerance(1e-7).absolute_tolerance(1e-10);
        let trajectory = solve(&mut motion, 0.0, &assembly.start, &[1.0, 2.0], &options).expect("it goes on");
        (trajectory.iter().last().expect("a state").1.to_vec(), *trajectory.statistics())
    };
    let (with, without) = (solved(true), solved(false));
    for (a, b) in with.0.iter().zip(&without.0) {
        // The tolerance of a step times the steps of a slow motion.
        assert!((a - b).abs() < 1e-4, "{:?} {:?}", with.0, without.0);
    }
    let [with, without] = [with.1, without.1];
    assert!(with.jacobian_evaluations > 0, "{with:?}");
    // An explicit method would take about 10⁴ steps per second; Newton's method would fail with a
    // wrong Jacobian.
    assert!(with.steps < 2000 && 2 * with.steps < 3 * without.steps, "{with:?} {without:?}");
    assert!(with.nonlinear_iterations < 2 * with.steps && with.nonlinear_failures < 10, "{with:?}");
}
