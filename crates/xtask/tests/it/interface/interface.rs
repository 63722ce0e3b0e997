//! The public interface of a crate, as Rust without bodies, documentation and what is private.

use std::collections::BTreeMap;

use syn::visit_mut::{self, VisitMut};
use syn::{
    Attribute, Fields, FieldsNamed, ImplItem, Item, ItemImpl, Token, TraitItem, Type, Visibility, parse_quote,
};

use crate::modules::{Import, ModulePath, Modules, absolute, imports, name_of};

/// Attributes that are part of what is offered.
const OFFERED: [&str; 6] = ["cfg", "derive", "from", "must_use", "non_exhaustive", "repr"];

/// Where a name is defined: the module and the name there, or the path into another crate.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord)]
enum Origin {
    Here(ModulePath, String),
    Elsewhere(String),
}

/// Implementations, each with whether it is of a trait, and its text, by which they are ordered.
type Ordered = Vec<((bool, String), Item)>;

/// The interface of a crate: each public name, in order, with its definition and what is implemented for it.
pub(crate) fn of(modules: &Modules) -> String {
    let mut names = BTreeMap::new();
    offered(modules, &[], &mut names);
    let implementations = implementations(modules, &names);
    let mut text = String::new();
    for (name, origin) in &names {
        let mut items = match origin {
            Origin::Elsewhere(path) => {
                let path: syn::UseTree = syn::parse_str(path).expect("a path");
                vec![parse_quote!(pub use #path;)]
            }
            Origin::Here(module, own) => {
                let all = modules[module].items.iter();
                all.filter(|item| name_of(item).as_ref() == Some(own)).cloned().map(without_bodies).collect()
            }
        };
        items.extend(implementations.get(origin).into_iter().flatten().cloned());
        let file = syn::File { shebang: None, attrs: Vec::new(), items };
        text += &format!("// {name}\n{}\n", prettyplease::unparse(&file));
    }
    text
}

/// The names that other crates can use, by their paths.
fn offered(modules: &Modules, path: &[String], names: &mut BTreeMap<String, Origin>) {
    let public = |name: &str| [path, &[name.to_owned()]].concat().join("::");
    for item in &modules[path].items {
        match item {
            Item::Mod(inner) if is_public(&inner.vis) => {
                offered(modules, &[path, &[inner.ident.to_string()]].concat(), names);
            }
            Item::Use(import) if is_public(&import.vis) => {
                for import in imports(&[], &import.tree) {
                    let (from, name) = match import {
                        Import::Name(from, name) => (from, name),
                        Import::Glob(all) => panic!("{}: all of {all:?} is offered", modules[path].file),
                    };
                    names.insert(public(&name.to_string()), origin(modules, path, &from));
                }
            }
            _ if visibility(item).is_some_and(is_public) => {
                let name = name_of(item).expect("what is public has a name");
                names.insert(public(&name), Origin::Here(path.to_vec(), name));
            }
            _ => {}
        }
    }
}

/// Where that is defined which a module calls by this path.
fn origin(modules: &Modules, here: &[String], path: &[String]) -> Origin {
    let elsewhere = || Origin::Elsewhere(path.join("::"));
    let Some(full) = absolute(here, path) else { return elsewhere() };
    let Some(inside) = (0..full.len()).rev().find(|&n| modules.contains_key(&full[..n])) else {
        return elsewhere();
    };
    let (module, name) = (&full[..inside], &full[inside]);
    let items = &modules[module].items;
    if items.iter().any(|item| name_of(item).as_ref() == Some(name)) {
        return Origin::Here(module.to_vec(), name.clone());
    }
    let uses =
        items.iter().filter_map(|item| if let Item::Use(import) = item { Some(&import.tree) } else { None });
    for import in uses.flat_map(|tree| imports(&[], tree)) {
        if let Import::Name(from, known) = import
            && known == name
            && from.len() + full.len() - inside > 1
            && absolute(module, &from).as_deref() != Some(&full)
        {
            return origin(modules, module, &[from.as_slice(), &full[inside + 1..]].concat());
        }
    }
    elsewhere()
}

/// What is implemented: functions of public types, public or foreign traits for them, and public traits for foreign types.
fn implementations(modules: &Modules, names: &BTreeMap<String, Origin>) -> BTreeMap<Origin, Vec<Item>> {
    let mut found: BTreeMap<Origin, Ordered> = BTreeMap::new();
    let is_offered = |origin: &Origin| names.values().any(|known| known == origin);
    for (path, module) in modules {
        for item in &module.items {
            let Item::Impl(implementation) = item else { continue };
            let of_type = path_of(&implementation.self_ty).map(|own| origin(modules, path, &own));
            let of_trait =
                implementation.trait_.as_ref().map(|(_, name, _)| origin(modules, path, &segments(name)));
            let owner = match (of_type, of_trait) {
                (Some(own), None) if is_offered(&own) => own,
                (Some(own), Some(law)) if is_offered(&own) && (is_offered(&law) || is_foreign(&law)) => own,
                (Some(Origin::Elsewhere(_)) | None, Some(law)) if is_offered(&law) => law,
                _ => continue,
            };
            if let Some(shown) = shown(implementation.clone()) {
                let text = prettyplease::unparse(&syn::File {
                    shebang: None,
                    attrs: Vec::new(),
                    items: vec![shown.clone()],
                });
                // Functions of a type come before what it implements.
                let order = (implementation.trait_.is_some(), text);
                found.entry(owner).or_default().push((order, shown));
            }
        }
    }
    let sorted = |(origin, mut items): (Origin, Ordered)| {
        items.sort_by(|a, b| a.0.cmp(&b.0));
        (origin, items.into_iter().map(|(_, item)| item).collect())
    };
    found.into_iter().map(sorted).collect()
}

fn is_foreign(origin: &Origin) -> bool {
    matches!(origin, Origin::Elsewhere(_))
}

/// What others see of an implementation: public functions, and of a trait the types that it chooses.
fn shown(mut implementation: ItemImpl) -> Option<Item> {
    let of_trait = implementation.trait_.is_some();
    implementation.items.retain(|item| match item {
        ImplItem::Fn(item) => !of_trait && is_public(&item.vis),
        ImplItem::Const(item) => !of_trait && is_public(&item.vis),
        ImplItem::Type(_) => true,
        _ => false,
    });
    let is_empty = implementation.items.is_empty();
    (of_trait || !is_empty).then(|| without_bodies(Item::Impl(implementation)))
}

/// The names of the path of a type, behind references.
fn path_of(own: &Type) -> Option<Vec<String>> {
    match own {
        Type::Path(path) => Some(segments(&path.path)),
        Type::Reference(reference) => path_of(&reference.elem),
        _ => None,
    }
}

fn segments(path: &syn::Path) -> Vec<String> {
    path.segments.iter().map(|segment| segment.ident.to_string()).collect()
}

fn is_public(visibility: &Visibility) -> bool {
    matches!(visibility, Visibility::Public(_))
}

fn visibility(item: &Item) -> Option<&Visibility> {
    Some(match item {
        Item::Const(item) => &item.vis,
        Item::Enum(item) => &item.vis,
        Item::Fn(item) => &item.vis,
        Item::Static(item) => &item.vis,
        Item::Struct(item) => &item.vis,
        Item::Trait(item) => &item.vis,
        Item::Type(item) => &item.vis,
        Item::Union(item) => &item.vis,
        _ => return None,
    })
}

fn without_bodies(mut item: Item) -> Item {
    Bare.visit_item_mut(&mut item);
    item
}

/// Takes away what others do not see.
struct Bare;

impl VisitMut for Bare {
    fn visit_attributes_mut(&mut self, attributes: &mut Vec<Attribute>) {
        attributes.retain(|attribute| OFFERED.iter().any(|offered| attribute.path().is_ident(offered)));
    }

    fn visit_item_struct_mut(&mut self, item: &mut syn::ItemStruct) {
        match &mut item.fields {
            Fields::Named(FieldsNamed { named, .. }) => {
                let public = named.iter().filter(|field| is_public(&field.vis)).cloned();
                let mut shown: syn::punctuated::Punctuated<_, Token![,]> = public.collect();
                if shown.len() < named.len() {
                    let rest: FieldsNamed = parse_quote!({ _rest: _ });
                    shown.extend(rest.named);
                }
                *named = shown;
            }
            Fields::Unnamed(fields) => {
                for field in fields.unnamed.iter_mut().filter(|field| !is_public(&field.vis)) {
                    field.ty = parse_quote!(_);
                    field.vis = Visibility::Inherited;
                }
            }
            Fields::Unit => {}
        }
        visit_mut::visit_item_struct_mut(self, item);
    }

    fn visit_block_mut(&mut self, block: &mut syn::Block) {
        block.stmts.clear();
    }

    fn visit_item_const_mut(&mut self, item: &mut syn::ItemConst) {
        *item.expr = parse_quote!(_);
        visit_mut::visit_item_const_mut(self, item);
    }

    fn visit_item_static_mut(&mut self, item: &mut syn::ItemStatic) {
        *item.expr = parse_quote!(_);
        visit_mut::visit_item_static_mut(self, item);
    }

    fn visit_impl_item_const_mut(&mut self, item: &mut syn::ImplItemConst) {
        item.expr = parse_quote!(_);
        visit_mut::visit_impl_item_const_mut(self, item);
    }

    fn visit_trait_item_mut(&mut self, item: &mut TraitItem) {
        if let TraitItem::Const(item) = item
            && let Some((_, value)) = &mut item.default
        {
            *value = parse_quote!(_);
        }
        visit_mut::visit_trait_item_mut(self, item);
    }
}
