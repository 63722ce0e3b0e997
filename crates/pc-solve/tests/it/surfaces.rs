//! Motions of fields of several pieces: across surfaces and along them, against closed forms.

use pc_solve::{
    AdjointOptions, Event, Failure, FnEvents, Functional, Integration, LyapunovOptions, Method, Options,
    Sensitivities, Slide, Solution, Solve, adjoint_gradient, lyapunov_exponents,
};

use crate::pieces::{Function, Pieces};

const METHODS: [Method; 4] = [Method::Dop853, Method::Adams, Method::Bdf, Method::Auto];

fn options(method: Method) -> Options {
    Options::new(method).relative_tolerance(1e-11).absolute_tolerance(1e-13)
}

fn run(field: Pieces, t0: f64, y0: &[f64], times: &[f64], method: Method) -> Solution {
    Solve::new(field, t0, y0).method(options(method)).run(times).unwrap()
}

fn assert_near(found: &[f64], right: &[f64], within: f64, what: impl std::fmt::Debug) {
    for (found, right) in found.iter().zip(right) {
        assert!((found - right).abs() <= within, "{what:?}: {found}, not {right}");
    }
}

/// x″ = −a sign(x′)
fn brake() -> Pieces {
    Pieces::new(2, &[3.0], |_, y, p, s, ydot| ydot.copy_from_slice(&[y[1], -p[0] * s[0]]), &[|_, y, _| y[1]])
}

/// A body that brakes from v stops after v/a at v²/2a and stays there.
#[test]
fn a_body_brakes_to_rest() {
    for method in METHODS {
        for (speed, direction) in [(2.5, 1.0), (-2.5, 1.0), (2.5, -1.0)] {
            let times = [0.2, 0.5, 1.0, 4.0].map(|t| t * direction);
            // Against time the friction drives it.
            let solution = run(brake(), 0.0, &[0.0, speed], &times, method);
            let (stop, way) = (2.5 / 3.0, 2.5 * 2.5 / 6.0 * f64::signum(speed));
            for (t, y) in solution.trajectory.iter() {
                let right = if direction < 0.0 {
                    [speed * t - 1.5 * t * t, speed - 3.0 * t]
                } else if t < stop {
                    [speed * t - 1.5 * t * t * speed.signum(), speed - 3.0 * t * speed.signum()]
                } else {
                    [way, 0.0]
                };
                assert_near(y, &right, 1e-9, (method, speed, direction, t));
            }
            match &solution.slides[..] {
                [Slide { surface, from, until: None }] if direction > 0.0 => {
                    assert!(surface == "g0" && (from - stop).abs() < 1e-9, "{method:?} {from}");
                }
                slides => assert!(direction < 0.0 && slides.is_empty(), "{method:?} {slides:?}"),
            }
        }
    }
}

/// A body on a belt of velocity w, held by a spring: x″ = −x − m sign(x′ − w). It slips until it is as fast as the belt,
/// sticks until the spring is as strong as the friction, and slips again.
#[test]
fn a_body_sticks_to_a_belt_and_slips() {
    let (m, w) = (1.1, 0.5);
    let belt = || {
        Pieces::new(
            2,
            &[1.1, 0.5],
            |_, y, p, s, ydot| ydot.copy_from_slice(&[y[1], -y[0] - p[0] * s[0]]),
            &[|_, y, p| y[1] - p[1]],
        )
    };
    // x′ = m sin t + w/2 cos t = w
    let (size, phase) = (f64::hypot(m, w / 2.0), f64::atan2(w / 2.0, m));
    let sticks = (w / size).asin() - phase;
    let at = m - m * sticks.cos() + w / 2.0 * sticks.sin();
    let slips = sticks + (m - at) / w;
    let motion = |t: f64| {
        if t < sticks {
            [m - m * t.cos() + w / 2.0 * t.sin(), m * t.sin() + w / 2.0 * t.cos()]
        } else if t < slips {
            [at + w * (t - sticks), w]
        } else {
            [m + w * (t - slips).sin(), w * (t - slips).cos()]
        }
    };
    for method in METHODS {
        let times: Vec<f64> = (1..30).map(|k| 0.2 * f64::from(k)).collect();
        let solution = run(belt(), 0.0, &[0.0, w / 2.0], &times, method);
        for (t, y) in solution.trajectory.iter() {
            assert_near(y, &motion(t), 1e-9, (method, t));
        }
        let [Slide { from, until: Some(until), .. }] = &solution.slides[..] else { panic!("{method:?}") };
        assert_near(&[*from, *until], &[sticks, slips], 1e-9, method);
    }
}

