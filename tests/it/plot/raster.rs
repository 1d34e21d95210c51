//! Dots: combined where lines cross, thin, round, and styled by the highest layer.

use std::f64::consts::TAU;

use phaselab::view::glyphs::Glyphs;
use phaselab::view::plot::{Letters, Marker, Pen, PlotFrame, Raster, Scale};
use phaselab::view::theme::{Dash, Shade};
use ratatui::buffer::Buffer;
use ratatui::layout::Rect;
use ratatui::style::{Color, Modifier, Style};

use super::{dots, rows, unit};

const PLAIN: Pen = Pen {
    style: Style::new(),
    layer: 0,
    fresh: 0,
    coverage: 1.0,
    dash: Dash::Full,
    letters: Letters::Height,
};

fn drawn(area: Rect, glyphs: Glyphs, draw: impl FnOnce(&mut Raster)) -> Buffer {
    let mut raster = Raster::new(area, glyphs);
    draw(&mut raster);
    let mut buffer = Buffer::empty(area);
    raster.draw(&mut buffer);
    buffer
}

#[test]
fn dots_of_crossing_lines_are_united() {
    let area = Rect::new(0, 0, 12, 6);
    let (up, down) = ([[0.0, 0.0], [1.0, 1.0]], [[0.0, 1.0], [1.0, 0.0]]);
    let drawn = |lines: &[[[f64; 2]; 2]]| {
        let mut raster = Raster::new(area, Glyphs::Braille);
        for [a, b] in lines {
            raster.line(&unit(area), *a, *b, &PLAIN);
        }
        raster
    };
    let mut union = dots(&drawn(&[up]));
    union.extend(dots(&drawn(&[down])));
    union.sort_unstable_by_key(|[x, y]| (*y, *x));
    union.dedup();
    assert_eq!(dots(&drawn(&[up, down])), union);
    assert!(union.len() > dots(&drawn(&[up])).len());
}

#[test]
fn a_shared_cell_takes_the_style_of_the_highest_layer_whatever_the_order() {
    let area = Rect::new(0, 0, 4, 2);
    let low = Pen::new(Style::new().fg(Color::Red), 1);
    let high = Pen::new(Style::new().fg(Color::Blue).add_modifier(Modifier::BOLD), 2);
    let frame = unit(area);
    for (pens, dot) in [([low, high], "⠈"), ([high, low], "⠁")] {
        let buffer = drawn(area, Glyphs::Braille, |raster| {
            for (pen, x) in pens.iter().zip([0.01, 0.2]) {
                raster.points(&frame, [[x, 0.9]], pen);
            }
        });
        assert_eq!(buffer[(0, 0)].fg, Color::Blue);
        assert_eq!(buffer[(0, 0)].modifier, Modifier::BOLD);
        assert_eq!(buffer[(0, 0)].symbol(), dot, "no dot has the colour of another layer");
        assert_eq!(buffer[(1, 0)].symbol(), " ");
    }
}

#[test]
fn within_a_layer_the_newer_dot_gives_the_style() {
    let area = Rect::new(0, 0, 1, 1);
    let old = Pen { fresh: 1, ..Pen::new(Style::new().fg(Color::Red), 1) };
    let new = Pen { fresh: 2, ..Pen::new(Style::new().fg(Color::Green), 1) };
    let buffer = drawn(area, Glyphs::Braille, |raster| {
        raster.dot([0, 0], &new);
        raster.dot([1, 3], &old);
    });
    assert_eq!((buffer[(0, 0)].symbol(), buffer[(0, 0)].fg), ("⢁", Color::Green));
}

#[test]
fn every_braille_dot_has_its_own_bit() {
    let area = Rect::new(0, 0, 1, 1);
    let expected = ['⠁', '⠈', '⠂', '⠐', '⠄', '⠠', '⡀', '⢀'];
    for (index, symbol) in expected.into_iter().enumerate() {
        let dot = [index as i32 % 2, index as i32 / 2];
        let buffer = drawn(area, Glyphs::Braille, |raster| raster.dot(dot, &PLAIN));
        assert_eq!(buffer[(0, 0)].symbol(), symbol.to_string());
    }
}

#[test]
fn half_blocks_have_two_dots_a_cell() {
    let area = Rect::new(0, 0, 3, 1);
    let buffer = drawn(area, Glyphs::HalfBlock, |raster| {
        for dot in [[0, 0], [1, 1], [2, 0], [2, 1]] {
            raster.dot(dot, &PLAIN);
        }
    });
    assert_eq!(rows(&buffer), ["▀▄█"]);
}

