//! Random calls, with random arguments.

use proptest::prelude::*;

/// A call; numbers choose among functions and arguments.
#[derive(Clone, Debug)]
pub(crate) enum Call {
    Model(ModelCall),
    System(SystemCall),
    Solver(SolverCall),
    Dense { t: f64, length: u8, rate: bool },
    Ensemble { which: u8, threads: u8, numbers: Vec<f64>, members: u8 },
    Nothing(u8),
}

#[derive(Clone, Debug)]
pub(crate) enum ModelCall {
    New(String),
    Parse(Vec<u8>),
    Builtin(u8),
    File(Vec<u8>),
    Clone,
    /// A function with a name, a text, another one and a number.
    Say(u8, [String; 3], f64),
    /// Any bytes for text.
    Bytes(u8, Vec<u8>),
    Event(u8, String, i8),
    Text,
    Check,
    Free,
}

#[derive(Clone, Debug)]
pub(crate) enum SystemCall {
    New(i8),
    /// By a code that is saved, changed in one byte or not, and loaded.
    Code {
        form: i8,
        change: u8,
    },
    Clone,
    Free,
    /// A function of (t, y) that writes numbers.
    At {
        function: u8,
        room: u8,
        t: f64,
        y: Vec<f64>,
    },
    /// A function of (t, y) and further arguments.
    With {
        function: u8,
        room: u8,
        t: f64,
        y: Vec<f64>,
        index: u8,
    },
    Parameters {
        function: u8,
        index: u8,
        value: f64,
    },
    Bracket([String; 2], Vec<f64>),
    Print(i8),
    Theory(i8, u8),
    Emit(String, f64),
    Inventory(u8),
    Force {
        function: u8,
        good: u8,
    },
    Kernel {
        y: Vec<f64>,
        value: f64,
    },
}

#[derive(Clone, Debug)]
pub(crate) enum SolverCall {
    New { method: i8, t: f64, y: Vec<f64>, change: u8 },
    Advance(f64, u8),
    TakeParameters,
    Run(Vec<f64>, bool),
    Step(f64, u8),
    AddEvent { direction: i8, function: u8, good: u8 },
    AddSensitivity(u8, u8),
    Observe(u8),
    Occurrences(u8, u8, u8),
    Interpolate(f64, u8, u8),
    RunDense(f64),
    Read(u8),
    Checkpoint(String),
    Restore(u8, i8),
    Free,
}

fn texts() -> impl Strategy<Value = String> {
    prop_oneof![
        3 => like("[a-cxyω]'?"),
        3 => like("[a-cx0-9ω'(*+/^) -]{0,12}"),
        1 => like("[^\u{0}]{0,20}"),
        1 => Just("x^2/2".to_owned()),
        1 => Just("x'^2/2".to_owned()),
        1 => Just("so3".to_owned()),
        1 => like("[a-c+*(ω\u{202e}\u{0301}\u{feff}\u{1f}\"\\\\]{1000}"),
    ]
}

/// Texts that match an expression, which is parsed once.
fn like(expression: &str) -> impl Strategy<Value = String> + use<> {
    prop::string::string_regex(expression).unwrap()
}

/// Text as C may give it: any bytes but zero.
fn bytes() -> impl Strategy<Value = Vec<u8>> {
    prop::collection::vec(1u8.., 0..40)
}

fn numbers() -> impl Strategy<Value = f64> {
    prop_oneof![4 => -3.0..3.0, 1 => any::<f64>(), 1 => Just(0.0)]
}

fn state() -> impl Strategy<Value = Vec<f64>> {
    prop::collection::vec(numbers(), 0..8)
}

fn of_model() -> impl Strategy<Value = ModelCall> {
    use ModelCall::*;
    prop_oneof![
        2 => texts().prop_map(New),
        1 => prop::collection::vec(any::<u8>(), 0..60).prop_map(Parse),
        3 => any::<u8>().prop_map(Builtin),
        1 => bytes().prop_map(File),
        1 => Just(Clone),
        12 => (any::<u8>(), [texts(), texts(), texts()], numbers()).prop_map(|(f, texts, x)| Say(f, texts, x)),
        1 => (any::<u8>(), bytes()).prop_map(|(f, text)| Bytes(f, text)),
        3 => (any::<u8>(), texts(), -2i8..3).prop_map(|(f, a, d)| Event(f, a, d)),
        1 => Just(Text),
        1 => Just(Check),
        1 => Just(Free),
    ]
}

