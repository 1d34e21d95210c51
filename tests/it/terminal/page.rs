//! The shell by itself, with the small page of `examples/page.rs`.

use std::time::{Duration, Instant};

use rustix::process::Signal;

use super::session::{Session, Setup};

fn started() -> Session {
    let mut page = Setup::page().start();
    page.shows("clock");
    page
}

#[test]
fn quitting_leaves_the_terminal_as_it_was() {
    let mut page = started();
    assert!(page.screen().alternate_screen() && page.screen().hide_cursor());
    assert!(!page.is_cooked());
    page.press("i");
    page.until("pastes are bracketed", |page| page.screen().bracketed_paste());
    page.press("abc");
    page.shows("text [abc]");
    page.press("\r");
    page.until("pastes are plain again", |page| !page.screen().bracketed_paste());
    page.press("q");
    assert_eq!(page.ends().0, 0);
    page.assert_restored();
}

#[test]
fn signals_restore_and_tell_their_number() {
    let signals =
        [(Signal::HUP, 129), (Signal::INT, 130), (Signal::QUIT, 131), (Signal::TERM, 143)];
    for (signal, status) in signals {
        let mut page = started();
        page.press("i");
        page.until("pastes are bracketed", |page| page.screen().bracketed_paste());
        page.signal(signal);
        let (ended, took) = page.ends();
        assert_eq!(ended, status, "{signal:?}");
        assert!(took < Duration::from_millis(200), "{signal:?} took {took:?}");
        page.assert_restored();
    }
}

/// Stops the page, checks the terminal and continues it.
fn check_stop(stop: impl Fn(&mut Session)) {
    let mut page = started();
    for _ in 0..2 {
        stop(&mut page);
        page.stops();
        page.until("the screen is given back", |page| !page.screen().alternate_screen());
        page.assert_restored();
        let before = page.sent.len();
        page.signal(Signal::CONT);
        page.until("everything is painted again", |page| {
            let after = String::from_utf8_lossy(&page.sent[before..]).into_owned();
            after.contains("\x1b[2J") && page.text().contains("clock")
        });
        assert!(page.screen().alternate_screen() && page.screen().hide_cursor());
        assert!(!page.is_cooked());
    }
    page.press("q");
    assert_eq!(page.ends().0, 0);
    page.assert_restored();
}

#[test]
fn a_key_stops_it() {
    check_stop(|page| page.press("z"));
}

#[test]
fn a_signal_stops_it() {
    check_stop(|page| page.signal(Signal::TSTP));
}

#[test]
fn a_stop_that_cannot_be_caught_is_survived() {
    let mut page = started();
    page.signal(Signal::STOP);
    page.stops();
    let before = page.sent.len();
    page.signal(Signal::CONT);
    page.until("everything is painted again", |page| {
        String::from_utf8_lossy(&page.sent[before..]).contains("\x1b[2J")
    });
    page.press("q");
    assert_eq!(page.ends().0, 0);
    page.assert_restored();
}

#[test]
fn a_panic_is_read_on_a_restored_terminal() {
    let mut page = started();
    page.press("p");
    assert_eq!(page.ends().0, 101);
    page.assert_restored();
    assert!(page.text().contains("the clock fell off the wall"), "{}", page.text());
    assert!(page.text().contains("examples/page.rs"), "{}", page.text());
}

#[test]
#[cfg(target_os = "linux")]
fn a_panic_that_nobody_can_read_about_restores_as_well() {
    let mut page = Setup::page_under("exec \"$0\" 2> /dev/full").start();
    page.shows("clock");
    page.press("p");
    assert_eq!(page.ends().0, 101);
    page.assert_restored();
}

#[test]
fn a_panic_caught_on_another_thread_does_not_touch_the_screen() {
    let mut page = started();
    page.press("t");
    page.shows("caught: true");
    assert!(!page.sent().contains("somebody else's clock"));
    assert!(page.screen().alternate_screen());
    page.press("\x1bq");
    page.until("esc is told from alt", |page| page.text().contains("inputs 3"));
    page.press("\x1b");
    page.until("the text is gone", |page| !page.text().contains("caught"));
    page.press("q");
    assert_eq!(page.ends().0, 0);
    page.assert_restored();
}

#[test]
fn a_dead_line_ends_it() {
    let mut child = started().hang_up();
    let start = Instant::now();
    let status = child.wait().expect("a child of ours");
    assert_eq!(status.exit_code(), 129);
    assert!(start.elapsed() < Duration::from_secs(2));
}

#[test]
#[cfg(target_os = "linux")]
fn a_dead_line_ends_it_without_a_signal() {
    // In a separate session it gets no SIGHUP, and must detect by itself that the terminal is gone.
    let folder = tempfile::tempdir().expect("a folder");
    let report = folder.path().join("status");
    let line = "trap '' HUP; setsid --wait \"$0\"; echo $? > \"$1\"";
    let mut page = Setup::page_under(line).argument(&report).start();
    page.shows("clock");
    let start = Instant::now();
    page.hang_up().wait().expect("a child of ours");
    assert_eq!(std::fs::read_to_string(report).expect("a report"), "129\n");
    assert!(start.elapsed() < Duration::from_secs(2));
}

