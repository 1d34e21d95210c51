//! An untrusted file does no damage: whatever its bytes, an answer comes soon and without a panic.

use std::fmt::Write as _;
use std::sync::LazyLock;

use phaselab::diagnostic::TEXT_LIMIT;
use phaselab::diagnostic::{Diagnostic, Document, report};
use phaselab::preset::read;
use proptest::prelude::*;
use proptest::sample::Index;

use super::GOOD;
use crate::fixtures::catalog;

/// Reads bytes and renders all errors in them; all positions lie in the text.
fn survive(bytes: &[u8]) {
    let document = Document::from_bytes("hostile.toml", bytes);
    let diagnostics = match document.read() {
        Ok(checked) => checked.warnings,
        Err(diagnostics) => {
            assert!(!diagnostics.is_empty());
            diagnostics
        }
    };
    for diagnostic in &diagnostics {
        let place = diagnostic.place.clone();
        assert!(document.text.get(place).is_some(), "{diagnostic:?}");
    }
    let drawn = document.report(&diagnostics, false);
    assert_eq!(drawn.matches("hostile.toml:").count(), diagnostics.len());
    document.report(&diagnostics, true);
}

fn shipped() -> &'static [String] {
    static TEXTS: LazyLock<Vec<String>> =
        LazyLock::new(|| catalog().entries().iter().map(|e| e.document().unwrap().text).collect());
    &TEXTS
}

/// A change of a text.
#[derive(Clone, Debug)]
enum Change {
    Put(Index, u8),
    Cut(Index, usize),
    Copy(Index, Index, usize),
}

fn change() -> impl Strategy<Value = Change> {
    let index = any::<Index>;
    let mark =
        prop_oneof![any::<u8>(), prop::sample::select(b"\"'[]{}()=,.#\\\n*/^-+0ae_t".to_vec())];
    prop_oneof![
        (index(), mark).prop_map(|(at, byte)| Change::Put(at, byte)),
        (index(), 1..40_usize).prop_map(|(at, length)| Change::Cut(at, length)),
        (index(), index(), 1..40_usize)
            .prop_map(|(from, to, length)| Change::Copy(from, to, length)),
    ]
}

fn apply(bytes: &mut Vec<u8>, change: &Change) {
    if bytes.is_empty() {
        return;
    }
    match change {
        Change::Put(at, byte) => {
            let at = at.index(bytes.len());
            bytes[at] = *byte;
        }
        Change::Cut(at, length) => {
            let at = at.index(bytes.len());
            bytes.drain(at..(at + length).min(bytes.len()));
        }
        Change::Copy(from, to, length) => {
            let from = from.index(bytes.len());
            let piece = bytes[from..(from + length).min(bytes.len())].to_vec();
            let to = to.index(bytes.len());
            bytes.splice(to..to, piece);
        }
    }
}

proptest! {
    #![proptest_config(crate::cases(400))]

    #[test]
    fn a_damaged_preset_gives_an_answer(
        which in any::<Index>(),
        changes in prop::collection::vec(change(), 1..8),
    ) {
        let texts = shipped();
        let mut bytes = texts[which.index(texts.len())].clone().into_bytes();
        for change in &changes {
            apply(&mut bytes, change);
        }
        survive(&bytes);
    }

    #[test]
    fn any_text_gives_an_answer(text in "\\PC{0,200}") {
        survive(text.as_bytes());
        survive(GOOD.replace("1/2*k*x^2", &text.replace(['"', '\\'], "")).as_bytes());
    }
}

/// The only error of a text.
fn only(text: &str) -> Diagnostic {
    let diagnostics = read(text).unwrap_err();
    assert_eq!(diagnostics.len(), 1, "{}", report(text, "test.toml", &diagnostics, false));
    diagnostics[0].clone()
}