#[test]
fn in_ascii_a_line_shows_its_direction() {
    let area = Rect::new(0, 0, 5, 5);
    let line = |a, b| {
        let buffer = drawn(area, Glyphs::Ascii, |raster| raster.line(&unit(area), a, b, &PLAIN));
        rows(&buffer).concat().replace(' ', "")
    };
    assert_eq!(line([0.0, 0.5], [1.0, 0.5]), "-----");
    assert_eq!(line([0.5, 0.0], [0.5, 1.0]), "|||||");
    assert_eq!(line([0.0, 0.0], [1.0, 1.0]), "/////");
    assert_eq!(line([0.0, 1.0], [1.0, 0.0]), "\\\\\\\\\\");
}

#[test]
fn a_curve_of_many_points_is_one_dot_wide() {
    let area = Rect::new(0, 0, 30, 15);
    let mut raster = Raster::new(area, Glyphs::Braille);
    let points = (0..=5000).map(|i| f64::from(i) / 5000.0).map(|x| [x, x.powi(3)]);
    raster.polyline(&unit(area), points, &PLAIN);
    let corners = dots(&raster).into_iter().filter(|[x, y]| {
        let set = |dx: i32, dy: i32| raster.is_set([x + dx, y + dy]);
        (set(-1, 0) || set(1, 0)) && (set(0, -1) || set(0, 1))
    });
    assert_eq!(corners.count(), 0);
}

#[test]
fn a_line_is_whole_from_end_to_end() {
    let area = Rect::new(0, 0, 20, 5);
    let mut raster = Raster::new(area, Glyphs::Braille);
    raster.line(&unit(area), [-3.0, 0.5], [7.0, 0.5], &PLAIN);
    let columns: Vec<_> = dots(&raster).into_iter().map(|[x, _]| x).collect();
    assert_eq!(columns, (0..40).collect::<Vec<_>>());
}

#[test]
fn a_circle_is_round_with_equal_units() {
    for glyphs in [Glyphs::Braille, Glyphs::HalfBlock, Glyphs::Ascii] {
        for (wide, high) in [(80, 24), (40, 40), (120, 33), (61, 50)] {
            let area = Rect::new(0, 0, wide, high);
            let scale = Scale::linear(-1.2, 1.2);
            let frame = PlotFrame::equal(scale, scale, area);
            let mut raster = Raster::new(area, glyphs);
            let rim = (0..=128).map(|side| (f64::from(side) * TAU / 128.0).sin_cos());
            raster.polyline(&frame, rim.map(|(sin, cos)| [cos, sin]), &PLAIN);
            let dots = dots(&raster);
            let extent = |axis: usize| {
                let along = dots.iter().map(|dot| dot[axis]);
                f64::from(along.clone().max().unwrap() - along.min().unwrap())
            };
            // A cell is twice as high as it is wide; this many dots are along each of its sides.
            let (across, down) = glyphs.dots();
            let width = extent(0) / f64::from(across);
            let height = 2.0 * extent(1) / f64::from(down);
            // Beside the five percent a dot may be lost to rounding.
            let dot = 2.0 / f64::from(down);
            assert!(
                (width - height).abs() <= 0.05 * height + if glyphs.is_ascii() { dot } else { 0.0 },
                "{glyphs:?} {wide}×{high}: {width} by {height} cells"
            );
        }
    }
}

#[test]
fn a_marker_stands_above_its_layer_and_below_the_next() {
    let area = Rect::new(0, 0, 5, 1);
    let frame = unit(area);
    let across = |layer| Pen::new(Style::new().fg(Color::Red), layer);
    let with_line_on = |layer| {
        drawn(area, Glyphs::Braille, |raster| {
            raster.marker(&frame, [0.5, 0.5], Marker::Disc, &Pen::new(Style::new(), 3));
            raster.line(&frame, [0.0, 0.5], [1.0, 0.5], &across(layer));
        })
    };
    assert_eq!(with_line_on(3)[(2, 0)].symbol(), "●");
    assert_eq!(with_line_on(3)[(2, 0)].fg, Color::Reset);
    assert_eq!(with_line_on(4)[(2, 0)].symbol(), "⠤");
    let outside = drawn(area, Glyphs::Ascii, |raster| {
        raster.marker(&frame, [1.5, 0.5], Marker::Disc, &PLAIN);
        raster.marker(&frame, [f64::NAN, 0.5], Marker::Disc, &PLAIN);
    });
    assert_eq!(rows(&outside), [""]);
}

