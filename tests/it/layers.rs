//! The layers of the source: the uses between rooms in every file of `src`, compared with the table in
//! `ARCHITECTURE.md`.

use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::path::{Path, PathBuf};

use crate::nonempty;

/// The rooms that each room may use.
type Table = BTreeMap<String, BTreeSet<String>>;

/// The table of `ARCHITECTURE.md`: in its order each room, and those above it that it may use.
fn table() -> Table {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("ARCHITECTURE.md");
    let mut table = Table::new();
    for line in fs::read_to_string(path).expect("ARCHITECTURE.md").lines() {
        let mut cells = line.split('|').map(str::trim).skip(1);
        let (Some(room), Some(uses)) = (cells.next(), cells.next()) else { continue };
        let Some(room) = room.strip_prefix('`').and_then(|r| r.strip_suffix('`')) else { continue };
        let uses = uses.split(',').map(str::trim).filter(|word| *word != "–");
        let allowed: BTreeSet<String> = uses.map(str::to_owned).collect();
        assert!(
            allowed.iter().all(|used| table.contains_key(used)),
            "the row of `{room}`: {allowed:?}"
        );
        table.insert(room.to_owned(), allowed);
    }
    assert!(table.len() >= 15, "{table:?}");
    table
}

/// External items that only some rooms may use: the item, its names in code, the rooms.
const OUTSIDE: [(&str, &[&str], &[&str]); 6] = [
    ("the clock", &["Instant", "SystemTime"], &["worker", "shell", "cli"]),
    ("threads", &["thread::", "mpsc"], &["worker", "shell", "cli"]),
    ("a pool of threads", &["rayon::"], &["ensemble"]),
    ("executable memory", &["rustix::mm"], &["system"]),
    ("files", &["std::fs", "fs::", "File::"], &["file", "preset", "shell", "cli"]),
    (
        "the terminal",
        &[
            "rustix::{",
            "rustix::event",
            "rustix::fs",
            "rustix::io",
            "rustix::process",
            "rustix::stdio",
            "rustix::termios",
            "signal_hook::",
            "stdin(",
            "stdout(",
            "stderr(",
            "IsTerminal",
        ],
        &["file", "shell", "cli"],
    ),
];

/// The rooms that use crossterm's types for keys and the mouse.
const SPEAK_OF_KEYS: [&str; 4] = ["app", "view", "record", "shell"];

/// Those types; everything else of crossterm operates on a terminal.
const OF_KEYS: [&str; 9] = [
    "Event",
    "KeyCode",
    "KeyEvent",
    "KeyEventKind",
    "KeyEventState",
    "KeyModifiers",
    "MouseButton",
    "MouseEvent",
    "MouseEventKind",
];

/// The files that write crossterm's commands into memory only.
const WRITE_FRAMES: [&str; 2] = ["view/frame/encoder.rs", "view/frame/pen.rs"];

/// A source file and its room.
struct File {
    path: PathBuf,
    room: String,
    /// The number of `super` that leads out of the room.
    depth: usize,
    /// Its code, without comments.
    code: String,
}

fn files() -> Vec<File> {
    let source = Path::new(env!("CARGO_MANIFEST_DIR")).join("src");
    let mut files = Vec::new();
    let mut folders = vec![source.clone()];
    while let Some(folder) = folders.pop() {
        for entry in fs::read_dir(folder).expect("a folder of src") {
            let path = entry.expect("an entry").path();
            if path.is_dir() {
                folders.push(path);
            } else if path.extension().is_some_and(|extension| extension == "rs") {
                let inside = path.strip_prefix(&source).expect("inside").with_extension("");
                let mut parts = inside.iter().map(|part| part.to_string_lossy().into_owned());
                let room = parts.next().expect("a name");
                let code = fs::read_to_string(&path).expect("a source file");
                let code =
                    code.lines().map(|line| line.split("//").next().unwrap_or("").to_owned());
                let code = code.collect::<Vec<_>>().join("\n");
                files.push(File { depth: parts.count() + 1, path, room, code });
            }
        }
    }
    files
}

