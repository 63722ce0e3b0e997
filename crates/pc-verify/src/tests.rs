//! The second derivation alone, against motions known in closed form.

use pc_mech::Graph;
use pc_model::{Document, Flow, Model, Source, Variables};
use pc_print::Form;

use crate::comparison::agreement::Agreement;
use crate::comparison::compare::{Options, verify};
use crate::comparison::outlet::{Outlet, vouch};
use crate::comparison::resets::Jump;
use crate::comparison::second::Second;
use crate::comparison::slopes::Slope;
use crate::derivation::equations::Derived;
use crate::derivation::place::Place;
use crate::error::VerifyError;
use crate::numbers::rounding::Rounding;

fn model(text: &str) -> Model {
    Model::new(Document::parse(Source::new("model.toml", text)).unwrap())
}

pub(crate) fn verified(model: &Model, options: &Options) -> Result<Agreement, VerifyError> {
    model.derived(|assembly| verify(model, assembly, options))
}

/// The second derivation at the start.
fn at_start(text: &str) -> Derived {
    let (graph, model) = (Graph::new(), model(text));
    let second = Second::new(&model, &model.assemble(&graph).unwrap()).unwrap();
    second.derivation().at(second.start(), &Rounding::none()).unwrap()
}

/// Some hundred roundings of numbers near 1.
fn assert_near(found: &[f64], expected: &[f64]) {
    assert_eq!(found.len(), expected.len());
    let near = found.iter().zip(expected).all(|(f, e)| (f - e).abs() < 1e-13);
    assert!(near, "{found:?}, not {expected:?}");
}

/// λ of x² + y² = 1 is (y − v²)/2 for a unit mass under unit gravity; its sign is that of 2xλ as a force along x.
#[test]
fn a_rod_pulls_with_its_multiplier() {
    let derived = at_start(
        r#"
[coordinates]
x = 0.6
y = -0.8
[quasi_velocities]
"x'" = 0.8
"y'" = 0.6
[constraints]
rod = "x^2 + y^2 - 1"
[lagrangian]
kinetic = "(x'^2 + y'^2)/2"
potential = "y"
"#,
    );
    let lambda = (-0.8 - 1.0) / 2.0;
    assert_near(&derived.reactions, &[lambda]);
    assert_near(&derived.accelerations, &[2.0 * 0.6 * lambda, -1.0 - 2.0 * 0.8 * lambda]);
}

/// A_1 ω̇_1 = (A_2 − A_3) ω_2 ω_3 and cyclically: the brackets of so(3) where there are no coordinates.
#[test]
fn a_free_body_obeys_eulers_equations() {
    let derived = at_start(
        r#"
[quasi_velocities]
w1 = 1.0
w2 = 2.0
w3 = 3.0
[algebra]
name = "so3"
[lagrangian]
kinetic = "(2*w1^2 + 3*w2^2 + 5*w3^2)/2"
"#,
    );
    assert_near(
        &derived.accelerations,
        &[(3.0 - 5.0) * 6.0 / 2.0, (5.0 - 2.0) * 3.0 / 3.0, (2.0 - 3.0) * 2.0 / 5.0],
    );
}

/// The same with Euler's angles, where the frame determines the brackets; and with Poisson's vertical, for
/// which constants are found.
#[test]
fn brackets_come_from_the_frame_or_fit_everywhere() {
    let angles = r#"
[coordinates]
"ψ" = 0.3
"θ" = 1.1
"φ" = 0.7
[quasi_velocities]
w1 = 1.0
w2 = 2.0
w3 = 3.0
[kinematics]
"θ" = "w1*cos(φ) - w2*sin(φ)"
"ψ" = "(w1*sin(φ) + w2*cos(φ))/sin(θ)"
"φ" = "w3 - cot(θ)*(w1*sin(φ) + w2*cos(φ))"
[lagrangian]
kinetic = "(2*w1^2 + 3*w2^2 + 5*w3^2)/2"
"#;
    let vertical = r#"
[coordinates]
g1 = 0.6
g2 = 0.0
g3 = 0.8
[quasi_velocities]
w1 = 1.0
w2 = 2.0
w3 = 3.0
[kinematics]
g1 = "g2*w3 - g3*w2"
g2 = "g3*w1 - g1*w3"
g3 = "g1*w2 - g2*w1"
[lagrangian]
kinetic = "(2*w1^2 + 3*w2^2 + 5*w3^2)/2"
"#;
    for text in [angles, vertical] {
        assert_near(&at_start(text).accelerations, &[-6.0, 3.0, -0.4]);
    }
}

