//! The brackets of the integrals, by Poisson's theorem, and whether the integrals suffice.

use pc_analysis::{
    AnalysisError, BracketAlgebra, BracketMeaning, Conservation, ConservationVerdict, DenotedFunction,
    Integral, Integrals, PairBracket, PoissonBracket, Rates,
};
use pc_expr::parse::{AstKind, parse};
use pc_mech::{Canonical, Expr};

use crate::theory::basis::Basis;
use crate::theory::description::{Entry, Section, Side, Verdict};

/// The largest number of variables of a bracket in which the brackets of integrals are formed.
const MOST_VARIABLES: usize = 24;
/// The largest number of integrals whose brackets are formed.
const MOST_INTEGRALS: usize = 12;
/// The largest number of integrals that are added.
const MOST_NEW: usize = 6;

/// The integrals whose brackets are formed, with the bracket.
struct Table<'a, 'g> {
    canonical: &'a Canonical<'g>,
    rates: Rates<'g>,
    bracket: PoissonBracket<'g>,
    integrals: Vec<(&'a Integral<'g>, DenotedFunction<'g>)>,
    /// Whether all integrals are conserved for all values of the parameters.
    always: bool,
}

/// The section on the brackets of integrals; none where Poisson's theorem does not apply: under nonholonomic constraints and
/// with forces.
pub(crate) fn section<'g>(
    ground: &Basis<'_, 'g>,
    bracket: Option<&PoissonBracket<'g>>,
    integrals: &Integrals<'g>,
) -> Result<Section<'g>, AnalysisError> {
    let section = |entries| Section {
        key: "brackets_of_integrals",
        title: "Brackets of integrals",
        names: Vec::new(),
        entries,
    };
    let Some(table) = bracket.and_then(|bracket| Table::new(ground, bracket, integrals)) else {
        return Ok(section(Vec::new()));
    };
    let functions: Vec<DenotedFunction<'g>> = table.integrals.iter().map(|&(_, function)| function).collect();
    let new = symbols(ground, "N", functions.iter().map(|f| f.symbol.to_string()).collect(), MOST_NEW);
    let algebra = table.bracket.algebra(&functions, &new)?;
    let mut entries = table.entries(&algebra)?;
    entries.extend(table.sufficiency(&algebra)?);
    Ok(section(entries))
}

impl<'a, 'g> Table<'a, 'g> {
    fn new(
        ground: &'a Basis<'_, 'g>,
        bracket: &PoissonBracket<'g>,
        integrals: &'a Integrals<'g>,
    ) -> Option<Table<'a, 'g>> {
        let canonical = ground.canonical.as_ref().ok()?;
        let is_forced = ground.free.forces().iter().any(|q| !q.is_zero());
        let is_large = bracket.variables().len() > MOST_VARIABLES;
        if ground.constrained.is_some() || is_forced || is_large || !ground.free.states().is_empty() {
            return None;
        }
        let rates = Rates::canonical(canonical);
        let conserved: Vec<&Integral<'g>> =
            integrals.conserved().filter(|integral| !integral.jumps).collect();
        let always = conserved.iter().all(|integral| integral.verdict == ConservationVerdict::Conserved);
        let at = |f: Expr<'g>| if always { f } else { rates.at_present(f) };
        let bracket = if always { bracket.clone() } else { bracket.at_present(&rates) };
        let in_momenta =
            conserved.into_iter().map(|integral| (integral, at(canonical.in_momenta(integral.value))));
        let readable: Vec<(&Integral<'g>, Expr<'g>)> = in_momenta
            .filter(|&(_, value)| value.constant().is_none() && bracket.field(value).is_ok())
            .collect();
        if !(2..=MOST_INTEGRALS).contains(&readable.len()) {
            return None;
        }
        let symbols = denoting(ground, readable.iter().map(|&(integral, _)| integral));
        let integrals = readable.into_iter().zip(symbols);
        let integrals = integrals
            .map(|((integral, value), symbol)| (integral, DenotedFunction { symbol, value }))
            .collect();
        Some(Table { canonical, rates, bracket, integrals, always })
    }