#[test]
fn a_stalled_terminal_does_not_hold_it() {
    let mut page = Setup::page().size(200, 60).start();
    page.shows("clock");
    page.press("f");
    let (status, took) = page.stalled(|page| {
        // Long enough for frames of 12 kB to fill the buffers between both ends.
        std::thread::sleep(Duration::from_secs(1));
        page.press("q");
        page.ends()
    });
    assert_eq!(status, 0);
    assert!(took < Duration::from_secs(1), "{took:?}");
    page.quiet(Duration::from_millis(200));
    page.assert_restored();
}

#[test]
fn a_storm_of_sizes_ends_in_a_whole_picture() {
    let mut page = Setup::page().start();
    page.shows("clock");
    page.press(" ");
    let mut seed = 1_u32;
    let mut random = || {
        seed = seed.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
        (seed >> 16) as u16 % 500
    };
    for step in 0..500 {
        match step % 100 {
            0 => page.resize(0, 0),
            1 => page.resize(1, 1),
            2 => page.resize(500, 500),
            _ => page.resize(random(), random()),
        }
    }
    page.resize(64, 9);
    page.shows("size 64x9");
    page.quiet(Duration::from_millis(200));
    let sent = page.sent();
    let mut screen = vt100::Parser::new(9, 64, 0);
    screen.process(&sent.as_bytes()[sent.rfind("\x1b[2J").expect("painted anew")..]);
    let lines: Vec<_> = screen.screen().rows(0, 64).collect();
    assert!(lines[0].starts_with("clock") && lines[2] == "size 64x9", "{lines:#?}");
    assert_eq!(lines[8], format!("{:>64}", "#"));
    page.press("q");
    assert_eq!(page.ends().0, 0);
}

#[test]
fn a_size_that_came_back_is_painted_anew() {
    let mut page = started();
    page.press(" ");
    page.quiet(Duration::from_millis(200));
    let before = page.sent.len();
    page.resize(40, 12);
    page.resize(80, 24);
    page.until("everything is painted again", |page| {
        String::from_utf8_lossy(&page.sent[before..]).contains("\x1b[2J")
    });
    page.press("q");
    assert_eq!(page.ends().0, 0);
}

#[test]
fn a_terminal_without_a_size_gets_the_usual_one() {
    let mut page = Setup::page().size(0, 0).start();
    page.shows("size 80x24");
    page.press("q");
    assert_eq!(page.ends().0, 0);
}

#[test]
fn nothing_is_sent_when_nothing_changes() {
    let mut page = started();
    page.press(" ");
    page.quiet(Duration::from_millis(300));
    assert_eq!(page.bytes_in(Duration::from_secs(1)), 0);
    page.press("q");
    page.ends();
}

#[test]
fn frames_are_whole_and_ask_nothing() {
    let mut page = started();
    page.bytes_in(Duration::from_millis(500));
    page.press("q");
    page.ends();
    let sent = page.sent();
    let body = &sent[sent.find("\x1b[?2026h").expect("a frame")..];
    let (frames, end) = body.rsplit_once("\x1b[?2026l").expect("the restoring ends it");
    for frame in frames.trim_end_matches("\x1b[?2026l").split("\x1b[?2026l") {
        assert!(frame.starts_with("\x1b[?2026h"), "{frame:?}");
        assert_eq!(frame.matches("\x1b[?2026").count(), 1, "{frame:?}");
    }
    assert_eq!(end, "\x1b[0m\x1b[?1004l\x1b[?25h\x1b[?1049l");
    for question in ["6n", "[c", "[0c", "[>", "]10", "]11", "?u", "\x1bP"] {
        assert!(!sent.contains(question), "{question:?} was sent");
    }
    for mode in ["1000h", "1002h", "1003h", "1006h", "2004h"] {
        assert!(!sent.contains(mode), "{mode} was set");
    }
}

/// A page with mouse reporting.
fn pointed_at() -> Session {
    let mut page = started();
    page.press("M");
    page.until("the mouse is reported", |page| {
        page.screen().mouse_protocol_mode() == vt100::MouseProtocolMode::ButtonMotion
            && page.screen().mouse_protocol_encoding() == vt100::MouseProtocolEncoding::Sgr
    });
    page
}

