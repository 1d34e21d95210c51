//! Untrusted files, names and arguments: no command ever writes a character that controls a terminal.

use std::ffi::{OsStr, OsString};
use std::fs;
use std::os::unix::ffi::OsStrExt;
use std::path::Path;
use std::process::{Command, Output};

use phaselab::printable::is_steering;

use super::{PENDULUM, program, with_file};

/// One of each kind: setting a title, writing the clipboard, C1's CSI and DCS, DEL, an override and an isolate, a
/// character without width, a line separator, the byte order mark, a tag.
const STEERING: &str = "\u{1b}]0;x\u{7}\u{1b}]52;c;eA\u{7}\u{9b}2J\u{90}q\u{9c}\u{7f}\u{8}\u{202e}\u{2066}\u{200b}\u{200d}\u{2028}\
                        \u{feff}\u{e0041}";

fn command(home: &Path) -> Command {
    let mut command = Command::new(assert_cmd::cargo::cargo_bin("phaselab"));
    command.env_clear().env("HOME", home).env("LANG", "C.UTF-8").current_dir(home);
    command
}

/// Runs a command and asserts that its output contains no control characters and that it exits with one of these codes.
#[track_caller]
fn harmless(home: &Path, arguments: &[&OsStr], codes: &[i32]) -> Output {
    let output = command(home).args(arguments).output().unwrap();
    let code = output.status.code().expect("it ends by itself");
    for bytes in [&output.stdout, &output.stderr] {
        let text = std::str::from_utf8(bytes).expect("UTF-8");
        let steers = |c: char| is_steering(c) && !matches!(c, '\n' | '\t');
        assert_eq!(text.chars().find(|&c| steers(c)), None, "{arguments:?}: {text:?}");
    }
    assert!(
        codes.contains(&code),
        "{arguments:?}: {code}, {}",
        String::from_utf8_lossy(&output.stderr)
    );
    output
}

