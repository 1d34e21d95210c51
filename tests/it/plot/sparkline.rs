//! Sparklines: histories and range bars, with numbers and with NaN.

use phaselab::view::glyphs::Glyphs;
use phaselab::view::plot::Scale;
use phaselab::view::sparkline::{ColumnValue, RangeBar, Sparkline};
use ratatui::buffer::Buffer;
use ratatui::layout::Rect;
use ratatui::style::{Color, Style};
use ratatui::widgets::Widget;

use super::rows;

fn history(values: &[f64], scale: Scale, width: u16, glyphs: Glyphs) -> String {
    shown(values, ColumnValue::Greatest, scale, (width, glyphs))
}

fn shown(
    values: &[f64],
    column: ColumnValue,
    scale: Scale,
    (width, glyphs): (u16, Glyphs),
) -> String {
    let mut buffer = Buffer::empty(Rect::new(0, 0, width, 1));
    let history = Sparkline { values, column, scale, style: Style::new(), glyphs };
    history.render(buffer.area, &mut buffer);
    rows(&buffer).concat()
}

fn bar(value: f64, glyphs: Glyphs) -> Buffer {
    let mut buffer = Buffer::empty(Rect::new(0, 0, 11, 1));
    let (filled, rest) = (Style::new().fg(Color::Cyan), Style::new().fg(Color::DarkGray));
    RangeBar { value, scale: Scale::linear(0.0, 10.0), filled, rest, glyphs }
        .render(buffer.area, &mut buffer);
    buffer
}

#[test]
fn a_history_rises_with_its_values_and_ends_at_the_right() {
    let scale = Scale::linear(0.0, 8.0);
    assert_eq!(history(&[0.5, 2.5, 4.5, 7.5], scale, 6, Glyphs::Braille), "  ▁▃▅█");
    assert_eq!(history(&[0.5, 2.5, 4.5, 7.5], scale, 4, Glyphs::Ascii), ".-+@");
}

#[test]
fn a_long_history_shows_the_greatest_of_each_share() {
    let mut values = vec![0.0; 100];
    values[42] = 8.0;
    assert_eq!(history(&values, Scale::linear(0.0, 8.0), 4, Glyphs::Braille), "▁█▁▁");
}

/// One swing in eight columns goes up, down to the bottom, and back; many in each column stay about their mean. The greatest of each
/// column would be at the top.
#[test]
fn what_swings_rises_and_falls_about_its_mean() {
    let sine = |swings: f64| -> Vec<f64> {
        (0..128).map(|i| (f64::from(i) / 128.0 * swings * std::f64::consts::TAU).sin()).collect()
    };
    let look = (8, Glyphs::Braille);
    let mean = |swings| shown(&sine(swings), ColumnValue::Mean, Scale::linear(-1.0, 1.0), look);
    // the means over eighths of a turn are ±0.373 and ±0.900
    assert_eq!(mean(1.0), "▆██▆▃▁▁▃");
    let fast = mean(32.0);
    assert!(fast.chars().all(|c| "▄▅".contains(c)), "{fast}");
    assert_eq!(history(&sine(32.0), Scale::linear(-1.0, 1.0), 8, Glyphs::Braille), "████████");
    let gaps = [f64::NAN, f64::NAN, 1.0, f64::NAN];
    assert_eq!(
        shown(&gaps, ColumnValue::Mean, Scale::linear(0.0, 1.0), (2, Glyphs::Braille)),
        " █"
    );
}

#[test]
fn gaps_stay_empty_and_what_is_out_of_range_stops_at_the_end() {
    let values = [f64::NAN, -1.0, f64::INFINITY, f64::NEG_INFINITY, 1e300];
    assert_eq!(history(&values, Scale::linear(0.0, 1.0), 5, Glyphs::Braille), " ▁█▁█");
    let drifts = [0.0, 1e-16, 1e-12, 1e-8];
    assert_eq!(history(&drifts, Scale::log(1e-16, 1e-8), 4, Glyphs::Braille), "▁▁▅█");
}

#[test]
fn a_bar_has_its_knob_at_the_value() {
    let buffer = bar(4.0, Glyphs::Braille);
    assert_eq!(rows(&buffer), ["━━━━●──────"]);
    assert_eq!(buffer[(4, 0)].fg, Color::Cyan);
    assert_eq!(buffer[(5, 0)].fg, Color::DarkGray);
    assert_eq!(rows(&bar(0.0, Glyphs::Ascii)), ["o----------"]);
    assert_eq!(rows(&bar(10.0, Glyphs::Ascii)), ["==========o"]);
}

#[test]
fn a_bar_says_when_its_value_is_outside_or_none() {
    assert_eq!(rows(&bar(-0.1, Glyphs::Braille)), ["◂──────────"]);
    assert_eq!(rows(&bar(10.000_000_1, Glyphs::Braille)), ["━━━━━━━━━━▸"]);
    assert_eq!(rows(&bar(f64::INFINITY, Glyphs::Ascii)), ["==========>"]);
    assert_eq!(rows(&bar(f64::NAN, Glyphs::Ascii)), ["-----------"]);
}
