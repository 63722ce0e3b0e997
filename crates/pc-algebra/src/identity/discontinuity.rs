//! Surfaces on which functions jump, found from the values on both sides.

use pc_expr::{Backend, Evaluator, Expr, ExprError, Graph, Inputs, Program};

use crate::identity::magnitudes::magnitudes;

/// The number of points from which each surface is sought; their components have magnitudes between 10⁻² and 10², in units in
/// which the terms of the functions are of the same order.
const TRIALS: u64 = 32;
/// The maximum number of Newton's steps to a surface, enough to halve the distance to a double zero until
/// precision is exhausted.
const MOST_STEPS: usize = 60;
/// The iteration has converged when a step is this small relative to the point.
const ARRIVED: f64 = 1e-12;
/// The distances from a surface at which values are compared, relative to the size of the point.
const BESIDE: [f64; 3] = [1e-5, 1e-6, 1e-7];
/// A jump is at least this fraction of the values, and is the same at all distances to within a tenth.
const LEAST: f64 = 1e-8;
const SAME: f64 = 0.1;

/// A surface on which a function jumps.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Discontinuity<'g> {
    /// Vanishes there.
    pub surface: Expr<'g>,
    /// The index of the first function that jumps.
    pub function: usize,
}

/// The [seams](Graph::seams) on which functions jump as the `moving` symbols change; the symbols of `numbers` have the
/// values given there, all other symbols may have any value.
///
/// Newton's steps lead to points on a seam. Lengths are measured with components in units in which the terms of the functions
/// and of the seam are of the same order. From the difference D(δ) of the values at the distances ±δ, the part proportional to δ
/// is subtracted: (D(qδ) − q D(δ))/(1 − q). If the rest is the same at each δ and is not a rounding error, it is a jump. At a
/// corner or a root the rest falls with δ; at a pole it rises.
///
/// # Errors
/// As for [`Program::new`].
///
/// ```
/// # use pc_algebra::discontinuities;
/// # use pc_expr::Graph;
/// let graph = Graph::new();
/// let [x, a] = graph.symbols(["x", "a"]);
/// let force = [x.abs(), (x - a).step(2.0, 0.0), 1.0 / x];
/// let found = discontinuities(&graph, &force, &[x], &[(a, 0.5)])?;
/// assert_eq!(found.iter().map(|at| (at.surface, at.function)).collect::<Vec<_>>(), [(x - a, 1)]);
/// assert_eq!(discontinuities(&graph, &[(1.0 / x).atan()], &[x], &[])?.len(), 1);
/// # Ok::<(), pc_expr::ExprError>(())
/// ```
pub fn discontinuities<'g>(
    graph: &'g Graph,
    functions: &[Expr<'g>],
    moving: &[Expr<'g>],
    numbers: &[(Expr<'g>, f64)],
) -> Result<Vec<Discontinuity<'g>>, ExprError> {
    let mut seams = graph.seams(functions);
    seams.retain(|seam| moving.iter().any(|&symbol| seam.depends_on(symbol)));
    if seams.is_empty() {
        return Ok(Vec::new());
    }
    let symbols = graph.symbols_of(functions);
    let inputs = Inputs { time: None, state: symbols.clone(), parameters: Vec::new() };
    let evaluator = |outputs: &[Expr<'g>]| -> Result<Evaluator, ExprError> {
        Ok(Evaluator::new(Program::new(graph, &inputs, outputs)?, Backend::Interpreter))
    };
    let mut values = evaluator(functions)?;
    let number =
        |symbol: Expr<'g>| numbers.iter().find(|(known, _)| *known == symbol).map(|&(_, value)| value);
    let fixed: Vec<Option<f64>> = symbols.iter().map(|&symbol| number(symbol)).collect();
    let free: Vec<(Expr<'g>, f64)> =
        symbols.iter().filter(|&&x| number(x).is_none()).map(|&x| (x, 1.0)).collect();
    let mut found = Vec::new();
    for surface in seams {
        let orders = magnitudes(graph, &[functions, &[surface]].concat(), &free, numbers);
        let unit = |symbol: &Expr<'g>| {
            let place = free.iter().position(|(known, _)| known == symbol);
            place.zip(orders.as_ref()).map_or(1.0, |(place, orders)| orders[place])
        };
        let moves = |&place: &usize| moving.contains(&symbols[place]) && surface.depends_on(symbols[place]);
        let mut sides = Sides {
            moving: (0..symbols.len()).filter(moves).collect(),
            units: symbols.iter().map(unit).collect(),
            seam: evaluator(&[surface])?,
            values: &mut values,
        };
        let function = (0..TRIALS).find_map(|trial| {
            let from = point(trial, &fixed, &sides.units);
            sides.jump(from)
        });
        found.extend(function.map(|function| Discontinuity { surface, function }));
    }
    Ok(found)
}

/// Whether a function may jump as the `changing` symbols change: it contains a sign, a step or an angle that depends on
/// them, or has [discontinuities]. The symbols of `numbers` have the values given there.
///
/// # Errors
/// As for [`discontinuities`].
pub fn may_jump<'g>(
    graph: &'g Graph,
    function: Expr<'g>,
    changing: &[Expr<'g>],
    numbers: &[(Expr<'g>, f64)],
) -> Result<bool, ExprError> {
    Ok(graph.applies(function, changing, |function| !function.is_continuous())
        || !discontinuities(graph, &[function], changing, numbers)?.is_empty())
}

/// Point number `trial` of a fixed sequence; the components that are fixed have their given values.
fn point(trial: u64, fixed: &[Option<f64>], units: &[f64]) -> Vec<f64> {
    let number = |place: usize| {
        let bits = mixed(trial << 32 | place as u64);
        let sign = if bits & 1 == 0 { 1.0 } else { -1.0 };
        sign * 10f64.powf(4.0 * (bits >> 11) as f64 / (1u64 << 53) as f64 - 2.0)
    };
    let component =
        |(place, value): (usize, &Option<f64>)| value.unwrap_or_else(|| number(place) * units[place]);
    fixed.iter().enumerate().map(component).collect()
}

/// A seam between the pieces of some functions, with the indices of the symbols whose change crosses it.
struct Sides<'a> {
    moving: Vec<usize>,
    /// The unit of each symbol.
    units: Vec<f64>,
    seam: Evaluator,
    values: &'a mut Evaluator,
}

impl Sides<'_> {
    /// The first function that jumps where the seam is reached from this point.
    fn jump(&mut self, from: Vec<f64>) -> Option<usize> {
        let (point, normal) = self.reach(from)?;
        let size = self.size(&point);
        let mut sums = Vec::new();
        let mut differences = |part: f64| -> Vec<f64> {
            let [ahead, behind] =
                [part, -part].map(|part| shifted(&point, (&self.moving, &self.units), &normal, part * size));
            let [ahead, behind] = [ahead, behind].map(|point| at(self.values, &point));
            sums = ahead.iter().zip(&behind).map(|(a, b)| a.abs() + b.abs()).collect();
            ahead.iter().zip(&behind).map(|(a, b)| a - b).collect()
        };
        let [far, near, nearest] = BESIDE.map(&mut differences);
        let without_slope = |far: f64, near: f64| {
            let part = BESIDE[1] / BESIDE[0];
            (near - part * far) / (1.0 - part)
        };
        (0..sums.len()).find(|&i| {
            let (first, second) = (without_slope(far[i], near[i]), without_slope(near[i], nearest[i]));
            let is_large = second.is_finite() && second.abs() > LEAST * sums[i];
            is_large && (first - second).abs() <= SAME * second.abs()
        })
    }

    /// A point on the seam and the unit vector normal to it, found by Newton's steps with difference quotients.
    fn reach(&mut self, mut point: Vec<f64>) -> Option<(Vec<f64>, Vec<f64>)> {
        for _ in 0..MOST_STEPS {
            let size = self.size(&point);
            let value = at(&mut self.seam, &point)[0];
            let step = f64::EPSILON.cbrt() * size;
            let mut slopes = Vec::with_capacity(self.moving.len());
            for &place in &self.moving {
                let [ahead, behind] =
                    [step, -step].map(|step| shifted(&point, (&[place], &self.units), &[1.0], step));
                let [ahead, behind] = [ahead, behind].map(|point| at(&mut self.seam, &point)[0]);
                slopes.push((ahead - behind) / (2.0 * step));
            }
            let steepness = slopes.iter().fold(0.0f64, |sum, slope| sum.hypot(*slope));
            if !(value.is_finite() && steepness.is_finite() && steepness > 0.0) {
                return None;
            }
            let normal: Vec<f64> = slopes.iter().map(|slope| slope / steepness).collect();
            let distance = value / steepness;
            if distance.abs() <= ARRIVED * size {
                return Some((point, normal));
            }
            point = shifted(&point, (&self.moving, &self.units), &normal, -distance);
        }
        None
    }

    /// The size of the moving part of a point; 1 at the origin.
    fn size(&self, point: &[f64]) -> f64 {
        let in_units = |&place: &usize| (point[place] / self.units[place]).abs();
        let largest = self.moving.iter().map(in_units).fold(0.0f64, f64::max);
        if largest > 0.0 { largest } else { 1.0 }
    }
}

fn at(program: &mut Evaluator, point: &[f64]) -> Vec<f64> {
    let mut outputs = vec![f64::NAN; program.program().outputs_len()];
    program.eval(0.0, point, &[], &mut outputs);
    outputs
}

fn shifted(point: &[f64], (places, units): (&[usize], &[f64]), direction: &[f64], distance: f64) -> Vec<f64> {
    let mut there = point.to_vec();
    let steps = places.iter().zip(direction);
    steps.for_each(|(&place, slope)| there[place] += distance * slope * units[place]);
    there
}

/// The given number with its bits mixed (splitmix64).
fn mixed(number: u64) -> u64 {
    let mut z = number.wrapping_add(1).wrapping_mul(0x9e37_79b9_7f4a_7c15);
    z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    z ^ (z >> 31)
}
