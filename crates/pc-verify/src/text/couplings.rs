//! The pairs of velocities that occur together in a term of the energy.
//!
//! If no term contains both w_r and w_s, ∂²L/∂w_r∂w_s vanishes and need not be computed: n uncoupled
//! coordinates cost n evaluations of L instead of n². An error here would remove an entry of the mass matrix,
//! and the derivations would disagree.

use crate::text::body::Turning;
use crate::text::term::Term;
use crate::text::text::{Text, Velocities};

/// The pairs of velocities that occur together in a term of the energy.
#[derive(Clone, Debug)]
pub(crate) struct Couplings(Vec<Set>);

impl Couplings {
    /// The couplings in the energy of a text.
    pub(crate) fn of(text: &Text) -> Couplings {
        let mut reader = Reader::new(text);
        let energy = [&text.kinetic, &text.potential, &text.lagrangian];
        reader.summands(energy.into_iter().flatten().collect());
        reader.bodies();
        Couplings(reader.coupled)
    }

    /// Whether some term contains both velocities.
    pub(crate) fn has(&self, r: usize, s: usize) -> bool {
        self.0[r].has(s)
    }

    /// The number of coupled pairs r ≤ s.
    pub(crate) fn pairs(&self) -> usize {
        let (both, alone) =
            self.0.iter().enumerate().fold((0, 0), |(both, alone), (r, with)| {
                (both + with.len(), alone + usize::from(with.has(r)))
            });
        (both + alone) / 2
    }
}

/// A set of numbers.
#[derive(Clone, Debug)]
struct Set(Vec<u64>);

impl Set {
    fn empty(size: usize) -> Set {
        Set(vec![0; size.div_ceil(64)])
    }

    fn has(&self, i: usize) -> bool {
        self.0[i / 64] >> (i % 64) & 1 == 1
    }

    fn insert(&mut self, i: usize) {
        self.0[i / 64] |= 1 << (i % 64);
    }

    fn join(&mut self, other: &Set) {
        self.0.iter_mut().zip(&other.0).for_each(|(all, more)| *all |= more);
    }

    fn len(&self) -> usize {
        self.0.iter().map(|word| word.count_ones() as usize).sum()
    }
}

/// The coordinates and velocities w in a term, and whether it contains first-order states.
#[derive(Clone, Debug)]
struct Contents {
    coordinates: Set,
    velocities: Set,
    states: bool,
}

impl Contents {
    fn join(&mut self, other: &Contents) {
        self.coordinates.join(&other.coordinates);
        self.velocities.join(&other.velocities);
        self.states |= other.states;
    }
}

/// A reader of terms, which knows what some or all of the names of a text contain.
struct Reader<'a> {
    text: &'a Text,
    n: usize,
    k: usize,
    /// The contents of definitions, and of the expressions for ẋ or η, as far as they have been read.
    definitions: Vec<Option<Contents>>,
    moving: Vec<Option<Contents>>,
    coupled: Vec<Set>,
}

