//! What is kept between frames, and how the picture of a moving system fills its pane.

use phaselab::app::AppEvent;
use phaselab::view::colour::ColourDepth;
use phaselab::view::glyphs::Glyphs;
use phaselab::view::theme::Theme;
use phaselab::view::{self, Painter, RenderStyle};
use ratatui::buffer::Buffer;
use ratatui::layout::Rect;

use super::{rich, rows};
use crate::app::real::Real;

/// A motion in a potential that is drawn, maps with grids, bodies, surfaces, curves on spheres, a past that is drawn.
const SYSTEMS: [&str; 9] = [
    "heavy-top",
    "t-handle",
    "pendulum",
    "planet",
    "moving-axes",
    "two-roots",
    "neumann",
    "spherical-pendulum",
    "kicked-rotor",
];

/// The pictures of a painter that keeps what does not change are those of one that keeps nothing.
#[test]
fn what_is_cached_is_what_would_be_drawn_anew() {
    let area = Rect::new(0, 0, 120, 40);
    for name in SYSTEMS {
        for glyphs in [Glyphs::Braille, Glyphs::Ascii] {
            let look = RenderStyle { theme: Theme::dark(ColourDepth::True), glyphs };
            let (mut real, mut painter) = (Real::of(name), Painter::default());
            for frame in 0..4 {
                real.run(8);
                real.app.update(AppEvent::Tick(std::time::Duration::from_secs(1) / 3));
                if frame == 2 {
                    // A change of the first parameter changes potentials, maps and bodies.
                    real.press("Right");
                }
                let [mut kept, mut anew] = [0, 1].map(|_| Buffer::empty(area));
                painter.draw(&real.app, &look, area, &mut kept);
                view::draw(&real.app, &look, area, &mut anew);
                assert!(
                    kept == anew,
                    "{name}, frame {frame}: {:#?} {:#?}",
                    rows(&kept),
                    rows(&anew)
                );
            }
        }
    }
}

/// A trail is continued by the rows that are new, and begun anew only where its axes or its scene have changed: not because the
/// last bits of a number in the picture have.
#[test]
fn a_frame_strokes_only_the_rows_that_are_new() {
    let area = Rect::new(0, 0, 120, 40);
    for name in ["pendulum", "heavy-top", "henon-heiles", "planet"] {
        let (mut real, mut painter) = (Real::of(name), Painter::default());
        real.run(600);
        let mut frugal = 0;
        let (mut newest, mut stroked) = (f64::NEG_INFINITY, 0);
        for _ in 0..31 {
            real.run(2);
            painter.draw(&real.app, &rich(), area, &mut Buffer::empty(area));
            let trail = &real.seen().trail;
            let new = trail.rows().rev().take_while(|row| row[0] > newest).count() as u64;
            // a picture in space, a portrait, and curves against the time
            let most = 6 * new;
            frugal += usize::from(painter.stroked() - stroked <= most);
            assert!(trail.len() > 300, "{name}: {} rows", trail.len());
            newest = trail.rows().next_back().unwrap()[0];
            stroked = painter.stroked();
        }
        // the window of a time series grows in steps
        assert!(frugal >= 26, "{name}: {frugal} frames of 31 stroke only what is new");
    }
}

/// The columns and rows of the first pane that the picture takes, without the triad in its corner.
fn filled(name: &str) -> [usize; 2] {
    let mut real = Real::of(name);
    for _ in 0..40 {
        real.run(9);
    }
    let area = Rect::new(0, 0, 120, 40);
    let mut buffer = Buffer::empty(area);
    view::draw(&real.app, &rich(), area, &mut buffer);
    let drawn = |&(x, y): &(u16, u16)| {
        let corner = x < 9 && y > 16;
        !corner && buffer[(x, y)].symbol().starts_with(|c| ('⠁'..='⣿').contains(&c) || c == '●')
    };
    let dots: Vec<_> = (2..22).flat_map(|y| (1..39).map(move |x| (x, y))).filter(drawn).collect();
    let size =
        |ends: Vec<u16>| usize::from(ends.iter().max().unwrap() - ends.iter().min().unwrap()) + 1;
    [size(dots.iter().map(|dot| dot.0).collect()), size(dots.iter().map(|dot| dot.1).collect())]
}

/// A picture in space is as large as what was seen of the motion allows, not as boxes around it would: the pane has 38 columns
/// and 20 rows.
#[test]
fn a_picture_in_space_fills_its_pane_in_one_direction() {
    for name in [
        "kepler-brackets",
        "solar-system",
        "spherical-pendulum",
        "charge-by-its-hamiltonian",
        "bead-on-hoop",
    ] {
        let [wide, high] = filled(name);
        assert!(wide >= 31 || high >= 17, "{name}: {wide} columns, {high} rows");
    }
}
