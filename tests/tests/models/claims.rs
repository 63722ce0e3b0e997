//! All claims, and the models of which they are made.

use std::collections::BTreeMap;
use std::fs;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::Path;
use std::sync::{LazyLock, OnceLock};

use pc_model::BUILTIN;

use crate::derived::Derived;
use crate::findings::Findings;
use crate::{
    backends, bound_programs, derived_equations, estimates, forms_agree, free_forms, kept_costs, measures,
    printed_pages, reference_states, taylor_references, theory,
};

/// Claims by their names, in the order in which they are made.
type Claims = &'static [(&'static str, for<'d, 'g> fn(&'d Derived<'g>))];

macro_rules! claims {
    ($($claim:path),* $(,)?) => {
        &[$((stringify!($claim), $claim)),*]
    };
}

const OF_BUILT_IN_MODELS: Claims = claims![
    kept_costs::neither_pages_nor_operations_grow,
    printed_pages::pages_of_built_in_models_agree_with_their_equations,
    derived_equations::derived_equations_are_the_classical_ones,
    derived_equations::without_folding_they_are_the_same,
    derived_equations::equations_with_multipliers_are_the_classical_ones,
    derived_equations::they_are_those_of_the_definition,
    forms_agree::canonical_equations_are_poincares,
    forms_agree::lagranges_equations_are_poincares,
    free_forms::all_models_move_alike_in_reduced_and_orthonormal_form,
    free_forms::all_models_move_alike_in_quasi_velocities_given_at_random,
    bound_programs::bound_programs_cost_no_more_than_free_ones,
    bound_programs::bound_programs_compute_what_free_ones_do,
    backends::compiled_equations_agree_to_rounding_of_the_largest_term,
    backends::exactly_compiled_equations_have_the_same_bits,
    theory::integrals_of_all_models_are_kept_at_random_states,
    theory::the_equations_that_remain_have_the_motions_of_the_whole,
    measures::measures_of_known_systems_are_kept,
    reference_states::adams_reaches_the_references,
    reference_states::bdf_reaches_the_references,
    reference_states::dop853_reaches_the_references,
    reference_states::the_choice_of_methods_reaches_the_references,
    reference_states::dop853_comes_back_to_the_starts,
    reference_states::the_canonical_equations_reach_the_references,
    reference_states::lagranges_equations_reach_the_references,
    taylor_references::taylor_reaches_the_references_and_comes_back,
    estimates::errors_are_estimated_within_a_factor_of_ten,
];

const OF_MECHANISMS: Claims = claims![
    kept_costs::neither_pages_nor_operations_grow,
    printed_pages::pages_of_mechanisms_agree_with_their_equations,
    bound_programs::bound_programs_cost_no_more_than_free_ones,
];

/// A model with the claims that are made of it.
struct Entry {
    text: String,
    claims: Claims,
    /// What came of them, whichever test asks first.
    outcome: OnceLock<Outcome>,
}

/// What was found of a model.
struct Outcome {
    findings: Findings,
    /// The claims that do not hold.
    wrong: Vec<&'static str>,
}

impl Entry {
    fn new(text: String, claims: Claims) -> Entry {
        Entry { text, claims, outcome: OnceLock::new() }
    }

    /// Makes all claims, once. Those that do not hold say so by the messages of their panics, and are named.
    fn outcome(&self, name: &str) -> &Outcome {
        let made = |derived: &Derived<'_>| {
            let fails = |claim: fn(&Derived<'_>)| catch_unwind(AssertUnwindSafe(|| claim(derived))).is_err();
            let wrong =
                self.claims.iter().filter(|&&(_, claim)| fails(claim)).map(|&(name, _)| name).collect();
            Outcome { findings: derived.findings.take(), wrong }
        };
        self.outcome.get_or_init(|| Derived::of(name, &self.text, made))
    }
}

/// Models by their names.
pub(crate) struct Models(BTreeMap<String, Entry>);

pub(crate) static BUILT_IN: LazyLock<Models> = LazyLock::new(|| {
    let entry = |text: &str| Entry::new(text.to_owned(), OF_BUILT_IN_MODELS);
    Models(BUILTIN.iter().map(|model| (model.name.to_owned(), entry(model.text))).collect())
});

/// The models of the folder `mechanisms`.
pub(crate) static MECHANISMS: LazyLock<Models> = LazyLock::new(|| {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("mechanisms");
    let named = |path: &Path| {
        let name = path.file_stem().unwrap().to_string_lossy().into_owned();
        (name, Entry::new(fs::read_to_string(path).unwrap(), OF_MECHANISMS))
    };
    Models(fs::read_dir(folder).unwrap().map(|entry| named(&entry.unwrap().path())).collect())
});

impl Models {
    /// The names as those of tests.
    pub(crate) fn tests(&self) -> Vec<String> {
        self.0.keys().map(|name| name.replace('-', "_")).collect()
    }

    /// All claims hold of a model, which is named as its test is.
    #[track_caller]
    pub(crate) fn assert_claims(&self, test: &str) {
        let (name, entry) = self.0.iter().find(|(name, _)| name.replace('-', "_") == test).unwrap();
        let wrong = &entry.outcome(name).wrong;
        assert!(wrong.is_empty(), "of {name} these claims do not hold: {}", wrong.join(", "));
    }

    /// What was found of each model.
    pub(crate) fn findings(&self) -> impl Iterator<Item = &Findings> {
        self.0.iter().map(|(name, entry)| &entry.outcome(name).findings)
    }
}
