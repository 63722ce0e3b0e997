//! The texts of a specimen: as it is, and in ordinary velocities.

use std::fmt::Write as _;

use super::execution::{ATOL, RTOL, SAMPLES};
use super::expression::Expression;
use super::specimen::{Body, Frame, Input, Restricts, Specimen, State, Turning, at_rest};
use super::start::Start;

/// Before the names of outputs that show what is no coordinate or quasi-velocity of a twin.
pub(super) const SHOWN: &str = "o_";

/// The text of a specimen.
pub fn model(specimen: &Specimen, start: &Start) -> String {
    let mut text = Text::default();
    text.parameters(specimen);
    let coordinates = specimen.coordinates();
    text.section("coordinates", coordinates.iter().map(|name| (name, number(start.value(name)))));
    let velocities = specimen.chart_velocities();
    match (&specimen.frame, velocities) {
        (Frame::Velocities, _) => text.start_velocities(specimen, start),
        (Frame::Triangular(frame), Some(velocities)) if !frame.by_definitions => {
            text.kinematics(specimen, start, velocities);
        }
        (Frame::Group { .. }, Some(velocities)) => text.kinematics(specimen, start, velocities),
        (Frame::Triangular(_) | Frame::Definitions(_) | Frame::Group { .. }, _) => {
            let entry = |(name, is): &(String, Expression)| {
                (name.clone(), format!("{{ is = \"{is}\", start = {} }}", number(start.value(name))))
            };
            text.section("quasi_velocities", specimen.definitions().iter().map(entry));
        }
    }
    if let Some(algebra) = &specimen.algebra {
        let _ = writeln!(text.0, "[algebra]\n{algebra}");
    }
    text.dynamics(specimen, start, false);
    text.section("forces", specimen.forces.iter().map(|(on, force)| (on, quoted(force))));
    let outputs = specimen.outputs.iter().map(|(name, value)| (name.clone(), quoted(value)));
    text.section("outputs", outputs);
    let integrals = specimen.quasi_velocities().into_iter();
    text.section("integrals", integrals.map(|eta| (format!("i_{eta}"), format!("\"{eta}\""))));
    text.events(specimen, |event| event.reset.clone());
    text.simulation(specimen)
}

/// The text of the same motion in the coordinates of the chart and their velocities, where everything else is a definition;
/// none where the text is the same, or a reset cannot be written so.
pub fn twin(specimen: &Specimen, start: &Start) -> Option<String> {
    let same_words = specimen.carried.is_empty() && matches!(specimen.frame, Frame::Velocities);
    let velocities = specimen.chart_velocities();
    let resets = specimen.events.iter().any(|event| !event.reset.is_empty());
    if same_words || resets && velocities.is_none() || holds_some_velocities(specimen) {
        return None;
    }
    let mut text = Text::default();
    text.parameters(specimen);
    text.section("coordinates", specimen.chart.iter().map(|x| (&x.name, number(x.start))));
    text.start_velocities(specimen, start);
    let carried = specimen.carried.iter().map(|carried| (carried.name.clone(), quoted(&carried.value)));
    let definitions = specimen.definitions();
    let eta = definitions.iter().map(|(name, value)| (name.clone(), quoted(value)));
    text.section("definitions", carried.chain(eta));
    text.dynamics(specimen, start, true);
    let forces = forces_on_coordinates(specimen, &definitions);
    text.section("forces", forces.iter().map(|(on, force)| (on, quoted(force))));
    let outputs = specimen.outputs.iter().map(|(name, value)| (name.clone(), quoted(value)));
    let also =
        specimen.carried.iter().map(|carried| &carried.name).chain(definitions.iter().map(|(name, _)| name));
    let also = also.map(|name| (format!("{SHOWN}{name}"), format!("\"{name}\"")));
    text.section("outputs", outputs.chain(also));
    text.events(specimen, |event| {
        if event.reset.is_empty() {
            return Vec::new();
        }
        let rows = velocities.iter().flatten().map(|row| row.substitute(&event.reset));
        let velocities = specimen.chart.iter().zip(rows).map(|(x, row)| (format!("{}'", x.name), row));
        let is_same = |name: &String| {
            let mut states = specimen.states.iter().map(|state| &state.name);
            specimen.chart.iter().any(|x| x.name == *name) || states.any(|state| state == name)
        };
        velocities.chain(event.reset.iter().filter(|(name, _)| is_same(name)).cloned()).collect()
    });
    Some(text.simulation(specimen))
}

