//! Gradients of several functionals, with events, and of large systems, against closed forms and
//! forward sensitivities.

use std::ops::ControlFlow::Continue;

use crate::boxed::{erased, from_fn};
use pc_solve::{
    AdjointOptions, Event, Events, Failure, FnEvents, Functional, InputError, Integration, Krylov,
    LinearSolver, Method, Options, Pattern, Reason, Sensitivities, SolveError, VectorField, adjoint_gradient,
    adjoint_gradients, adjoint_gradients_with_events,
};

fn sharp(method: Method) -> Options {
    Options::new(method).relative_tolerance(1e-11).absolute_tolerance(1e-13)
}

/// G = ∫ y₀² y₁ dt + y₀(T) y₁(T) p₀, or either term.
#[derive(Clone, Copy)]
struct Mixed {
    density: f64,
    end: f64,
    p: f64,
}

impl Functional for Mixed {
    fn density(&mut self, _t: f64, y: &[f64], by_y: &mut [f64], by_p: &mut [f64]) -> Result<f64, Failure> {
        by_y.copy_from_slice(&[self.density * 2.0 * y[0] * y[1], self.density * y[0] * y[0]]);
        by_p.fill(0.0);
        Ok(self.density * y[0] * y[0] * y[1])
    }
    fn end(&mut self, _t: f64, y: &[f64], by_y: &mut [f64], by_p: &mut [f64]) -> Result<f64, Failure> {
        let s = self.end * self.p;
        by_y.copy_from_slice(&[s * y[1], s * y[0]]);
        by_p.fill(0.0);
        by_p[0] = self.end * y[0] * y[1];
        Ok(s * y[0] * y[1])
    }
}

/// ẍ = −p₀ sin x − p₁ ẋ
fn pendulum(p: [f64; 2]) -> impl VectorField {
    from_fn(2, move |_t, y: &[f64], ydot: &mut [f64]| {
        ydot.copy_from_slice(&[y[1], -p[0] * y[0].sin() - p[1] * y[1]]);
        Ok(())
    })
    .with_jacobian(move |_, y, jacobian| {
        jacobian.copy_from_slice(&[0.0, -p[0] * y[0].cos(), 1.0, -p[1]]);
        Ok(())
    })
    .with_parameters(2, |_, y, by| {
        by.copy_from_slice(&[0.0, -y[0].sin(), 0.0, -y[1]]);
        Ok(())
    })
}

/// Sharing the motion changes no gradient.
#[test]
fn several_functionals_have_the_gradients_of_each_alone() {
    let p = [1.3, 0.2];
    let all = [
        Mixed { density: 1.0, end: 0.0, p: p[0] },
        Mixed { density: 0.0, end: 1.0, p: p[0] },
        Mixed { density: 2.0, end: -1.0, p: p[0] },
    ];
    for method in [Method::Adams, Method::Bdf] {
        let options = AdjointOptions::new(sharp(method)).checkpoint_interval(30);
        let gradients =
            |of: Vec<Mixed>| adjoint_gradients(pendulum(p), of, 0.0, &[1.0, 0.7], 6.0, &options).unwrap();
        let together = gradients(all.to_vec());
        assert_eq!(together.len(), 3);
        for (one, functional) in together.iter().zip(all) {
            assert_eq!(&gradients(vec![functional])[0], one);
            let alone = adjoint_gradient(pendulum(p), functional, 0.0, &[1.0, 0.7], 6.0, &options).unwrap();
            assert_eq!(&alone, one);
        }
        // G is linear in its terms.
        let sum = |i: usize| 2.0 * together[0].by_parameters[i] - together[1].by_parameters[i];
        for i in 0..2 {
            assert!((together[2].by_parameters[i] - sum(i)).abs() < 1e-8);
        }
        let boxed: Vec<Box<dyn Functional>> = all.iter().map(|&one| Box::new(one) as Box<_>).collect();
        let boxed = adjoint_gradients(pendulum(p), boxed, 0.0, &[1.0, 0.7], 6.0, &options).unwrap();
        assert_eq!(boxed, together);
    }
    let none: [Mixed; 0] = [];
    let options = AdjointOptions::new(Options::default());
    let error = adjoint_gradients(pendulum(p), none, 0.0, &[1.0, 0.7], 6.0, &options).unwrap_err();
    assert!(matches!(error, SolveError::Input(InputError::NoFunctional)));
}

