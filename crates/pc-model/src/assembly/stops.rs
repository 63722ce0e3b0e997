//! Rigid stops of joints: the events at which joints strike them, and checks of what they say.

use pc_expr::{Direction, Expr};
use pc_mech::{System, Tree};

use crate::assembly::assembler::Assembler;
use crate::assembly::event::{Event, Impact};
use crate::diagnostics::error::ModelError;
use crate::diagnostics::meaning::MeaningError;
use crate::document::{Expression, Joint};
use crate::names::stage::Stage;

/// The two ends of a way, with the sign of the coordinate's rate with which a joint leaves them.
const ENDS: [(&str, i32); 2] = [("lower", 1), ("upper", -1)];
/// A start closer to an end than this fraction of the way is at the end.
const REACHED: f64 = 1e-9;

/// A rigid stop.
pub(super) struct Stop<'g> {
    /// The index of the body.
    body: usize,
    end: &'static str,
    /// The distance to the end, and its rate.
    gap: Expr<'g>,
    rate: Expr<'g>,
    /// The distance between the ends.
    way: Expr<'g>,
    restitution: Expr<'g>,
}

impl<'g> Assembler<'g, '_> {
    /// The rigid stops of a tree, in the order of its bodies, for each first the lower one.
    pub(super) fn stops(&mut self, tree: Option<&Tree<'g>>) -> Result<Vec<Stop<'g>>, ModelError> {
        let mut stops = Vec::new();
        let document = self.model.document();
        let Some(tree) = tree else { return Ok(stops) };
        for (body, hung) in document.tree.iter().enumerate() {
            let drive = &hung.joint.drive;
            let (Some(limits), Some(restitution)) = (&drive.limits, &drive.restitution) else { continue };
            let Some((x, velocity)) = tree.way_of(body) else { continue };
            let limits = self.scope.constants(limits)?;
            let restitution = self.scope.resolve(restitution, Stage::Joint)?;
            for ((end, sign), limit) in ENDS.into_iter().zip(limits) {
                let (gap, rate) = ((x - limit) * sign, velocity * sign);
                stops.push(Stop { body, end, gap, rate, way: limits[1] - limits[0], restitution });
            }
        }
        Ok(stops)
    }

    /// The events at which joints strike their stops.
    pub(super) fn impacts(&self, stops: &[Stop<'g>]) -> Result<Vec<Event<'g>>, ModelError> {
        let document = self.model.document();
        let event = |stop: &Stop<'g>| {
            let name = format!("{}_{}", document.tree[stop.body].name.text, stop.end);
            if let Some(other) = document.events.iter().find(|event| event.name.text == name) {
                let message = format!("`{name}` is the event at the {} stop of a joint", stop.end);
                let help = "give this event another name";
                return Err(document.error(&other.place, MeaningError::OfJoint { message, help }));
            }
            let impact = Impact { rate: stop.rate, restitution: stop.restitution, way: stop.way };
            Ok(Event {
                name,
                when: stop.gap,
                direction: Direction::Falling,
                terminal: false,
                resets: Vec::new(),
                impact: Some(impact),
            })
        };
        stops.iter().map(event).collect()
    }

    /// Checks the numbers of stops and of stiction, and that joints start between their stops.
    pub(super) fn check_joints(
        &mut self,
        stops: &[Stop<'g>],
        system: &System<'g>,
        start: &[f64],
    ) -> Result<(), ModelError> {
        let document = self.model.document();
        let state = system.state().into_iter().zip(start.iter().copied());
        let at: Vec<(Expr<'g>, f64)> = system.parameters().iter().copied().chain(state).collect();
        let refused = |entry: &Expression, message: String, help: &'static str| {
            Err(document.error(&entry.whole(), MeaningError::OfJoint { message, help }))
        };
        for Stop { body, end, gap, rate, way, restitution } in stops {
            let Joint { drive, .. } = &document.tree[*body].joint;
            let (Some([lower, _]), Some(entry)) = (&drive.limits, &drive.restitution) else { continue };
            let name = &document.tree[*body].name.text;
            let Ok(values) = self.graph.evaluate(&[*gap, *rate, *way, *restitution], &at) else { continue };
            let [gap, rate, way, e] = values[..] else { continue };
            if !(0.0..=1.0).contains(&e) {
                let message = format!("a coefficient of restitution is between 0 and 1, not {e}");
                return refused(entry, message, "0 is an impact without rebound, 1 one without loss");
            }
            if way.is_nan() || way <= 0.0 {
                let message = format!("the lower end of the way of `{name}` is not below the upper one");
                return refused(lower, message, "write the lower end first");
            }
            if gap < -REACHED * way {
                let message = format!("`{name}` starts beyond its {end} end, by {}", -gap);
                return refused(lower, message, "give a start between the ends");
            }
            if gap <= 0.0 && rate < 0.0 {
                let message =
                    format!("`{name}` starts at its {end} end with a velocity that leads beyond it");
                return refused(
                    lower,
                    message,
                    "start before the end, or with the velocity after the impact",
                );
            }
        }
        for hung in &document.tree {
            let drive = &hung.joint.drive;
            let (Some(entry), Some(friction)) = (&drive.stiction, &drive.friction) else { continue };
            let sizes = [entry, friction].map(|size| self.scope.resolve(size, Stage::Joint));
            let [stiction, friction] = sizes;
            let Ok(values) = self.graph.evaluate(&[stiction?, friction?], &at) else { continue };
            let [stiction, friction] = values[..] else { continue };
            if friction <= 0.0 || stiction < friction || stiction.is_nan() {
                let message =
                    format!("stiction {stiction} is less than the friction {friction}, or that is 0");
                return refused(
                    entry,
                    message,
                    "friction holds up to `stiction`, and slides with `friction` above 0",
                );
            }
        }
        Ok(())
    }
}
