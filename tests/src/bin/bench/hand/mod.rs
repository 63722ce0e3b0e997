//! Right-hand sides as one writes them who knows the equations and wants them fast.
//!
//! Parameters are numbers, what several terms share is computed once, divisions by constants are products, and where
//! the processor has fused multiply-add, the functions are compiled for it.
#![expect(unsafe_code, reason = "a function compiled for some processors only is entered through `unsafe`")]

mod particle;
mod pendulum;
mod top;

pub(crate) use particle::{charged, relativistic};
pub(crate) use pendulum::{pendulum, pendulum_by_tensions};
pub(crate) use top::{euler, poisson, quaternion};

/// Writes ẏ(y).
pub(crate) type Hand = fn(&[f64], &mut [f64]);

/// a·b + c
#[inline(always)]
fn fma<const FMA: bool>(a: f64, b: f64, c: f64) -> f64 {
    if FMA { a.mul_add(b, c) } else { a * b + c }
}

/// The best compilation for this host of a function of `const FMA: bool` and further parameters.
macro_rules! for_this_host {
    ($function:ident $(, $argument:tt)*) => {{
        #[cfg(target_arch = "x86_64")]
        {
            #[target_feature(enable = "avx2,fma")]
            fn fused(y: &[f64], dy: &mut [f64]) {
                $function::<true $(, $argument)*>(y, dy);
            }
            if is_x86_feature_detected!("avx2") && is_x86_feature_detected!("fma") {
                // SAFETY: the processor has just been found to have both features.
                return |y, dy| unsafe { fused(y, dy) };
            }
        }
        if cfg!(target_arch = "aarch64") {
            $function::<true $(, $argument)*>
        } else {
            $function::<false $(, $argument)*>
        }
    }};
}
use for_this_host;