    /// What is proved of these integrals.
    fn proved(&self) -> Verdict {
        if self.always { Verdict::Proved } else { Verdict::ProvedHere }
    }

    /// The brackets that are not zero, after the meaning of the symbols in them.
    fn entries(&self, algebra: &BracketAlgebra<'g>) -> Result<Vec<Entry<'g>>, AnalysisError> {
        if algebra.is_commutative() {
            return Ok(vec![
                Entry::words("all are zero: the integrals are in involution").with(self.proved()),
            ]);
        }
        let in_use = |place: usize| {
            let symbol = algebra.functions()[place].symbol;
            algebra.pairs().iter().any(|pair| match pair.meaning {
                _ if pair.value.is_zero() => false,
                BracketMeaning::Polynomial(polynomial) if polynomial.depends_on(symbol) => true,
                _ => pair.pair.contains(&place),
            })
        };
        // H stands among the momenta.
        let is_known = |f: &DenotedFunction<'g>| (f.value - self.canonical.hamiltonian()).is_zero();
        let legend =
            self.integrals.iter().enumerate().filter(|&(place, (_, f))| in_use(place) && !is_known(f));
        let legend = legend.map(|(_, (integral, f))| {
            let entry = Entry::formula(Side::of(f.symbol), Side::of(f.value));
            if f.symbol.to_string() == integral.name { entry } else { entry.named(integral.name.clone()) }
        });
        let mut entries: Vec<Entry<'g>> = legend.collect();
        for pair in algebra.pairs().iter().filter(|pair| !pair.value.is_zero()) {
            entries.push(self.entry(algebra, pair)?);
        }
        if algebra.pairs().iter().any(|pair| pair.value.is_zero()) {
            entries.push(Entry::words("all other brackets are zero"));
        }
        Ok(entries)
    }

    /// The bracket of a pair.
    fn entry(
        &self,
        algebra: &BracketAlgebra<'g>,
        pair: &PairBracket<'g>,
    ) -> Result<Entry<'g>, AnalysisError> {
        let [f, g] = pair.pair.map(|place| algebra.functions()[place].symbol);
        let equals = |right: Side<'g>| Entry::formula(Side::bracket(f, g), right);
        Ok(match pair.meaning {
            BracketMeaning::Polynomial(polynomial) => equals(Side::of(polynomial)).with(self.proved()),
            BracketMeaning::New(place) => {
                let new = algebra.functions()[place];
                // The theorem says that it is an integral; its rate along the equations says so again.
                let rate = self.rates.verdict(new.value)?;
                let verdict = match rate {
                    Conservation::Conserved if self.always => Verdict::Proved,
                    Conservation::Conserved | Conservation::ConservedHere => Verdict::ProvedHere,
                    Conservation::ConservedBetweenJumps | Conservation::Changing(_) => Verdict::Open,
                };
                let mut entry = equals(Side::of(new.symbol)).with(verdict);
                entry.formulas.push((Side::of(new.symbol), Side::of(new.value)));
                entry.say("a new integral, by Poisson's theorem")
            }
            BracketMeaning::Dependent => equals(Side::of(pair.value))
                .with(self.proved())
                .say("a function of these integrals that is not found as a polynomial in them"),
            BracketMeaning::Undecided => {
                Entry::words(format!("({f}, {g}) is an integral that is not expressed through these"))
                    .with(Verdict::Open)
            }
        })
    }

