//! The C interface as it is declared: types from `abi/interface.txt`, names of arguments and documentation from `pc.h`.

use std::fs;

use crate::command::workspace_root;
use crate::error::Error;

/// Everything that is declared.
#[derive(Debug, Default)]
pub(crate) struct Interface {
    pub(crate) functions: Vec<Function>,
    /// The types of handles.
    pub(crate) handles: Vec<String>,
    pub(crate) structures: Vec<Structure>,
    pub(crate) callbacks: Vec<Callback>,
    /// The values of pc_status that a call may return.
    pub(crate) statuses: Vec<String>,
}

/// A function of the library.
#[derive(Debug, PartialEq, Eq)]
pub(crate) struct Function {
    pub(crate) name: String,
    /// The type of what it returns.
    pub(crate) result: String,
    pub(crate) parameters: Vec<Parameter>,
    /// What the header says of it, on one line.
    pub(crate) text: String,
}

/// An argument of a function, or a member of a structure.
#[derive(Debug, PartialEq, Eq)]
pub(crate) struct Parameter {
    pub(crate) kind: String,
    pub(crate) name: String,
}

/// A structure that is handed over with its size.
#[derive(Debug, PartialEq, Eq)]
pub(crate) struct Structure {
    pub(crate) name: String,
    pub(crate) members: Vec<Parameter>,
}

/// A type of functions of the program.
#[derive(Debug, PartialEq, Eq)]
pub(crate) struct Callback {
    pub(crate) name: String,
    pub(crate) result: String,
    pub(crate) parameters: Vec<String>,
}

impl Interface {
    /// That of this workspace.
    ///
    /// # Errors
    /// [`Error::File`], and [`Error::Unfit`] where both files do not declare the same.
    pub(crate) fn read() -> Result<Interface, Error> {
        let read = |path: &str| {
            let path = workspace_root().join(path);
            fs::read_to_string(&path).map_err(|source| Error::of_file(&path, source))
        };
        Interface::of(&read("crates/pc-capi/abi/interface.txt")?, &read("include/pc.h")?)
    }

    /// That of the lines of an interface with its header.
    ///
    /// # Errors
    /// [`Error::Unfit`] with the line that is not understood.
    pub(crate) fn of(lines: &str, header: &str) -> Result<Interface, Error> {
        let mut found = Interface::default();
        for line in lines.lines() {
            found.add(line, header).ok_or_else(|| Error::Unfit {
                wrong: format!("`{line}` is not what pc.h declares; `cargo xtask header` writes both"),
            })?;
        }
        Ok(found)
    }

    fn add(&mut self, line: &str, header: &str) -> Option<()> {
        let (head, rest) = line.split_once(' ')?;
        match head {
            "abi" => {}
            "enum" => {
                let (kind, constant) = rest.split_once(": ")?;
                let constant = constant.split_once(" = ")?.0;
                if kind == "pc_status" && constant != "PC_STATUS_LAST" {
                    self.statuses.push(constant.to_owned());
                }
            }
            "handle" => self.handles.push(rest.to_owned()),
            "struct" => self.add_member(rest)?,
            "callback" => self.callbacks.push(callback(rest)?),
            _ => self.functions.push(function(line, header)?),
        }
        Some(())
    }

    fn add_member(&mut self, line: &str) -> Option<()> {
        let (structure, member) = line.split_once(": ")?;
        let (kind, name) = split_name(member.split_once(' ')?.1);
        if self.structures.last().is_none_or(|last| last.name != structure) {
            self.structures.push(Structure { name: structure.to_owned(), members: Vec::new() });
        }
        self.structures.last_mut()?.members.push(Parameter { kind, name });
        Some(())
    }
}

/// `int (*pc_name)(double, void *)`.
fn callback(line: &str) -> Option<Callback> {
    let (result, rest) = line.split_once(" (*")?;
    let (name, parameters) = rest.split_once(")(")?;
    Some(Callback { name: name.to_owned(), result: result.to_owned(), parameters: list(parameters)? })
}

