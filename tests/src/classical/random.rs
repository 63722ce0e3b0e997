//! Random numbers of the tests, the same everywhere.

#![allow(dead_code, unreachable_pub, reason = "a module of tests of other crates, which take what they need")]

/// A small generator of random numbers: a counter, well mixed [Steele, Lea and Flood 2014, SplitMix64].
#[derive(Clone, Debug)]
pub struct SplitMix64(u64);

impl SplitMix64 {
    /// The generator that starts from `seed`; the same seed gives the same numbers on every machine.
    pub fn new(seed: u64) -> Self {
        SplitMix64(seed)
    }

    /// The next 64 bits.
    pub fn next_bits(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ (z >> 31)
    }

    /// One of 0..count.
    pub fn below(&mut self, count: usize) -> usize {
        (self.next_bits() % count as u64) as usize
    }

    /// Uniform in [low, high).
    pub fn uniform(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * ((self.next_bits() >> 11) as f64 / (1u64 << 53) as f64)
    }

    /// Normal with mean 0 and variance 1 [Box and Muller 1958].
    pub fn normal(&mut self) -> f64 {
        let radius = (-2.0 * (1.0 - self.uniform(0.0, 1.0)).ln()).sqrt();
        radius * self.uniform(0.0, std::f64::consts::TAU).cos()
    }

    pub(super) fn normals(&mut self, count: usize) -> Vec<f64> {
        (0..count).map(|_| self.normal()).collect()
    }
}

/// Numbers in [−1, 1).
pub fn numbers(seed: u64) -> impl FnMut() -> f64 {
    let mut random = SplitMix64::new(seed);
    move || random.uniform(-1.0, 1.0)
}