/// A block on a table that moves as A sin ωt, with the friction a: it moves with the table while Aω² |sin ωt| ≤ a, then as
/// far behind it as the friction allows.
#[test]
fn a_block_lies_on_a_table_that_shakes() {
    let (size, pace, friction) = (0.4, 3.0, 2.2);
    let table = || {
        Pieces::new(
            2,
            &[0.4, 3.0, 2.2],
            |_, y, p, s, ydot| ydot.copy_from_slice(&[y[1], -p[2] * s[0]]),
            &[|t, y, p| y[1] - p[0] * p[1] * (p[1] * t).cos()],
        )
    };
    let speed = |t: f64| size * pace * (pace * t).cos();
    let leaves = (friction / (size * pace * pace)).asin() / pace;
    // The block is faster from there on, until it has the speed of the table again.
    let behind = |t: f64| speed(leaves) - friction * (t - leaves) - speed(t);
    let (mut early, mut late) = (1.0, 2.0);
    for _ in 0..100 {
        let middle = 0.5 * (early + late);
        if behind(middle) > 0.0 { early = middle } else { late = middle }
    }
    assert!(behind(1.0) > 0.0 && early < 2.0);
    for method in METHODS {
        let solution = run(table(), 0.0, &[0.0, speed(0.0)], &[0.1, 0.3, 0.7, 1.2], method);
        for (t, y) in solution.trajectory.iter().filter(|(t, _)| *t < early) {
            let right = if t < leaves { speed(t) } else { speed(leaves) - friction * (t - leaves) };
            assert_near(&[y[1]], &[right], 1e-9, (method, t));
        }
        let times: Vec<f64> =
            solution.slides.iter().flat_map(|slide| [Some(slide.from), slide.until]).flatten().collect();
        assert_near(&times, &[0.0, leaves, early], 1e-9, method);
    }
}

/// ẋ = 0.3 + 0.2 t − sign x, ẏ = 0.5 − 2 sign y, ż = sign x sign y: along both surfaces ż is the product of σ_x = 0.3 + 0.2 t
/// and σ_y = 0.25, until σ_x = 1.
#[test]
fn a_motion_slides_along_two_surfaces() {
    let corner = || {
        Pieces::new(
            3,
            &[],
            |t, _, _, s, ydot| {
                ydot.copy_from_slice(&[0.3 + 0.2 * t - s[0], 0.5 - 2.0 * s[1], s[0] * s[1]]);
            },
            &[|_, y, _| y[0], |_, y, _| y[1]],
        )
    };
    // x: 0.4 − 0.7 t + 0.1 t² = 0, y: 0.9 − 1.5 t = 0.
    let reaches = [(0.7 - f64::sqrt(0.49 - 0.16)) / 0.2, 0.6];
    let leaves = 3.5;
    let motion = |t: f64| {
        let integral = |a: f64, b: f64| 0.3 * (b - a) + 0.1 * (b * b - a * a);
        // σ_y = 0.25 from 0.6 on, σ_x = 0.3 + 0.2 t from 0.676… to 3.5.
        let mut z = t.min(0.6);
        z += 0.25 * (t.clamp(0.6, reaches[0]) - 0.6);
        z += 0.25 * integral(reaches[0], t.clamp(reaches[0], leaves));
        z += 0.25 * (t.max(leaves) - leaves);
        let since = t.max(leaves) - leaves;
        let x = if t < reaches[0] { 0.4 - 0.7 * t + 0.1 * t * t } else { 0.1 * since * since };
        [x, (0.9 - 1.5 * t).max(0.0), z]
    };
    for method in METHODS {
        let solution = run(corner(), 0.0, &[0.4, 0.9, 0.0], &[0.3, 0.65, 1.0, 3.0, 5.0], method);
        for (t, y) in solution.trajectory.iter() {
            assert_near(y, &motion(t), 1e-9, (method, t));
        }
    }
}

