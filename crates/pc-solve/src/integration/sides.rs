//! The sides of its surfaces on which a field of several pieces is held.
//!
//! During a step the field is smooth: it is [held](pc_expr::Switching) on one side of each surface. Where a surface is
//! reached the step ends, and the motion continues in the first of these ways that is consistent: across the surface, if
//! f on the other side leads away from it; along it, if f leads back from both sides; or back to
//! the side from which it came, where it only touches the surface. Where several surfaces are
//! reached at once, or the motion already slides along others, all combinations are tried; those in
//! which the motion slides along fewer surfaces come first.

use pc_expr::{Events, Failure, Sliding, SlidingError, SlidingRange, Switching, VectorField};

use crate::error::{Reason, SolveError};
#[cfg(feature = "cvode")]
use crate::events::root_finding::Sides;
use crate::integration::breaks::break_at;
#[cfg(feature = "cvode")]
use crate::integration::held_sides::HeldSides;
use crate::integration::held_sides::{Passage, Slide};
use crate::integration::integration::Integration;
#[cfg(feature = "cvode")]
use crate::integration::integration::directions;
use crate::integration::stepper::Stepper;

/// A function counts as being at zero if it is less than this fraction of the sum of its terms.
const ROUNDINGS: f64 = 16.0 * f64::EPSILON;
/// The rate of a function counts as zero if it is less than this fraction of the sum of the rate's
/// terms.
const FLAT: f64 = 1e-11;
/// |σ| may exceed its bound by this fraction where a motion begins to slide.
const BEYOND: f64 = 1e-9;
/// Up to this number of surfaces, all combinations are tried; if there are more, the sides are
/// decided one after another.
const MOST_COMBINED: usize = 3;
/// Fractions of the time scale of the motion at which a function that begins flat is evaluated.
const AHEAD: [f64; 3] = [1e-5, 1e-3, 1e-2];

/// Surfaces at zero, each with the sides to be tried in turn.
type Open = Vec<(usize, [f64; 3])>;

/// A field at a time and state, with the direction of time.
struct Place<'a> {
    field: &'a mut dyn Switching,
    t: f64,
    y: &'a [f64],
    direction: f64,
    /// The smallest significant size of a component.
    least: f64,
    /// The longest time span that matters.
    span: f64,
    /// The functions of the surfaces at this place, with the field held on the sides that it had
    /// before.
    before: Vec<f64>,
}

/// Whether sides are consistent with the motion to which they lead.
enum Verdict {
    Consistent,
    /// The motion leaves this one of the open surfaces, to the given side.
    Left(usize, f64),
}

