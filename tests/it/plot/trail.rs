//! Trails: they fade, thin out without colour, and are split where an angle wraps.

use std::f64::consts::{PI, TAU};

use phaselab::view::colour::{ColourDepth, Rgb};
use phaselab::view::glyphs::Glyphs;
use phaselab::view::plot::{Pen, PlotFrame, Raster, Scale};
use phaselab::view::theme::Theme;
use ratatui::buffer::Buffer;
use ratatui::layout::Rect;
use ratatui::style::{Modifier, Style};

use super::{dots, draw_trail, rows, unit};

#[test]
fn a_trail_brightens_towards_its_end() {
    let area = Rect::new(0, 0, 40, 1);
    for depth in [ColourDepth::True, ColourDepth::Ansi256, ColourDepth::Ansi16] {
        let theme = Theme::dark(depth);
        let points: Vec<_> = (0..400).map(|i| [f64::from(i) / 400.0, 0.5]).collect();
        let mut raster = Raster::new(area, Glyphs::Braille);
        draw_trail(&mut raster, Glyphs::Braille, &unit(area), &points, theme.trail(0));
        let mut buffer = Buffer::empty(area);
        raster.draw(&mut buffer);
        let light: Vec<_> =
            (0..40).map(|x| Rgb::of(buffer[(x, 0)].fg).unwrap().luminance()).collect();
        assert!(light.is_sorted(), "{depth:?}: {light:?}");
        assert!(light[39] > 2.0 * light[0], "{depth:?}");
    }
}

#[test]
fn without_colour_the_old_end_is_thin_and_dim_and_the_new_end_full_and_bold() {
    let area = Rect::new(0, 0, 80, 1);
    let theme = Theme::dark(ColourDepth::None);
    let points: Vec<_> = (0..800).map(|i| [f64::from(i) / 800.0, 0.5]).collect();
    let mut raster = Raster::new(area, Glyphs::Braille);
    draw_trail(&mut raster, Glyphs::Braille, &unit(area), &points, theme.trail(0));
    let count = |from: i32, to: i32| {
        dots(&raster).into_iter().filter(|[x, _]| (from..to).contains(x)).count()
    };
    assert!(count(0, 40) < 24, "of 40 dots {} are drawn", count(0, 40));
    assert!(count(0, 40) > 4, "but it does not vanish");
    assert_eq!(count(120, 160), 40);
    let mut buffer = Buffer::empty(area);
    raster.draw(&mut buffer);
    assert_eq!(buffer[(79, 0)].modifier, Modifier::BOLD);
    let oldest = (0..10).find(|x| buffer[(*x, 0)].symbol() != " ").unwrap();
    assert_eq!(buffer[(oldest, 0)].modifier, Modifier::DIM);
}

#[test]
fn in_ascii_age_chooses_the_character() {
    let area = Rect::new(0, 0, 16, 1);
    let theme = Theme::dark(ColourDepth::True);
    let points: Vec<_> = (0..160).map(|i| [(f64::from(i) + 0.5) / 160.0, 0.5]).collect();
    let mut raster = Raster::new(area, Glyphs::Ascii);
    draw_trail(&mut raster, Glyphs::Ascii, &unit(area), &points, theme.trail(0));
    let mut buffer = Buffer::empty(area);
    raster.draw(&mut buffer);
    assert_eq!(rows(&buffer), ["....::::++++oooo"]);
}

#[test]
fn a_single_point_is_new() {
    let area = Rect::new(0, 0, 1, 1);
    let theme = Theme::dark(ColourDepth::True);
    let mut raster = Raster::new(area, Glyphs::Braille);
    draw_trail(&mut raster, Glyphs::Braille, &unit(area), &[[0.5, 0.5]], theme.trail(2));
    let mut buffer = Buffer::empty(area);
    raster.draw(&mut buffer);
    assert_eq!(Some(buffer[(0, 0)].fg), theme.trail(2).last().unwrap().style.fg);
}

/// The longest run of dots in any row, and the number of dots.
fn longest_run(raster: &Raster) -> (usize, usize) {
    let [wide, high] = raster.size();
    let mut longest = 0;
    for y in 0..high {
        let row: Vec<bool> = (0..wide).map(|x| raster.is_set([x, y])).collect();
        longest = row.split(|set| !set).map(<[bool]>::len).max().unwrap_or(0).max(longest);
    }
    (longest, raster.count())
}

#[test]
fn a_rotating_pendulum_leaves_no_stroke_across_the_plot() {
    let area = Rect::new(0, 0, 60, 20);
    let frame = PlotFrame::new(Scale::turn(), Scale::linear(1.0, 4.0), area);
    // p²/2 − cos θ = 3, several turns to the right; the angle is not wrapped.
    let turns = (0..4000).map(|i| f64::from(i) * TAU / 1000.0);
    let right: Vec<_> = turns.map(|q: f64| [q, (2.0 * (3.0 + q.cos())).sqrt()]).collect();
    let left: Vec<_> = right.iter().map(|[q, p]| [-q, *p]).collect();
    // The same orbit as another program would give it, already wrapped into one turn.
    let wrapped: Vec<_> = right.iter().map(|[q, p]| [(q + PI).rem_euclid(TAU) - PI, *p]).collect();
    for points in [right, left, wrapped] {
        let mut raster = Raster::new(area, Glyphs::Braille);
        raster.polyline(&frame, points, &Pen::new(Style::new(), 0));
        let (longest, count) = longest_run(&raster);
        assert!(longest < 40, "a run of {longest} dots");
        assert!((120..170).contains(&count), "one curve from edge to edge has {count} dots");
        let columns: std::collections::BTreeSet<_> =
            dots(&raster).into_iter().map(|[x, _]| x).collect();
        assert_eq!(columns.len(), 120, "the curve reaches both edges");
    }
}

#[test]
fn a_wrap_of_the_vertical_axis_splits_too() {
    let area = Rect::new(0, 0, 20, 20);
    let frame = PlotFrame::new(Scale::linear(0.0, 10.0), Scale::turn(), area);
    let mut raster = Raster::new(area, Glyphs::Braille);
    let points = (0..=100).map(|i| f64::from(i) / 10.0).map(|t| [t, 3.0 * t]);
    raster.polyline(&frame, points, &Pen::new(Style::new(), 0));
    // A stroke down a column would fill it.
    for x in 0..40 {
        let filled = (0..80).filter(|y| raster.is_set([x, *y])).count();
        assert!(filled < 24, "column {x} has {filled} dots");
    }
}

#[test]
fn a_gap_in_the_data_is_a_gap_in_the_line() {
    let area = Rect::new(0, 0, 20, 1);
    let mut raster = Raster::new(area, Glyphs::Braille);
    let points = [[0.0, 0.5], [0.2, 0.5], [0.5, f64::NAN], [0.8, 0.5], [1.0, 0.5]];
    raster.polyline(&unit(area), points, &Pen::new(Style::new(), 0));
    let columns: Vec<_> = dots(&raster).into_iter().map(|[x, _]| x).collect();
    assert_eq!(columns, (0..8).chain(32..40).collect::<Vec<_>>());
}
