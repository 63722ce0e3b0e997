//! The interface as tables of C, with a function for each function of the library that calls it.

use std::fmt::Write;

use super::arguments::{Argument, Extent, of_function};
use super::interface::{Callback, Function, Interface};
use crate::error::Error;

/// Functions that take long by nature: one call in so many.
const RARE: [(&str, usize); 7] = [
    ("pc_system_theory", 12),
    ("pc_system_canonical_variables", 6),
    ("pc_system_verify", 6),
    ("pc_system_verify_at", 6),
    ("pc_system_print", 3),
    ("pc_system_emit_c", 3),
    ("pc_ensemble_run", 2),
];

/// The functions of the program that `program/callbacks.c` has.
const OWN: [&str; 8] = [
    "pc_destroy",
    "pc_event_function",
    "pc_event_observer",
    "pc_event_reset",
    "pc_force_function",
    "pc_force_jacobian",
    "pc_member_observer",
    "pc_observer",
];

/// What says that results need not be finite.
const NOT_FINITE: [&str; 5] = [
    "not a finite number",
    "the first of the observables",
    "is not finite where",
    "may be not finite",
    "like pc_system_observable_jacobian",
];

/// The most words of a description that are given as texts.
const WORDS: usize = 64;

/// The source `tables.c`.
///
/// # Errors
/// [`Error::Unfit`] with an argument of which it is not known what to give.
pub(crate) fn tables(interface: &Interface) -> Result<String, Error> {
    let mut source = "/* Made by `cargo xtask fuzz c` of pc.h. */\n#include \"fuzz.h\"\n\n".to_owned();
    for function in &interface.functions {
        source += &caller(function, &of_function(function, interface)?);
    }
    source += "const struct function functions[] = {\n";
    for function in &interface.functions {
        source += &entry(function, &of_function(function, interface)?, interface);
    }
    source += "};\nconst size_t function_count = sizeof functions / sizeof *functions;\n\n";
    source += &handles(interface);
    source += &structures(interface);
    source += &callbacks(interface);
    source += &format!(
        "const int statuses[] = {{ {} }};\nconst size_t status_count = sizeof statuses / sizeof *statuses;\n",
        interface.statuses.join(", ")
    );
    Ok(source)
}

/// The function that makes a call of what an array of values holds.
fn caller(function: &Function, arguments: &[Argument]) -> String {
    let values =
        arguments.iter().zip(&function.parameters).enumerate().map(|(place, (argument, parameter))| {
            let value = format!("a[{place}].{}", argument.kind.member());
            if argument.kind.member() == "function" { format!("({}){value}", parameter.kind) } else { value }
        });
    let call = format!("{}({})", function.name, values.collect::<Vec<_>>().join(", "));
    let statement = match result(function).1 {
        "" => format!("(void)r;\n    {call}"),
        "pointer" => format!("r->pointer = (void *){call}"),
        member => format!("r->{member} = {call}"),
    };
    let unused = if arguments.is_empty() { "(void)a;\n    " } else { "" };
    let name = &function.name;
    format!(
        "static void call_{name}(const union value *a, union value *r)\n{{\n    {unused}{statement};\n}}\n\n"
    )
}

/// The kind of a result, and the member of `union value` for it.
fn result(function: &Function) -> (&'static str, &'static str) {
    let fails = function.parameters.iter().any(|parameter| parameter.kind == "pc_error **");
    match function.result.as_str() {
        "pc_status" if fails => ("STATUS", "choice"),
        "pc_status" => ("WHOLE", "choice"),
        "const char *" => ("NAME", "pointer"),
        "size_t" => ("SOME", "count"),
        "int" => ("WHOLE", "choice"),
        "double" => ("REAL", "number"),
        "void" => ("NOTHING", ""),
        _ => ("WIDE", "wide"),
    }
}

