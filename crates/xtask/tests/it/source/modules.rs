//! The modules of a crate, read from its files.

use std::collections::BTreeMap;
use std::path::Path;

use syn::{Attribute, Item, UseTree};

/// The path of a module; the root's is empty.
pub(crate) type ModulePath = Vec<String>;

/// The modules of a crate by their paths.
pub(crate) type Modules = BTreeMap<ModulePath, Module>;

/// A module with what it defines, tests and modules within it left out.
pub(crate) struct Module {
    pub(crate) file: String,
    pub(crate) items: Vec<Item>,
}

/// What a `use` brings in.
pub(crate) enum Import<'t> {
    /// A path under a name.
    Name(ModulePath, &'t syn::Ident),
    /// All of a module.
    Glob(ModulePath),
}

/// The modules of the crate in a folder.
pub(crate) fn read(folder: &Path) -> Modules {
    let mut modules = Modules::new();
    let root = ["lib.rs", "main.rs"].into_iter().find(|file| folder.join(file).is_file());
    read_file(&mut modules, folder, root.expect("a crate has a root"), Vec::new());
    modules
}

fn read_file(modules: &mut Modules, folder: &Path, name: &str, path: ModulePath) {
    let text = std::fs::read_to_string(folder.join(name)).expect("a declared module has a file");
    let items = syn::parse_file(&text).expect("the crate compiles").items;
    read_items(modules, folder, name, path, items);
}

fn read_items(modules: &mut Modules, folder: &Path, file: &str, path: ModulePath, items: Vec<Item>) {
    let mut module = Module { file: file.to_owned(), items: Vec::new() };
    for mut item in items.into_iter().filter(|item| !is_test(item)) {
        if let Item::Mod(inner) = &mut item {
            let mut child = path.clone();
            child.push(inner.ident.to_string());
            match inner.content.take() {
                Some((_, items)) => read_items(modules, folder, file, child, items),
                None => {
                    let beside = format!("{}.rs", child.join("/"));
                    let within = format!("{}/mod.rs", child.join("/"));
                    let name = if folder.join(&beside).is_file() { beside } else { within };
                    read_file(modules, folder, &name, child);
                }
            }
        }
        module.items.push(item);
    }
    modules.insert(path, module);
}

/// The imports of a `use`, as paths that are written there.
pub(crate) fn imports<'t>(prefix: &[String], tree: &'t UseTree) -> Vec<Import<'t>> {
    let with = |name: &syn::Ident| [prefix, &[name.to_string()]].concat();
    match tree {
        UseTree::Path(path) => imports(&with(&path.ident), &path.tree),
        UseTree::Group(group) => group.items.iter().flat_map(|tree| imports(prefix, tree)).collect(),
        UseTree::Glob(_) => vec![Import::Glob(prefix.to_vec())],
        UseTree::Name(name) if name.ident == "self" => vec![Import::Name(prefix.to_vec(), &name.ident)],
        UseTree::Name(name) => vec![Import::Name(with(&name.ident), &name.ident)],
        UseTree::Rename(rename) => vec![Import::Name(with(&rename.ident), &rename.rename)],
    }
}

/// The path from the root of the crate; a path that may be of another crate is tried from here.
pub(crate) fn absolute(here: &[String], path: &[String]) -> Option<ModulePath> {
    let mut base = match path.first()?.as_str() {
        "crate" => Vec::new(),
        _ => here.to_vec(),
    };
    for segment in path {
        match segment.as_str() {
            "crate" | "self" => {}
            "super" => {
                base.pop()?;
            }
            name => base.push(name.to_owned()),
        }
    }
    Some(base)
}

/// The name that an item defines.
pub(crate) fn name_of(item: &Item) -> Option<String> {
    Some(match item {
        Item::Const(item) => item.ident.to_string(),
        Item::Enum(item) => item.ident.to_string(),
        Item::Fn(item) => item.sig.ident.to_string(),
        Item::Static(item) => item.ident.to_string(),
        Item::Struct(item) => item.ident.to_string(),
        Item::Trait(item) => item.ident.to_string(),
        Item::Type(item) => item.ident.to_string(),
        Item::Union(item) => item.ident.to_string(),
        Item::Macro(item) => item.ident.as_ref()?.to_string(),
        _ => return None,
    })
}

fn is_test(item: &Item) -> bool {
    let attributes: &[Attribute] = match item {
        Item::Mod(item) => &item.attrs,
        Item::Fn(item) => &item.attrs,
        Item::Use(item) => &item.attrs,
        Item::Impl(item) => &item.attrs,
        _ => return false,
    };
    attributes.iter().any(|attribute| {
        let text = attribute.meta.require_list().map(|list| list.tokens.to_string()).unwrap_or_default();
        attribute.path().is_ident("cfg") && text == "test" || attribute.path().is_ident("test")
    })
}
