//! The laboratory itself, as a user experiences it.

use std::fs;
use std::path::Path;
use std::process::{Command, Stdio};
use std::time::{Duration, Instant};

use rustix::process::Signal;

use super::session::{Session, Setup, quits};

const PROGRAM: &str = env!("CARGO_BIN_EXE_phaselab");

fn lab(arguments: &[&str]) -> Setup {
    Setup::new(PROGRAM, arguments).size(120, 40)
}

/// The pendulum in motion.
fn pendulum() -> Session {
    let mut lab = lab(&["pendulum"]).start();
    lab.shows("running");
    lab.shows("fps");
    lab
}

#[test]
fn the_picker_answers_and_opens_a_system() {
    let mut lab = lab(&[]).start();
    lab.shows("Systems");
    lab.shows("Simple pendulum");
    lab.press("henon");
    lab.until("the search leaves one", |lab| {
        lab.text().contains("Hénon") && !lab.text().contains("Simple pendulum")
    });
    assert!(lab.screen().bracketed_paste(), "text is typed, so pastes come in brackets");
    lab.press("\r");
    lab.shows("running");
    lab.press(" ");
    lab.shows("paused");
    quits(lab);
}

#[test]
fn q_leaves_every_page() {
    for (keys, shown) in [("", "Gauges"), ("2", "Equations"), ("3", "Notes"), ("4", "Numbers")] {
        let mut lab = pendulum();
        lab.press(keys);
        lab.shows(shown);
        quits(lab);
    }
    let mut tiny = lab(&[]).size(20, 4).start();
    tiny.shows("needs");
    quits(tiny);
    let mut lab = pendulum();
    lab.press("\x1b");
    lab.shows("Esc again");
    lab.press("\x1b");
    lab.shows("Systems");
    quits(lab);
    // but what lies on top it closes first
    let mut lab = pendulum();
    lab.press("?");
    lab.shows("Keys");
    lab.press("q");
    lab.shows("running");
    quits(lab);
}

#[test]
fn a_paused_lab_sends_nothing() {
    let mut lab = pendulum();
    lab.press(" ");
    lab.shows("paused");
    lab.quiet(Duration::from_millis(300));
    assert_eq!(lab.bytes_in(Duration::from_secs(2)), 0);
    quits(lab);
}

#[test]
fn the_cursor_is_seen_where_something_is_read_or_typed_and_nowhere_else() {
    let mut lab = pendulum();
    lab.until("the cursor is hidden", |lab| lab.screen().hide_cursor());
    lab.press("9");
    lab.until("the cursor is at the first line", |lab| {
        !lab.screen().hide_cursor() && lab.screen().cursor_position() == (1, 1)
    });
    lab.press("j");
    lab.until("it goes a line on", |lab| lab.screen().cursor_position() == (2, 1));
    lab.quiet(Duration::from_millis(300));
    assert_eq!(lab.bytes_in(Duration::from_secs(1)), 0, "what is read keeps still");
    lab.press("1");
    lab.until("the cursor is hidden", |lab| lab.screen().hide_cursor());
    lab.press(":zoo");
    lab.until("the cursor is in the text", |lab| {
        let (row, column) = lab.screen().cursor_position();
        let before = lab.screen().contents_between(row, 0, row, column);
        !lab.screen().hide_cursor() && before.ends_with("/ zoo")
    });
    lab.press("\x1b");
    lab.until("it is closed", |lab| !lab.text().contains("/ zoo"));
    quits(lab);
}

#[test]
fn a_click_is_done_where_it_falls() {
    let mut lab = lab(&["pendulum", "--mouse"]).start();
    lab.shows("running");
    let text = lab.text();
    let row = text.lines().position(|line| line.contains("2 Equations")).unwrap();
    let line = text.lines().nth(row).unwrap();
    let column = line[..line.find("2 Equations").unwrap()].chars().count();
    let (x, y) = (column + 3, row + 1);
    lab.press(&format!("\x1b[<0;{x};{y}M\x1b[<0;{x};{y}m"));
    lab.shows("Lagrangian");
    quits(lab);
}