impl<'a> Reader<'a> {
    fn new(text: &'a Text) -> Reader<'a> {
        let n = text.coordinates();
        let (k, moving) = match &text.velocities {
            Velocities::Ordinary(definitions) => (n, definitions),
            Velocities::Quasi(rates) => (text.names.quasi_velocities.len(), rates),
        };
        let mut reader = Reader {
            text,
            n,
            k,
            definitions: vec![None; text.definitions.len()],
            moving: vec![None; moving.len()],
            coupled: vec![Set::empty(k); k],
        };
        // A definition may contain earlier ones and velocities, and a velocity may contain definitions.
        reader.read_definitions();
        for (i, term) in moving.iter().enumerate() {
            reader.moving[i] = Some(reader.contents(term));
        }
        reader.read_definitions();
        reader
    }

    fn read_definitions(&mut self) {
        for (j, term) in self.text.definitions.iter().enumerate() {
            self.definitions[j] = Some(self.contents(term));
        }
    }

    fn nothing(&self) -> Contents {
        let (coordinates, velocities) = (Set::empty(self.n), Set::empty(self.k));
        Contents { coordinates, velocities, states: false }
    }

    /// Adds contents to `all`; if they are unknown, they may be anything.
    fn add_known(&self, known: Option<&Contents>, all: &mut Contents) {
        if let Some(known) = known {
            return all.join(known);
        }
        (0..self.n).for_each(|i| all.coordinates.insert(i));
        (0..self.k).for_each(|s| all.velocities.insert(s));
        all.states = true;
    }

    /// Adds a velocity to `all`: the velocity is one of w or, if it is given `by_terms`, stands for the
    /// contents of those terms.
    fn add_velocity(&self, i: usize, by_terms: bool, all: &mut Contents) {
        match by_terms {
            true => self.add_known(self.moving[i].as_ref(), all),
            false => all.velocities.insert(i),
        }
    }

    fn is_quasi(&self) -> bool {
        matches!(self.text.velocities, Velocities::Quasi(_))
    }

    fn contents(&self, term: &Term) -> Contents {
        let mut all = self.nothing();
        self.add(term, &mut all);
        all
    }

    fn add(&self, term: &Term, all: &mut Contents) {
        match term {
            Term::Number(_) | Term::Time | Term::Parameter(_) | Term::Reaction(_) | Term::Resultant(_) => {}
            Term::Coordinate(i) => all.coordinates.insert(*i),
            Term::OfBody(..) => self.add_known(None, all),
            Term::Velocity(i) => self.add_velocity(*i, self.is_quasi(), all),
            Term::QuasiVelocity(s) => self.add_velocity(*s, !self.is_quasi(), all),
            Term::State(_) => all.states = true,
            Term::Definition(j) => self.add_known(self.definitions[*j].as_ref(), all),
            Term::Rate(inner) => all.join(&self.rate(&self.contents(inner))),
            Term::Sum(parts) | Term::Product(parts) => parts.iter().for_each(|(_, part)| self.add(part, all)),
            Term::Negative(inner) => self.add(inner, all),
            Term::Power(base, exponent) => [base, exponent].into_iter().for_each(|part| self.add(part, all)),
            Term::Call(_, arguments) => arguments.iter().for_each(|argument| self.add(argument, all)),
        }
    }

    /// What the rate of a term may contain, given what the term contains.
    fn rate(&self, inner: &Contents) -> Contents {
        let mut all = inner.clone();
        if inner.states || inner.velocities.len() > 0 {
            self.add_known(None, &mut all);
        }
        for i in (0..self.n).filter(|&i| inner.coordinates.has(i)) {
            self.add_velocity(i, self.is_quasi(), &mut all);
        }
        all
    }

    /// Couples the velocities that occur together in a summand of these terms.
    fn summands(&mut self, mut terms: Vec<&'a Term>) {
        let text = self.text;
        let mut seen = vec![false; text.definitions.len()];
        while let Some(term) = terms.pop() {
            match term {
                Term::Sum(parts) => terms.extend(parts.iter().map(|(_, part)| part)),
                Term::Negative(inner) => terms.push(inner),
                Term::Definition(j) => {
                    if !std::mem::replace(&mut seen[*j], true) {
                        terms.push(&text.definitions[*j]);
                    }
                }
                Term::Product(parts) => {
                    let moves = |part: &&(bool, Term)| self.contents(&part.1).velocities.len() > 0;
                    let moving: Vec<_> = parts.iter().filter(moves).collect();
                    match moving.as_slice() {
                        [] => {}
                        [(false, one)] => terms.push(one),
                        _ => self.couple(&self.contents(term)),
                    }
                }
                _ => self.couple(&self.contents(term)),
            }
        }
    }

    fn bodies(&mut self) {
        for body in &self.text.bodies {
            let mass = self.contents(&body.mass);
            for part in &body.position {
                let mut energy = self.rate(&self.contents(part));
                energy.join(&mass);
                self.couple(&energy);
            }
            let mut turning = self.nothing();
            match &body.turning {
                Some(Turning::Rotation(terms)) => {
                    terms.iter().for_each(|term| turning.join(&self.rate(&self.contents(term))));
                }
                Some(Turning::AngularVelocity(terms)) => {
                    terms.iter().for_each(|term| turning.join(&self.contents(term)));
                }
                None => {}
            }
            body.inertia.iter().flatten().for_each(|entry| turning.join(&self.contents(entry)));
            self.couple(&turning);
            // Terms of gravity and of force functions contain velocities only if they are written with them.
            let mut forced = mass;
            let terms = body.position.iter().chain(&body.force).chain(&self.text.gravity);
            terms.for_each(|term| forced.join(&self.contents(term)));
            self.couple(&forced);
        }
    }

    fn couple(&mut self, contents: &Contents) {
        for r in (0..self.k).filter(|&r| contents.velocities.has(r)) {
            self.coupled[r].join(&contents.velocities);
        }
    }
}

#[cfg(test)]
mod tests {
    use pc_model::{Document, Model, Source};

    use super::*;

    fn couplings(text: &str) -> Couplings {
        let document = Document::parse(Source::new("model.toml", text.to_owned())).expect("a model");
        Couplings::of(&Text::new(&Model::new(document)).expect("terms"))
    }

    #[test]
    fn velocities_of_one_summand_are_coupled() {
        let couplings = couplings(
            "[coordinates]\na = 0\nb = 0\nc = 0\ne = 0\n[definitions]\nboth = \"a' + sin(b)*b'\"\n\
             [lagrangian]\nkinetic = \"(a'^2 + b'^2 + e'^2 + c'*both)/2 - (e' + 1)*cos(c)\"\npotential = \"a*b*c*e\"\n",
        );
        let pairs: Vec<(usize, usize)> =
            (0..4).flat_map(|r| (r..4).map(move |s| (r, s))).filter(|&(r, s)| couplings.has(r, s)).collect();
        // For the product c'·both the squared velocities are not determined separately.
        assert_eq!(pairs, [(0, 0), (0, 1), (0, 2), (1, 1), (1, 2), (2, 2), (3, 3)]);
        assert_eq!(couplings.pairs(), pairs.len());
    }

    #[test]
    fn velocities_are_those_that_the_kinematics_give() {
        let couplings = couplings(
            "[coordinates]\nx = 0\ny = 0\nz = 0\n[quasi_velocities]\nu = 0\nv = 0\nw = 0\n\
             [kinematics]\nx = \"u + y*v\"\ny = \"v\"\nz = \"w\"\n\
             [bodies.ball]\nmass = 1\nposition = [\"x\", \"y\", \"z\"]\n",
        );
        let is = [[true, true, false], [true, true, false], [false, false, true]];
        (0..3).for_each(|r| (0..3).for_each(|s| assert_eq!(couplings.has(r, s), is[r][s], "{r} {s}")));
    }
}
