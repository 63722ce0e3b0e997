//! Vector fields and events that are programs.

use std::sync::Arc;

use pc_expr::{
    Backend, Event, Events, Expr, Failure, Graph, Inputs, Interpreter, Kernel, Program, ProgramField,
};

/// A program of (t, y).
pub(crate) fn program<const N: usize, const M: usize>(
    outputs: impl for<'g> Fn(Expr<'g>, [Expr<'g>; N]) -> [Expr<'g>; M],
) -> Program {
    let graph = Graph::new();
    let t = graph.symbol("t");
    let y: [Expr<'_>; N] = std::array::from_fn(|i| graph.symbol(&format!("y{i}")));
    let inputs = Inputs { time: Some(t), state: y.to_vec(), parameters: Vec::new() };
    Program::new(&graph, &inputs, &outputs(t, y)).unwrap()
}

/// The field of these rates.
pub(crate) fn field<const N: usize>(
    rates: impl for<'g> Fn(Expr<'g>, [Expr<'g>; N]) -> [Expr<'g>; N],
) -> ProgramField {
    ProgramField::new(program(rates), Vec::new(), Backend::Fastest)
}

pub(crate) fn oscillator() -> ProgramField {
    field(|_, [x, v]| [v, -x])
}

/// (Ω, γ) of a top with three different moments of inertia and its centre of mass off the principal
/// axes.
pub(crate) fn heavy_top() -> ProgramField {
    field(|_, [a, b, c, g, h, k]| {
        let [i1, i2, i3] = MOMENTS;
        let [x1, x2, x3] = CENTRE;
        [
            (b * c * (i2 - i3) + h * x3 - k * x2) / i1,
            (c * a * (i3 - i1) + k * x1 - g * x3) / i2,
            (a * b * (i1 - i2) + g * x2 - h * x1) / i3,
            h * c - k * b,
            k * a - g * c,
            g * b - h * a,
        ]
    })
}

const MOMENTS: [f64; 3] = [1.0, 1.5, 0.8];
/// The centre of mass times the weight.
const CENTRE: [f64; 3] = [9.81 * 0.03, -9.81 * 0.02, 9.81 * 0.4];

pub(crate) fn top_start() -> [f64; 6] {
    [0.5, -0.3, 8.0, 0.4f64.sin(), 0.0, 0.4f64.cos()]
}

/// The energy and |γ|² of the top.
pub(crate) fn top_integrals(y: &[f64]) -> [f64; 2] {
    let kinetic: f64 = (0..3).map(|i| 0.5 * MOMENTS[i] * y[i] * y[i]).sum();
    let potential: f64 = (0..3).map(|i| CENTRE[i] * y[3 + i]).sum();
    [kinetic + potential, y[3] * y[3] + y[4] * y[4] + y[5] * y[5]]
}

/// A reset of a state.
pub(crate) type Reset = fn(&mut [f64]);

/// Events whose functions are a program.
pub(crate) struct ProgramEvents {
    events: Vec<Event>,
    resets: Vec<Option<Reset>>,
    program: Arc<Program>,
    kernel: Interpreter,
}

impl ProgramEvents {
    /// Events without resets.
    pub(crate) fn new(program: Program) -> ProgramEvents {
        let events = (0..program.outputs_len()).map(|i| (Event::new(format!("g{i}")), None)).collect();
        ProgramEvents::with(program, events)
    }

    /// These events, each with its reset, if any.
    pub(crate) fn with(program: Program, events: Vec<(Event, Option<Reset>)>) -> ProgramEvents {
        let program = Arc::new(program);
        let (events, resets) =
            events.into_iter().map(|(event, reset)| (event.resetting(reset.is_some()), reset)).unzip();
        ProgramEvents { events, resets, kernel: Interpreter::new(Arc::clone(&program)), program }
    }
}

impl Events for ProgramEvents {
    fn events(&self) -> &[Event] {
        &self.events
    }

    fn evaluate(&mut self, t: f64, y: &[f64], values: &mut [f64]) -> Result<(), Failure> {
        self.kernel.eval(t, y, &[], values);
        Ok(())
    }

    fn program(&self) -> Option<(&Arc<Program>, &[f64])> {
        Some((&self.program, &[]))
    }

    fn reset(&mut self, event: usize, _t: f64, y: &mut [f64]) -> Result<(), Failure> {
        if let Some(reset) = self.resets[event] {
            reset(y);
        }
        Ok(())
    }
}