#[test]
fn a_theme_is_chosen_by_its_name() {
    let mut lab = lab(&["pendulum", "--theme", "contrast", "--color", "true"]).start();
    lab.shows("running");
    // phaselab, in the accent of that theme
    lab.until("the theme is there", |lab| lab.sent().contains("38;2;95;255;255"));
    quits(lab);
}

#[test]
fn a_far_terminal_gets_fewer_frames() {
    let mut lab = lab(&["pendulum"]).variable("SSH_TTY", "/dev/pts/0").start();
    lab.shows("running");
    let frames = lab.frames_in(Duration::from_secs(2));
    assert!(frames <= 31, "{frames} frames in two seconds");
    quits(lab);
}

#[test]
fn the_mouse_is_used_until_it_is_left_to_the_terminal() {
    let reported = |lab: &Session| {
        lab.screen().mouse_protocol_mode() == vt100::MouseProtocolMode::ButtonMotion
    };
    let mut plain = pendulum();
    plain.until("the mouse is reported", reported);
    plain.press("\x1b[<0;0;0M\x1b[<0;10;10M\x1b[<32;11;10M\x1b[<0;11;10m\x1b[<64;99999;1M");
    plain.press("M");
    plain.until("the mouse is left alone", |lab| !reported(lab));
    plain.shows("Mouse off");
    quits(plain);

    let mut without = lab(&["pendulum", "--mouse=false"]).start();
    without.shows("running");
    assert!(["1000", "1002", "1003", "1006"].iter().all(|m| !without.sent().contains(m)));
    quits(without);
}

#[test]
fn a_narrow_line_is_kept_to() {
    let mut lab = Setup::new(PROGRAM, &["double-pendulum", "--bandwidth", "8k"])
        .size(200, 60)
        .variable("COLORTERM", "truecolor")
        .start();
    lab.shows("running");
    let bytes = lab.bytes_in(Duration::from_secs(5));
    assert!(bytes <= 8 * 1024 * 5 * 11 / 10 + 4096, "{bytes} bytes in five seconds");
    quits(lab);
}

#[test]
fn frames_a_second_are_shown_and_changed() {
    let mut lab = lab(&["pendulum", "--fps", "20"]).start();
    lab.shows("/20 fps");
    lab.press("<");
    lab.shows("/15 fps");
    lab.press("<<<");
    lab.shows("/2 fps");
    lab.quiet(Duration::from_millis(300));
    let frames = lab.frames_in(Duration::from_secs(2));
    assert!((1..=5).contains(&frames), "{frames} frames in two seconds");
    quits(lab);

    let mut calm =
        Setup::new(PROGRAM, &["pendulum", "--reduce-motion", "--fps", "60"]).size(120, 40).start();
    calm.shows("/4 fps");
    let frames = calm.frames_in(Duration::from_secs(2));
    assert!(frames <= 9, "{frames} frames in two seconds");
    calm.press(">");
    calm.shows("The highest rate");
    quits(calm);

    let mut wrong = Setup::new(PROGRAM, &["pendulum", "--bandwidth", "slow"]).start();
    assert_eq!(wrong.ends().0, 2);
    assert!(wrong.text().contains("16k"), "{}", wrong.text());
}

/// All numbers of the `CSI … m` sequences in what was sent.
fn attributes(sent: &str) -> Vec<Vec<u16>> {
    let sequences = sent.split("\x1b[").skip(1).filter_map(|rest| {
        let end = rest.find(|c: char| !c.is_ascii_digit() && c != ';')?;
        rest[end..].starts_with('m').then(|| &rest[..end])
    });
    sequences.map(|numbers| numbers.split(';').flat_map(str::parse).collect()).collect()
}

