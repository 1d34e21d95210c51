//! Shaded surfaces: where colours allow it, a cell that a surface covers has a background.

mod thickness;

use phaselab::app::App;
use phaselab::view::RenderStyle;
use phaselab::view::colour::{ColourDepth, Rgb};
use phaselab::view::glyphs::Glyphs;
use phaselab::view::theme::{PALETTES, Palette, Role, Theme};
use ratatui::buffer::{Buffer, Cell};
use ratatui::style::{Color, Style};

use super::{rich, screen};
use crate::app::real::Real;
use crate::fixtures::{begun, lab};
use crate::nonempty;

/// The pane of the momentum sphere at 120 × 40: its columns, its rows.
const PANE: [std::ops::Range<u16>; 2] = [41..79, 2..22];

fn momentum_sphere() -> App {
    let mut real = Real::of("free-rigid-body");
    real.run(600);
    real.app
}

fn drawn(app: &App, depth: ColourDepth, glyphs: Glyphs) -> Buffer {
    screen(app, &RenderStyle { theme: Theme::dark(depth), glyphs }, (120, 40))
}

/// The cells of the pane that have a background, row by row.
fn painted(buffer: &Buffer) -> Vec<Vec<bool>> {
    let [columns, rows] = PANE;
    let is_painted = |at: (u16, u16)| buffer[at].bg != Color::Reset;
    rows.map(|y| columns.clone().map(|x| is_painted((x, y))).collect()).collect()
}

/// The edge of a sphere is round, and inside there is not one cell without its colour.
#[test]
fn a_sphere_has_no_holes() {
    let buffer = drawn(&momentum_sphere(), ColourDepth::True, Glyphs::Braille);
    let [columns, rows] = PANE;
    let is_block = |cell: &Cell| cell.symbol().chars().any(|c| ('▀'..='▟').contains(&c));
    let is_painted = |cell: &Cell| cell.bg != Color::Reset || is_block(cell);
    let row = |y: u16| columns.clone().map(move |x| (x, y));
    let rows: Vec<Vec<bool>> =
        rows.map(|y| row(y).map(|at| is_painted(&buffer[at])).collect()).collect();
    let spans: Vec<(usize, usize)> = rows
        .iter()
        .filter_map(|row| Some((row.iter().position(|p| *p)?, row.iter().rposition(|p| *p)?)))
        .collect();
    assert!(spans.len() >= 16, "{rows:?}");
    // what is not painted is connected with the border of the pane
    let mut open: Vec<Vec<bool>> = rows.iter().map(|row| vec![false; row.len()]).collect();
    let (high, wide) = (rows.len(), rows[0].len());
    let cells = || (0..high).flat_map(|y| (0..wide).map(move |x| (x, y)));
    let on_border = |(x, y)| x == 0 || y == 0 || x == wide - 1 || y == high - 1;
    let mut reached: Vec<(usize, usize)> = cells().filter(|at| on_border(*at)).collect();
    while let Some((x, y)) = reached.pop() {
        if !(rows[y][x] || open[y][x]) {
            open[y][x] = true;
            reached.extend(
                [(x + 1, y), (x.wrapping_sub(1), y), (x, y + 1), (x, y.wrapping_sub(1))]
                    .into_iter()
                    .filter(|&(x, y)| x < wide && y < high),
            );
        }
    }
    assert!(cells().all(|(x, y)| rows[y][x] || open[y][x]), "{rows:?}");
    // an ellipse of cells: it is nowhere hollow, and its area is π/4 of that around it
    let widths: Vec<usize> = spans.iter().map(|(first, last)| last - first + 1).collect();
    let widest = *widths.iter().max().unwrap();
    let middle = widths.iter().position(|width| *width == widest).unwrap();
    assert!(
        widths[..middle].is_sorted() && widths[middle..].iter().rev().is_sorted(),
        "{widths:?}"
    );
    let share = widths.iter().sum::<usize>() as f64 / (widest * widths.len()) as f64;
    assert!((share / std::f64::consts::FRAC_PI_4 - 1.0).abs() < 0.1, "{share}: {widths:?}");
    // blocks round it off: of a quarter of a cell, and beside braille of one or three of four rows, too
    let [columns, rows] = PANE;
    let count = |buffer: &Buffer, counts: &dyn Fn(&Cell) -> bool| {
        let cells = rows.clone().flat_map(|y| columns.clone().map(move |x| (x, y)));
        cells.filter(|at| counts(&buffer[*at])).count()
    };
    assert!(count(&buffer, &is_block) > 20);
    assert!(count(&buffer, &|cell| ["▂", "▆"].contains(&cell.symbol())) > 4);
    let buffer = drawn(&momentum_sphere(), ColourDepth::True, Glyphs::Octant);
    assert!(count(&buffer, &is_block) > 10);
}