/// Twelve bodies in a row, joined by springs of strength 0.1, which friction stops one after the other.
#[test]
fn many_bodies_come_to_rest() {
    const N: usize = 12;
    let functions: [Function; N] = [
        |_, y, _| y[12],
        |_, y, _| y[13],
        |_, y, _| y[14],
        |_, y, _| y[15],
        |_, y, _| y[16],
        |_, y, _| y[17],
        |_, y, _| y[18],
        |_, y, _| y[19],
        |_, y, _| y[20],
        |_, y, _| y[21],
        |_, y, _| y[22],
        |_, y, _| y[23],
    ];
    let row = Pieces::new(
        2 * N,
        &[],
        |_, y, _, s, ydot| {
            ydot[..N].copy_from_slice(&y[N..]);
            for i in 0..N {
                let left = if i > 0 { y[i - 1] - y[i] } else { 0.0 };
                let right = if i + 1 < N { y[i + 1] - y[i] } else { 0.0 };
                ydot[N + i] = 0.1 * (left + right) - s[i];
            }
        },
        &functions,
    );
    // At rest, all but the first.
    let mut start = vec![0.0; 2 * N];
    start[N] = 1.5;
    for method in METHODS {
        let solution = run(row.clone(), 0.0, &start, &[4.0, 8.0], method);
        let (before, after) = (solution.trajectory.state(0), solution.trajectory.state(1));
        assert_near(after, before, 1e-9, method);
        assert!(after[N..].iter().all(|v| v.abs() < 1e-9) && after[0] > 1.0, "{method:?} {after:?}");
    }
}

/// f = 0 before x = a, then F: x = a + v τ + F τ²/2 with τ = t − a/v.
fn step_in_space() -> Pieces {
    Pieces::new(
        2,
        &[5.0, 1.2],
        |_, y, p, s, ydot| ydot.copy_from_slice(&[y[1], if s[0] > 0.0 { p[1] } else { 0.0 }]),
        &[|_, y, p| y[0] - p[0]],
    )
}

#[test]
fn derivatives_jump_where_a_force_begins() {
    let (a, force, speed, end) = (5.0, 1.2, 0.8, 10.0);
    let since = end - a / speed;
    // ∂x/∂(a, F, v₀) and ∂x′/∂(a, F, v₀)
    let right = [
        -force * since / speed,
        -force / speed,
        since * since / 2.0,
        since,
        end + force * since * a / (speed * speed),
        1.0 + force * a / (speed * speed),
    ];
    for method in [Method::Adams, Method::Bdf, Method::Dop853] {
        let wanted = Sensitivities::new().by_parameters([0, 1]).by_start(1);
        let options = options(method);
        let motion = Solve::new(step_in_space(), 0.0, &[0.0, speed])
            .method(&options)
            .sensitivities(&wanted)
            .run(&[end])
            .unwrap();
        assert_near(motion.trajectory.matrix(0), &right, 1e-8, method);
    }
}

/// The same backwards, from a functional of the end.
#[test]
fn gradients_jump_where_a_force_begins() {
    struct End;
    impl Functional for End {
        fn end(&mut self, _: f64, y: &[f64], by: &mut [f64], p: &mut [f64]) -> Result<f64, Failure> {
            by.copy_from_slice(&[1.0, 0.5]);
            p.fill(0.0);
            Ok(y[0] + 0.5 * y[1])
        }
    }
    let (a, force, speed, end) = (5.0, 1.2, 0.8, 10.0);
    let since = end - a / speed;
    let found = adjoint_gradient(
        step_in_space(),
        End,
        0.0,
        &[0.0, speed],
        end,
        &AdjointOptions::new(options(Method::Adams)),
    )
    .unwrap();
    let by_speed = end + force * since * a / (speed * speed) + 0.5 * (1.0 + force * a / (speed * speed));
    let by_a = -force * since / speed - 0.5 * force / speed;
    assert_near(&found.by_parameters, &[by_a, since * since / 2.0 + 0.5 * since], 1e-7, "by a, F");
    assert_near(&found.by_start[1..], &[by_speed], 1e-7, "by the start");
    // x = v²/2a of a body that has come to rest.
    let found =
        adjoint_gradient(brake(), End, 0.0, &[0.0, 2.5], 2.0, &AdjointOptions::new(options(Method::Adams)))
            .unwrap();
    assert_near(&found.by_parameters, &[-2.5 * 2.5 / 18.0], 1e-8, "brake by a");
    assert_near(&found.by_start, &[1.0, 2.5 / 3.0], 1e-8, "brake by the start");
}

