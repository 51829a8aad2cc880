//! Which file of a crate uses which: from its `use` lines and every other path, through re-exports to the file that defines
//! what is named. Comments, strings, and what is compiled for tests only do not count.

use proc_macro2::{Delimiter, Ident, Spacing, TokenStream, TokenTree};
use quote::ToTokens;
use std::collections::{BTreeMap, BTreeSet};
use syn::{Attribute, ImplItem, Item, Meta, UseTree, Visibility};

/// One file uses another one.
#[derive(Debug)]
pub struct Import {
    pub from: usize,
    pub to: usize,
    pub line: usize,
    /// The path as it is written.
    pub path: String,
    /// The name is only passed on to others (`pub use`), not used in the file itself.
    pub passed_on: bool,
}

/// Files, by their paths from the folder `src`, and what they use of each other.
#[derive(Debug, Default)]
pub struct Sources {
    pub files: Vec<String>,
    pub imports: Vec<Import>,
}

/// Follows the module declarations from `lib.rs` and `main.rs`. `text` gives a file's text by its path from the folder `src`.
pub fn read(text: &dyn Fn(&str) -> Option<String>) -> Result<Sources, String> {
    let mut sources = Sources::default();
    for top in ["lib.rs", "main.rs"] {
        if let Some(source) = text(top) {
            let mut tree = Tree { text, files: std::mem::take(&mut sources.files), modules: vec![], macros: vec![] };
            tree.file(None, top, "", &source)?;
            sources.imports.extend(tree.imports());
            sources.files = tree.files;
        }
    }
    if sources.files.is_empty() { Err("there is no lib.rs and no main.rs".into()) } else { Ok(sources) }
}

/// A name that a `use` line brings in.
struct Use {
    path: Vec<String>,
    /// `None`: all names of a module.
    name: Option<String>,
    line: usize,
    public: bool,
}

struct Module {
    parent: Option<usize>,
    file: usize,
    children: BTreeMap<String, usize>,
    defined: BTreeSet<String>,
    uses: Vec<Use>,
    /// Everything else.
    code: Vec<TokenStream>,
}

/// What a path leads to.
#[derive(Clone, Copy)]
enum Found {
    Module(usize),
    /// Something that is defined in a file.
    Item(usize),
}

/// Modules of one crate; the first one is its top.
struct Tree<'t> {
    text: &'t dyn Fn(&str) -> Option<String>,
    files: Vec<String>,
    modules: Vec<Module>,
    /// Macros by rules, which are also found without a path, and the files that define them.
    macros: Vec<(String, usize)>,
}

/// Whether a condition holds in tests only.
fn tests_only(attributes: &[Attribute]) -> bool {
    fn needs_test(meta: &Meta) -> bool {
        let of_list = |list: &syn::MetaList| {
            let parts = list.parse_args_with(syn::punctuated::Punctuated::<Meta, syn::Token![,]>::parse_terminated);
            list.path.is_ident("all") && parts.is_ok_and(|parts| parts.iter().any(needs_test))
        };
        meta.path().is_ident("test") || matches!(meta, Meta::List(list) if of_list(list))
    }
    attributes.iter().any(|attribute| {
        attribute.path().is_ident("test")
            || attribute.path().is_ident("cfg") && attribute.parse_args::<Meta>().is_ok_and(|meta| needs_test(&meta))
    })
}

fn attributes(item: &Item) -> &[Attribute] {
    match item {
        Item::Const(i) => &i.attrs,
        Item::Enum(i) => &i.attrs,
        Item::Fn(i) => &i.attrs,
        Item::Impl(i) => &i.attrs,
        Item::Macro(i) => &i.attrs,
        Item::Mod(i) => &i.attrs,
        Item::Static(i) => &i.attrs,
        Item::Struct(i) => &i.attrs,
        Item::Trait(i) => &i.attrs,
        Item::Type(i) => &i.attrs,
        Item::Union(i) => &i.attrs,
        Item::Use(i) => &i.attrs,
        _ => &[],
    }
}