/// The light comes from above, a little from the left.
#[test]
fn the_light_comes_from_above() {
    let buffer = drawn(&momentum_sphere(), ColourDepth::True, Glyphs::Braille);
    let bright = |at: (u16, u16)| Rgb::of(buffer[at].bg).expect("a surface").brightness();
    let (high, low) = (bright((56, 6)), bright((63, 19)));
    assert!(high > low + 0.1, "{high} and {low}");
}

/// Lines on a surface differ from it in brightness, in every palette.
#[test]
fn lines_on_a_surface_are_seen() {
    let app = momentum_sphere();
    for palette in &PALETTES {
        let theme = Theme::new(palette, ColourDepth::True);
        if theme.tones(theme[Role::Level]).is_none() {
            continue;
        }
        let buffer = screen(&app, &RenderStyle { theme, glyphs: Glyphs::Braille }, (120, 40));
        let [columns, rows] = PANE;
        let cells = rows.flat_map(|y| columns.clone().map(move |x| (x, y)));
        let is_line = |cell: &&Cell| {
            let dotted = |c: char| ('\u{2801}'..='\u{28ff}').contains(&c) || c == '●';
            cell.bg != Color::Reset && cell.symbol().chars().all(dotted)
        };
        let mut count = 0;
        for cell in cells.map(|at| &buffer[at]).filter(is_line) {
            let [line, behind] =
                [cell.fg, cell.bg].map(|c| Rgb::of(c).expect("a colour").brightness());
            assert!((line - behind).abs() > 0.2, "{}: {line} on {behind}", palette.name);
            count += 1;
        }
        assert!(count > 40, "{}: {count}", palette.name);
    }
}

/// With few colours, without any and in ASCII surfaces are dots, and no cell has a background.
#[test]
fn few_colours_shade_with_dots() {
    let app = momentum_sphere();
    for (depth, glyphs) in [
        (ColourDepth::Ansi16, Glyphs::Braille),
        (ColourDepth::None, Glyphs::Braille),
        (ColourDepth::True, Glyphs::Ascii),
    ] {
        let buffer = drawn(&app, depth, glyphs);
        assert!(painted(&buffer).iter().flatten().all(|painted| !painted), "{depth:?} {glyphs:?}");
    }
    let buffer = drawn(&app, ColourDepth::Ansi256, Glyphs::HalfBlock);
    assert!(painted(&buffer).iter().flatten().filter(|painted| **painted).count() > 300);
}

/// Among 256 colours a sphere is shaded in greys: a hue that comes and goes from step to step would look like paint.
#[test]
fn among_256_colours_a_sphere_is_grey() {
    let buffer = drawn(&momentum_sphere(), ColourDepth::Ansi256, Glyphs::Braille);
    let [columns, rows] = PANE;
    let cells = rows.flat_map(|y| columns.clone().map(move |x| (x, y)));
    let tones: Vec<Rgb> = cells.filter_map(|at| Rgb::of(buffer[at].bg)).collect();
    assert!(tones.len() > 300, "{tones:?}");
    assert!(tones.iter().all(|Rgb(r, g, b)| r == g && g == b), "{tones:?}");
}

