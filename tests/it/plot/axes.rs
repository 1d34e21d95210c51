//! Axes on a buffer: text and styles.

use phaselab::view::colour::ColourDepth;
use phaselab::view::glyphs::Glyphs;
use phaselab::view::plot::{Axes, DrawnAxis, PlotFrame, Scale};
use phaselab::view::theme::{Role, Theme};
use ratatui::buffer::Buffer;
use ratatui::layout::Rect;
use ratatui::style::{Color, Modifier};

use super::rows;

fn pendulum() -> Axes {
    Axes::new(
        DrawnAxis::new("θ", "rad", Scale::turn()),
        DrawnAxis::new("p_θ", "kg m²/s", Scale::linear(-3.0, 3.0)),
    )
}

fn drawn(axes: &Axes, area: Rect, glyphs: Glyphs, depth: ColourDepth) -> (Buffer, PlotFrame) {
    let mut buffer = Buffer::empty(area);
    let frame = axes.draw(area, &mut buffer, &Theme::dark(depth), glyphs);
    (buffer, frame)
}

#[test]
fn a_phase_portraits_axes() {
    let area = Rect::new(0, 0, 44, 11);
    let (buffer, frame) = drawn(&pendulum(), area, Glyphs::Braille, ColourDepth::True);
    assert_eq!(
        rows(&buffer),
        [
            "p_θ [kg m²/s]",
            "   │                    ┊",
            "  2┤                    ┊",
            "   │                    ┊",
            "   │                    ┊",
            "  0┤┈┈┈┈┈┈┈┈┈┈┈┈┈┈┈┈┈┈┈┈┊┈┈┈┈┈┈┈┈┈┈┈┈┈┈┈┈┈┈┈",
            "   │                    ┊",
            " −2┤                    ┊",
            "   │                    ┊",
            "   └┬─────────┬─────────┬─────────┬─ θ [rad]",
            "   −π       −π/2        0        π/2       π",
        ]
    );
    assert_eq!(frame.area, Rect::new(4, 1, 40, 8));
    assert_eq!(frame, pendulum().frame(area, Glyphs::Braille), "the mouse finds the same frame");
}

/// The labels of a vertical axis without a name share a power of ten too, and it is said; plain labels leave the row to the plot.
#[test]
fn an_axis_without_a_name_says_its_power_of_ten() {
    let area = Rect::new(0, 0, 44, 11);
    let several = |size: f64| {
        let y = DrawnAxis::new("", "", Scale::linear(-size, size));
        Axes::new(DrawnAxis::new("t", "s", Scale::linear(0.0, 1.0)), y)
    };
    for (size, first) in [(3e-5, "×10⁻⁵"), (3e7, "×10⁷")] {
        let axes = several(size);
        let (buffer, frame) = drawn(&axes, area, Glyphs::Braille, ColourDepth::True);
        assert_eq!(rows(&buffer)[0].trim(), first, "{size:e}");
        assert_eq!(frame.area.y, 1);
        assert_eq!(frame, axes.frame(area, Glyphs::Braille), "the mouse finds the same frame");
    }
    assert_eq!(several(3.0).frame(area, Glyphs::Braille).area.y, 0);
}

#[test]
fn axes_wear_the_styles_of_their_roles() {
    let area = Rect::new(0, 0, 44, 11);
    let theme = Theme::dark(ColourDepth::True);
    let (buffer, _) = drawn(&pendulum(), area, Glyphs::Braille, ColourDepth::True);
    assert_eq!(Some(buffer[(3, 3)].fg), theme[Role::Border].fg, "the line");
    assert_eq!(Some(buffer[(2, 2)].fg), theme[Role::Dim].fg, "a label");
    assert_eq!(Some(buffer[(10, 5)].fg), theme[Role::Border].fg, "the zero line");
    assert_eq!(buffer[(0, 0)].fg, Color::Reset, "the title is text");
}

