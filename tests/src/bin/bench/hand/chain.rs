//! The spatial chain of N unit links, y = (q, q̇): revolute joints about x, y, x, y, …, each at the lower end of the link before,
//! one below its own; mass centres in the middle, principal moments 0.10, 0.12, 0.05; g = 9.81.
//!
//! Featherstone's articulated-body algorithm as one writes it for this chain: three-vectors along body axes, classical accelerations
//! replaced by velocity products, zeros of the axis and of the offset used, all sines and cosines first.

use std::hint::black_box;

use super::{Hand, fma, for_this_host};

const GRAVITY: f64 = 9.81;

/// What a link is. The compiler does not know the numbers: so it is in the libraries of robotics.
#[derive(Clone, Copy)]
struct Constants {
    mass: f64,
    /// m c
    moment: f64,
    /// To the next joint.
    below: f64,
    /// About the joint.
    inertia: Vector,
}

fn constants() -> Constants {
    black_box(Constants { mass: 1.0, moment: -0.5, below: -1.0, inertia: [0.35, 0.37, 0.05] })
}

type Vector = [f64; 3];

#[derive(Clone, Copy, Default)]
struct Link {
    cos: f64,
    sin: f64,
    omega: Vector,
    velocity: Vector,
    /// Velocity products of α and of a.
    turning: Vector,
    moving: Vector,
    /// Φ s/(s·Φ s)
    angular: Vector,
    linear: Vector,
    /// (τ − s·p)/(s·Φ s)
    impulse: f64,
}

/// Articulated inertia and bias force about a joint.
#[derive(Clone, Copy, Default)]
struct Articulated {
    j: [Vector; 3],
    h: [Vector; 3],
    m: [Vector; 3],
    n: Vector,
    f: Vector,
}

const fn next(axis: usize) -> (usize, usize) {
    ((axis + 1) % 3, (axis + 2) % 3)
}

#[inline(always)]
fn turned<const FMA: bool>(axis: usize, cos: f64, sin: f64, v: Vector) -> Vector {
    let (p, q) = next(axis);
    let mut turned = v;
    turned[p] = fma::<FMA>(cos, v[p], -(sin * v[q]));
    turned[q] = fma::<FMA>(sin, v[p], cos * v[q]);
    turned
}

/// v + ω × r for r one link down.
#[inline(always)]
fn carried<const FMA: bool>(v: Vector, omega: Vector, below: f64) -> Vector {
    [fma::<FMA>(omega[1], below, v[0]), fma::<FMA>(-omega[0], below, v[1]), v[2]]
}

impl Link {
    #[inline(always)]
    fn new<const FMA: bool>(
        axis: usize,
        (sin, cos): (f64, f64),
        rate: f64,
        parent: &Link,
        below: f64,
    ) -> Link {
        let (p, q) = next(axis);
        let mut omega = turned::<FMA>(axis, cos, -sin, parent.omega);
        let velocity = turned::<FMA>(axis, cos, -sin, carried::<FMA>(parent.velocity, parent.omega, below));
        omega[axis] += rate;
        let (mut turning, mut moving) = ([0.0; 3], [0.0; 3]);
        (turning[p], turning[q]) = (omega[q] * rate, -omega[p] * rate);
        (moving[p], moving[q]) = (velocity[q] * rate, -velocity[p] * rate);
        Link { cos, sin, omega, velocity, turning, moving, ..Link::default() }
    }