/// v̇ = a ω², (J + m a²) ω̇ = −m a v ω, and the blade holds with λ = v ω (m − m² a²/(m a² + J)).
#[test]
fn a_sleigh_is_held_by_its_blade() {
    let derived = at_start(
        r#"
[parameters]
m = 2.0
J = 1.5
a = 0.5
[coordinates]
x = 0.0
y = 0.0
"φ" = 0.0
[quasi_velocities]
v = { is = "cos(φ)*x' + sin(φ)*y'", start = 0.7 }
"ω" = { is = "φ'", start = 1.2 }
[constraints]
blade = "-sin(φ)*x' + cos(φ)*y'"
[lagrangian]
kinetic = "m/2*(x'^2 + y'^2) + m*a*ω*(cos(φ)*y' - sin(φ)*x') + (J + m*a^2)/2*ω^2"
"#,
    );
    let (m, inertia, a, v, w): (f64, f64, f64, f64, f64) = (2.0, 1.5, 0.5, 0.7, 1.2);
    let turning = -m * a * v * w / (inertia + m * a * a);
    // At φ = 0 the acceleration across is that of the turning frame, v ω.
    assert_near(&derived.accelerations, &[a * w * w, v * w, turning]);
    assert_near(&derived.reactions, &[v * w * (m - m * m * a * a / (m * a * a + inertia))]);
}

/// I φ̈ = N − m g l sin φ for a body that turns about an axle, given by its rotation.
#[test]
fn forces_and_torques_act_on_bodies() {
    let derived = at_start(
        r#"
[coordinates]
"φ" = 0.5
[quasi_velocities]
"φ'" = 2.0
[bodies.b]
mass = 2.0
position = ["0.3*sin(φ)", "-0.3*cos(φ)", 0]
rotation = ["cos(φ)", "-sin(φ)", 0, "sin(φ)", "cos(φ)", 0, 0, 0, 1]
inertia = [1, 2, 0.4]
force = [0, -20, 0]
torque = [0, 0, 0.7]
"#,
    );
    assert_near(&derived.accelerations, &[(0.7 - 20.0 * 0.3 * 0.5f64.sin()) / (0.4 + 2.0 * 0.09)]);
}

/// z̈ = −g/(1 + k²) along a straight line, λ = −k² g ż/(ẋ² + ẏ² + k⁴ ż²) in ẍ = λ ẋ; here λ is that of ½ the
/// constraint.
#[test]
fn chetaevs_condition_holds_a_nonlinear_constraint() {
    let derived = at_start(
        r#"
[coordinates]
x = 0.0
y = 0.0
z = 0.0
[quasi_velocities]
"x'" = 0.45
"y'" = 0.6
"z'" = -1.0
[constraints]
drive = { expr = "(x'^2 + y'^2 - 0.75^2*z'^2)/2", kind = "nonlinear" }
[lagrangian]
kinetic = "(x'^2 + y'^2 + z'^2)/2"
potential = "10*z"
"#,
    );
    let k2 = 0.5625;
    let lambda = k2 * 10.0 / (k2 + k2 * k2);
    assert_near(&derived.accelerations, &[0.45 * lambda, 0.6 * lambda, -10.0 / (1.0 + k2)]);
    assert_near(&derived.reactions, &[lambda]);
}

