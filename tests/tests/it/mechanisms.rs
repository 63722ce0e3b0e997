//! Mechanisms whose quasi-velocities are defined by `is` and whose constraints are on positions, too: bicycles, squeezers,
//! four-bars, slider-cranks, bodies that roll, against the same in ordinary velocities and against independent numbers.

use std::array::from_fn;

use pc_mech::{Graph, Motion, VectorField};
use pc_model::{Document, Flow, Model, Source, Variables};
use pc_solve::{Events, Method, Options, solve};
use pc_tests::classical::{SplitMix64, arm_on_wall, arm_sample};
use pc_tests::verified::derived_twice;

const BICYCLE: &str = include_str!("../../mechanisms/whipple-bicycle.toml");
const SQUEEZER: &str = include_str!("../../mechanisms/squeezer.toml");
const CRANK_ROCKER: &str = include_str!("../../mechanisms/crank-rocker.toml");
const SLIDER_CRANK: &str = include_str!("../../mechanisms/slider-crank.toml");
const ARM: &str = include_str!("../../mechanisms/arm-on-wall.toml");
const RATTLEBACK: &str = include_str!("../../mechanisms/rattleback.toml");

fn model(text: &str) -> Model {
    derived_twice(Document::parse(Source::new("m.toml", text)).unwrap_or_else(|error| panic!("{error}")))
}

/// A motion and what a table shows of its start and end.
struct Run {
    names: Vec<String>,
    rows: Vec<Vec<f64>>,
    /// The energy at the start, and its largest change.
    energy: (f64, f64),
}

impl Run {
    /// To times spaced evenly, by a method of order up to 12.
    #[track_caller]
    fn of(model: &Model, variables: Variables, end: f64, rtol: f64) -> Run {
        let graph = Graph::new();
        let assembly = model.assemble(&graph).unwrap_or_else(|error| panic!("{error}"));
        let mut flow = Flow::new(model, &assembly, variables).unwrap_or_else(|error| panic!("{error}"));
        let times: Vec<f64> = (0..=50).map(|i| end * f64::from(i) / 50.0).collect();
        let options = Options::new(Method::Adams)
            .relative_tolerance(rtol)
            .absolute_tolerance(rtol / 100.0)
            .max_steps(1_000_000);
        let start = flow.start.clone();
        let trajectory = solve(&mut flow.motion, 0.0, &start, &times, &options).unwrap();
        let rows: Vec<Vec<f64>> = trajectory.iter().map(|(t, state)| flow.row(t, state)).collect();
        let energy =
            flow.names.len() + flow.motion.observable_names().iter().position(|n| n == "energy").unwrap();
        let change = rows.iter().fold(0.0f64, |worst, row| worst.max((row[energy] - rows[0][energy]).abs()));
        Run { energy: (rows[0][energy], change), names: flow.names.clone(), rows }
    }

    fn end(&self, name: &str) -> f64 {
        self.column(name).last().copied().unwrap()
    }

    fn column(&self, name: &str) -> Vec<f64> {
        let place = self.names.iter().position(|known| known == name).unwrap();
        self.rows.iter().map(|row| row[place]).collect()
    }

    /// The largest difference of the columns that two runs have in common.
    fn differs(&self, other: &Run) -> f64 {
        let common = self.names.iter().filter(|name| other.names.contains(name));
        let differences = common.flat_map(|name| {
            let (own, others) = (self.column(name), other.column(name));
            own.into_iter().zip(others).map(|(a, b)| (a - b).abs() / a.abs().max(1.0)).collect::<Vec<_>>()
        });
        differences.fold(0.0, f64::max)
    }
}

/// The model with its quasi-velocities replaced.
fn with_quasi_velocities(text: &str, quasi_velocities: &str) -> String {
    let start = text.find("[quasi_velocities]").unwrap();
    let end = start + 1 + text[start + 1..].find("\n[").unwrap();
    format!("{}[quasi_velocities]\n{quasi_velocities}\n{}", &text[..start], &text[end..])
}

/// The start of the bicycle in velocities of its coordinates.
const IN_VELOCITIES: &str = "\"x'\" = \"v0\"\n\"φ'\" = 0.5\n\"χ'\" = \"-v0/rR\"\n\"ξ'\" = \"-v0/rF\"";