#[test]
fn in_ascii_all_is_ascii() {
    let area = Rect::new(0, 0, 44, 9);
    let (buffer, _) = drawn(&pendulum(), area, Glyphs::Ascii, ColourDepth::True);
    assert_eq!(
        rows(&buffer),
        [
            "p_theta [kg m^2/s]",
            "   |                    .",
            "  2+                    .",
            "   |                    .",
            "  0+. . . . . . . . . . . . . . . . . . . .",
            "   |                    .",
            " -2+                    .",
            "   ++---------+---------+------- theta [rad]",
            "   -pi      -pi/2       0       pi/2      pi",
        ]
    );
}

#[test]
fn without_colour_there_are_only_weights() {
    let area = Rect::new(0, 0, 44, 9);
    let (buffer, _) = drawn(&pendulum(), area, Glyphs::Braille, ColourDepth::None);
    for cell in buffer.content() {
        assert_eq!((cell.fg, cell.bg), (Color::Reset, Color::Reset));
    }
    assert_eq!(buffer[(3, 1)].modifier, Modifier::DIM);
}

#[test]
fn a_power_of_ten_moves_into_the_title() {
    let axes = Axes::new(
        DrawnAxis::new("t", "s", Scale::linear(0.0, 10.0)),
        DrawnAxis::new("ΔE", "J", Scale::linear(0.0, 4e-9)),
    );
    let area = Rect::new(0, 0, 40, 10);
    let (buffer, _) = drawn(&axes, area, Glyphs::Braille, ColourDepth::True);
    assert_eq!(rows(&buffer)[0], "ΔE [J] ×10⁻⁹");
    let (buffer, _) = drawn(&axes, area, Glyphs::Ascii, ColourDepth::True);
    assert_eq!(rows(&buffer)[0], "DeltaE [J] x1e-9");
}

#[test]
fn equal_axes_have_equal_units() {
    let scale = Scale::linear(-1.0, 1.0);
    let axes = Axes::new(DrawnAxis::new("x", "m", scale), DrawnAxis::new("y", "m", scale)).equal();
    let frame = axes.frame(Rect::new(0, 0, 90, 30), Glyphs::Braille);
    let across = (frame.x.hi - frame.x.lo) / f64::from(frame.area.width);
    let up = (frame.y.hi - frame.y.lo) / (2.0 * f64::from(frame.area.height));
    assert!((across / up - 1.0).abs() < 1e-12);
}

#[test]
fn a_small_pane_is_all_plot() {
    let area = Rect::new(3, 2, 12, 4);
    assert_eq!(pendulum().frame(area, Glyphs::Braille).area, area);
}

#[test]
fn labels_keep_apart_and_inside() {
    for width in 16..120 {
        let area = Rect::new(0, 0, width, 12);
        let axes = Axes::new(
            DrawnAxis::new("t", "s", Scale::linear(1_000.0, 1_000.4)),
            DrawnAxis::new("x", "m", Scale::linear(-0.001, 0.001)),
        );
        let (buffer, _) = drawn(&axes, area, Glyphs::Ascii, ColourDepth::True);
        let last = rows(&buffer)[11].clone();
        let labels: Vec<f64> = last.split_whitespace().map(|l| l.parse().unwrap()).collect();
        assert!(!labels.is_empty() && labels.is_sorted(), "{last}");
        assert!(labels.iter().all(|label| (1_000.0..=1_000.4).contains(label)), "{last}");
    }
}

#[test]
fn ticks_that_share_a_row_have_one_label() {
    let axes = Axes::new(
        DrawnAxis::new("t", "s", Scale::linear(0.0, 10.0)),
        DrawnAxis::new("x", "m", Scale::linear(-6.0, 6.0)),
    );
    for height in 5..12 {
        let area = Rect::new(0, 0, 40, height);
        let (buffer, _) = drawn(&axes, area, Glyphs::Ascii, ColourDepth::True);
        let labels: Vec<String> = rows(&buffer)[1..usize::from(height) - 2]
            .iter()
            .filter_map(|row| Some(row.split_once('+')?.0.trim().to_owned()))
            .collect();
        assert!(!labels.is_empty(), "{height}");
        let plain =
            |label: &String| ["-6", "-5", "-4", "-2", "0", "2", "4", "5", "6"].contains(&&**label);
        assert!(labels.iter().all(plain), "{height}: {labels:?}");
    }
}