fn entry(function: &Function, arguments: &[Argument], interface: &Interface) -> String {
    let name = &function.name;
    let rarity = RARE.iter().find(|(rare, _)| rare == name).map_or(1, |(_, rarity)| *rarity);
    let says = |text: &str| usize::from(function.text.contains(text));
    let (null, kept) = (says("NULL") | says("null"), says("does nothing when called from"));
    let infinite = usize::from(NOT_FINITE.iter().any(|text| function.text.contains(text)));
    let counted = counted(function, interface).map_or("-1".to_owned(), |place| place.to_string());
    let mut text = format!("    {{ \"{name}\", {}, {}, {{\n", result(function).0, arguments.len());
    for (argument, parameter) in arguments.iter().zip(&function.parameters) {
        let (length, fixed, power) = match argument.extent {
            Extent::Given(place) => (place.to_string(), 0, 0),
            Extent::Fixed(count) => ("-1".to_owned(), count, 0),
            Extent::OfState { power, times } => (times.map_or("-1".to_owned(), |t| t.to_string()), 0, power),
            Extent::None => ("-1".to_owned(), 0, 0),
        };
        let _ = writeln!(
            text,
            "        {{ \"{}\", {}, {}, {length}, {fixed}, {power}, {} }},",
            parameter.name,
            argument.kind.name(),
            argument.of,
            usize::from(parameter.kind == "double *" || parameter.kind == "const double *")
        );
    }
    if arguments.is_empty() {
        text += "        { 0 }\n";
    }
    let words: Vec<String> = words(&function.text).iter().map(|word| format!("\"{word}\"")).collect();
    let _ = writeln!(
        text,
        "    }}, {rarity}, {null}, {infinite}, {kept}, {counted}, {}, {{ {} }}, call_{name} }},",
        words.len(),
        if words.is_empty() { "0".to_owned() } else { words.join(", ") }
    );
    text
}

/// The number of the function that counts what a function gives the names of.
fn counted(function: &Function, interface: &Interface) -> Option<usize> {
    let stem = function.name.strip_suffix("_name")?;
    let is = |name: String| interface.functions.iter().position(|other| other.name == name);
    is(format!("{stem}_count")).or_else(|| is(format!("{stem}_dim")))
}

/// The words that a description puts into quotes, or else all its words: what texts may say.
fn words(text: &str) -> Vec<String> {
    let plain = |word: &&str| {
        !word.is_empty()
            && word.len() < 24
            && word.chars().all(|c| c.is_ascii_alphanumeric() || "_-".contains(c))
    };
    let mut quoted: Vec<&str> = text.split('"').skip(1).step_by(2).filter(plain).collect();
    if quoted.is_empty() {
        let trim = |word| str::trim_matches(word, |c: char| !c.is_ascii_alphanumeric());
        quoted = text.split_whitespace().map(trim).filter(plain).collect();
    }
    quoted.iter().take(WORDS).map(|&word| word.to_owned()).collect()
}

fn handles(interface: &Interface) -> String {
    let place = |name: String| {
        interface
            .functions
            .iter()
            .position(|f| f.name == name)
            .map_or("-1".to_owned(), |place| place.to_string())
    };
    let mut text = "const struct handle_type handle_types[] = {\n".to_owned();
    for handle in &interface.handles {
        let (free, dim) = (place(format!("{handle}_free")), place(format!("{handle}_dim")));
        let _ = writeln!(text, "    {{ \"{handle}\", {free}, {dim} }},");
    }
    text + "};\nconst size_t handle_type_count = sizeof handle_types / sizeof *handle_types;\n\n"
}

fn structures(interface: &Interface) -> String {
    let mut text = "const struct structure structures[] = {\n".to_owned();
    for structure in &interface.structures {
        let name = &structure.name;
        let init = interface.functions.iter().position(|f| f.name == format!("{name}_init"));
        let _ = writeln!(
            text,
            "    {{ \"{name}\", sizeof({name}), {}, {}, {{",
            init.map_or("-1".to_owned(), |place| place.to_string()),
            structure.members.len()
        );
        for member in &structure.members {
            let (kind, of) = kind_of_member(&member.kind, interface);
            let (member, place) = (&member.name, format!("offsetof({name}, {})", member.name));
            let _ = writeln!(text, "        {{ \"{member}\", {place}, {kind}, {of} }},");
        }
        text += "    } },\n";
    }
    text + "};\n\n"
}

