//! Prints for each model file how closely its two derivations agree.

use std::process::ExitCode;
use std::{env, fs};

use pc_model::{Document, Model};
use pc_verify::{Options, VerifyError, verify};

fn main() -> ExitCode {
    let mut all = true;
    for path in env::args().skip(1) {
        let outcome = fs::read(&path).map_err(|error| error.to_string()).and_then(|bytes| {
            let document = Document::from_bytes(path.as_str(), &bytes).map_err(|error| error.to_string())?;
            let model = Model::new(document);
            let options = Options::default();
            model.derived(|assembly| verify(&model, assembly, &options)).map_err(|error| match error {
                VerifyError::Model(error) => format!("refused: {}", error.diagnostic().message),
                error => error.to_string(),
            })
        });
        match outcome {
            Ok(agreement) => println!("{path}: {agreement}, worst in {}", agreement.quantity),
            Err(error) => {
                println!("{path}: {error}");
                all = false;
            }
        }
    }
    if all { ExitCode::SUCCESS } else { ExitCode::FAILURE }
}
