//! A notebook for Jupyter with a model, its equations and its motion.

use pc_model::{Document, Model, Source};
use serde_json::{Value, json};

use crate::args::input;
use crate::error::CliError;
use crate::live::request::Job;

/// The end of a motion of which the text says none.
const END: f64 = 10.0;

/// The notebook; `name` is that of the model.
///
/// # Errors
/// [`CliError`] for a text that is not valid, or values that it does not have.
pub(super) fn notebook(name: &str, job: &Job) -> Result<String, CliError> {
    let mut model = Model::new(Document::parse(Source::new(format!("{name}.toml"), job.text.as_str()))?);
    input::set(&mut model, &job.settings())?;
    let form = if job.form.is_empty() { String::new() } else { quoted(&job.form) };
    let end = job.t_end.or((model.document().simulation.t_end.is_none()).then_some(END));
    let cells = [
        markdown(&format!("# {}", model.title())),
        code(&format!(
            "import chetaev\n\nmodel = chetaev.Model.from_text({}, name={})\nmodel",
            literal(&job.text),
            quoted(name)
        )),
        code(&format!("model.derive({form})")),
        code("print(model.check())"),
        code(&format!(
            "system = model.system({})\nmotion = system.run({})\nmotion",
            values(&model, job),
            end.map_or_else(String::new, |t| format!("{t:?}"))
        )),
    ];
    let whole = json!({
        "cells": cells,
        "metadata": { "kernelspec": { "display_name": "Python 3", "language": "python", "name": "python3" } },
        "nbformat": 4,
        "nbformat_minor": 4,
    });
    Ok(format!("{whole:#}\n"))
}

/// The values that were set, as arguments of `Model.system`.
fn values(model: &Model, job: &Job) -> String {
    let parameters = model.parameter_names();
    let (of_parameters, of_starts): (Vec<_>, Vec<_>) =
        job.set.iter().partition(|(name, _)| parameters.iter().any(|known| known == *name));
    let listed = |keyword: &str, list: &[(&String, &String)]| {
        let entries: Vec<String> =
            list.iter().map(|(name, value)| format!("{}: {value}", quoted(name))).collect();
        (!entries.is_empty()).then(|| format!("{keyword}={{{}}}", entries.join(", ")))
    };
    let all = [listed("parameters", &of_parameters), listed("start", &of_starts)];
    all.into_iter().flatten().collect::<Vec<_>>().join(", ")
}

/// A text as a literal of Python, on several lines where that is the text itself.
fn literal(text: &str) -> String {
    let is_plain = !text.contains('\\') && !text.contains("\"\"\"");
    if is_plain { format!("\"\"\"\n{text}\"\"\"") } else { quoted(text) }
}

/// JSON quotes as Python does.
fn quoted(text: &str) -> String {
    Value::from(text).to_string()
}

fn markdown(text: &str) -> Value {
    json!({ "cell_type": "markdown", "metadata": {}, "source": text })
}

fn code(text: &str) -> Value {
    json!({ "cell_type": "code", "execution_count": null, "metadata": {}, "outputs": [], "source": text })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn values_go_where_they_belong() {
        let text = "[parameters]\nm = 1\n[coordinates]\nx = \"m\"\n[lagrangian]\nlagrangian = \"m*x'^2/2\"";
        let job = json!({ "text": text, "set": { "m": "2.5", "x": "1" }, "form": "kane" });
        let whole = notebook("a \"b\"", &serde_json::from_value(job).unwrap()).unwrap();
        let read: Value = serde_json::from_str(&whole).unwrap();
        let source = |cell: usize| read["cells"][cell]["source"].as_str().unwrap();
        assert_eq!(source(2), "model.derive(\"kane\")");
        assert!(
            source(1).contains("from_text(\"\"\"\n[parameters]\nm = 1\n")
                && source(1).contains("name=\"a \\\"b\\\"\"")
        );
        let run = "system = model.system(parameters={\"m\": 2.5}, start={\"x\": 1})\nmotion = system.run(10.0)\nmotion";
        assert_eq!(source(4), run);
        assert_eq!(literal("a\\b"), "\"a\\\\b\"");
    }
}
