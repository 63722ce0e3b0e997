//! Calls of the library at random, and what they hand over.

use std::ffi::{c_int, c_void};

use pc::{pc_member, pc_status};
use proptest::prelude::*;

/// A call; numbers choose among what there is.
#[derive(Clone, Debug)]
pub(crate) enum Call {
    NewModel(String),
    Parse(Vec<u8>),
    Builtin(u8),
    Say(u8, String, String, f64),
    FreeModel,
    NewSystem(i8),
    CloneSystem,
    FreeSystem,
    Event(u8, String, i8),
    Text(u8, Vec<u8>),
    Evaluate(u8, u8, Vec<f64>),
    Parameter(u8, f64),
    Print(i8),
    Kernel,
    NewSolver(i8, f64, Vec<f64>),
    Advance(f64, u8),
    Run(Vec<f64>, bool),
    Step(f64, u8),
    AddEvent(i8, u8, u8),
    Observe(u8),
    Occurrences(u8, u8, u8),
    Interpolate(f64, u8, u8),
    RunDense(f64),
    Eval(f64, u8),
    Checkpoint(String),
    Restore(u8, i8),
    Ensemble(u8, u8, Vec<f64>, u8),
    FreeSolver,
}

fn texts() -> impl Strategy<Value = String> {
    prop_oneof![
        3 => "[a-cxyω]'?",
        3 => "[a-cx0-9ω'(*+/^) -]{0,12}",
        1 => "[^\u{0}]{0,20}",
        1 => Just("x^2/2".to_owned()),
        1 => Just("x'^2/2".to_owned()),
        1 => Just("so3".to_owned()),
        1 => prop::collection::vec("[a-c+*(ω\u{202e}\u{0301}\u{feff}\u{1f}\"\\\\]", 1000).prop_map(|all| all.concat()),
    ]
}

/// Text as C may give it: any bytes but zero.
fn bytes() -> impl Strategy<Value = Vec<u8>> {
    prop::collection::vec(1u8.., 0..40)
}

fn numbers() -> impl Strategy<Value = f64> {
    prop_oneof![4 => -3.0..3.0, 1 => any::<f64>(), 1 => Just(0.0)]
}

pub(crate) fn calls() -> impl Strategy<Value = Vec<Call>> {
    let state = || prop::collection::vec(numbers(), 0..8);
    let one = prop_oneof![
        2 => texts().prop_map(Call::NewModel),
        1 => prop::collection::vec(any::<u8>(), 0..60).prop_map(Call::Parse),
        3 => any::<u8>().prop_map(Call::Builtin),
        9 => (any::<u8>(), texts(), texts(), numbers()).prop_map(|(f, a, b, x)| Call::Say(f, a, b, x)),
        1 => Just(Call::FreeModel),
        3 => (-1i8..3).prop_map(Call::NewSystem),
        1 => Just(Call::CloneSystem),
        1 => Just(Call::FreeSystem),
        3 => (any::<u8>(), texts(), -2i8..3).prop_map(|(f, a, d)| Call::Event(f, a, d)),
        1 => (any::<u8>(), bytes()).prop_map(|(f, text)| Call::Text(f, text)),
        6 => (any::<u8>(), any::<u8>(), state()).prop_map(|(f, n, y)| Call::Evaluate(f, n, y)),
        2 => (any::<u8>(), numbers()).prop_map(|(i, x)| Call::Parameter(i, x)),
        1 => (-1i8..3).prop_map(Call::Print),
        1 => Just(Call::Kernel),
        2 => (-1i8..3, numbers(), state()).prop_map(|(m, t, y)| Call::NewSolver(m, t, y)),
        3 => (numbers(), 0u8..8).prop_map(|(t, n)| Call::Advance(t, n)),
        2 => (prop::collection::vec(numbers(), 0..4), any::<bool>()).prop_map(|(t, s)| Call::Run(t, s)),
        2 => (numbers(), 0u8..8).prop_map(|(t, n)| Call::Step(t, n)),
        3 => (-2i8..3, any::<u8>(), any::<u8>()).prop_map(|(d, f, u)| Call::AddEvent(d, f, u)),
        1 => any::<u8>().prop_map(Call::Observe),
        1 => (0u8..4, 0u8..8, 0u8..8).prop_map(|(e, n, m)| Call::Occurrences(e, n, m)),
        1 => (numbers(), 0u8..8, any::<u8>()).prop_map(|(t, n, k)| Call::Interpolate(t, n, k)),
        2 => numbers().prop_map(Call::RunDense),
        1 => (numbers(), 0u8..8).prop_map(|(t, n)| Call::Eval(t, n)),
        1 => texts().prop_map(Call::Checkpoint),
        2 => (any::<u8>(), -1i8..3).prop_map(|(change, m)| Call::Restore(change, m)),
        1 => (any::<u8>(), any::<u8>(), state(), 0u8..4).prop_map(|(f, n, y, m)| Call::Ensemble(f, n, y, m)),
        1 => Just(Call::FreeSolver),
    ];
    // In most, something to work with comes first.
    let first = (any::<u8>(), 0i8..2, 0i8..2, 0u8..4).prop_map(|(model, form, method, length)| {
        let all = [Call::Builtin(model), Call::NewSystem(form), Call::NewSolver(method, 0.0, vec![])];
        all[..usize::from(length)].to_vec()
    });
    (first, prop::collection::vec(one, 1..30)).prop_map(|(first, then)| [first, then].concat())
}

/// What the functions of an event do; it is freed with the solver.
pub(crate) struct Own {
    pub(crate) calls: usize,
    /// After how many calls the function fails, or writes nothing.
    pub(crate) good: usize,
    pub(crate) writes: bool,
    pub(crate) reset: c_int,
}

pub(crate) extern "C" fn value(
    t: f64,
    y: *const f64,
    y_length: usize,
    value: *mut f64,
    user: *mut c_void,
) -> c_int {
    // SAFETY: what `AddEvent` passes; the state is as long as said.
    unsafe {
        let own = &mut *user.cast::<Own>();
        own.calls += 1;
        if own.calls <= own.good {
            value.write(std::slice::from_raw_parts(y, y_length).iter().sum::<f64>() + (5.0 * t).sin());
            return 0;
        }
        c_int::from(own.writes)
    }
}

pub(crate) extern "C" fn reset(_t: f64, y: *mut f64, y_length: usize, user: *mut c_void) -> c_int {
    // SAFETY: what `AddEvent` passes; the state is as long as said.
    unsafe {
        std::slice::from_raw_parts_mut(y, y_length).iter_mut().for_each(|y| *y *= -0.9);
        (*user.cast::<Own>()).reset
    }
}

pub(crate) extern "C" fn destroy(user: *mut c_void) {
    // SAFETY: what `AddEvent` passes, once.
    drop(unsafe { Box::from_raw(user.cast::<Own>()) });
}

pub(crate) extern "C" fn observe_event(
    event: usize,
    _t: f64,
    before: *const f64,
    after: *const f64,
    y_length: usize,
    user: *mut c_void,
) -> c_int {
    assert!(!before.is_null() && !after.is_null() && y_length > 0);
    c_int::from(!user.is_null() && event == 1)
}

pub(crate) extern "C" fn observe_member(member: *const pc_member, user: *mut c_void) -> c_int {
    // SAFETY: as documented.
    let member = unsafe { &*member };
    assert_eq!(member.message.is_null(), matches!(member.status, pc_status::PC_OK | pc_status::PC_EVENT));
    assert_ne!(member.status, pc_status::PC_INTERNAL);
    c_int::from(!user.is_null() && member.number == 1)
}
