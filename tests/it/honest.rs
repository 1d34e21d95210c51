//! No test passes without checking something: each contains an assertion or calls a function that does, none returns
//! early, and none is ignored.

use std::collections::BTreeSet;
use std::fs;
use std::path::Path;

/// What makes a test fail.
const SURE: [&str; 6] =
    ["assert", "panic!(", "unreachable!(", "expect_err(", "unwrap_err(", "prop_assert"];

/// A function of the tests.
struct Function {
    name: String,
    body: String,
    is_test: bool,
}

fn sources(folder: &Path, texts: &mut Vec<String>) {
    for entry in fs::read_dir(folder).expect("a folder of the package") {
        let path = entry.expect("an entry").path();
        if path.is_dir() {
            sources(&path, texts);
        } else if path.extension().is_some_and(|end| end == "rs") {
            texts.push(fs::read_to_string(path).expect("a source file"));
        }
    }
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
fn functions(text: &str) -> Vec<Function> {
    let lines: Vec<&str> = text.lines().collect();
    let mut found = Vec::new();
    for (index, line) in lines.iter().enumerate() {
        let Some(name) = named(line) else { continue };
        let indent = &line[..line.len() - line.trim_start().len()];
        let end = format!("{indent}}}");
        let below = lines[index + 1..].iter().take_while(|line| **line != end);
        let one_line = line.ends_with('}');
        let body: Vec<&str> = if one_line { vec![*line] } else { below.copied().collect() };
        let above = lines[..index].iter().rev();
        let mut attributes =
            above.take_while(|line| line.trim_start().starts_with("#[") || line.contains("///"));
        let is_test = attributes.any(|line| line.trim() == "#[test]");
        found.push(Function { name: name.to_owned(), body: body.join("\n"), is_test });
    }
    found
}

fn calls(body: &str, names: &BTreeSet<String>) -> bool {
    let mut words = body.split(|c: char| !c.is_alphanumeric() && c != '_' && c != '(');
    words.any(|word| word.split('(').any(|name| names.contains(name)) && word.contains('('))
}

/// The names of tests that cannot fail.
fn idle(functions: &[Function]) -> Vec<&str> {
    let holds = |f: &Function| SURE.iter().any(|word| f.body.contains(word));
    let mut checking = BTreeSet::new();
    loop {
        let more: Vec<&Function> = functions
            .iter()
            .filter(|f| !f.is_test && !checking.contains(&f.name))
            .filter(|f| holds(f) || calls(&f.body, &checking))
            .collect();
        if more.is_empty() {
            break;
        }
        checking.extend(more.into_iter().map(|f| f.name.clone()));
    }
    let skips = |f: &Function| ["return;", "return }"].iter().any(|word| f.body.contains(word));
    let tests = functions.iter().filter(|f| f.is_test);
    let idle = tests.filter(|f| skips(f) || !(holds(f) || calls(&f.body, &checking)));
    idle.map(|f| f.name.as_str()).collect()
}

#[test]
fn every_test_looks_at_something() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let (mut texts, mut code) = (Vec::new(), Vec::new());
    sources(&root.join("tests/it"), &mut texts);
    sources(&root.join("src"), &mut code);
    let tests_of = |text: &String| Some(text.split_once("#[cfg(test)]")?.1.to_owned());
    texts.extend(code.iter().filter_map(tests_of));
    let left_out = ["#[", "ignore"].concat();
    assert!(texts.iter().all(|text| !text.contains(&left_out)), "a test is left out");
    let functions: Vec<Function> = texts.iter().flat_map(|text| functions(text)).collect();
    let tests = functions.iter().filter(|f| f.is_test).count();
    assert!(tests > 900, "only {tests} tests were found");
    assert_eq!(idle(&functions), Vec::<&str>::new());
}

#[test]
fn what_looks_at_nothing_is_found() {
    let test = |body: &str| format!("#[test]\nfn it() {{\n    {body}\n}}\n");
    let check = |body: &str, found: usize| {
        let text = test(body) + "fn check(x: u8) {\n    assert_eq!(x, 1);\n}\nfn run(x: u8) {}\n";
        assert_eq!(idle(&functions(&text)).len(), found, "{body}");
    };
    check("assert!(true);", 0);
    check("check(1);", 0);
    check("for x in 0..2 { check(x) }", 0);
    check("run(1);", 1);
    check(&["let Some(x) = tool() else { re", "turn };\n    check(x);"].concat(), 1);
}
