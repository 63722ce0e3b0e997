//! Motions by Jacobi's theorem, on all coordinates and on orbits of intransitive groups, against closed forms and power series.

use pc_analysis::{
    AnalysisError, BranchEnd, CompleteIntegral, Orbit, ProposedAction, SeparatedAction, hamilton_jacobi,
};
use pc_mech::{Canonical, Expr, Graph, Identity, LieAlgebra, Neighbourhood, System};

/// The largest difference from the motion of (10), (11), which rounding errors leave.
const ROUNDING: f64 = 1e-12;

/// A top in γ, the upward vertical in body axes, with equal moments A and a potential of γ3.
fn top<'g>(graph: &'g Graph, potential: impl Fn(Expr<'g>) -> Expr<'g>) -> System<'g> {
    let a = graph.symbol("A");
    System::builder(graph)
        .parameter(a, 2.0)
        .coordinates(["γ1", "γ2", "γ3"])
        .quasi_velocities(["ω1", "ω2", "ω3"])
        .kinematics(|_, g, w| {
            [g[1] * w[2] - g[2] * w[1], g[2] * w[0] - g[0] * w[2], g[0] * w[1] - g[1] * w[0]]
        })
        .algebra(&LieAlgebra::so3())
        .lagrangian(|_, g, w| a * (w[0].square() + w[1].square() + w[2].square()) / 2.0 - potential(g[2]))
        .build()
        .unwrap()
}

fn sphere<'g>(graph: &'g Graph, top: &System<'g>) -> Orbit<'g> {
    let [x, y, z] = graph.symbols(["γ1", "γ2", "γ3"]);
    let functions = [x * y, z, x.square() + y.square() + z.square()];
    Orbit::through(top, &functions, &[(x, 0.6), (y, 0.0), (z, 0.8)]).unwrap()
}

/// S = A ∠(γ, n)²/(2t): the action of the motion from n at t = 0 along a great circle.
fn of_great_circles(graph: &Graph) -> Expr<'_> {
    let [a, t, x, y, z, u, v] = graph.symbols(["A", "t", "γ1", "γ2", "γ3", "u", "v"]);
    let cosine = x * u.sin() * v.cos() + y * u.sin() * v.sin() + z * u.cos();
    a * cosine.acos().square() / (2.0 * t)
}

#[test]
fn a_spherical_top_turns_along_great_circles() {
    let graph = Graph::new();
    let top = top(&graph, |_| Expr::ZERO);
    let (canonical, sphere) = (top.canonical().unwrap(), sphere(&graph, &top));
    assert_eq!((sphere.dimension(), sphere.invariants()[0].1), (2, 1.0));
    let action = of_great_circles(&graph);
    assert!(!hamilton_jacobi(&canonical, action).unwrap().is_zero(), "off the unit sphere it is none");
    let integral = CompleteIntegral::on_orbit(&canonical, action, &["u", "v"], &sphere).unwrap();
    // From n = (sin u, 0, cos u) with γ̇ = c e_2: γ = n cos ct + e_2 sin ct, ω = γ̇ × γ.
    let (u, c) = (0.3f64, 0.9f64);
    let state = |t: f64| {
        let (cosine, sine) = ((c * t).cos(), (c * t).sin());
        let gamma = [u.sin() * cosine, sine, u.cos() * cosine];
        let omega = [u.cos() * c, 0.0, -u.sin() * c];
        (gamma, omega.map(|w| 2.0 * w))
    };
    let (gamma, momentum) = state(0.4);
    let rate = [-u.sin() * (c * 0.4f64).sin() * c, (c * 0.4f64).cos() * c, -u.cos() * (c * 0.4f64).sin() * c];
    let omega = momentum.map(|y| y / 2.0);
    let turned = [
        gamma[1] * omega[2] - gamma[2] * omega[1],
        gamma[2] * omega[0] - gamma[0] * omega[2],
        gamma[0] * omega[1] - gamma[1] * omega[0],
    ];
    assert!(turned.iter().zip(rate).all(|(a, b)| (a - b).abs() < 1e-15), "γ̇ = γ × ω");

    let mut motion = integral.motion_through(0.4, (&gamma, &momentum), &[0.4, 0.2]).unwrap();
    assert!((motion.alpha()[0] - u).abs() < ROUNDING && motion.alpha()[1].abs() < ROUNDING, "{motion:?}");
    for t in [0.8, 1.7, 3.0] {
        let (gamma, momentum) = state(t);
        let found = motion.state(t).unwrap();
        let expected = [gamma, momentum].concat();
        assert!(found.iter().zip(&expected).all(|(a, b)| (a - b).abs() < ROUNDING), "{found:?} {expected:?}");
    }
    let agreement = motion.agreement(&canonical, 3.0).unwrap();
    assert!(agreement.end.is_none() && agreement.deviation.unwrap() < ROUNDING, "{agreement:?}");
}

