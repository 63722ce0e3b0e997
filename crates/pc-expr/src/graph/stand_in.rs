//! Functions that take the place of undetermined ones in numbers.

/// The smooth function by which an undetermined function is replaced where numbers are needed,
///
///   f(x) = 2 + Σ_k a_k sin(ω_k·x + φ_k), k = 1, 2, a = (1, ½).
///
/// The frequencies ω and phases φ are fixed numbers without simple relations between them, different for each name. The
/// function is positive, and neither even, odd nor zero; no derivative vanishes identically. What is found at
/// points of a stand-in speaks of it alone: an inequality there disproves that something holds for every
/// function, an equality proves nothing.
///
/// ```
/// use pc_expr::StandIn;
/// let (v, w) = (StandIn::new("V", 1), StandIn::new("W", 1));
/// assert!(v.value(&[0], &[0.7]) > 0.5 && v.value(&[0], &[0.7]) != w.value(&[0], &[0.7]));
/// let slope = (v.value(&[0], &[0.7 + 1e-5]) - v.value(&[0], &[0.7 - 1e-5])) / 2e-5;
/// assert!((slope - v.value(&[1], &[0.7])).abs() < 1e-9);
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct StandIn {
    /// The two waves.
    pub waves: [Wave; 2],
}

/// a sin(ω·x + φ)
#[derive(Clone, Debug, PartialEq)]
pub struct Wave {
    /// a
    pub amplitude: f64,
    /// ω, one number for each argument.
    pub frequencies: Vec<f64>,
    /// φ
    pub phase: f64,
}

/// The least frequency; the greatest is below twice this number.
const SLOW: f64 = 0.7;

impl StandIn {
    /// The mean value, which makes the function positive.
    pub const LEVEL: f64 = 2.0;

    /// The stand-in for the function with this name and number of arguments.
    pub fn new(name: &str, arguments: usize) -> StandIn {
        // FNV-1a, then multiples of the golden ratio, whose fractional parts are as far from fractions as can be.
        let seed = name.bytes().fold(0xcbf2_9ce4_8422_2325_u64, |hash, byte| {
            (hash ^ u64::from(byte)).wrapping_mul(0x0100_0000_01b3)
        });
        let golden = (5f64.sqrt() - 1.0) / 2.0;
        let mut count = (seed % 10_000) as f64;
        let mut next = || {
            count += 1.0;
            (count * golden).fract()
        };
        let mut wave = |amplitude| Wave {
            amplitude,
            frequencies: (0..arguments).map(|_| SLOW * (1.0 + next())).collect(),
            phase: next(),
        };
        StandIn { waves: [wave(1.0), wave(0.5)] }
    }
}