impl Place<'_> {
    /// The functions of the surfaces, and their rounding errors.
    fn functions(&mut self, sides: &[f64]) -> (Vec<f64>, Vec<f64>) {
        self.field.hold(Some(sides));
        let mut values = vec![f64::NAN; sides.len()];
        self.field.functions(self.t, self.y, &mut values);
        let mut slopes = vec![0.0; self.y.len()];
        let rounding = (0..sides.len()).map(|surface| {
            let by_time = self.field.gradient(surface, self.t, self.y, &mut slopes);
            let terms = slopes.iter().zip(self.y).map(|(slope, y)| (slope * y).abs());
            ROUNDINGS * ((by_time * self.t).abs() + terms.sum::<f64>())
        });
        let rounding = rounding.collect();
        (values, rounding)
    }

    /// Sets the sides of surfaces that are not open to the signs of their functions, which may jump where another
    /// surface is passed.
    fn follow(&mut self, sides: &mut [f64], open: &[(usize, [f64; 3])]) {
        for _ in 0..sides.len() {
            let (values, rounding) = self.functions(sides);
            let mut changed = false;
            for surface in 0..sides.len() {
                let is_decided = sides[surface] == 0.0 || open.iter().any(|&(other, _)| other == surface);
                let value = values[surface];
                if !is_decided && value * sides[surface] < 0.0 && value.abs() > rounding[surface] {
                    sides[surface] = 1.0_f64.copysign(value);
                    changed = true;
                }
            }
            if !changed {
                return;
            }
        }
    }

    /// The rates when the field is held on these sides; none if the surfaces do not determine how
    /// the motion slides.
    fn rates(&mut self, sides: &[f64]) -> Result<Option<Sliding>, Failure> {
        self.field.hold(Some(sides));
        if sides.contains(&0.0) {
            return match Sliding::of(self.field, sides, self.t, self.y) {
                Ok(sliding) => Ok(Some(sliding)),
                Err(failure)
                    if matches!(failure.cause().downcast_ref(), Some(SlidingError::Undetermined { .. })) =>
                {
                    Ok(None)
                }
                Err(failure) => Err(failure),
            };
        }
        let mut rates = vec![f64::NAN; self.y.len()];
        self.field.rates(sides, self.t, self.y, &mut rates)?;
        Ok(Some(Sliding {
            surfaces: Vec::new(),
            weights: Vec::new(),
            slopes: Vec::new(),
            resting: Vec::new(),
            rates,
        }))
    }

    /// The sides to be tried in turn for a surface that is reached, with those that f alone suggests.
    fn options(&mut self, surface: usize, plain: [f64; 3]) -> [f64; 3] {
        self.field.range(surface, self.t, self.y).options(plain)
    }

    /// The rate below which a function counts as constant.
    fn least_rate(&self, rates: &[f64]) -> f64 {
        let largest = |v: &[f64]| v.iter().fold(0.0, |size: f64, v| size.max(v.abs()));
        ROUNDINGS * largest(self.y).max(largest(rates))
    }

    /// The derivative dg/dt for these rates, and the sum of the magnitudes of its terms.
    fn rate_of(&mut self, surface: usize, rates: &[f64]) -> (f64, f64) {
        let mut slopes = vec![0.0; self.y.len()];
        let by_time = self.field.gradient(surface, self.t, self.y, &mut slopes);
        let terms = slopes.iter().zip(rates).map(|(slope, rate)| slope * rate);
        terms.fold((by_time, by_time.abs()), |(sum, size), term| (sum + term, size + term.abs()))
    }

    /// Whether the motion with the field held on these sides stays on them.
    fn judge(&mut self, sides: &[f64], open: &[(usize, [f64; 3])]) -> Result<Verdict, Failure> {
        let Some(sliding) = self.rates(sides)? else {
            let first = open.iter().position(|&(surface, _)| sides[surface] == 0.0).unwrap_or(0);
            return Ok(Verdict::Left(first, 1.0));
        };
        let (values, rounding) = self.functions(sides);
        for (place, &(surface, _)) in open.iter().enumerate() {
            let (side, value) = (sides[surface], values[surface]);
            // Where another surface is passed this one may jump away from the motion, which goes on beside it.
            if (value - self.before[surface]).abs() > rounding[surface] && value.abs() > rounding[surface] {
                if value * side > 0.0 {
                    continue;
                }
                return Ok(Verdict::Left(place, 1.0_f64.copysign(value)));
            }
            if side == 0.0 {
                let Some(i) = sliding.surfaces.iter().position(|&other| other == surface) else { continue };
                let weight = sliding.weights[i];
                let is_led_back = match sliding.resting[i] {
                    None => sliding.slopes[i] * self.direction < 0.0,
                    // In the second derivative the direction of time does not matter.
                    Some(rate) => {
                        let slope = sliding.slopes[i];
                        slope < 0.0
                            && rate.abs() <= self.least_rate(&sliding.rates).max(ROUNDINGS * slope.abs())
                    }
                };
                let range = self.field.range(surface, self.t, self.y);
                let stays = is_led_back && range.holds(weight, BEYOND);
                if !stays {
                    return Ok(Verdict::Left(place, 1.0_f64.copysign(weight)));
                }
                continue;
            }
            let (rate, size) = self.rate_of(surface, &sliding.rates);
            let along = rate * self.direction * side;
            let leads_on = if along.abs() > FLAT * size {
                along > 0.0
            } else {
                self.leads_ahead(surface, sides, &sliding.rates)?
            };
            if !leads_on {
                return Ok(Verdict::Left(place, 0.0));
            }
        }
        Ok(Verdict::Consistent)
    }

    /// Whether a function that begins flat grows towards its side, judging by Runge–Kutta steps.
    fn leads_ahead(&mut self, surface: usize, sides: &[f64], rates: &[f64]) -> Result<bool, Failure> {
        let largest = |v: &[f64]| v.iter().fold(0.0, |size: f64, v| size.max(v.abs()));
        let length = largest(rates);
        let time = if length > 0.0 { largest(self.y).max(self.least) / length } else { 1.0 }.min(self.span);
        let (values, rounding) = self.functions(sides);
        let mut next = values.clone();
        for part in AHEAD {
            let h = part * time * self.direction;
            let y = match self.runge_kutta(sides, h, rates) {
                Ok(y) => y,
                Err(failure) if failure.is_recoverable() => break,
                Err(failure) => return Err(failure),
            };
            self.field.functions(self.t + h, &y, &mut next);
            let moved = (next[surface] - values[surface]) * sides[surface];
            if moved.abs() > 4.0 * rounding[surface].max(f64::MIN_POSITIVE) {
                return Ok(moved > 0.0);
            }
        }
        Ok(true) // it stays in the surface, on either side
    }

    /// The state after a step of the classical Runge–Kutta method.
    fn runge_kutta(&mut self, sides: &[f64], h: f64, first: &[f64]) -> Result<Vec<f64>, Failure> {
        let (t, y) = (self.t, self.y);
        let mut sum = first.to_vec();
        let mut slope = first.to_vec();
        for (part, weight) in [(0.5, 2.0), (0.5, 2.0), (1.0, 1.0)] {
            let moved: Vec<f64> = y.iter().zip(&slope).map(|(y, slope)| y + part * h * slope).collect();
            if sides.contains(&0.0) {
                slope = Sliding::of(self.field, sides, t + part * h, &moved)?.rates;
            } else {
                self.field.rates(sides, t + part * h, &moved, &mut slope)?;
            }
            sum.iter_mut().zip(&slope).for_each(|(sum, slope)| *sum += weight * slope);
        }
        Ok(y.iter().zip(&sum).map(|(y, sum)| y + h / 6.0 * sum).collect())
    }

    /// The first sides that are consistent, if there are any.
    fn decide(&mut self, sides: &[f64], open: &Open) -> Result<Option<Vec<f64>>, Failure> {
        if open.len() > MOST_COMBINED {
            return self.decide_in_turn(sides, open);
        }
        let mut choices: Vec<Vec<usize>> = vec![Vec::new()];
        for _ in open {
            let longer = |choice: &Vec<usize>| [0, 1, 2].map(|next| [&choice[..], &[next]].concat());
            choices = choices.iter().flat_map(longer).collect();
        }
        // Each surface as it comes first; then those with fewer exceptions from that.
        choices.sort_by_key(|choice| choice.iter().sum::<usize>());
        for choice in choices {
            let mut tried = sides.to_vec();
            for (&(surface, options), &choice) in open.iter().zip(&choice) {
                tried[surface] = options[choice];
            }
            self.follow(&mut tried, open);
            if let Verdict::Consistent = self.judge(&tried, open)? {
                return Ok(Some(tried));
            }
        }
        Ok(None)
    }

    /// The same for many surfaces: in each round, the first surface that the motion leaves is
    /// assigned the side to which the motion leaves it [Murty 1974]. The procedure terminates if
    /// each surface acts on its own function more strongly than the others do.
    fn decide_in_turn(&mut self, sides: &[f64], open: &Open) -> Result<Option<Vec<f64>>, Failure> {
        let mut tried = sides.to_vec();
        for &(surface, options) in open {
            tried[surface] = if options.contains(&0.0) { 0.0 } else { options[0] };
        }
        for _ in 0..20 * open.len() {
            self.follow(&mut tried, open);
            match self.judge(&tried, open)? {
                Verdict::Consistent => return Ok(Some(tried)),
                Verdict::Left(place, side) => tried[open[place].0] = side,
            }
        }
        Ok(None)
    }
}