/// Whether a reset keeps some quasi-velocities but not all at the values that it gives, and constraints move the others: in
/// ordinary velocities there are no values that say the same.
fn holds_some_velocities(specimen: &Specimen) -> bool {
    let eta = specimen.quasi_velocities();
    let sets = |event: &super::specimen::Event, eta: &String| event.reset.iter().any(|(name, _)| name == eta);
    let some = |event| eta.iter().any(|eta| sets(event, eta)) && !eta.iter().all(|eta| sets(event, eta));
    !specimen.constraints.is_empty() && specimen.events.iter().any(some)
}

/// F_i = Q_s a_si + Q_i: what forces on quasi-velocities η = a ẋ + a_0 are on coordinates.
fn forces_on_coordinates(
    specimen: &Specimen,
    definitions: &[(String, Expression)],
) -> Vec<(String, Expression)> {
    let rest: Vec<(String, Expression)> = specimen.chart.iter().map(at_rest).collect();
    let mut forces = Vec::new();
    for coordinate in &specimen.chart {
        let velocity = format!("{}'", coordinate.name);
        let mut moving = rest.clone();
        moving
            .iter_mut()
            .filter(|(name, _)| *name == velocity)
            .for_each(|(_, v)| *v = Expression::Number(1.0));
        let mut terms = Vec::new();
        for (on, force) in &specimen.forces {
            if *on == coordinate.name {
                terms.push(force.clone());
            }
            for (_, eta) in definitions.iter().filter(|(name, _)| name == on) {
                let slope = vec![eta.substitute(&moving), eta.substitute(&rest).times(-1.0)];
                terms.push(Expression::product(vec![force.clone(), Expression::sum(slope)]));
            }
        }
        if !terms.is_empty() {
            forces.push((coordinate.name.clone(), Expression::sum(terms)));
        }
    }
    forces
}

#[derive(Default)]
struct Text(String);

impl Text {
    fn section<N: AsRef<str>>(&mut self, name: &str, entries: impl Iterator<Item = (N, String)>) {
        let mut entries = entries.peekable();
        if entries.peek().is_none() {
            return;
        }
        let _ = writeln!(self.0, "[{name}]");
        for (key, value) in entries {
            let _ = writeln!(self.0, "\"{}\" = {value}", key.as_ref());
        }
    }

    fn parameters(&mut self, specimen: &Specimen) {
        self.section("parameters", specimen.parameters.iter().map(|(name, value)| (name, number(*value))));
    }

    fn start_velocities(&mut self, specimen: &Specimen, start: &Start) {
        let of = |(x, &v): (&super::specimen::Coordinate, &f64)| (format!("{}'", x.name), number(v));
        self.section("quasi_velocities", specimen.chart.iter().zip(&start.velocities).map(of));
    }

    fn kinematics(&mut self, specimen: &Specimen, start: &Start, velocities: Vec<Expression>) {
        let eta = specimen.quasi_velocities().into_iter();
        self.section("quasi_velocities", eta.map(|eta| (eta.clone(), number(start.value(&eta)))));
        let shown = specimen.chart.iter().zip(velocities).filter(|(x, _)| x.shown);
        let shown = shown.map(|(x, row)| (x.name.clone(), quoted(&row)));
        let carried = specimen.carried.iter().map(|c| (c.name.clone(), quoted(&c.velocity)));
        self.section("kinematics", shown.chain(carried));
    }

    /// Constraints, energies and bodies; `turned` where bodies turn by angular velocities.
    fn dynamics(&mut self, specimen: &Specimen, start: &Start, turned: bool) {
        let constraints = specimen.constraints.iter().zip(&start.kept).map(|(constraint, &kept)| {
            let expression = Expression::sum(vec![constraint.expression.clone(), Expression::Number(-kept)]);
            let text = match constraint.restricts {
                Restricts::Nonlinearly => format!("{{ expr = \"{expression}\", kind = \"nonlinear\" }}"),
                Restricts::Positions | Restricts::Velocities => quoted(&expression),
            };
            (constraint.name.clone(), text)
        });
        self.section("constraints", constraints);
        let energies = [
            ("kinetic", &specimen.kinetic),
            ("potential", &specimen.potential),
            ("dissipation", &specimen.dissipation),
        ];
        let energies = energies.into_iter().filter(|(_, terms)| !terms.is_empty());
        self.section(
            "lagrangian",
            energies.map(|(name, terms)| (name, quoted(&Expression::sum(terms.clone())))),
        );
        specimen.bodies.iter().for_each(|body| self.body(body, turned));
        if let Some(gravity) = &specimen.gravity {
            let _ = writeln!(self.0, "[gravity]\nacceleration = {}", list(gravity));
        }
        let state =
            |state: &State| format!("{{ start = {}, rate = \"{}\" }}", number(state.start), state.rate);
        self.section("states", specimen.states.iter().map(|s| (&s.name, state(s))));
        let input = |input: &Input| match input {
            Input::Constant(value) => number(*value),
            Input::Table { times, values, interpolation } => {
                format!("{{ times = {times:?}, values = {values:?}, interpolation = \"{interpolation}\" }}")
            }
        };
        self.section("inputs", specimen.inputs.iter().map(|(name, of)| (name, input(of))));
    }

