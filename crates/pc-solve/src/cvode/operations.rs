//! The operations of vectors that CVODES calls on each step.
//!
//! States of mechanics are short: for them the operations of SUNDIALS spend more time on telling cases apart than on
//! numbers. These compute the same formulas in the same order, so that each bit of the results is the same, four
//! components at a time. As in SUNDIALS, a result may overwrite an operand.

use std::ffi::c_int;

use sundials_sys as sys;

/// Makes a vector, and clones of it, use these operations.
///
/// # Safety
/// The vector is live, serial and used by nobody else.
pub(super) unsafe fn install(vector: sys::N_Vector) {
    // SAFETY: the table of a live vector, which is used by nobody else; clones copy it.
    let table = unsafe { &mut *(*vector).ops };
    #[cfg(target_arch = "x86_64")]
    if is_x86_feature_detected!("avx2") {
        table.nvlinearsum = Some(by_vectors::linear_sum);
        table.nvscale = Some(by_vectors::scale);
        table.nvwrmsnorm = Some(by_vectors::wrms_norm);
        table.nvlinearcombination = Some(by_vectors::linear_combination);
        table.nvscaleaddmulti = Some(by_vectors::scale_add_multi);
        return;
    }
    table.nvlinearsum = Some(portable::linear_sum);
    table.nvscale = Some(portable::scale);
    table.nvwrmsnorm = Some(portable::wrms_norm);
    table.nvlinearcombination = Some(portable::linear_combination);
    table.nvscaleaddmulti = Some(portable::scale_add_multi);
}