/// A file of just 1 MiB whose Lagrangian consists of one repeated piece.
fn filled(piece: impl Fn(usize) -> String) -> String {
    let mut law = String::new();
    for i in 0.. {
        let next = piece(i);
        if GOOD.len() + law.len() + next.len() > TEXT_LIMIT {
            break;
        }
        law.push_str(&next);
    }
    GOOD.replace("1/2*k*x^2", &law)
}

#[test]
fn a_file_beyond_the_limit_is_refused() {
    let text = format!("{GOOD}{}", "#".repeat(TEXT_LIMIT));
    assert!(only(&text).message.ends_with("a preset may have 1048576 (1 MiB)"));
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("long.toml");
    std::fs::write(&path, &text).unwrap();
    let document = Document::open(&path).unwrap();
    let diagnostics = document.read().unwrap_err();
    assert_eq!(diagnostics[0].message, only(&text).message);
    assert!(document.report(&diagnostics, false).contains("long.toml"));
}

#[test]
fn a_mebibyte_of_parentheses_is_refused() {
    let text = filled(|_| "(".to_owned());
    assert!(text.len() > TEXT_LIMIT - 20);
    assert_eq!(only(&text).message, "nested deeper than 256");
    assert!(report(&text, "test.toml", &[only(&text)], false).len() < 1000);
    for mark in ["[", "{a=", "a.", "\"", "[[", "\0", "\n", "'''"] {
        survive(mark.repeat(TEXT_LIMIT / mark.len()).as_bytes());
    }
}

#[test]
fn a_mebibyte_of_terms_is_read() {
    assert!(read(&filled(|_| "x+".to_owned()).replace("+\"", "\"")).is_ok());
    assert!(read(&filled(|i| format!("sin({i}*x)+")).replace("+\"", "\"")).is_ok());
    assert!(read(&filled(|i| format!("(x-{i})*")).replace("*\"", "\"")).is_ok());
}

#[test]
fn a_mebibyte_of_errors_is_reported_in_a_hundred() {
    let text = filled(|i| format!("y{i}+")).replace("+\"", "\"");
    let diagnostics = read(&text).unwrap_err();
    assert_eq!(diagnostics.len(), 100);
    let keys: String = (0..20_000).fold(String::new(), |mut keys, i| {
        let _ = writeln!(keys, "key{i} = 1");
        keys
    });
    let diagnostics = read(&(keys + GOOD)).unwrap_err();
    assert_eq!(diagnostics.len(), 101);
    assert_eq!(diagnostics[100].message, "19900 more errors are not listed");
}

#[test]
fn long_names_are_reported_shortened() {
    let text = GOOD.replace('k', &"k".repeat(100_000)).replace("x^2", "x^2*y");
    assert_eq!(only(&text).message, "unknown name `y`");
    let text = GOOD.replace("k*x", &"k".repeat(100_000));
    assert!(only(&text).message.len() < 500);
}

/// A file with a number of entries in a table.
fn many(head: &str, entry: impl Fn(usize) -> String, count: usize) -> String {
    let mut text = GOOD.replace(&format!("{head}\n"), &format!("{head}\n@"));
    let entries: String = (0..count).map(entry).collect();
    if !text.contains('@') {
        let _ = write!(text, "{head}\n@");
    }
    text.replace('@', &entries)
}

#[test]
fn each_count_has_its_limit() {
    let coordinates = |n| many("[coordinates]", |i| format!("q{i} = {{ initial = 0 }}\n"), n);
    assert!(read(&coordinates(63)).is_ok());
    assert_eq!(only(&coordinates(64)).message, "there are 65 coordinates; 64 are allowed");
    let parameters = |n| many("[parameters]", |i| format!("a{i} = 0\n"), n);
    assert!(read(&parameters(254)).is_ok());
    assert_eq!(only(&parameters(255)).message, "there are 257 parameters; 256 are allowed");
    let definitions = |n| many("[definitions]", |i| format!("d{i} = \"x\"\n"), n);
    assert!(read(&definitions(1024)).is_ok());
    assert_eq!(only(&definitions(1025)).message, "there are 1025 definitions; 1024 are allowed");
    let views = GOOD.to_owned() + &"[[views]]\nkind = \"space\"\n".repeat(65);
    assert_eq!(only(&views).message, "there are 65 views; 64 are allowed");
}

