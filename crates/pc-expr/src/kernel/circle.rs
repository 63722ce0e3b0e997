//! Constants for sines and cosines: the parts of π/2, and the polynomials of the Cephes library.

/// 1.5·2⁵²: added to a small number, it leaves the nearest integer in the low bits.
pub(crate) const ROUNDING: f64 = 6_755_399_441_055_744.0;
/// π/2 as a sum.
pub(crate) const HALF_PI: [f64; 3] =
    [std::f64::consts::FRAC_PI_2, 6.123_233_995_736_766e-17, -1.497_384_904_859_169_8e-33];
/// (sin r − r)/r³ in powers of r², for |r| ≤ π/4.
pub(crate) const SIN: [f64; 6] = [
    -1.666_666_666_666_663e-1,
    8.333_333_333_322_118e-3,
    -1.984_126_982_958_954e-4,
    2.755_731_362_138_572_2e-6,
    -2.505_074_776_285_780_7e-8,
    1.589_623_015_765_465_6e-10,
];
/// (cos r − 1 + r²/2)/r⁴ in powers of r².
pub(crate) const COS: [f64; 6] = [
    4.166_666_666_666_659_5e-2,
    -1.388_888_888_887_305_6e-3,
    2.480_158_728_885_170_4e-5,
    -2.755_731_417_929_674e-7,
    2.087_570_084_197_473e-9,
    -1.135_853_652_138_768_2e-11,
];