/// The operations as CVODES calls them, in functions with this attribute.
macro_rules! operations {
    ($name:ident, $(#[$attribute:meta])?) => {
        /// Operations on live serial vectors of equal lengths, which are the same ones or apart.
        mod $name {
            use super::*;

            $(#[$attribute])?
            pub(super) unsafe extern "C" fn linear_sum(
                a: f64,
                x: sys::N_Vector,
                b: f64,
                y: sys::N_Vector,
                z: sys::N_Vector,
            ) {
                // SAFETY: as CVODES calls operations.
                unsafe { super::linear_sum((a, Numbers::of(x)), (b, Numbers::of(y)), Numbers::of(z)) };
            }

            $(#[$attribute])?
            pub(super) unsafe extern "C" fn scale(c: f64, x: sys::N_Vector, z: sys::N_Vector) {
                // SAFETY: as CVODES calls operations.
                unsafe { Numbers::of(z).set(Numbers::of(x), Numbers::of(x), |x, _| c * x) };
            }

            $(#[$attribute])?
            pub(super) unsafe extern "C" fn wrms_norm(x: sys::N_Vector, w: sys::N_Vector) -> f64 {
                // SAFETY: as CVODES calls operations.
                unsafe { super::wrms_norm(Numbers::of(x), Numbers::of(w)) }
            }

            $(#[$attribute])?
            pub(super) unsafe extern "C" fn linear_combination(
                count: c_int,
                c: *mut f64,
                x: *mut sys::N_Vector,
                z: sys::N_Vector,
            ) -> sys::SUNErrCode {
                // SAFETY: as CVODES calls operations, with `count` numbers and vectors.
                unsafe {
                    let z = Numbers::of(z);
                    let first = *c;
                    z.set(Numbers::of(*x), Numbers::of(*x), |x, _| first * x);
                    for i in 1..count as usize {
                        let c = *c.add(i);
                        z.set(Numbers::of(*x.add(i)), z, |x, z| c * x + z);
                    }
                }
                0 // SUN_SUCCESS
            }

            $(#[$attribute])?
            pub(super) unsafe extern "C" fn scale_add_multi(
                count: c_int,
                a: *mut f64,
                x: sys::N_Vector,
                y: *mut sys::N_Vector,
                z: *mut sys::N_Vector,
            ) -> sys::SUNErrCode {
                // SAFETY: as CVODES calls operations, with `count` numbers and vectors.
                unsafe {
                    let x = Numbers::of(x);
                    for i in 0..count as usize {
                        let a = *a.add(i);
                        Numbers::of(*z.add(i)).set(x, Numbers::of(*y.add(i)), |x, y| a * x + y);
                    }
                }
                0 // SUN_SUCCESS
            }
        }
    };
}

operations!(portable,);
#[cfg(target_arch = "x86_64")]
operations!(by_vectors, #[target_feature(enable = "avx2")]);

/// z = a x + b y
///
/// # Safety
/// As for [`Numbers::set`].
#[inline(always)]
unsafe fn linear_sum((a, x): (f64, Numbers), (b, y): (f64, Numbers), z: Numbers) {
    // SAFETY: as promised.
    unsafe {
        if a == b {
            z.set(x, y, |x, y| a * (x + y));
        } else if a == -b {
            z.set(x, y, |x, y| a * (x - y));
        } else {
            z.set(x, y, |x, y| a * x + b * y);
        }
    }
}

/// √(Σ (xᵢ wᵢ)²/n)
///
/// # Safety
/// Vectors of equal lengths whose numbers are live.
#[inline(always)]
unsafe fn wrms_norm(x: Numbers, w: Numbers) -> f64 {
    let mut sum = 0.0;
    for i in 0..x.len {
        // SAFETY: within the numbers of both.
        let product = unsafe { *x.data.add(i) * *w.data.add(i) };
        sum += product * product;
    }
    (sum / x.len as f64).sqrt()
}

/// The numbers of a vector.
#[derive(Clone, Copy)]
struct Numbers {
    data: *mut f64,
    len: usize,
}

impl Numbers {
    /// # Safety
    /// The vector is live and serial.
    #[inline(always)]
    unsafe fn of(vector: sys::N_Vector) -> Numbers {
        // SAFETY: a serial vector has this layout.
        let content = unsafe { &*(*vector).content.cast::<sys::_N_VectorContent_Serial>() };
        Numbers { data: content.data, len: content.length as usize }
    }

    /// Sets each component to a function of those of two vectors, four at a time, then two, then one: loops over
    /// what is left would be compiled for long vectors.
    ///
    /// # Safety
    /// The numbers of all are live and of equal number; the operands are this vector or apart from it.
    #[inline(always)]
    unsafe fn set(self, x: Numbers, y: Numbers, f: impl Fn(f64, f64) -> f64) {
        for i in (0..self.len / 4).map(|block| 4 * block) {
            // SAFETY: within the numbers of each; all four are read before any is written.
            unsafe {
                let [a, b, c, d]: [f64; 4] = x.block(i);
                let [p, q, r, s]: [f64; 4] = y.block(i);
                self.data.add(i).cast::<[f64; 4]>().write([f(a, p), f(b, q), f(c, r), f(d, s)]);
            }
        }
        let mut i = self.len & !3;
        if self.len & 2 != 0 {
            // SAFETY: as above.
            unsafe {
                let ([a, b], [p, q]): ([f64; 2], [f64; 2]) = (x.block(i), y.block(i));
                self.data.add(i).cast::<[f64; 2]>().write([f(a, p), f(b, q)]);
            }
            i += 2;
        }
        if self.len & 1 != 0 {
            // SAFETY: as above.
            unsafe { *self.data.add(i) = f(*x.data.add(i), *y.data.add(i)) };
        }
    }

    /// The numbers from number `i` on.
    ///
    /// # Safety
    /// There are as many.
    #[inline(always)]
    unsafe fn block<const LEN: usize>(self, i: usize) -> [f64; LEN] {
        // SAFETY: within the numbers.
        unsafe { self.data.add(i).cast::<[f64; LEN]>().read() }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::cvode::context::Context;
    use crate::cvode::handles::Vector;

    /// Factors with cases of their own in SUNDIALS, and others.
    const FACTORS: [f64; 6] = [1.0, -1.0, 0.1, -0.1, 3.7, 0.0];

    /// Vectors whose sums round.
    fn vectors(context: &mut Context, len: usize) -> [Vector; 3] {
        let number = |i: usize, k: usize| ((7 * i + 3 * k + 1) as f64).sin() * 10f64.powi(i as i32 % 5 - 2);
        [0, 1, 2].map(|k| {
            let values: Vec<f64> = (0..len).map(|i| number(i, k)).collect();
            Vector::new(context, &values).expect("a vector")
        })
    }

    fn bits(vector: &Vector) -> Vec<u64> {
        vector.as_slice().iter().map(|x| x.to_bits()).collect()
    }

    /// The results are those of SUNDIALS, bit for bit, whether or not a result overwrites an operand.
    #[test]
    fn operations_are_those_of_sundials() {
        let mut context = Context::new().expect("a context");
        type Case = fn(f64, f64, [sys::N_Vector; 3], bool);
        // SAFETY: live vectors of one length.
        let cases: [Case; 6] = [
            |a, b, [x, y, z], ours| unsafe {
                if ours { sys::N_VLinearSum(a, x, b, y, z) } else { sys::N_VLinearSum_Serial(a, x, b, y, z) }
            },
            |a, b, [x, y, _], ours| unsafe {
                if ours { sys::N_VLinearSum(a, x, b, y, y) } else { sys::N_VLinearSum_Serial(a, x, b, y, y) }
            },
            |a, b, [x, y, _], ours| unsafe {
                if ours { sys::N_VLinearSum(a, x, b, y, x) } else { sys::N_VLinearSum_Serial(a, x, b, y, x) }
            },
            |a, _, [x, _, z], ours| unsafe {
                if ours { sys::N_VScale(a, x, z) } else { sys::N_VScale_Serial(a, x, z) }
            },
            |a, b, [x, y, z], ours| unsafe {
                let (mut c, mut of) = ([a, b, 0.3], [z, x, y]);
                let combine = if ours { sys::N_VLinearCombination } else { sys::N_VLinearCombination_Serial };
                combine(3, c.as_mut_ptr(), of.as_mut_ptr(), z);
            },
            |a, b, [x, y, z], ours| unsafe {
                let (mut c, mut of, mut to) = ([a, b], [y, z], [z, y]);
                let add = if ours { sys::N_VScaleAddMulti } else { sys::N_VScaleAddMulti_Serial };
                add(2, c.as_mut_ptr(), x, of.as_mut_ptr(), to.as_mut_ptr());
            },
        ];
        for len in [1, 3, 4, 5, 8, 11] {
            for a in FACTORS {
                for b in FACTORS {
                    for (case, run) in cases.iter().enumerate() {
                        let (ours, theirs) = (vectors(&mut context, len), vectors(&mut context, len));
                        run(a, b, ours.each_ref().map(Vector::raw), true);
                        run(a, b, theirs.each_ref().map(Vector::raw), false);
                        for (ours, theirs) in ours.iter().zip(&theirs) {
                            assert_eq!(bits(ours), bits(theirs), "case {case}: {a}, {b}, {len}");
                        }
                    }
                }
            }
            let [x, w, _] = vectors(&mut context, len);
            // SAFETY: live vectors of one length.
            let norms =
                unsafe { [sys::N_VWrmsNorm(x.raw(), w.raw()), sys::N_VWrmsNorm_Serial(x.raw(), w.raw())] };
            assert_eq!(norms[0].to_bits(), norms[1].to_bits());
        }
    }
}