#[test]
fn no_color_means_no_colour_and_still_a_selection() {
    let mut lab = lab(&[]).variable("NO_COLOR", "1").start();
    lab.shows("Simple pendulum");
    lab.press("pendulum\r");
    lab.shows("running");
    lab.press("?");
    lab.shows("Keys");
    let attributes = attributes(&lab.sent());
    assert!(attributes.iter().all(|numbers| !numbers.is_empty()), "a bare CSI m ends everything");
    let coloured = |number: &u16| (30..=49).contains(number) || (90..=107).contains(number);
    assert!(!attributes.iter().flatten().any(coloured), "{attributes:?}");
    assert!(attributes.iter().flatten().any(|number| *number == 7), "nothing is selected");
    lab.press("q");
    lab.shows("running");
    quits(lab);
}

#[test]
fn a_plain_locale_gets_ascii() {
    let mut lab = lab(&[]).variable("LANG", "C").start();
    lab.shows("Simple pendulum");
    lab.press("pendulum\r");
    lab.shows("running");
    for page in ["2", "3", "4", "?"] {
        lab.press(page);
        lab.bytes_in(Duration::from_millis(100));
    }
    lab.shows("Keys");
    let beyond: String = lab.sent().chars().filter(|c| !c.is_ascii()).collect();
    assert_eq!(beyond, "");
    lab.press("q");
    lab.shows("Numbers");
    quits(lab);
}

#[test]
fn a_file_with_errors_is_shown_with_its_errors() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("wrong.toml");
    let text = "title = \"Wrong\"\n[coordinates]\nx = { initial = 1.0 }\n[lagrangian]\nL = \"y\"\n";
    fs::write(&path, text).expect("a file");
    let mut lab = Setup::new(PROGRAM, &[]).size(120, 40).argument(&path).start();
    lab.shows("has errors");
    lab.shows("L = \"y\"");
    lab.shows("^");
    // the first q closes the report
    lab.press("q");
    lab.until("it is closed", |lab| !lab.text().contains("has errors"));
    quits(lab);
}

#[test]
fn a_name_that_is_not_there_opens_nothing() {
    let mut lab = lab(&["pendulm"]).start();
    assert_eq!(lab.ends().0, 2);
    assert!(lab.text().contains("`pendulum`"), "{}", lab.text());
    assert!(!lab.sent().contains("\x1b["));
}

#[test]
fn a_flood_of_keys_does_not_hold_a_moving_lab() {
    for key in ["z", " "] {
        let mut lab = pendulum();
        lab.press(&(key.repeat(100_000) + "q"));
        let (status, took) = lab.ends();
        assert_eq!(status, 0);
        assert!(took < Duration::from_secs(2), "{took:?}");
    }
}

#[test]
fn a_storm_of_sizes_ends_in_the_picture_of_the_last() {
    let mut lab = pendulum();
    lab.press(" ");
    lab.shows("paused");
    for step in 0_u16..200 {
        lab.resize(step * 37 % 301, step * 53 % 97);
    }
    lab.resize(80, 24);
    lab.until("the last size is painted", |lab| {
        let sent = lab.sent();
        let last = sent.rfind("\x1b[2J").map_or("", |at| &sent[at..]);
        let mut screen = vt100::Parser::new(24, 80, 0);
        screen.process(last.as_bytes());
        let lines: Vec<_> = screen.screen().rows(0, 80).collect();
        lines[0].contains("Simple pendulum") && lines[23].contains("q quit")
    });
    lab.press("q");
    assert_eq!(lab.ends().0, 0);
}

#[test]
fn without_a_terminal_it_says_what_to_do() {
    let output = Command::new(PROGRAM)
        .env("TERM", "xterm")
        .stdin(Stdio::null())
        .output()
        .expect("the program starts");
    assert_eq!(output.status.code(), Some(2));
    assert!(output.stdout.is_empty());
    let message = String::from_utf8(output.stderr).expect("text");
    assert_eq!(message.lines().count(), 1, "{message}");
    assert!(message.contains("phaselab run"), "{message}");
    let mut dumb = lab(&[]).variable("TERM", "dumb").start();
    assert_eq!(dumb.ends().0, 2);
    assert!(dumb.text().contains("phaselab run"), "{}", dumb.text());
}