/// ẏ = v, v̇ = −p₀; p₁ is for the reset.
fn ball(g: f64) -> impl VectorField {
    from_fn(2, move |_t, y: &[f64], ydot: &mut [f64]| {
        ydot.copy_from_slice(&[y[1], -g]);
        Ok(())
    })
    .with_jacobian(|_, _, jacobian| {
        jacobian.copy_from_slice(&[0.0, 0.0, 1.0, 0.0]);
        Ok(())
    })
    .with_parameters(2, |_, _, by| {
        by.copy_from_slice(&[0.0, -1.0, 0.0, 0.0]);
        Ok(())
    })
}

fn bounce(e: f64) -> FnEvents<'static> {
    let reset = move |_: f64, y: &mut [f64]| {
        y[1] *= -e;
        Ok(())
    };
    FnEvents::new()
        .with_reset(Event::new("bounce").falling(), |_, y| Ok(y[0]), reset)
        .with_parameter_derivatives(|_, j, _, y, by| {
            by.copy_from_slice(&[0.0, if j == 1 { -y[1] } else { 0.0 }]);
            Ok(0.0)
        })
}

/// G = ∫ y dt + c y(T)
struct Flight(f64);

impl Functional for Flight {
    fn density(&mut self, _t: f64, y: &[f64], by_y: &mut [f64], by_p: &mut [f64]) -> Result<f64, Failure> {
        by_y.copy_from_slice(&[1.0, 0.0]);
        by_p.fill(0.0);
        Ok(y[0])
    }
    fn end(&mut self, _t: f64, y: &[f64], by_y: &mut [f64], by_p: &mut [f64]) -> Result<f64, Failure> {
        by_y.copy_from_slice(&[self.0, 0.0]);
        by_p.fill(0.0);
        Ok(self.0 * y[0])
    }
}

/// From rest at h the ball lands at τ = w/g with w = √(2gh), so ∫ y dt = 2hτ/3 + e w s²/2 − g s³/6
/// and y = e w s − g s²/2 with s = T − τ after the first bounce.
#[test]
fn a_bouncing_ball_in_closed_form() {
    let (h, g, e, t, c) = (1.3_f64, 9.81_f64, 0.8, 1.1, 0.7);
    let w = (2.0 * g * h).sqrt();
    let (tau, s) = (w / g, t - w / g);
    let value =
        2.0 * h * tau / 3.0 + e * w * s * s / 2.0 - g * s.powi(3) / 6.0 + c * (e * w * s - g * s * s / 2.0);
    // Derivatives of both terms by w, τ and s, with ∂w/∂h = w/2h, ∂τ/∂h = τ/2h, ∂w/∂g = w/2g,
    // ∂τ/∂g = −τ/2g, ∂s = −∂τ.
    let by_s = e * w * s - g * s * s / 2.0 + c * (e * w - g * s);
    let by_w = e * s * s / 2.0 + c * e * s;
    let by_h =
        2.0 * tau / 3.0 + 2.0 * h / 3.0 * tau / (2.0 * h) + by_w * w / (2.0 * h) - by_s * tau / (2.0 * h);
    let by_g = -h * tau / (3.0 * g) + by_w * w / (2.0 * g) + by_s * tau / (2.0 * g)
        - s.powi(3) / 6.0
        - c * s * s / 2.0;
    let by_e = w * s * s / 2.0 + c * w * s;
    for method in [Method::Adams, Method::Bdf] {
        for interval in [3, 200] {
            let options = AdjointOptions::new(sharp(method)).checkpoint_interval(interval);
            let found =
                adjoint_gradients_with_events(ball(g), bounce(e), [Flight(c)], 0.0, &[h, 0.0], t, &options)
                    .unwrap();
            let found = &found[0];
            let pairs = [
                (found.value, value),
                (found.by_start[0], by_h),
                (found.by_parameters[0], by_g),
                (found.by_parameters[1], by_e),
            ];
            for (i, (found, expected)) in pairs.into_iter().enumerate() {
                // Resets are differentiated by quotients, accurate to ten digits.
                assert!((found - expected).abs() < 1e-8, "{method:?} {i}: {found} is not {expected}");
            }
        }
    }
}