#[test]
fn the_mouse_is_reported_only_while_it_is_wanted() {
    let mut page = started();
    page.press("\x1b[<0;5;3M");
    page.until("the report is read", |page| page.text().contains("inputs 1"));
    assert!(!page.text().contains("Down"), "{}", page.text());

    let mut page = pointed_at();
    for (report, shown) in [
        ("\x1b[<0;5;3M", "Down(Left) 4 2"),
        ("\x1b[<32;80;24M", "Drag(Left) 79 23"),
        ("\x1b[<0;80;24m", "Up(Left) 79 23"),
        ("\x1b[<64;1;1M", "ScrollUp 0 0"),
        ("\x1b[<0;0;0M\x1b[<0;81;1M\x1b[<65;99999;99999M\x1b[<0;2;1M", "Down(Left) 1 0"),
    ] {
        page.press(report);
        page.shows(shown);
    }
    page.press("\rM");
    page.until("it is left alone", |page| {
        page.screen().mouse_protocol_mode() == vt100::MouseProtocolMode::None
    });
    let mouse = ["1000", "1002", "1003", "1006"];
    assert!(page.modes_on().iter().all(|mode| !mouse.contains(&mode.as_str())));
    page.press("q");
    assert_eq!(page.ends().0, 0);
    page.assert_restored();
}

#[test]
fn the_mouse_is_left_alone_on_every_way_out() {
    for (key, status) in [("q", 0), ("p", 101)] {
        let mut page = pointed_at();
        page.press(key);
        assert_eq!(page.ends().0, status);
        page.assert_restored();
    }
    let mut page = pointed_at();
    page.signal(Signal::TERM);
    assert_eq!(page.ends().0, 143);
    page.assert_restored();

    let mut page = pointed_at();
    page.press("z");
    page.stops();
    page.until("the screen is given back", |page| !page.screen().alternate_screen());
    page.assert_restored();
    page.signal(Signal::CONT);
    page.until("it is reported again", |page| {
        page.screen().mouse_protocol_mode() == vt100::MouseProtocolMode::ButtonMotion
    });
}

#[test]
fn a_window_that_nobody_looks_at_gets_few_frames() {
    let mut page = started();
    assert!(page.modes_on().contains(&"1004".to_owned()));
    page.press("\x1b[O");
    page.quiet(Duration::from_millis(300));
    let frames = page.frames_in(Duration::from_secs(2));
    assert!((1..=5).contains(&frames), "{frames} frames in two seconds");
    let shown = page.text();
    page.until("the clock goes on", |page| page.text() != shown);
    page.press("\x1b[I");
    let before = page.sent.len();
    // Two per second would exceed the time limit here.
    page.until("frames come fast again", |page| {
        String::from_utf8_lossy(&page.sent[before..]).matches("\x1b[?2026h").count() > 50
    });
    page.press("q");
    assert_eq!(page.ends().0, 0);
    page.assert_restored();
}

/// All that has come is taken before anything is drawn: between a flood and the end there is hardly a frame.
#[test]
fn floods_do_not_keep_it_from_ending() {
    for (length, most) in [(1023, 2), (1024, 2), (4000, 2), (100_000, 40)] {
        let mut page = started();
        page.press(" ");
        page.quiet(Duration::from_millis(200));
        let before = page.sent.len();
        page.press(&("x".repeat(length) + "q"));
        assert_eq!(page.ends().0, 0, "{length}");
        let since = String::from_utf8_lossy(&page.sent[before..]);
        let frames = since.matches("\x1b[?2026h").count();
        assert!(frames <= most, "{frames} frames after {length} bytes");
        assert!(since.len() < 5000, "{length}");
    }
}

#[test]
fn noise_does_not_keep_it_from_ending() {
    for noise in ["\x1b[<0;0;0M", "\x1b]0;title", "\x1bP", "\x1b[", "\x1b[200~", "\x1b_\x1b[99999;"]
    {
        let mut page = started();
        page.press(noise);
        // An incomplete sequence may swallow a key, until a pause ends it.
        assert_eq!(page.press_until_it_ends("q"), 0, "{noise:?}");
        page.assert_restored();
    }
}

#[test]
fn a_paste_that_never_ends_does_not_keep_it() {
    let mut page = started();
    page.press("i");
    page.until("pastes are bracketed", |page| page.screen().bracketed_paste());
    page.press("\x1b[200~never");
    page.shows("text [never]");
    page.press("\rq");
    assert_eq!(page.ends().0, 0);
    page.assert_restored();
}

#[test]
fn a_report_that_never_ends_does_not_keep_it() {
    for report in ["\x1b[<", "\x1b[<0;1", "\x1b[M", "\x1b[?2026;2$"] {
        let mut page = pointed_at();
        page.press(report);
        assert_eq!(page.press_until_it_ends("q"), 0, "{report:?}");
        page.assert_restored();
    }
}

#[test]
fn without_a_terminal_there_is_a_sentence() {
    let mut page = Setup::page().variable("TERM", "dumb").start();
    assert_eq!(page.ends().0, 2);
    assert!(page.text().contains("terminal"), "{}", page.text());
    assert!(!page.sent().contains('\x1b'));
}
