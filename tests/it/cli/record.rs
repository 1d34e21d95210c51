//! `phaselab record` and `phaselab script check`, run as programs.

use std::fs;

use super::{done, phaselab, program};

const SCRIPT: &str = "Open pendulum\nSize 90x28\nFps 10\nCaption \"Hello\"\nPress Tab\nWait 1s\n\
                      Marker \"Middle\"\nSweep g to 20 in 1s\nAssert g = 20 within 0\n";

#[test]
fn the_machine_leaves_no_mark() {
    let home = tempfile::tempdir().expect("a folder");
    let other = home.path().join("Eva's other folder");
    fs::create_dir(&other).expect("a folder");
    for place in [home.path(), &other] {
        fs::write(place.join("my.demo"), SCRIPT).expect("a file");
        fs::write(place.join("own.toml"), include_str!("../../../presets/pendulums/pendulum.toml"))
            .expect("a file");
    }
    let arguments = ["record", "./own.toml", "--script", "my.demo"];
    let one = done(program(home.path()).args(arguments));
    let mut command = program(&other);
    let variables = [
        ("TERM", "dumb"),
        ("NO_COLOR", "1"),
        ("TZ", "Asia/Kathmandu"),
        ("LC_ALL", "C"),
        ("COLUMNS", "7"),
        ("LINES", "3"),
        ("RAYON_NUM_THREADS", "1"),
        ("USER", "eva-maria"),
        ("HOSTNAME", "zugspitze"),
        ("SSH_CONNECTION", "x"),
        ("SHELL", "/bin/fish"),
    ];
    command.envs(variables).env("HOME", "/nonexistent").current_dir(&other);
    let another = done(command.args(["record"]).arg(other.join("own.toml")).args(&arguments[2..]));
    assert_eq!((one.code, another.code), (0, 0), "{}{}", one.stderr, another.stderr);
    assert!(one.stdout == another.stdout, "two casts of one script differ");
    for private in
        ["eva-maria", "Eva's", "zugspitze", "/bin/fish", "SHELL", "/tmp", "timestamp", "HOME"]
    {
        assert!(!one.stdout.contains(private), "{private}");
    }
    assert_eq!((one.stderr.as_str(), another.stderr.as_str()), ("", ""));
}

#[test]
fn a_cast_is_written_whole_or_not_at_all() {
    let home = tempfile::tempdir().expect("a folder");
    let write = |text: &str| fs::write(home.path().join("my.demo"), text).expect("a file");
    let record = || {
        let arguments = ["record", "pendulum", "--script", "my.demo", "-o", "out.cast"];
        done(program(home.path()).args(arguments))
    };
    let cast = home.path().join("out.cast");
    write(&format!("{SCRIPT}Assert g = 1 within 0\n"));
    let failed = record();
    assert_eq!(failed.code, 65);
    assert!(failed.stderr.contains("--> my.demo:10:1"), "{}", failed.stderr);
    assert!(failed.stderr.contains("this is false: g is 20"), "{}", failed.stderr);
    assert!(!cast.exists());
    write(SCRIPT);
    assert_eq!(record().code, 0);
    let text = fs::read_to_string(&cast).expect("a cast");
    assert!(
        text.starts_with("{\"version\":3,\"term\":{\"cols\":90,\"rows\":28"),
        "{}",
        &text[..90]
    );
    assert!(text.contains("[0.000000, \"m\", \"Middle\"]") || text.contains("\"m\", \"Middle\"]"));
}

