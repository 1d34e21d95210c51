//! Any bits of any number at any size: something is drawn, or nothing, but never a panic.

use std::f64::consts::FRAC_PI_2;

use phaselab::view::colour::ColourDepth;
use phaselab::view::glyphs::Glyphs;
use phaselab::view::plot::{
    Axes, Bounds, Camera, DrawnAxis, Marker, Pen, PlotFrame, Raster, Scale,
};
use phaselab::view::sparkline::{ColumnValue, RangeBar, Sparkline};
use phaselab::view::theme::{Role, Theme};
use proptest::prelude::*;
use ratatui::buffer::Buffer;
use ratatui::layout::Rect;
use ratatui::style::Color;
use ratatui::widgets::Widget;

/// Every bit pattern, with frequent special values.
fn number() -> impl Strategy<Value = f64> {
    prop_oneof![
        4 => any::<u64>().prop_map(f64::from_bits),
        4 => -10.0..10.0_f64,
        1 => prop::sample::select(vec![
            0.0, -0.0, f64::NAN, f64::INFINITY, f64::NEG_INFINITY, f64::MAX, f64::MIN,
            f64::MIN_POSITIVE, 5e-324, 1e300, -1e-300,
        ]),
    ]
}

fn scale() -> impl Strategy<Value = Scale> {
    (number(), number(), 0..5).prop_map(|(lo, hi, kind)| match kind {
        0 => Scale::linear(lo, hi),
        1 => Scale::log(lo, hi),
        2 => Scale::linear(lo, hi).angle(),
        3 => Scale::linear(lo, hi).wrapped(hi),
        _ => Scale::turn(),
    })
}

fn glyphs() -> impl Strategy<Value = Glyphs> {
    prop::sample::select(Glyphs::ALL.to_vec())
}

fn depth() -> impl Strategy<Value = ColourDepth> {
    use ColourDepth::{Ansi16, Ansi256, None, True};
    prop::sample::select(vec![None, Ansi16, Ansi256, True])
}

/// A size, mostly small, and an area that may extend beyond a screen of that size.
fn screen() -> impl Strategy<Value = (Rect, Rect)> {
    let side = || prop_oneof![3 => 0_u16..40, 1 => 0_u16..=250];
    (side(), side(), side(), side(), side(), side())
        .prop_map(|(w, h, x, y, wide, high)| (Rect::new(0, 0, w, h), Rect::new(x, y, wide, high)))
}

/// Draws one of everything.
fn everything(
    buffer: &mut Buffer,
    area: Rect,
    (x, y): (Scale, Scale),
    points: &[[f64; 2]],
    glyphs: Glyphs,
    theme: &Theme,
) {
    let axes = Axes {
        x: DrawnAxis::new("θ", "rad", x),
        y: DrawnAxis::new("p_θ", "kg m²/s", y),
        equal: false,
        pan: points.first().copied().unwrap_or_default(),
    };
    let axes = if area.width.is_multiple_of(2) { axes } else { axes.equal() };
    let frame = axes.draw(area, buffer, theme, glyphs);
    let mut raster = Raster::new(frame.area, glyphs);
    raster.polyline(&frame, points.iter().copied(), &Pen::shaded(theme.line(Role::Level), 0));
    super::draw_trail(&mut raster, glyphs, &frame, points, theme.trail(1));
    raster.cloud(&frame, points.iter().copied(), theme.density(), 1);
    raster.points(&frame, points.iter().copied(), &Pen::new(theme.curve(2), 1));
    for point in points.iter().take(2) {
        raster.marker(&frame, *point, Marker::Diamond, &Pen::new(theme[Role::Accent], 3));
    }
    raster.draw(buffer);
    let values: Vec<f64> = points.iter().map(|[x, _]| *x).collect();
    Sparkline {
        values: &values,
        column: ColumnValue::Mean,
        scale: y,
        style: theme[Role::Accent],
        glyphs,
    }
    .render(area, buffer);
    let value = points.first().map_or(f64::NAN, |p| p[1]);
    let (filled, rest) = (theme[Role::Accent], theme[Role::Border]);
    RangeBar { value, scale: x, filled, rest, glyphs }.render(area, buffer);
    let mut outside = buffer.area.positions().filter(|at| !area.contains(*at));
    assert!(outside.all(|at| buffer[at].symbol() == " "), "something is drawn outside {area:?}");
}