/// The faces of a top differ in brightness: the upper one is the brightest.
#[test]
fn the_faces_of_a_top_are_told_apart() {
    let buffer = screen(&lab("sleeping-top", 1.0), &rich(), (120, 40));
    let cells = (2..22).flat_map(|y| (1..39).map(move |x| (x, y)));
    let mut tones: Vec<u32> = cells
        .filter_map(|at| Rgb::of(buffer[at].bg))
        .map(|tone| (1000.0 * tone.brightness()) as u32)
        .collect();
    tones.sort_unstable();
    tones.dedup();
    assert!(tones.len() >= 4, "{tones:?}");
    assert!(tones[tones.len() - 1] > tones[0] + 100, "{tones:?}");
}

/// A piece is drawn in one style while it turns: thin ones as dots in every frame.
#[test]
fn the_style_of_a_body_does_not_change_while_it_turns() {
    for (name, size) in [("t-handle", (60, 15)), ("t-handle", (40, 10))] {
        let mut real = Real::of(name);
        let (mut painted, mut dotted) = (0, 0);
        for _ in 0..40 {
            real.run(4);
            let buffer = screen(&real.app, &rich(), size);
            let is_painted = |cell: &&Cell| Rgb::of(cell.bg).is_some();
            painted += usize::from(buffer.content.iter().any(|cell| is_painted(&cell)));
            let is_dot =
                |cell: &Cell| cell.symbol().chars().any(|c| ('\u{2801}'..='\u{28ff}').contains(&c));
            dotted += usize::from(buffer.content.iter().filter(|cell| is_dot(cell)).count() > 8);
        }
        assert!((painted, dotted) == (0, 40), "{name} {size:?}: {painted} {dotted}");
    }
}

/// Thin pieces are no wires: what they cover is full of dots.
#[test]
fn a_thin_body_is_full_of_dots() {
    let mut real = Real::of("t-handle");
    let mut counts = Vec::new();
    for _ in 0..20 {
        real.run(8);
        let buffer = screen(&real.app, &rich(), (80, 24));
        let cells = (2..13).flat_map(|y| (1..38).map(move |x| (x, y)));
        let is_braille = |c: &char| ('\u{2800}'..='\u{28ff}').contains(c);
        let dots = |at| buffer[at].symbol().chars().find(is_braille).map_or(0, |c| c as u32 & 0xff);
        counts.push(cells.filter(|&at| dots(at).count_ones() >= 6).count());
    }
    assert!(counts.iter().sum::<usize>() >= 120, "{counts:?}");
}

/// Thick ones are filled in every frame.
#[test]
fn a_thick_body_is_filled_while_it_turns() {
    let mut real = Real::of("t-handle");
    for frame in 0..40 {
        real.run(4);
        let buffer = screen(&real.app, &rich(), (120, 40));
        let cells = (2..22).flat_map(|y| (1..39).map(move |x| (x, y)));
        let painted = cells.filter(|&at| Rgb::of(buffer[at].bg).is_some()).count();
        assert!(painted > 20, "{frame}: {painted}");
    }
}

/// The side in the shade is told from the background in every palette, and so is the brightest one.
#[test]
fn no_tone_is_lost_in_the_background() {
    for (palette, _, tone) in nonempty(tones(ColourDepth::True)) {
        let ratio = Rgb::of(tone).expect("a colour").contrast(palette.background);
        assert!(ratio >= 1.45, "{}: {tone:?} {ratio}", palette.name);
    }
}