/// Both kinds of velocities tell the same motion, and that of the rates of roll, steer and rear wheel has no others among its
/// columns.
#[test]
fn a_bicycle_rides_alike_in_rates_of_roll_and_steer_and_in_velocities() {
    let rates = Run::of(&model(BICYCLE), Variables::QuasiVelocities, 5.0, 1e-12);
    let columns = ["x", "y", "ψ", "φ", "θ", "δ", "χ", "ξ", "roll", "steer", "wheel"];
    assert_eq!(rates.names, columns);
    let velocities = model(&with_quasi_velocities(BICYCLE, IN_VELOCITIES));
    let velocities = Run::of(&velocities, Variables::QuasiVelocities, 5.0, 1e-12);
    // Errors of 1e-12 a step, in a thousand steps.
    assert!(rates.differs(&velocities) < 1e-9, "{}", rates.differs(&velocities));
    for (rate, velocity) in [("roll", "φ'"), ("steer", "δ'"), ("wheel", "χ'")] {
        assert!((rates.end(rate) - velocities.end(velocity)).abs() < 1e-9 * rates.end(rate).abs().max(1.0));
    }
    assert!(rates.energy.1 < 1e-9 * rates.energy.0, "{}", rates.energy.1);
}

/// d/dt of (φ, δ, roll, steer) at a state near straight riding with the rear wheel at its speed: pitch and what is left of
/// the velocities follow from the constraints.
fn lean_and_steer(
    motion: &mut Motion,
    start: &[f64],
    [lean, steer, lean_rate, steer_rate]: [f64; 4],
) -> [f64; 4] {
    let mut state = start.to_vec();
    (state[3], state[5], state[8], state[9]) = (lean, steer, lean_rate, steer_rate);
    motion.project_holding(0.0, &mut state, &[0, 1, 2, 3, 5, 6, 7], &[0, 1, 2]).unwrap();
    let mut rates = vec![0.0; state.len()];
    motion.rhs(0.0, &state, &mut rates).unwrap();
    [rates[3], rates[5], rates[8], rates[9]]
}

/// The coefficients of det(λ − A) by the method of Faddeev and Leverrier, that of λ⁴ first.
fn characteristic(a: &[[f64; 4]; 4]) -> [f64; 5] {
    let product = |m: &[[f64; 4]; 4]| -> [[f64; 4]; 4] {
        from_fn(|i| from_fn(|j| (0..4).map(|l| a[i][l] * m[l][j]).sum()))
    };
    let mut coefficients = [1.0, 0.0, 0.0, 0.0, 0.0];
    let mut m = [[0.0; 4]; 4];
    for degree in 1..=4 {
        // M ← A M + c 1, c = −tr(A M)/degree
        let last = coefficients[degree - 1];
        let before = product(&m);
        m = from_fn(|i| from_fn(|j| before[i][j] + if i == j { last } else { 0.0 }));
        let after = product(&m);
        coefficients[degree] = -(0..4).map(|i| after[i][i]).sum::<f64>() / degree as f64;
    }
    coefficients
}

/// The eigenvalues of straight riding at 5 m/s: weave, capsize and castering [Meijaard, Papadopoulos, Ruina, Schwab, Proc. R.
/// Soc. A 463 (2007) 1955, Table 2].
#[test]
fn a_bicycle_weaves_as_the_benchmark_says() {
    let upright = model(&BICYCLE.replace("start = 0.5", "start = 0"));
    let graph = Graph::new();
    let assembly = upright.assemble(&graph).unwrap();
    let (mut motion, start) = upright.compile(&assembly).unwrap();
    let h = 1e-3;
    let slopes: [[f64; 4]; 4] = from_fn(|column| {
        let mut at = |distance: f64| {
            let mut deviation = [0.0; 4];
            deviation[column] = distance;
            lean_and_steer(&mut motion, &start, deviation)
        };
        let (far, near) = ([at(-2.0 * h), at(2.0 * h)], [at(-h), at(h)]);
        // Of the fourth order.
        from_fn(|row| (8.0 * (near[1][row] - near[0][row]) - (far[1][row] - far[0][row])) / (12.0 * h))
    });
    let a = from_fn(|row| from_fn(|column| slopes[column][row]));
    let (weave, frequency) = (-0.775_341_882_195_85, 4.464_867_713_788_23);
    let (capsize, castering) = (-0.322_866_429_004_09, -14.078_389_692_798_22);
    let pair = [1.0, -2.0 * weave, weave * weave + frequency * frequency];
    let two = [1.0, -capsize - castering, capsize * castering];
    let mut expected = [0.0; 5];
    for (i, a) in pair.iter().enumerate() {
        for (j, b) in two.iter().enumerate() {
            expected[i + j] += a * b;
        }
    }
    // Differences of the fourth order: h⁴ = 1e-12, and roundings of 1e-13 divided by h.
    for (found, expected) in characteristic(&a).iter().zip(expected) {
        assert!((found - expected).abs() < 1e-8 * expected.abs().max(1.0), "{found} {expected}");
    }
}