fn of_system() -> impl Strategy<Value = SystemCall> {
    use SystemCall::*;
    let at = || (any::<u8>(), any::<u8>(), numbers(), state());
    prop_oneof![
        4 => (-1i8..3).prop_map(New),
        1 => (-1i8..3, any::<u8>()).prop_map(|(form, change)| Code { form, change }),
        1 => Just(Clone),
        1 => Just(Free),
        6 => at().prop_map(|(function, room, t, y)| At { function, room, t, y }),
        4 => (at(), any::<u8>()).prop_map(|((function, room, t, y), index)| With { function, room, t, y, index }),
        2 => (any::<u8>(), any::<u8>(), numbers())
            .prop_map(|(function, index, value)| Parameters { function, index, value }),
        1 => ([texts(), texts()], state()).prop_map(|(texts, y)| Bracket(texts, y)),
        1 => (-1i8..4).prop_map(Print),
        // A theory with a degree takes long, so it is rare.
        1 => (-1i8..4, prop_oneof![8 => Just(0u8), 1 => Just(1u8), 1 => Just(2u8)]).prop_map(|(format, degree)| Theory(format, degree)),
        1 => (texts(), numbers()).prop_map(|(name, t)| Emit(name, t)),
        1 => any::<u8>().prop_map(Inventory),
        2 => (any::<u8>(), any::<u8>()).prop_map(|(function, good)| Force { function, good }),
        1 => (state(), numbers()).prop_map(|(y, value)| Kernel { y, value }),
    ]
}

fn of_solver() -> impl Strategy<Value = SolverCall> {
    use SolverCall::*;
    prop_oneof![
        2 => (-1i8..3, numbers(), state(), any::<u8>())
            .prop_map(|(method, t, y, change)| New { method, t, y, change }),
        3 => (numbers(), 0u8..8).prop_map(|(t, n)| Advance(t, n)),
        1 => Just(TakeParameters),
        2 => (prop::collection::vec(numbers(), 0..4), any::<bool>()).prop_map(|(t, s)| Run(t, s)),
        2 => (numbers(), 0u8..8).prop_map(|(t, n)| Step(t, n)),
        3 => (-2i8..3, any::<u8>(), any::<u8>())
            .prop_map(|(direction, function, good)| AddEvent { direction, function, good }),
        1 => (any::<u8>(), any::<u8>()).prop_map(|(parameter, length)| AddSensitivity(parameter, length)),
        1 => any::<u8>().prop_map(Observe),
        1 => (0u8..4, 0u8..8, 0u8..8).prop_map(|(e, n, m)| Occurrences(e, n, m)),
        1 => (numbers(), 0u8..8, any::<u8>()).prop_map(|(t, n, k)| Interpolate(t, n, k)),
        2 => numbers().prop_map(RunDense),
        1 => any::<u8>().prop_map(Read),
        1 => texts().prop_map(Checkpoint),
        2 => (any::<u8>(), -1i8..3).prop_map(|(change, m)| Restore(change, m)),
        1 => Just(Free),
    ]
}

/// A sequence of calls; most begin by making handles.
pub(crate) fn calls() -> impl Strategy<Value = Vec<Call>> {
    let one = prop_oneof![
        10 => of_model().prop_map(Call::Model),
        9 => of_system().prop_map(Call::System),
        9 => of_solver().prop_map(Call::Solver),
        1 => (numbers(), 0u8..8, any::<bool>()).prop_map(|(t, length, rate)| Call::Dense { t, length, rate }),
        1 => (any::<u8>(), any::<u8>(), state(), 0u8..4)
            .prop_map(|(which, threads, numbers, members)| Call::Ensemble { which, threads, numbers, members }),
        1 => any::<u8>().prop_map(Call::Nothing),
    ];
    let first = (any::<u8>(), 0i8..2, 0i8..2, 0u8..4).prop_map(|(model, form, method, length)| {
        let all = [
            Call::Model(ModelCall::Builtin(model)),
            Call::System(SystemCall::New(form)),
            Call::Solver(SolverCall::New { method, t: 0.0, y: vec![], change: 31 }),
        ];
        all[..usize::from(length)].to_vec()
    });
    (first, prop::collection::vec(one, 1..30)).prop_map(|(first, then)| [first, then].concat())
}