/// Dots that fill a thin piece stand out from the page in every palette.
#[test]
fn thin_pieces_stand_out_from_the_page() {
    let palettes: &'static [Palette] = &PALETTES;
    let mut count = 0;
    for palette in palettes {
        let theme = Theme::new(palette, ColourDepth::True);
        for style in styles(&theme).into_iter().filter_map(|style| theme.dots(style)) {
            let colour = style.fg.and_then(Rgb::of).expect("a colour");
            let contrast = colour.contrast(palette.background);
            assert!(contrast >= 3.0, "{}: {colour:?} {contrast}", palette.name);
            count += 1;
        }
    }
    assert!(count > 20, "{count}");
}

/// The styles of level curves and series.
fn styles(theme: &Theme) -> Vec<Style> {
    [theme[Role::Level]].into_iter().chain((0..7).map(|n| theme.curve(n))).collect()
}

/// The tones of every palette that has some, with the theme at this depth.
fn tones(depth: ColourDepth) -> impl Iterator<Item = (&'static Palette, Theme, Color)> {
    let palettes: &'static [Palette] = &PALETTES;
    palettes.iter().flat_map(move |palette| {
        let theme = Theme::new(palette, depth);
        let tones = styles(&theme).into_iter().filter_map(|style| theme.tones(style));
        let tones: Vec<Color> = tones.flatten().copied().collect();
        tones.into_iter().map(move |tone| (palette, theme.clone(), tone))
    })
}

/// A line on any tone differs from it in brightness, whatever its own colour, at both depths that have tones.
#[test]
fn whatever_is_written_on_a_tone_is_legible() {
    for depth in [ColourDepth::True, ColourDepth::Ansi256] {
        for (palette, theme, tone) in nonempty(tones(depth)) {
            let written = [theme[Role::Dim], theme[Role::Accent]];
            for style in nonempty(styles(&theme).into_iter().chain(written)) {
                let written = theme.legible(style, tone).fg.and_then(Rgb::of);
                let written = written.unwrap_or(palette.foreground).brightness();
                let behind = Rgb::of(tone).expect("a colour").brightness();
                let apart = (written - behind).abs();
                assert!(apart >= 0.25, "{} {depth:?}: {style:?} on {tone:?}", palette.name);
            }
        }
    }
}

/// Bodies that stand for a motion have its colour: the discs of the right and the wrong mechanics differ in hue.
#[test]
fn the_discs_of_two_mechanics_have_the_colours_of_the_legend() {
    let theme = Theme::dark(ColourDepth::True);
    let mut real = Real::of("rolling-disc");
    let mut buffers = Vec::new();
    for _ in 0..20 {
        real.run(12);
        buffers.push(screen(&real.app, &rich(), (200, 60)));
    }
    let painted = |style| {
        let tones = theme.tones(style).expect("tones");
        let cells = buffers.iter().flat_map(|buffer| &buffer.content);
        cells.filter(|cell| tones.contains(&cell.bg)).count()
    };
    let [right, wrong] = [0, 1].map(|series| painted(theme.curve(series)));
    assert!(right >= 3 && wrong >= 3, "{right} {wrong}");
    assert_eq!(painted(theme[Role::Level]), 0, "no disc is grey");
}

/// A sphere inside a shaded one is drawn, as a line.
#[test]
fn a_sphere_inside_another_one_is_drawn() {
    let file = |others: &str| {
        format!(
            "title = \"Spheres\"\nsummary = \"x\"\n[coordinates]\nx = {{ initial = 1.0, velocity = 0.0 }}\n[lagrangian]\n\
             L = \"1/2*x'^2 - 1/2*x^2\"\n[space]\nshapes = [{{ sphere = [\"0\", \"0\", \"0\"], radius = \"1\" }}, {others}]\n\
             [[views]]\nkind = \"space\"\n"
        )
    };
    let dotted = |others: &str| {
        let buffer = screen(&begun(&file(others)), &rich(), (120, 40));
        let cells = (3..21).flat_map(|y| (1..39).map(move |x| (x, y)));
        let dots = |c: char| ('\u{2801}'..='\u{28ff}').contains(&c);
        // but for the corner of axes
        let inside = cells.filter(|(x, y)| *x > 12 || *y < 14);
        inside.filter(|at| buffer[*at].symbol().chars().any(dots)).count()
    };
    // the dots are those of its edge
    let (once, twice) = (dotted(""), dotted("{ sphere = [\"0\", \"0\", \"0\"], radius = \"1\" }"));
    assert_eq!(twice, once, "a shaded sphere has no outline inside another one");
    let inner = dotted("{ sphere = [\"0\", \"0\", \"0\"], radius = \"0.5\" }");
    assert!(inner > twice + 15, "{inner} and {twice}");
}