impl<S: Stepper, E: Events> Integration<S, E> {
    /// Finds the sides of all surfaces at the front for a motion in this direction of time, if they are not known, and
    /// holds the field on them.
    pub(crate) fn find_sides(&mut self, direction: f64) -> Result<(), SolveError> {
        if self.held.are_known || self.held.len() == 0 {
            return Ok(());
        }
        let (t, y, least) = (self.front.t, self.front_state.clone(), self.engine.least_size());
        let span = self.span_of_interest();
        let Some(field) = self.engine.field_mut().switching() else { return Ok(()) };
        let mut place = Place { field, t, y: &y, direction, least, span, before: Vec::new() };
        let mut sides = vec![1.0; self.held.len()];
        let mut rounding = Vec::new();
        // A surface contains the sides of those before it only.
        for _ in 0..=sides.len() {
            (place.before, rounding) = place.functions(&sides);
            let signs = |value: &f64| if *value < 0.0 { -1.0 } else { 1.0 };
            let found: Vec<f64> = place.before.iter().map(signs).collect();
            if found == sides {
                break;
            }
            sides = found;
        }
        let is_open = |&surface: &usize| place.before[surface].abs() <= rounding[surface];
        let open: Vec<usize> = (0..sides.len()).filter(is_open).collect();
        let open: Open =
            open.into_iter().map(|surface| (surface, place.options(surface, [1.0, -1.0, 0.0]))).collect();
        let decided = if open.is_empty() { Ok(Some(sides)) } else { place.decide(&sides, &open) };
        self.take_sides(decided, &open)
    }

