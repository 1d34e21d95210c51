//! What is kept between frames, and how the picture of a moving system fills its pane.

use phaselab::app::Event;
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
fn what_is_kept_is_what_would_be_drawn_anew() {
    let area = Rect::new(0, 0, 120, 40);
    for name in SYSTEMS {
        for glyphs in [Glyphs::Braille, Glyphs::Ascii] {
            let look = RenderStyle { theme: Theme::dark(ColourDepth::True), glyphs };
            let (mut real, mut painter) = (Real::of(name), Painter::default());
            for frame in 0..4 {
                real.run(8);
                real.app.update(Event::Tick(std::time::Duration::from_secs(1) / 3));
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