/// A pendulum between a wall at x = p − 0.9 that reflects it, and a switch that pushes it and moves
/// with time.
fn wall_and_switch(p: f64) -> FnEvents<'static> {
    let turn = |_: f64, y: &mut [f64]| {
        y[1] *= -0.7;
        Ok(())
    };
    let push = move |t: f64, y: &mut [f64]| {
        y[1] += 0.3 * p + 0.01 * t;
        y[0] += 0.02 * y[1];
        Ok(())
    };
    FnEvents::new()
        .with_reset(Event::new("wall").falling(), move |_, y| Ok(y[0] - (p - 0.9)), turn)
        .with_reset(Event::new("switch").rising(), move |t, y| Ok(y[0] - 0.2 - 0.03 * t), push)
        .with_parameter_derivatives(|event, j, _, _, by| {
            by.fill(0.0);
            match (event, j) {
                (0, 0) => Ok(-1.0),
                (1, 0) => {
                    by.copy_from_slice(&[0.02 * 0.3, 0.3]);
                    Ok(0.0)
                }
                _ => Ok(0.0),
            }
        })
}

/// Over many events: the gradient of the end term is ∂h/∂y S(T); that of an integral is the same
/// for a third component of the state.
#[test]
fn over_events_the_adjoint_agrees_with_forward_sensitivities() {
    let p = [0.6, 0.05];
    let third = |y: &[f64]| y[0] * y[0] * y[1];
    let wide = from_fn(3, move |_t, y: &[f64], ydot: &mut [f64]| {
        ydot.copy_from_slice(&[y[1], -p[0] * y[0].sin() - p[1] * y[1], third(y)]);
        Ok(())
    })
    .with_jacobian(move |_, y, jacobian| {
        let (by_x, by_v) = (2.0 * y[0] * y[1], y[0] * y[0]);
        jacobian.copy_from_slice(&[0.0, -p[0] * y[0].cos(), by_x, 1.0, -p[1], by_v, 0.0, 0.0, 0.0]);
        Ok(())
    })
    .with_parameters(2, |_, y, by| {
        by.copy_from_slice(&[0.0, -y[0].sin(), 0.0, 0.0, -y[1], 0.0]);
        Ok(())
    });
    struct Wide(FnEvents<'static>);
    impl Events for Wide {
        fn events(&self) -> &[Event] {
            self.0.events()
        }
        fn evaluate(&mut self, t: f64, y: &[f64], values: &mut [f64]) -> Result<(), Failure> {
            self.0.evaluate(t, &y[..2], values)
        }
        fn reset(&mut self, event: usize, t: f64, y: &mut [f64]) -> Result<(), Failure> {
            self.0.reset(event, t, &mut y[..2])
        }
        fn has_parameter_derivatives(&self) -> bool {
            true
        }
        fn by_parameter(
            &mut self,
            event: usize,
            j: usize,
            t: f64,
            y: &[f64],
            by: &mut [f64],
        ) -> Result<f64, Failure> {
            by[2] = 0.0;
            self.0.by_parameter(event, j, t, &y[..2], &mut by[..2])
        }
    }
    let columns = Sensitivities::new().by_starts([0, 1]).by_parameters([0, 1]);
    let (start, t, options) = ([1.0, 0.7, 0.0], 20.0, sharp(Method::Adams));
    let cvode = Integration::with_sensitivities(erased(wide), 0.0, &start, &options, &columns).unwrap();
    let mut hybrid = cvode.with_events(Wide(wall_and_switch(p[0]))).unwrap();
    let mut occurred = [0; 2];
    hybrid
        .advance_to(t, |occurrence| {
            occurred[occurrence.event] += 1;
            Continue(())
        })
        .unwrap();
    assert!(occurred[0] >= 2 && occurred[1] >= 2, "{occurred:?}");
    let y = hybrid.state().to_vec();
    let matrix = hybrid.sensitivities().unwrap();
    let functional = Mixed { density: 1.0, end: 1.0, p: p[0] };
    let expected: Vec<f64> = matrix
        .chunks_exact(3)
        .enumerate()
        .map(|(j, s)| {
            let explicit = if j == 2 { y[0] * y[1] } else { 0.0 };
            s[2] + p[0] * (y[1] * s[0] + y[0] * s[1]) + explicit
        })
        .collect();
    for method in [Method::Adams, Method::Bdf] {
        let options = AdjointOptions::new(sharp(method));
        let found = adjoint_gradients_with_events(
            pendulum(p),
            wall_and_switch(p[0]),
            [functional, functional],
            0.0,
            &start[..2],
            t,
            &options,
        )
        .unwrap();
        assert_eq!(found[0], found[1]);
        assert!((found[0].value - y[2] - p[0] * y[0] * y[1]).abs() < 1e-7);
        let gradient = [&found[0].by_start[..], &found[0].by_parameters].concat();
        let size = expected.iter().fold(1.0, |size: f64, s| size.max(s.abs()));
        for (found, expected) in gradient.iter().zip(&expected) {
            // Quotients have ten digits at each event, and each of some thousand steps an error of
            // 1e-11.
            assert!((found - expected).abs() < 1e-7 * size, "{method:?}: {gradient:?}, not the above");
        }
    }
}

#[test]
fn gradients_that_do_not_exist_are_refused() {
    let options = AdjointOptions::new(sharp(Method::Adams));
    let gradient = |events: FnEvents<'static>, h: f64| {
        adjoint_gradients_with_events(ball(1.0), events, [Flight(1.0)], 0.0, &[h, 0.0], 4.0, &options)
    };
    let silent = FnEvents::new().with_reset(Event::new("one"), |_, y| Ok(y[0]), |_, _| Ok(()));
    let error = gradient(silent, 1.0).unwrap_err();
    assert!(matches!(error, SolveError::Input(InputError::EventParameters)));
    let reason = |error: SolveError| match error {
        SolveError::Integration(error) => error.reason,
        other => panic!("{other}"),
    };
    let last = FnEvents::new().with(Event::new("floor").terminal(true), |_, y| Ok(y[0]));
    let error = gradient(last, 2.0).unwrap_err();
    let message = error.to_string();
    assert!(message.starts_with("the event floor ends the motion at t = 2"), "{message}");
    assert!(matches!(reason(error), Reason::EndsEarly { t, .. } if (t - 2.0).abs() < 1e-9));
    let turn = |_: f64, y: &mut [f64]| {
        y[1] = y[1].abs();
        Ok(())
    };
    let both = FnEvents::new()
        .with_reset(Event::new("one"), |_, y| Ok(y[0]), turn)
        .with_reset(Event::new("two"), |_, y| Ok(3.0 * y[0]), turn)
        .with_parameter_derivatives(|_, _, _, _, by| {
            by.fill(0.0);
            Ok(0.0)
        });
    let reason = reason(gradient(both, 1.0).unwrap_err());
    assert!(matches!(&reason, Reason::Together { events, .. } if events == &["one", "two"]), "{reason:?}");
}

