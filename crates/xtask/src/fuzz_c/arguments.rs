//! What an argument is: which numbers, texts or handles a call is given for it, by its type and its name.

use super::interface::{Function, Interface, Parameter};
use crate::error::Error;

/// What is given for an argument; the names are those of `program/fuzz.h`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Kind {
    Handle,
    FreedHandle,
    HandlePlace,
    ErrorPlace,
    Text,
    Texts,
    FreedText,
    TextPlace,
    Bytes,
    FreedBytes,
    BytesPlace,
    /// An array that is read.
    Numbers,
    /// An array that is written.
    Room,
    /// A place for one number.
    Place,
    /// A place for a pointer to numbers of the library.
    PointerPlace,
    Options,
    Structure,
    /// The length of an array, a text or bytes.
    Length,
    /// The size of a structure.
    Size,
    Number,
    Count,
    Choice,
    Unsigned,
    Callback,
    User,
}

impl Kind {
    /// Its name in the program.
    pub(crate) fn name(self) -> &'static str {
        match self {
            Kind::Handle => "HANDLE",
            Kind::FreedHandle => "FREED_HANDLE",
            Kind::HandlePlace => "HANDLE_PLACE",
            Kind::ErrorPlace => "ERROR_PLACE",
            Kind::Text => "TEXT",
            Kind::Texts => "TEXTS",
            Kind::FreedText => "FREED_TEXT",
            Kind::TextPlace => "TEXT_PLACE",
            Kind::Bytes => "BYTES",
            Kind::FreedBytes => "FREED_BYTES",
            Kind::BytesPlace => "BYTES_PLACE",
            Kind::Numbers => "NUMBERS",
            Kind::Room => "ROOM",
            Kind::Place => "PLACE",
            Kind::PointerPlace => "POINTER_PLACE",
            Kind::Options => "OPTIONS",
            Kind::Structure => "STRUCTURE",
            Kind::Length => "LENGTH",
            Kind::Size => "SIZE",
            Kind::Number => "NUMBER",
            Kind::Count => "COUNT",
            Kind::Choice => "CHOICE",
            Kind::Unsigned => "UNSIGNED",
            Kind::Callback => "CALLBACK",
            Kind::User => "USER",
        }
    }

    /// The member of `union value` in which it is held.
    pub(crate) fn member(self) -> &'static str {
        match self {
            Kind::Number => "number",
            Kind::Length | Kind::Size | Kind::Count => "count",
            Kind::Choice => "choice",
            Kind::Unsigned => "wide",
            Kind::Callback => "function",
            _ => "pointer",
        }
    }
}

/// How many numbers, or texts, an array has.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Extent {
    /// As many as another argument says, the one of this number.
    Given(usize),
    Fixed(usize),
    /// The length of the state, to the power, times the number of states that the argument of this number says.
    OfState {
        power: usize,
        times: Option<usize>,
    },
    /// It is no array.
    None,
}

/// An argument with what it refers to.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Argument {
    pub(crate) kind: Kind,
    /// The number of the handle type, structure or callback among those of the interface; for arrays the bytes of an entry.
    pub(crate) of: usize,
    pub(crate) extent: Extent,
}

/// Arrays whose length is said in words.
const SAID: [(&str, usize); 4] = [("axis", 3), ("first", 3), ("second", 3), ("places", 6)];

/// The arguments of a function.
///
/// # Errors
/// [`Error::Unfit`] with the argument of which it is not known what to give.
pub(crate) fn of_function(function: &Function, interface: &Interface) -> Result<Vec<Argument>, Error> {
    let all = &function.parameters;
    let mut found = Vec::new();
    for (place, parameter) in all.iter().enumerate() {
        let argument = argument(function, place, interface).ok_or_else(|| Error::Unfit {
            wrong: format!(
                "`cargo xtask fuzz c` does not know what to give `{}` for `{} {}`: say so in \
                 crates/xtask/src/fuzz_c/arguments.rs",
                function.name, parameter.kind, parameter.name
            ),
        })?;
        found.push(argument);
    }
    for place in 0..found.len() {
        if let Extent::Given(length) = found[place].extent {
            found[length].kind = Kind::Length;
        }
        if found[place].kind == Kind::Structure
            && let Some(size) = all.get(place + 1).filter(|next| next.name == "size")
            && size.kind == "size_t"
        {
            found[place + 1].kind = Kind::Size;
        }
    }
    Ok(found)
}

