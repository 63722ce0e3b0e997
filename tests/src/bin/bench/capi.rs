//! `bench capi`: one evaluation of ẏ = f(y) from Rust, and through the functions of libpc.

#![expect(unsafe_code, reason = "calls a C interface")]

use std::ffi::{CString, c_int, c_void};
use std::hint::black_box;
use std::ptr;

use pc::{pc_kernel, pc_status, pc_system};
use pc_mech::{Graph, VectorField};
use pc_model::{Builtin, Model};

use crate::error::Error;
use crate::measure::{Call, ROUNDS, Variant, interleave};
use crate::report::Report;

/// From the fewest operations to the most.
const MODELS: [&str; 4] = ["heavy-top-lagrange", "tilted-disk", "snakeboard", "pendulum-chain"];

type Rhs = unsafe extern "C" fn(f64, *const f64, *mut f64, *mut c_void) -> c_int;

/// Times all models; the last line is the worst ratios.
///
/// # Errors
/// [`Error::Refused`] if libpc refuses a call.
pub(crate) fn run(report: &mut Report) -> Result<(), Error> {
    report.line(format!(
        "ns a call: minimum, 10th percentile and median of {ROUNDS} rounds, in each of which every variant has one \
         turn of about 100 µs. `rust` is `Motion::rhs`, `handle` is `pc_system_rhs`, which checks lengths and \
         overlaps and that nobody changes the parameters meanwhile, `pointer` is `pc_kernel_rhs`, as integrators are given it. \
         `/ rust` is the median over the rounds of the ratio within a round.\n"
    ));
    report.columns(&["model", "variant", "min", "p10", "median", "/ rust"]);
    let mut worst = [0.0f64; 3];
    for name in MODELS {
        let document = Builtin::named(name).ok_or(Error::NoModel { name })?.document()?;
        let (graph, model) = (Graph::new(), Model::new(document));
        let (mut motion, start) = model.compile(&model.assemble(&graph)?)?;
        let handles = Handles::of(name)?;
        let rust = move |y: &[f64], dy: &mut [f64]| match motion.rhs(0.0, &y[..dy.len()], dy) {
            Ok(()) => {}
            Err(_) => dy.fill(f64::NAN),
        };
        let variants: [(&str, Box<Call<'_>>); 3] =
            [("rust", Box::new(rust)), ("handle", handles.by_handle()), ("pointer", handles.by_pointer())];
        let mut variants = variants.map(|(name, call)| Variant::new(name, call));
        let reference = variants[0].at(&start);
        for variant in &mut variants[1..] {
            if variant.at(&start) != reference {
                return Err(Error::Refused { call: "an evaluation of other numbers" });
            }
        }
        let times = interleave(&start, &mut variants);
        for ((variant, taken), worst) in variants.iter().zip(&times).zip(&mut worst) {
            let ratio = taken.ratio_to(&times[0]);
            *worst = worst.max(ratio);
            let numbers = [taken.min(), taken.p10(), taken.median()].map(|time| format!("{time:.1}"));
            let mut row = vec![name.to_owned(), variant.name.clone()];
            row.extend(numbers);
            row.push(format!("{ratio:.2}"));
            report.row(&row);
        }
    }
    report.line(format!("\nworst ratio to Rust: {:.2} by handle, {:.2} by pointer", worst[1], worst[2]));
    Ok(())
}

/// A model in libpc.
struct Handles {
    system: *mut pc_system,
    kernel: *mut pc_kernel,
}

impl Handles {
    fn of(name: &'static str) -> Result<Handles, Error> {
        let (mut model, mut system, mut kernel) =
            (ptr::null_mut::<pc::pc_model>(), ptr::null_mut(), ptr::null_mut());
        let text = CString::new(name).unwrap_or_default();
        // SAFETY: places for handles, a zero-terminated text, and null where the header allows it.
        let made = unsafe {
            pc::pc_model_builtin(text.as_ptr(), &raw mut model, ptr::null_mut()) == pc_status::PC_OK
                && pc::pc_system_new(model, ptr::null(), &raw mut system, ptr::null_mut()) == pc_status::PC_OK
                && pc::pc_kernel_new(system, &raw mut kernel, ptr::null_mut()) == pc_status::PC_OK
        };
        // SAFETY: null or ours, and not used again.
        unsafe { pc::pc_model_free(model) };
        let handles = Handles { system, kernel };
        if made { Ok(handles) } else { Err(Error::Refused { call: "the making of a kernel" }) }
    }

    fn by_handle(&self) -> Box<Call<'static>> {
        let (system, rhs) = (
            self.system.cast_const(),
            black_box(pc::pc_system_rhs as unsafe extern "C" fn(_, _, _, _, _, _, _) -> _),
        );
        Box::new(move |y, dy| {
            // SAFETY: a live system, arrays as long as its state, and null for the error.
            let status =
                unsafe { rhs(system, 0.0, y.as_ptr(), dy.len(), dy.as_mut_ptr(), dy.len(), ptr::null_mut()) };
            if status != pc_status::PC_OK {
                dy.fill(f64::NAN);
            }
        })
    }

    fn by_pointer(&self) -> Box<Call<'static>> {
        let (kernel, rhs) = (self.kernel.cast(), black_box(pc::pc_kernel_rhs as Rhs));
        Box::new(move |y, dy| {
            // SAFETY: a live kernel that only this thread uses, and arrays as long as its state.
            if unsafe { rhs(0.0, y.as_ptr(), dy.as_mut_ptr(), kernel) } != 0 {
                dy.fill(f64::NAN);
            }
        })
    }
}

impl Drop for Handles {
    fn drop(&mut self) {
        // SAFETY: ours, null if they were not made; the calls that have them are gone or are not made any more.
        unsafe {
            pc::pc_kernel_free(self.kernel);
            pc::pc_system_free(self.system);
        }
    }
}
