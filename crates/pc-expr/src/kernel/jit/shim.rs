//! The elementary functions for compiled code: [`Function::eval`] under the C calling convention.

use crate::graph::function::Function;

macro_rules! shims {
    ($($variant:ident $name:ident ($($arg:ident),+);)+) => {
        $(
            extern "C" fn $name($($arg: f64),+) -> f64 {
                Function::$variant.eval(&[$($arg),+])
            }
        )+

        /// The address of the shim of a function; arguments and result are of type `f64`.
        pub(super) fn address(function: Function) -> usize {
            match function {
                $(Function::$variant => $name as *const () as usize,)+
            }
        }
    };
}

shims! {
    Sin sin(x);
    Cos cos(x);
    Asin asin(x);
    Acos acos(x);
    Atan atan(x);
    Atan2 atan2(y, x);
    Sinh sinh(x);
    Cosh cosh(x);
    Tanh tanh(x);
    Exp exp(x);
    Log log(x);
    Sqrt sqrt(x);
    Abs abs(x);
    Sign sign(x);
    Min min(x, y);
    Max max(x, y);
    Step step(x, a, b);
    Pow pow(x, y);
}

/// The address of a function of three arguments, a·b + c rounded once.
pub(super) fn multiply_add_address() -> usize {
    extern "C" fn multiply_add(a: f64, b: f64, c: f64) -> f64 {
        a.mul_add(b, c)
    }
    multiply_add as *const () as usize
}

/// The address of a function of x and a pointer, to which it writes (sin x, cos x).
pub(super) fn circle_address() -> usize {
    extern "C" fn circle(x: f64, place: *mut [f64; 2]) {
        // SAFETY: compiled code passes the address of two numbers on its stack.
        unsafe { *place = [x.sin(), x.cos()] };
    }
    circle as *const () as usize
}