/// ẍ = −2 ζ x' − x by Rayleigh's function, and a force on a coordinate.
#[test]
fn dissipation_slows_the_motion() {
    let derived = at_start(
        r#"
[coordinates]
x = 1.0
[quasi_velocities]
"x'" = 3.0
[lagrangian]
kinetic = "x'^2"
potential = "x^2"
dissipation = "0.2*x'^2"
[forces]
x = "5*t + 1"
"#,
    );
    assert_near(&derived.accelerations, &[(1.0 - 2.0 - 0.4 * 3.0) / 2.0]);
}

/// A mass that is a thousandth larger in one of the derivations changes the acceleration.
#[test]
fn a_difference_is_an_error_with_both_values() {
    let text = "[coordinates]\nx = 1.0\n[parameters]\nm = 2.0\n[lagrangian]\nkinetic = \"m*x'^2/2\"\npotential = \"x^2/2\"";
    let (mut heavier, graph) = (model(text), Graph::new());
    let light = model(text);
    let assembly = light.assemble(&graph).unwrap();
    let flow = Flow::new(&light, &assembly, Variables::QuasiVelocities).unwrap();
    heavier.set("m", 2.002).unwrap();
    let second = Second::new(&heavier, &assembly).unwrap();
    let found = second.agrees("poincare", &flow, &assembly, 0.0, &[1.0, 0.0]);
    let Err(VerifyError::Disagreement(disagreement)) = found else { panic!("{found:?}") };
    assert_eq!(disagreement.quantity, "the rate of x'");
    assert_near(&[disagreement.first, disagreement.second], &[-0.5, -1.0 / 2.002]);
    let message = VerifyError::Disagreement(disagreement).to_string();
    assert!(message.ends_with("at t = 0.0, x = 1.0, x' = 0.0"), "{message}");
}

/// A random state satisfies constraints on positions and on velocities.
#[test]
fn states_are_on_the_constraints() {
    let text = r#"
[coordinates]
x = 0.6
y = -0.8
[constraints]
rod = "x^2 + y^2 - 1"
[lagrangian]
kinetic = "(x'^2 + y'^2)/2"
"#;
    let (graph, model) = (Graph::new(), model(text));
    let second = Second::new(&model, &model.assemble(&graph).unwrap()).unwrap();
    for number in 0..20 {
        let Place { x, w, .. } = second.derivation().random(second.start(), number).unwrap();
        assert_near(&[x[0] * x[0] + x[1] * x[1], x[0] * w[0] + x[1] * w[1]], &[1.0, 0.0]);
    }
}

/// A constraint with coefficients of 1e40 does not affect another one.
#[test]
fn the_scale_of_a_constraint_does_not_matter() {
    let text = r#"
[coordinates]
x = 0.0
y = 0.0
z = 0.0
[quasi_velocities]
"z'" = 1.0
[constraints]
large = "1e40*x' - 1e40*y'"
small = "x' + y' - z'/8"
[lagrangian]
kinetic = "(x'^2 + y'^2 + z'^2)/2"
"#;
    let text = text.replace("\"z'\" = 1.0", "\"x'\" = 0.0625\n\"y'\" = 0.0625\n\"z'\" = 1.0");
    let (graph, model) = (Graph::new(), model(&text));
    let second = Second::new(&model, &model.assemble(&graph).unwrap()).unwrap();
    for number in 0..20 {
        let Place { w, .. } = second.derivation().random(second.start(), number).unwrap();
        assert_near(&[w[0] - w[1], w[0] + w[1] - w[2] / 8.0], &[0.0, 0.0]);
    }
}