    /// Whether the integrals suffice to integrate a motion that does not depend on time.
    fn sufficiency(&self, algebra: &BracketAlgebra<'g>) -> Result<Option<Entry<'g>>, AnalysisError> {
        let time = self.canonical.system().frame().time();
        let values: Vec<Expr<'g>> = algebra.functions().iter().map(|f| f.value).collect();
        let has_energy = self.integrals.iter().any(|(integral, _)| integral.is_energy());
        let is_steady = self.bracket.time_momentum().is_none() && !values.iter().any(|f| f.depends_on(time));
        if !(has_energy && is_steady && algebra.is_closed()) {
            return Ok(None);
        }
        let found = self.bracket.integrability(&values)?;
        let (d, rank, leaf) = (found.independent, found.bracket_rank, found.leaf);
        let integrals = if d == 1 { "integral" } else { "integrals" };
        let place = match self.bracket.variables().len() > leaf {
            true => format!("on levels of the Casimirs of dimension {leaf}"),
            false => format!("in dimension {leaf}"),
        };
        let have = match rank {
            0 => format!("{d} independent {integrals} in involution {place}"),
            _ => format!("{d} independent {integrals} with brackets of rank {rank} {place}"),
        };
        Ok(Some(match (found.torus(), rank) {
            (Some(n), 0) => Entry::words(format!(
                "integrable by Liouville's theorem: {have}; where their levels are compact, these are tori of dimension {n}"
            ))
            .with(self.proved()),
            (Some(n), _) => Entry::words(format!(
                "integrable by the theorem of Mishchenko and Fomenko: {have}; where their levels are compact, these are tori \
                 of dimension {n}"
            ))
            .with(self.proved()),
            (None, _) => Entry::words(format!(
                "these integrals do not suffice: {have}; 2·{d} − {rank} is not {leaf} (Liouville; Mishchenko and Fomenko)"
            )),
        }))
    }
}

/// The symbol of each integral: H for the energy, its own name where that is a name in the language of models and no other
/// symbol has it, else a letter with a number.
fn denoting<'a, 'g: 'a>(
    ground: &Basis<'_, 'g>,
    integrals: impl Iterator<Item = &'a Integral<'g>>,
) -> Vec<Expr<'g>> {
    let graph = ground.free.graph();
    let taken = taken(ground);
    let own = |integral: &Integral<'g>| match integral.is_energy() {
        true => Some("H".to_owned()),
        false => Some(integral.name.clone()).filter(|name| is_name(name)),
    };
    let mut names: Vec<Option<String>> = Vec::new();
    for integral in integrals {
        let name = own(integral).filter(|name| !taken.contains(name) && !names.contains(&Some(name.clone())));
        names.push(name);
    }
    let known = names.iter().flatten().cloned().collect();
    let mut numbered = symbols(ground, "F", known, names.len()).into_iter();
    let symbol = |name: Option<String>| match name {
        Some(name) => Some(graph.symbol(&name)),
        None => numbered.next(),
    };
    names.into_iter().filter_map(symbol).collect()
}

/// So many symbols: a letter, `letter` if that is possible, and numbers, none of which is a name of the model or `known`.
fn symbols<'g>(ground: &Basis<'_, 'g>, letter: &str, known: Vec<String>, count: usize) -> Vec<Expr<'g>> {
    let taken = [taken(ground), known].concat();
    let name = |letter: &str, number: usize| format!("{letter}{number}");
    let is_free = |letter: &&str| !(1..=count).any(|number| taken.contains(&name(letter, number)));
    let letter = [letter, "F_", "I_", "Φ_"].into_iter().find(is_free).unwrap_or("F__");
    (1..=count).map(|number| ground.free.graph().symbol(&name(letter, number))).collect()
}

/// The names that have a meaning in the model.
fn taken(ground: &Basis<'_, '_>) -> Vec<String> {
    let (all, free) = (ground.assembly.system.symbols(), ground.free.symbols());
    let symbols = all.into_iter().chain(free).chain(ground.free.momentum_symbols());
    let defined = ground.assembly.definitions.iter().map(|(name, _)| name.clone());
    symbols.map(|symbol| symbol.to_string()).chain(defined).collect()
}

/// Whether the text is a name in the language of models.
fn is_name(text: &str) -> bool {
    parse(text).is_ok_and(|ast| ast.kind == AstKind::Name(text.to_owned()))
}