/// The files of a folder whose names have this ending.
fn written(folder: &Path, ending: &str) -> Vec<(String, String)> {
    let entries = fs::read_dir(folder).expect("a folder").filter_map(Result::ok);
    let named = entries.map(|e| (e.file_name().to_string_lossy().into_owned(), e.path()));
    let wanted = named.filter(|(name, _)| name.ends_with(ending));
    let mut all: Vec<(String, String)> =
        wanted.map(|(name, path)| (name, fs::read_to_string(path).unwrap_or_default())).collect();
    all.sort();
    all
}

/// The pendulum in motion, started in a folder.
fn pendulum_in(folder: &Path) -> Session {
    let mut lab = lab(&["pendulum"]).folder(folder).start();
    lab.shows("running");
    lab
}

/// Where the terminal is not known to have a clipboard, `y` says so, and into which file and folder it has written.
#[test]
fn equations_that_are_not_copied_are_written_into_a_named_file() {
    let folder = tempfile::tempdir().expect("a folder");
    let mut lab = pendulum_in(folder.path());
    lab.press("2");
    lab.shows("Equations");
    lab.press("y");
    lab.shows("because this terminal is not known to have a clipboard.");
    let name = folder.path().file_name().expect("a name").to_string_lossy().into_owned();
    lab.shows(&name);
    lab.shows("Saved pendulum.tex in");
    lab.press("1q");
    lab.ends();
    assert_eq!(written(folder.path(), ".tex").len(), 1);
}

#[test]
fn stills_data_and_recordings_are_written_by_keys() {
    let folder = tempfile::tempdir().expect("a folder");
    let mut lab = pendulum_in(folder.path());
    lab.press("S");
    let folder_name = folder.path().file_name().expect("a name").to_string_lossy().into_owned();
    lab.shows("Saved pendulum.svg in");
    lab.shows(&folder_name);
    lab.press("S");
    lab.shows("Saved pendulum-2.svg");
    lab.press("D");
    lab.shows("Saved pendulum.csv in");
    lab.press("O");
    lab.shows("rec");
    lab.press("2");
    lab.shows("Equations");
    lab.press("1O");
    lab.shows("Saved pendulum.cast in");
    // and again, ended by leaving
    lab.press("O");
    lab.shows("rec");
    let stills = written(folder.path(), ".svg");
    assert_eq!(stills.len(), 2);
    assert!(stills.iter().all(|(_, text)| text.ends_with("</svg>\n") && text.contains("<circle")));
    let data = written(folder.path(), ".csv").remove(0).1;
    let mut lines = data.lines().skip_while(|line| line.starts_with('#'));
    let head = lines.next().expect("names of columns");
    assert!(head.starts_with("t,theta,theta',p_theta,energy"), "{head}");
    assert!(lines.next().is_some_and(|row| row.starts_with("0.0,2.0,0.0,0.0,")), "{data}");
    lab.press("q");
    assert_eq!(lab.ends().0, 0);
    let casts = written(folder.path(), ".cast");
    assert_eq!(casts.len(), 2);
    for (name, text) in casts {
        let cast = phaselab::record::RecordedCast::read(&text)
            .unwrap_or_else(|why| panic!("{name}: {why}"));
        assert_eq!(cast.size, (120, 40));
        let mut terminal = avt::Vt::new(120, 40);
        for (_, turn) in &cast.events {
            if let phaselab::record::CastEvent::Output(text) = turn {
                terminal.feed_str(text);
            }
        }
        assert!(terminal.text().join("\n").contains("Parameters"), "{name}");
    }
    assert!(written(folder.path(), ".partial").is_empty());
}

#[test]
fn a_recording_survives_a_signal() {
    let folder = tempfile::tempdir().expect("a folder");
    let mut lab = pendulum_in(folder.path());
    lab.press("O");
    lab.shows("rec");
    lab.signal(Signal::TERM);
    assert_eq!(lab.ends().0, 143);
    let casts = written(folder.path(), ".cast");
    assert!(
        casts.len() == 1 && phaselab::record::RecordedCast::read(&casts[0].1).is_ok(),
        "{casts:?}"
    );
}

