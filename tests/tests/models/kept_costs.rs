//! The length of print-outs and the operations of right-hand sides do not grow, of any model in any form.
//!
//! What they are is kept in a table. Where they have become less, or models are new, it is written anew by
//!
//! ```sh
//! KEEP_COSTS=1 cargo test -p pc-tests --test models neither_pages
//! ```

use std::fmt::Write;
use std::fs;
use std::path::Path;

use pc_print::{Form, Page};

use crate::derived::Derived;
use crate::findings::Costs;
use crate::pages::printed;

/// The forms that may be printed of any model.
const FORMS: [(&str, Form); 7] = [
    ("poincare", Form::Poincare),
    ("canonical", Form::Canonical),
    ("lagrange", Form::Lagrange),
    ("voronets", Form::Voronets),
    ("reduced", Form::Reduced),
    ("lie-poisson", Form::LiePoisson),
    ("orthonormal", Form::Orthonormal),
];

/// What is kept of a page: its characters, those of its longest line, and the operations with parameters free and bound.
const KEPT: [&str; 4] = ["characters", "longest line", "operations, parameters free", "operations, bound"];

/// Operations are said in lines such as `parameters free   24 = 2 add + …`.
fn operations(text: &str, of: &str) -> usize {
    let line = text.lines().find_map(|line| line.trim_start().strip_prefix(of)).unwrap();
    line.split_whitespace().next().unwrap().parse().unwrap()
}

fn costs_of(text: &str) -> [usize; 4] {
    let longest = text.lines().map(|line| line.chars().count()).max().unwrap();
    let (free, bound) = (operations(text, "parameters free "), operations(text, "parameters bound"));
    [text.chars().count(), longest, free, bound]
}

/// The costs of a model are measured; that none grows is said of the table of all.
pub(crate) fn neither_pages_nor_operations_grow(derived: &Derived<'_>) {
    let mut costs = Costs::new();
    for (form, of) in FORMS {
        let Some(text) = printed(derived, of, Page::Text) else { continue };
        costs.insert((derived.name.to_owned(), form.to_owned()), costs_of(&text));
    }
    derived.findings.borrow_mut().costs = costs;
}

fn written(costs: &Costs) -> String {
    let mut table =
        format!("{:32} {:12} {:>6} {:>4} {:>5} {:>5}\n", "model", "form", "chars", "line", "free", "bound");
    for ((name, form), [characters, longest, free, bound]) in costs {
        writeln!(table, "{name:32} {form:12} {characters:>6} {longest:>4} {free:>5} {bound:>5}").unwrap();
    }
    table
}

fn read(table: &str) -> Costs {
    let row = |line: &str| {
        let words: Vec<&str> = line.split_whitespace().collect();
        let number = |i: usize| words[i].parse().unwrap();
        ((words[0].to_owned(), words[1].to_owned()), [number(2), number(3), number(4), number(5)])
    };
    table.lines().skip(1).map(row).collect()
}

/// The claim of all models, in the table.
pub(crate) fn assert_kept(found: &Costs) {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("kept-costs.txt");
    if std::env::var_os("KEEP_COSTS").is_some() {
        fs::write(&path, written(found)).unwrap();
    }
    let table = fs::read_to_string(&path).unwrap();
    let kept = read(&table);
    assert_eq!(written(&kept), table, "the table is not as it was written");
    let mut grown = String::new();
    for (place @ (name, form), costs) in found {
        let Some(before) = kept.get(place) else {
            writeln!(grown, "{name}, {form}: not in the table").unwrap();
            continue;
        };
        for ((what, now), before) in KEPT.iter().zip(costs).zip(before) {
            if now > before {
                writeln!(grown, "{name}, {form}: {what} {before} -> {now}").unwrap();
            } else if now < before {
                eprintln!("less, to be kept: {name}, {form}: {what} {before} -> {now}");
            }
        }
    }
    for (name, form) in kept.keys().filter(|place| !found.contains_key(place)) {
        writeln!(grown, "{name}, {form}: is no more").unwrap();
    }
    assert!(grown.is_empty(), "\n{grown}");
}
