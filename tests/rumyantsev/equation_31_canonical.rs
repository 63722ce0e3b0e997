//! Nonholonomic constraints in canonical variables, equation (31): with H of all momenta,
//!
//!   ∂H/∂y_α = 0,   ẋ_i = b_is ∂H/∂y_s + b_i0,   s ≤ l < α ≤ k,
//!
//! and ẏ_s = (c_rs^m ∂H/∂y_r + c_0s^m) y_m − X_s H + Q_s with m ≤ k. The y_α are not zero: they follow from the first of these.
//! Each model comes from its text; H has terms of degree 2, 1 and 0 in y.

use pc_algebra::{affine, inverse};
use pc_mech::{Canonical, Expr, Matrix};
use pc_model::{Document, Model, Source};
use pc_nonholo::Constrained;

use crate::{along, assert_identities};

/// A charge in a magnetic field and a potential on ż = y ẋ: L has terms linear in the velocities.
const CHARGE: &str = r#"
    [parameters]
    m = 2.0
    B = 0.7
    k = 1.3
    [coordinates]
    x = 0.1
    y = 0.3
    z = 0.2
    [quasi_velocities]
    "x'" = 1.0
    "y'" = 0.5
    "z'" = 0.3
    [lagrangian]
    kinetic = "m*(x'^2 + y'^2 + z'^2)/2 + B*(x*y' - y*x' + x*z')"
    potential = "k*(x^2*y + z^2)/2"
    [constraints]
    knife = "z' - y*x'"
"#;

/// A sleigh on ice that drifts in the direction of x with the speed c t: an affine constraint that depends on time.
const DRIFTING_SLEIGH: &str = r#"
    [parameters]
    m = 2.0
    J = 0.5
    a = 0.3
    c = 0.4
    [coordinates]
    X = 0.0
    Y = 0.0
    "φ" = 0.2
    [quasi_velocities]
    v = { is = "X'*cos(φ) + Y'*sin(φ)", start = 1.0 }
    u = { is = "Y'*cos(φ) - X'*sin(φ) + c*t*sin(φ)", start = 0.0 }
    "ω" = { is = "φ'", start = 0.7 }
    [constraints]
    blade = "u"
    [lagrangian]
    kinetic = "m*((X'- a*φ'*sin(φ))^2 + (Y' + a*φ'*cos(φ))^2)/2 + J*φ'^2/2"
    potential = "m*X^2"
    [forces]
    Y = "-3*Y'"
"#;

