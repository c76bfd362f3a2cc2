//! The graph of a crate's modules, and the circles in it.
//!
//! A module depends on what its paths name: those of its `use`, its types, expressions and macros,
//! followed through re-exports to the module that has the item. What only tests compile does not
//! count, nor does code in `quote!`, which is that of somebody else.
//!
//! The children of a folder are its modules, each with all that lies below it. If anything below
//! child A names anything below child B, A depends on B; children of a folder must not depend on
//! each other in a circle. Between a folder and its face, which is `a.rs` beside `a/`, nothing
//! counts. A face tells the story of its folder, calls its children and keeps what they share, so
//! they may name each other. What a face offers with `pub use` belongs to the face for those below it:
//! the types of a model refer to each other, and meet there. Everybody else depends on the module
//! that has it, and so do those below the face if it only imports an item for itself.

#[cfg(test)]
mod tests;

use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::path::Path;

use proc_macro2::{TokenStream, TokenTree};
use quote::ToTokens;
use syn::{Attribute, Ident, Item, ItemUse, UseTree, Visibility};

/// The names from the root of a crate to a module, or from a module to an item.
type Names = Vec<String>;

/// The files of a crate: their paths below its `src`, and their texts.
pub type Files = BTreeMap<String, String>;

/// A dependency of one child of a folder on another one, and a place that shows it.
#[derive(Debug, Clone, PartialEq, Eq, PartialOrd, Ord)]
pub struct Edge {
    folder: Names,
    from: String,
    to: String,
    place: String,
}

/// Reads all Rust files below a folder.
///
/// # Panics
///
/// If one cannot be read.
pub fn files(source: &Path) -> Files {
    let mut files = Files::new();
    let mut folders = vec![source.to_owned()];
    while let Some(folder) = folders.pop() {
        for path in fs::read_dir(folder).expect("the folder exists").flatten().map(|entry| entry.path()) {
            if path.is_dir() {
                folders.push(path);
            } else if path.extension().is_some_and(|ending| ending == "rs") {
                let name = path.strip_prefix(source).expect("it lies below").to_string_lossy().replace('\\', "/");
                files.insert(name, fs::read_to_string(&path).expect("it is text"));
            }
        }
    }
    files
}

/// Returns a text on each circle: its folder and its modules, and a place for each edge.
pub fn circles(files: &Files) -> Vec<String> {
    let edges = Graph::new(files).edges();
    let folders: BTreeSet<_> = edges.iter().map(|edge| &edge.folder).collect();
    folders.into_iter().flat_map(|folder| circles_of(folder, &edges)).collect()
}

/// Finds the circles among the children of a folder.
fn circles_of(folder: &Names, edges: &[Edge]) -> Vec<String> {
    let edges: Vec<_> = edges.iter().filter(|edge| edge.folder == *folder).collect();
    let children: BTreeSet<&str> = edges.iter().map(|edge| &*edge.from).collect();
    let needed: BTreeMap<_, _> = children.iter().map(|child| (*child, needed_by(child, &edges))).collect();
    let mut circles: BTreeMap<BTreeSet<&str>, Vec<String>> = BTreeMap::new();
    for edge in &edges {
        let is_needed_back = |child: &&str| needed[&*edge.from].contains(child) && needed[child].contains(&*edge.from);
        let modules: BTreeSet<_> = children.iter().copied().filter(is_needed_back).collect();
        if modules.contains(&*edge.to) {
            let text = format!("  {} needs {}: {}", edge.from, edge.to, edge.place);
            circles.entry(modules).or_default().push(text);
        }
    }
    let texts = circles.iter().map(|(modules, edges)| {
        let modules = modules.iter().copied().collect::<Vec<_>>().join(", ");
        format!("in `{}`: {modules}\n{}", crate_path(folder), edges.join("\n"))
    });
    texts.collect()
}

