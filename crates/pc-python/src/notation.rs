//! Options in messages, which are written as options of the program and turned into arguments of Python here.

/// Options that have a value, or another name in Python.
const PHRASES: [(&str, &str); 13] = [
    (
        "give them after the model, as in `pc derive MODEL --form hamel \"v = r*φ'\"`",
        "give them as `velocities={\"v\": \"r*φ'\"}`",
    ),
    ("`--limit-memory`, `--limit-time`; in C `memory_limit`, `time_limit`", "`limit_memory`, `limit_time`"),
    (
        "--project-start (--keep NAMES holds what is to stay)",
        "`project_start=True` (`hold` names what is to stay)",
    ),
    ("--set NAME=VALUE", "`start={NAME: VALUE}`"),
    ("with --set", "by `parameters`"),
    ("--box NAME=FROM:TO", "`box={NAME: (FROM, TO)}`"),
    ("--starts N", "`starts`"),
    ("--at start", "`at=\"start\"`"),
    ("(--hold)", "(`hold`)"),
    ("with --independent", "by `independent`"),
    ("`pc equilibria`", "`equilibria`"),
    ("`pc check`", "`check`"),
    ("`pc theory`", "`theory`"),
];

/// A message in the notation of Python.
pub(crate) fn in_python(message: &str) -> String {
    let mut text = message.to_owned();
    for (of_program, of_python) in PHRASES {
        text = text.replace(of_program, of_python);
    }
    let mut parts = text.split("--");
    let mut shown = parts.next().unwrap_or_default().to_owned();
    for part in parts {
        let length = part.find(|c: char| c != '-' && !c.is_ascii_lowercase()).unwrap_or(part.len());
        let (name, rest) = part.split_at(length);
        let is_option = !name.is_empty() && !shown.ends_with(|c: char| c.is_alphanumeric() || c == '-');
        shown += if is_option { "" } else { "--" };
        shown += &if is_option { name.replace('-', "_") } else { name.to_owned() };
        shown += rest;
    }
    shown
}
