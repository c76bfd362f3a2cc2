//! The names in generated code: none stands twice where Rust allows one.

use std::collections::{BTreeMap, BTreeSet};

use quote::ToTokens;
use syn::{Fields, ImplItem, Item, UseTree};

/// Tests the names of a module, of its structs and enums, and of what belongs to them.
pub fn check(file: &syn::File) {
    distinct("the types", file.items.iter().flat_map(types).collect());
    distinct("the values", file.items.iter().filter_map(value).collect());
    file.items.iter().for_each(check_members);
    for (owner, names) in associated(file) {
        distinct(&owner, names);
    }
}

fn distinct(owner: &str, names: Vec<String>) {
    let mut known = BTreeSet::new();
    for name in names {
        assert!(known.insert(name.clone()), "`{name}` stands twice among {owner}");
    }
}

/// Returns the names that an item gives to types.
fn types(item: &Item) -> Vec<String> {
    match item {
        Item::Struct(known) => vec![known.ident.to_string()],
        Item::Enum(known) => vec![known.ident.to_string()],
        Item::Trait(known) => vec![known.ident.to_string()],
        Item::Type(known) => vec![known.ident.to_string()],
        Item::Use(known) => imported(&known.tree),
        _ => Vec::new(),
    }
}

/// Returns the names that an import makes known, those of a glob aside, which any other name hides.
fn imported(tree: &UseTree) -> Vec<String> {
    match tree {
        UseTree::Path(path) => imported(&path.tree),
        UseTree::Name(name) => vec![name.ident.to_string()],
        UseTree::Rename(rename) => vec![rename.rename.to_string()],
        UseTree::Group(group) => group.items.iter().flat_map(imported).collect(),
        UseTree::Glob(_) => Vec::new(),
    }
}

/// Returns the name that an item gives to a constant or a function.
fn value(item: &Item) -> Option<String> {
    match item {
        Item::Const(known) if known.ident != "_" => Some(known.ident.to_string()),
        Item::Static(known) => Some(known.ident.to_string()),
        Item::Fn(known) => Some(known.sig.ident.to_string()),
        _ => None,
    }
}

/// Tests the fields of a struct, or the variants of an enum.
fn check_members(item: &Item) {
    match item {
        Item::Struct(known) => distinct(&known.ident.to_string(), fields(&known.fields)),
        Item::Enum(known) => {
            distinct(
                &known.ident.to_string(),
                known.variants.iter().map(|variant| variant.ident.to_string()).collect(),
            );
        }
        _ => {}
    }
}

fn fields(fields: &Fields) -> Vec<String> {
    fields.iter().filter_map(|field| field.ident.as_ref()).map(ToString::to_string).collect()
}

/// Returns the constants and functions of each type, whatever block they stand in.
fn associated(file: &syn::File) -> BTreeMap<String, Vec<String>> {
    let mut names = BTreeMap::<_, Vec<_>>::new();
    for item in &file.items {
        let Item::Impl(block) = item else { continue };
        if block.trait_.is_none() {
            let owned = block.items.iter().filter_map(|item| match item {
                ImplItem::Const(known) => Some(known.ident.to_string()),
                ImplItem::Fn(known) => Some(known.sig.ident.to_string()),
                _ => None,
            });
            names.entry(block.self_ty.to_token_stream().to_string()).or_default().extend(owned);
        }
    }
    names
}
