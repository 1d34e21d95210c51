//! The projector: casts shown at their own speed, whatever their origin.

use std::ops::ControlFlow;
use std::time::Duration;

use crossterm::event::{Event, KeyCode};
use phaselab::diagnostic::Document;
use phaselab::record::{RecordedCast, play_while};
use phaselab::shell::{CastPlayer, NotRecorded, RecordingAhead, Screen, ScreenRequest};
use phaselab::view::RenderStyle;
use phaselab::view::colour::ColourDepth;
use phaselab::view::glyphs::Glyphs;
use phaselab::view::theme::Theme;
use proptest::prelude::*;
use ratatui::buffer::Buffer;
use ratatui::layout::Rect;
use ratatui::style::Color;

use super::{played, script};
use crate::fixtures::catalog;

fn look() -> RenderStyle {
    RenderStyle { theme: Theme::dark(ColourDepth::Ansi256), glyphs: Glyphs::Braille }
}

fn projector(cast: &str) -> CastPlayer {
    CastPlayer::new(RecordedCast::read(cast).expect("a cast"), look())
}

fn shown(projector: &mut CastPlayer, (width, height): (u16, u16)) -> String {
    let mut buffer = Buffer::empty(Rect::new(0, 0, width, height));
    projector.draw(buffer.area, &mut buffer);
    let row = |y| (0..width).map(|x| buffer[(x, y)].symbol().to_owned()).collect::<String>();
    (0..height).map(|y| row(y).trim_end().to_owned()).collect::<Vec<_>>().join("\n")
}

fn press(projector: &mut CastPlayer, code: KeyCode) -> ScreenRequest {
    projector.input(Event::Key(code.into()))
}

/// Lets some milliseconds pass, in frames.
fn pass(projector: &mut CastPlayer, milliseconds: u64) {
    for _ in 0..milliseconds / 20 {
        projector.advance(Duration::from_millis(20));
    }
}

const CAST: &str = "{\"version\":3,\"term\":{\"cols\":30,\"rows\":3}}\n[0.0, \"o\", \"one\"]\n\
                    [1.0, \"m\", \"middle\"]\n[0.0, \"o\", \" two\"]\n[1.0, \"o\", \" three\"]\n";

#[test]
fn a_cast_runs_at_its_pace() {
    let mut it = projector(CAST);
    pass(&mut it, 500);
    assert!(shown(&mut it, (30, 4)).starts_with("one\n\n"));
    pass(&mut it, 600);
    assert!(shown(&mut it, (30, 4)).starts_with("one two\n\n"));
    press(&mut it, KeyCode::Char(' '));
    pass(&mut it, 5000);
    let held = shown(&mut it, (80, 4));
    assert!(
        held.contains("one two\n") && held.contains("‖ 0:01 of 0:02") && held.contains("middle")
    );
    press(&mut it, KeyCode::Char('.'));
    pass(&mut it, 20);
    assert!(shown(&mut it, (30, 4)).contains("one two three"));
    assert!(it.is_over());
    press(&mut it, KeyCode::Home);
    pass(&mut it, 20);
    assert!(shown(&mut it, (30, 4)).starts_with("one\n"));
    press(&mut it, KeyCode::Tab);
    pass(&mut it, 20);
    assert!(shown(&mut it, (30, 4)).starts_with("one two\n"));
    press(&mut it, KeyCode::Char(' '));
    press(&mut it, KeyCode::Home);
    for _ in 0..2 {
        press(&mut it, KeyCode::Char(']'));
    }
    pass(&mut it, 300);
    assert!(shown(&mut it, (30, 4)).starts_with("one two\n"), "four times as fast");
    assert_eq!(press(&mut it, KeyCode::Char('q')), ScreenRequest::Quit);
}

#[test]
fn controls_stand_over_a_cast_as_large_as_the_window_for_a_while() {
    let mut it = projector(CAST);
    let last = |it: &mut CastPlayer| shown(it, (30, 3)).lines().nth(2).unwrap_or("").to_owned();
    assert!(last(&mut it).contains("▶ 0:00 of 0:02"), "{}", last(&mut it));
    // the cast ends before they disappear by themselves
    for _ in 0..3 {
        press(&mut it, KeyCode::Char('['));
    }
    pass(&mut it, 4000);
    assert!(last(&mut it).contains("0:00 of 0:02"));
    pass(&mut it, 2000);
    assert_eq!(last(&mut it), "");
    // any key shows them again, for a shorter time
    press(&mut it, KeyCode::Char('x'));
    assert!(last(&mut it).contains("0:00 of 0:02"));
    pass(&mut it, 3500);
    assert_eq!(last(&mut it), "");
    // and `c` makes them stay, or stay away
    press(&mut it, KeyCode::Char('c'));
    pass(&mut it, 4000);
    assert!(last(&mut it).contains("of 0:02"));
    press(&mut it, KeyCode::Char('c'));
    press(&mut it, KeyCode::Char(' '));
    assert_eq!(last(&mut it), "");
    // if there is a row below the cast they are always there
    press(&mut it, KeyCode::Char('c'));
    assert!(shown(&mut it, (80, 4)).lines().nth(3).is_some_and(|row| row.contains("q quit")));
}

