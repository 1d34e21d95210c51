//! Dependencies between the files of a room: facades without code, cycles, and a single way to open a system.

use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::path::{Path, PathBuf};

/// The code of every module by its path, such as `system::watch`, without comments, the text of strings, and tests.
struct Source(BTreeMap<String, String>);

impl Source {
    fn read() -> Source {
        let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("src");
        let (mut modules, mut folders) = (BTreeMap::new(), vec![root.clone()]);
        while let Some(folder) = folders.pop() {
            for entry in fs::read_dir(folder).expect("a folder of src") {
                let path = entry.expect("an entry").path();
                if path.is_dir() {
                    folders.push(path);
                } else if path.extension().is_some_and(|extension| extension == "rs") {
                    let code = fs::read_to_string(&path).expect("a source file");
                    modules.insert(name_of(&root, &path), plain(&code));
                }
            }
        }
        Source(modules)
    }

    /// The module to which a path leads, following re-exports of facades.
    fn module(&self, path: &[String], uses: &Uses, depth: u32) -> Option<String> {
        let at = (1..=path.len()).rev().find(|&k| self.0.contains_key(&path[..k].join("::")))?;
        let module = path[..at].join("::");
        let given = path.get(at).and_then(|name| uses.0.get(&module)?.get(name));
        match given.filter(|given| depth > 0 && given.as_slice() != path) {
            Some(given) => {
                let on: Vec<String> = given.iter().chain(&path[at + 1..]).cloned().collect();
                self.module(&on, uses, depth - 1)
            }
            None => Some(module),
        }
    }

    /// The absolute path that a path inside a module means.
    fn absolute(&self, module: &str, path: &str) -> Option<Vec<String>> {
        let mut names: Vec<String> = path.split("::").map(str::to_owned).collect();
        let mut here: Vec<String> = module.split("::").map(str::to_owned).collect();
        match names[0].as_str() {
            "crate" => here.clear(),
            "self" => {}
            "super" => {
                while names.first().is_some_and(|name| name == "super") {
                    here.pop()?;
                    names.remove(0);
                }
                return Some([here, names].concat());
            }
            child if self.0.contains_key(&format!("{module}::{child}")) => {
                return Some([here, names].concat());
            }
            _ => return None,
        }
        names.remove(0);
        Some([here, names].concat())
    }

    /// The files of the same room that each file uses. A mere re-export by a facade is no use.
    fn graph(&self) -> BTreeMap<&str, BTreeSet<String>> {
        let uses = Uses::of(self);
        let mut graph = BTreeMap::new();
        for (module, code) in &self.0 {
            let has_children = self.0.keys().any(|m| m.starts_with(&format!("{module}::")));
            let (statements, rest) = statements(code);
            let taken = statements.into_iter().filter(|(given, _)| !(*given && has_children));
            let named = paths_in(&rest);
            let paths = taken.flat_map(|(_, paths)| paths).chain(named);
            let room = module.split("::").next();
            let to = paths.filter_map(|path| self.module(&self.absolute(module, &path)?, &uses, 8));
            let inside = to.filter(|to| to != module && to.split("::").next() == room);
            graph.insert(module.as_str(), inside.collect());
        }
        graph
    }
}

/// The names that each module imports with `use`, and their paths.
struct Uses(BTreeMap<String, BTreeMap<String, Vec<String>>>);

impl Uses {
    fn of(source: &Source) -> Uses {
        let of_one = |(module, code): (&String, &String)| {
            let paths = statements(code).0.into_iter().flat_map(|(_, paths)| paths);
            let named = paths.filter_map(|path| {
                let path = source.absolute(module, &path)?;
                Some((path.last()?.clone(), path))
            });
            (module.clone(), named.collect())
        };
        Uses(source.0.iter().map(of_one).collect())
    }
}

fn name_of(root: &Path, path: &Path) -> String {
    let inside: PathBuf = path.strip_prefix(root).expect("inside").with_extension("");
    let names: Vec<_> = inside.iter().map(|name| name.to_string_lossy().into_owned()).collect();
    names.join("::")
}

/// Code without comments, the text of strings, and the tests at its end.
fn plain(code: &str) -> String {
    let mut plain = String::new();
    for line in code.lines().take_while(|line| *line != "#[cfg(test)]") {
        let mut inside = false;
        let mut characters = line.chars().peekable();
        while let Some(c) = characters.next() {
            match c {
                '\\' if inside => drop(characters.next()),
                '"' => inside = !inside,
                '/' if !inside && characters.peek() == Some(&'/') => break,
                c if !inside => plain.push(c),
                _ => {}
            }
        }
        plain.push('\n');
    }
    plain
}

/// The `use` statements, each with a flag for re-exports, and the rest of the code.
fn statements(code: &str) -> (Vec<(bool, Vec<String>)>, String) {
    let (mut found, mut rest, mut left) = (Vec::new(), String::new(), code);
    while let Some(at) = left.find("use ") {
        let start = left[..at].rfind('\n').map_or(0, |newline| newline + 1);
        let before = left[start..at].trim();
        let length = left[at..].find(';');
        let (true, Some(length)) = (before.is_empty() || before.starts_with("pub"), length) else {
            rest.push_str(&left[..at + 4]);
            left = &left[at + 4..];
            continue;
        };
        rest.push_str(&left[..start]);
        let tree: String =
            left[at + 4..at + length].split_whitespace().collect::<Vec<_>>().join(" ");
        found.push((!before.is_empty(), branches("", &tree)));
        left = &left[at + length + 1..];
    }
    rest.push_str(left);
    (found, rest)
}