/// A model of one coordinate with these shapes in space, seen from the side and a little from above.
fn in_space(shapes: &str) -> App {
    seen_from(30, shapes)
}

/// The same, seen from so many degrees above.
fn seen_from(elevation: u32, shapes: &str) -> App {
    begun(&format!(
        "title = \"Shapes\"\nsummary = \"x\"\n[coordinates]\nx = {{ initial = 1.0, velocity = 0.0 }}\n[lagrangian]\n\
         L = \"1/2*x'^2 - 1/2*x^2\"\n[space]\nazimuth = 0\nelevation = {elevation}\nshapes = [{shapes}]\n[[views]]\nkind = \"space\"\n"
    ))
}

/// Where two mechanics are compared, what moves with neither has the colour of neither.
#[test]
fn what_moves_with_neither_mechanics_has_none_of_their_colours() {
    let theme = Theme::dark(ColourDepth::True);
    let text = &crate::fixtures::catalog().find("rolling-disc").expect("a preset").text;
    let painted = |text: &str| {
        let buffer = screen(&begun(text), &rich(), (200, 60));
        [theme[Role::Level], theme.curve(0), theme.curve(1)].map(|style| {
            let tones = theme.tones(style).expect("tones");
            buffer.content.iter().filter(|cell| tones.contains(&cell.bg)).count()
        })
    };
    let third = "{ disc = [\"0\", \"0.7 + t\", \"0.4\"], radius = \"0.4\", normal = [\"1\", \"0\", \"1\"] },";
    let [before, with] = [text.clone(), text.replace("shapes = [", &format!("shapes = [{third}"))]
        .map(|text| painted(&text));
    assert_eq!(before[0], 0, "{before:?}");
    assert!(with[0] > 3, "{with:?}");
}

/// Where its edges are lines, a cone or a cylinder about a mass has them in the colour of the mass, as it has its filling.
#[test]
fn the_edges_of_a_body_have_its_colour() {
    let theme = Theme::dark(ColourDepth::True);
    let look = RenderStyle { theme: theme.clone(), glyphs: Glyphs::Ascii };
    let mass = "{ mass = [\"x\", \"0\", \"0\"] }";
    for body in [
        "{ cylinder = [\"x\", \"0\", \"0\"], to = [\"x\", \"0\", \"1\"], radius = \"1/2\" }",
        "{ cone = [\"x\", \"0\", \"1\"], to = [\"x\", \"0\", \"0\"], radius = \"1/2\" }",
    ] {
        let buffer = screen(&in_space(&format!("{mass}, {body}")), &look, (120, 40));
        let places = || (2..14).flat_map(|y| (3..39).map(move |x| (x, y)));
        let cells = || places().map(|at| &buffer[at]);
        let count = |style: ratatui::style::Style| {
            cells().filter(|c| c.symbol() != " " && Some(c.fg) == style.fg).count()
        };
        let counts = [count(theme.curve(0)), count(theme[Role::Text])];
        assert!(counts[0] > 20 && counts[1] == 0, "{body}: {counts:?}");
    }
}

