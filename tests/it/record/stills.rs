//! Stills: well-formed drawings with as many dots as the screen, and the screen's text.

use phaselab::record::screenshot::{ImageFormat, write};
use ratatui::buffer::Buffer;

use super::played;

fn pendulum() -> (Buffer, String) {
    let recording = played("pendulum", "Size 110x32\nCaption \"<A & B> \\\"C\\\"\"\nWait 2s");
    let palette = recording.style.theme.palette();
    let drawing = write(&recording.last, palette, ImageFormat::Svg, "a < b & c");
    (recording.last, drawing)
}

#[test]
fn a_drawing_has_the_dots_of_its_screen() {
    let (screen, drawing) = pendulum();
    let patterns = screen.content.iter().filter_map(|cell| cell.symbol().chars().next());
    let bits = patterns.filter(|c| ('\u{2800}'..='\u{28ff}').contains(c));
    let dots: u32 = bits.map(|c| (c as u32 - 0x2800).count_ones()).sum();
    assert!(dots > 300, "{dots}");
    let document = roxmltree::Document::parse(&drawing).expect("well-formed");
    let circles = document.descendants().filter(|node| node.has_tag_name("circle"));
    assert_eq!(circles.count() as u32, dots);
    // every dot is inside
    let size =
        |name: &str| document.root_element().attribute(name).unwrap().parse::<f64>().unwrap();
    assert_eq!((size("width"), size("height")), (110.0 * 8.0 + 16.0, 32.0 * 16.0 + 16.0));
    for circle in document.descendants().filter(|node| node.has_tag_name("circle")) {
        let place = |name: &str| circle.attribute(name).unwrap().parse::<f64>().unwrap();
        assert!((0.0..880.0).contains(&place("cx")) && (0.0..512.0).contains(&place("cy")));
    }
}

#[test]
fn a_drawing_has_the_words_of_its_screen_and_no_fonts() {
    let (screen, drawing) = pendulum();
    let document = roxmltree::Document::parse(&drawing).expect("well-formed");
    let words = |name: &'static str| {
        document.descendants().filter(move |node| node.has_tag_name(name)).filter_map(|n| n.text())
    };
    assert_eq!(words("title").next(), Some("a < b & c"));
    let written: String = words("text").collect();
    for word in ["phaselab", "Parameters", "<A", "&", "B>", "\"C\""] {
        assert!(written.contains(word), "{word}");
    }
    let messages = |text: &str| text.chars().filter(|c| c.is_alphabetic()).count();
    let shown: String = screen.content.iter().map(ratatui::buffer::Cell::symbol).collect();
    assert_eq!(messages(&written), messages(&shown));
    for refused in ["font-face", "<script", "<style", "href", "data:"] {
        assert!(!drawing.contains(refused), "{refused}");
    }
}

/// Text has no colours to shade a sphere with: it is drawn with dots and lines, as on a screen without colours.
#[test]
fn a_still_in_text_is_drawn_without_colours() {
    let of = |colour: &str| {
        played("free-rigid-body", &format!("Size 120x40\nColor {colour}\nMarker \"a\"\nWait 1s"))
    };
    let (coloured, bare) = (of("true"), of("never"));
    let text = |screen: &Buffer| write(screen, bare.style.theme.palette(), ImageFormat::Text, "");
    assert_ne!(text(&coloured.last), text(&bare.last));
    for (still, other) in [
        (&coloured.last_colourless, &bare.last),
        (&coloured.markers[0].colourless, &bare.markers[0].screen),
    ] {
        assert_eq!(text(still), text(other));
    }
}

/// The disc of radius 0.3 about the start turns rigidly, so the action around it remains its area; friction makes it smaller
/// by e^(−c t/m), of an ellipse of semi-axes 0.3 and 0.6. It does so where nobody asked for it but the file.
#[test]
fn an_ensemble_that_a_file_opens_with_is_carried_in_a_recording() {
    let disc = 0.09 * std::f64::consts::PI;
    let turned = format!("Assert ensemble.action = {disc} within 1e-3");
    let script =
        format!("Size 110x32\nWait 2s\nAssert ensemble.points = 2000 within 0.5\n{turned}\n");
    played("back-to-the-start", &script);
    let script = "Size 110x32\nWait 3s\nAssert ensemble.points = 2000 within 0.5\n\
        Assert ensemble.action = pi*0.18*exp(-c*t/m) within 1e-3\n";
    played("damped-oscillator", script);
}

#[test]
fn text_and_colours_are_those_of_the_screen() {
    let recording = played("pendulum", "Size 80x24\nColor 256\nWait 1s");
    let palette = recording.style.theme.palette();
    let text = write(&recording.last, palette, ImageFormat::Text, "");
    assert_eq!(text.lines().count(), 24);
    let ansi = write(&recording.last, palette, ImageFormat::Ansi, "");
    let mut terminal = vt100::Parser::new(25, 80, 0);
    terminal.process(ansi.replace('\n', "\r\n").as_bytes());
    for y in 0..24 {
        for x in 0..80 {
            let drawn = &recording.last[(x, y)];
            let cell = terminal.screen().cell(y, x).expect("inside");
            let contents = if cell.has_contents() { cell.contents() } else { " " };
            assert_eq!(contents, drawn.symbol(), "at {x}, {y}");
            if let ratatui::style::Color::Indexed(index) = drawn.fg
                && drawn.symbol() != " "
            {
                assert_eq!(cell.fgcolor(), vt100::Color::Idx(index), "at {x}, {y}");
            }
        }
    }
    let rows: Vec<String> = terminal.screen().rows(0, 80).take(24).collect();
    assert_eq!(
        rows.iter().map(|r| r.trim_end()).collect::<Vec<_>>(),
        text.lines().collect::<Vec<_>>()
    );
}