    fn body(&mut self, body: &Body, turned: bool) {
        let _ = writeln!(self.0, "[bodies.{}]\nmass = {}", body.name, quoted(&body.mass));
        let _ = writeln!(self.0, "position = {}", list(&body.position));
        if let Some(force) = &body.force {
            let _ = writeln!(self.0, "force = {}", list(force));
        }
        let Some((inertia, turning)) = &body.turning else { return };
        let _ = writeln!(self.0, "inertia = {inertia:?}");
        let _ = match turning {
            Turning::AngularVelocity(omega) => writeln!(self.0, "angular_velocity = {}", list(omega)),
            Turning::About { ratio, coordinate, .. } if turned => {
                let spin = Expression::velocity(coordinate).times(*ratio);
                let zero = Expression::Number(0.0);
                writeln!(self.0, "angular_velocity = {}", list(&[zero.clone(), zero, spin]))
            }
            Turning::About { tilt, ratio, coordinate } => {
                let angle = Expression::symbol(coordinate).times(*ratio);
                writeln!(self.0, "rotation = {}", list(&rotation(*tilt, &angle)))
            }
        };
    }

    fn events(
        &mut self,
        specimen: &Specimen,
        reset: impl Fn(&super::specimen::Event) -> Vec<(String, Expression)>,
    ) {
        for event in &specimen.events {
            let _ = writeln!(self.0, "[events.{}]\nwhen = \"{}\"", event.name, event.when);
            let _ = writeln!(self.0, "direction = \"{}\"", event.direction);
            if event.terminal {
                let _ = writeln!(self.0, "terminal = true");
            }
            let entries: Vec<String> =
                reset(event).iter().map(|(name, value)| format!("\"{name}\" = \"{value}\"")).collect();
            if !entries.is_empty() {
                let _ = writeln!(self.0, "reset = {{ {} }}", entries.join(", "));
            }
        }
    }

    fn simulation(mut self, specimen: &Specimen) -> String {
        let (from, to) = (number(specimen.t_start), number(specimen.t_end));
        let _ = writeln!(self.0, "[simulation]\nt_start = {from}\nt_end = {to}");
        let _ = writeln!(self.0, "samples = {SAMPLES}\nrtol = {RTOL:e}\natol = {ATOL:e}");
        self.0
    }
}

/// The nine entries of R_x(tilt) R_z(angle), row by row, the tilt written out as a literal angle.
fn rotation(tilt: f64, angle: &Expression) -> [Expression; 9] {
    let (sin, cos) =
        (Expression::Call("sin", vec![angle.clone()]), Expression::Call("cos", vec![angle.clone()]));
    let zero = Expression::Number(0.0);
    let (st, ct) = match tilt {
        0.0 => (zero.clone(), Expression::Number(1.0)),
        tilt => (
            Expression::Call("sin", vec![Expression::Number(tilt)]),
            Expression::Call("cos", vec![Expression::Number(tilt)]),
        ),
    };
    let product = |a: &Expression, b: &Expression| Expression::product(vec![a.clone(), b.clone()]);
    [
        cos.clone(),
        sin.clone().times(-1.0),
        zero,
        product(&ct, &sin),
        product(&ct, &cos),
        st.clone().times(-1.0),
        product(&st, &sin),
        product(&st, &cos),
        ct,
    ]
}

fn quoted(expression: &Expression) -> String {
    format!("\"{expression}\"")
}

fn number(value: f64) -> String {
    format!("{value:?}")
}

fn list(expressions: &[Expression]) -> String {
    let entries: Vec<String> = expressions.iter().map(quoted).collect();
    format!("[{}]", entries.join(", "))
}