/// The name that an item defines.
fn defined(item: &Item) -> Option<&Ident> {
    match item {
        Item::Const(i) => Some(&i.ident),
        Item::Enum(i) => Some(&i.ident),
        Item::Fn(i) => Some(&i.sig.ident),
        Item::Macro(i) => i.ident.as_ref(),
        Item::Static(i) => Some(&i.ident),
        Item::Struct(i) => Some(&i.ident),
        Item::Trait(i) => Some(&i.ident),
        Item::Type(i) => Some(&i.ident),
        Item::Union(i) => Some(&i.ident),
        _ => None,
    }
}

/// The leaves of a `use` line.
fn leaves(tree: &UseTree, path: &[String], public: bool, out: &mut Vec<Use>) {
    let with = |ident: &Ident| [path, &[ident.to_string()]].concat();
    let mut leaf = |path: Vec<String>, name: Option<String>, ident: &Ident| {
        out.push(Use { path, name, line: ident.span().start().line, public });
    };
    match tree {
        UseTree::Path(part) => leaves(&part.tree, &with(&part.ident), public, out),
        UseTree::Name(part) if part.ident == "self" => leaf(path.to_vec(), path.last().cloned(), &part.ident),
        UseTree::Name(part) => leaf(with(&part.ident), Some(part.ident.to_string()), &part.ident),
        UseTree::Rename(part) if part.ident == "self" => {
            leaf(path.to_vec(), Some(part.rename.to_string()), &part.ident)
        }
        UseTree::Rename(part) => leaf(with(&part.ident), Some(part.rename.to_string()), &part.ident),
        UseTree::Glob(part) => {
            out.push(Use { path: path.to_vec(), name: None, line: part.star_token.spans[0].start().line, public })
        }
        UseTree::Group(group) => group.items.iter().for_each(|tree| leaves(tree, path, public, out)),
    }
}

