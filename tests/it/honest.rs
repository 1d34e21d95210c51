//! No test passes without checking something: each reaches an assertion, or a function that does, on every way
//! through it. It stands in no branch, in no loop that may be empty and in no `match` of which another arm has none, none
//! returns early, none is ignored, and none asserts what is always true.
//!
//! Not seen: an iterator inside an assertion that is empty, such as `assert!(none.iter().all(…))`.

use std::collections::BTreeSet;
use std::fs;
use std::ops::Range;
use std::path::{Path, PathBuf};

/// What makes a test fail.
const SURE: [&str; 6] =
    ["assert", "panic!(", "unreachable!(", "expect_err(", "unwrap_err(", "prop_assert"];

/// The beginning of an assertion of a constant. It is put together, so that whoever searches the tests for one finds none.
const VOID: &str = concat!("assert!(", "true");

/// The function that returns the items of a list and fails if there are none.
const NONEMPTY: &str = "nonempty";

/// A function of the tests.
#[derive(Clone)]
struct Function {
    /// The index of its file.
    file: usize,
    /// As it is called: that of a method begins with a dot.
    name: String,
    /// The lines between its braces.
    body: Vec<String>,
    is_test: bool,
}

pub(crate) fn sources(folder: &Path, texts: &mut Vec<(PathBuf, String)>) {
    for entry in fs::read_dir(folder).expect("a folder of the package") {
        let path = entry.expect("an entry").path();
        if path.is_dir() {
            sources(&path, texts);
        } else if path.extension().is_some_and(|end| end == "rs") {
            let text = fs::read_to_string(&path).expect("a source file");
            texts.push((path, text));
        }
    }
}

/// Code with the same lines, without comments and the text of strings.
pub(crate) fn plain(code: &str) -> String {
    let (mut plain, mut left) = (String::new(), code);
    while let Some(at) = left.find(['"', '/', '\'', 'r']) {
        plain.push_str(&left[..at]);
        left = &left[at..];
        let hashes = left[1..].len() - left[1..].trim_start_matches('#').len();
        let is_word = plain.ends_with(|c: char| c.is_alphanumeric() || c == '_');
        let length = if left.starts_with("//") {
            left.find('\n').unwrap_or(left.len())
        } else if left.starts_with('r') && left[1 + hashes..].starts_with('"') && !is_word {
            let (inside, end) = (2 + hashes, format!("\"{}", "#".repeat(hashes)));
            left[inside..].find(&end).map_or(left.len(), |at| inside + at + end.len())
        } else if let Some(rest) = left.strip_prefix('"') {
            let escaped = rest.char_indices().scan(false, |escaped, (at, c)| {
                let is_end = c == '"' && !*escaped;
                *escaped = c == '\\' && !*escaped;
                Some((at, is_end))
            });
            escaped.filter(|(_, is_end)| *is_end).map(|(at, _)| at + 2).next().unwrap_or(left.len())
        } else if let Some(rest) = left.strip_prefix('\'') {
            // a character, and no lifetime
            let after = rest.chars().nth(1);
            match rest.chars().next() {
                Some('\\') => rest[2..].find('\'').map_or(1, |at| at + 4),
                Some(c) if after == Some('\'') => c.len_utf8() + 2,
                _ => 0,
            }
        } else {
            0
        };
        if length == 0 {
            plain.push_str(&left[..1]);
            left = &left[1..];
        } else {
            plain.extend(left[..length].chars().filter(|c| *c == '\n'));
            left = &left[length..];
        }
    }
    plain + left
}

fn indent(line: &str) -> usize {
    line.len() - line.trim_start().len()
}

/// The name of a function that begins in this line.
fn named(line: &str) -> Option<&str> {
    let mut words = line
        .split_whitespace()
        .skip_while(|word| word.starts_with("pub") || ["super)", "const"].contains(word));
    let name = words.next().filter(|word| *word == "fn").and_then(|_| words.next())?;
    name.split(['(', '<']).next()
}

/// The functions of a formatted file: each ends at the brace with the indentation of its first line.
fn functions(file: usize, text: &str) -> Vec<Function> {
    let code = plain(text);
    let lines: Vec<&str> = code.lines().collect();
    let mut found = Vec::new();
    for (index, line) in lines.iter().enumerate() {
        let Some(name) = named(line) else { continue };
        let end = format!("{}}}", &line[..indent(line)]);
        let below = lines[index + 1..].iter().take_while(|line| **line != end);
        let body: Vec<&str> =
            if line.ends_with('}') { vec![*line] } else { below.copied().collect() };
        let above = lines[..index].iter().rev();
        let mut attributes = above.take_while(|line| line.is_empty() || line.contains("#["));
        let is_test = attributes.any(|line| line.trim() == "#[test]");
        let body = body.into_iter().filter(|line| !line.trim().is_empty()).map(str::to_owned);
        let length = lines[index..].iter().position(|line| line.ends_with(['{', '}']));
        let head = lines[index..].iter().take(length.unwrap_or(0) + 1);
        let mut words =
            head.flat_map(|line| line.split(|c: char| !c.is_alphanumeric() && c != '_'));
        let is_method = words.any(|word| word == "self");
        let name = if is_method { format!(".{name}") } else { name.to_owned() };
        found.push(Function { file, name, body: body.collect(), is_test });
    }
    found
}