/// y_s = X_s S has γ_s y_s = 0; a motion whose area integral is not zero is none of S.
#[test]
fn an_action_of_the_vertical_has_motions_without_area_only() {
    let graph = Graph::new();
    let top = top(&graph, |_| Expr::ZERO);
    let (canonical, sphere) = (top.canonical().unwrap(), sphere(&graph, &top));
    let relations = Orbit::relations(&top);
    assert_eq!(relations.iter().map(Expr::to_string).collect::<Vec<_>>(), ["γ1*p_ω1 + γ2*p_ω2 + γ3*p_ω3"]);
    let action = of_great_circles(&graph);
    let integral = CompleteIntegral::on_orbit(&canonical, action, &["u", "v"], &sphere).unwrap();
    let known: Vec<_> = canonical.momenta().iter().copied().zip(integral.momenta().iter().copied()).collect();
    assert!(graph.substitute(&relations, &known)[0].is_zero());
    let spinning =
        integral.motion_through(0.5, (&[0.6, 0.0, 0.8], &[0.0, 1.0, 1.0]), &[0.3, 0.2]).unwrap_err();
    assert!(matches!(spinning, AnalysisError::NoConstants { .. }), "{spinning}");
}

/// By H–J on the sphere, y_s = X_s S satisfies (10) along (11) as identities, with the third coordinate solved from |γ| = 1.
#[test]
fn the_momenta_of_an_action_satisfy_the_canonical_equations_on_the_orbit() {
    let graph = Graph::new();
    let top = top(&graph, |_| Expr::ZERO);
    let (canonical, sphere) = (top.canonical().unwrap(), sphere(&graph, &top));
    let action = of_great_circles(&graph);
    let integral = CompleteIntegral::on_orbit(&canonical, action, &["u", "v"], &sphere).unwrap();
    let known: Vec<_> = canonical.momenta().iter().copied().zip(integral.momenta().iter().copied()).collect();
    let velocities = graph.substitute(canonical.velocities(), &known);
    let flow: Vec<_> = top.frame().coordinates().iter().copied().zip(velocities).collect();
    let flow = [flow, vec![(top.frame().time(), Expr::ONE)]].concat();
    let rates = graph.directional(integral.momenta(), &flow);
    let expected = graph.substitute(canonical.right_hand_side(), &known);
    let [t, x, y, z, u, v] = graph.symbols(["t", "γ1", "γ2", "γ3", "u", "v"]);
    let near = Neighbourhood { centre: vec![(t, 1.0), (x, 0.6), (y, 0.0), (z, 0.8), (u, 0.3), (v, 0.5)] };
    for (rate, expected) in rates.into_iter().zip(expected) {
        let rest = sphere.restricted(&graph, &[rate, -expected]);
        assert!(near.residual(&graph, &[rest]) < 1e-13);
    }
}