fn argument(function: &Function, place: usize, interface: &Interface) -> Option<Argument> {
    let all = &function.parameters;
    let Parameter { kind, name } = &all[place];
    let plain = |kind| Some(Argument { kind, of: 0, extent: Extent::None });
    let frees = function.name.ends_with("_free");
    match kind.as_str() {
        "double" => return plain(Kind::Number),
        "size_t" => return plain(Kind::Count),
        "int" => return plain(Kind::Choice),
        "unsigned int" | "uint32_t" | "uint64_t" => return plain(Kind::Unsigned),
        "const char *" => {
            let next = all.get(place + 1).filter(|next| next.kind == "size_t" && is_length(name, &next.name));
            let extent = next.map_or(Extent::None, |_| Extent::Given(place + 1));
            return Some(Argument { kind: Kind::Text, of: 1, extent });
        }
        "char *" if frees => return plain(Kind::FreedText),
        "char **" => return plain(Kind::TextPlace),
        "void *" if frees => return plain(Kind::FreedBytes),
        "void *" if name == "user" => return plain(Kind::User),
        "void *" => return of_handle(&format!("pc_{name}"), Kind::Handle, interface),
        "const void *" => {
            all.get(place + 1).filter(|next| next.kind == "size_t")?;
            return Some(Argument { kind: Kind::Bytes, of: 1, extent: Extent::Given(place + 1) });
        }
        "void **" => return plain(Kind::BytesPlace),
        "pc_error **" => return plain(Kind::ErrorPlace),
        "const char *const *" => return array(function, place, Kind::Texts, 8),
        _ => {}
    }
    if let Some(callback) = interface.callbacks.iter().position(|callback| callback.name == *kind) {
        return Some(Argument { kind: Kind::Callback, of: callback, extent: Extent::None });
    }
    if kind.starts_with("const ") && kind.ends_with(" **") {
        return plain(Kind::PointerPlace);
    }
    if let Some(handle) = kind.strip_suffix(" **") {
        return of_handle(handle, Kind::HandlePlace, interface);
    }
    let bare = kind.strip_suffix(" *")?;
    let (constant, pointed) = bare.strip_prefix("const ").map_or((false, bare), |pointed| (true, pointed));
    if let Some(bytes) = bytes_of_number(pointed) {
        let kind = if constant { Kind::Numbers } else { Kind::Room };
        return match array(function, place, kind, bytes) {
            None if !constant => Some(Argument { kind: Kind::Place, of: bytes, extent: Extent::None }),
            found => found,
        };
    }
    if let Some(structure) = interface.structures.iter().position(|structure| structure.name == pointed) {
        let kind = if constant { Kind::Options } else { Kind::Structure };
        return Some(Argument { kind, of: structure, extent: Extent::None });
    }
    let kind = if frees { Kind::FreedHandle } else { Kind::Handle };
    of_handle(pointed, kind, interface)
}

fn of_handle(name: &str, kind: Kind, interface: &Interface) -> Option<Argument> {
    let of = interface.handles.iter().position(|handle| handle == name)?;
    Some(Argument { kind, of, extent: Extent::None })
}

/// The bytes of a number of this type.
fn bytes_of_number(kind: &str) -> Option<usize> {
    match kind {
        "double" | "size_t" | "uint64_t" | "int64_t" => Some(8),
        "int" | "unsigned int" | "uint32_t" | "int32_t" => Some(4),
        "uint8_t" => Some(1),
        _ => None,
    }
}

/// Whether a number is the length of what stands before it.
fn is_length(array: &str, number: &str) -> bool {
    let one = array.strip_suffix('s').unwrap_or(array);
    let lengths = ["length", "count"];
    lengths.contains(&number)
        || lengths.iter().any(|length| [array, one].iter().any(|name| number == format!("{name}_{length}")))
}

