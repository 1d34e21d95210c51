//! Performances: the same as recordings, at the speed of the viewer.

use phaselab::diagnostic::Document;
use phaselab::preset::Catalog;
use phaselab::record::{ScriptRunner, play};
use phaselab::view::RenderStyle;
use ratatui::buffer::{Buffer, Cell};
use ratatui::layout::Rect;

use super::{recorded, script};

const SCRIPT: &str = "Size 90x28\nCaption \"It swings\"\nPress Down x2\nSweep g to 20 in 1s\n\
                      Marker \"Middle\"\nWait 1s\nAssert g = 1 within 0\nPress 2\nWait 0.5s";

fn performance(text: &str) -> (ScriptRunner, RenderStyle) {
    let system = Catalog::with_folder(None).find("pendulum").expect("a preset");
    let script = script(text);
    let look = script.head.render_style();
    (ScriptRunner::watched(script, &system, "pendulum").expect("it can be opened"), look)
}

/// Advances to a time in irregular frames; returns the screen and whether there is more to come.
fn watched(
    it: &mut ScriptRunner,
    look: &RenderStyle,
    times: impl Iterator<Item = u64>,
) -> (Buffer, bool) {
    let mut screen = Buffer::empty(Rect::new(0, 0, 90, 28));
    let mut more = true;
    for time in times {
        more = it.continue_to(time).expect("no errors");
        screen.reset();
        it.draw(look, screen.area, &mut screen);
    }
    (screen, more)
}

#[test]
fn what_is_watched_is_what_is_recorded() {
    let recording = recorded("pendulum", SCRIPT);
    let (mut it, look) = performance(SCRIPT);
    let middle = recording.markers[0].time;
    let (screen, more) = watched(&mut it, &look, (0..=middle).step_by(10_000).chain([middle]));
    assert!(more);
    assert_eq!(screen, recording.markers[0].screen);
    // the rest in a single step, and beyond the end
    let (screen, more) =
        watched(&mut it, &look, [recording.end, recording.end + 50_000].into_iter());
    assert!(!more, "it ends by itself");
    let text = |buffer: &Buffer| buffer.content.iter().map(Cell::symbol).collect::<String>();
    assert_eq!(text(&screen), text(&recording.last));
    assert_eq!(it.now(), recording.end);
}

#[test]
fn captions_are_broken_where_the_screen_is_narrow() {
    let long =
        "The separatrix leads to the top and never arrives; a little faster, and it goes over";
    let (mut it, look) = performance(&format!("Size 110x30\nCaption \"{long}\"\nWait 1s"));
    it.continue_to(0).expect("no errors");
    let mut screen = Buffer::empty(Rect::new(0, 0, 60, 24));
    it.draw(&look, screen.area, &mut screen);
    let row = |y: u16| (0..60).map(|x| screen[(x, y)].symbol()).collect::<String>();
    assert_eq!(row(22).trim(), "▌ The separatrix leads to the top and never arrives; a");
    assert_eq!(row(23).trim(), "▌ little faster, and it goes over");
}

#[test]
fn a_screen_of_no_size_is_none_of_its_business() {
    for (width, height) in [(0, 0), (1, 1), (39, 9), (300, 2), (3, 100)] {
        let (mut it, look) = performance(SCRIPT);
        let mut screen = Buffer::empty(Rect::new(0, 0, width, height));
        for time in [0, 300_000] {
            it.continue_to(time).expect("no errors");
            it.draw(&look, screen.area, &mut screen);
        }
    }
}

/// A recording runs unattended and has a budget; whoever watches may leave.
#[test]
fn a_motion_too_slow_to_be_recorded_is_given_up_after_twenty_frames_and_is_watched_as_long_as_one_likes()
 {
    let text = "title = \"A spring\"\n[coordinates]\nx = { initial = 1.0 }\n[lagrangian]\n\
                L = \"1/2*x'^2 - 1/2*x^2\"\n[run]\nmethod = \"leapfrog\"\nstep = 1e-12\n";
    let spring = Document::new("spring.toml", text);
    let recorded = |seconds: &str| {
        let script = script(&format!("Fps 20\nWait {seconds}s"));
        play(&script, &spring, "spring", (80, 24)).map(|recording| recording.frames)
    };
    assert!(recorded("0.5").is_ok_and(|frames| frames >= 10));
    let why = recorded("1.5").expect_err("it is overdue");
    let part = "20 frames took 100000 steps each and led only to t = ";
    assert!(why.len() == 1 && why[0].message.contains(part), "{why:?}");
    let watched = script("Fps 20\nWait 1.5s");
    let mut watched = ScriptRunner::watched(watched, &spring, "spring").expect("it can be opened");
    assert!(watched.continue_to(1_400_000).expect("no errors"));
}
