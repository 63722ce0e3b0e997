//! The modules of a crate, the names they define and the paths they use, read from its files.

use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;

use syn::visit::{self, Visit};
use syn::{Item, UseTree};

type ModulePath = Vec<String>;

/// The modules of a crate by their paths; the root's is empty.
pub(crate) struct Crate {
    modules: BTreeMap<ModulePath, Module>,
}

#[derive(Default)]
struct Module {
    file: String,
    defined: BTreeSet<String>,
    /// Names that `use` brings in, and where from.
    imported: BTreeMap<String, ModulePath>,
    globs: Vec<ModulePath>,
    /// Paths that code of the module uses, those of imports among them.
    used: Vec<ModulePath>,
}

impl Crate {
    pub(crate) fn read(folder: &Path) -> Self {
        let mut read = Self { modules: BTreeMap::new() };
        let root = ["lib.rs", "main.rs"].into_iter().find(|file| folder.join(file).is_file());
        read.file(folder, root.expect("a crate has a root"), Vec::new());
        read
    }

    fn file(&mut self, folder: &Path, name: &str, path: ModulePath) {
        let text = std::fs::read_to_string(folder.join(name)).expect("a declared module has a file");
        let items = syn::parse_file(&text).expect("the crate compiles").items;
        self.module(folder, name, path, &items);
    }

    fn module(&mut self, folder: &Path, file: &str, path: ModulePath, items: &[Item]) {
        let mut module = Module { file: file.to_owned(), ..Module::default() };
        for item in items.iter().filter(|item| !is_test(item)) {
            match item {
                Item::Mod(inner) => {
                    let mut child = path.clone();
                    child.push(inner.ident.to_string());
                    match &inner.content {
                        Some((_, items)) => self.module(folder, file, child, items),
                        None => {
                            let beside = format!("{}.rs", child.join("/"));
                            let within = format!("{}/mod.rs", child.join("/"));
                            let name = if folder.join(&beside).is_file() { beside } else { within };
                            self.file(folder, &name, child);
                        }
                    }
                }
                Item::Use(import) => module.import(&path, &[], &import.tree),
                _ => {
                    module.defined.extend(name_of(item));
                    let mut paths = Paths { here: &path, found: Vec::new() };
                    paths.visit_item(item);
                    module.used.append(&mut paths.found);
                }
            }
        }
        self.modules.insert(path, module);
    }

    /// Of each file the files whose names it uses.
    pub(crate) fn arrows(&self) -> BTreeMap<String, BTreeSet<String>> {
        let mut arrows: BTreeMap<String, BTreeSet<String>> = BTreeMap::new();
        for module in self.modules.values() {
            let to = arrows.entry(module.file.clone()).or_default();
            // What a module brings in and leaves to others is no use of its own: private imports are used by its
            // code, and public ones count where somebody takes the name from here.
            let files = module.used.iter().filter_map(|path| self.file_of(path, 0));
            to.extend(files.filter(|file| *file != module.file));
        }
        arrows
    }

    /// The file that defines what a path names; none where it is of another crate.
    fn file_of(&self, path: &[String], depth: usize) -> Option<String> {
        assert!(depth < 32, "a re-export leads to itself: {}", path.join("::"));
        let inside = (0..=path.len()).rev().find(|&n| self.modules.contains_key(&path[..n]))?;
        let module = &self.modules[&path[..inside]];
        let name = path.get(inside)?;
        if module.defined.contains(name) {
            return Some(module.file.clone());
        }
        if let Some(from) = module.imported.get(name) {
            let further = [from.as_slice(), &path[inside + 1..]].concat();
            return self.file_of(&further, depth + 1);
        }
        module.globs.iter().find_map(|glob| {
            let further = [glob.as_slice(), &path[inside..]].concat();
            (self.modules.contains_key(glob)).then(|| self.file_of(&further, depth + 1)).flatten()
        })
    }
}

impl Module {
    fn import(&mut self, here: &[String], prefix: &[String], tree: &UseTree) {
        let with = |name: &syn::Ident| [prefix, &[name.to_string()]].concat();
        match tree {
            UseTree::Path(path) => self.import(here, &with(&path.ident), &path.tree),
            UseTree::Group(group) => group.items.iter().for_each(|tree| self.import(here, prefix, tree)),
            UseTree::Glob(_) => self.globs.extend(absolute(here, prefix)),
            UseTree::Name(name) if name.ident == "self" => self.bring(here, prefix, prefix.last()),
            UseTree::Name(name) => self.bring(here, &with(&name.ident), Some(&name.ident)),
            UseTree::Rename(rename) => self.bring(here, &with(&rename.ident), Some(&rename.rename)),
        }
    }

    fn bring(&mut self, here: &[String], path: &[String], name: Option<&impl ToString>) {
        if let (Some(path), Some(name)) = (absolute(here, path), name) {
            self.imported.insert(name.to_string(), path);
        }
    }
}

/// The path from the root of the crate; a path that may be of another crate is tried from here.
fn absolute(here: &[String], path: &[String]) -> Option<ModulePath> {
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

struct Paths<'a> {
    here: &'a [String],
    found: Vec<ModulePath>,
}

impl<'ast> Visit<'ast> for Paths<'_> {
    fn visit_path(&mut self, path: &'ast syn::Path) {
        let segments: Vec<_> = path.segments.iter().map(|segment| segment.ident.to_string()).collect();
        self.found.extend(absolute(self.here, &segments));
        visit::visit_path(self, path);
    }

    fn visit_macro(&mut self, invocation: &'ast syn::Macro) {
        visit::visit_macro(self, invocation);
        // Arguments of macros are no syntax tree: each name in them may be that of an import.
        self.found.extend(names(invocation.tokens.clone()).filter_map(|name| absolute(self.here, &[name])));
    }

    fn visit_item_use(&mut self, _: &'ast syn::ItemUse) {}
}

fn names(tokens: proc_macro2::TokenStream) -> Box<dyn Iterator<Item = String>> {
    Box::new(tokens.into_iter().flat_map(|token| match token {
        proc_macro2::TokenTree::Group(group) => names(group.stream()),
        proc_macro2::TokenTree::Ident(name) => Box::new(std::iter::once(name.to_string())),
        _ => Box::new(std::iter::empty()),
    }))
}

fn name_of(item: &Item) -> Option<String> {
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
    let attributes = match item {
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
