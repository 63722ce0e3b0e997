//! The names that the modules of a crate define and the paths they use, read from its files.

use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;

use syn::Item;
use syn::visit::{self, Visit};

use crate::modules::{self, Import, ModulePath, absolute, name_of};

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
        let mut modules = BTreeMap::new();
        for (path, read) in modules::read(folder) {
            let module = Module::of(&path, read);
            modules.insert(path, module);
        }
        Self { modules }
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
    fn of(path: &[String], read: modules::Module) -> Module {
        let mut module = Module { file: read.file, ..Module::default() };
        for item in &read.items {
            match item {
                Item::Mod(_) => {}
                Item::Use(import) => module.import(path, &import.tree),
                _ => {
                    module.defined.extend(name_of(item));
                    let mut paths = Paths { here: path, found: Vec::new() };
                    paths.visit_item(item);
                    module.used.append(&mut paths.found);
                }
            }
        }
        module
    }

    fn import(&mut self, here: &[String], tree: &syn::UseTree) {
        for import in modules::imports(&[], tree) {
            match import {
                Import::Glob(path) => self.globs.extend(absolute(here, &path)),
                Import::Name(path, name) => {
                    let name = if name == "self" { path.last().cloned() } else { Some(name.to_string()) };
                    if let (Some(path), Some(name)) = (absolute(here, &path), name) {
                        self.imported.insert(name, path);
                    }
                }
            }
        }
    }
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