proptest! {
    #![proptest_config(crate::cases(400))]

    #[test]
    fn anything_can_be_drawn_anywhere(
        (screen, area) in screen(),
        scales in (scale(), scale()),
        points in prop::collection::vec([number(), number()], 0..30),
        glyphs in glyphs(),
        depth in depth(),
    ) {
        let theme = Theme::dark(depth);
        let mut buffer = Buffer::empty(screen);
        everything(&mut buffer, area, scales, &points, glyphs, &theme);
        for cell in buffer.content() {
            prop_assert!(!glyphs.is_ascii() || cell.symbol().is_ascii());
            if depth == ColourDepth::None {
                prop_assert_eq!((cell.fg, cell.bg), (Color::Reset, Color::Reset));
            }
        }
    }

    #[test]
    fn any_camera_makes_a_frame(
        points in prop::collection::vec([number(), number(), number()], 0..8),
        angles in [number(), number(), number(), number()],
        (_, area) in screen(),
    ) {
        let finite = |x: f64| if x.is_finite() { x } else { 0.0 };
        let camera = Camera {
            yaw: finite(angles[0]),
            pitch: finite(angles[1]).clamp(-FRAC_PI_2, FRAC_PI_2),
            zoom: finite(angles[2]).clamp(0.01, 100.0),
            pan: [angles[3], angles[0]],
            distance: Some(angles[2]),
        };
        let frame: PlotFrame = camera.frame(&Bounds::around(points.iter().copied()), area);
        prop_assert!(frame.x.lo < frame.x.hi && frame.y.lo < frame.y.hi);
        let mut raster = Raster::new(area, Glyphs::Braille);
        let seen = points.iter().map(|point| camera.project(*point)).map(|[x, y, _]| [x, y]);
        raster.polyline(&frame, seen, &Pen::new(ratatui::style::Style::new(), 0));
    }
}

#[test]
fn every_size_up_to_250_by_250_can_be_drawn() {
    let theme = Theme::dark(ColourDepth::Ansi256);
    let scales = (Scale::turn(), Scale::linear(-2.0, 2.0));
    let points: Vec<[f64; 2]> = (0..40).map(|i| f64::from(i) * 0.3).map(|t| [t, t.sin()]).collect();
    // All small sizes, then increasing strides.
    let sides = || (0..24).chain((24..=250).step_by(37)).chain([249, 250]);
    for (wide, high) in sides().flat_map(|w| sides().map(move |h| (w, h))) {
        let area = Rect::new(1, 1, wide, high);
        let around = Rect::new(0, 0, wide + 2, high + 2);
        let mut buffer = Buffer::empty(around);
        everything(&mut buffer, area, scales, &points, Glyphs::Braille, &theme);
    }
}

#[test]
fn the_corner_of_the_largest_screen_is_safe() {
    let area = Rect::new(u16::MAX - 5, u16::MAX - 5, 5, 5);
    let mut buffer = Buffer::empty(area);
    let scales = (Scale::linear(0.0, 1.0), Scale::linear(0.0, 1.0));
    let theme = Theme::dark(ColourDepth::True);
    everything(&mut buffer, area, scales, &[[0.0, 0.0], [1.0, 1.0]], Glyphs::Braille, &theme);
}

#[test]
fn a_huge_line_costs_no_more_than_the_plot_is_wide() {
    let area = Rect::new(0, 0, 100, 50);
    let frame = PlotFrame::new(Scale::linear(0.0, 1.0), Scale::linear(0.0, 1.0), area);
    let mut raster = Raster::new(area, Glyphs::Braille);
    let start = std::time::Instant::now();
    for _ in 0..1000 {
        raster.line(
            &frame,
            [-1e308, 0.5],
            [1e308, 0.5],
            &Pen::new(ratatui::style::Style::new(), 0),
        );
    }
    assert_eq!(raster.count(), 200);
    assert!(start.elapsed().as_secs() < 5, "a thousand lines of 200 dots");
}
