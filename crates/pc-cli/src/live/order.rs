//! What the buttons of the page ask for, as command lines.

use pc_model::Variables;
use pc_print::Form;

use crate::live::request::{Job, Order};

/// A command of this program, without the model and the place of its result.
pub(super) struct Line {
    /// The name of the command.
    pub(super) command: &'static str,
    /// Its options.
    pub(super) options: Vec<String>,
    /// The result, if it is not what the command prints.
    pub(super) file: Option<Written>,
}

/// The file that a command writes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Written {
    /// A file with this extension.
    File(&'static str),
    /// Several files in a directory, which become an archive.
    Directory,
}

/// The command that prints something, if there is one of this name.
pub(super) fn printed(order: &Order) -> Option<Line> {
    let job = &order.job;
    let (command, options) = match order.what.as_str() {
        "check" => ("check", Vec::new()),
        "theory" => ("theory", Vec::new()),
        "linearize" => ("linearize", Vec::new()),
        "equilibria" => ("equilibria", Vec::new()),
        "derive" => ("derive", form(job, |_| true)),
        _ => return None,
    };
    Some(line(command, job, &options, None))
}

/// The command that makes a file, if there is one of this name.
pub(super) fn made(order: &Order) -> Option<Line> {
    let job = &order.job;
    let of_motion = || [form(job, is_integrated), end(job)].concat();
    let emitted = |options: &[&str]| [owned(options), form(job, is_emitted)].concat();
    let (command, options, file) = match order.what.as_str() {
        "report" => ("report", of_motion(), Written::File("html")),
        "animate" => ("animate", of_motion(), Written::File("html")),
        "csv" => ("run", of_motion(), Written::File("csv")),
        "png" => {
            ("animate", [of_motion(), given("--time", order.at.as_deref())].concat(), Written::File("png"))
        }
        "sweep" => {
            ("sweep", [of_motion(), given("--vary", order.vary.as_deref())].concat(), Written::File("csv"))
        }
        "latex" => {
            ("derive", [owned(&["--format", "latex"]), form(job, |_| true)].concat(), Written::File("tex"))
        }
        "c" => ("emit", emitted(&["--lang", "c"]), Written::Directory),
        "rust" => ("emit", emitted(&["--lang", "rust"]), Written::Directory),
        "fmu" => ("emit", emitted(&["--fmu", "3"]), Written::File("fmu")),
        _ => return None,
    };
    Some(line(command, job, &options, Some(file)))
}

fn line(command: &'static str, job: &Job, more: &[String], file: Option<Written>) -> Line {
    // What a sweep varies has no single value.
    let varied = |name: &str| more.iter().any(|option| option.starts_with(&format!("--vary={name}=")));
    // As one argument, a value that begins with a dash is no option.
    let set =
        job.set.iter().filter(|(name, _)| !varied(name)).map(|(name, value)| format!("--set={name}={value}"));
    Line { command, options: set.chain(more.iter().cloned()).collect(), file }
}

/// The chosen form, if the command takes it.
fn form(job: &Job, takes: impl Fn(Form) -> bool) -> Vec<String> {
    Form::named(&job.form)
        .filter(|form| takes(*form))
        .map(|form| format!("--form={}", form.name()))
        .into_iter()
        .collect()
}

fn is_integrated(form: Form) -> bool {
    form.variables().is_some()
}

fn is_emitted(form: Form) -> bool {
    form.variables().is_some_and(|variables: Variables| !variables.has_momenta())
}

fn end(job: &Job) -> Vec<String> {
    given("--t-end", job.t_end.map(|t| t.to_string()).as_deref())
}

fn given(option: &str, value: Option<&str>) -> Vec<String> {
    value.map(|value| format!("{option}={value}")).into_iter().collect()
}

fn owned(words: &[&str]) -> Vec<String> {
    words.iter().map(|&word| word.to_owned()).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn order(what: &str, rest: &str) -> Order {
        serde_json::from_str(&format!("{{\"what\":\"{what}\",\"text\":\"\"{rest}}}")).unwrap()
    }

    #[test]
    fn a_command_takes_what_it_knows() {
        let arguments = |what: &str, rest: &str| {
            let order = order(what, rest);
            printed(&order)
                .or_else(|| made(&order))
                .map(|line| [&[line.command.to_owned()], line.options.as_slice()].concat().join(" "))
        };
        let all = r#","set":{"a":"-1"},"form":"kane","t_end":2.5,"at":"1"#;
        let all = format!("{all}\",\"vary\":\"a=0:1:3\"");
        for (what, line) in [
            ("check", "check --set=a=-1"),
            ("derive", "derive --set=a=-1 --form=kane"),
            ("csv", "run --set=a=-1 --t-end=2.5"),
            ("png", "animate --set=a=-1 --t-end=2.5 --time=1"),
            ("sweep", "sweep --t-end=2.5 --vary=a=0:1:3"),
            ("c", "emit --set=a=-1 --lang c"),
        ] {
            assert_eq!(arguments(what, &all).as_deref(), Some(line));
        }
        assert_eq!(arguments("csv", r#","form":"canonical""#).as_deref(), Some("run --form=canonical"));
        assert_eq!(arguments("fmu", r#","form":"canonical""#).as_deref(), Some("emit --fmu 3"));
        for unknown in ["", "import", "new", "--help", "check --output=x"] {
            assert_eq!(arguments(unknown, ""), None, "{unknown}");
        }
    }
}