/// The only cast of a folder, which must be well-formed to its last line.
#[track_caller]
fn only_cast(folder: &Path) -> String {
    let mut casts = written(folder, ".cast");
    assert_eq!(casts.len(), 1, "{casts:?}");
    let (_, text) = casts.remove(0);
    phaselab::record::RecordedCast::read(&text).unwrap_or_else(|why| panic!("{why}: {text}"));
    assert!(written(folder, ".partial").is_empty());
    text
}

#[test]
fn a_recording_keeps_its_end_behind_a_stalled_terminal() {
    let folder = tempfile::tempdir().expect("a folder");
    let mut lab = pendulum_in(folder.path());
    lab.press("O");
    lab.shows("rec");
    lab.stalled(|lab| {
        // more than a terminal accepts if nobody reads from it
        for _ in 0..20 {
            lab.press("2");
            lab.bytes_in(Duration::from_millis(50));
            lab.press("1");
            lab.bytes_in(Duration::from_millis(50));
        }
        lab.signal(Signal::TERM);
        assert_eq!(lab.ends().0, 143);
    });
    let text = only_cast(folder.path());
    assert!(text.trim_end().ends_with("\\u001b[?25h\"]"), "its end is there: {text:.200}");
}

#[test]
fn a_recording_keeps_its_end_when_the_line_is_lost() {
    let folder = tempfile::tempdir().expect("a folder");
    let mut lab = pendulum_in(folder.path());
    lab.press("O");
    lab.shows("rec");
    lab.hang_up().wait().expect("a child of ours");
    let text = only_cast(folder.path());
    assert!(text.trim_end().ends_with("\\u001b[?25h\"]"), "its end is there: {text:.200}");
}

#[test]
fn a_full_disk_ends_a_recording_and_keeps_what_was_recorded() {
    let folder = tempfile::tempdir().expect("a folder");
    // no file beyond 40 KiB, and no signal because of that
    let line = "trap '' XFSZ; ulimit -f 80; exec \"$0\" pendulum";
    let lab = Setup::new("sh", &["-c", line, PROGRAM]).size(120, 40).folder(folder.path());
    let mut lab = lab.start();
    lab.shows("running");
    lab.press("O");
    lab.shows("rec");
    let end = Instant::now() + Duration::from_secs(60);
    while !lab.text().contains("pendulum.cast holds what came before") {
        assert!(Instant::now() < end, "never full: {}", lab.text());
        lab.press("2");
        lab.bytes_in(Duration::from_millis(60));
        lab.press("1");
        lab.bytes_in(Duration::from_millis(60));
    }
    assert!(lab.text().contains("cannot write pendulum.cast: "), "{}", lab.text());
    let text = only_cast(folder.path());
    assert!(text.ends_with("]\n") && text.len() > 10_000, "{}", text.len());
    // another attempt gives another file
    lab.press("O");
    lab.until("it records again", |lab| lab.text().contains("rec"));
    lab.press("O");
    lab.shows("Saved pendulum-2.cast");
    quits(lab);
}

#[test]
fn a_cast_is_played_on_the_terminal() {
    let mut player = lab(&["play", "pendulum"]).start();
    player.shows("Released from 1°");
    player.shows(" of 0:");
    player.press(" ");
    player.shows("‖");
    player.press("\x1b[F");
    player.shows("Since the last change the energy");
    player.press("q");
    assert_eq!(player.ends().0, 0);
    player.assert_restored();
}

/// A claim that would be false later is not taken for checked where the script is left before, by a key or by a signal.
#[test]
fn a_script_that_is_left_before_its_end_says_what_was_not_checked() {
    let script = "Open pendulum\nCaption \"Begun\"\nWait 3500s\nAssert t < 0\nAssert t < 1\n";
    for (key, code) in [(Some("q"), 0), (None, 143)] {
        let folder = tempfile::tempdir().expect("a folder");
        fs::write(folder.path().join("long.demo"), script).expect("a file");
        let mut player = lab(&["play", "./long.demo"]).folder(folder.path()).start();
        player.shows("Begun");
        match key {
            Some(key) => player.press(key),
            None => player.signal(Signal::TERM),
        }
        assert_eq!(player.ends().0, code);
        player.assert_restored();
        let left = player.text().split_whitespace().collect::<Vec<_>>().join(" ");
        assert!(left.contains("2 claims of 2 were not reached"), "{left}");
    }
}