    /// Finds how the motion continues at the front, where these surfaces are reached; returns what
    /// happened.
    pub(crate) fn pass_surfaces(&mut self, due: &[usize]) -> Result<(), SolveError> {
        let (t, y, least) = (self.front.t, self.front_state.clone(), self.engine.least_size());
        let span = self.span_of_interest();
        let before = self.held.sides.clone();
        let mut sides = before.clone();
        let direction = self.direction.unwrap_or(1.0);
        let mut open = Open::new();
        let mut crosses = false;
        if due.iter().any(|&surface| before[surface] == 0.0)
            && let Some(field) = self.engine.field_mut().switching()
            && let Ok(sliding) = Sliding::of(field, &before, t, &y)
        {
            for (surface, weight) in sliding.surfaces.into_iter().zip(sliding.weights) {
                if due.contains(&surface) {
                    sides[surface] = 1.0_f64.copysign(weight);
                }
            }
        }
        for &surface in due.iter().filter(|&&surface| before[surface] != 0.0) {
            let side = before[surface];
            crosses = true;
            if self.jumps(surface) || self.is_passed(surface, (t, &y)) {
                sides[surface] = -side;
            } else {
                open.push((surface, [-side, 0.0, side]));
            }
        }
        if crosses {
            // f jumps, and may lead away from other surfaces.
            let slide = (0..sides.len()).filter(|&surface| sides[surface] == 0.0);
            open.extend(slide.map(|surface| (surface, [0.0, 1.0, -1.0])));
        }
        let decided = match self.engine.field_mut().switching() {
            Some(field) if crosses => {
                let mut place = Place { field, t, y: &y, direction, least, span, before: Vec::new() };
                open.iter_mut().for_each(|(surface, options)| *options = place.options(*surface, *options));
                place.before = place.functions(&before).0;
                place.decide(&sides, &open)
            }
            _ => Ok(Some(sides)),
        };
        self.take_sides(decided, &open)?;
        self.note_sides(Passage {
            surfaces: due.to_vec(),
            time: t,
            state: y,
            before,
            after: self.held.sides.clone(),
        });
        Ok(())
    }

    /// Whether the function of a surface that is reached jumps through zero, as it may at a break
    /// of a table.
    pub(crate) fn jumps(&self, surface: usize) -> bool {
        let noise = self.noise.get(self.events.events().len() + surface);
        noise.is_some_and(|noise| *noise == 0.0)
    }

    /// Whether a motion always passes through a surface, because nothing jumps there.
    fn is_passed(&mut self, surface: usize, (t, y): (f64, &[f64])) -> bool {
        let field = self.engine.field_mut().switching();
        field.is_some_and(|field| field.range(surface, t, y) == SlidingRange::NONE)
    }

    /// Decides the sides anew at a break of a table while the motion slides. The function of a
    /// surface may jump away from zero there, and the motion then continues beside this surface.
    /// Along the other surfaces the rates jump, as the rates of the table do.
    pub(crate) fn leave_what_jumps(&mut self, towards: f64) -> Result<(), SolveError> {
        if !self.held.sides.contains(&0.0) {
            return Ok(());
        }
        let (y, least, span) = (self.front_state.clone(), self.engine.least_size(), self.span_of_interest());
        let direction = 1.0_f64.copysign(towards - self.front.t);
        let before = self.held.sides.clone();
        let field = self.engine.field_mut();
        let Some(t) = break_at(field.breaks(), self.front.t) else { return Ok(()) };
        let Some(switching) = field.switching() else { return Ok(()) };
        let mut place = Place { field: switching, t, y: &y, direction, least, span, before: Vec::new() };
        let (ahead, rounding) = place.functions(&before);
        field.enter(t, towards);
        let Some(switching) = field.switching() else { return Ok(()) };
        let mut place = Place { field: switching, t, y: &y, direction, least, span, before: Vec::new() };
        let behind = place.functions(&before).0;
        let (mut sides, mut open) = (before.clone(), Open::new());
        for surface in (0..sides.len()).filter(|&surface| before[surface] == 0.0) {
            if (behind[surface] - ahead[surface]).abs() > rounding[surface] {
                sides[surface] = 1.0_f64.copysign(behind[surface]);
            } else {
                open.push((surface, place.options(surface, [0.0, 1.0, -1.0])));
            }
        }
        place.before = behind;
        let decided = place.decide(&sides, &open);
        self.take_sides(decided, &open)?;
        let (time, after) = (self.front.t, self.held.sides.clone());
        self.note_sides(Passage { surfaces: Vec::new(), time, state: y.clone(), before, after });
        self.engine.stand_at(time);
        let matrix = self.engine.columns()?;
        self.engine.enter_piece(time, &y, &matrix, self.direction)?;
        self.restarted = true;
        Ok(())
    }