/// The state at t = 0.03 is that of the Test Set for IVP Solvers [Andrews' squeezing mechanism; Hairer and Wanner II, VII.7].
#[test]
fn the_squeezer_reaches_its_reference_for_any_choice_of_rate() {
    let expected = [
        ("β", 15.810_771_196_299_04),
        ("Θ", -15.756_371_059_842_98),
        ("γ", 0.040_822_240_130_731_01),
        ("Φ", -0.534_730_116_322_694_8),
        ("δ", 0.524_409_965_880_530_4),
        ("Ω", 0.534_730_116_322_694_8),
        ("ε", 1.048_080_741_042_263),
    ];
    let by_rate = |rate: &str| {
        let quasi_velocity = format!("rate = {{ is = \"{rate}\" }}");
        with_quasi_velocities(SQUEEZER, &quasi_velocity).replace("motor = \"moment\"", "\"β\" = \"moment\"")
    };
    for rate in ["β'", "Θ'", "β' - 2*Θ'"] {
        let run = Run::of(&model(&by_rate(rate)), Variables::QuasiVelocities, 0.03, 1e-12);
        assert_eq!(run.names.len(), 8, "one quasi-velocity");
        for (name, expected) in expected {
            // 1e-12 a step, in a thousand steps, of β' = 1000.
            assert!((run.end(name) - expected).abs() < 1e-7, "{rate}: {name} = {}", run.end(name));
        }
    }
    // At the start body 3 is at a dead centre, where its rate determines no other.
    let graph = Graph::new();
    let error = model(&by_rate("γ'")).assemble(&graph).map(|_| ()).unwrap_err();
    assert!(error.to_string().contains("leave β', Θ' undetermined"), "{error}");
}

/// The rocker comes to rest and turns back 13 times while the crank goes round: there its rate does not determine that of the
/// crank. The numbers are those of the one equation in the angle of the crank, its loop closed by Newton's method (Dormand and
/// Prince's method of order 8, tolerance 1e-13).
#[test]
fn a_four_bar_goes_through_the_dead_centres_of_its_rocker() {
    let run = Run::of(&model(CRANK_ROCKER), Variables::QuasiVelocities, 10.0, 1e-12);
    let expected = [
        ("α", 42.590_968_007_304_02),
        ("β", 1.146_209_779_921_165),
        ("γ", 2.366_369_645_963_713),
        ("rocker", -1.201_381_966_002_608_6),
    ];
    for (name, expected) in expected {
        assert!((run.end(name) - expected).abs() < 1e-7, "{name} = {}", run.end(name));
    }
    let turns = run.column("rocker").windows(2).filter(|pair| pair[0] * pair[1] < 0.0).count();
    assert!(turns >= 10, "{turns}");
    assert!(run.energy.1 < 1e-9 * run.energy.0, "{}", run.energy.1);
}

/// In the angular velocity of the crank, and in the velocity of the slider, which vanishes at its dead centres; the numbers
/// are those of the one equation in the angle of the crank.
#[test]
fn a_slider_crank_turns_alike_in_the_rate_of_its_crank_and_of_its_slider() {
    let crank = Run::of(&model(SLIDER_CRANK), Variables::QuasiVelocities, 10.0, 1e-12);
    assert!((crank.end("φ") - 22.672_214_462_763).abs() < 1e-8, "{}", crank.end("φ"));
    assert!((crank.end("ω") - 2.487_134_389_135).abs() < 1e-8, "{}", crank.end("ω"));
    assert!(crank.energy.1 < 1e-9 * crank.energy.0, "{}", crank.energy.1);
    // x' = −r sin φ φ' − l sin ψ ψ', ψ' = r cos φ φ'/(l cos ψ)
    let start = "-2*(0.5*sin(0.7) + 0.5*cos(0.7)*tan(asin(0.5*sin(0.7)/1.5)))";
    let by_slider = format!("v = {{ is = \"x'\", start = \"{start}\" }}");
    let slider = Run::of(
        &model(&with_quasi_velocities(SLIDER_CRANK, &by_slider)),
        Variables::QuasiVelocities,
        10.0,
        1e-12,
    );
    assert!(slider.differs(&crank) < 1e-8, "{}", slider.differs(&crank));
}