/// `pc_status pc_name(pc_model *, double)`, whose arguments have names in the header.
fn function(line: &str, header: &str) -> Option<Function> {
    let (head, kinds) = line.split_once('(')?;
    let (result, name) = split_name(head);
    let (before, after) = header.split_once(&format!("{head}("))?;
    let named = list(after.split_once(';')?.0)?;
    let kinds = list(kinds)?;
    let text = before.rsplit_once("/**")?.1.split_once("*/")?.0.replace("\n *", " ");
    let parameters = kinds.iter().zip(&named).map(|(kind, named)| {
        let (declared, name) = split_name(named);
        (declared == *kind).then(|| Parameter { kind: kind.clone(), name })
    });
    let parameters = parameters.collect::<Option<Vec<_>>>()?;
    let text = text.split_whitespace().collect::<Vec<_>>().join(" ");
    (kinds.len() == named.len()).then_some(Function { name, result, parameters, text })
}

/// The parts of a list of arguments that a bracket ends.
fn list(text: &str) -> Option<Vec<String>> {
    let inner = text.trim_end().strip_suffix(')')?;
    let parts = inner.split(',').map(|part| part.split_whitespace().collect::<Vec<_>>().join(" "));
    Some(parts.filter(|part| part != "void").collect())
}

/// A declaration as its type and its name.
fn split_name(declaration: &str) -> (String, String) {
    let kind = declaration.trim_end_matches(|c: char| c.is_ascii_alphanumeric() || c == '_');
    (kind.trim_end().to_owned(), declaration[kind.len()..].to_owned())
}

#[cfg(test)]
mod tests {
    use super::*;

    const HEADER: &str = "/**\n * A status.\n */\ntypedef enum { PC_OK = 0 } pc_status;\n\
        /**\n * Says the \"first\"\n * or \"second\".\n */\n\
        PC_API pc_status pc_model_say(pc_model *model,\n                       const char *const *names,\n\
                               size_t length);\n/** None. */\nint pc_none(void);\n";

    fn of(lines: &str) -> Result<Interface, Error> {
        Interface::of(lines, HEADER)
    }

    #[test]
    fn lines_are_read_with_the_names_of_the_header() {
        let lines = "abi 0\nenum pc_status: PC_OK = 0\nenum pc_status: PC_STATUS_LAST = 7\nhandle pc_model\n\
            struct pc_choice: 0 size_t size\nstruct pc_choice: 8 const double *values\n\
            callback int (*pc_observer)(double, const double *, void *)\n\
            pc_status pc_model_say(pc_model *, const char *const *, size_t)\nint pc_none(void)\n";
        let interface = of(lines).unwrap();
        assert_eq!(interface.statuses, ["PC_OK"]);
        assert_eq!(interface.handles, ["pc_model"]);
        let members: Vec<_> = interface.structures[0].members.iter().map(|m| (&*m.kind, &*m.name)).collect();
        assert_eq!(members, [("size_t", "size"), ("const double *", "values")]);
        assert_eq!(interface.callbacks[0].parameters, ["double", "const double *", "void *"]);
        let [say, none] = &interface.functions[..] else { panic!("two functions") };
        let named: Vec<_> = say.parameters.iter().map(|p| (&*p.kind, &*p.name)).collect();
        assert_eq!(named, [("pc_model *", "model"), ("const char *const *", "names"), ("size_t", "length")]);
        assert_eq!((&*say.result, &*say.text), ("pc_status", "Says the \"first\" or \"second\"."));
        assert!(none.parameters.is_empty());
    }

    #[test]
    fn a_function_that_the_header_declares_otherwise_is_refused() {
        let message = of("int pc_none(double)\n").unwrap_err().to_string();
        assert_eq!(
            message,
            "`int pc_none(double)` is not what pc.h declares; `cargo xtask header` writes both"
        );
        assert!(of("int pc_other(void)\n").is_err());
    }

    #[test]
    fn the_interface_of_the_workspace_is_read() {
        let interface = Interface::read().unwrap();
        let count = crate::header::functions_of_header().unwrap().len();
        assert_eq!(interface.functions.len(), count);
        assert!(interface.functions.iter().all(|function| !function.text.is_empty()));
    }
}
