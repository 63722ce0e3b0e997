//! The return codes of CVODES.

use std::ffi::c_int;
use std::fmt;

use sundials_sys as sys;

macro_rules! codes {
    ($($variant:ident = $name:ident, $doc:literal;)*) => {
        /// A return code of CVODES that means failure, with its number and name (`cvodes.h`).
        #[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
        #[non_exhaustive]
        pub enum Code {
            $(#[doc = concat!("`", stringify!($name), "`: ", $doc)] $variant,)*
            /// A number `cvodes.h` does not define.
            Unknown(i32),
        }

        impl Code {
            /// The number CVODES returned.
            pub fn number(self) -> i32 {
                match self {
                    $(Code::$variant => sys::$name,)*
                    Code::Unknown(number) => number,
                }
            }

            /// The name of the number in `cvodes.h`.
            pub fn name(self) -> &'static str {
                match self {
                    $(Code::$variant => stringify!($name),)*
                    Code::Unknown(_) => "unknown code",
                }
            }
        }

        impl From<c_int> for Code {
            fn from(number: c_int) -> Self {
                match number {
                    $(sys::$name => Code::$variant,)*
                    number => Code::Unknown(number),
                }
            }
        }
    };
}

codes! {
    TooMuchWork = CV_TOO_MUCH_WORK, "more internal steps than allowed before the next output.";
    TooMuchAccuracy = CV_TOO_MUCH_ACC, "the tolerances are below rounding error.";
    ErrorFailure = CV_ERR_FAILURE, "error tests failed repeatedly, or at the least step.";
    ConvergenceFailure = CV_CONV_FAILURE, "the nonlinear iteration failed repeatedly, or at the least step.";
    LinearInit = CV_LINIT_FAIL, "the linear solver could not be initialised.";
    LinearSetup = CV_LSETUP_FAIL, "the linear solver, or the Jacobian, failed fatally.";
    LinearSolve = CV_LSOLVE_FAIL, "the linear solve failed fatally.";
    RhsFatal = CV_RHSFUNC_FAIL, "the right-hand side failed fatally.";
    RhsFirst = CV_FIRST_RHSFUNC_ERR, "the right-hand side failed at the start.";
    RhsRepeated = CV_REPTD_RHSFUNC_ERR, "the right-hand side kept failing at ever smaller steps.";
    RhsUnrecovered = CV_UNREC_RHSFUNC_ERR, "the right-hand side failed where no smaller step helps.";
    RootFunction = CV_RTFUNC_FAIL, "a root function failed.";
    NonlinearInit = CV_NLS_INIT_FAIL, "the nonlinear solver could not be initialised.";
    NonlinearSetup = CV_NLS_SETUP_FAIL, "the nonlinear solver could not be set up.";
    Constraint = CV_CONSTR_FAIL, "the inequality constraints could not be satisfied.";
    Nonlinear = CV_NLS_FAIL, "the nonlinear solver failed fatally.";
    Memory = CV_MEM_FAIL, "out of memory.";
    NoMemory = CV_MEM_NULL, "no solver memory.";
    IllegalInput = CV_ILL_INPUT, "an input, or an error weight, is not legal.";
    NotAllocated = CV_NO_MALLOC, "the solver memory was not initialised.";
    BadOrder = CV_BAD_K, "a derivative of that order cannot be interpolated.";
    BadTime = CV_BAD_T, "the time is outside the last step.";
    BadVector = CV_BAD_DKY, "no vector for the interpolated values.";
    TooClose = CV_TOO_CLOSE, "the first output is too close to the start.";
    VectorOperation = CV_VECTOROP_ERR, "a vector operation failed.";
    NoQuadrature = CV_NO_QUAD, "quadratures are not set up.";
    QuadratureFatal = CV_QRHSFUNC_FAIL, "the integrand failed fatally.";
    QuadratureFirst = CV_FIRST_QRHSFUNC_ERR, "the integrand failed at the start.";
    QuadratureRepeated = CV_REPTD_QRHSFUNC_ERR, "the integrand kept failing.";
    QuadratureUnrecovered = CV_UNREC_QRHSFUNC_ERR, "the integrand failed where no smaller step helps.";
    NoSensitivity = CV_NO_SENS, "sensitivities are not set up.";
    SensitivityFatal = CV_SRHSFUNC_FAIL, "the sensitivity equations failed fatally.";
    SensitivityFirst = CV_FIRST_SRHSFUNC_ERR, "the sensitivity equations failed at the start.";
    SensitivityRepeated = CV_REPTD_SRHSFUNC_ERR, "the sensitivity equations kept failing.";
    SensitivityUnrecovered = CV_UNREC_SRHSFUNC_ERR, "the sensitivity equations failed where no smaller step helps.";
    BadSensitivity = CV_BAD_IS, "no sensitivity of that index.";
    NoQuadratureSensitivity = CV_NO_QUADSENS, "sensitivities of quadratures are not set up.";
    QuadratureSensitivityFatal = CV_QSRHSFUNC_FAIL, "the sensitivity of the integrand failed fatally.";
    QuadratureSensitivityFirst = CV_FIRST_QSRHSFUNC_ERR, "the sensitivity of the integrand failed at the start.";
    QuadratureSensitivityRepeated = CV_REPTD_QSRHSFUNC_ERR, "the sensitivity of the integrand kept failing.";
    QuadratureSensitivityUnrecovered = CV_UNREC_QSRHSFUNC_ERR, "the sensitivity of the integrand failed where no smaller step helps.";
    Context = CV_CONTEXT_ERR, "the SUNDIALS context is not valid.";
    NoProjection = CV_PROJ_MEM_NULL, "the projection is not set up.";
    ProjectionFatal = CV_PROJFUNC_FAIL, "the projection failed fatally.";
    ProjectionRepeated = CV_REPTD_PROJFUNC_ERR, "the projection kept failing.";
    BadInterpolation = CV_BAD_TINTERP, "the time is outside what the checkpoints cover.";
    Unrecognized = CV_UNRECOGNIZED_ERR, "an error CVODES does not recognise.";
    NoAdjoint = CV_NO_ADJ, "the adjoint problem is not set up.";
    NoForward = CV_NO_FWD, "no forward integration was made.";
    NoBackward = CV_NO_BCK, "no backward problem is set up.";
    BadBackwardStart = CV_BAD_TB0, "the backward problem starts outside the forward interval.";
    ForwardRestart = CV_REIFWD_FAIL, "the forward problem could not be restarted at a checkpoint.";
    Forward = CV_FWD_FAIL, "the forward integration from a checkpoint failed.";
    BadCheckpointTime = CV_GETY_BADT, "the forward solution cannot be interpolated at that time.";
}

impl fmt::Display for Code {
    /// `NAME (number)`.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{} ({})", self.name(), self.number())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::ffi::CStr;

    #[test]
    fn names_are_those_of_cvodes() {
        for number in -110..0 {
            // SAFETY: returns a string from malloc for any number.
            let theirs = unsafe { sys::CVodeGetReturnFlagName(number.into()) };
            // SAFETY: it is a C string.
            let name = unsafe { CStr::from_ptr(theirs) }.to_str().unwrap().to_owned();
            // SAFETY: allocated by the C library's malloc, not used again.
            unsafe { free(theirs.cast()) };
            let code = Code::from(number);
            assert_eq!(code.number(), number);
            // CVodeGetReturnFlagName knows fewer codes than cvodes.h and answers NONE for the others.
            if name != "NONE" {
                assert_eq!(code.name(), name);
            }
        }
        assert_eq!(Code::from(-1).to_string(), "CV_TOO_MUCH_WORK (-1)");
        assert_eq!(Code::from(-77), Code::Unknown(-77));
        assert_eq!(Code::from(-77).to_string(), "unknown code (-77)");
    }

    unsafe extern "C" {
        fn free(pointer: *mut std::ffi::c_void);
    }
}
