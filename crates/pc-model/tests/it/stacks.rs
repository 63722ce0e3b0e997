//! Derivations from threads with little stack.

#![cfg(feature = "any-stack")]

use std::thread;

use pc_model::{Document, Flow, Model, Source, Variables};
use pc_verify::{Options, verify};

/// The stack that `deep` requires of a thread.
const STACK: usize = 128 << 10;

/// The full derivation; with the second derivation for short models only.
fn on_small_stack(text: String, again: bool) {
    let derive = move || {
        let model = Model::new(Document::parse(Source::new("deep.toml", text)).unwrap());
        let graph = model.graph();
        let assembly = model.assemble(&graph).unwrap();
        let equations = assembly.equations().unwrap();
        assert_eq!(equations.right_hand_side().len(), 2);
        for variables in [Variables::QuasiVelocities, Variables::Momenta] {
            Flow::new(&model, &assembly, variables).unwrap();
        }
        pc_model::deep(|| {
            pc_print::page(
                pc_print::Form::Poincare,
                pc_print::Page::Text,
                &pc_print::Layout::default(),
                "deep",
                &assembly,
            )
        })
        .unwrap();
        if again {
            model
                .derived(|assembly| verify(&model, assembly, &Options { states: 3, ..Options::default() }))
                .unwrap();
        }
    };
    thread::Builder::new().stack_size(STACK).spawn(derive).unwrap().join().unwrap();
}

fn model(potential: &str, definitions: &str) -> String {
    format!(
        "[definitions]\n{definitions}\n[coordinates]\nx = 0.3\ny = 0.1\n\
         [lagrangian]\nkinetic = \"x'^2/2 + y'^2\"\npotential = \"{potential}\"\n"
    )
}

#[test]
fn functions_nest_up_to_the_limit() {
    on_small_stack(model(&format!("{}x + y{}", "sin(".repeat(199), ")".repeat(199)), ""), true);
}

#[test]
fn long_sums_are_handled() {
    let sum: Vec<String> = (1..5000).map(|i| format!("sin({i}*x)*y^{}", i % 3)).collect();
    on_small_stack(model(&sum.join(" + "), ""), false);
}

#[test]
fn nested_definitions_are_handled() {
    let chain: Vec<String> = (1..300).map(|i| format!("d{i} = \"sin(d{} + y)\"", i - 1)).collect();
    on_small_stack(model("d299", &format!("d0 = \"x\"\n{}", chain.join("\n"))), true);
}