/// The derivatives offered by the field of diffusion below.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Offer {
    Sparse,
    Colours,
    Products,
    Both,
}

/// u̇ᵢ = p₀ (uᵢ₋₁ − 2uᵢ + uᵢ₊₁) − p₁ (uᵢ − uᵢ₋₁) − uᵢ³, with u = 0 beyond the ends: with
/// convection, so that ∂f/∂u is not symmetric.
fn diffusion(n: usize, p: [f64; 2], offer: Offer) -> impl VectorField {
    struct Diffusion {
        p: [f64; 2],
        pattern: Pattern,
        offer: Offer,
    }
    impl VectorField for Diffusion {
        fn dim(&self) -> usize {
            self.pattern.rows()
        }
        fn rhs(&mut self, _t: f64, u: &[f64], rate: &mut [f64]) -> Result<(), Failure> {
            let n = u.len();
            for i in 0..n {
                let (left, right) =
                    (if i > 0 { u[i - 1] } else { 0.0 }, if i + 1 < n { u[i + 1] } else { 0.0 });
                rate[i] = self.p[0] * (left - 2.0 * u[i] + right) - self.p[1] * (u[i] - left) - u[i].powi(3);
            }
            Ok(())
        }
        fn has_jacobian(&self) -> bool {
            matches!(self.offer, Offer::Sparse | Offer::Both)
        }
        fn jacobian(&mut self, _t: f64, _y: &[f64], _jacobian: &mut [f64]) -> Result<(), Failure> {
            panic!("a dense matrix is asked for")
        }
        fn sparsity(&self) -> Option<&Pattern> {
            (self.offer != Offer::Products).then_some(&self.pattern)
        }
        fn sparse_jacobian(&mut self, _t: f64, u: &[f64], values: &mut [f64]) -> Result<(), Failure> {
            let [k, c] = self.p;
            for ((i, j), value) in self.pattern.entries().zip(values) {
                *value = match i.cmp(&j) {
                    std::cmp::Ordering::Less => k,
                    std::cmp::Ordering::Equal => -2.0 * k - c - 3.0 * u[i] * u[i],
                    std::cmp::Ordering::Greater => k + c,
                };
            }
            Ok(())
        }
        fn has_vjp(&self) -> bool {
            matches!(self.offer, Offer::Products | Offer::Both)
        }
        fn vjp(&mut self, _t: f64, u: &[f64], w: &[f64], product: &mut [f64]) -> Result<(), Failure> {
            let ([k, c], n) = (self.p, u.len());
            for j in 0..n {
                let above = if j > 0 { k * w[j - 1] } else { 0.0 };
                let below = if j + 1 < n { (k + c) * w[j + 1] } else { 0.0 };
                product[j] = above + below - (2.0 * k + c + 3.0 * u[j] * u[j]) * w[j];
            }
            Ok(())
        }
        fn parameters_len(&self) -> usize {
            2
        }
        fn has_parameter_jacobian(&self) -> bool {
            true
        }
        fn parameter_jacobian(&mut self, _t: f64, u: &[f64], by: &mut [f64]) -> Result<(), Failure> {
            let n = u.len();
            for i in 0..n {
                let (left, right) =
                    (if i > 0 { u[i - 1] } else { 0.0 }, if i + 1 < n { u[i + 1] } else { 0.0 });
                by[i] = left - 2.0 * u[i] + right;
                by[n + i] = left - u[i];
            }
            Ok(())
        }
    }
    let column = |j: usize| (j.saturating_sub(1)..(j + 2).min(n)).collect::<Vec<_>>();
    Diffusion { p, pattern: Pattern::from_columns(n, (0..n).map(column)), offer }
}