#[test]
fn a_still_is_taken_of_a_moment() {
    let home = tempfile::tempdir().expect("a folder");
    fs::write(home.path().join("my.demo"), SCRIPT).expect("a file");
    let take = |still: &str, at: &[&str]| {
        let arguments = ["record", "pendulum", "--script", "my.demo", "--still", still];
        done(program(home.path()).args(arguments).args(at))
    };
    let read = |name: &str| fs::read_to_string(home.path().join(name)).expect(name);
    let last = take("last.txt", &[]);
    assert_eq!((last.code, last.stdout.as_str()), (0, ""), "{}", last.stderr);
    assert_eq!(take("middle.txt", &["--at", "Middle"]).code, 0);
    assert!(read("last.txt").contains(" t 2.10000"), "{}", read("last.txt"));
    assert!(read("middle.txt").contains(" t 1.10000"), "{}", read("middle.txt"));
    assert_eq!(take("last.svg", &[]).code, 0);
    assert!(read("last.svg").starts_with("<svg xmlns="));
    assert_eq!(take("last.ans", &[]).code, 0);
    let wrong = take("last.svg", &["--at", "Midle"]);
    assert!(wrong.code == 2 && wrong.stderr.contains("did you mean `Middle`?"), "{}", wrong.stderr);
    let wrong = take("last.gif", &[]);
    assert!(wrong.code == 2 && wrong.stderr.contains(".svg, .txt or .ans"), "{}", wrong.stderr);
}

#[test]
fn a_gif_is_drawn_of_a_script_and_of_a_cast() {
    let home = tempfile::tempdir().expect("a folder");
    fs::write(home.path().join("my.demo"), SCRIPT).expect("a file");
    let record = |arguments: &[&str]| done(program(home.path()).arg("record").args(arguments));
    let script = ["pendulum", "--script", "my.demo", "--cell-width", "5"];
    for output in ["direct.gif", "it.cast"] {
        let done = record(&[&script[..], &["-o", output]].concat());
        assert_eq!((done.code, done.stderr.as_str()), (0, ""));
    }
    let done = record(&["it.cast", "--cell-width", "5", "-o", "converted.gif"]);
    assert_eq!((done.code, done.stderr.as_str()), (0, ""));
    let read = |name: &str| fs::read(home.path().join(name)).expect(name);
    let gif = read("direct.gif");
    assert!(gif.starts_with(b"GIF89a\xc2\x01\x18\x01"), "450 by 280 pixels");
    assert!(gif == read("converted.gif"), "a cast and its script give different pictures");
    let wrong = record(&["it.cast"]);
    assert!(wrong.code == 2 && wrong.stderr.contains("-o NAME.gif"), "{}", wrong.stderr);
    let wrong = record(&["it.cast", "--size", "80x24", "-o", "other.gif"]);
    assert!(wrong.code == 2 && wrong.stderr.contains("drawn as it is"), "{}", wrong.stderr);
    let wrong = record(&["pendulum", "--cell-width", "400", "-o", "other.gif"]);
    assert!(wrong.code == 2 && wrong.stderr.contains("4..=40"), "{}", wrong.stderr);
}

#[test]
fn what_is_played_is_a_cast_or_a_script() {
    let home = tempfile::tempdir().expect("a folder");
    let check = |text: &str, code: i32, part: &str| {
        fs::write(home.path().join("it.cast"), text).expect("a file");
        let done = done(program(home.path()).args(["play", "it.cast"]));
        assert_eq!((done.code, done.stdout.as_str()), (code, ""), "{}", done.stderr);
        assert!(done.stderr.contains(part), "{}", done.stderr);
    };
    let head = "{\"version\":2,\"width\":80,\"height\":24}\n";
    check(
        "{\"version\":9,\"width\":80,\"height\":24}",
        65,
        "it.cast: line 1: casts of version 2 and 3",
    );
    check(&format!("{head}nonsense"), 65, "it.cast: line 2: this is not an event");
    check("Wiat 1s", 65, "did you mean `Wait`?");
    check("Wait 1s", 65, "does not say which system");
    // everything is correct, but there is no terminal
    check(&format!("{head}[1, \"o\", \"hello\"]"), 2, "terminal");
    check("Open pendulum\nWait 1s", 2, "terminal");
}

