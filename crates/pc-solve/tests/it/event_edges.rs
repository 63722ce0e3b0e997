//! Events whose functions jump, have poles, or have no value beyond an edge.

use crate::boxed::erased;
use crate::fields::{ProgramEvents, field};
use pc_expr::{Expr, Graph, Inputs, Program, ProgramField};
use pc_solve::{Ending, Event, FnEvents, Method, Options, Reason, Solution, Solve, SolveError};

/// y = t.
fn clock() -> ProgramField {
    field(|_, [_y]| [1.0.into()])
}

fn of_clock(function: impl for<'g> Fn(Expr<'g>) -> Expr<'g>) -> Program {
    let graph = Graph::new();
    let y = graph.symbol("y");
    let inputs = Inputs { time: None, state: vec![y], parameters: Vec::new() };
    Program::new(&graph, &inputs, &[function(y)]).unwrap()
}

/// The motion up to `end` with one event, given as a program.
fn programmed(
    method: Method,
    event: Event,
    end: f64,
    function: impl for<'g> Fn(Expr<'g>) -> Expr<'g>,
) -> Result<Solution, SolveError> {
    let events = ProgramEvents::with(of_clock(function), vec![(event, None)]);
    let options = Options::new(method);
    Solve::new(erased(clock()), 0.0, &[0.0]).method(options).events(events).run(&[end]).map_err(|e| e.error)
}

/// The same, given as a closure.
fn called(
    method: Method,
    event: Event,
    end: f64,
    function: impl Fn(f64) -> f64,
) -> Result<Solution, SolveError> {
    let events = FnEvents::new().with(event, move |_, y| Ok(function(y[0])));
    let options = Options::new(method).max_step(0.3);
    Solve::new(erased(clock()), 0.0, &[0.0]).method(options).events(events).run(&[end]).map_err(|e| e.error)
}

#[track_caller]
fn assert_times(found: &Solution, expected: &[f64], of: &str) {
    let times: Vec<f64> = found.occurrences.iter().map(|occurrence| occurrence.time).collect();
    let is_near = times.iter().zip(expected).all(|(a, b)| (a - b).abs() <= 1e-12);
    assert!(times.len() == expected.len() && is_near, "{of}: {times:?} is not {expected:?}");
}

/// Places that the samples of some steps meet exactly, where the functions are infinite.
#[test]
fn poles_that_are_met_exactly_are_passed() {
    for method in Method::ALL {
        for at in [0.25, 0.5, 0.75, 1.0, 1.2, 1.5] {
            let of = format!("{method}, pole at {at}");
            let event = || Event::new("a");
            let odd = programmed(method, event(), 2.0, |y| 1.0 / (y - at)).unwrap();
            assert_times(&odd, &[], &of);
            let cubic = programmed(method, event(), 2.0, |y| 1.0 / (y - at).powi(3)).unwrap();
            assert_times(&cubic, &[], &of);
            let both = programmed(method, event(), 2.0, |y| (y - 1.75) / (y - at)).unwrap();
            assert_times(&both, &[1.75], &of);
            let even = programmed(method, event(), 2.0, |y| 1.0 / (y - at).powi(2) - 4.0).unwrap();
            let zeros: Vec<f64> = [at - 0.5, at + 0.5].into_iter().filter(|t| *t > 0.0 && *t < 2.0).collect();
            if at < 1.5 {
                assert_times(&even, &zeros, &of);
            }
            let odd = called(method, event(), 2.0, |y| 1.0 / (y - at)).unwrap();
            assert_times(&odd, &[], &of);
            let both = called(method, event(), 2.0, |y| (y - 1.75) / (y - at)).unwrap();
            assert_times(&both, &[1.75], &of);
        }
    }
}

/// √(1 − y) − 0.3 is zero at 0.91, ln(1 − y) + 2 at 1 − e⁻²; beyond 1 they have no value.
#[test]
fn a_terminal_zero_before_an_edge_ends_the_motion() {
    for method in Method::ALL {
        let last = || Event::new("a").terminal(true);
        let root = 1.0 - (-2.0_f64).exp();
        for (found, zero) in [
            (programmed(method, last(), 3.0, |y| (1.0 - y).sqrt() - 0.3), 0.91),
            (programmed(method, last(), 3.0, |y| (1.0 - y).log() + 2.0), root),
            (called(method, last(), 3.0, |y| (1.0 - y).sqrt() - 0.3), 0.91),
            (called(method, last(), 3.0, |y| (1.0 - y).ln() + 2.0), root),
        ] {
            let found = found.unwrap();
            assert_times(&found, &[zero], &method.to_string());
            assert_eq!(found.ending, Some(Ending::Event { event: 0 }), "{method}");
        }
    }
}