/// A ball on a sphere in the potential k/(2 γ3²), by separation in its angles, written in γ.
#[test]
fn a_separated_action_in_the_vertical_is_proved_on_the_sphere() {
    let graph = Graph::new();
    let [k, t, x, y, z, e, l] = graph.symbols(["k", "t", "γ1", "γ2", "γ3", "E", "l"]);
    let a = graph.symbol("A");
    let ball = System::builder(&graph)
        .parameter(a, 2.0)
        .parameter(k, 0.5)
        .coordinates(["γ1", "γ2", "γ3"])
        .quasi_velocities(["ω1", "ω2", "ω3"])
        .kinematics(|_, g, w| {
            [g[1] * w[2] - g[2] * w[1], g[2] * w[0] - g[0] * w[2], g[0] * w[1] - g[1] * w[0]]
        })
        .algebra(&LieAlgebra::so3())
        .lagrangian(|_, g, w| {
            a * (w[0].square() + w[1].square() + w[2].square()) / 2.0 - k / (2.0 * g[2].square())
        })
        .build()
        .unwrap();
    let canonical: Canonical<'_> = ball.canonical().unwrap();
    let (u, w) = (x.square() + y.square(), z.square());
    let (b, c) = (2.0 * a * e - a * k + l.square(), 2.0 * a * e + a * k - l.square());
    let q = (b * u - 2.0 * a * e * u.square() - l.square()).sqrt();
    let (outer, inner) = ((2.0 * a * e).sqrt(), (a * k).sqrt());
    let angles = inner * ((c * w - 2.0 * a * k) / (2.0 * inner * q)).atan()
        - outer * ((b - 4.0 * a * e * u) / (2.0 * outer * q)).atan()
        - l * ((b * u - 2.0 * l.square()) / (2.0 * l * q)).atan();
    let action = l * x.atan2(y) - e * t + angles / 2.0;
    let sphere = sphere(&graph, &ball);
    let near = Neighbourhood {
        centre: vec![(a, 2.0), (k, 0.5), (t, 0.0), (x, 0.6), (y, 0.0), (z, 0.8), (e, 2.0), (l, 0.5)],
    };
    let checked = ProposedAction::check_on(&canonical, action, &[e, l], (&sphere, &near)).unwrap();
    assert!((checked.identity, checked.rank) == (Identity::Proved, 2), "{:?}", checked.identity);
    // ω across γ, and towards the pole: p_θ > 0.
    let omega = [0.4, -0.7, -0.3];
    let momentum = omega.map(|w| 2.0 * w);
    let integral = checked.integral(&canonical).unwrap();
    let mut motion = integral.motion_through(0.0, (&[0.6, 0.0, 0.8], &momentum), &[2.0, 0.5]).unwrap();
    let energy = (0.16 + 0.49 + 0.09) + 0.25 / 0.64;
    assert!((motion.alpha()[0] - energy).abs() < ROUNDING, "{motion:?}");
    let agreement = motion.agreement(&canonical, 2.0).unwrap();
    assert!(
        agreement.end == Some(BranchEnd::TurningPoint)
            && agreement.until > 0.1
            && agreement.deviation.unwrap() < 1e-11,
        "{agreement:?}"
    );
}

/// Redundant coordinates: a point on the circle x² + y² = 1, S = a atan2(y, x) − a² t/2.
#[test]
fn a_point_on_a_circle_in_two_coordinates() {
    let graph = Graph::new();
    let [t, x, y, a] = graph.symbols(["t", "x", "y", "a"]);
    let point = System::builder(&graph)
        .coordinates(["x", "y"])
        .quasi_velocities(["ω"])
        .kinematics(|_, x, w| [-x[1] * w[0], x[0] * w[0]])
        .lagrangian(|_, _, w| w[0].square() / 2.0)
        .build()
        .unwrap();
    let canonical = point.canonical().unwrap();
    let action = a * y.atan2(x) - a.square() * t / 2.0;
    let alone = CompleteIntegral::new(&canonical, action, &["a"]).unwrap_err();
    assert_eq!(alone, AnalysisError::OrbitUnknown { found: 0, needed: 1 });
    let circle = Orbit::through(&point, &[x.square() + y.square()], &[(x, 0.6), (y, 0.8)]).unwrap();
    let integral = CompleteIntegral::on_orbit(&canonical, action, &["a"], &circle).unwrap();
    let mut motion = integral.motion_through(0.0, (&[0.6, 0.8], &[0.7]), &[1.0]).unwrap();
    let angle = 0.8f64.atan2(0.6) + 0.7 * 1.5;
    let found = motion.state(1.5).unwrap();
    let expected = [angle.cos(), angle.sin(), 0.7];
    assert!(found.iter().zip(expected).all(|(a, b)| (a - b).abs() < ROUNDING), "{found:?}");
    // Where atan2 jumps the point does not turn.
    let agreement = motion.agreement(&canonical, 10.0).unwrap();
    let half = (std::f64::consts::PI - 0.8f64.atan2(0.6)) / 0.7;
    assert!(agreement.end == Some(BranchEnd::Cut) && (agreement.until - half).abs() < 1e-6, "{agreement:?}");
}