impl Tree<'_> {
    /// Adds the module of a file; those that it declares without content lie in `folder`.
    fn file(&mut self, parent: Option<usize>, path: &str, folder: &str, text: &str) -> Result<usize, String> {
        let parsed = syn::parse_file(text).map_err(|error| format!("{path}:{}: {error}", error.span().start().line))?;
        let file = self.files.iter().position(|file| file == path).unwrap_or_else(|| {
            self.files.push(path.into());
            self.files.len() - 1
        });
        self.module(parent, file, folder, parsed.items)
    }

    fn module(&mut self, parent: Option<usize>, file: usize, folder: &str, items: Vec<Item>) -> Result<usize, String> {
        let at = self.modules.len();
        let (children, defined_here) = Default::default();
        self.modules.push(Module { parent, file, children, defined: defined_here, uses: vec![], code: vec![] });
        for mut item in items {
            if tests_only(attributes(&item)) {
                continue;
            }
            if let Some(name) = defined(&item) {
                self.modules[at].defined.insert(name.to_string());
                if matches!(item, Item::Macro(_)) {
                    self.macros.push((name.to_string(), file));
                }
            }
            match &mut item {
                Item::Use(line) if line.leading_colon.is_none() => {
                    let public = !matches!(line.vis, Visibility::Inherited);
                    leaves(&line.tree, &[], public, &mut self.modules[at].uses);
                    continue;
                }
                Item::Mod(module) => {
                    let name = module.ident.to_string();
                    let inner = format!("{folder}{name}/");
                    let child = match module.content.take() {
                        Some((_, items)) => self.module(Some(at), file, &inner, items)?,
                        None => self.declared(at, folder, &name, &module.attrs)?,
                    };
                    self.modules[at].children.insert(name, child);
                    continue;
                }
                Item::Impl(block) => block.items.retain(|item| match item {
                    ImplItem::Fn(f) => !tests_only(&f.attrs),
                    ImplItem::Const(c) => !tests_only(&c.attrs),
                    _ => true,
                }),
                _ => {}
            }
            self.modules[at].code.push(item.to_token_stream());
        }
        Ok(at)
    }

    /// The module of `mod name;`.
    fn declared(&mut self, at: usize, folder: &str, name: &str, attributes: &[Attribute]) -> Result<usize, String> {
        let own = self.files[self.modules[at].file].clone();
        let given = attributes.iter().find_map(|attribute| match &attribute.meta {
            Meta::NameValue(pair) if pair.path.is_ident("path") => {
                let file = pair.value.to_token_stream().to_string();
                let beside = own.rsplit_once('/').map_or(String::new(), |(folder, _)| format!("{folder}/"));
                Some(beside + file.trim_matches('"'))
            }
            _ => None,
        });
        let usual = [format!("{folder}{name}.rs"), format!("{folder}{name}/mod.rs")];
        for path in given.into_iter().chain(usual) {
            if let Some(text) = (self.text)(&path) {
                return self.file(Some(at), &path, &format!("{folder}{name}/"), &text);
            }
        }
        Err(format!("{own}: the file of `mod {name}` is not there"))
    }

    /// A name in a module. Where it stands for a module and for something else, `last` says whether the path ends there.
    fn lookup(&self, at: usize, name: &str, last: bool, depth: usize) -> Option<Found> {
        let module = self.modules.get(at).filter(|_| depth < 20)?;
        let child = || module.children.get(name).map(|&child| Found::Module(child));
        let item = || module.defined.contains(name).then_some(Found::Item(module.file));
        let used = || {
            let line = module.uses.iter().find(|line| line.name.as_deref() == Some(name))?;
            // What comes from another crate counts as defined where it comes in.
            Some(self.resolve(at, &line.path, depth + 1).unwrap_or(Found::Item(module.file)))
        };
        let found = if last { item().or_else(used).or_else(child) } else { child().or_else(used).or_else(item) };
        found.or_else(|| {
            let mut all = module.uses.iter().filter(|line| line.name.is_none());
            all.find_map(|line| match self.resolve(at, &line.path, depth + 1)? {
                Found::Module(from) if from != at => self.lookup(from, name, last, depth + 1),
                _ => None,
            })
        })
    }

    /// Where a path in a module leads; `None`: out of the crate.
    fn resolve(&self, at: usize, path: &[String], depth: usize) -> Option<Found> {
        let (first, mut rest) = path.split_first()?;
        let mut found = match first.as_str() {
            "crate" => Found::Module(0),
            "self" => Found::Module(at),
            "super" => Found::Module(self.modules[at].parent?),
            name => self.lookup(at, name, rest.is_empty(), depth)?,
        };
        while let (Found::Module(module), Some((name, after))) = (found, rest.split_first()) {
            rest = after;
            found = match name.as_str() {
                "super" => Found::Module(self.modules[module].parent?),
                // A name that a macro makes is not seen.
                name => self
                    .lookup(module, name, rest.is_empty(), depth)
                    .or_else(|| self.exported(module, name))
                    .unwrap_or(Found::Item(self.modules[module].file)),
            };
        }
        Some(found)
    }

    /// Macros may be exported to the top of the crate.
    fn exported(&self, module: usize, name: &str) -> Option<Found> {
        let found = self.macros.iter().find(|(own, _)| own == name);
        found.filter(|_| module == 0).map(|&(_, file)| Found::Item(file))
    }

    fn imports(&self) -> Vec<Import> {
        let mut all = Vec::new();
        for (at, module) in self.modules.iter().enumerate() {
            let mut add = |to: usize, line: usize, path: &[String], passed_on: bool| {
                if to != module.file {
                    all.push(Import { from: module.file, to, line, path: path.join("::"), passed_on });
                }
            };
            for line in &module.uses {
                match (self.resolve(at, &line.path, 0), &line.name) {
                    (Some(Found::Item(file)), _) => add(file, line.line, &line.path, line.public),
                    // A module alone: what is used of it follows in the code.
                    (Some(Found::Module(from)), Some(_)) if line.public => {
                        add(self.modules[from].file, line.line, &line.path, true);
                    }
                    (Some(Found::Module(from)), None) if line.public || !self.modules[from].defined.is_empty() => {
                        add(self.modules[from].file, line.line, &line.path, line.public);
                    }
                    _ => {}
                }
            }
            let mut paths = Vec::new();
            module.code.iter().for_each(|tokens| scan(tokens.clone(), &[], &mut paths));
            for Path { parts, line, called } in paths {
                let first = parts[0].as_str();
                let own = module.uses.iter().find(|line| line.name.as_deref() == Some(first));
                // Its `use` line is an import already, unless that only passes it on or brings in a module.
                let counted = own
                    .is_some_and(|own| !own.public && matches!(self.resolve(at, &own.path, 0), Some(Found::Item(_))));
                let known = module.defined.contains(first) && !module.children.contains_key(first);
                match self.resolve(at, &parts, 0) {
                    _ if known || counted => {}
                    Some(Found::Item(file)) => add(file, line, &parts, false),
                    Some(Found::Module(from)) if parts.len() > 1 => add(self.modules[from].file, line, &parts, false),
                    None if called => {
                        if let Some((_, file)) = self.macros.iter().find(|(name, _)| name == first) {
                            add(*file, line, &parts, false);
                        }
                    }
                    _ => {}
                }
            }
        }
        all
    }
}