/// Names are written beside marks: these are told from the dots of lines, by the cell on the screen.
#[test]
fn a_marker_is_told_from_dots_by_its_cell() {
    let area = Rect::new(3, 2, 5, 2);
    let frame = unit(area);
    let mut raster = Raster::new(area, Glyphs::Braille);
    raster.line(&frame, [0.0, 0.2], [1.0, 0.2], &PLAIN);
    raster.marker(&frame, [0.5, 0.8], Marker::Disc, &Pen::new(Style::new(), 3));
    raster.marker(&frame, [0.1, 0.2], Marker::Ring, &Pen::new(Style::new(), 3));
    // a line of a higher layer takes its cell
    raster.line(&frame, [0.0, 0.2], [0.1, 0.2], &Pen::new(Style::new(), 4));
    let cells = (0..10_u16).flat_map(|x| (0..6_u16).map(move |y| (x, y)));
    let marked: Vec<_> = cells.filter(|at| raster.has_marker((*at).into())).collect();
    assert_eq!(marked, [(5, 2)]);
}

/// What a mass covers half of is `#` in ASCII, of less the letter says which part; a line has its letters whatever it covers.
#[test]
fn a_mass_fills_the_cells_it_covers_half_of() {
    let area = Rect::new(0, 0, 6, 1);
    let of = |letters: Letters| {
        let buffer = drawn(area, Glyphs::Ascii, |raster| {
            // from the left one dot more in each cell, in the order of a row after the other
            for cell in 0..6 {
                for dot in 0..=cell {
                    raster.dot([2 * cell + dot % 2, dot / 2], &Pen { letters, ..PLAIN });
                }
            }
        });
        rows(&buffer).concat()
    };
    assert_eq!(of(Letters::Mass), "`\"####");
    assert_eq!(of(Letters::Height), "`\"\"*/#");
}

#[test]
fn cells_without_dots_and_backgrounds_are_left_alone() {
    let area = Rect::new(0, 0, 2, 1);
    let mut buffer = Buffer::empty(area);
    buffer.set_string(0, 0, "ab", Style::new().bg(Color::Green).add_modifier(Modifier::UNDERLINED));
    let mut raster = Raster::new(area, Glyphs::Braille);
    raster.dot([0, 0], &PLAIN);
    raster.draw(&mut buffer);
    assert_eq!((buffer[(0, 0)].symbol(), buffer[(0, 0)].bg), ("⠁", Color::Green));
    assert_eq!(buffer[(0, 0)].modifier, Modifier::empty(), "no underline of the text before");
    assert_eq!((buffer[(1, 0)].symbol(), buffer[(1, 0)].modifier), ("b", Modifier::UNDERLINED));
}

/// A shade with the colour of this index.
fn shade(index: u8) -> Shade {
    let style = Style::new().fg(Color::Indexed(index));
    Shade { style, coverage: 1.0, dash: Dash::Full }
}

#[test]
fn an_even_cloud_has_an_even_shade() {
    let shades: Vec<Shade> = (0..8).map(shade).collect();
    let area = Rect::new(0, 0, 20, 10);
    // A lattice of additive recurrences (Roberts' R2) fills the square evenly.
    let points = (0..20_000).map(|i| {
        let n = f64::from(i);
        [(n * 0.754_877_666_246_692_7).fract(), (n * 0.569_840_290_998_053_2).fract()]
    });
    let buffer = drawn(area, Glyphs::Braille, |raster| {
        raster.cloud(&unit(area), points, &shades, 0);
    });
    let steps: Vec<u8> = area
        .positions()
        .map(|cell| match buffer[cell].fg {
            Color::Indexed(step) => step,
            other => panic!("{cell:?} has {other:?}"),
        })
        .collect();
    let (least, most) = (steps.iter().min().unwrap(), steps.iter().max().unwrap());
    assert!(most - least <= 1, "{least} to {most}");
}

#[test]
fn a_denser_cell_has_a_later_shade_and_in_ascii_a_heavier_character() {
    let shades: Vec<Shade> = (0..8).map(shade).collect();
    let area = Rect::new(0, 0, 4, 1);
    let points = [1, 10, 100, 1000]
        .into_iter()
        .enumerate()
        .flat_map(|(column, count)| std::iter::repeat_n([(column as f64 + 0.5) / 4.0, 0.5], count));
    let buffer = drawn(area, Glyphs::Ascii, |raster| {
        raster.cloud(&unit(area), points, &shades, 0);
    });
    let colours: Vec<_> = (0..4).map(|x| buffer[(x, 0)].fg).collect();
    assert_eq!(colours, [0, 2, 5, 7].map(Color::Indexed));
    assert_eq!(rows(&buffer), [".=o@"]);
}

