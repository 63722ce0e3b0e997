//! Points at which expressions jump.

use pc_expr::{Break, Expr, Graph, Weighed};

use crate::identity::sample::{Neighbourhood, TRIALS};

/// The maximum number of Newton's steps to a surface: a surface that they do not reach is ignored.
const MOST_STEPS: usize = 40;
/// The iteration has converged when a step is this small relative to the point.
const ARRIVED: f64 = 1e-14;
/// The distance from the surface at which its sign is evaluated, relative to the size of the point.
const BESIDE: f64 = 1e-6;

/// A jump of an expression.
#[derive(Clone, Debug, PartialEq)]
pub struct Jump {
    /// Names and values of the symbols at a point where the expression jumps.
    pub at: Vec<(String, f64)>,
    /// The size of the jump.
    pub size: f64,
}

impl<'g> Neighbourhood<'g> {
    /// A jump of `value` at a surface that is crossed when the `moving` symbols change, if there is one nearby.
    ///
    /// The surface is f = 0, where f is the argument of a `step` or `sign`; Newton steps along ∇f lead to it from points near the centre. A
    /// difference no larger than rounding errors is not a jump, and neither is a difference at a surface where f only
    /// touches zero.
    ///
    /// ```
    /// # use pc_algebra::Neighbourhood;
    /// # use pc_expr::Graph;
    /// let graph = Graph::new();
    /// let [x, a] = graph.symbols(["x", "a"]);
    /// let near = Neighbourhood { centre: vec![(a, 0.5)] };
    /// let jump = near.jump(&graph, (x - a).step(x, 0.0), &[x]).expect("of 1/2 at x = 1/2");
    /// assert_eq!((jump.at, jump.size), (vec![("x".to_owned(), 0.5)], 0.5));
    /// assert!(near.jump(&graph, (x - a).step((x - a).square(), 0.0), &[x]).is_none());
    /// ```
    pub fn jump(&self, graph: &'g Graph, value: Expr<'g>, moving: &[Expr<'g>]) -> Option<Jump> {
        if value.constant().is_some() {
            return None;
        }
        graph.breaks(value).into_iter().find_map(|found| self.jump_at(graph, found, moving))
    }

    fn jump_at(&self, graph: &'g Graph, at: Break<'g>, moving: &[Expr<'g>]) -> Option<Jump> {
        let change = at.above - at.below;
        let in_it = graph.symbols_of(&[at.surface]);
        let moving: Vec<Expr<'g>> = moving.iter().copied().filter(|symbol| in_it.contains(symbol)).collect();
        if moving.is_empty() || change.is_zero() {
            return None;
        }
        let slopes = graph.gradient(at.surface, &moving);
        let surface: Vec<Expr<'g>> = [at.surface].into_iter().chain(slopes).collect();
        let all = graph.symbols_of(&[&surface[..], &[change]].concat());
        let beside = (0..TRIALS as u64).filter_map(|trial| {
            let values = self.sample::<f64>(graph, &all, trial)?;
            Some(all.iter().copied().zip(values).collect::<Vec<(Expr<'g>, f64)>>())
        });
        let of_one_order = || self.points_of_one_order(graph, &[at.surface, change], TRIALS);
        beside.chain(std::iter::once_with(of_one_order).flatten()).find_map(|mut point| {
            reach(graph, &surface, &moving, &mut point)?;
            let weighed: Vec<_> = point.iter().map(|&(z, value)| (z, Weighed::rounded(value))).collect();
            let size = graph.evaluate(&[change], &weighed).ok()?[0];
            let at = || point.iter().filter(|(z, _)| moving.contains(z)).map(|(z, v)| (z.to_string(), *v));
            let jumps = size.is_finite() && size.rest() > Neighbourhood::ROUNDING;
            jumps.then(|| Jump { at: at().collect(), size: size.value })
        })
    }
}

/// Moves a point to where f = 0 and f has opposite signs on the two sides; `surface` is f, ∇f.
fn reach<'g>(
    graph: &'g Graph,
    surface: &[Expr<'g>],
    moving: &[Expr<'g>],
    point: &mut [(Expr<'g>, f64)],
) -> Option<()> {
    for _ in 0..MOST_STEPS {
        let values = graph.evaluate(surface, point).ok()?;
        let (f, slopes) = values.split_first()?;
        let steepness: f64 = slopes.iter().map(|slope| slope * slope).sum();
        if !(f.is_finite() && steepness.is_finite() && steepness > 0.0) {
            return None;
        }
        let size = size(point, moving);
        if f.abs() <= ARRIVED * size * steepness.sqrt() {
            let beside = BESIDE * size / steepness.sqrt();
            let sign = |distance: f64| {
                let mut there = point.to_vec();
                shift(&mut there, moving, slopes, distance);
                graph.evaluate(&surface[..1], &there).ok().map(|f| f[0].signum())
            };
            return (sign(beside)? != sign(-beside)?).then_some(());
        }
        shift(point, moving, slopes, -f / steepness);
    }
    None
}

/// The size of the moving part of a point; 1 at the origin.
fn size<'g>(point: &[(Expr<'g>, f64)], moving: &[Expr<'g>]) -> f64 {
    let moved = point.iter().filter(|(z, _)| moving.contains(z));
    let size = moved.fold(0.0f64, |size, (_, value)| size.max(value.abs()));
    if size > 0.0 { size } else { 1.0 }
}

/// Moves a point along a direction in the space of the moving symbols.
fn shift<'g>(point: &mut [(Expr<'g>, f64)], moving: &[Expr<'g>], along: &[f64], distance: f64) {
    for (symbol, slope) in moving.iter().zip(along) {
        point.iter_mut().filter(|(z, _)| z == symbol).for_each(|(_, value)| *value += distance * slope);
    }
}