/// A path in the code.
struct Path {
    parts: Vec<String>,
    line: usize,
    /// An exclamation mark follows.
    called: bool,
}

/// Finds paths in code of any kind, the bodies of macros and nested groups `a::{b, c::d}` included.
fn scan(tokens: TokenStream, before: &[String], out: &mut Vec<Path>) {
    let tokens: Vec<TokenTree> = tokens.into_iter().collect();
    let punct = |i: usize, c: char| matches!(tokens.get(i), Some(TokenTree::Punct(p)) if p.as_char() == c);
    let colons = |i: usize| {
        matches!(tokens.get(i), Some(TokenTree::Punct(p)) if p.as_char() == ':' && p.spacing() == Spacing::Joint)
            && punct(i + 1, ':')
    };
    let mut i = 0;
    while let Some(token) = tokens.get(i) {
        i += 1;
        let ident = match token {
            TokenTree::Group(group) => {
                scan(group.stream(), &[], out);
                continue;
            }
            TokenTree::Ident(ident) => ident,
            _ => continue,
        };
        // A field or method (but not the end of a range), a lifetime, another name.
        let at = i - 1;
        let dot = at > 0 && punct(at - 1, '.') && !(at > 1 && punct(at - 2, '.'));
        let renamed = at > 0 && matches!(&tokens[at - 1], TokenTree::Ident(word) if word == "as") && !before.is_empty();
        let absolute = at > 1 && colons(at - 2);
        if ident == "as" || dot || renamed || absolute || at > 0 && punct(at - 1, '\'') {
            continue;
        }
        let mut parts = before.to_vec();
        if ident != "self" || before.is_empty() {
            parts.push(ident.to_string());
        }
        let line = ident.span().start().line;
        let mut grouped = false;
        while colons(i) {
            match tokens.get(i + 2) {
                Some(TokenTree::Ident(next)) => parts.push(next.to_string()),
                Some(TokenTree::Group(group)) if group.delimiter() == Delimiter::Brace => {
                    scan(group.stream(), &parts, out);
                    grouped = true;
                    i += 3;
                    break;
                }
                _ => break,
            }
            i += 3;
        }
        if !grouped {
            out.push(Path { parts, line, called: punct(i, '!') });
        }
    }
}