/// x' − y' for x' = y' has the size of either, as far as rounding goes.
#[test]
fn cancelling_sums_are_measured_by_their_summands() {
    let text = r#"
[coordinates]
x = 0.0
[quasi_velocities]
"x'" = 3.0
[definitions]
rest = "2*(x' - 3)"
[lagrangian]
kinetic = "x'^2/2"
[outputs]
out = "rest/4"
"#;
    let (graph, model) = (Graph::new(), model(text));
    let second = Second::new(&model, &model.assemble(&graph).unwrap()).unwrap();
    let (derivation, exact) = (second.derivation(), Rounding::none());
    let out = &derivation.text.observed[0].1;
    let point = derivation.still(second.start(), &exact);
    assert_eq!((point.value(out).unwrap(), point.largest_term(out).unwrap()), (0.0, 1.5));
}

/// L = x'⁴/4 − x'²/2 has the momentum x'³ − x': three velocities for one where |x'| < 2/√3. The form in
/// momenta is compared where they determine the velocity, and the result mentions that this is not always so.
#[test]
fn ambiguous_momenta_are_not_a_disagreement() {
    let text = r#"
[coordinates]
x = 0.0
[quasi_velocities]
"x'" = 1.3
[lagrangian]
kinetic = "x'^4/4 - x'^2/2"
potential = "x^2/2"
"#;
    let agreement = verified(&model(text), &Options::default()).unwrap();
    assert!(agreement.states == 100 && agreement.error < 1e-12, "{agreement}");
    let said = "canonical: at some states the momenta are those of other velocities, too";
    assert!(agreement.not_compared.iter().any(|line| line == said), "{:?}", agreement.not_compared);
}

/// η = √a q' + 1/q of a free particle: p = 2 q'/√a is conserved, and its rate is the rounding of terms in
/// 1/q³.
#[test]
fn quantities_that_a_drift_cancels_have_the_rounding_of_the_drift() {
    let agreement = verified(
        &model(
            r#"
[coordinates]
x = 0.71
q = 0.71
[quasi_velocities]
w = { is = "sqrt(0.79)*q' + 1.0/q", start = 1.4084507042253522 }
[constraints]
held = "x'"
[lagrangian]
kinetic = "q'^2"
"#,
        ),
        &Options::default(),
    );
    assert_eq!(agreement.unwrap().states, 100);
}

/// y is fixed against a force, and moves by a part in 2⁵⁴ of it; the motion along q is a thousand times
/// slower.
#[test]
fn quantities_that_reactions_balance_have_the_rounding_of_the_forces() {
    let agreement = verified(
        &model(
            r#"
[coordinates]
x = 0.71
y = 0.89
"φ" = 0.5
q = 0.71
[quasi_velocities]
w = { is = "sqrt(0.79)*sqrt(x)*q' + 0.3*(1.0/(2.0 + q^2))", start = 0.11980352222355337 }
[constraints]
k0 = "(1.0 + abs(φ)^2)*y'"
k1 = "q*φ' + atan(x)*y'"
k2 = "(1.0 + tanh(x))*x'"
[lagrangian]
kinetic = "0.2*x'^2 + 1.02*exp(x)*x'^2 + 0.96*y'^2 + 1.12*φ'^2 + 1.1*q'^2"
potential = "(-0.51)*(1.0/(2.0 + y^2))"
[forces]
x = "(-0.33)*exp(-((t - 0.13769)/0.02769)^2)"
"#,
        ),
        &Options { states: 100, ..Options::default() },
    );
    assert_eq!(agreement.unwrap().states, 100);
}

/// w_2 = y φ' + y' and ω = y' determine φ' less and less as y goes to 0, to y⁻⁴ roundings of reactions:
/// states near there give no information on the derivation, others do.
#[test]
fn states_at_which_rounding_hides_everything_are_skipped() {
    let agreement = verified(
        &model(
            r#"
[coordinates]
x = 0.9
y = 0.68
"φ" = 1.01
q = 0.52
[quasi_velocities]
w1 = { is = "x'", start = -0.9 }
w2 = { is = "y*φ' + y'", start = 0.6245834298922175 }
"ω" = { is = "y'", start = 0.10098342989221738 }
[constraints]
k0 = "q + cos(y) - 1.2975727187509278"
[lagrangian]
kinetic = "x'^2 + φ'^2 + q'^2"
"#,
        ),
        &Options::default(),
    );
    let agreement = agreement.unwrap();
    assert_eq!(agreement.states, 100);
    let partly = agreement.not_compared.iter().any(|line| line.contains("amplified too much"));
    assert!(partly, "{:?}", agreement.not_compared);
}