/// The functions besides tests, by file and name: those that check something on every way through them, and the others.
struct Checking<'a> {
    able: BTreeSet<(usize, &'a str)>,
    unable: BTreeSet<(usize, &'a str)>,
    /// The names of functions that check something.
    names: BTreeSet<&'a str>,
    /// The file of the module that each file is in.
    parents: &'a [Option<usize>],
}

impl<'a> Checking<'a> {
    fn among(functions: &'a [Function], parents: &'a [Option<usize>]) -> Self {
        let helpers: Vec<&Function> =
            functions.iter().filter(|f| !f.is_test && f.name != NONEMPTY).collect();
        let (able, unable) = (BTreeSet::new(), BTreeSet::new());
        let mut checking = Self { able, unable, names: BTreeSet::new(), parents };
        loop {
            let is_able = |f: &&&Function| checking.checks(f.file, &f.body, 0..f.body.len(), 0);
            let (able, unable): (Vec<&Function>, Vec<&Function>) =
                helpers.iter().partition(is_able);
            let keys =
                |all: &[&'a Function]| all.iter().map(|f| (f.file, f.name.as_str())).collect();
            let (able, unable): (BTreeSet<_>, BTreeSet<_>) = (keys(&able), keys(&unable));
            if able == checking.able {
                return checking;
            }
            let names = able.iter().map(|(_, name)| *name).collect();
            checking = Self { able, unable, names, parents };
        }
    }

    /// Whether a call of this name in this file checks something: of a function of the file, or else of the file of the module
    /// that it is in, or else of any other.
    fn has(&self, file: usize, name: &str) -> bool {
        let own = (file, name);
        match self.parents.get(file) {
            _ if self.able.contains(&own) => true,
            _ if self.unable.contains(&own) => false,
            Some(Some(parent)) => self.has(*parent, name),
            _ => self.names.contains(name),
        }
    }

    /// Whether a line checks something.
    fn is_sure(&self, file: usize, line: &str) -> bool {
        let is_sure = SURE.iter().any(|word| line.contains(word));
        let calls = || {
            let mut names = called(line).into_iter();
            names.any(|(name, is_passed)| {
                if is_passed { self.able.contains(&(file, name)) } else { self.has(file, name) }
            })
        };
        !is_void(line) && (is_sure || calls())
    }

    /// Whether a test checks something on every way through it.
    fn is_honest(&self, test: &Function) -> bool {
        let skips =
            test.body.iter().any(|line| line.contains("return;") || line.contains("return }"));
        !skips && self.checks(test.file, &test.body, 0..test.body.len(), 0)
    }

    /// Whether one of these lines of a body checks something and runs whenever those that are indented by less do.
    fn checks(&self, file: usize, body: &[String], lines: Range<usize>, least: usize) -> bool {
        lines.into_iter().any(|index| {
            self.is_sure(file, &body[index]) && self.always_runs(file, body, index, least)
        })
    }

    /// Whether a line of a body runs whenever those that are indented by less than `least` do: in no branch, in no loop that
    /// may be empty, and in no arm of a `match` beside one that checks nothing.
    fn always_runs(&self, file: usize, body: &[String], index: usize, least: usize) -> bool {
        if is_branch(body[index].trim()) || body[index].contains("for_each(") {
            return false;
        }
        let mut depth = indent(&body[index]);
        for above in (0..index).rev() {
            let mut line = &body[above];
            if indent(line) >= depth {
                continue;
            }
            depth = indent(line);
            if depth < least {
                break;
            }
            if line.trim() == "{" {
                // the header has several lines
                let header = body[..above].iter().rev().find(|line| indent(line) == depth);
                line = header.unwrap_or(line);
            }
            if line.contains("match ") && !self.every_arm_checks(file, body, above) {
                return false;
            }
            let line = line.trim();
            let may_be_empty = |(_, items): (&str, &str)| !is_filled(body, items);
            let loops = line.starts_with("for ").then(|| line.split_once(" in ")).flatten();
            if is_branch(line) || loops.is_some_and(may_be_empty) {
                return false;
            }
        }
        true
    }

    /// Whether all arms of the `match` with this header check something.
    fn every_arm_checks(&self, file: usize, body: &[String], header: usize) -> bool {
        let depth = indent(&body[header]) + 4;
        let inside = body[header + 1..].iter().take_while(|line| indent(line) >= depth).count();
        let (first, end) = (header + 1, header + 1 + inside);
        let is_arm =
            |index: &usize| indent(&body[*index]) == depth && body[*index].contains(" => ");
        let starts: Vec<usize> = (first..end).filter(is_arm).collect();
        let ends = starts.iter().skip(1).copied().chain([end]);
        starts.iter().zip(ends).all(|(&start, end)| self.checks(file, body, start..end, depth))
    }
}

/// Whether what follows this line, or this line, need not run.
fn is_branch(line: &str) -> bool {
    let branches = ["if ", "} else", "while ", "loop "];
    branches.iter().any(|word| line.starts_with(word)) || line.contains("for_each(")
}

/// The names that a line calls, or may pass to be called; those of methods begin with a dot.
fn called(line: &str) -> Vec<(&str, bool)> {
    let is_word = |c: char| c.is_alphanumeric() || c == '_';
    let (mut names, mut at) = (Vec::new(), 0);
    while let Some(start) = line[at..].find(is_word).map(|found| at + found) {
        let length = line[start..].find(|c| !is_word(c)).unwrap_or(line.len() - start);
        at = start + length;
        let (before, after) = (&line[..start], &line[at..]);
        let is_call = after.starts_with('(') || after.starts_with("::<");
        let is_passed = before.ends_with('(') && after.starts_with(')');
        let is_method = before.ends_with('.') && !before.ends_with("..");
        // a function of a type, most likely of the library
        let qualifier =
            before.strip_suffix("::").and_then(|path| path.rsplit(|c| !is_word(c)).next());
        let is_of_type = qualifier.is_some_and(|name| name.starts_with(char::is_uppercase));
        if (is_call || is_passed) && !is_of_type {
            names.push((&line[start - usize::from(is_method)..at], is_passed));
        }
    }
    names
}

/// Whether an assertion is true whatever happens.
fn is_void(line: &str) -> bool {
    let either = [("is_ok()", "is_err()"), ("is_some()", "is_none()")];
    let is_either = |(one, other): (&str, &str)| {
        let Some((left, right)) = line.split_once(" || ") else { return false };
        let subject = |text: &str, end: &str| {
            let start = text.find(end)?;
            text[..start].rsplit(['(', '!', ' ']).next().map(str::to_owned)
        };
        let same = |a, b| subject(left, a).is_some_and(|left| Some(left) == subject(right, b));
        same(one, other) || same(other, one)
    };
    line.contains(VOID) || line.contains("assert") && either.into_iter().any(is_either)
}

/// Whether what a loop goes over has an item for sure: it is written as a list or a range of numbers, a constant, a list of the
/// same body, or checked to have one.
fn is_filled(body: &[String], items: &str) -> bool {
    let items = items.trim_start_matches('&');
    let is_list = |text: &str| {
        let text = text.trim_start_matches(['&', '(']);
        let is_list = text.starts_with('[') && !text.starts_with("[]");
        is_list || text.starts_with("vec![") || text.contains(".chain([")
    };
    let name =
        items.split(|c: char| !c.is_alphanumeric() && !"_:".contains(c)).next().unwrap_or("");
    let is_bound = || {
        let text = body.iter().map(|line| line.trim()).collect::<Vec<_>>().join(" ");
        let bound = [format!("let {name} = "), format!("let {name}: ")];
        let mut starts = bound.iter().filter_map(|start| Some(text.split_once(start)?.1));
        starts.any(|rest| {
            let before_value = rest.split_once("] = ").filter(|_| rest.starts_with('['));
            is_list(before_value.map_or(rest, |(_, value)| value))
        })
    };
    let constant = name.rsplit("::").next().unwrap_or("");
    let is_constant = constant.len() > 1 && !constant.contains(|c: char| c.is_lowercase());
    let number = items.trim_start_matches(['(', '-']);
    is_list(items)
        || number.starts_with(|c: char| c.is_ascii_digit())
        || is_constant
        || name == NONEMPTY
        || !name.is_empty() && is_bound()
}

/// The names of tests that may pass without checking anything.
fn idle<'a>(functions: &'a [Function], parents: &[Option<usize>]) -> Vec<&'a str> {
    let checking = Checking::among(functions, parents);
    let tests = functions.iter().filter(|f| f.is_test);
    tests.filter(|f| !checking.is_honest(f)).map(|f| f.name.as_str()).collect()
}