/// Kepler's motion between two turning points, with the constants of the start; the half period is that of the third law,
/// π √(m a³/k).
#[test]
fn a_planet_until_its_turning_point() {
    let graph = Graph::new();
    let [m, k, t, r, phi, e, l] = graph.symbols(["m", "k", "t", "r", "φ", "E", "l"]);
    let planet = System::builder(&graph)
        .parameter(m, 2.0)
        .parameter(k, 3.0)
        .coordinates(["r", "φ"])
        .lagrangian(|_, x, v| m * (v[0].square() + (x[0] * v[1]).square()) / 2.0 + k / x[0])
        .build()
        .unwrap();
    let canonical = planet.canonical().unwrap();
    let (q, a) = ((2.0 * m * (e * r.square() + k * r) - l.square()).sqrt(), -2.0 * m * e);
    let action = l * phi - e * t + q + m * k / a.sqrt() * ((a * r - m * k) / (a.sqrt() * q)).atan()
        - l * ((m * k * r - l.square()) / (l * q)).atan();
    let integral = CompleteIntegral::new(&canonical, action, &["E", "l"]).unwrap();
    // Just past the nearest point, at the distance a (1 − ε) for a = 1.2, ε = 0.3.
    let (energy, momentum) = (-3.0f64 / 2.4, (2.0f64 * 3.0 * 1.2 * (1.0 - 0.09)).sqrt());
    let r0 = 0.85f64;
    let p0 = (4.0 * (energy + 3.0 / r0) - (momentum / r0).powi(2)).sqrt();
    let mut motion = integral.motion_through(0.0, (&[r0, 0.3], &[p0, momentum]), &[-1.0, 2.4]).unwrap();
    assert!((motion.alpha()[0] - energy).abs() < ROUNDING && (motion.alpha()[1] - momentum).abs() < ROUNDING);
    let agreement = motion.agreement(&canonical, 10.0).unwrap();
    assert!(
        agreement.end == Some(BranchEnd::TurningPoint) && agreement.deviation.unwrap() < 1e-11,
        "{agreement:?}"
    );
    // From r0 to the farthest point, by Kepler's equation: r = a (1 − ε cos u), t √(k/(m a³)) = u − ε sin u.
    let u = ((1.0 - r0 / 1.2) / 0.3).acos();
    let rate = (3.0f64 / (2.0 * 1.2f64.powi(3))).sqrt();
    let left = (std::f64::consts::PI - (u - 0.3 * u.sin())) / rate;
    assert!((agreement.until - left).abs() < 1e-6, "{} is {left}", agreement.until);
    let ended = motion.state(10.0).unwrap_err();
    assert!(ended.to_string().starts_with("the branch of the action ends at t = "), "{ended}");
}