/// A curve around a wide cloud is seen at its edge; a cloud so thin that the curve goes through most of its cells is seen itself.
#[test]
fn a_thin_cloud_is_seen_in_place_of_the_curve_around_it() {
    let cloud = [shade(7)];
    let area = Rect::new(0, 0, 40, 20);
    let curve = Pen { style: Style::new().fg(Color::Indexed(1)), ..PLAIN };
    for glyphs in [Glyphs::Braille, Glyphs::Ascii] {
        let seen = |half: f64| {
            let corners = [[0.1, -half], [0.9, -half], [0.9, half], [0.1, half], [0.1, -half]];
            let corners = corners.map(|[x, y]| [x, 0.5 + y]);
            let points = (0..2000).map(|i| {
                let n = f64::from(i);
                let [x, y] =
                    [(n * 0.754_877_666_246_692_7).fract(), (n * 0.569_840_290_998_053_2).fract()];
                [0.1 + 0.8 * x, 0.5 + half * (2.0 * y - 1.0)]
            });
            let buffer = drawn(area, glyphs, |raster| {
                raster.polyline(&unit(area), corners.iter().copied(), &curve);
                raster.cloud(&unit(area), points, &cloud, 2);
            });
            let of = |index: u8| {
                area.positions().filter(|at| buffer[*at].fg == Color::Indexed(index)).count()
            };
            [of(1), of(7)]
        };
        let [edge, inside] = seen(0.4);
        assert!(edge > 20 && inside > 3 * edge, "{edge} {inside}");
        let [edge, inside] = seen(0.001);
        assert!(inside >= 30 && edge <= 2, "{edge} {inside}");
    }
}

#[test]
fn every_pattern_of_dots_has_a_character_of_its_own() {
    for glyphs in Glyphs::ALL.into_iter().filter(|glyphs| !glyphs.is_ascii()) {
        let (across, down) = glyphs.dots();
        let count = across * down;
        let mut symbols: Vec<String> = (1..1_u32 << count)
            .map(|pattern| {
                let buffer = drawn(Rect::new(0, 0, 1, 1), glyphs, |raster| {
                    for dot in (0..count).filter(|dot| pattern & (1 << dot) != 0) {
                        raster.dot([i32::from(dot % across), i32::from(dot / across)], &PLAIN);
                    }
                });
                buffer[(0, 0)].symbol().to_owned()
            })
            .collect();
        assert!(!symbols.contains(&" ".to_owned()), "{glyphs:?}");
        let full = if glyphs == Glyphs::Braille { "⣿" } else { "█" };
        assert_eq!(symbols.last().map(String::as_str), Some(full), "{glyphs:?}");
        let all = symbols.len();
        symbols.sort_unstable();
        symbols.dedup();
        assert_eq!(symbols.len(), all, "{glyphs:?}");
    }
    let corner = |glyphs: Glyphs| {
        let (across, down) = glyphs.dots();
        let last = [i32::from(across) - 1, i32::from(down) - 1];
        drawn(Rect::new(0, 0, 1, 1), glyphs, |r| r.dot(last, &PLAIN))[(0, 0)].symbol().to_owned()
    };
    let corners = [Glyphs::Quadrant, Glyphs::Sextant, Glyphs::Octant, Glyphs::HalfBlock];
    assert_eq!(corners.map(corner), ["▗", "🬞", "\u{1cea0}", "▄"]);
}

#[test]
fn patterns_run_along_lines_of_every_slope() {
    let area = Rect::new(0, 0, 40, 20);
    for end in [[1.0, 0.5], [1.0, 1.0], [0.5, 1.0], [0.02, 1.0], [1.0, 0.02]] {
        let count = |dash: Dash| {
            let mut raster = Raster::new(area, Glyphs::Braille);
            raster.line(&unit(area), [0.0, 0.0], end, &Pen { dash, ..PLAIN });
            raster.count() as f64
        };
        let full = count(Dash::Full);
        for (dash, share) in
            [(Dash::Dashed, 5.0 / 9.0), (Dash::Dotted, 0.25), (Dash::Sparse, 0.125)]
        {
            let drawn = count(dash) / full;
            assert!((drawn - share).abs() < 0.1, "{dash:?} to {end:?}: {drawn}");
        }
    }
}