/// What a member of a structure holds, and the type of a handle.
fn kind_of_member(kind: &str, interface: &Interface) -> (&'static str, usize) {
    let handle = interface.handles.iter().position(|handle| kind == format!("const {handle} *"));
    match kind {
        "size_t" => ("MEMBER_COUNT", 0),
        "int" => ("MEMBER_INT", 0),
        "uint32_t" => ("MEMBER_WIDE32", 0),
        "uint64_t" => ("MEMBER_WIDE64", 0),
        "double" => ("MEMBER_DOUBLE", 0),
        "const double *" => ("MEMBER_DOUBLES", 0),
        "const int *" => ("MEMBER_INTS", 0),
        _ => handle.map_or(("MEMBER_OTHER", 0), |handle| ("MEMBER_HANDLE", handle)),
    }
}

/// The functions of the program, those of new types among them: these do nothing with what they are given.
fn callbacks(interface: &Interface) -> String {
    let (mut own, mut list) = (String::new(), String::new());
    for Callback { name, result, parameters } in &interface.callbacks {
        let _ = writeln!(list, "    {{ \"{name}\", (void (*)(void))own_{name} }},");
        let named: Vec<String> =
            parameters.iter().enumerate().map(|(place, kind)| format!("{kind} a{place}")).collect();
        let head = format!("{result} own_{name}({})", named.join(", "));
        if OWN.contains(&&**name) {
            let _ = writeln!(own, "{head};");
            continue;
        }
        let unused: String = (0..parameters.len()).map(|place| format!("(void)a{place}; ")).collect();
        let user = if parameters.last().is_some_and(|last| last == "void *") {
            format!("a{}", parameters.len() - 1)
        } else {
            "NULL".to_owned()
        };
        let answer = if result == "void" { "(void)" } else { "return " };
        let _ = writeln!(own, "static {head}\n{{\n    {unused}\n    {answer}called({user});\n}}");
    }
    format!("{own}\nconst struct callback callbacks[] = {{\n{list}}};\n\n")
}

#[cfg(test)]
mod tests {
    use super::*;

    /// That each function gets a call, which the compiler then holds to its declaration.
    #[test]
    fn each_function_of_the_library_is_called() {
        let interface = Interface::read().unwrap();
        let source = tables(&interface).unwrap();
        for function in &interface.functions {
            let name = &function.name;
            assert!(
                source.contains(&format!("call_{name}(const union value *a, union value *r)\n")),
                "{name}"
            );
            assert!(
                source.contains(&format!("{name}(")) && source.contains(&format!("call_{name} }},")),
                "{name}"
            );
        }
    }

    #[test]
    fn a_function_becomes_a_call_and_a_line() {
        let header =
            "/** Sets \"this\" or \"that\"; NULL is allowed. */\nint pc_set(double t, pc_destroy destroy);\n";
        let lines = "callback void (*pc_destroy)(void *)\nint pc_set(double, pc_destroy)\n";
        let source = tables(&Interface::of(lines, header).unwrap()).unwrap();
        assert!(
            source.contains("    r->choice = pc_set(a[0].number, (pc_destroy)a[1].function);\n"),
            "{source}"
        );
        assert!(
            source.contains("\"pc_set\", WHOLE, 2, {\n        { \"t\", NUMBER, 0, -1, 0, 0, 0 },"),
            "{source}"
        );
        assert!(source.contains("}, 1, 1, 0, 0, -1, 2, { \"this\", \"that\" }, call_pc_set },"), "{source}");
    }

    #[test]
    fn a_new_type_of_callback_gets_a_function() {
        let lines = "callback int (*pc_watch)(double, void *)\n";
        let source = callbacks(&Interface::of(lines, "").unwrap());
        assert!(source.contains("static int own_pc_watch(double a0, void * a1)\n"), "{source}");
        assert!(source.contains("return called(a1);"), "{source}");
    }

    #[test]
    fn rare_functions_exist() {
        let interface = Interface::read().unwrap();
        for (rare, _) in RARE {
            assert!(interface.functions.iter().any(|function| function.name == rare), "{rare}");
        }
    }
}
