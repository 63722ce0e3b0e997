//! The binary interface in lines: what a program compiled with a header holds the library to.
//!
//! One line for each function (names of parameters left out, which no program sees), member of a structure with its place in
//! bytes, constant of an enumeration, handle and type of callback, below the version of the whole. A line that goes, or becomes
//! another, breaks programs; one that comes does not: structures are handed over with their sizes and grow at the end. Nor does a
//! parameter that points to what is only read from now on.

use std::collections::BTreeSet;

/// The lines of a header, in its order.
pub(crate) fn interface(header: &str, version: u32) -> String {
    let mut lines = vec![format!("abi {version}")];
    for declaration in declarations(header) {
        match declaration.strip_prefix("typedef ") {
            Some(definition) => definition_lines(definition, &mut lines),
            None => lines.push(function(&declaration)),
        }
    }
    lines.join("\n") + "\n"
}

/// Whether one interface may take the place of the other, and if not, why.
///
/// # Errors
/// The lines that programs miss, if the version is the same.
pub(crate) fn replaces(new: &str, old: &str) -> Result<(), String> {
    let known: BTreeSet<&str> = new.lines().collect();
    let is_there = |line: &str| known.contains(line) || new.lines().any(|new| takes_as_much(new, line));
    let lost: Vec<&str> = old.lines().filter(|line| !is_there(line)).collect();
    if lost.is_empty() || new.lines().next() != old.lines().next() {
        return Ok(());
    }
    Err(format!(
        "programs compiled with an earlier pc.h need what is there no more or is different now:\n  {}\n\
         Keep it, or raise PC_ABI_VERSION, in crates/pc-capi/src/api/version.rs and build.rs; then `cargo xtask header`.",
        lost.join("\n  ")
    ))
}

/// Whether a function is the other one, but that it only reads what parameters point to: what may be written to may be given
/// there. Not so with a function of the program, which is given them.
fn takes_as_much(new: &str, old: &str) -> bool {
    let (Some((new, taken)), Some((old, given))) = (new.split_once('('), old.split_once('(')) else {
        return false;
    };
    let (taken, given) = (taken.split(", "), given.split(", "));
    let is_same = |(new, old): (&str, &str)| new == old || new.strip_prefix("const ") == Some(old);
    new == old
        && !new.starts_with("callback ")
        && taken.clone().count() == given.clone().count()
        && taken.zip(given).all(is_same)
}

/// What stands between semicolons outside braces, without comments, preprocessor and PC_API, with single spaces.
fn declarations(header: &str) -> Vec<String> {
    let mut code = String::new();
    let mut rest = header;
    while let Some((before, comment)) = rest.split_once("/*") {
        code.push_str(before);
        rest = comment.split_once("*/").map_or("", |(_, after)| after);
    }
    code.push_str(rest);
    let outside = |line: &&str| {
        !line.trim_start().starts_with('#') && !line.starts_with("extern \"C\"") && !line.starts_with("}  //")
    };
    let words = code.lines().filter(outside).flat_map(str::split_whitespace);
    let words: Vec<&str> = words.filter(|&word| word != "PC_API").collect();
    let (mut found, mut current, mut depth) = (Vec::new(), String::new(), 0);
    for c in words.join(" ").chars() {
        depth += i32::from(c == '{') - i32::from(c == '}');
        if c == ';' && depth == 0 {
            found.push(current.trim().to_owned());
            current.clear();
        } else {
            current.push(c);
        }
    }
    found
}

/// `enum { A = 0, … } name`, `struct { int a; … } name`, `struct name name`, or a pointer to a function.
fn definition_lines(definition: &str, lines: &mut Vec<String>) {
    let Some((head, rest)) = definition.split_once('{') else {
        match definition.split_whitespace().collect::<Vec<_>>()[..] {
            ["struct", name, _] => lines.push(format!("handle {name}")),
            _ => lines.push(format!("callback {}", function(definition))),
        }
        return;
    };
    let Some((body, name)) = rest.rsplit_once('}') else { return };
    let name = name.trim();
    if head.trim() == "enum" {
        for constant in body.split(',').map(str::trim).filter(|constant| !constant.is_empty()) {
            lines.push(format!("enum {name}: {constant}"));
        }
        return;
    }
    let mut end = 0_usize;
    for member in body.split(';').map(str::trim).filter(|member| !member.is_empty()) {
        let size = size(member);
        let place = end.next_multiple_of(size);
        lines.push(format!("struct {name}: {place} {member}"));
        end = place + size;
    }
}

/// The size of a member, and its alignment: pointers have 8 bytes, other types that are not numbers are not members.
fn size(member: &str) -> usize {
    match member.rsplit_once(' ') {
        Some(("int" | "int32_t" | "uint32_t", name)) if !name.starts_with('*') => 4,
        _ => 8,
    }
}

/// `type name(type a, type b)` without a and b.
fn function(declaration: &str) -> String {
    let Some((head, parameters)) = declaration.rsplit_once('(') else { return declaration.to_owned() };
    let parameters = parameters.trim_end_matches(')').split(',').map(str::trim).map(|parameter| {
        let bare = parameter.trim_end_matches(|c: char| c.is_ascii_alphanumeric() || c == '_').trim_end();
        if bare.is_empty() { parameter } else { bare }
    });
    format!("{head}({})", parameters.collect::<Vec<_>>().join(", "))
}