/// Of an ellipsoid that spins one way and goes on so for ten turns, and the other way and is turned back at once. The numbers
/// are those of Newton's and Euler's equations with the force of the contact eliminated, in body axes.
#[test]
fn a_rattleback_keeps_its_energy_both_ways() {
    let spinning = |spin: &str| {
        let text = RATTLEBACK.replace("start = 5.0", &format!("start = {spin}"));
        Run::of(&model(&text), Variables::QuasiVelocities, 2.0, 1e-12)
    };
    let (on, back) = (spinning("5.0"), spinning("-5.0"));
    for run in [&on, &back] {
        assert!(run.energy.1 < 1e-9 * run.energy.0, "{}", run.energy.1);
    }
    assert!(on.column("ω3").iter().all(|&spin| spin > 4.0));
    assert!(back.end("ω3") > -1.0, "it has lost its spin");
    let expected = [
        (&on, [4.129_899_151_357, -1.504_360_071_518, 5.436_030_076_558], 12.087_056_262_354),
        (&back, [11.177_461_541_441, 2.999_769_146_337, -0.676_156_489_383], -5.922_938_768_193),
    ];
    for (run, spin, heading) in expected {
        // The motion magnifies an error of the start a thousand times.
        for (name, expected) in ["ω1", "ω2", "ω3"].into_iter().zip(spin).chain([("ψ", heading)]) {
            assert!((run.end(name) - expected).abs() < 1e-6, "{name} = {}", run.end(name));
        }
    }
}

/// A blade at the distance b from the axle of a wheel: its constraint contains ω beside x' and y', v and ω being defined. v̇ = b
/// ω², (1 + b²) ω̇ = −b v ω keep v² + (1 + b²) ω².
#[test]
fn a_blade_behind_its_axle_may_be_written_with_the_rate_of_turn() {
    let text = |rate: &str| {
        format!(
            "[parameters]\nb = 0.3\n[coordinates]\nx = 0\ny = 0\n\"φ\" = 0\n[quasi_velocities]\n\
             v = {{ is = \"cos(φ)*x' + sin(φ)*y'\", start = 0.5 }}\n\"ω\" = {{ is = \"φ'\", start = 1.0 }}\n[constraints]\n\
             blade = \"-sin(φ)*x' + cos(φ)*y' - b*{rate}\"\n[lagrangian]\nkinetic = \"(x'^2 + y'^2)/2 + ω^2/2\"\n"
        )
    };
    for variables in [Variables::QuasiVelocities, Variables::Momenta] {
        let by_rate = Run::of(&model(&text("ω")), variables, 3.0, 1e-12);
        let by_hand = Run::of(&model(&text("φ'")), variables, 3.0, 1e-12);
        assert_eq!(by_rate.rows, by_hand.rows);
        // v = k tanh(β (t − t₀)), b ω = k sech(β (t − t₀))/√(1 + b²) · b with β = b k/(1 + b²)
        let (b, square) = (0.3f64, 1.09f64);
        let k = (0.25 + square).sqrt();
        let beta = b * k / square;
        let phase = (0.5 / k).atanh() + 3.0 * beta;
        assert!((by_rate.end("v") - k * phase.tanh()).abs() < 1e-9, "{}", by_rate.end("v"));
        assert!((by_rate.end("ω") - k / square.sqrt() / phase.cosh()).abs() < 1e-9, "{}", by_rate.end("ω"));
        assert!(by_rate.energy.1 < 1e-9);
    }
}

/// Two cranks a = b on one pin: one condition of four follows from the others where they hold, and nowhere else.
/// (5/3) a'' = −19.62 sin a, past a = 90°, where the three that are kept would let b go its own way.
#[test]
fn two_cranks_on_one_pin_swing_as_one() {
    let text = "[coordinates]\na = 2\nb = 2\nx = \"sin(2)\"\ny = \"-cos(2)\"\n[constraints]\nk1 = \"x - sin(a)\"\n\
                k2 = \"y + cos(a)\"\nk3 = \"x - sin(b)\"\nk4 = \"y + cos(b)\"\n[lagrangian]\n\
                kinetic = \"(a'^2 + b'^2)/6 + (x'^2 + y'^2)/2\"\npotential = \"9.81*(y - cos(a)/2 - cos(b)/2)\"\n";
    let cranks = Run::of(&model(text), Variables::QuasiVelocities, 5.0, 1e-12);
    let one = "[coordinates]\na = 2\n[lagrangian]\nkinetic = \"5/6*a'^2\"\npotential = \"-19.62*cos(a)\"\n";
    let one = Run::of(&model(one), Variables::QuasiVelocities, 5.0, 1e-12);
    assert!(cranks.differs(&one) < 1e-8, "{}", cranks.differs(&one));
    assert!(one.column("a").windows(2).filter(|pair| pair[0] * pair[1] < 0.0).count() >= 4, "it swings");
    // Of the wrong length, the second crank contradicts the first.
    let graph = Graph::new();
    assert!(model(&text.replace("y + cos(b)", "y + 1.1*cos(b)")).assemble(&graph).is_err());
}