/// Returns all that a child of a folder needs, and what that needs, and so on.
fn needed_by<'e>(child: &'e str, edges: &[&'e Edge]) -> BTreeSet<&'e str> {
    let mut needed = BTreeSet::new();
    let mut next = vec![child];
    while let Some(child) = next.pop() {
        let new = edges.iter().filter(|edge| edge.from == child).map(|edge| &*edge.to);
        next.extend(new.filter(|other| needed.insert(*other)));
    }
    needed
}

fn crate_path(names: &[String]) -> String {
    std::iter::once("crate").chain(names.iter().map(String::as_str)).collect::<Vec<_>>().join("::")
}

/// A module, as far as its dependencies go.
#[derive(Default)]
struct Module {
    file: String,
    /// What its `use` calls by a name, and whether others may use that name.
    aliases: BTreeMap<String, (Names, bool)>,
    /// The paths in it.
    paths: Vec<Names>,
}

/// The modules of a crate.
struct Graph<'a> {
    files: &'a Files,
    modules: BTreeMap<Names, Module>,
}

impl<'a> Graph<'a> {
    fn new(files: &'a Files) -> Self {
        let mut graph = Self { files, modules: BTreeMap::new() };
        graph.read(vec![], "lib.rs");
        graph
    }

    fn read(&mut self, module: Names, file: &str) {
        let syntax = syn::parse_file(&self.files[file]).expect("it compiles");
        self.insert(module, file, syntax.items);
    }

    fn insert(&mut self, at: Names, file: &str, items: Vec<Item>) {
        let mut module = Module { file: file.to_owned(), ..Module::default() };
        for item in items {
            match item {
                Item::Mod(child) if !is_for_tests(&child.attrs) => {
                    let path = [&*at, &[child.ident.to_string()]].concat();
                    match child.content {
                        Some((_, items)) => self.insert(path, file, items),
                        None => self.read(path.clone(), &format!("{}.rs", path.join("/"))),
                    }
                }
                Item::Use(import) if !is_for_tests(&import.attrs) => module.import(&import),
                Item::Mod(_) | Item::Use(_) => {}
                item => collect(item.into_token_stream(), &mut module.paths),
            }
        }
        self.modules.insert(at, module);
    }

    /// Returns each edge once.
    fn edges(&self) -> Vec<Edge> {
        let mut edges = BTreeMap::new();
        for (from, module) in &self.modules {
            for path in &module.paths {
                let Some((to, _)) = self.module(from, from, path, 0) else { continue };
                let shared = from.iter().zip(&to).take_while(|(from, to)| from == to).count();
                if let (Some(child), Some(other)) = (from.get(shared), to.get(shared)) {
                    let key = (from[..shared].to_vec(), child.clone(), other.clone());
                    edges.entry(key).or_insert_with(|| self.place(&module.file, path));
                }
            }
        }
        let edges = edges.into_iter().map(|((folder, from, to), place)| Edge { folder, from, to, place });
        edges.collect()
    }

    /// Returns the module to which a path in a module leads from another one, and whether the path ends there; nothing
    /// for a path out of the crate.
    fn module(&self, from: &[String], at: &[String], path: &[String], depth: usize) -> Option<(Names, bool)> {
        let mut at = at.to_vec();
        for (place, name) in path.iter().enumerate() {
            let child = [&*at, std::slice::from_ref(name)].concat();
            match (&**name, self.modules[&at].aliases.get(name)) {
                ("crate", _) => at.clear(),
                ("self", _) => {}
                ("super", _) => drop(at.pop()?),
                _ if self.modules.contains_key(&child) => at = child,
                (_, Some((_, true))) if from.starts_with(&at) && *from != *at => return Some((at, false)),
                (_, Some((alias, _))) if depth < 9 && *alias != [name.clone()] => {
                    match self.module(from, &at, alias, depth + 1)? {
                        (module, true) => at = module,
                        (module, false) => return Some((module, false)),
                    }
                }
                _ => return (place > 0).then_some((at, false)),
            }
        }
        Some((at, true))
    }