#[test]
fn paths_have_a_limit_together() {
    let shape = "{ path = [\"cos(s*x)\", 0], from = 0, to = 1, samples = 1000 },";
    let text = |n| format!("{GOOD}[space]\nshapes = [{}]\n", shape.repeat(n));
    assert!(read(&text(100)).is_ok());
    let message = only(&text(1000)).message;
    assert_eq!(message, "with this, the file's paths have more than a million nodes");
}

/// The stack of a program's first thread; a thread of a test has a quarter of it, which code that is not optimised fills.
const STACK: usize = 8 << 20;

#[test]
fn opened_definitions_have_a_depth_limit() {
    let thread = std::thread::Builder::new().stack_size(STACK);
    thread.spawn(open_deep_definitions).unwrap().join().unwrap();
}

/// Nested definitions may be as deep as the limit for a text, and no deeper.
fn open_deep_definitions() {
    let chain = |n: usize| {
        let tower = |i: usize| match i {
            0 => "d0 = \"x\"\n".to_owned(),
            i => format!("d{i} = \"sin(d{})\"\n", i - 1),
        };
        many("[definitions]", tower, n).replace("1/2*k*x^2", &format!("k*d{}", n - 1))
    };
    assert!(read(&chain(1000)).is_ok());
    let deeper = chain(1020).replace("sin(", "sin(1 + ");
    assert!(only(&deeper).message.contains("nested deeper than 1024"));
    let parentheses = |n: usize| {
        GOOD.replace("1/2*k*x^2", &format!("{}x{}", "sin(1 + 2*".repeat(n), ")".repeat(n)))
    };
    assert!(read(&parentheses(250)).is_ok());
}

/// Sums of sums of sums: the nodes are counted, and the file is refused once, before memory is full.
#[test]
fn expressions_may_not_outgrow_their_pool() {
    let tower = |i: usize| match i {
        0 => "d0 = \"x\"\n".to_owned(),
        i => format!("d{i} = \"d{} + {i}*x^{i}*sin({i}*x)\"\n", i - 1),
    };
    let text = many("[definitions]", tower, 1024);
    let shapes: String = (0..1024).fold(String::new(), |mut shapes, i| {
        let entry = |k: usize| format!("\"d1023 + {k}.{i}\"");
        let point =
            |k: usize| format!("[{}, {}, {}]", entry(3 * k), entry(3 * k + 1), entry(3 * k + 2));
        let _ = write!(shapes, "{{ line = {}, to = {} }},", point(1), point(2));
        shapes
    });
    let text = format!("{text}[space]\nshapes = [{shapes}]\n");
    let message = "with this, the file's expressions grow beyond a million nodes";
    assert_eq!(only(&text).message, message);
}

/// A proof that constraints are linear traverses them once for each velocity.
#[test]
fn constraints_have_a_limit_together() {
    let mut text = "title = \"long\"\n[coordinates]\n".to_owned();
    for i in 0..64 {
        writeln!(text, "x{i} = {{ initial = 1 }}").unwrap();
    }
    let long: Vec<String> =
        (0..40_000).map(|i| format!("sin(x{}+{i})*x{}'", i % 64, i % 64)).collect();
    writeln!(text, "[definitions]\nD = \"{}\"\n[lagrangian]\nL = \"x0'^2\"", long.join("+"))
        .unwrap();
    for i in 0..128 {
        writeln!(text, "[[constraints]]\nname = \"c{i}\"\nexpression = \"D + {i}\"").unwrap();
    }
    let diagnostics = read(&text).unwrap_err();
    assert_eq!(diagnostics.len(), 1);
    assert_eq!(
        diagnostics[0].message,
        "with this, the constraints of the file are too long to be proved linear in the velocities"
    );
}
