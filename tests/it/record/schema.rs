//! The published asciicast formats, versions 2 and 3, compared with what the program writes. The check is stricter than
//! players: anything that the specifications do not name is refused.
//!
//! <https://docs.asciinema.org/manual/asciicast/v2/>, <https://docs.asciinema.org/manual/asciicast/v3/>.

use phaselab::record::cast_writer::Version;
use serde_json::{Map, Value};

/// A key of an object, whether it is required, and the test of its value.
type Rule = (&'static str, bool, fn(&Value) -> bool);

/// Header of version 2: the key, whether it is required, the test of its value.
const HEAD_TWO: &[Rule] = &[
    ("version", true, |v| v.as_u64() == Some(2)),
    ("width", true, is_side),
    ("height", true, is_side),
    ("timestamp", false, Value::is_u64),
    ("duration", false, is_time),
    ("idle_time_limit", false, is_time),
    ("command", false, Value::is_string),
    ("title", false, Value::is_string),
    ("env", false, is_env),
    ("theme", false, |v| holds(v, THEME)),
];

const HEAD_THREE: &[Rule] = &[
    ("version", true, |v| v.as_u64() == Some(3)),
    ("term", true, |v| holds(v, TERM)),
    ("timestamp", false, Value::is_u64),
    ("idle_time_limit", false, is_time),
    ("command", false, Value::is_string),
    ("title", false, Value::is_string),
    ("env", false, is_env),
    ("tags", false, |v| v.as_array().is_some_and(|tags| tags.iter().all(Value::is_string))),
];

const TERM: &[Rule] = &[
    ("cols", true, is_side),
    ("rows", true, is_side),
    ("type", false, Value::is_string),
    ("version", false, Value::is_string),
    ("theme", false, |v| holds(v, THEME)),
];

const THEME: &[Rule] =
    &[("fg", true, is_colour), ("bg", true, is_colour), ("palette", true, is_palette)];

fn is_side(value: &Value) -> bool {
    value.as_u64().is_some_and(|side| (1..=65_535).contains(&side))
}

fn is_time(value: &Value) -> bool {
    value.as_f64().is_some_and(|time| time >= 0.0 && time.is_finite())
}

fn is_env(value: &Value) -> bool {
    value.as_object().is_some_and(|env| env.values().all(Value::is_string))
}

fn is_hex(text: &str) -> bool {
    let digits = text.strip_prefix('#').unwrap_or_default();
    digits.len() == 6 && digits.chars().all(|c| c.is_ascii_hexdigit())
}

fn is_colour(value: &Value) -> bool {
    value.as_str().is_some_and(is_hex)
}

/// Whether the value is eight or sixteen colours separated by colons.
fn is_palette(value: &Value) -> bool {
    value.as_str().is_some_and(|text| {
        matches!(text.split(':').count(), 8 | 16) && text.split(':').all(is_hex)
    })
}

fn wrong_key(object: &Map<String, Value>, rules: &[Rule]) -> Option<String> {
    let known = |key: &String| rules.iter().find(|(name, ..)| name == key);
    let wrong = object.iter().find(|(key, value)| !known(key).is_some_and(|(.., ok)| ok(value)));
    let missing = rules.iter().find(|(name, needed, _)| *needed && !object.contains_key(*name));
    wrong.map(|(key, _)| key.clone()).or_else(|| missing.map(|(name, ..)| (*name).to_owned()))
}

fn holds(value: &Value, rules: &[Rule]) -> bool {
    value.as_object().is_some_and(|object| wrong_key(object, rules).is_none())
}

/// The first line of a cast that violates its format, and the violation.
pub(super) fn error(text: &str, version: Version) -> Option<String> {
    if !text.ends_with('\n') || text.contains('\r') {
        return Some("lines end in a line feed".to_owned());
    }
    let mut lines = text.lines();
    let head: Value = match serde_json::from_str(lines.next().unwrap_or_default()) {
        Ok(head) => head,
        Err(why) => return Some(format!("the head is no JSON: {why}")),
    };
    let (rules, codes) = match version {
        Version::Two => (HEAD_TWO, "oimr"),
        Version::Three => (HEAD_THREE, "oimrx"),
    };
    let Some(head) = head.as_object() else { return Some("the head is no object".to_owned()) };
    if let Some(key) = wrong_key(head, rules) {
        return Some(format!("head: {key}"));
    }
    let mut last = 0.0;
    let mut over = false;
    for line in lines {
        if version == Version::Three && line.starts_with('#') {
            continue;
        }
        let wrong = |what: &str| Some(format!("{what}: {line}"));
        let Ok((time, code, data)) = serde_json::from_str::<(Value, String, String)>(line) else {
            return wrong("an event is a time, a code and a text");
        };
        if over {
            return wrong("after the end");
        }
        if !is_time(&time) || version == Version::Two && time.as_f64() < Some(last) {
            return wrong("time");
        }
        last = time.as_f64().unwrap_or(last);
        if code.chars().count() != 1 || !codes.contains(&code) {
            return wrong("code");
        }
        let right = match code.as_str() {
            "r" => {
                let sides = data.split_once('x').map(|(w, h)| [w, h].map(str::parse::<u16>));
                sides.is_some_and(|sides| sides.iter().all(|side| matches!(side, Ok(1..))))
            }
            "x" => {
                over = true;
                data.parse::<i32>().is_ok()
            }
            _ => true,
        };
        if !right {
            return wrong("data");
        }
    }
    None
}

#[test]
fn the_checker_takes_the_examples_of_the_format_and_refuses_what_is_not() {
    use Version::{Three, Two};
    let palette = ["#101010"; 16].join(":");
    let two = format!(
        "{{\"version\":2,\"width\":80,\"height\":24,\"timestamp\":1504467315,\"duration\":1.5,\"title\":\"x\",\
         \"env\":{{\"TERM\":\"xterm\"}},\"theme\":{{\"fg\":\"#d0d0d0\",\"bg\":\"#212121\",\"palette\":\"{palette}\"}}}}\n\
         [0.248848, \"o\", \"a\"]\n[1.5, \"m\", \"\"]\n[1.5, \"r\", \"80x24\"]\n[2.0, \"i\", \"b\"]\n"
    );
    let three = format!(
        "{{\"version\":3,\"term\":{{\"cols\":80,\"rows\":24,\"type\":\"xterm\",\"theme\":{{\"fg\":\"#d0d0d0\",\
         \"bg\":\"#212121\",\"palette\":\"{palette}\"}}}},\"tags\":[\"a\"]}}\n# words\n[0.5, \"o\", \"a\"]\n\
         [0.1, \"r\", \"90x30\"]\n[3, \"m\", \"x\"]\n[0.8, \"x\", \"0\"]\n"
    );
    assert_eq!((error(&two, Two), error(&three, Three)), (None, None));
    let refused = |text: &str, version, from: &str, to: &str| {
        assert!(text.contains(from), "{from}");
        assert!(error(&text.replace(from, to), version).is_some(), "{from} → {to}");
    };
    for (from, to) in [
        ("\"width\":80", "\"width\":0"),
        ("\"width\":80", "\"width\":\"80\""),
        ("\"height\":24,", ""),
        ("\"version\":2", "\"version\":3"),
        ("\"title\"", "\"titel\""),
        ("\"xterm\"", "7"),
        ("#d0d0d0", "#d0d0"),
        (":#101010\"", "\""),
        ("[1.5, \"r\"", "[1.4, \"r\""),
        ("0.248848", "-0.2"),
        ("80x24", "80*24"),
        ("80x24", "80x0"),
        ("\"i\"", "\"x\""),
        ("\"b\"]\n", "\"b\"]"),
        ("\"a\"]", "\"a\", 1]"),
    ] {
        refused(&two, Two, from, to);
    }
    for (from, to) in [
        ("\"cols\":80,", ""),
        ("\"rows\":24", "\"rows\":24.5"),
        ("\"term\"", "\"terminal\""),
        ("\"type\"", "\"types\""),
        ("[0.1, ", "[-0.1, "),
        ("\"m\"", "\"mm\""),
        ("\"0\"]\n", "\"zero\"]\n"),
        ("\"0\"]\n", "\"0\"]\n[1.0, \"o\", \"\"]\n"),
        ("[\"a\"]", "\"a\""),
    ] {
        refused(&three, Three, from, to);
    }
}