    /// Returns the line that names most of the end of a path.
    fn place(&self, file: &str, path: &[String]) -> String {
        let is_in_name = |letter: char| letter.is_alphanumeric() || letter == '_';
        let names = |line: &str, end: &str| {
            let mut found = line.match_indices(end).map(|(start, _)| (&line[..start], &line[start + end.len()..]));
            found.any(|(before, after)| !before.ends_with(is_in_name) && !after.starts_with(is_in_name))
        };
        let lines = || self.files[file].lines().enumerate().filter(|(_, line)| !line.trim_start().starts_with("//"));
        let mut ends = (0..path.len()).map(|start| path[start..].join("::"));
        let line = ends.find_map(|end| lines().find(|(_, line)| names(line, &end)));
        format!("{file}:{} ({})", line.map_or(1, |(number, _)| number + 1), path.join("::"))
    }
}

impl Module {
    fn import(&mut self, import: &ItemUse) {
        if import.leading_colon.is_none() {
            self.import_tree(&import.tree, vec![], !matches!(import.vis, Visibility::Inherited));
        }
    }

    fn import_tree(&mut self, tree: &UseTree, mut before: Names, is_offered: bool) {
        match tree {
            UseTree::Path(path) => {
                before.push(path.ident.to_string());
                self.import_tree(&path.tree, before, is_offered);
            }
            UseTree::Group(group) => {
                group.items.iter().for_each(|tree| self.import_tree(tree, before.clone(), is_offered));
            }
            UseTree::Name(name) => self.alias(&name.ident, before, &name.ident, is_offered),
            UseTree::Rename(rename) => self.alias(&rename.ident, before, &rename.rename, is_offered),
            UseTree::Glob(_) => self.paths.push(before),
        }
    }

    fn alias(&mut self, name: &Ident, mut before: Names, called: &Ident, is_offered: bool) {
        let called = if called == "self" { before.last().cloned() } else { Some(called.to_string()) };
        before.extend((name != "self").then(|| name.to_string()));
        self.aliases.extend(called.map(|called| (called, (before.clone(), is_offered))));
        self.paths.push(before);
    }
}

/// Collects the paths in code, except what only tests compile and what stands in `quote!`.
fn collect(tokens: TokenStream, paths: &mut Vec<Names>) {
    let tokens: Vec<_> = tokens.into_iter().collect();
    let text: Vec<_> = tokens.iter().map(ToString::to_string).collect();
    let follows = |place: usize, wanted: &[&str]| {
        wanted.iter().zip(text.get(place..).unwrap_or(&[])).filter(|(a, b)| a == b).count() == wanted.len()
    };
    let mut place = 0;
    while place < tokens.len() {
        match &tokens[place] {
            TokenTree::Punct(_) if follows(place, &["#", "[cfg (test)]"]) => place += item_length(&text[place..]),
            TokenTree::Ident(name) if name.to_string().starts_with("quote") && follows(place + 1, &["!"]) => place += 2,
            TokenTree::Ident(name) => {
                let mut path = vec![name.to_string()];
                while follows(place + 1, &[":", ":"]) && matches!(tokens.get(place + 3), Some(TokenTree::Ident(_))) {
                    path.push(text[place + 3].clone());
                    place += 3;
                }
                paths.extend((path.len() > 1).then_some(path));
            }
            TokenTree::Group(group) => collect(group.stream(), paths),
            TokenTree::Punct(_) | TokenTree::Literal(_) => {}
        }
        place += 1;
    }
}

/// Returns how many tokens an item has, up to its braces or its semicolon.
fn item_length(tokens: &[String]) -> usize {
    tokens.iter().take_while(|token| !token.starts_with('{') && *token != ";").count()
}

fn is_for_tests(attributes: &[Attribute]) -> bool {
    let conditions = ["# [cfg (test)]", "# [cfg (all (test ,"];
    let mut texts = attributes.iter().map(|attribute| attribute.to_token_stream().to_string());
    texts.any(|text| conditions.iter().any(|condition| text.starts_with(condition)))
}