#[test]
fn in_ascii_a_curve_is_a_curve() {
    let area = Rect::new(0, 0, 24, 4);
    let wave = |x: f64| 0.5 + 0.46 * (std::f64::consts::TAU * x).sin();
    let points = (0..=500).map(|i| f64::from(i) / 500.0).map(|x| [x, wave(x)]);
    let buffer = drawn(area, Glyphs::Ascii, |raster| raster.polyline(&unit(area), points, &PLAIN));
    let seen = rows(&buffer);
    // every column contains something, and there are no gaps between columns
    let row = |x: usize| seen.iter().position(|line| line.chars().nth(x).is_some_and(|c| c != ' '));
    let heights: Vec<usize> = (0..24).map(|x| row(x).expect("a character")).collect();
    assert!(heights.windows(2).all(|pair| pair[0].abs_diff(pair[1]) <= 1), "{seen:#?}");
    assert!(seen.concat().chars().filter(|c| "|+#X".contains(*c)).count() == 0, "{seen:#?}");
}

#[test]
fn in_ascii_lines_without_colour_are_made_of_letters() {
    let area = Rect::new(0, 0, 6, 1);
    let line = |dash| {
        let pen = Pen { dash, ..PLAIN };
        let draw = |raster: &mut Raster| raster.line(&unit(area), [0.0, 0.5], [1.0, 0.5], &pen);
        rows(&drawn(area, Glyphs::Ascii, draw)).concat()
    };
    let all: Vec<String> = Dash::ALL.into_iter().map(line).collect();
    assert_eq!(all, ["------", "++++++", "......", "xxxxxx", "******", "::::::", "%%%%%%"]);
    for (dash, line) in Dash::ALL.into_iter().zip(&all) {
        assert!(line.starts_with(dash.sample()[1]), "the heading shows the same");
    }
}

#[test]
fn shared_cells_are_a_part_of_those_with_dots() {
    let area = Rect::new(0, 0, 10, 1);
    let raster = |from: f64, to: f64| {
        let mut raster = Raster::new(area, Glyphs::Ascii);
        raster.line(&unit(area), [from, 0.5], [to, 0.5], &PLAIN);
        raster
    };
    assert_eq!(raster(0.0, 0.5).shared(&raster(0.75, 1.0)), 0.0);
    assert_eq!(raster(0.0, 1.0).shared(&raster(0.0, 1.0)), 1.0);
    assert_eq!(raster(0.0, 0.999).shared(&raster(0.0, 0.39)), 0.5, "beside counts too");
    assert_eq!(Raster::new(area, Glyphs::Ascii).shared(&raster(0.0, 1.0)), 0.0);
}

/// A halo takes the dots of lower layers around a disc, and no others.
#[test]
fn a_halo_blanks_what_is_below_and_near() {
    let dots = |glyphs: Glyphs, layer: u8, halo: bool| {
        let area = Rect::new(0, 0, 20, 10);
        let frame = PlotFrame { x: Scale::linear(0.0, 40.0), y: Scale::linear(0.0, 40.0), area };
        let mut raster = Raster::new(area, glyphs);
        raster.line(&frame, [0.0, 20.5], [40.0, 20.5], &Pen::new(Style::new(), layer));
        if halo {
            raster.halo(&frame, [20.0, 20.0], 4.0, 2);
        }
        raster.count()
    };
    let whole = dots(Glyphs::Braille, 2, false);
    // of 40 dots in a row those within the radius and a dot and a half
    let left = dots(Glyphs::Braille, 2, true);
    assert!((10..=12).contains(&(whole - left)), "{whole} {left}");
    assert_eq!(dots(Glyphs::Braille, 3, true), whole, "a rod goes on to its mass");
    assert_eq!(dots(Glyphs::Ascii, 2, true), dots(Glyphs::Ascii, 2, false));
}

/// Points of a section are not strokes: in ASCII a cell has the height of one, or that there are several.
#[test]
fn points_are_points_in_ascii() {
    let area = Rect::new(0, 0, 6, 1);
    // two dots beside each other, or one at the height of each row, or two of them
    let dots = [[0, 2], [1, 2], [2, 0], [4, 1], [6, 2], [8, 0], [9, 2]];
    let points = dots.map(|[x, y]| [(f64::from(x) + 0.5) / 12.0, 1.0 - (f64::from(y) + 0.5) / 3.0]);
    let buffer = drawn(area, Glyphs::Ascii, |raster| {
        raster.points(&unit(area), points, &PLAIN);
    });
    assert_eq!(rows(&buffer), [".'..:"]);
}