/// The blanks between the words of a caption are its own: neither edges nor blocks are drawn in them.
#[test]
fn a_caption_keeps_its_blanks() {
    let words = ["a b c d e f g h i j k l m n o", "aa b c d e f g h i j k l m n o"];
    let captions = (0..14).map(|k| {
        let (z, text) = (0.2 * f64::from(k) - 1.3, words[k as usize % 2]);
        format!("{{ caption = [\"-1.8\", \"0\", \"{z}\"], text = \"{text}\" }}")
    });
    let captions: Vec<String> = captions.collect();
    let bodies = "{ sphere = [\"0\", \"0\", \"0\"], radius = \"1\" }, \
                  { cylinder = [\"0\", \"0\", \"-1.4\"], to = [\"0\", \"0\", \"1.4\"], radius = \"0.4\" }";
    let app = in_space(&format!("{bodies}, {}", captions.join(", ")));
    let text = super::rows(&screen(&app, &rich(), (200, 60))).join("\n");
    assert_eq!(text.matches(words[0]).count(), 14, "{text}");
}

/// A wheel that spins about its axle looks the same from one moment to the next, but for what is marked on it.
#[test]
fn what_is_round_does_not_flicker_while_it_spins() {
    let mut real = Real::of("unbalanced-wheel");
    real.run(60);
    let mut shades = Vec::new();
    for _ in 0..12 {
        real.run(2);
        let buffer = drawn(&real.app, ColourDepth::True, Glyphs::Braille);
        let cells = (2..22).flat_map(|y| (1..39).map(move |x| (x, y)));
        let blank = |cell: &Cell| (cell.symbol() == " ").then_some(cell.bg);
        shades.push(cells.map(|at| blank(&buffer[at])).collect::<Vec<_>>());
    }
    let covered = shades[0].iter().flatten().filter(|colour| **colour != Color::Reset);
    assert!(covered.count() > 30);
    for pair in shades.windows(2) {
        let both = pair[0].iter().zip(&pair[1]).filter_map(|(a, b)| a.as_ref().zip(b.as_ref()));
        assert_eq!(both.filter(|(a, b)| a != b).count(), 0);
    }
}

/// A ball beside a disc is as solid as that is.
#[test]
fn a_ball_in_a_plane_is_shaded_beside_a_disc() {
    let mut real = Real::of("rolling-race");
    real.run(20);
    let buffer = drawn(&real.app, ColourDepth::True, Glyphs::Braille);
    let cells = (2..22).flat_map(|y| (1..39).map(move |x| (x, y)));
    let greenish = |colour: Color| {
        Rgb::of(colour).is_some_and(|Rgb(r, g, b)| g > r.saturating_add(20) && g > b)
    };
    assert!(cells.filter(|at| greenish(buffer[*at].bg)).count() >= 4);
}

/// A motion beside the main one is drawn with the rims and edges of its body, where the body of the main one does not hide them.
#[test]
fn a_second_top_is_drawn_with_its_body() {
    use phaselab::experiment::Command;
    use phaselab::system::InitialOverride::Position;
    let look = rich();
    // its colour, as it looks at any distance
    let style = look.theme.curve(4);
    let inks: Vec<_> =
        (0..=12).map(|far| look.theme.receding(style, f64::from(far) / 12.0).fg).collect();
    let counts = [0.0, 1.5, 3.0, 4.5].map(|phi| {
        let mut real = Real::of("heavy-top");
        real.experiment.execute(Command::AddStart(vec![Position(0, 1.3), Position(1, phi)]));
        real.run(4);
        let buffer = screen(&real.app, &look, (120, 40));
        let cells = (2..22).flat_map(|y| (1..39).map(move |x| (x, y)));
        let is_own =
            |at: &(u16, u16)| buffer[*at].symbol() != " " && inks.contains(&Some(buffer[*at].fg));
        cells.filter(is_own).count()
    });
    // the rod and the number at its end are fewer than ten
    assert!(counts.iter().any(|count| *count > 20), "{counts:?}");
}