#[test]
fn a_demo_ends_by_itself_and_its_last_picture_stays() {
    let mut demo = Setup::new(PROGRAM, &["--demo"]).start();
    demo.shows("nothing but a Lagrangian is given");
    demo.until("it has the screen for itself", |demo| demo.screen().alternate_screen());
    demo.shows("Equations of motion");
    demo.shows("the energy is conserved to the last digit");
    assert_eq!(demo.ends().0, 0);
    demo.assert_restored();
    let left = demo.text();
    for part in ["Motion", "Gauges", "20 m/s²", "the energy is conserved to the last digit"] {
        assert!(left.contains(part), "{left}");
    }
    assert!(demo.sent().contains("\x1b[?2026h"));
}

#[test]
fn a_demo_can_be_paused_and_left() {
    let mut demo = Setup::new(PROGRAM, &["pendulum", "--demo"]).start();
    demo.shows("Released from 1°");
    demo.press(" ");
    demo.quiet(Duration::from_millis(500));
    demo.press(" ");
    demo.shows("From 170°");
    demo.press("q");
    assert_eq!(demo.ends().0, 0);
    demo.assert_restored();
    assert!(!demo.text().contains("Gauges"), "{}", demo.text());
}

#[test]
fn what_is_wrong_with_a_demo_is_reported_on_the_restored_terminal() {
    let folder = tempfile::tempdir().expect("a folder");
    let check = |name: &str, text: &str, code: u32, part: &str| {
        fs::write(folder.path().join("my.demo"), text).expect("a file");
        let mut demo = Setup::new(PROGRAM, &["--demo", name]).folder(folder.path()).start();
        assert_eq!(demo.ends().0, code);
        demo.assert_restored();
        assert!(demo.text().contains(part), "{}", demo.text());
    };
    check("my.demo", "Open pendulum\nWait 1s\nSet thta = 1\nWait 1s", 65, "did you mean `theta`?");
    check("my.demo", "Open pendulum\nWiat 1s", 65, "did you mean `Wait`?");
    check("my.demo", "Wait 1s", 65, "does not say which system");
    check("duffing", "", 2, "`duffing` has no demo of its own: name a script");
}

/// A lesson has the screen until it is left, and goes on where it was; a demo leads back as well.
#[test]
fn a_lesson_and_a_demo_are_taken_inside_the_lab() {
    let mut lab = pendulum();
    lab.press("\x1bOQ");
    lab.shows("Lessons and demos");
    lab.press("kepler");
    lab.shows("Why does Kepler");
    lab.press("\r");
    lab.shows("A planet moves around a sun");
    lab.press("\r");
    lab.shows("Before each thing happens");
    lab.press("q");
    lab.shows("lesson, begun");
    lab.press("\r");
    lab.shows("Before each thing happens");
    lab.press("q");
    lab.shows("lesson, begun");
    // the list begins anew, with all of them
    closes(&mut lab);
    lab.press("\x1bOQ");
    lab.press("double well");
    lab.shows("demo");
    lab.press("\r");
    lab.until("the demo has the screen", |lab| !lab.text().contains("Lessons and demos"));
    lab.press("q");
    lab.shows("Lessons and demos");
    closes(&mut lab);
    // Ctrl-c ends the program from within a lesson too, which is kept where it was
    lab.press("\x1bOQ");
    lab.shows("Lessons and demos");
    lab.press("kepler");
    lab.shows("lesson, begun");
    lab.press("\r");
    lab.shows("Before each thing happens");
    lab.press("\x03");
    assert_eq!(lab.ends().0, 0);
    lab.assert_restored();
}

/// Closes the list of lessons and demos.
#[track_caller]
fn closes(lab: &mut Session) {
    lab.press("\x1b");
    lab.until("the list is closed", |lab| !lab.text().contains("Lessons and demos"));
}