    /// Adds the link itself, eliminates its joint, and answers what the parent feels about its own joint.
    #[inline(always)]
    fn eliminate<const FMA: bool>(&mut self, axis: usize, on: &Articulated, of: &Constants) -> Articulated {
        let (p, q) = next(axis);
        let Link { cos, sin, omega: w, velocity: v, turning, moving, .. } = *self;
        let Articulated { mut j, mut h, mut m, mut n, mut f } = *on;
        // Momenta of the link about its joint.
        let Constants { mass, moment, below, inertia } = *of;
        let of_mass =
            [fma::<FMA>(w[1], moment, mass * v[0]), fma::<FMA>(-w[0], moment, mass * v[1]), mass * v[2]];
        let spin = [
            fma::<FMA>(-moment, v[1], inertia[0] * w[0]),
            fma::<FMA>(moment, v[0], inertia[1] * w[1]),
            inertia[2] * w[2],
        ];
        for i in 0..3 {
            let (k, l) = next(i);
            j[i][i] += inertia[i];
            m[i][i] += mass;
            n[i] += fma::<FMA>(w[k], spin[l], -(w[l] * spin[k]))
                + fma::<FMA>(v[k], of_mass[l], -(v[l] * of_mass[k]));
            f[i] += fma::<FMA>(w[k], of_mass[l], -(w[l] * of_mass[k]));
        }
        h[0][1] -= moment;
        h[1][0] += moment;

        let inverse = 1.0 / j[axis][axis];
        let (column, row) = ([j[0][axis], j[1][axis], j[2][axis]], h[axis]);
        self.impulse = -n[axis] * inverse;
        self.angular = column.map(|u| u * inverse);
        self.linear = row.map(|u| u * inverse);
        let (angular, linear) = (self.angular, self.linear);

        // What is left: the row of the axis vanishes.
        let left = |a: f64, u: f64, t: f64| fma::<FMA>(-u, t, a);
        let (app, apq, aqq) = (
            left(j[p][p], column[p], angular[p]),
            left(j[p][q], column[p], angular[q]),
            left(j[q][q], column[q], angular[q]),
        );
        let (mut hp, mut hq) = ([0.0; 3], [0.0; 3]);
        for c in 0..3 {
            hp[c] = left(h[p][c], column[p], linear[c]);
            hq[c] = left(h[q][c], column[q], linear[c]);
            for r in 0..=c {
                m[r][c] = left(m[r][c], row[r], linear[c]);
                m[c][r] = m[r][c];
            }
        }
        let dot = |a: Vector, b: Vector| fma::<FMA>(a[0], b[0], fma::<FMA>(a[1], b[1], a[2] * b[2]));
        n[p] += dot([app, apq, column[p]], [turning[p], turning[q], self.impulse])
            + fma::<FMA>(hp[p], moving[p], hp[q] * moving[q]);
        n[q] += dot([apq, aqq, column[q]], [turning[p], turning[q], self.impulse])
            + fma::<FMA>(hq[p], moving[p], hq[q] * moving[q]);
        n[axis] = 0.0;
        for i in 0..3 {
            f[i] += dot([hp[i], hq[i], row[i]], [turning[p], turning[q], self.impulse])
                + fma::<FMA>(m[i][p], moving[p], m[i][q] * moving[q]);
        }

        // To the axes of the parent.
        let n = turned::<FMA>(axis, cos, sin, n);
        let f = turned::<FMA>(axis, cos, sin, f);
        let (cc, ss, cs) = (cos * cos, sin * sin, cos * sin);
        let block = |a: f64, b: f64, d: f64| {
            let twice = 2.0 * cs * b;
            (
                fma::<FMA>(cc, a, fma::<FMA>(ss, d, -twice)),
                fma::<FMA>(cs, a - d, (cc - ss) * b),
                fma::<FMA>(ss, a, fma::<FMA>(cc, d, twice)),
            )
        };
        let mut j = [[0.0; 3]; 3];
        (j[p][p], j[p][q], j[q][q]) = block(app, apq, aqq);
        j[q][p] = j[p][q];
        let mut h = [[0.0; 3]; 3];
        let (mut up, mut uq) = ([0.0; 3], [0.0; 3]);
        for c in 0..3 {
            up[c] = fma::<FMA>(cos, hp[c], -(sin * hq[c]));
            uq[c] = fma::<FMA>(sin, hp[c], cos * hq[c]);
        }
        h[p] = turned::<FMA>(axis, cos, sin, up);
        h[q] = turned::<FMA>(axis, cos, sin, uq);
        let mut turned_mass = [[0.0; 3]; 3];
        turned_mass[axis][axis] = m[axis][axis];
        (turned_mass[p][p], turned_mass[p][q], turned_mass[q][q]) = block(m[p][p], m[p][q], m[q][q]);
        let across = turned::<FMA>(axis, cos, sin, m[axis]);
        (turned_mass[axis][p], turned_mass[axis][q]) = (across[p], across[q]);
        for (r, c) in [(q, p), (p, axis), (q, axis)] {
            turned_mass[r][c] = turned_mass[c][r];
        }

        // About the joint of the parent, r = (0, 0, below): G = Hᵀ − M r̂, J ← J − H r̂ + r̂ G, H ← Gᵀ.
        let mut g = [[0.0; 3]; 3];
        for i in 0..3 {
            g[i][0] = fma::<FMA>(-below, turned_mass[i][1], h[0][i]);
            g[i][1] = fma::<FMA>(below, turned_mass[i][0], h[1][i]);
            g[i][2] = h[2][i];
        }
        j[0][0] = fma::<FMA>(-below, h[0][1] + g[1][0], j[0][0]);
        j[0][1] = fma::<FMA>(below, h[0][0] - g[1][1], j[0][1]);
        j[0][2] = fma::<FMA>(-below, g[1][2], j[0][2]);
        j[1][1] = fma::<FMA>(below, h[1][0] + g[0][1], j[1][1]);
        j[1][2] = fma::<FMA>(below, g[0][2], j[1][2]);
        (j[1][0], j[2][0], j[2][1]) = (j[0][1], j[0][2], j[1][2]);
        let mut about = [[0.0; 3]; 3];
        for (r, row) in about.iter_mut().enumerate() {
            *row = [g[0][r], g[1][r], g[2][r]];
        }
        let n = [fma::<FMA>(-below, f[1], n[0]), fma::<FMA>(below, f[0], n[1]), n[2]];
        Articulated { j, h: about, m: turned_mass, n, f }
    }