fn words<'w>(words: &'w [&'w str]) -> Vec<&'w OsStr> {
    words.iter().map(OsStr::new).collect()
}

/// Escapes a text for TOML.
fn escaped(text: &str) -> String {
    text.chars().fold(String::new(), |text, c| text + &format!("\\U{:08x}", c as u32))
}

/// Files in which the text appears in each possible place in turn.
fn files(hostile: &str) -> Vec<String> {
    let place = |old: &str, new: &str| {
        assert!(FULL.contains(old), "{old}");
        FULL.replacen(old, &new.replace('@', hostile), 1)
    };
    vec![
        place("title = \"full\"", "title = \"a@b\""),
        place("summary = \"s\"", "summary = \"a@b\""),
        place("notes = \"n\"", "notes = \"a@b\""),
        place("topics = [\"t\"]", "topics = [\"a@b\"]"),
        place("source = \"s\"", "source = \"a@b\""),
        place("symbol = \"θ\"", "symbol = \"a@b\""),
        place("unit = \"rad\"", "unit = \"a@b\""),
        place("about = \"mass\"", "about = \"a@b\""),
        place("m = {", "\"a@b\" = {"),
        place("name = \"twice\"", "name = \"a@b\""),
        place("[[events]]\nname = \"top\"", "[[events]]\nname = \"a@b\""),
        place("1/2*m*theta'^2 +", "1/2*m*theta'^2 + \\\"@\\\" +"),
        place("= \"2*theta\"", "= \"2*@theta\""),
        place("method = \"auto\"", "method = \"a@b\""),
        place("[run]", "[\"a@b\"]\nx = 1\n[run]"),
        place("initial = 0.5", "initial = \"0.5@\""),
    ]
}

const FULL: &str = r#"
title = "full"
summary = "s"
notes = "n"
topics = ["t"]
source = "s"

[coordinates]
theta = { initial = 0.5, symbol = "θ", unit = "rad" }

[parameters]
m = { value = 2.0, about = "mass" }

[lagrangian]
L = "1/2*m*theta'^2 + m*cos(theta)"

[[observables]]
name = "twice"
expression = "2*theta"

[[events]]
name = "top"
when = "theta"

[run]
method = "auto"
"#;

#[test]
fn the_file_to_begin_with_is_right() {
    with_file(FULL, &["check", "system.toml"]).success();
}

#[test]
fn no_text_of_a_file_steers_the_terminal() {
    let home = tempfile::tempdir().unwrap();
    let raw: String = STEERING.chars().filter(|&c| c > '\u{7f}').collect();
    for hostile in [escaped(STEERING), raw] {
        for text in files(&hostile) {
            fs::write(home.path().join("system.toml"), &text).unwrap();
            for arguments in [
                &["check", "system.toml"][..],
                &["check", "--format", "json", "system.toml"],
                &["run", "system.toml", "--format", "json", "--at", "0"],
            ] {
                let output = harmless(home.path(), &words(arguments), &[65]);
                if arguments.contains(&"check") && arguments.contains(&"json") {
                    let read: serde_json::Value = serde_json::from_slice(&output.stdout).unwrap();
                    assert!(!read["files"][0]["mistakes"].as_array().unwrap().is_empty());
                }
            }
        }
    }
}

/// The content of a comment does not matter until its line is shown because of another error.
#[test]
fn a_comment_beside_an_error_is_written_out_and_the_caret_stands_under_its_place() {
    let home = tempfile::tempdir().unwrap();
    let (before, after) = ("\u{9b}\u{202e}", "\u{9b}31m\u{200b}");
    let text = PENDULUM.replace(
        "theta = { initial = 0.0,",
        &format!("theta = {{ initial = \"0.0 + '{before}' + nonsense\" }} # {after}\nphi = {{"),
    );
    fs::write(home.path().join("system.toml"), text).unwrap();
    let output = harmless(home.path(), &words(&["check", "system.toml"]), &[65]);
    let reported = String::from_utf8(output.stderr).unwrap();
    assert!(
        reported.contains("\\u{9b}\\u{202e}") && reported.contains("# \\u{9b}31m\\u{200b}"),
        "{reported}"
    );

    let text =
        PENDULUM.replace("title = ", &format!("notes = 'x' # {before}\ntitle = 3 # {after}\n#"));
    fs::write(home.path().join("system.toml"), text).unwrap();
    let output = harmless(home.path(), &words(&["check", "system.toml"]), &[65]);
    let reported = String::from_utf8(output.stderr).unwrap();
    let lines: Vec<&str> = reported.lines().collect();
    let shown = lines.iter().position(|line| line.contains("title = 3")).unwrap();
    let column = |line: &str, part: &str| line.find(part).unwrap();
    assert_eq!(column(lines[shown], "3 #"), column(lines[shown + 1], "^"), "{reported}");
}

#[test]
fn the_caret_and_the_column_are_right_behind_what_is_written_out() {
    let home = tempfile::tempdir().unwrap();
    let text = PENDULUM.replace("m = 2.0", "'\u{9b}' = 1\nm = 2.0").replace(
        "L = \"1/2*m",
        "'a\u{9b}\u{202e}b' = 1\nforces = { 'c\u{9b}' = 1, theta = \"nonsense\" }\nL = \"1/2*m",
    );
    fs::write(home.path().join("system.toml"), text).unwrap();
    let output = harmless(home.path(), &words(&["check", "system.toml"]), &[65]);
    let reported = String::from_utf8(output.stderr).unwrap();
    let shown = reported.lines().position(|line| line.contains("\"nonsense\"")).expect("the line");
    let lines: Vec<&str> = reported.lines().collect();
    let place = lines.iter().rposition(|line| line.contains("`nonsense`")).expect("the error");
    let line = lines[place..].iter().position(|l| l.contains("\"nonsense\"")).unwrap() + place;
    assert!(shown <= line);
    let caret = lines[line + 1].find('^').unwrap();
    assert_eq!(lines[line].find("nonsense").unwrap(), caret, "{reported}");
    // the column is that of the file
    let column = "forces = { 'c\u{9b}' = 1, theta = \"".chars().count() + 1;
    assert!(lines[place + 1].ends_with(&format!(":{column}")), "{reported}");
}

#[test]
fn no_name_of_a_file_steers_the_terminal() {
    let home = tempfile::tempdir().unwrap();
    let mut name = OsString::from(format!("a{STEERING}\n\r").replace('/', ""));
    name.push(OsStr::from_bytes(b"\xff\xfe.toml"));
    let call = |before: &[&str], name: &OsStr, codes: &[i32]| {
        let mut arguments = words(before);
        arguments.push(name);
        harmless(home.path(), &arguments, codes)
    };
    let commands: [&[&str]; 7] = [
        &["check"],
        &["check", "--format", "json"],
        &["derive"],
        &["run"],
        &["play"],
        &["script", "check"],
        &["config", "check"],
    ];
    // the file is missing, or a folder, or wrong, or correct
    for before in commands {
        call(before, &name, &[2]);
    }
    fs::write(home.path().join(&name), "title = nonsense\n").unwrap();
    for before in commands {
        call(before, &name, &[65]);
    }
    fs::write(home.path().join(&name), PENDULUM).unwrap();
    for before in [&["check"][..], &["derive"], &["run", "--at", "0"]] {
        call(before, &name, &[0]);
    }
    call(&["run", "system.toml", "--at", "0", "-o"], &name, &[2]);
    fs::write(home.path().join("system.toml"), PENDULUM).unwrap();
    let reported = call(&["run", "system.toml", "--at", "0", "-o"], &name, &[2]);
    assert!(String::from_utf8_lossy(&reported.stderr).contains("describes a system"));
    fs::write(home.path().join(&name), "rows\n").unwrap();
    let reported = call(&["run", "system.toml", "--at", "0", "-o"], &name, &[0]);
    assert!(
        String::from_utf8_lossy(&reported.stderr).ends_with("\\n\\r\\xff\\xfe.toml is replaced\n")
    );
    let mut folder = name.clone();
    folder.push("/x.csv");
    call(&["run", "system.toml", "--at", "0", "-o"], &folder, &[74]);
    folder.push(".demo");
    call(&["record", "pendulum", "--script"], &folder, &[2]);
    call(&["record", "pendulum", "--still"], &folder, &[2]);
}

#[test]
fn no_argument_steers_the_terminal() {
    let home = tempfile::tempdir().unwrap();
    let hostile = format!("{STEERING}\n");
    let value = format!("m={hostile}");
    let other = format!("{hostile}=1");
    let format = format!("--format={hostile}");
    for arguments in [
        &["run", "pendulum", "--set", &value][..],
        &["run", "pendulum", "--set", &other],
        &["run", "pendulum", "--set", &hostile],
        &["run", "pendulum", "--init", &other],
        &["run", "pendulum", "--observe", &hostile],
        &["run", "pendulum", "--method", &hostile],
        &["run", "pendulum", "--until", &hostile],
        &["run", "pendulum", &format],
        &["run", &hostile],
        &["bracket", "pendulum", &hostile, "energy"],
        &[&hostile],
        &[&hostile, "pendulum"],
        &["pendulum", &hostile],
        &["man", &hostile],
        &["completions", &hostile],
        &["theme", &hostile],
        &["record", &hostile],
        &["play", &hostile],
        &["--fps", &hostile],
        &["--log", &hostile, &hostile],
    ] {
        harmless(home.path(), &words(arguments), &[2]);
    }
    // a column may have any name
    let named = format!("{hostile}=2*theta");
    for format in ["csv", "json", "jsonl"] {
        let arguments = ["run", "pendulum", "--at", "0", "--format", format, "--observe", &named];
        let output = harmless(home.path(), &words(&arguments), &[0]);
        if format == "json" {
            let read: serde_json::Value = serde_json::from_slice(&output.stdout).unwrap();
            assert_eq!(read["columns"].as_array().unwrap().last().unwrap(), hostile.trim());
        }
    }
}

#[test]
fn no_preset_or_folder_of_ones_own_steers_the_terminal() {
    let home = tempfile::tempdir().unwrap();
    let presets = home.path().join(".config/phaselab/presets");
    let folder = presets.join(format!("a{STEERING}\nb").replace('/', ""));
    fs::create_dir_all(&folder).unwrap();
    let text = PENDULUM.replace("A pendulum", &format!("A {}", escaped(STEERING)));
    fs::write(folder.join(format!("x{STEERING}\ny.toml").replace('/', "")), text).unwrap();
    fs::write(folder.join(format!("z{STEERING}\ny.toml").replace('/', "")), PENDULUM).unwrap();
    for arguments in [
        &["list"][..],
        &["list", "--format", "names"],
        &["list", "--format", "json"],
        &["derive", "zy"],
    ] {
        let output = harmless(home.path(), &words(arguments), &[0, 2]);
        let lines = String::from_utf8(output.stdout).unwrap();
        assert!(!lines.lines().any(|line| line.trim_end() == "y"), "{lines}");
        if arguments.contains(&"json") {
            serde_json::from_str::<serde_json::Value>(&lines).unwrap();
        }
    }
}

#[test]
fn no_cast_script_or_configuration_steers_the_terminal() {
    let home = tempfile::tempdir().unwrap();
    let write = |name: &str, text: &str| fs::write(home.path().join(name), text).unwrap();
    let in_json: String =
        STEERING.encode_utf16().fold(String::new(), |text, unit| text + &format!("\\u{unit:04x}"));
    let raw: String = STEERING.chars().filter(|&c| c > '\u{7f}').collect();
    let head = "{\"version\":2,\"width\":80,\"height\":24}\n";
    for cast in [
        format!("{head}[0,\"r\",\"{in_json}\"]"),
        format!("{head}[0,\"r\",\"{raw}\"]"),
        format!("{head}[0,{{\"{raw}\":1}}]"),
        format!("{head}{STEERING}"),
        format!("{{\"version\":\"{in_json}\"}}"),
        format!("{{\"version\":2,\"{raw}\":{raw}}}"),
    ] {
        write("it.cast", &cast);
        harmless(home.path(), &words(&["play", "it.cast"]), &[65]);
    }
    for script in [
        format!("{STEERING}\n"),
        format!("Open {STEERING}\n"),
        format!("Open pendulum\nCaption \"{STEERING}\"\nWiat 1s\n"),
        format!("Open pendulum\nWait 1s\nMarker \"{STEERING}\"\nAssert g = 1\n"),
        format!("Open pendulum\nType \"{STEERING}\"\nAssert {STEERING} = 1\n"),
    ] {
        write("my.demo", &script);
        harmless(home.path(), &words(&["script", "check", "my.demo"]), &[2, 65]);
        harmless(home.path(), &words(&["play", "my.demo"]), &[2, 65]);
        harmless(home.path(), &words(&["record", "pendulum", "--script", "my.demo"]), &[2, 65]);
    }
    for config in [format!("theme = \"{}\"\n", escaped(STEERING)), format!("\"{raw}\" = 1\n")] {
        write("config.toml", &config);
        harmless(home.path(), &words(&["config", "check", "config.toml"]), &[65]);
    }
    // captions in a cast are JSON, and a script's title is a cast's
    write(
        "my.demo",
        &format!(
            "Open pendulum\nSize 90x28\nFps 10\nCaption \"a{raw}b\"\nMarker \"a{raw}b\"\nWait 1s\n"
        ),
    );
    for arguments in [
        &["record", "pendulum", "--script", "my.demo"][..],
        &["record", "pendulum", "--script", "my.demo", "--format", "account"],
        &["record", "pendulum", "--script", "my.demo", "--still", "/dev/stdout"],
    ] {
        harmless(home.path(), &words(arguments), &[0, 2, 65]);
    }
}

/// Of a file whose name steers a terminal, and whose texts are markup.
#[test]
fn no_recording_or_still_has_what_steers_or_is_markup() {
    let home = tempfile::tempdir().unwrap();
    let markup = "<b>&]]>'";
    let name = format!("a{STEERING}.toml").replace('/', "");
    let system = PENDULUM.replacen("title = \"", &format!("title = \"{markup}"), 1);
    fs::write(home.path().join(&name), system).unwrap();
    let script = format!(
        "Size 90x28\nFps 10\nTitle \"{markup}\"\nCaption \"{markup}\"\nMarker \"{markup}\"\nWait 0.3s\n"
    );
    fs::write(home.path().join("my.demo"), script).unwrap();
    let name = format!("./{name}");
    for still in ["it.svg", "it.txt"] {
        let arguments = ["record", &name, "--script", "my.demo", "--still", still, "-o", "it.cast"];
        harmless(home.path(), &words(&arguments), &[0]);
        for written in [still, "it.cast"] {
            let text = fs::read_to_string(home.path().join(written)).unwrap();
            assert!(!text.chars().any(|c| is_steering(c) && c != '\n'), "{written}");
        }
    }
    let drawing = fs::read_to_string(home.path().join("it.svg")).unwrap();
    let drawing = roxmltree::Document::parse(&drawing).expect("well-formed");
    assert!(!drawing.descendants().any(|node| node.has_tag_name("b")));
    let cast = fs::read_to_string(home.path().join("it.cast")).unwrap();
    let events = cast.lines().skip(1).filter(|line| !line.is_empty());
    for event in events.map(|line| serde_json::from_str::<serde_json::Value>(line).unwrap()) {
        let data = event[2].as_str().unwrap().replace('\u{1b}', "");
        // the lab itself moves the cursor, by sequences that begin with ESC and by single characters
        let steers = |c: char| is_steering(c) && !matches!(c, '\r' | '\n' | '\u{8}');
        assert!(!data.chars().any(steers), "{data:?}");
        assert!(!event[2].as_str().unwrap().contains("\u{1b}]"), "{event}");
    }
}

#[test]
fn nothing_is_reported_at_any_length() {
    let home = tempfile::tempdir().unwrap();
    let long = "x".repeat(100_000);
    let value = format!("m={long}");
    let ones = "1".repeat(100_000);
    for arguments in [
        &["run", &long][..],
        &["run", "pendulum", "--set", &value],
        &["run", "pendulum", "--set", &long],
        &["run", "pendulum", "--method", &long],
        &["run", "pendulum", "--until", &ones],
        &["run", "pendulum", "--observe", &long],
        &["run", "pendulum", "--format", &long],
        &["run", "pendulum", "--at", "1e300,1e299"],
        &["run", "pendulum", "--init", "t=1e300", "--until", "1"],
        &["bracket", "pendulum", &long, "energy"],
        &["man", &long],
        &[&long, "pendulum"],
        &[&long],
    ] {
        let output = harmless(home.path(), &words(arguments), &[2]);
        let reported = String::from_utf8(output.stderr).unwrap();
        let longest = reported.lines().map(|line| line.chars().count()).max();
        assert!(longest.is_some_and(|longest| longest < 500), "{:?}: {longest:?}", arguments[0]);
    }
}

/// A name with bytes that are not UTF-8 is a valid name.
#[test]
fn a_name_that_is_no_text_is_accepted() {
    let home = tempfile::tempdir().unwrap();
    let name = OsStr::from_bytes(b"caf\xe9.toml");
    fs::write(home.path().join(name), PENDULUM).unwrap();
    let run = |arguments: &[&str]| {
        let mut command = program(home.path());
        super::done(command.arg(arguments[0]).arg(name).args(&arguments[1..])).success()
    };
    assert!(run(&["derive"]).starts_with("A pendulum\n"));
    assert!(run(&["run", "--at", "0"]).starts_with("# phaselab "));
    assert!(run(&["bracket", "theta", "p_theta"]).contains('1'));
    assert_eq!(run(&["check"]), "");
}