    /// Finds the sides at the front, and records them.
    pub(crate) fn begin_on_sides(&mut self, direction: f64) -> Result<(), SolveError> {
        if self.held.are_known || self.held.len() == 0 {
            return Ok(());
        }
        self.find_sides(direction)?;
        self.note_sides(Passage {
            surfaces: Vec::new(),
            time: self.front.t,
            state: self.front_state.clone(),
            before: Vec::new(),
            after: self.held.sides.clone(),
        });
        Ok(())
    }

    /// Notes where motions along surfaces begin and end.
    fn note_sides(&mut self, passage: Passage) {
        let Some(field) = self.engine.field_mut().switching() else { return };
        for (name, &side) in field.surfaces().iter().zip(&passage.after) {
            let open =
                self.held.slides.iter_mut().find(|slide| slide.until.is_none() && slide.surface == *name);
            match open {
                Some(slide) if side != 0.0 => slide.until = Some(passage.time),
                None if side == 0.0 => {
                    let slide = Slide { surface: name.clone(), from: passage.time, until: None };
                    self.held.slides.push(slide);
                }
                _ => {}
            }
        }
        if let Some(passages) = &mut self.held.passages {
            passages.push(passage);
        }
    }

    /// The parts of the motion so far in which it slides along surfaces on which the field jumps.
    pub fn slides(&self) -> &[Slide] {
        &self.held.slides
    }

    /// Holds the field on these sides permanently: from then on, the integration no longer looks
    /// for surfaces.
    #[cfg(feature = "cvode")] // for the adjoint equations
    pub(crate) fn stay_on(&mut self, sides: &[f64]) {
        self.hold_on(sides);
        self.held = HeldSides::default();
        let own = self.events.events().len();
        self.front.values.truncate(own);
        self.sides = Sides::new(directions(&self.events, &self.held));
        self.sides.pass(&self.front.values);
        self.sides_before = self.sides.clone();
    }

    /// The time span of interest: up to the end, or as long as many steps like the last one.
    fn span_of_interest(&self) -> f64 {
        let last = self.engine.last_step();
        match (self.engine.stop_time(), last.degree) {
            (Some(stop), _) if stop != self.front.t => (stop - self.front.t).abs(),
            (_, Some(_)) => 100.0 * (last.end - last.start).abs(),
            _ => 1.0,
        }
    }

    /// Holds the field on sides that have been decided, and notes where the functions are.
    fn take_sides(
        &mut self,
        decided: Result<Option<Vec<f64>>, Failure>,
        open: &Open,
    ) -> Result<(), SolveError> {
        let t = self.front.t;
        let sides = match decided {
            Ok(Some(sides)) => sides,
            Ok(None) => {
                let all = self.engine.field_mut().switching().map_or(&[][..], |field| field.surfaces());
                let surfaces = open.iter().filter_map(|&(surface, _)| all.get(surface).cloned()).collect();
                return Err(self.failed(Reason::Undecided { surfaces, t }, None));
            }
            Err(failure) => return Err(self.failed(Reason::Rates { t }, Some(failure))),
        };
        self.hold_on(&sides);
        (self.held.sides, self.held.are_known) = (sides, true);
        let state = self.front_state.clone();
        self.front.values = self.evaluate(t, &state)?;
        let first = self.events.events().len();
        for (surface, &side) in self.held.sides.iter().enumerate() {
            let value = self.front.values[first + surface];
            let is_open = open.iter().any(|&(other, _)| other == surface);
            // The margin of σ is positive where the motion slides.
            let side = if side == 0.0 { 1.0 } else { side };
            // What has jumped away from zero is on its side at once.
            let has_jumped = value * side > NEAR;
            let near =
                !has_jumped && (is_open || value * side <= 0.0 || self.due.contains(&(first + surface)));
            let noise = if near { 2.0 * value.abs().min(NEAR) } else { 0.0 };
            self.sides.set(first + surface, side, noise.max(f64::MIN_POSITIVE * f64::from(near)));
        }
        Ok(())
    }

    /// Holds the field on these sides.
    pub(crate) fn hold_on(&mut self, sides: &[f64]) {
        if let Some(field) = self.engine.field_mut().switching() {
            field.hold(Some(sides));
        }
    }
}

/// The magnitude above which the function of an open surface has jumped.
const NEAR: f64 = 1e-6;