/// Sixty coordinates, one of them coupled to all, on fifty-nine circles: the rates of the constraints cancel
/// to the last digit, without scatter.
#[test]
fn fully_cancelling_sums_have_the_size_of_their_terms() {
    let list = |n: usize, entry: &dyn Fn(usize) -> String, between: &str| -> String {
        (0..n).map(entry).collect::<Vec<_>>().join(between)
    };
    let text = format!(
        "[coordinates]\n{}\n[lagrangian]\nkinetic = \"{} + x0'*({})/8\"\n[constraints]\n{}\n",
        list(60, &|i| format!("x{i} = 0.5"), "\n"),
        list(60, &|i| format!("x{i}'^2/2"), " + "),
        list(60, &|i| format!("x{i}'"), " + "),
        list(59, &|i| format!("k{i} = \"x{i}^2 + x{}^2 - 0.5\"", i + 1), "\n"),
    );
    let agreement = verified(&model(&text), &Options { states: 10, ..Options::default() }).unwrap();
    assert!(agreement.projected > 0, "{agreement:?}");
}

/// Subnormal numbers, below 2⁻¹⁰²², have fewer digits the smaller they are.
#[test]
fn values_without_significant_digits_are_not_compared() {
    let text = "[coordinates]\nx = 0.7\ny = 0.3\n[lagrangian]\nkinetic = \"3*x'^2 + x'*y'*cos(x) + y'^2\"\n\
                potential = \"7e-323*sin(x + y)\"\n";
    assert_eq!(verified(&model(text), &Options::default()).unwrap().states, 100);
}

/// A pendulum with damping beside an angle that nothing depends on; gravity is so many times as strong.
fn pendulum(times: &str) -> Model {
    model(&format!(
        r#"
[parameters]
l = 1.0
[coordinates]
"φ" = 0.3
"ψ" = 0.0
[quasi_velocities]
w = {{ is = "φ'", start = 0.2 }}
v = {{ is = "ψ' + φ'", start = 1.0 }}
[lagrangian]
kinetic = "l^2*φ'^2/2 + ψ'^2"
potential = "-{times}*l*cos(φ)"
[forces]
"φ" = "-0.1*φ'"
[simulation]
t_end = 1
"#
    ))
}

/// Every way out of a model.
fn outlets() -> Vec<Outlet> {
    let integrated =
        [Variables::QuasiVelocities, Variables::Momenta, Variables::Reduced, Variables::Orthonormal];
    let pages = [
        Form::Poincare,
        Form::Canonical,
        Form::Lagrange,
        Form::Reduced,
        Form::LiePoisson,
        Form::Orthonormal,
        Form::Maggi,
        Form::Kane,
        Form::GibbsAppell,
    ];
    let sources = [Variables::QuasiVelocities, Variables::Reduced, Variables::Orthonormal];
    let all = integrated.map(Outlet::Equations).into_iter();
    all.chain(sources.map(Outlet::Source)).chain(pages.map(Outlet::Page)).collect()
}