/// The rooms named in code: after `crate::`, inside `crate::{…}`, and after more `super::` than the room is deep.
fn rooms_named(code: &str, depth: usize) -> Vec<String> {
    let mut named = Vec::new();
    let way_out = "super::".repeat(depth);
    for start in ["crate::", "phaselab::", way_out.as_str()] {
        for (at, _) in code.match_indices(start) {
            let before = code[..at].chars().next_back();
            if before.is_some_and(|c| c.is_alphanumeric() || c == '_' || c == ':' || c == '$') {
                continue;
            }
            let rest = &code[at + start.len()..];
            match rest.strip_prefix('{') {
                Some(list) => named.extend(heads(list)),
                None => named.extend(word(rest)),
            }
        }
    }
    named
}

/// The first path segments of the items of a `use` list, up to its closing brace.
fn heads(list: &str) -> Vec<String> {
    let mut heads = Vec::new();
    let (mut depth, mut start) = (0, true);
    for (at, character) in list.char_indices() {
        match character {
            '{' => depth += 1,
            '}' if depth == 0 => break,
            '}' => depth -= 1,
            ',' if depth == 0 => start = true,
            c if start && !c.is_whitespace() => {
                heads.extend(word(&list[at..]));
                start = false;
            }
            _ => {}
        }
    }
    heads
}

fn word(text: &str) -> Option<String> {
    let word: String = text.chars().take_while(|c| c.is_alphanumeric() || *c == '_').collect();
    (!word.is_empty()).then_some(word)
}

/// The violation in a use of one room by another.
fn violation(table: &Table, from: &str, to: &str) -> Option<String> {
    let allowed = table.get(from)?;
    if from == to || !table.contains_key(to) || allowed.contains(to) {
        return None;
    }
    Some(format!("{from} uses {to}, which the table of ARCHITECTURE.md does not allow"))
}

#[test]
fn every_room_uses_only_what_it_may() {
    let table = table();
    let mut wrong = Vec::new();
    for file in &files() {
        for named in rooms_named(&file.code, file.depth) {
            wrong.extend(violation(&table, &file.room, &named).map(|why| (file.path.clone(), why)));
        }
    }
    assert!(wrong.is_empty(), "{wrong:#?}");
}

#[test]
fn no_row_allows_what_its_room_does_not_use() {
    let (table, files) = (table(), files());
    let named = |room: &str| -> BTreeSet<String> {
        let mine = files.iter().filter(|file| file.room == room);
        mine.flat_map(|file| rooms_named(&file.code, file.depth)).collect()
    };
    let idle = |(room, allowed): (&String, &BTreeSet<String>)| {
        let idle: Vec<String> = allowed.difference(&named(room)).cloned().collect();
        (!idle.is_empty()).then(|| format!("{room} does not use {idle:?}"))
    };
    let wrong: Vec<String> = table.iter().filter_map(idle).collect();
    assert!(wrong.is_empty(), "{wrong:#?}");
}

#[test]
fn the_table_is_read_as_it_is_meant() {
    let table = table();
    let is_violation = |from: &str, to: &str| violation(&table, from, to).is_some();
    for (from, to) in [
        ("mechanics", "preset"),
        ("preset", "mechanics"),
        ("system", "preset"),
        ("integrate", "preset"),
        ("expr", "model"),
        ("worker", "app"),
        ("view", "worker"),
        ("record", "worker"),
        ("app", "view"),
        ("shell", "cli"),
        ("cli", "worker"),
    ] {
        assert!(is_violation(from, to), "{from} → {to}");
    }
    for (from, to) in [
        ("mechanics", "model"),
        ("system", "cancel"),
        ("experiment", "preset"),
        ("view", "expr"),
        ("shell", "worker"),
        ("cli", "shell"),
        ("app", "App"),
    ] {
        assert!(!is_violation(from, to), "{from} → {to}");
    }
}