/// All paths of a tree of a `use` statement.
fn branches(before: &str, tree: &str) -> Vec<String> {
    let tree = tree.trim();
    let Some((head, list)) = tree.split_once('{') else {
        let path = tree.split(" as ").next().unwrap_or(tree).trim();
        let path = path.strip_suffix("::self").unwrap_or(path);
        return if path.is_empty() { Vec::new() } else { vec![format!("{before}{path}")] };
    };
    let list = list.trim_end().strip_suffix('}').unwrap_or(list);
    let (mut depth, mut start, mut all) = (0, 0, Vec::new());
    let before = format!("{before}{}", head.trim());
    for (at, c) in list.char_indices().chain([(list.len(), ',')]) {
        match c {
            '{' => depth += 1,
            '}' => depth -= 1,
            ',' if depth == 0 => {
                let part = list[start..at].trim();
                let part = if part == "self" { "" } else { part };
                let whole = before.trim_end_matches("::");
                all.extend(match part {
                    "" if start < at => vec![whole.to_owned()],
                    part => branches(&before, part),
                });
                start = at + 1;
            }
            _ => {}
        }
    }
    all
}

/// The paths in code outside its `use` statements.
fn paths_in(code: &str) -> Vec<String> {
    let mut found = Vec::new();
    for start in ["crate::", "super::", "self::"] {
        for (at, _) in code.match_indices(start) {
            let before = code[..at].chars().next_back();
            if before.is_some_and(|c| c.is_alphanumeric() || "_:$".contains(c)) {
                continue;
            }
            let path: String = code[at..]
                .chars()
                .take_while(|c| c.is_alphanumeric() || "_:".contains(*c))
                .collect();
            found.push(path.trim_end_matches(':').to_owned());
        }
    }
    found
}

/// The files that depend on themselves.
fn in_circles(graph: &BTreeMap<&str, BTreeSet<String>>) -> Vec<String> {
    let reaches_itself = |file: &&&str| {
        let mut seen = BTreeSet::new();
        let mut next: Vec<&str> = vec![file];
        while let Some(at) = next.pop() {
            for to in graph.get(at).into_iter().flatten() {
                if to == **file {
                    return true;
                }
                if seen.insert(to.as_str()) {
                    next.push(to);
                }
            }
        }
        false
    };
    graph.keys().filter(reaches_itself).map(|file| (*file).to_owned()).collect()
}

#[test]
fn no_file_of_a_room_depends_on_itself() {
    let source = Source::read();
    let files = in_circles(&source.graph());
    assert!(files.is_empty(), "{files:#?}");
}

#[test]
fn circles_are_found_by_whatever_name_a_file_is_used() {
    let source = |files: &[(&str, &str)]| {
        Source(files.iter().map(|(name, code)| ((*name).to_owned(), plain(code))).collect())
    };
    let check = |files: &[(&str, &str)], expected: &[&str]| {
        assert_eq!(in_circles(&source(files).graph()), expected, "{files:?}");
    };
    let facade = ("room", "mod a;\nmod b;\npub use a::A;\npub use b::{B, C as D};");
    check(&[facade, ("room::a", "use super::b::B;"), ("room::b", "")], &[]);
    check(
        &[facade, ("room::a", "use super::b::B;"), ("room::b", "use crate::room::A;")],
        &["room::a", "room::b"],
    );
    check(
        &[facade, ("room::a", "fn f(x: super::B) {}"), ("room::b", "use super::{A, x::Y};")],
        &["room::a", "room::b"],
    );
    check(
        &[
            facade,
            ("room::a", "// use super::b::B;\nlet x = \"super::b\";"),
            ("room::b", "use super::A;"),
        ],
        &[],
    );
}

#[test]
fn a_facade_holds_modules_and_what_it_gives_out() {
    let source = Source::read();
    let mut wrong = Vec::new();
    for (module, code) in &source.0 {
        let has_children = source.0.keys().any(|m| m.starts_with(&format!("{module}::")));
        if module.contains("::") || !has_children {
            continue;
        }
        let rest = statements(code).1;
        let other = rest.lines().map(str::trim).filter(|line| !line.is_empty());
        let other = other.filter(|line| !(line.ends_with(';') && line.contains("mod ")));
        wrong.extend(other.map(|line| format!("{module}: {line}")));
    }
    assert!(wrong.is_empty(), "{wrong:#?}");
}

#[test]
fn a_system_is_opened_by_the_stages_of_prepared() {
    // claims are compared with what was derived for them; a system held at an instant is another system
    let may = ["experiment::prepared", "claims::check", "action_angle::frozen"];
    let opens =
        |code: &str| code.contains("mechanics::derive") || code.contains("System::compile(");
    let source = Source::read();
    let others = source.0.iter().filter(|(module, code)| {
        let here = code.split("#[cfg(test)]").next().unwrap_or(code);
        !may.contains(&module.as_str()) && opens(here)
    });
    let others: Vec<&String> = others.map(|(module, _)| module).collect();
    assert!(others.is_empty(), "{others:?}");
}