/// In each form the equations themselves are compared, not others in their place.
#[test]
fn whatever_leaves_is_compared() {
    let (graph, model) = (Graph::new(), pendulum("1"));
    let assembly = model.assemble(&graph).unwrap();
    for outlet in outlets() {
        let agreement = vouch(&model, &assembly, outlet).unwrap();
        let form = match outlet {
            Outlet::Equations(variables) => variables.name().to_owned(),
            Outlet::Source(Variables::QuasiVelocities) => "emit".to_owned(),
            Outlet::Source(variables) => variables.name().to_owned(),
            Outlet::Page(form) => format!("{} as printed", form.name()),
            Outlet::PageWithReactions(form) => format!("{} as printed with reactions", form.name()),
        };
        assert_eq!((agreement.states, agreement.forms.as_slice()), (4, [form].as_slice()), "{outlet:?}");
        assert!(agreement.error < 1e-13, "{outlet:?}: {agreement}");
    }
}

/// Equations with another gravity are not those of the model, in whatever form they leave.
#[test]
fn wrong_equations_leave_in_no_form() {
    let (graph, model, other) = (Graph::new(), pendulum("1"), pendulum("1.01"));
    let assembly = model.assemble(&graph).unwrap();
    let second = Second::new(&other, &assembly).unwrap();
    for outlet in outlets() {
        let outcome = second.vouches(&model, &assembly, outlet);
        assert!(matches!(outcome, Err(VerifyError::Disagreement(_))), "{outlet:?}: {outcome:?}");
    }
}

/// ẍ = −k sin x + u: along (δx, δu) its rate changes by −k cos x δx + δu, and the output x² + u by 2x δx + δu.
fn slope_of_a_pendulum(by_x: f64, by_u: f64) -> Result<Agreement, VerifyError> {
    let model = model(
        "[parameters]\nk = 2.5\n[coordinates]\nx = 0.7\n[quasi_velocities]\n\"x'\" = -0.4\n[lagrangian]\nkinetic = \"x'^2/2\"\n\
         potential = \"-k*cos(x)\"\n[inputs]\nu = 0.3\n[forces]\nx = \"u\"\n[outputs]\no = \"x^2 + u\"\n",
    );
    let graph = Graph::new();
    let assembly = model.assemble(&graph).unwrap();
    let flow = Flow::new(&model, &assembly, Variables::QuasiVelocities).unwrap();
    let second = Second::new(&model, &assembly).unwrap();
    let slope = Slope {
        name: "the derivative".to_owned(),
        state: vec![2.0, 0.0],
        parameters: vec![("u".to_owned(), 3.0)],
        rates: vec![("x".to_owned(), 0.0), ("x'".to_owned(), 2.0 * by_x + 3.0 * by_u)],
        observed: vec![("o".to_owned(), 4.0 * 0.7 + 3.0)],
    };
    second.slope_agrees((&model, &assembly), &flow, (0.0, &[0.7, -0.4]), &slope)
}

#[test]
fn a_right_derivative_agrees_and_a_wrong_one_does_not() {
    let right = -2.5 * 0.7f64.cos();
    let agreement = slope_of_a_pendulum(right, 1.0).unwrap();
    // Differences of the fourth order at steps of 1e-3, with rounding of some 1e-13.
    assert!(agreement.error < 1e-9 && agreement.not_compared.is_empty(), "{agreement:?}");
    for (by_x, by_u) in [(right, 0.0), (right * 1.001, 1.0), (0.0, 1.0), (right, f64::NAN)] {
        match slope_of_a_pendulum(by_x, by_u) {
            Err(VerifyError::Disagreement(found)) => {
                assert_eq!(found.quantity, "the derivative of the rate of x'");
                assert!((found.second - (2.0 * right + 3.0)).abs() < 1e-9, "{found:?}");
            }
            other => panic!("{by_x}, {by_u}: {other:?}"),
        }
    }
}

