//! Time and error of Taylor's method: a heavy top and a tilted disk for 100 s, by tolerance and order.

use std::time::Instant;

use pc_expr::{Backend, Expr, Graph, Inputs, Program, ProgramField};
use pc_solve::{Integration, IntegrationMethod, TaylorOptions};

const TOP: [f64; 6] = [
    0.9140918489101751,
    0.19299738567900723,
    7.990335190672689,
    0.26071564526551544,
    0.35068400003797773,
    0.8994710025515829,
];
const DISK: [f64; 8] = [
    -0.4691567790372857,
    9.996026797723028,
    0.10997831164295578,
    -26.418844755001224,
    -17.377504423975385,
    1003.5698803894063,
    -17.718570865374243,
    0.11953800822799095,
];

fn field<const N: usize>(rates: impl for<'g> Fn([Expr<'g>; N]) -> [Expr<'g>; N]) -> ProgramField {
    let graph = Graph::new();
    let y: [Expr<'_>; N] = std::array::from_fn(|i| graph.symbol(&format!("y{i}")));
    let inputs = Inputs { time: None, state: y.to_vec(), parameters: vec![] };
    ProgramField::new(Program::new(&graph, &inputs, &rates(y)).unwrap(), vec![], Backend::Fastest)
}

fn main() {
    let top = field(|[a, b, c, g, h, k]| {
        let (i1, i2, i3, mg, x1, x2, x3) = (1.0, 1.5, 0.8, 9.81, 0.03, -0.02, 0.4);
        [
            b * c * ((i2 - i3) / i1) + h * (mg * x3 / i1) - k * (mg * x2 / i1),
            c * a * ((i3 - i1) / i2) + k * (mg * x1 / i2) - g * (mg * x3 / i2),
            a * b * ((i1 - i2) / i3) + g * (mg * x2 / i3) - h * (mg * x1 / i3),
            h * c - k * b,
            k * a - g * c,
            g * b - h * a,
        ]
    });
    let disk = field(|[u1, u2, u3, _x, _y, _psi, phi, th]| {
        let (m, r, g) = (1.0, 0.5, 9.81);
        let (j, i, mr) = (m * r * r / 4.0, m * r * r / 2.0, m * r * r);
        let f = u3 / th.cos();
        let w = th.sin() * f;
        [
            (u2 * u3 * (i + mr) - u3 * w * j + th.sin() * (m * g * r)) / (j + mr),
            u1 * u3 * (-mr / (i + mr)),
            u1 * w - u1 * u2 * (i / j),
            (u2 - w) * phi.cos() * r,
            (u2 - w) * phi.sin() * r,
            u2 - w,
            f,
            u1,
        ]
    });
    let start = [0.5, -0.3, 8.0, 0.4f64.sin(), 0.0, 0.4f64.cos()];
    run("top", &top, &start, &TOP);
    run("disk", &disk, &[0.1, 10.0, 0.5, 0.0, 0.0, 0.0, 0.0, 0.1], &DISK);
}

fn run(name: &str, field: &ProgramField, start: &[f64], end: &[f64]) {
    for tolerance in [1e-8, 1e-9, 1e-10, 1e-11, 1e-12, 1e-16] {
        for order in [None, Some(14), Some(18), Some(22), Some(26)] {
            let mut options =
                TaylorOptions::new().relative_tolerance(tolerance).absolute_tolerance(tolerance);
            if let Some(order) = order {
                options = options.order(order);
            }
            let mut field = field.clone();
            let (mut times, mut last) = (Vec::new(), None);
            for _ in 0..31 {
                let stepper = options.begin(&mut field, 0.0, start, Some(100.0)).unwrap();
                let mut motion = Integration::of(stepper);
                let clock = Instant::now();
                let y = motion.state_at(100.0).unwrap().to_vec();
                times.push(clock.elapsed().as_secs_f64() * 1e3);
                last = Some((y, motion.statistics()));
            }
            times.sort_by(f64::total_cmp);
            let (y, statistics) = last.unwrap();
            let error = y.iter().zip(end).map(|(y, e)| (y - e).abs() / e.abs().max(1.0)).fold(0.0, f64::max);
            println!(
                "{name} {tolerance:.0e} p {:2}{}: {:.3} ms, {:4} steps, {:.0} ns a step, error {error:.1e}",
                statistics.last_order,
                if order.is_none() { '*' } else { ' ' },
                times[0],
                statistics.steps,
                times[0] * 1e6 / statistics.steps as f64,
            );
        }
    }
}