/// The model in the frame in which its constraints are η_α = 0.
fn with_constrained(text: &str, then: impl FnOnce(&Constrained<'_>)) {
    let model = Model::new(Document::parse(Source::new("model.toml", text)).unwrap());
    let graph = model.graph();
    let assembly = model.assemble(&graph).unwrap();
    then(&assembly.constraints.constrained(&assembly.at_start()).unwrap().unwrap());
}

/// H of all momenta, with the conditions ∂H/∂y_α = 0 solved for the y_α.
struct Held<'a, 'g> {
    constrained: &'a Constrained<'g>,
    canonical: Canonical<'g>,
    /// Each y_α as a function of (t, x, y_1..y_l).
    dependent: Vec<(Expr<'g>, Expr<'g>)>,
}

impl<'a, 'g> Held<'a, 'g> {
    fn new(constrained: &'a Constrained<'g>) -> Held<'a, 'g> {
        let canonical = constrained.system().canonical().unwrap();
        let (graph, l) = (constrained.system().graph(), constrained.equations().right_hand_side().len());
        let dependent = &canonical.momenta()[l..];
        let conditions = graph.gradient(canonical.hamiltonian(), dependent);
        let (rows, rest): (Vec<_>, Vec<_>) =
            conditions.iter().map(|&condition| affine(graph, condition, dependent).unwrap()).unzip();
        let size = dependent.len();
        let inverse = inverse(graph, &Matrix::from_fn(size, size, |a, b| rows[a][b])).unwrap();
        let value = |a: usize| -graph.dot((0..size).map(|b| inverse[(a, b)]), rest.iter().copied());
        let dependent = dependent.iter().enumerate().map(|(a, &y)| (y, value(a))).collect();
        Held { constrained, canonical, dependent }
    }

    /// The number l of free quasi-velocities.
    fn free(&self) -> usize {
        self.constrained.equations().right_hand_side().len()
    }

    /// Functions of (t, x, y) where ∂H/∂y_α = 0, at y_s = (∂L/∂η_s)_0: functions of (t, x, η_1..η_l).
    fn there(&self, functions: &[Expr<'g>]) -> Vec<Expr<'g>> {
        let graph = self.constrained.system().graph();
        let of_free = graph.substitute(functions, &self.dependent);
        let free = self.canonical.momenta()[..self.free()].iter().copied();
        graph.substitute(&of_free, &free.zip(self.momenta()).collect::<Vec<_>>())
    }

    /// (∂L/∂η_m)_0, m = 1..k.
    fn momenta(&self) -> Vec<Expr<'g>> {
        let system = self.constrained.system();
        let zeros: Vec<_> = self.constrained.vanishing().iter().map(|&eta| (eta, Expr::ZERO)).collect();
        system.graph().substitute(&system.momenta(), &zeros)
    }
}

const MODELS: [&str; 2] = [CHARGE, DRIFTING_SLEIGH];

/// The η_α vanish where the y_α have the values (∂L/∂η_α)_0, which are not zero, and only there.
#[test]
fn equation_31_determines_the_dependent_momenta() {
    for text in MODELS {
        with_constrained(text, |constrained| {
            let held = Held::new(constrained);
            let (graph, l) = (constrained.system().graph(), held.free());
            let (h, y) = (held.canonical.hamiltonian(), held.canonical.momenta());
            let degrees: Vec<u32> =
                graph.polynomial(h, y).unwrap().terms.iter().map(|(powers, _)| powers.iter().sum()).collect();
            assert!((0..=2).all(|degree| degrees.contains(&degree)), "{degrees:?}");

            let dependent: Vec<Expr<'_>> = held.dependent.iter().map(|&(_, value)| value).collect();
            let expected = held.momenta()[l..].to_vec();
            assert!(expected.iter().all(|y| !y.is_zero()));
            assert_identities("y_α", held.there(&dependent).into_iter().zip(expected));
            let eta = held.there(&graph.gradient(h, y));
            let (free, vanishing) = (constrained.equations().system().quasi_velocities(), &eta[l..]);
            assert_identities("∂H/∂y_s", eta.iter().copied().zip(free[..l].iter().copied()));
            assert_identities("∂H/∂y_α", vanishing.iter().map(|&rate| (rate, Expr::ZERO)));
        });
    }
}

/// ẋ_i = b_is ∂H/∂y_s + b_i0, s = 1..l, are the velocities (29).
#[test]
fn equation_31_gives_the_velocities() {
    for text in MODELS {
        with_constrained(text, |constrained| {
            let held = Held::new(constrained);
            let (graph, frame) = (constrained.system().graph(), constrained.system().frame());
            let eta = graph.gradient(held.canonical.hamiltonian(), held.canonical.momenta());
            let velocity = |i: usize| {
                let b = (0..held.free()).map(|s| frame.b()[(i, s)]);
                graph.sum([graph.dot(b, eta.iter().copied()), frame.b0()[i]])
            };
            let velocities: Vec<Expr<'_>> = (0..frame.coordinates().len()).map(velocity).collect();
            let expected = constrained.equations().velocities().iter().copied();
            assert_identities("ẋ", held.there(&velocities).into_iter().zip(expected));
        });
    }
}

/// ẏ_s = (c_rs^m ∂H/∂y_r + c_0s^m) y_m − X_s H + Q_s, with the y_α of (31), is the motion (30).
#[test]
fn equation_31_leads_to_the_motion() {
    for text in MODELS {
        with_constrained(text, |constrained| {
            let held = Held::new(constrained);
            let (system, graph) = (constrained.system(), constrained.system().graph());
            let (h, y) = (held.canonical.hamiltonian(), held.canonical.momenta());
            let eta = graph.gradient(h, y);
            let gyroscopic = system.structure().gyroscopic(graph, &eta, y);
            let of_h = system.frame().contract(&graph.gradient(h, system.frame().coordinates()));
            let known: Vec<_> = system.quasi_velocities().iter().copied().zip(eta).collect();
            let forces = graph.substitute(system.forces(), &known);
            let rates: Vec<Expr<'_>> =
                (0..held.free()).map(|s| graph.sum([gyroscopic[s], -of_h[s], forces[s]])).collect();
            let flow = along(constrained.equations());
            let expected = graph.directional(&held.momenta()[..held.free()], &flow);
            assert_identities("ẏ", held.there(&rates).into_iter().zip(expected));
        });
    }
}