/// Without an end at the zero, what the function is beyond the edge is not known.
#[test]
fn an_event_without_a_value_is_an_error_after_its_zeros() {
    for method in Method::ALL {
        let mut occurred = 0;
        let events = ProgramEvents::new(of_clock(|y| (1.0 - y).sqrt() - 0.3));
        let begun = Solve::new(erased(clock()), 0.0, &[0.0]).method(Options::new(method)).events(events);
        let failure = begun.run(&[3.0]).unwrap_err();
        occurred += failure.reached.occurrences.len();
        let SolveError::Integration(error) = &failure.error else { panic!("{}", failure.error) };
        assert_eq!(occurred, 1, "{method}");
        let Reason::Event { event, t } = &error.reason else { panic!("{error}") };
        assert!(event == "g0" && (t - 1.0).abs() < 1e-9, "{method}: {error}");
    }
}

/// A generator of numbers in [0, 1) [Steele, Lea, Flood 2014].
struct Random(u64);

impl Random {
    fn next(&mut self) -> f64 {
        self.0 = self.0.wrapping_add(0x9E37_79B9_7F4A_7C15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
        ((z ^ (z >> 31)) >> 11) as f64 / (1u64 << 53) as f64
    }

    /// Of either sign, between 1/4 and 1 times 10 to some power.
    fn value(&mut self) -> f64 {
        let size = (0.25 + 0.75 * self.next()) * 10.0_f64.powi((self.next() * 5.0) as i32 - 2);
        if self.next() < 0.5 { size } else { -size }
    }
}

/// A function of straight pieces that jumps between them.
struct Pieces {
    /// The starts of the pieces but the first, ascending.
    jumps: Vec<f64>,
    /// The values at the ends of each piece.
    ends: Vec<(f64, f64)>,
}

impl Pieces {
    fn random(random: &mut Random) -> Pieces {
        let count = 1 + (random.next() * 5.0) as usize;
        let place = |i: usize, random: &mut Random| (i as f64 + 0.1 + 0.8 * random.next()) / count as f64;
        let jumps: Vec<f64> = (0..count).map(|i| place(i, random)).collect();
        let ends = (0..=count).map(|_| (random.value(), random.value())).collect();
        Pieces { jumps, ends }
    }

    fn span(&self, k: usize) -> (f64, f64) {
        let start = if k == 0 { 0.0 } else { self.jumps[k - 1] };
        (start, self.jumps.get(k).copied().unwrap_or(1.0))
    }

    /// The line of a piece: its value at 0, and its slope.
    fn line(&self, k: usize) -> (f64, f64) {
        let ((start, end), (from, to)) = (self.span(k), self.ends[k]);
        let slope = (to - from) / (end - start);
        (from - slope * start, slope)
    }

    fn value(&self, y: f64) -> f64 {
        let (level, slope) = self.line(self.jumps.partition_point(|jump| *jump <= y));
        level + slope * y
    }

    fn expression<'g>(&self, y: Expr<'g>) -> Expr<'g> {
        let line = |k: usize| {
            let (level, slope) = self.line(k);
            level + slope * y
        };
        let last = line(self.jumps.len());
        (0..self.jumps.len()).rev().fold(last, |after, k| (y - self.jumps[k]).step(after, line(k)))
    }

    fn zeros(&self) -> Vec<f64> {
        let mut zeros = Vec::new();
        for k in 0..self.ends.len() {
            let ((start, end), (from, to)) = (self.span(k), self.ends[k]);
            if k > 0 && self.ends[k - 1].1 * from < 0.0 {
                zeros.push(start);
            }
            if from * to < 0.0 {
                zeros.push(start + (end - start) * from / (from - to));
            }
        }
        zeros
    }
}

/// 300 functions by each method, as programs, and as closures where their zeros are farther apart
/// than the samples.
#[test]
fn each_jump_and_each_zero_is_passed_once() {
    let mut random = Random(37);
    let mut passed = 0;
    for case in 0..300 {
        let pieces = Pieces::random(&mut random);
        let zeros = pieces.zeros();
        passed += zeros.len();
        for method in Method::ALL {
            let found = programmed(method, Event::new("a"), 1.0, |y| pieces.expression(y)).unwrap();
            assert_times(&found, &zeros, &format!("{method}, program {case}"));
            if zeros.windows(2).any(|pair| pair[1] - pair[0] < 5e-3) {
                continue;
            }
            let options = Options::new(method).max_step(0.01);
            let events = FnEvents::new().with(Event::new("a"), |_, y| Ok(pieces.value(y[0])));
            let begun = Solve::new(erased(clock()), 0.0, &[0.0]).method(options).events(events);
            assert_times(&begun.run(&[1.0]).unwrap(), &zeros, &format!("{method}, closure {case}"));
        }
    }
    assert!(passed > 600, "{passed}");
}