/// S = (x − α)²/(2t) − t (x + α)/2 − t³/24 has no value at t = 0, where the motion starts.
#[test]
fn a_principal_function_is_taken_up_after_its_pole() {
    let graph = Graph::new();
    let [t, x, a, b] = graph.symbols(["t", "x", "α", "β"]);
    let body = System::builder(&graph)
        .coordinates(["x"])
        .lagrangian(|_, x, v| v[0].square() / 2.0 - x[0])
        .build()
        .unwrap();
    let canonical = body.canonical().unwrap();
    let action = (x - a).square() / (2.0 * t) - t * (x + a) / 2.0 - t.powi(3) / 24.0;
    let integral = CompleteIntegral::new(&canonical, action, &["α"]).unwrap();
    assert!(integral.motion_through(0.0, (&[5.0], &[3.0]), &[1.0]).is_err());
    let mut motion = integral.motion_after(&canonical, (0.0, 4.0), (&[5.0], &[3.0]), &[1.0]).unwrap();
    assert!((motion.alpha()[0] - 5.0).abs() < ROUNDING && (motion.beta()[0] + 3.0).abs() < ROUNDING);
    assert!(motion.start_time() > 0.0);
    // Through the highest point, where the velocity changes its sign: no branch ends there.
    let agreement = motion.agreement(&canonical, 8.0).unwrap();
    assert!(agreement.end.is_none() && agreement.deviation.unwrap() < ROUNDING, "{agreement:?}");
    assert_eq!(integral.positions(&canonical, &[b]).unwrap(), [a - b * t - t.square() / 2.0]);
}

/// Kepler's problem, a pendulum at its swing and one that turns over, by quadratures: Jacobi's constants are kept, and the time until
/// a turning point is that of Kepler's equation.
#[test]
fn actions_by_separation_have_constants_of_the_motion() {
    let graph = Graph::new();
    let [t, x, p] = graph.symbols(["t", "x", "p_x"]);
    let pendulum = System::builder(&graph)
        .coordinates(["x"])
        .lagrangian(|_, x, v| v[0].square() / 2.0 + x[0].cos())
        .build()
        .unwrap();
    let canonical = pendulum.canonical().unwrap();
    for (speed, turns) in [(-1.0, true), (2.5, false)] {
        let at = [(t, 0.0), (x, 0.2), (p, speed)];
        let action = SeparatedAction::of(&canonical, &at).unwrap().unwrap();
        assert_eq!(action.identity(), Identity::Proved);
        assert!((action.value() - (speed * speed / 2.0 - 0.2f64.cos())).abs() < 1e-15);
        let agreement = action.agreement(&canonical, 5.0).unwrap();
        assert_eq!(agreement.end.is_some(), turns);
        assert!(agreement.deviation.unwrap() < ROUNDING, "{agreement:?}");
    }
    // At rest, where ∂p/∂E is infinite, and with two coordinates in H, there is none.
    assert!(SeparatedAction::of(&canonical, &[(t, 0.0), (x, 0.2), (p, 0.0)]).unwrap().is_none());

    let graph = Graph::new();
    let [t, r, phi, p, l] = graph.symbols(["t", "r", "φ", "p_r", "p_φ"]);
    let planet = System::builder(&graph)
        .coordinates(["r", "φ"])
        .lagrangian(|_, x, v| (v[0].square() + (x[0] * v[1]).square()) / 2.0 + 1.0 / x[0])
        .build()
        .unwrap();
    let canonical = planet.canonical().unwrap();
    // The nearest point of the ellipse with a = 1, ε = 0.3 is passed at t = 0; at u = 1, t = u − ε sin u.
    let (u, eccentricity) = (1.0f64, 0.3f64);
    let (r0, p0) = (1.0 - eccentricity * u.cos(), eccentricity * u.sin() / (1.0 - eccentricity * u.cos()));
    let at = [(t, 0.0), (r, r0), (phi, 0.0), (p, p0), (l, (1.0 - 0.09f64).sqrt())];
    let action = SeparatedAction::of(&canonical, &at).unwrap().unwrap();
    assert!((action.value() + 0.5).abs() < 1e-15);
    let agreement = action.agreement(&canonical, 10.0).unwrap();
    let left = std::f64::consts::PI - (u - eccentricity * u.sin());
    assert!(
        (agreement.until - left).abs() < 1e-6 && agreement.deviation.unwrap() < ROUNDING,
        "{agreement:?}"
    );
}