#[test]
fn the_world_outside_stays_where_it_is_let_in() {
    let (files, mut wrong) = (files(), Vec::new());
    for file in files.iter().filter(|file| !["lib", "main"].contains(&file.room.as_str())) {
        for (what, words, rooms) in OUTSIDE.iter().filter(|o| !o.2.contains(&file.room.as_str())) {
            let found = words.iter().filter(|word| file.code.contains(**word));
            wrong.extend(found.map(|word| (&file.path, what, word, rooms)));
        }
    }
    assert!(wrong.is_empty(), "{wrong:#?}");
}

/// The uses of crossterm other than the types for keys and the mouse.
fn beyond_keys(code: &str) -> Vec<String> {
    let mut found = Vec::new();
    for (at, _) in code.match_indices("crossterm::") {
        let own = code[..at].chars().next_back().is_none_or(|c| !c.is_alphanumeric() && c != ':');
        if !own {
            // for example tui-input's event handler
            continue;
        }
        let rest = &code[at + "crossterm::".len()..];
        let Some(items) = rest.strip_prefix("event::") else {
            found.extend(word(rest).or(Some("{".to_owned())));
            continue;
        };
        let named = match items.strip_prefix('{') {
            Some(list) => heads(list),
            None => word(items).into_iter().collect(),
        };
        found.extend(named.into_iter().filter(|name| !OF_KEYS.contains(&name.as_str())));
    }
    if code.contains("CrosstermBackend") {
        found.push("CrosstermBackend".to_owned());
    }
    found
}

#[test]
fn crossterm_is_a_vocabulary_outside_the_shell() {
    let mut wrong = Vec::new();
    for file in files().iter().filter(|file| file.room != "shell") {
        let path = file.path.to_string_lossy().replace('\\', "/");
        let beyond = beyond_keys(&file.code);
        if WRITE_FRAMES.iter().any(|own| path.ends_with(own)) {
            let outward = ["execute!", "raw_mode", "read(", "poll("];
            wrong.extend(
                outward
                    .iter()
                    .filter(|w| file.code.contains(**w))
                    .map(|w| (path.clone(), (*w).to_owned())),
            );
        } else {
            wrong.extend(beyond.into_iter().map(|word| (path.clone(), word)));
        }
        if file.code.contains("crossterm::") && !SPEAK_OF_KEYS.contains(&file.room.as_str()) {
            wrong.push((path, "crossterm".to_owned()));
        }
    }
    assert!(wrong.is_empty(), "{wrong:#?}");
    let seen = |code: &str| beyond_keys(code);
    assert!(
        seen("use crossterm::event::{Event, KeyCode};\nlet x = backend::crossterm::Y;").is_empty()
    );
    assert_eq!(seen("use crossterm::event::{Event, read, poll};"), ["read", "poll"]);
    assert_eq!(seen("crossterm::terminal::enable_raw_mode()"), ["terminal"]);
    assert_eq!(seen("use crossterm::{event, execute};"), ["{"]);
}

#[test]
fn every_room_stands_in_the_table() {
    let table = table();
    for file in files() {
        let known = table.contains_key(&file.room) || ["lib", "main"].contains(&file.room.as_str());
        assert!(known, "{} belongs to no room of the table", file.path.display());
    }
}

#[test]
fn the_reader_of_uses_sees_them() {
    let check = |code: &str, depth: usize, expected: &[&str]| {
        assert_eq!(rooms_named(code, depth), expected, "{code}");
    };
    check("use crate::worker::Worker;", 1, &["worker"]);
    check("use crate::{app::{App, Key}, view, shell::run};", 1, &["app", "view", "shell"]);
    check("let x = crate::cli::main();", 2, &["cli"]);
    check("use super::view::Look;", 1, &["view"]);
    check("use super::theme::Theme;\nuse super::super::app::App;", 2, &["app"]);
}