#[test]
fn a_window_too_small_for_a_cast_is_reported() {
    let mut it = projector(CAST);
    let whole = shown(&mut it, (100, 4));
    assert!(!whole.contains("window"), "{whole}");
    let text = shown(&mut it, (20, 2));
    assert!(text.starts_with(" the cast is 30×3, "), "{text}");
    assert!(text.lines().nth(1).is_some_and(|row| row.contains("0:00")), "{text}");
    let mut large = projector(&CAST.replace("\"cols\":30", "\"cols\":200"));
    let text = shown(&mut large, (100, 10));
    let reported = "the cast is 200×3, the window 100×10: enlarge it, or use a smaller font";
    assert!(text.contains(reported), "{text}");
}

#[test]
fn a_recording_looks_as_it_was_drawn() {
    let recording = played("pendulum", "Size 90x28\nColor 256\nCaption \"Hello\"\nWait 2s");
    let last = recording.last.clone();
    let mut it = CastPlayer::new(recording.into(), look());
    pass(&mut it, 2500);
    let mut buffer = Buffer::empty(Rect::new(0, 0, 90, 29));
    it.draw(buffer.area, &mut buffer);
    for y in 0..28 {
        for x in 0..90 {
            let (cell, drawn) = (&buffer[(x, y)], &last[(x, y)]);
            assert_eq!(cell.symbol(), drawn.symbol(), "at {x}, {y}");
            if drawn.symbol() != " " {
                assert_eq!(cell.fg, drawn.fg, "at {x}, {y}");
            }
        }
    }
}

#[test]
fn colours_are_those_the_terminal_has() {
    use Color::{Indexed, Reset, Rgb};
    let cast = "{\"version\":2,\"width\":3,\"height\":1}\n\
                [0, \"o\", \"\\u001b[38;2;255;0;0ma\\u001b[38;5;200mb\\u001b[31mc\"]\n";
    let check = |depth, expected: [Color; 3]| {
        let look = RenderStyle { theme: Theme::dark(depth), glyphs: Glyphs::Braille };
        let mut it = CastPlayer::new(RecordedCast::read(cast).expect("a cast"), look);
        pass(&mut it, 20);
        let mut buffer = Buffer::empty(Rect::new(0, 0, 3, 2));
        it.draw(buffer.area, &mut buffer);
        assert_eq!([0, 1, 2].map(|x| buffer[(x, 0)].fg), expected, "{depth:?}");
    };
    check(ColourDepth::True, [Rgb(255, 0, 0), Indexed(200), Indexed(1)]);
    check(ColourDepth::Ansi256, [Indexed(196), Indexed(200), Indexed(1)]);
    check(ColourDepth::Ansi16, [Reset, Reset, Indexed(1)]);
    check(ColourDepth::None, [Reset, Reset, Reset]);
}

/// Untrusted content of a cast: letters and pieces of sequences.
fn hostile() -> impl Strategy<Value = String> {
    let piece = prop_oneof![
        any::<char>().prop_map(String::from),
        prop::sample::select(vec![
            "\u{1b}",
            "\u{1b}[",
            "\u{1b}]52;c;",
            "\u{1b}P",
            "\u{7}",
            "\u{1b}[?1049h",
            "\u{1b}[65535b",
            "\u{1b}[99999;99999H",
            "\u{1b}[?1003h",
            "\u{1b}[6n",
            "\u{1b}c",
            "漢",
            "e\u{301}",
            "\r\n",
            "\u{1b}[2;1r",
            "\u{1b}[9999L",
            "\u{1b}[9999P",
            "\u{1b}[9999@",
            "\u{9b}31m",
            "\u{1b}#8",
        ])
        .prop_map(str::to_owned),
    ];
    prop::collection::vec(piece, 0..60).prop_map(|pieces| pieces.concat())
}

proptest! {
    #[test]
    fn no_cast_does_harm(
        size in (1..90_u16, 1..30_u16),
        outputs in prop::collection::vec((hostile(), prop::option::of((1..90_u16, 1..30_u16))), 1..6),
        area in (0..100_u16, 0..40_u16),
    ) {
        let (columns, rows) = size;
        let mut cast =
            format!("{{\"version\":3,\"term\":{{\"cols\":{columns},\"rows\":{rows}}}}}\n");
        for (output, resize) in outputs {
            cast += &format!("[0.01, \"o\", {}]\n", serde_json::Value::from(output));
            if let Some((columns, rows)) = resize {
                cast += &format!("[0.01, \"r\", \"{columns}x{rows}\"]\n");
            }
        }
        let mut it = projector(&cast);
        for code in [KeyCode::Right, KeyCode::Home, KeyCode::Char('.'), KeyCode::End, KeyCode::Char(' ')] {
            press(&mut it, code);
            pass(&mut it, 60);
            let mut buffer = Buffer::empty(Rect::new(0, 0, area.0, area.1));
            it.draw(buffer.area, &mut buffer);
            let escapes = buffer.content.iter().filter(|c| c.symbol().contains('\u{1b}')).count();
            prop_assert_eq!(escapes, 0);
        }
        prop_assert_eq!(press(&mut it, KeyCode::Char('q')), ScreenRequest::Quit);
    }
}

