//! The modules of a crate, read from its source files: what each imports and which paths it names. The check of the
//! layers needs this. Tests are left out.

use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};

use anyhow::{Context as _, bail};
use proc_macro2::{Delimiter, TokenStream, TokenTree};

/// Names from the crate's root to a module or an item; empty for the root itself.
pub type Names = Vec<String>;

/// One module. An inline module has the file of the module around it.
#[derive(Debug, Default)]
pub struct Module {
    /// Its source file.
    pub file: PathBuf,
    /// The paths that `use` imports, by the names that they have here.
    pub imports: BTreeMap<String, Names>,
    /// The paths of everything that the module uses, in imports and in its code, as they are written. A path that is
    /// only re-exported does not count.
    pub paths: BTreeSet<Names>,
}

/// The modules of the crate with this root file (`lib.rs` or `main.rs`), by name.
pub fn modules(root: &Path) -> anyhow::Result<BTreeMap<Names, Module>> {
    let mut reader = Reader::default();
    let folder = root.parent().context("a source file lies in a folder")?;
    reader.file(&Names::new(), root.to_owned(), folder.to_owned())?;
    Ok(reader.modules)
}

#[derive(Default)]
struct Reader {
    modules: BTreeMap<Names, Module>,
}

#[derive(Default)]
struct Contents {
    imports: Vec<Import>,
    paths: BTreeSet<Names>,
    words: BTreeSet<String>,
}

struct Import {
    name: String,
    path: Names,
    public: bool,
}

impl Reader {
    /// Reads a source file whose child modules lie in `folder`.
    fn file(&mut self, module: &Names, file: PathBuf, folder: PathBuf) -> anyhow::Result<()> {
        let text = std::fs::read_to_string(&file).with_context(|| format!("{}", file.display()))?;
        let tokens: TokenStream =
            text.parse().map_err(|error| anyhow::anyhow!("{}: {error}", file.display()))?;
        self.module(module, &file, &folder, tokens)
    }

    fn module(
        &mut self,
        module: &Names,
        file: &Path,
        folder: &Path,
        tokens: TokenStream,
    ) -> anyhow::Result<()> {
        let mut contents = Contents::default();
        let mut children = Vec::new();
        read(tokens, &mut contents, &mut children);
        for (name, body) in children {
            let child = [module.as_slice(), std::slice::from_ref(&name)].concat();
            let within = folder.join(&name);
            match body {
                Some(body) => self.module(&child, file, &within, body)?,
                None => {
                    let places = [folder.join(format!("{name}.rs")), within.join("mod.rs")];
                    let Some(found) = places.into_iter().find(|place| place.is_file()) else {
                        bail!("{} has `mod {name};`, but that file is missing", file.display());
                    };
                    self.file(&child, found, within)?;
                }
            }
        }
        let Contents { imports, mut paths, words } = contents;
        for import in &imports {
            if !import.public || words.contains(&import.name) {
                paths.insert(import.path.clone());
            }
        }
        let imports = imports.into_iter().map(|import| (import.name, import.path)).collect();
        self.modules.insert(module.clone(), Module { file: file.to_owned(), imports, paths });
        Ok(())
    }
}