/// Where a body rests, its place v²/2a has the derivatives of the motion before; its velocity has none.
#[test]
fn derivatives_of_a_body_at_rest() {
    for method in [Method::Adams, Method::Bdf, Method::Dop853] {
        let wanted = Sensitivities::new().by_parameter(0).by_start(1);
        let motion = Solve::new(brake(), 0.0, &[0.0, 2.5])
            .method(&options(method))
            .sensitivities(&wanted)
            .run(&[3.0])
            .unwrap();
        let right = [-2.5 * 2.5 / 18.0, 0.0, 2.5 / 3.0, 0.0];
        assert_near(motion.trajectory.matrix(0), &right, 1e-9, method);
    }
}

/// ẋ = 1 below 0 and 2 above: a deviation doubles once.
#[test]
fn tangent_vectors_jump() {
    let faster = Pieces::new(
        1,
        &[],
        |_, _, _, s, ydot| ydot[0] = if s[0] > 0.0 { 2.0 } else { 1.0 },
        &[|_, y, _| y[0]],
    );
    let found =
        lyapunov_exponents(faster, 0.0, &[-1.0], &options(Method::Adams), &LyapunovOptions::new(1, 0.5, 8))
            .unwrap();
    assert_near(&found.exponents, &[2f64.ln() / 4.0], 1e-10, "doubles once");
}

/// A ball that falls through a layer in which gravity is twice as strong, and is thrown back by the floor.
#[test]
fn resets_lead_to_other_pieces() {
    let layer = || {
        Pieces::new(
            2,
            &[0.5],
            |_, y, _, s, ydot| ydot.copy_from_slice(&[y[1], if s[0] > 0.0 { -1.0 } else { -2.0 }]),
            &[|_, y, p| y[0] - p[0]],
        )
    };
    // From x = 1 to 0.5 in 1 s; then x = 0.5 − s − s² = 0 with the speed √3, and half of it back is too slow for the layer.
    let floor = || {
        FnEvents::new()
            .with_reset(
                Event::new("floor").falling(),
                |_, y| Ok(y[0]),
                |_, y| {
                    y[1] *= -0.5;
                    Ok(())
                },
            )
            .with_parameter_derivatives(|_, _, _, _, reset| {
                reset.fill(0.0);
                Ok(0.0)
            })
    };
    let hits = 1.0 + (3f64.sqrt() - 1.0) / 2.0;
    for method in METHODS {
        let solution = Solve::new(layer(), 0.0, &[1.0, 0.0])
            .method(options(method))
            .events(floor())
            .run(&[0.9, 1.2, hits + 0.3])
            .unwrap();
        assert_near(&[solution.occurrences[0].time], &[hits], 1e-9, method);
        let back = 3f64.sqrt() / 2.0;
        let right = [0.3 * back - 0.09, back - 0.6];
        assert_near(solution.trajectory.state(2), &right, 1e-9, method);
    }
}

/// The place of a wall at c is reached at a/v + (√(v² + 2 F (c − a)) − v)/F.
#[test]
fn times_of_events_have_derivatives() {
    let (a, force, speed, c) = (5.0f64, 1.2f64, 0.8f64, 7.0f64);
    let wall = FnEvents::new()
        .with(Event::new("wall").terminal(true), |_, y| Ok(y[0] - 7.0))
        .with_parameter_derivatives(|_, _, _, _, _| Ok(0.0));
    let wanted = Sensitivities::new().by_parameters([0, 1]).by_start(1);
    let found = Solve::new(step_in_space(), 0.0, &[0.0, speed])
        .method(&options(Method::Adams))
        .events(wall)
        .sensitivities(&wanted)
        .run(&[20.0])
        .unwrap();
    let root = (speed * speed + 2.0 * force * (c - a)).sqrt();
    let by_force = (c - a) / (force * root) - (root - speed) / (force * force);
    let by_speed = -a / (speed * speed) + (speed / root - 1.0) / force;
    let right = [1.0 / speed - 1.0 / root, by_force, by_speed];
    assert_near(&found.time_derivatives[0], &right, 1e-8, "the wall");
}

/// The integration can be stopped and continued anywhere, and the field is its own again afterwards.
#[test]
fn steps_lead_across_surfaces_and_along_them() {
    let mut motion = Integration::new(brake(), 0.0, &[0.0, 1.0], &options(Method::Adams)).unwrap();
    let mut last = 0.0;
    while motion.time() < 1.0 {
        let t = motion.step_towards(1.0).unwrap();
        assert!(t > last || t == last && motion.slides().len() == 1, "{t}");
        last = t;
    }
    assert_near(motion.state(), &[1.0 / 6.0, 0.0], 1e-10, "at rest");
    motion.restart(1.0, &[0.0, -1.0]).unwrap();
    assert_near(motion.state_at(2.0).unwrap(), &[-1.0 / 6.0, 0.0], 1e-10, "at rest again");
    let mut field = motion.into_field();
    let mut rates = [0.0; 2];
    pc_solve::VectorField::rhs(&mut field, 0.0, &[0.0, 2.0], &mut rates).unwrap();
    assert_near(&rates, &[2.0, -3.0], 0.0, "as it is");
}