/// The elementary functions of `f64` that `std` leaves to the platform: `num::math` has its own.
const ELEMENTARY: [&str; 26] = [
    "sin", "cos", "sin_cos", "tan", "asin", "acos", "atan", "atan2", "sinh", "cosh", "tanh",
    "asinh", "acosh", "atanh", "exp", "exp2", "exp_m1", "ln", "ln_1p", "log", "log10", "log2",
    "powf", "powi", "cbrt", "hypot",
];

/// Files whose methods of these names belong to other numbers than `f64`: code generic over `Real`, double-doubles, exact
/// numbers. Only `clippy.toml` can check them.
const OTHER_NUMBERS: [&str; 8] = [
    "expr/ball/",
    "expr/ball.rs",
    "expr/function/",
    "num/double_double/",
    "num/number.rs",
    "expr/product.rs",
    "num/math.rs",
    "num/extended_range.rs",
];

/// The calls of `std`'s elementary functions in code, as `name`: methods, except those of the expression pool, and paths.
fn elementary_calls(code: &str) -> Vec<&'static str> {
    let mut found = Vec::new();
    for name in ELEMENTARY {
        let methods = code.match_indices(&format!(".{name}(")).any(|(at, _)| {
            let receiver = code[..at].rsplit(|c: char| !(c.is_alphanumeric() || c == '_')).next();
            !receiver.is_some_and(|word| word.ends_with("pool") || word == "self")
        });
        if methods
            || code.contains(&format!("f64::{name}("))
            || code.contains(&format!("f64::{name})"))
        {
            found.push(name);
        }
    }
    found
}

#[test]
fn no_elementary_function_is_left_to_the_platform() {
    let misplaced = |file: &File| {
        let path = file.path.to_string_lossy().replace('\\', "/");
        let other = OTHER_NUMBERS.iter().any(|place| path.contains(place));
        let calls = if other { Vec::new() } else { elementary_calls(&file.code) };
        (!calls.is_empty()).then(|| format!("{path}: {calls:?}: use num::math"))
    };
    let wrong: Vec<String> = files().iter().filter_map(misplaced).collect();
    assert!(wrong.is_empty(), "{wrong:#?}");
    assert_eq!(elementary_calls("let y = 2.0 * x.powi(3) + pool.powi(a, 2);"), ["powi"]);
    assert_eq!(elementary_calls("values.map(f64::sin).map(|x| (x + 1.0).ln())"), ["sin", "ln"]);
}

#[test]
fn clippy_refuses_the_same_functions_by_type() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let text = fs::read_to_string(root.join("clippy.toml")).expect("clippy.toml");
    let table: toml::Table = text.parse().expect("TOML");
    let rows = table["disallowed-methods"].as_array().expect("a list");
    let listed: Vec<&str> = rows.iter().filter_map(|row| row["path"].as_str()).collect();
    assert_eq!(listed, ELEMENTARY.map(|name| format!("f64::{name}")));
    let library = fs::read_to_string(root.join("src/lib.rs")).expect("src/lib.rs");
    assert!(library.contains("#![warn(clippy::disallowed_methods)]"));
}

#[test]
fn heads_say_what_a_file_is_and_those_of_rooms_what_goes_in_and_out() {
    for file in nonempty(files()) {
        let text = fs::read_to_string(&file.path).expect("a source file");
        let head = text.lines().map_while(|line| line.strip_prefix("//!"));
        let head = head.collect::<Vec<_>>().join("");
        let is_facade = file.depth == 1 && !["lib", "main"].contains(&file.room.as_str());
        let passes = head.contains("In and out:") || head.contains("In:") && head.contains("Out:");
        let says_all = passes && head.contains("Never here");
        assert!(!head.is_empty() && (says_all || !is_facade), "{}", file.path.display());
    }
}