/// An array with its extent: its length follows it, alone or after other arrays of the same length; or it is that of a state, for
/// functions that are handed a handle without a type; or it is said in words.
fn array(function: &Function, place: usize, kind: Kind, of: usize) -> Option<Argument> {
    let all = &function.parameters;
    let name = &all[place].name;
    let is_array =
        |parameter: &Parameter| parameter.kind.ends_with('*') && parameter.kind.starts_with("const ");
    if all.iter().any(|other| other.kind == "void *" && other.name != "user") {
        let times = all.iter().position(|other| other.kind == "size_t" && other.name == "count");
        let extent = Extent::OfState { power: if name == "jacobian" { 2 } else { 1 }, times };
        return Some(Argument { kind, of, extent });
    }
    let end = all[place + 1..].iter().position(|next| next.kind == "size_t").map(|steps| place + 1 + steps);
    let given = end.filter(|&end| {
        let own = is_length(name, &all[end].name);
        own && (end == place + 1 || is_array(&all[place]) && all[place + 1..end].iter().all(is_array))
    });
    if let Some(end) = given {
        return Some(Argument { kind, of, extent: Extent::Given(end) });
    }
    let said = SAID.iter().find(|(said, _)| said == name && is_array(&all[place]))?;
    Some(Argument { kind, of, extent: Extent::Fixed(said.1) })
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Reads a function of an interface with two handles, a structure and a callback.
    fn arguments(declaration: &str) -> Result<Vec<Argument>, Error> {
        let mut lines = "handle pc_system\nhandle pc_kernel\nstruct pc_choice: 0 size_t size\n\
            callback void (*pc_destroy)(void *)\n"
            .to_owned();
        let header = format!("/** One. */\n{declaration};\n");
        let bare = declaration.split_once('(').unwrap();
        let kinds = bare.1.trim_end_matches(')').split(',').map(|parameter| {
            parameter.trim_end_matches(|c: char| c.is_ascii_alphanumeric() || c == '_').trim().to_owned()
        });
        lines += &format!("{}({})\n", bare.0, kinds.collect::<Vec<_>>().join(", "));
        let interface = Interface::of(&lines, &header)?;
        of_function(&interface.functions[0], &interface)
    }

    fn kinds(declaration: &str) -> Vec<(Kind, Extent)> {
        arguments(declaration).unwrap().iter().map(|argument| (argument.kind, argument.extent)).collect()
    }

    #[test]
    fn arrays_have_the_lengths_beside_them() {
        use Extent::{Given, None};
        assert_eq!(
            kinds("int pc_f(const pc_system *system, double *t, double *y, size_t y_length)"),
            [(Kind::Handle, None), (Kind::Place, None), (Kind::Room, Given(3)), (Kind::Length, None)]
        );
        assert_eq!(
            kinds("int pc_f(const double *times, const double *values, size_t length, const char *word)"),
            [(Kind::Numbers, Given(2)), (Kind::Numbers, Given(2)), (Kind::Length, None), (Kind::Text, None)]
        );
        assert_eq!(
            kinds("int pc_f(const char *const *functions, size_t function_count, size_t index)"),
            [(Kind::Texts, Given(1)), (Kind::Length, None), (Kind::Count, None)]
        );
        assert_eq!(
            kinds("int pc_f(void **data, size_t *length, const void *bytes, size_t count)"),
            [(Kind::BytesPlace, None), (Kind::Place, None), (Kind::Bytes, Given(3)), (Kind::Length, None)]
        );
    }

    #[test]
    fn a_handle_without_a_type_is_known_by_its_name() {
        let state = |power, times| Extent::OfState { power, times };
        assert_eq!(
            kinds("int pc_f(double t, const double *states, size_t count, double *rates, void *kernel)"),
            [
                (Kind::Number, Extent::None),
                (Kind::Numbers, state(1, Some(2))),
                (Kind::Count, Extent::None),
                (Kind::Room, state(1, Some(2))),
                (Kind::Handle, Extent::None)
            ]
        );
    }

    #[test]
    fn structures_come_with_their_sizes() {
        let found =
            kinds("void pc_f(pc_choice *choice, size_t size, const pc_choice *other, pc_destroy destroy)");
        let found: Vec<Kind> = found.iter().map(|(kind, _)| *kind).collect();
        assert_eq!(found, [Kind::Structure, Kind::Size, Kind::Options, Kind::Callback]);
        let found = kinds("void pc_kernel_free(pc_kernel *kernel)");
        assert_eq!(found, [(Kind::FreedHandle, Extent::None)]);
    }

    #[test]
    fn an_argument_of_an_unknown_kind_is_named() {
        let message =
            arguments("int pc_f(const double *numbers, pc_system **system)").unwrap_err().to_string();
        assert!(message.contains("`pc_f` for `const double * numbers`: say so in "), "{message}");
    }

    #[test]
    fn every_argument_of_the_library_is_known() {
        let interface = Interface::read().unwrap();
        for function in &interface.functions {
            of_function(function, &interface).unwrap();
        }
    }
}