/// A reset of a quasi-velocity that the constraints leave free: it has that value, and the velocities follow.
#[test]
fn a_kick_changes_the_defined_velocity() {
    let kicked = |is: &str, start: f64| {
        let text = format!(
            "[coordinates]\nx = 0.6\ny = -0.8\n[quasi_velocities]\nw = {{ is = \"{is}\", start = {start} }}\n[constraints]\n\
             rod = \"x^2 + y^2 - 1\"\n[lagrangian]\nkinetic = \"(x'^2 + y'^2)/2\"\npotential = \"y\"\n[events.kick]\n\
             when = \"x\"\ndirection = \"falling\"\nreset = {{ w = \"-2*w\" }}\n"
        );
        let graph = Graph::new();
        let model = model(&text);
        let assembly = model.assemble(&graph).unwrap();
        let mut flow = Flow::new(&model, &assembly, Variables::QuasiVelocities).unwrap();
        // At the lowest point w = −x'/y = x'.
        let mut state = flow.start.clone();
        (state[0], state[1], state[2]) = (0.0, -1.0, -0.7);
        flow.motion.project_holding(0.0, &mut state, &[0], &[0]).unwrap();
        let before = flow.row(0.0, &state);
        flow.events.reset(0, 0.0, &mut state).unwrap();
        (before, flow.row(0.0, &state))
    };
    for (is, start) in [("x*y' - y*x'", 0.2), ("x'", 0.16), ("x' + y'", 0.28)] {
        let (before, after) = kicked(is, start);
        assert_eq!(before[..3], [0.0, -1.0, -0.7], "{is}");
        assert_eq!(after[..3], [0.0, -1.0, 1.4], "{is}");
        // ẋ²/2 − 1
        assert!((after[3] - (1.4f64.powi(2) / 2.0 - 1.0)).abs() < 1e-15, "{is}: {}", after[3]);
    }
}

/// Against the equations of all three links with the reaction of the wall, solved together. Where it goes is known to 16 digits by
/// extrapolation in arithmetic of 40 digits.
#[test]
fn an_arm_moves_its_tool_along_a_wall() {
    const COLUMNS: [&str; 5] = ["q1", "q2", "q3", "rise", "turn"];
    let model = model(ARM);
    let graph = Graph::new();
    let assembly = model.assemble(&graph).unwrap();
    let (mut motion, _) = model.compile(&assembly).unwrap();
    let names = motion.names().to_vec();
    let place = |name: &str| COLUMNS.iter().position(|known| *known == name);
    let mut random = SplitMix64::new(3);
    for _ in 0..300 {
        let y = arm_sample(&mut random);
        let mut expected = [0.0; 5];
        arm_on_wall(&y, &mut expected);
        // What else there is says that the tool stays on the wall.
        let state: Vec<f64> = names.iter().map(|name| place(name).map_or(0.0, |i| y[i])).collect();
        let mut rates = vec![0.0; state.len()];
        motion.rhs(0.0, &state, &mut rates).unwrap();
        let size = expected.iter().fold(1.0f64, |size, rate| size.max(rate.abs()));
        for (name, rate) in names.iter().zip(rates) {
            let error = rate - place(name).map_or(0.0, |i| expected[i]);
            // Some hundred roundings, magnified where the elbow is bent by half a radian.
            assert!(error.abs() < 1e-11 * size, "{name} at {y:?}: {error:e} of {size}");
        }
    }
    let run = Run::of(&model, Variables::QuasiVelocities, 0.5, 1e-12);
    let expected = [
        0.807_514_210_237_163_1,
        -0.375_983_649_602_033_95,
        1.169_200_299_645_307_7,
        0.101_340_723_866_163_3,
        0.467_470_290_159_552_6,
    ];
    for (name, expected) in COLUMNS.into_iter().zip(expected) {
        assert!((run.end(name) - expected).abs() < 1e-9, "{name} = {}", run.end(name));
    }
}