/// A wave of a hundred switches costs few evaluations.
#[test]
fn switches_in_time_cost_few_evaluations() {
    let wave = || {
        Pieces::new(
            2,
            &[],
            |_, y, _, s, ydot| ydot.copy_from_slice(&[y[1], -y[0] + s[0]]),
            &[|t, _, _| (std::f64::consts::PI * t).sin()],
        )
    };
    let mut y = [0.0, 0.0];
    for k in 0..100 {
        let force = if k % 2 == 0 { 1.0 } else { -1.0 };
        let (sin, cos) = 1f64.sin_cos();
        y = [force + (y[0] - force) * cos + y[1] * sin, y[1] * cos - (y[0] - force) * sin];
    }
    let options = Options::new(Method::Dop853);
    let mut motion = Solve::new(wave(), 0.0, &[0.0, 0.0]).method(&options).start().unwrap();
    assert_near(motion.state_at(100.0).unwrap(), &y, 1e-8, "the end");
    let evaluations = motion.statistics().rhs_evaluations;
    assert!(evaluations <= 5200, "{evaluations}");
}

/// ẏ = A y + b + s c with the sign s of n·y − d; the parameters are A by rows, b, c, n and d.
fn planar(p: &[f64], y: &[f64], s: f64) -> [f64; 2] {
    [0, 1].map(|i| p[2 * i] * y[0] + p[2 * i + 1] * y[1] + p[4 + i] + s * p[6 + i])
}

fn distance(p: &[f64], y: &[f64]) -> f64 {
    p[8] * y[0] + p[9] * y[1] - p[10]
}

fn along(p: &[f64], rates: [f64; 2]) -> f64 {
    p[8] * rates[0] + p[9] * rates[1]
}

/// σ of the motion along the line.
fn weight(p: &[f64], y: &[f64]) -> f64 {
    let [above, below] = [1.0, -1.0].map(|s| along(p, planar(p, y, s)));
    -(above + below) / (above - below)
}

/// The end of a motion by the classical method with small steps and bisection, and how far it stays from places
/// where it would be another one.
fn by_hand(p: &[f64], start: [f64; 2], end: f64) -> ([f64; 2], f64) {
    #[derive(Clone, Copy, PartialEq)]
    enum Mode {
        On(f64),
        Slides,
    }
    let rates = |mode: Mode, y: [f64; 2]| match mode {
        Mode::On(s) => planar(p, &y, s),
        Mode::Slides => planar(p, &y, weight(p, &y)),
    };
    let step = |mode: Mode, y: [f64; 2], h: f64| {
        let shifted = |k: [f64; 2], h: f64| [y[0] + h * k[0], y[1] + h * k[1]];
        let a = rates(mode, y);
        let b = rates(mode, shifted(a, h / 2.0));
        let c = rates(mode, shifted(b, h / 2.0));
        let d = rates(mode, shifted(c, h));
        [0, 1].map(|i| y[i] + h / 6.0 * (a[i] + 2.0 * b[i] + 2.0 * c[i] + d[i]))
    };
    // What stays positive while a mode lasts.
    let lasts = |mode: Mode, y: &[f64]| match mode {
        Mode::On(s) => s * distance(p, y),
        Mode::Slides => 1.0 - weight(p, y).powi(2),
    };
    let (mut t, mut y) = (0.0, start);
    let mut mode = Mode::On(distance(p, &y).signum());
    let mut margin = distance(p, &y).abs();
    while t < end {
        let h = f64::min(2e-3, end - t);
        let next = step(mode, y, h);
        if lasts(mode, &next) > 0.0 {
            (t, y) = (t + h, next);
            continue;
        }
        let (mut early, mut late) = (0.0, h);
        for _ in 0..60 {
            let middle = 0.5 * (early + late);
            if lasts(mode, &step(mode, y, middle)) > 0.0 { early = middle } else { late = middle }
        }
        y = step(mode, y, early);
        t += early;
        let [above, below] = [1.0, -1.0].map(|s| along(p, planar(p, &y, s)));
        mode = match mode {
            Mode::Slides => Mode::On(weight(p, &y).signum()),
            Mode::On(_) => {
                margin = margin.min(above.abs()).min(below.abs());
                if above < 0.0 && below > 0.0 { Mode::Slides } else { Mode::On(above.signum()) }
            }
        };
        // Off the place where the mode ends.
        let on = step(mode, y, 1e-7);
        (t, y) = (t + 1e-7, on);
    }
    (y, margin)
}