#[test]
fn a_bomb_does_not_keep_the_keys_waiting() {
    // each of these asks for 65535 characters
    let bomb = "x\\u001b[65535b".repeat(100_000);
    let mut it = projector(&format!(
        "{{\"version\":2,\"width\":80,\"height\":24}}\n[0, \"o\", \"{bomb}\"]\n"
    ));
    let began = std::time::Instant::now();
    for _ in 0..10 {
        it.advance(Duration::from_millis(20));
    }
    assert_eq!(press(&mut it, KeyCode::Char('q')), ScreenRequest::Quit);
    assert!(began.elapsed() < Duration::from_secs(10), "{:?}", began.elapsed());
}

fn system(name: &str) -> Document {
    catalog().find(name).expect("a preset")
}

/// The script of a second and a half of the pendulum.
const SCRIPT: &str = "Size 60x20\nCaption \"One\"\nWait 1s\nMarker \"Middle\"\nWait 500ms";

#[test]
fn a_demo_is_there_from_its_first_frame_on_and_not_only_when_all_is_computed() {
    let (script, system) = (script(SCRIPT), system("pendulum"));
    let mut heard = Vec::new();
    let first = play_while(&script, &system, ("pendulum", (80, 24)), &mut |so_far| {
        heard.extend(so_far.new.to_vec());
        if heard.is_empty() { ControlFlow::Continue(()) } else { ControlFlow::Break(()) }
    });
    let (recording, whole) = first.expect("a good script");
    assert!(!whole && heard.len() == 1 && recording.events == heard, "{heard:?}");
    assert!(recording.end < 100_000, "nothing after the first frame was computed");
}

#[test]
fn a_cast_that_is_recorded_meanwhile_is_the_one_that_is_recorded_alone() {
    let alone = played("pendulum", SCRIPT);
    let ahead = RecordingAhead::begin(script(SCRIPT), system("pendulum"), "pendulum", (80, 24));
    let mut it = CastPlayer::following(ahead, look());
    assert!(!it.is_over(), "nothing is there yet, and the rest is to come");
    // time passes only as far as there is something to see
    let mut frames = 0;
    while !it.is_over() {
        it.advance(Duration::from_millis(20));
        assert!(!it.is_done());
        let text = shown(&mut it, (80, 21));
        frames += 1;
        assert!(frames < 75 || text.contains("0:0"), "{text}");
        std::thread::yield_now();
    }
    let mut replayed = CastPlayer::new(alone.clone().into(), look());
    pass(&mut replayed, 10_000);
    assert_eq!(shown(&mut it, (80, 20)), shown(&mut replayed, (80, 20)));
    let recorded = it.recorded().expect("it has ended").expect("a good script");
    assert_eq!((recorded.events, recorded.end), (alone.events, alone.end));
}

#[test]
fn a_script_that_proves_wrong_while_it_is_shown_ends_the_show() {
    let wrong = "Wait 100ms\nSet nothing = 1";
    let ahead = RecordingAhead::begin(script(wrong), system("pendulum"), "pendulum", (80, 24));
    let mut it = CastPlayer::following(ahead, look());
    while !it.is_done() {
        it.advance(Duration::from_millis(20));
        std::thread::yield_now();
    }
    match it.recorded() {
        Some(Err(NotRecorded::Script(wrong))) => assert_eq!(wrong.len(), 1, "{wrong:?}"),
        other => panic!("{other:?}"),
    }
}

#[test]
fn a_script_that_is_left_early_says_how_many_of_its_claims_were_not_reached() {
    // an hour, so that it is left on its way; the first claim is false, the other one is never reached
    let long = "Wait 100ms\nAssert t > 1e9\nWait 3500s\nAssert t > 0";
    let ahead = RecordingAhead::begin(script(long), system("pendulum"), "pendulum", (80, 24));
    let mut it = CastPlayer::following(ahead, look());
    // beyond the first second, however far it has come meanwhile
    let has_begun = |text: &str| {
        let clock = |rest: &str| rest.get(1..2) == Some(":") && !rest.starts_with("0:00");
        text.split(" of ").skip(1).any(clock)
    };
    while !has_begun(&shown(&mut it, (80, 25))) {
        it.advance(Duration::from_millis(20));
        std::thread::yield_now();
    }
    match it.recorded() {
        Some(Err(NotRecorded::Left(left))) => {
            assert_eq!((left.claims, left.false_claims.len()), ((1, 2), 1));
            assert!((100_000..3_500_000_000).contains(&left.reached), "{}", left.reached);
        }
        other => panic!("{other:?}"),
    }
}