#[test]
fn scripts_are_checked() {
    let home = tempfile::tempdir().expect("a folder");
    let check = |text: &str, code: i32, part: &str| {
        fs::write(home.path().join("my.demo"), text).expect("a file");
        let done = done(program(home.path()).args(["script", "check", "my.demo"]));
        assert_eq!((done.code, done.stdout.as_str()), (code, ""), "{}", done.stderr);
        assert!(done.stderr.contains(part), "{}", done.stderr);
    };
    check(SCRIPT, 0, "");
    check("Wiat 2s\n", 65, "--> my.demo:1:1");
    check("Wiat 2s\n", 65, "did you mean `Wait`?");
    check("Open pendulum\nWait 1s\nAssert status paused", 65, "my.demo:3:1");
    check("Open pendulm\nWait 1s", 2, "did you mean `pendulum`?");
}

/// A script has the words of the gauges, and one that has an older one learns the new one.
#[test]
fn a_script_may_claim_each_verdict_with_the_word_of_the_gauge() {
    let home = tempfile::tempdir().expect("a folder");
    let driven = "title = \"Driven\"\n[coordinates]\nx = { initial = 1 }\n[lagrangian]\n\
                  L = \"1/2*x'^2 - 1/2*x^2 + x*sin(3*t)\"\n[[observables]]\nname = \"V\"\n\
                  expression = \"x^2\"\nconserved = false\n";
    fs::write(home.path().join("driven.toml"), driven).expect("a file");
    let check = |claim: &str| {
        let script = format!("Open \"driven.toml\"\nSize 120x40\nWait 9s\nAssert {claim}\n");
        fs::write(home.path().join("my.demo"), script).expect("a file");
        done(program(home.path()).args(["script", "check", "my.demo"]))
    };
    let name = "energy";
    let run = check(&format!("verdict {name} not conserved"));
    assert_eq!((run.code, run.stderr.as_str()), (0, ""));
    let run = check(&format!("verdict {name} exact"));
    assert!(run.code == 65 && run.stderr.contains("is not conserved"), "{}", run.stderr);
    for (word, new) in
        [("broken", "not conserved"), ("varies", "not conserved"), ("drifting", "secular")]
    {
        let run = check(&format!("verdict {name} {word}"));
        assert_eq!(run.code, 65, "{word}");
        assert!(run.stderr.contains(&format!("write `{new}`")), "{}", run.stderr);
        assert!(run.stderr.contains("my.demo:4:23"), "{}", run.stderr);
    }
    check(&format!("verdict {name} not")).fails(65, &["conserved"]);
}

/// The lab has the word and the reason in the gauge, and a script may claim them.
#[test]
fn a_script_may_claim_that_a_verdict_is_unknown() {
    let home = tempfile::tempdir().expect("a folder");
    let tiny = "title = \"Tiny\"\n[coordinates]\nx = { initial = 1e-170 }\n[lagrangian]\nL = \"1/2*x'^2 - 1/2*x^2\"\n";
    fs::write(home.path().join("tiny.toml"), tiny).expect("a file");
    let script = "Open \"tiny.toml\"\nSize 120x40\nWait 30s\nAssert verdict energy unknown\n\
                  Assert screen \"underflow\"\nAssert screen \"unknown\"\n";
    fs::write(home.path().join("my.demo"), script).expect("a file");
    let done = done(program(home.path()).args(["script", "check", "my.demo"]));
    assert_eq!((done.code, done.stderr.as_str()), (0, ""));
}

#[test]
fn a_demo_of_its_own_or_a_sentence() {
    let missing = phaselab(&["record", "duffing"]);
    assert_eq!((missing.code, missing.stdout.as_str()), (2, ""));
    assert!(missing.stderr.contains("`duffing` has no demo of its own"), "{}", missing.stderr);
    let two = phaselab(&["record", "charge-in-fields", "--format", "v2"]);
    assert_eq!(two.code, 0, "{}", two.stderr);
    assert!(two.stdout.starts_with("{\"version\":2,\"width\":"));
    let account = phaselab(&["record", "charge-in-fields", "--format", "account"]);
    assert!(account.code == 0 && account.stdout.contains("  chapter   "), "{}", account.stdout);
}