#[test]
fn every_test_checks_something() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let (mut texts, mut code) = (Vec::new(), Vec::new());
    sources(&root.join("tests/it"), &mut texts);
    sources(&root.join("src"), &mut code);
    for (path, text) in code {
        texts.extend(text.split_once("#[cfg(test)]").map(|(_, tests)| (path, tests.to_owned())));
    }
    let left_out = ["#[", "ignore"].concat();
    assert!(texts.iter().all(|(_, text)| !text.contains(&left_out)), "a test is left out");
    let place = |wanted: &Path| texts.iter().position(|(path, _)| path == wanted);
    let parent = |path: &Path| place(&path.parent()?.with_extension("rs"));
    let parents: Vec<Option<usize>> = texts.iter().map(|(path, _)| parent(path)).collect();
    let all = texts.iter().enumerate();
    let functions: Vec<Function> =
        all.flat_map(|(file, (_, text))| functions(file, text)).collect();
    let tests = functions.iter().filter(|f| f.is_test).count();
    assert!(tests > 2000, "only {tests} tests were found");
    assert_eq!(idle(&functions, &parents), Vec::<&str>::new());
}

#[test]
fn what_checks_nothing_is_found() {
    let helpers = "fn check(x: u8) {\n    assert_eq!(x, 1);\n}\nfn run(x: u8) {}\n\
                   fn perhaps(x: u8) {\n    match x {\n        1 => check(x),\n        _ => {}\n    }\n}\n";
    let parents = [Some(1), None, None];
    let outside = [
        functions(1, "fn surely(x: u8) {\n    assert_eq!(x, 1);\n}\n"),
        functions(2, "fn surely(x: u8) {}\nfn run(x: u8) {\n    assert_eq!(x, 1);\n}\n"),
    ];
    let check = |body: &str, found: usize| {
        let lines: Vec<String> = body.lines().map(|line| format!("    {line}\n")).collect();
        let text = format!("#[test]\nfn it() {{\n{}}}\n{helpers}", lines.concat());
        let own = functions(0, &text).into_iter();
        let all: Vec<Function> = own.chain(outside.iter().flatten().cloned()).collect();
        assert_eq!(idle(&all, &parents).len(), found, "{body}");
    };
    for honest in [
        "assert!(works());",
        "check(1);",
        "surely(1);",
        "[1, 2].map(check);",
        "for x in 0..2 {\n    check(x)\n}",
        "for x in [1, 2] {\n    check(x)\n}",
        "for x in CASES {\n    check(x)\n}",
        "for x in nonempty(list()) {\n    check(x)\n}",
        "let all = [1, 2];\nfor x in &all {\n    check(*x)\n}",
        "for x in list() {\n    check(x)\n}\nassert!(!list().is_empty());",
        "match it() {\n    Ok(x) => check(x),\n    Err(why) => panic!(\"{why}\"),\n}",
        "match it() {\n    0 => check(1),\n    1 | 2 => match other() {\n        3 => check(3),\n        _ => check(4),\n    },\n    _ => {\n        run(5);\n        check(5);\n    }\n}",
        "match it() {\n    Ok(x) => check(x),\n    Err(_) => {}\n}\ncheck(2);",
        "assert!(a.is_ok() || b.is_err());",
        "let quote = '\"';\nassert_eq!(it(), quote);",
    ] {
        check(honest, 0);
    }
    let early = ["let Some(x) = tool() else { re", "turn };\ncheck(x);"].concat();
    for idle in [
        "run(1);",
        "perhaps(1);",
        "// assert!(works());\nrun(1);",
        "run(\"assert!(works());\");",
        "run(r#\"assert!(\"works\");\"#);",
        concat!("assert!(", "true);"),
        "assert!(it.is_ok() || it.is_err());",
        "assert!(it.is_none() || it.is_some(), \"{it:?}\");",
        "for x in list() {\n    check(x)\n}",
        "for x in [] {\n    check(x)\n}",
        "for x in nonempty(list()) {\n    run(x)\n}",
        "for x in list()\n    .iter()\n    .rev()\n{\n    check(x)\n}",
        "list().for_each(|x| {\n    check(x)\n});",
        "if let Some(x) = it() {\n    check(x)\n}",
        "while let Some(x) = it() {\n    check(x)\n}",
        "match it() {\n    Ok(x) => check(x),\n    Err(_) => {}\n}",
        "match it() {\n    Some(x) => {\n        check(x);\n    }\n    None => run(0),\n}",
        "let x = match it() {\n    Ok(x) => x,\n    Err(why) => panic!(\"{why}\"),\n};\nrun(x);",
        "match it()\n    .other()\n{\n    Ok(x) => check(x),\n    Err(_) => run(0),\n}",
        "match it() {\n    0 => check(1),\n    _ => match other() {\n        3 => check(3),\n        _ => {}\n    },\n}",
        "match it() {\n    0 => check(1),\n    _ => {\n        if is_so() {\n            check(3)\n        }\n    }\n}",
        &early,
    ] {
        check(idle, 1);
    }
}
