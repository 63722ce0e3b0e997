//! Estimates of global errors of motions that are known to sixteen digits. (Those of the built-in models are a claim of the program
//! `models`.)

use pc_mech::Graph;
use pc_model::document::AbsoluteTolerance;
use pc_model::{Document, Flow, Model, Source, Variables};
use pc_solve::{ErrorEstimate, Method, Options, Solve};

use crate::estimated::assert_estimated;

/// A motion from t = 0 whose end is known: in closed form, or from an extrapolated integration in arithmetic of 36 digits, rounded once.
struct Known {
    text: String,
    t_end: f64,
    end: Vec<(&'static str, f64)>,
}

/// The methods and tolerances of each.
const RUNS: [(Method, f64); 9] = [
    (Method::Auto, 1e-6),
    (Method::Auto, 1e-9),
    (Method::Auto, 1e-12),
    (Method::Adams, 1e-6),
    (Method::Adams, 1e-9),
    (Method::Adams, 1e-12),
    (Method::Taylor, 1e-6),
    (Method::Taylor, 1e-9),
    (Method::Taylor, 1e-12),
];

impl Known {
    fn new<const N: usize>(text: &str, t_end: f64, end: [(&'static str, f64); N]) -> Known {
        Known { text: text.to_owned(), t_end, end: end.to_vec() }
    }

    /// Every method and tolerance has estimates that are right.
    #[track_caller]
    fn assert_estimated(&self) {
        self.assert_estimated_by(&RUNS);
    }

    #[track_caller]
    fn assert_estimated_by(&self, runs: &[(Method, f64)]) {
        let model = Model::new(Document::parse(Source::new("known.toml", self.text.as_str())).unwrap());
        let graph = Graph::new();
        let assembly = model.assemble(&graph).unwrap();
        for &(method, rtol) in runs {
            let flow = Flow::new(&model, &assembly, Variables::QuasiVelocities).unwrap();
            self.assert_right(flow, method, rtol);
        }
    }

    #[track_caller]
    fn assert_right(&self, mut flow: Flow, method: Method, rtol: f64) {
        let (times, start) = ([self.t_end], flow.start.clone());
        let atol = flow.absolute_tolerances(&AbsoluteTolerance::default(), (0.0, self.t_end), rtol);
        let options = Options::new(method).relative_tolerance(rtol).absolute_tolerance(atol);
        let (field, events) = (flow.motion.clone(), flow.events.clone());
        let solve = Solve::new(&mut flow.motion, 0.0, &start).method(&options).events(&mut flow.events);
        let motion = solve.run(&times).unwrap();
        let estimate = ErrorEstimate::of(&motion, (field, 0.0, &start), events, &times, &options);
        assert_eq!(estimate.len(), 1, "{method} {rtol:e}: {:?}", estimate.failure());
        let errors = estimate.errors(&motion, 0);
        for (name, expected) in &self.end {
            let i = flow.motion.names().iter().position(|known| known == name).unwrap();
            let by = format!("{name} by {method} at {rtol:e} of\n{}", self.text);
            assert_estimated(&by, motion.trajectory.state(0)[i], *expected, errors[i]);
        }
    }
}

#[test]
fn of_oscillators() {
    let (sin, cos) = 100f64.sin_cos();
    let harmonic = "[coordinates]\nx = 1.0\n[lagrangian]\nkinetic = \"x'^2/2\"\npotential = \"x^2/2\"\n";
    Known::new(harmonic, 100.0, [("x", cos), ("x'", -sin)]).assert_estimated();
    // x = (t/2) sin t
    let (sin, cos) = 50f64.sin_cos();
    let resonant = format!("{harmonic}[forces]\nx = \"cos(t)\"\n").replace("x = 1.0", "x = 0.0");
    Known::new(&resonant, 50.0, [("x", 25.0 * sin), ("x'", sin / 2.0 + 25.0 * cos)]).assert_estimated();
    let duffing = "[coordinates]\nx = 1.0\n[lagrangian]\nkinetic = \"x'^2/2\"\npotential = \"x^4/4 - x^2/2\"\n\
                   [forces]\nx = \"0.3*cos(1.2*t) - 0.1*x'\"\n";
    Known::new(duffing, 40.0, DUFFING).assert_estimated();
}

/// φ̈ = −sin φ from rest at 2: φ = 2 asin(k sn(K − t)), k = sin 1.
#[test]
fn of_pendulums() {
    let (angle, rate) = (1.995585828898159f64, 0.08964190620764684);
    let angular = "[coordinates]\n\"φ\" = 2.0\n[lagrangian]\nkinetic = \"φ'^2/2\"\npotential = \"-cos(φ)\"\n";
    Known::new(angular, 50.0, [("φ", angle), ("φ'", rate)]).assert_estimated();
    let (sin, cos) = angle.sin_cos();
    let cartesian = "[coordinates]\nx = \"sin(2)\"\ny = \"-cos(2)\"\n[constraints]\nrod = \"x^2 + y^2 - 1\"\n\
                     [lagrangian]\nkinetic = \"(x'^2 + y'^2)/2\"\npotential = \"y\"\n";
    // Its multiplier is solved for in numbers, and it has no series.
    Known::new(cartesian, 50.0, [("x", sin), ("y", -cos)]).assert_estimated_by(&RUNS[..6]);
    let double = "[coordinates]\na = 2.0\nb = 1.0\n[lagrangian]\n\
                  kinetic = \"a'^2 + b'^2/2 + cos(a - b)*a'*b'\"\npotential = \"-9.81*(2*cos(a) + cos(b))\"\n";
    let end = [
        ("a", 0.6034833127568419),
        ("b", -3.2951570015119245),
        ("a'", -2.7847633034129995),
        ("b'", -4.714120062135656),
    ];
    Known::new(double, 8.0, end).assert_estimated();
}

/// M = E − e sin E
#[test]
fn of_planets() {
    let t = 36.0f64;
    for e in [0.0, 0.5, 0.9f64] {
        let mut anomaly = t;
        for _ in 0..100 {
            anomaly -= (anomaly - e * anomaly.sin() - t) / (1.0 - e * anomaly.cos());
        }
        let ((sin, cos), root) = (anomaly.sin_cos(), (1.0 - e * e).sqrt());
        let rate = 1.0 / (1.0 - e * cos);
        let text = format!(
            "[parameters]\ne = {e:?}\n[coordinates]\nx = \"1 - e\"\ny = 0.0\n[quasi_velocities]\n\"x'\" = 0.0\n\
             \"y'\" = \"sqrt((1 + e)/(1 - e))\"\n[lagrangian]\nkinetic = \"(x'^2 + y'^2)/2\"\n\
             potential = \"-1/sqrt(x^2 + y^2)\"\n"
        );
        let end = [("x", cos - e), ("y", root * sin), ("x'", -sin * rate), ("y'", root * cos * rate)];
        Known::new(&text, t, end).assert_estimated();
    }
}

#[test]
fn of_chaotic_motions() {
    let henon = |x: f64, y: f64, u: f64, v: f64| {
        format!(
            "[coordinates]\nx = {x:?}\ny = {y:?}\n[quasi_velocities]\n\"x'\" = {u:?}\n\"y'\" = {v:?}\n\
             [lagrangian]\nkinetic = \"(x'^2 + y'^2)/2\"\npotential = \"(x^2 + y^2)/2 + x^2*y - y^3/3\"\n"
        )
    };
    let end = [
        ("x", 0.13511526237169813),
        ("y", -0.32539554890280115),
        ("x'", -0.1143766773800361),
        ("y'", -0.17613847703087895),
    ];
    Known::new(&henon(0.0, 0.1, 0.4, -0.1), 60.0, end).assert_estimated();
    let end = [
        ("x", 0.5409645741848149),
        ("y", -0.18510436628797494),
        ("x'", 0.1797464407610337),
        ("y'", 0.14881384682613585),
    ];
    Known::new(&henon(0.0, -0.15, 0.5, 0.05), 60.0, end).assert_estimated();
    let lorenz = "[coordinates]\nq = 0.0\n[states]\nx = { start = 1, rate = \"10*(y - x)\" }\n\
                  y = { start = 1, rate = \"x*(28 - z) - y\" }\nz = { start = 1, rate = \"x*y - 8*z/3\" }\n\
                  [lagrangian]\nkinetic = \"q'^2/2\"\n";
    let end = [("x", 13.793199595128618), ("y", 12.951803936189899), ("z", 34.901608681135144)];
    Known::new(lorenz, 20.0, end).assert_estimated();
    let end = [("x", -4.902687541134646), ("y", -3.7438729218029194), ("z", 24.690858102790557)];
    Known::new(lorenz, 10.0, end).assert_estimated();
}

#[test]
fn of_limit_cycles() {
    let brusselator = "[coordinates]\nq = 0.0\n[states]\nx = { start = 1.5, rate = \"1 + x^2*y - 4*x\" }\n\
                       y = { start = 3, rate = \"3*x - x^2*y\" }\n[lagrangian]\nkinetic = \"q'^2/2\"\n";
    Known::new(brusselator, 20.0, [("x", 0.49863707126834783), ("y", 4.596780349452011)]).assert_estimated();
    let van_der_pol = |mu: f64| {
        format!(
            "[coordinates]\nx = 2.0\n[lagrangian]\nkinetic = \"x'^2/2\"\npotential = \"x^2/2\"\n\
             [forces]\nx = \"{mu:?}*(1 - x^2)*x'\"\n"
        )
    };
    Known::new(&van_der_pol(2.0), 30.0, [("x", 1.462732704655943), ("x'", 3.1540011837656605)])
        .assert_estimated();
    let stiff = [
        (Method::Auto, 1e-6),
        (Method::Auto, 1e-9),
        (Method::Auto, 1e-12),
        (Method::Bdf, 1e-6),
        (Method::Bdf, 1e-9),
        (Method::Bdf, 1e-12),
    ];
    Known::new(&van_der_pol(100.0), 200.0, STIFF).assert_estimated_by(&stiff);
}

/// A ball that bounces, and an oscillator with dry friction.
#[test]
fn of_motions_over_events() {
    // It falls from 1; flight n takes 2 t₀ eⁿ.
    let (g, e, t) = (9.81f64, 0.8, 3.0);
    let ball = "[coordinates]\ny = 1.0\n[lagrangian]\nkinetic = \"y'^2/2\"\npotential = \"9.81*y\"\n\
                [events.bounce]\nwhen = \"y\"\ndirection = \"falling\"\nreset = { \"y'\" = \"-0.8*y'\" }\n";
    let first = (2.0 / g).sqrt();
    let (mut landed, mut speed) = (first, e * g * first);
    while landed + 2.0 * speed / g < t {
        (landed, speed) = (landed + 2.0 * speed / g, e * speed);
    }
    let s = t - landed;
    Known::new(ball, t, [("y", speed * s - g * s * s / 2.0), ("y'", speed - g * s)]).assert_estimated();
    // In each half turn about ±μ the amplitude shrinks by 2 μ: x = 5 − 2 μ n − μ after n of them.
    let (friction, half_turns, rest) = (0.3f64, 4.0, 1.0f64);
    let text = format!(
        "[coordinates]\nx = 5.0\n[lagrangian]\nkinetic = \"x'^2/2\"\npotential = \"x^2/2\"\n\
         [forces]\nx = \"-{friction:?}*sign(x')\"\n"
    );
    let amplitude = 5.0 - friction * (2.0 * half_turns + 1.0);
    let end = [("x", amplitude * rest.cos() + friction), ("x'", -amplitude * rest.sin())];
    Known::new(&text, half_turns * std::f64::consts::PI + rest, end).assert_estimated();
}

const DUFFING: [(&str, f64); 2] = [("x", -0.9629186996658649), ("x'", -0.3326329929206856)];
const STIFF: [(&str, f64); 2] = [("x", 1.7185872080192406), ("x'", -0.008796821912416704)];