/// G = Σ uᵢ(T)²/2
struct Energy;

impl Functional for Energy {
    fn end(&mut self, _t: f64, u: &[f64], by_u: &mut [f64], by_p: &mut [f64]) -> Result<f64, Failure> {
        by_u.copy_from_slice(u);
        by_p.fill(0.0);
        Ok(u.iter().map(|u| u * u / 2.0).sum())
    }
}

fn bump(n: usize) -> Vec<f64> {
    (1..=n).map(|i| (std::f64::consts::PI * i as f64 / (n + 1) as f64).sin()).collect()
}

/// Against forward sensitivities by the parameters and along a direction, without a dense matrix,
/// whatever the field offers. The wave number of the start is low, so that the motion is slow
/// compared with the stiffest rate, 4 p₀.
#[test]
fn large_systems_take_no_dense_matrix() {
    let (n, p, t) = (150, [40.0, 3.0], 1.0);
    let start = bump(n);
    let direction: Vec<f64> = (0..n).map(|i| (0.3 * i as f64).sin()).collect();
    let columns = Sensitivities::new().along(direction.clone()).by_parameters([0, 1]);
    let options = Options::new(Method::Bdf).relative_tolerance(1e-10).absolute_tolerance(1e-12);
    let sparse = options.clone().linear_solver(LinearSolver::Sparse);
    let mut forward = Integration::with_sensitivities(
        erased(diffusion(n, p, Offer::Colours)),
        0.0,
        &start,
        &sparse,
        &columns,
    )
    .unwrap();
    forward.state_at(t).unwrap();
    let u = forward.state().to_vec();
    let matrix = forward.sensitivities().unwrap();
    let dot = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>();
    let expected: Vec<f64> = matrix.chunks_exact(n).map(|s| dot(&u, s)).collect();
    for offer in [Offer::Sparse, Offer::Colours, Offer::Products, Offer::Both] {
        let motion = match offer {
            Offer::Products => options.clone().linear_solver(LinearSolver::Krylov(Krylov::new(30))),
            _ => sparse.clone(),
        };
        let options = AdjointOptions::new(motion).checkpoint_interval(25);
        let found = adjoint_gradient(diffusion(n, p, offer), Energy, 0.0, &start, t, &options).unwrap();
        let gradient = [dot(&found.by_start, &direction), found.by_parameters[0], found.by_parameters[1]];
        for (found, expected) in gradient.iter().zip(&expected) {
            // An error of 1e-10 in each of some hundred steps.
            assert!(
                (found - expected).abs() < 1e-7 * expected.abs().max(1.0),
                "{offer:?}: {gradient:?} {expected:?}"
            );
        }
    }
}
