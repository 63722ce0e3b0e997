//! The return codes of CVODES.

use std::fmt;

macro_rules! codes {
    ($($variant:ident = $name:ident ($number:literal), $doc:literal;)*) => {
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
                    $(Code::$variant => $number,)*
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

        impl From<i32> for Code {
            fn from(number: i32) -> Self {
                match number {
                    $($number => Code::$variant,)*
                    number => Code::Unknown(number),
                }
            }
        }

        #[cfg(all(test, feature = "cvode"))]
        const THEIRS: &[(Code, i32)] = &[$((Code::$variant, sundials_sys::$name)),*];
    };
}

codes! {
    TooMuchWork = CV_TOO_MUCH_WORK (-1), "more internal steps than allowed before the next output.";
    TooMuchAccuracy = CV_TOO_MUCH_ACC (-2), "the tolerances are below rounding error.";
    ErrorFailure = CV_ERR_FAILURE (-3), "error tests failed repeatedly, or at the least step.";
    ConvergenceFailure = CV_CONV_FAILURE (-4), "the nonlinear iteration failed repeatedly, or at the least step.";
    LinearInit = CV_LINIT_FAIL (-5), "the linear solver could not be initialised.";
    LinearSetup = CV_LSETUP_FAIL (-6), "the linear solver, or the Jacobian, failed fatally.";
    LinearSolve = CV_LSOLVE_FAIL (-7), "the linear solve failed fatally.";
    RhsFatal = CV_RHSFUNC_FAIL (-8), "the right-hand side failed fatally.";
    RhsFirst = CV_FIRST_RHSFUNC_ERR (-9), "the right-hand side failed at the start.";
    RhsRepeated = CV_REPTD_RHSFUNC_ERR (-10), "the right-hand side kept failing at ever smaller steps.";
    RhsUnrecovered = CV_UNREC_RHSFUNC_ERR (-11), "the right-hand side failed where no smaller step helps.";
    RootFunction = CV_RTFUNC_FAIL (-12), "a root function failed.";
    NonlinearInit = CV_NLS_INIT_FAIL (-13), "the nonlinear solver could not be initialised.";
    NonlinearSetup = CV_NLS_SETUP_FAIL (-14), "the nonlinear solver could not be set up.";
    Constraint = CV_CONSTR_FAIL (-15), "the inequality constraints could not be satisfied.";
    Nonlinear = CV_NLS_FAIL (-16), "the nonlinear solver failed fatally.";
    Memory = CV_MEM_FAIL (-20), "out of memory.";
    NoMemory = CV_MEM_NULL (-21), "no solver memory.";
    IllegalInput = CV_ILL_INPUT (-22), "an input, or an error weight, is not legal.";
    NotAllocated = CV_NO_MALLOC (-23), "the solver memory was not initialised.";
    BadOrder = CV_BAD_K (-24), "a derivative of that order cannot be interpolated.";
    BadTime = CV_BAD_T (-25), "the time is outside the last step.";
    BadVector = CV_BAD_DKY (-26), "no vector for the interpolated values.";
    TooClose = CV_TOO_CLOSE (-27), "the first output is too close to the start.";
    VectorOperation = CV_VECTOROP_ERR (-28), "a vector operation failed.";
    NoQuadrature = CV_NO_QUAD (-30), "quadratures are not set up.";
    QuadratureFatal = CV_QRHSFUNC_FAIL (-31), "the integrand failed fatally.";
    QuadratureFirst = CV_FIRST_QRHSFUNC_ERR (-32), "the integrand failed at the start.";
    QuadratureRepeated = CV_REPTD_QRHSFUNC_ERR (-33), "the integrand kept failing.";
    QuadratureUnrecovered = CV_UNREC_QRHSFUNC_ERR (-34), "the integrand failed where no smaller step helps.";
    NoSensitivity = CV_NO_SENS (-40), "sensitivities are not set up.";
    SensitivityFatal = CV_SRHSFUNC_FAIL (-41), "the sensitivity equations failed fatally.";
    SensitivityFirst = CV_FIRST_SRHSFUNC_ERR (-42), "the sensitivity equations failed at the start.";
    SensitivityRepeated = CV_REPTD_SRHSFUNC_ERR (-43), "the sensitivity equations kept failing.";
    SensitivityUnrecovered = CV_UNREC_SRHSFUNC_ERR (-44), "the sensitivity equations failed where no smaller step helps.";
    BadSensitivity = CV_BAD_IS (-45), "no sensitivity of that index.";
    NoQuadratureSensitivity = CV_NO_QUADSENS (-50), "sensitivities of quadratures are not set up.";
    QuadratureSensitivityFatal = CV_QSRHSFUNC_FAIL (-51), "the sensitivity of the integrand failed fatally.";
    QuadratureSensitivityFirst = CV_FIRST_QSRHSFUNC_ERR (-52), "the sensitivity of the integrand failed at the start.";
    QuadratureSensitivityRepeated = CV_REPTD_QSRHSFUNC_ERR (-53), "the sensitivity of the integrand kept failing.";
    QuadratureSensitivityUnrecovered = CV_UNREC_QSRHSFUNC_ERR (-54), "the sensitivity of the integrand failed where no smaller step helps.";
    Context = CV_CONTEXT_ERR (-55), "the SUNDIALS context is not valid.";
    NoProjection = CV_PROJ_MEM_NULL (-56), "the projection is not set up.";
    ProjectionFatal = CV_PROJFUNC_FAIL (-57), "the projection failed fatally.";
    ProjectionRepeated = CV_REPTD_PROJFUNC_ERR (-58), "the projection kept failing.";
    BadInterpolation = CV_BAD_TINTERP (-59), "the time is outside what the checkpoints cover.";
    Unrecognized = CV_UNRECOGNIZED_ERR (-99), "an error CVODES does not recognise.";
    NoAdjoint = CV_NO_ADJ (-101), "the adjoint problem is not set up.";
    NoForward = CV_NO_FWD (-102), "no forward integration was made.";
    NoBackward = CV_NO_BCK (-103), "no backward problem is set up.";
    BadBackwardStart = CV_BAD_TB0 (-104), "the backward problem starts outside the forward interval.";
    ForwardRestart = CV_REIFWD_FAIL (-105), "the forward problem could not be restarted at a checkpoint.";
    Forward = CV_FWD_FAIL (-106), "the forward integration from a checkpoint failed.";
    BadCheckpointTime = CV_GETY_BADT (-107), "the forward solution cannot be interpolated at that time.";
}

impl fmt::Display for Code {
    /// `NAME (number)`.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{} ({})", self.name(), self.number())
    }
}

#[cfg(all(test, feature = "cvode"))]
mod tests {
    use super::*;
    use std::ffi::CStr;
    use sundials_sys as sys;

    #[test]
    fn numbers_are_those_of_cvodes() {
        for &(code, number) in THEIRS {
            assert_eq!(code.number(), number, "{code}");
        }
    }

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
            // CVodeGetReturnFlagName knows fewer codes than cvodes.h and answers NONE for the
            // others.
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
