//! Work through the C interface whose instructions are counted: each row is a function, which a profiler finds by its name.
//!
//! Prints a line for each row: its name, and of how many calls or steps it consists.

#![expect(unsafe_code, reason = "calls a C interface, and functions with names that profilers see")]

use std::hint::black_box;

use pc::pc_method;
use pc_tests::through_c::{self, Handles, Subject};

/// Evaluations in a row.
const CALLS: u32 = 200;
const TOLERANCE: (f64, f64) = (1e-9, 1e-12);

/// What a row needs, made before it begins.
struct Work {
    handles: Handles,
    subject: Subject,
    method: fn() -> pc_method,
}

impl Work {
    fn of(subject: Subject, method: fn() -> pc_method) -> Option<Work> {
        Some(Work { handles: Handles::of(&subject.text)?, subject, method })
    }

    /// Evaluates f again and again; the number of calls, or none where f fails.
    fn evaluate(&self) -> Option<u64> {
        let (rhs, kernel) = self.handles.pointers();
        let start = &self.subject.start;
        let mut rates = vec![0.0; start.len()];
        for _ in 0..CALLS {
            // SAFETY: a live kernel that only this thread uses, and arrays as long as its state.
            let status = unsafe { rhs(0.0, black_box(start.as_ptr()), rates.as_mut_ptr(), kernel) };
            if status != 0 {
                return None;
            }
        }
        Some(CALLS.into())
    }

    /// Integrates a tenth of the motion; the number of steps.
    fn integrate(&self) -> Option<u64> {
        let Subject { start, end, .. } = &self.subject;
        let (_, steps) = self.handles.integrate((self.method)(), TOLERANCE, start, end / 10.0)?;
        Some(steps)
    }
}

/// Functions of these names, and a table of them.
macro_rules! rows {
    ($($name:ident: $subject:expr, $method:ident, $work:ident;)*) => {
        $(
            #[unsafe(no_mangle)]
            #[inline(never)]
            extern "C" fn $name(work: &Work, units: &mut Option<u64>) {
                *units = work.$work();
            }
        )*

        /// Prepares and does each row: the first time compiles what the second, which counts, only runs.
        fn all() -> bool {
            $(
                let Some(work) = Work::of($subject, || pc_method::$method) else { return false };
                if work.$work().is_none() {
                    return false;
                }
                let mut units = None;
                black_box($name as extern "C" fn(&Work, &mut Option<u64>))(&work, &mut units);
                match units {
                    Some(units) => println!("{} {units}", stringify!($name)),
                    None => return false,
                }
            )*
            true
        }
    };
}

rows! {
    rates_of_top: through_c::top(), PC_DOP853, evaluate;
    rates_of_sleigh: through_c::sleigh(), PC_DOP853, evaluate;
    rates_of_disk: through_c::disk(), PC_DOP853, evaluate;
    rates_of_2_links: through_c::pendulum(2), PC_DOP853, evaluate;
    rates_of_4_links: through_c::pendulum(4), PC_DOP853, evaluate;
    rates_of_8_links: through_c::pendulum(8), PC_DOP853, evaluate;
    rates_of_16_masses: through_c::chain_of_masses(16), PC_DOP853, evaluate;
    dop853_on_top: through_c::top(), PC_DOP853, integrate;
    dop853_on_disk: through_c::disk_by_definitions(), PC_DOP853, integrate;
    adams_on_top: through_c::top(), PC_ADAMS, integrate;
    adams_on_disk: through_c::disk_by_definitions(), PC_ADAMS, integrate;
    bdf_on_sleigh: through_c::stiff_sleigh(), PC_BDF, integrate;
    taylor_on_top: through_c::top(), PC_TAYLOR, integrate;
}

fn main() {
    if !all() {
        eprintln!("libpc refused a call");
        std::process::exit(1);
    }
}