/// A ball on a table with a counter: v⁺ = −e v⁻ − n, n⁺ = n + 1.
fn bounce(after: [f64; 3]) -> Result<Agreement, VerifyError> {
    let model = model(
        "[parameters]\ne = 0.8\n[coordinates]\nz = 1\n[lagrangian]\nkinetic = \"z'^2/2\"\npotential = \"z\"\n[states]\n\
         n = { start = 2, rate = \"0\" }\n[events.bounce]\nwhen = \"z\"\ndirection = \"falling\"\nreset = { \"z'\" = \"-e*z' - n\", n = \
         \"n + 1\" }\n",
    );
    let graph = Graph::new();
    let assembly = model.assemble(&graph).unwrap();
    let flow = Flow::new(&model, &assembly, Variables::QuasiVelocities).unwrap();
    let jump = Jump { event: "bounce", t: 0.5, before: &[0.0, -1.5, 2.0], after: &after };
    Second::new(&model, &assembly).unwrap().reset_agrees(&model, &flow, &jump)
}

#[test]
fn a_reset_is_that_of_the_text() {
    // −0.8 · −1.5 − 2, rounded.
    assert!(bounce([0.0, -0.8, 3.0]).unwrap().error < 1e-15);
    for (wrong, quantity) in [([0.0, 1.2, 3.0], "z'"), ([0.0, -0.8, 2.0], "n"), ([0.1, -0.8, 3.0], "z")] {
        match bounce(wrong) {
            Err(VerifyError::Disagreement(found)) => {
                assert_eq!(
                    (found.form.as_str(), found.quantity.as_str()),
                    ("after the event bounce", quantity)
                );
            }
            other => panic!("{wrong:?}: {other:?}"),
        }
    }
}

/// A bead on a circle that turns back, with its constraint in any units: (x, y)·(u, v) = 0 after the reset.
fn turn(factor: f64, after: [f64; 4]) -> Result<Agreement, VerifyError> {
    let model = model(&format!(
        "[coordinates]\nx = 0.6\ny = -0.8\n[quasi_velocities]\n\"x'\" = 0.8\n\"y'\" = 0.6\n[constraints]\nrod = \"{factor:e}*(x^2 + y^2 - \
         1)\"\n[lagrangian]\nkinetic = \"(x'^2 + y'^2)/2\"\n[events.wall]\nwhen = \"x - 0.6\"\nreset = {{ \"x'\" = \"-x'/2\" }}\n"
    ));
    let graph = Graph::new();
    let assembly = model.assemble(&graph).unwrap();
    let flow = Flow::new(&model, &assembly, Variables::QuasiVelocities).unwrap();
    let jump = Jump { event: "wall", t: 0.0, before: &[0.6, -0.8, 0.8, 0.6], after: &after };
    Second::new(&model, &assembly).unwrap().reset_agrees(&model, &flow, &jump)
}

#[test]
fn a_reset_under_a_constraint_is_compared_in_its_units() {
    for factor in [1e-12, 1.0, 1e12] {
        // Off by some roundings, and stopped up to these.
        for after in [[0.6, -0.8, -0.4, -0.3 + 1e-15], [0.6, -0.8, 1e-17, 3e-17]] {
            assert!(turn(factor, after).is_ok(), "{factor}, {after:?}: {:?}", turn(factor, after));
        }
        match turn(factor, [0.6, -0.8, -0.4, 0.6]) {
            Err(VerifyError::Disagreement(found)) => assert_eq!(found.quantity, "the constraint rod"),
            other => panic!("{factor}: {other:?}"),
        }
    }
}

/// Slopes of the size of the smallest numbers are 0 but for digits that these do not have.
#[test]
fn what_is_below_the_normal_numbers_is_no_difference() {
    let model = model("[coordinates]\nx = 0\n[lagrangian]\nkinetic = \"x'^2/2\"\npotential = \"x^3/3\"\n");
    let graph = Graph::new();
    let assembly = model.assemble(&graph).unwrap();
    let flow = Flow::new(&model, &assembly, Variables::QuasiVelocities).unwrap();
    let second = Second::new(&model, &assembly).unwrap();
    let slope = |rate: f64| Slope {
        name: "the derivative".to_owned(),
        state: vec![3e-320, 0.0],
        rates: vec![("x'".to_owned(), rate)],
        ..Slope::default()
    };
    let agrees = |rate| second.slope_agrees((&model, &assembly), &flow, (0.0, &[3e-320, 0.0]), &slope(rate));
    assert!(agrees(2.3e-322).is_ok(), "{:?}", agrees(2.3e-322));
    assert!(matches!(agrees(1e-200), Err(VerifyError::Disagreement(_))));
}

