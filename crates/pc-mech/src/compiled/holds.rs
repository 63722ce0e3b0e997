//! What holds a motion on the surfaces between its pieces.

use pc_expr::{Backend, Evaluator, Expr, Program, SlidingRange, Surface};
use serde::{Deserialize, Serialize};

use crate::compiled::first_order::FirstOrder;
use crate::error::MechError;

/// What holds a motion on each of its surfaces.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub(super) struct Holds {
    kinds: Vec<Kind>,
    /// The component of the state that each surface holds at a value, if it is a single one.
    still: Vec<Option<usize>>,
    /// The ratios F_s/F from (t, y, p).
    ratios: Evaluator,
    values: Vec<f64>,
}

/// What holds a motion on one surface.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
enum Kind {
    /// The forces on both sides.
    Jump,
    /// Stiction, with this one of the ratios.
    Stiction(usize),
    /// Where a stop comes into reach; nothing jumps there.
    Reach,
    /// A stop, which does not act beside the surface. It pushes on the side −1 of the surface, or on the side 1 if
    /// `reversed`.
    Stop { reversed: bool },
}

/// The surfaces of the holds of a system, with the forces of the stops.
pub(super) struct Placed<'g> {
    pub(super) surfaces: Vec<Surface<'g>>,
    kinds: Vec<(usize, Kind)>,
    still: Vec<(usize, usize)>,
    ratios: Vec<Expr<'g>>,
    /// The gaps of the surfaces of stops, as text.
    pub(super) gaps: Vec<(usize, String)>,
    /// The forces on the quasi-velocities: (1 − s)/2 along each gap, where s is the side of its surface.
    pub(super) forces: Vec<Expr<'g>>,
}

impl<'g> FirstOrder<'g> {
    /// The quasi-velocities.
    fn quasi_velocities(&self) -> &[Expr<'g>] {
        &self.state[self.coordinates..self.state.len() - self.states]
    }

    /// The surfaces on which the holds act.
    pub(super) fn place_holds(&self) -> Placed<'g> {
        let (graph, eta) = (self.graph, self.quasi_velocities());
        let mut placed = Placed {
            surfaces: Vec::new(),
            kinds: Vec::new(),
            still: Vec::new(),
            ratios: Vec::new(),
            gaps: Vec::new(),
            forces: vec![Expr::ZERO; eta.len()],
        };
        for hold in &self.holds {
            let held = graph.held_on(&[hold.function().sign()], &self.passing(), &placed.surfaces);
            let sign = held.values[0];
            let is_of_velocities = |surface: &Surface<'g>| {
                sign.depends_on(surface.side) && eta.iter().any(|&eta| surface.function.depends_on(eta))
            };
            let Some(place) = held.surfaces.iter().position(is_of_velocities) else { continue };
            let reaches = (placed.surfaces.len()..held.surfaces.len()).filter(|&surface| surface != place);
            placed.kinds.extend(reaches.map(|surface| (surface, Kind::Reach)));
            placed.surfaces = held.surfaces;
            let slopes = graph.gradient(hold.rate(), eta);
            let mut moved = (0..eta.len()).filter(|&s| !slopes[s].is_zero());
            if let (Some(s), None) = (moved.next(), moved.next()) {
                placed.still.push((place, self.coordinates + s));
            }
            if let Some(ratio) = hold.ratio() {
                placed.kinds.push((place, Kind::Stiction(placed.ratios.len())));
                placed.ratios.push(ratio);
            }
            if let Some(gap) = hold.gap() {
                placed.gaps.push((place, gap.to_string()));
                placed.kinds.push((place, Kind::Stop { reversed: sign == -placed.surfaces[place].side }));
                let size = (1.0 - sign) / 2.0;
                let forces = placed.forces.iter_mut().zip(slopes);
                forces.for_each(|(force, slope)| *force += size * slope);
            }
        }
        placed
    }
}

impl Holds {
    /// What holds a motion on `surfaces`.
    ///
    /// # Errors
    /// As for [`Program::new`].
    pub(super) fn new<'g>(
        system: &FirstOrder<'g>,
        placed: &Placed<'g>,
        surfaces: usize,
    ) -> Result<Holds, MechError> {
        let mut kinds = vec![Kind::Jump; surfaces];
        placed.kinds.iter().for_each(|&(place, kind)| kinds[place] = kind);
        let mut still = vec![None; surfaces];
        placed.still.iter().for_each(|&(place, component)| still[place] = Some(component));
        let program = Program::new(system.graph, &system.inputs(&[]), &placed.ratios)?;
        let values = vec![f64::NAN; placed.ratios.len()];
        Ok(Holds { kinds, still, ratios: Evaluator::new(program, Backend::Interpreter), values })
    }

    /// The σ for which the motion stays on a surface.
    pub(super) fn range(&mut self, surface: usize, (t, y, p): (f64, &[f64], &[f64])) -> SlidingRange {
        match self.kinds[surface] {
            Kind::Jump => SlidingRange::default(),
            Kind::Reach => SlidingRange::NONE,
            Kind::Stiction(place) => {
                self.ratios.eval(t, y, p, &mut self.values);
                let ratio = self.values[place].max(1.0);
                SlidingRange { lowest: -ratio, highest: ratio }
            }
            Kind::Stop { reversed: false } => SlidingRange { lowest: f64::NEG_INFINITY, highest: 1.0 },
            Kind::Stop { reversed: true } => SlidingRange { lowest: -1.0, highest: f64::INFINITY },
        }
    }

    /// The components of the state that keep their values to the last digit while the motion slides along the surfaces
    /// with side 0.
    pub(super) fn still(&self, sides: &[f64]) -> impl Iterator<Item = usize> {
        self.still.iter().zip(sides).filter(|(_, side)| **side == 0.0).filter_map(|(component, _)| *component)
    }

    /// The side on which f is evaluated where the motion is on this side of a surface, or on the surface.
    pub(super) fn beside(&self, surface: usize, side: f64) -> f64 {
        match self.kinds[surface] {
            Kind::Stop { reversed: true } => -1.0,
            Kind::Stop { reversed: false } => 1.0,
            _ if side < 0.0 => -1.0,
            _ => 1.0,
        }
    }
}