/// Reads the tokens of one module into `contents`. Adds its child modules to `children`: their names, and the tokens of
/// inline ones.
fn read(tokens: TokenStream, contents: &mut Contents, children: &mut Vec<(String, Option<TokenStream>)>) {
    let tokens: Vec<TokenTree> = tokens.into_iter().collect();
    let mut at = 0;
    let mut public = false;
    while let Some(token) = tokens.get(at) {
        at += 1;
        match token {
            TokenTree::Punct(mark) if mark.as_char() == '#' => {
                at += usize::from(is_mark(tokens.get(at), '!'));
                let Some(TokenTree::Group(attribute)) = tokens.get(at) else { continue };
                at += 1;
                if is_for_tests(&attribute.stream()) {
                    at = after_item(&tokens, at);
                }
            }
            TokenTree::Group(group) => read(group.stream(), contents, children),
            TokenTree::Ident(word) if word == "pub" => public = true,
            TokenTree::Ident(word) if word == "mod" => {
                let Some(TokenTree::Ident(name)) = tokens.get(at) else { continue };
                let body = match tokens.get(at + 1) {
                    Some(TokenTree::Group(body)) => Some(body.stream()),
                    _ => None,
                };
                children.push((name.to_string(), body));
                (at, public) = (at + 2, false);
            }
            TokenTree::Ident(word) if word == "use" && !is_mark(tokens.get(at), '<') => {
                let end = (at..tokens.len()).find(|&end| is_mark(tokens.get(end), ';'));
                let end = end.unwrap_or(tokens.len());
                imports(&tokens[at..end], &Names::new(), public, &mut contents.imports);
                (at, public) = (end, false);
            }
            TokenTree::Ident(word) => {
                let mut path = vec![word.to_string()];
                while let Some(name) = next_name(&tokens, at) {
                    path.push(name);
                    at += 3;
                }
                contents.words.insert(path[0].clone());
                if path.len() > 1 {
                    contents.paths.insert(path);
                }
                public = false;
            }
            TokenTree::Punct(_) | TokenTree::Literal(_) => {}
        }
    }
}

/// Adds the imports of a `use` tree to `found`. `before` has the names that stand before the tree.
fn imports(tree: &[TokenTree], before: &Names, public: bool, found: &mut Vec<Import>) {
    for branch in tree.split(|token| is_mark(Some(token), ',')) {
        let mut path = before.clone();
        let mut name = None;
        for token in branch {
            match token {
                TokenTree::Ident(word) if word == "as" => name = Some(String::new()),
                TokenTree::Ident(word) if name.is_some() => name = Some(word.to_string()),
                TokenTree::Ident(word) if word == "self" && !path.is_empty() => {}
                TokenTree::Ident(word) => path.push(word.to_string()),
                TokenTree::Punct(mark) if mark.as_char() == '*' => path.push("*".to_owned()),
                TokenTree::Group(group) => {
                    let inner: Vec<TokenTree> = group.stream().into_iter().collect();
                    imports(&inner, &path, public, found);
                    path.clear();
                }
                TokenTree::Punct(_) | TokenTree::Literal(_) => {}
            }
        }
        if let Some(last) = path.last().filter(|_| !branch.is_empty()) {
            let name = name.unwrap_or_else(|| last.clone());
            found.push(Import { name, path, public });
        }
    }
}

/// The name after the `::` at index `at`, if there is one.
fn next_name(tokens: &[TokenTree], at: usize) -> Option<String> {
    match (tokens.get(at), tokens.get(at + 1), tokens.get(at + 2)) {
        (first, second, Some(TokenTree::Ident(name))) if is_mark(first, ':') && is_mark(second, ':') => {
            Some(name.to_string())
        }
        _ => None,
    }
}

fn is_mark(token: Option<&TokenTree>, wanted: char) -> bool {
    matches!(token, Some(TokenTree::Punct(mark)) if mark.as_char() == wanted)
}

/// Whether an attribute limits what follows to test builds.
fn is_for_tests(attribute: &TokenStream) -> bool {
    let text = attribute.to_string().replace(' ', "");
    text.starts_with("cfg(test") || text.starts_with("cfg(all(test")
}

/// The index after the item that starts at `at`: past its `;` or, except for a `use`, past its braces.
fn after_item(tokens: &[TokenTree], at: usize) -> usize {
    let mut is_use = false;
    for (place, token) in tokens.iter().enumerate().skip(at) {
        match token {
            TokenTree::Ident(word) if word == "use" => is_use = true,
            TokenTree::Group(group) if group.delimiter() == Delimiter::Brace && !is_use => return place + 1,
            token if is_mark(Some(token), ';') => return place + 1,
            _ => {}
        }
    }
    tokens.len()
}