/// A rod as long as the distance of two joints leaves the link free where the arm lies on the line of both: there, the
/// velocity of the arm, which is the independent one, determines that of the link by a quotient of rounding errors.
#[test]
fn one_state_where_an_independent_velocity_fails_is_not_the_verdict() {
    let linkage = r#"
[coordinates]
arm = 0.5
link = 0.5
[bodies.arm]
joint = { kind = "revolute", axis = [0, 0, 1] }
mass = 1.0
inertia = [0.1, 0.1, 0.1]
[bodies.link]
joint = { kind = "revolute", axis = [0, 0, 1], at = [1, 0, 0] }
mass = 1.0
inertia = [0.1, 0.1, 0.1]
[loops.pin]
bodies = ["arm", "link"]
kind = "rod"
at = [[1, 0, 0], [1, 0, 0]]
length = 1.0
"#;
    let model = model(linkage);
    for seed in 0..40 {
        let options = Options { states: 1, seed, ..Options::default() };
        assert!(verified(&model, &options).unwrap().states >= 1);
    }
}

/// Eleven velocities, which take two numbers of eight lanes: each derivative is that along one velocity alone.
#[test]
fn derivatives_along_many_velocities_are_those_along_each() {
    let names: Vec<String> = (0..11).map(|i| format!("q{i}")).collect();
    let coordinates: String = names.iter().map(|q| format!("{q} = 0.4\n")).collect();
    let along: Vec<String> = names.iter().enumerate().map(|(i, q)| format!("{}*sin({q})", i + 1)).collect();
    let kinetic: Vec<String> = names.iter().map(|q| format!("{q}'^2")).collect();
    let text = format!(
        "[coordinates]\n{coordinates}[constraints]\nheight = \"{} - 66*sin(0.4)\"\n\
         slide = \"q10'*cos(q0) - q3'*q8 + q2'\"\n[lagrangian]\nkinetic = \"({})/2\"\n",
        along.join(" + "),
        kinetic.join(" + ")
    );
    let (graph, model) = (Graph::new(), model(&text));
    let second = Second::new(&model, &model.assemble(&graph).unwrap()).unwrap();
    let (derivation, at, exact) = (second.derivation(), second.start(), Rounding::none());
    let which: Vec<usize> = (0..2).collect();
    let matrix = derivation.constraint_matrix(&which, at, &exact).unwrap();
    for s in 0..11 {
        let column = derivation.constraint_rates(&which, at, &at.along_velocity(s), &exact).unwrap();
        assert_near(&matrix.iter().map(|row| row[s]).collect::<Vec<f64>>(), &column);
    }
}

/// 1 − cos φ is known to a part in 1e8 where φ = 1e-4, and each repetition with deliberate rounding errors shows that: 1 is a
/// number that no operation has rounded.
#[test]
fn exact_operations_do_not_hide_what_a_difference_has_lost() {
    let text = r#"
[coordinates]
"φ" = 1e-4
[lagrangian]
kinetic = "φ'^2/2"
[outputs]
lost = "1 - cos(φ)"
"#;
    let (graph, model) = (Graph::new(), model(text));
    let second = Second::new(&model, &model.assemble(&graph).unwrap()).unwrap();
    let derivation = second.derivation();
    let lost = |rounding: &Rounding| {
        derivation.still(second.start(), rounding).value(&derivation.text.observed[0].1).unwrap()
    };
    for seed in 1..=32 {
        let moved = lost(&Rounding::made(seed)) - lost(&Rounding::none());
        assert!(moved.abs() > 1e-17, "{seed}: {moved}");
    }
}