    /// q̈ and the accelerations of the link.
    #[inline(always)]
    fn accelerate<const FMA: bool>(
        &self,
        axis: usize,
        (alpha, a): (Vector, Vector),
        below: f64,
    ) -> (f64, Vector, Vector) {
        let moved = carried::<FMA>(a, alpha, below);
        let mut alpha = turned::<FMA>(axis, self.cos, -self.sin, alpha);
        let mut a = turned::<FMA>(axis, self.cos, -self.sin, moved);
        let mut rate = self.impulse;
        for i in 0..3 {
            alpha[i] += self.turning[i];
            a[i] += self.moving[i];
            rate = fma::<FMA>(-self.angular[i], alpha[i], fma::<FMA>(-self.linear[i], a[i], rate));
        }
        alpha[axis] += rate;
        (rate, alpha, a)
    }
}

/// sin and cos of many angles, eight at a time where the processor can: reduced by multiples of π/2, then Taylor's series to the
/// last digit on ±π/4. For angles below some hundred.
#[inline(always)]
fn sines<const FMA: bool, const N: usize>(angles: &[f64; N]) -> [(f64, f64); N] {
    const SIN: [f64; 6] =
        [-1.0 / 6.0, 1.0 / 120.0, -1.0 / 5040.0, 1.0 / 362_880.0, -1.0 / 39_916_800.0, 1.0 / 6_227_020_800.0];
    const COS: [f64; 6] = [
        1.0 / 24.0,
        -1.0 / 720.0,
        1.0 / 40_320.0,
        -1.0 / 3_628_800.0,
        1.0 / 479_001_600.0,
        -1.0 / 87_178_291_200.0,
    ];
    /// π/2 in two parts.
    const HALF: [f64; 2] = [std::f64::consts::FRAC_PI_2, 6.123_233_995_736_766e-17];
    /// Adding it rounds to a whole number, which is then in the last bits.
    const ROUND: f64 = 6_755_399_441_055_744.0;
    let (mut sin, mut cos) = ([0.0; N], [0.0; N]);
    for i in 0..N {
        let shifted = fma::<FMA>(angles[i], std::f64::consts::FRAC_2_PI, ROUND);
        let (quarter, turns) = (shifted.to_bits(), shifted - ROUND);
        let x = fma::<FMA>(-turns, HALF[1], fma::<FMA>(-turns, HALF[0], angles[i]));
        let square = x * x;
        let series = |c: &[f64; 6]| c.iter().rev().fold(0.0, |sum, &c| fma::<FMA>(sum, square, c));
        let s = fma::<FMA>(x * square, series(&SIN), x);
        let c = fma::<FMA>(square * square, series(&COS), fma::<FMA>(-0.5, square, 1.0));
        let (first, second) = if quarter & 1 == 0 { (s, c) } else { (c, s) };
        sin[i] = f64::from_bits(first.to_bits() ^ (quarter & 2) << 62);
        cos[i] = f64::from_bits(second.to_bits() ^ (quarter.wrapping_add(1) & 2) << 62);
    }
    std::array::from_fn(|i| (sin[i], cos[i]))
}

#[inline(always)]
fn articulated<const FMA: bool, const N: usize>(
    [angles, rates]: &[[f64; N]; 2],
    [velocities, accelerations]: &mut [[f64; N]; 2],
) {
    *velocities = *rates;
    let of = constants();
    let trigonometry = sines::<FMA, N>(angles);
    let mut links = [Link::default(); N];
    // The first joint is at the origin: nothing that would carry it there moves.
    let mut parent = Link::default();
    for i in 0..N {
        let axis = i & 1;
        parent = match axis {
            0 => Link::new::<FMA>(0, trigonometry[i], rates[i], &parent, of.below),
            _ => Link::new::<FMA>(1, trigonometry[i], rates[i], &parent, of.below),
        };
        links[i] = parent;
    }
    let mut on = Articulated::default();
    for (i, link) in links.iter_mut().enumerate().rev() {
        on = match i & 1 {
            0 => link.eliminate::<FMA>(0, &on, &of),
            _ => link.eliminate::<FMA>(1, &on, &of),
        };
    }
    let mut moving = ([0.0; 3], [0.0, 0.0, GRAVITY]);
    for (i, link) in links.iter().enumerate() {
        let (rate, alpha, a) = match i & 1 {
            0 => link.accelerate::<FMA>(0, moving, of.below),
            _ => link.accelerate::<FMA>(1, moving, of.below),
        };
        (accelerations[i], moving) = (rate, (alpha, a));
    }
}

macro_rules! of_length {
    ($links:expr; $($length:literal)*) => {
        match $links {
            $($length => for_this_host!(articulated, [[f64; $length]; 2], $length),)*
            links => unreachable!("no chain of {links} links is written by hand"),
        }
    };
}

/// The chain of as many links.
///
/// # Panics
/// For any number of links but 5, 10, 20, 50, 100, 200 and 1000.
pub(crate) fn chain(links: usize) -> Hand {
    of_length!(links; 5 10 20 50 100 200 1000)
}