#[test]
fn random_motions_are_those_by_hand() {
    let mut seed = 7u64;
    let mut random = || {
        seed = seed.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
        (seed >> 11) as f64 / (1u64 << 52) as f64 - 1.0
    };
    let (mut slides, mut crossings, mut compared) = (0, 0, 0);
    for case in 0..300 {
        let p: Vec<f64> = (0..11).map(|_| random()).collect();
        let start = [2.0 * random(), 2.0 * random()];
        let (right, margin) = by_hand(&p, start, 3.0);
        if margin < 0.02 || right.iter().any(|y| y.abs() > 20.0) {
            continue;
        }
        compared += 1;
        let field = || {
            Pieces::new(
                2,
                &p,
                |_, y, p, s, ydot| ydot.copy_from_slice(&planar(p, y, s[0])),
                &[|_, y, p| distance(p, y)],
            )
        };
        for method in METHODS {
            let mut motion = Solve::new(field(), 0.0, &start).method(&options(method)).start().unwrap();
            assert_near(motion.state_at(3.0).unwrap(), &right, 1e-7, (case, method, &p));
            slides += motion.slides().len();
        }
        // Derivatives by c₁, d and y₁ against differences, where they exist.
        let wanted = Sensitivities::new().by_parameters([6, 10]).by_start(0);
        let by = Options::new(if case % 2 == 0 { Method::Adams } else { Method::Dop853 });
        let with = Solve::new(field(), 0.0, &start).method(&by).sensitivities(&wanted).run(&[3.0]).unwrap();
        let step = 1e-6;
        let moved = |place: Option<usize>, step: f64| {
            let (mut p, mut y) = (p.clone(), start);
            match place {
                Some(j) => p[j] += step,
                None => y[0] += step,
            }
            let moved = Pieces::new(
                2,
                &p,
                |_, y, p, s, ydot| ydot.copy_from_slice(&planar(p, y, s[0])),
                &[|_, y, p| distance(p, y)],
            );
            let solution = Solve::new(moved, 0.0, &y).method(options(Method::Dop853)).run(&[3.0]).unwrap();
            [solution.trajectory.state(0)[0], solution.trajectory.state(0)[1]]
        };
        for (place, column) in [Some(6), Some(10), None].into_iter().zip(with.trajectory.matrix(0).chunks(2))
        {
            let (ahead, behind) = (moved(place, step), moved(place, -step));
            let quotient = [0, 1].map(|i| (ahead[i] - behind[i]) / (2.0 * step));
            let size = quotient.iter().fold(1.0f64, |size, q| size.max(q.abs()));
            assert_near(column, &quotient, 1e-4 * size, (case, place, &p));
        }
        crossings += usize::from(distance(&p, &start) * distance(&p, &right) < 0.0);
    }
    assert!(compared > 150 && slides > 50 && crossings > 20, "{compared} {slides} {crossings}");
}

/// x″ = −sign x at the bottom of the groove: the body rests, also with friction, and leaves where it is not held.
#[test]
fn a_body_rests_in_a_groove() {
    let groove = |friction: f64| {
        Pieces::new(
            2,
            &[friction],
            |t, y, p, s, ydot| ydot.copy_from_slice(&[y[1], -s[0] - p[0] * s[1] + 0.5 * t]),
            &[|_, y, _| y[0], |_, y, _| y[1]],
        )
    };
    for method in METHODS {
        for friction in [0.0, 0.25] {
            let holds = (1.0 + friction) / 0.5;
            let solution = run(groove(friction), 0.0, &[0.0, 0.0], &[1.0, holds + 1.0], method);
            assert_near(solution.trajectory.state(0), &[0.0, 0.0], 1e-12, (method, friction));
            // It leaves with no acceleration: the time at which it does is known to 2e-7.
            assert_near(solution.trajectory.state(1), &[0.5 / 6.0, 0.25], 1e-7, (method, friction));
        }
    }
}
