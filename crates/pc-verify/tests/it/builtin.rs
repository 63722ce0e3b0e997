//! The models that come with the library, derived twice.

use pc_model::{BUILTIN, Model};
use pc_verify::{Options, TOLERANCE, verify};

#[test]
fn built_in_models_agree_by_both_routes() {
    let mut failures = Vec::new();
    for builtin in BUILTIN {
        let model = Model::new(builtin.document().unwrap());
        match model
            .derived(|assembly| verify(&model, assembly, &Options { states: 20, ..Options::default() }))
        {
            Ok(agreement) => {
                println!("{}: {agreement}, {:?}", builtin.name, agreement);
                if agreement.states < 20 || agreement.error > TOLERANCE || !agreement.not_compared.is_empty()
                {
                    failures.push(format!("{}: {agreement:?}", builtin.name));
                }
            }
            Err(error) => failures.push(format!("{}: {error}", builtin.name)),
        }
    }
    assert!(failures.is_empty(), "{}", failures.join("\n"));
}
