//! Characters drawn as shapes within a cell: braille dots, blocks, shades and box-drawing lines.
//!
//! In: a character. Out: its dots, rectangles or strokes, in units of a cell 8 wide and 16 high. Never here: colours,
//! or the position of the cell.

use ratatui::symbols::pixel::OCTANTS;

/// The width and height of a cell.
pub(in crate::record) const CELL: (f64, f64) = (8.0, 16.0);

pub(in crate::record) const DOT: f64 = 1.45;

#[derive(Clone, Debug, PartialEq)]
pub(in crate::record) enum GlyphShape {
    Dots(Vec<(f64, f64)>),
    /// Rectangles as left, top, width and height; and their opacity.
    Blocks(Vec<[f64; 4]>, f64),
    /// A stroke as SVG path data; whether it is heavy.
    Stroke(&'static str, bool),
}

impl GlyphShape {
    /// The shape of a character; letters have none.
    pub(in crate::record) fn of(character: char) -> Option<GlyphShape> {
        match character {
            '\u{2800}'..='\u{28ff}' => Some(GlyphShape::Dots(dots(character as u32 - 0x2800))),
            '░' => Some(GlyphShape::Blocks(vec![[0.0, 0.0, 8.0, 16.0]], 0.25)),
            '▒' => Some(GlyphShape::Blocks(vec![[0.0, 0.0, 8.0, 16.0]], 0.5)),
            '▓' => Some(GlyphShape::Blocks(vec![[0.0, 0.0, 8.0, 16.0]], 0.75)),
            _ => blocks(character)
                .map(|blocks| GlyphShape::Blocks(blocks, 1.0))
                .or_else(|| stroke(character).map(|(data, heavy)| GlyphShape::Stroke(data, heavy))),
        }
    }
}

/// The dots of a braille pattern: bits 0 to 2 down the left, 3 to 5 down the right, 6 and 7 below them.
fn dots(bits: u32) -> Vec<(f64, f64)> {
    const PLACES: [(f64, f64); 8] = [
        (2.0, 2.0),
        (2.0, 6.0),
        (2.0, 10.0),
        (6.0, 2.0),
        (6.0, 6.0),
        (6.0, 10.0),
        (2.0, 14.0),
        (6.0, 14.0),
    ];
    (0..8).filter(|bit| bits >> bit & 1 == 1).map(|bit| PLACES[bit as usize]).collect()
}

fn blocks(character: char) -> Option<Vec<[f64; 4]>> {
    let code = character as u32;
    let quadrants = |bits: u32| {
        let places = [(0.0, 0.0), (4.0, 0.0), (0.0, 8.0), (4.0, 8.0)];
        let set = places.iter().enumerate().filter(|(bit, _)| bits >> bit & 1 == 1);
        set.map(|(_, (x, y))| [*x, *y, 4.0, 8.0]).collect()
    };
    Some(match character {
        '▀' => vec![[0.0, 0.0, 8.0, 8.0]],
        // from an eighth at the bottom to the full block
        '▁'..='█' => {
            let height = f64::from(code - 0x2580) * 2.0;
            vec![[0.0, 16.0 - height, 8.0, height]]
        }
        // from seven eighths at the left to one
        '▉'..='▏' => vec![[0.0, 0.0, f64::from(0x2590 - code), 16.0]],
        '▐' => vec![[4.0, 0.0, 4.0, 16.0]],
        '▔' => vec![[0.0, 0.0, 8.0, 2.0]],
        '▖' => quadrants(4),
        '▗' => quadrants(8),
        '▘' => quadrants(1),
        '▙' => quadrants(1 + 4 + 8),
        '▚' => quadrants(1 + 8),
        '▛' => quadrants(1 + 2 + 4),
        '▜' => quadrants(1 + 2 + 8),
        '▝' => quadrants(2),
        '▞' => quadrants(2 + 4),
        '▟' => quadrants(2 + 4 + 8),
        // sextants, two columns by three rows; the halves and the full block have other code points
        '\u{1fb00}'..='\u{1fb3b}' => {
            let n = code - 0x1fb00 + 1;
            let bits = n + u32::from(n > 20) + u32::from(n > 40);
            let third = 16.0 / 3.0;
            let set = (0..6).filter(|bit| bits >> bit & 1 == 1);
            set.map(|bit: u32| [f64::from(bit % 2) * 4.0, f64::from(bit / 2) * third, 4.0, third])
                .collect()
        }
        // octants, two columns by four rows; those that are blocks of other kinds as well have code points elsewhere
        _ if code > 0x1c000 => {
            let bits = OCTANTS.iter().position(|octant| *octant == character)?;
            let set = (0..8_u32).filter(|bit| bits >> bit & 1 == 1);
            set.map(|bit| [f64::from(bit % 2) * 4.0, f64::from(bit / 2) * 4.0, 4.0, 4.0]).collect()
        }
        _ => return None,
    })
}

fn stroke(character: char) -> Option<(&'static str, bool)> {
    Some(match character {
        '─' => ("M0 8H8", false),
        '│' => ("M4 0V16", false),
        '╭' => ("M4 16V12Q4 8 8 8", false),
        '╮' => ("M0 8Q4 8 4 12V16", false),
        '╰' => ("M4 0V4Q4 8 8 8", false),
        '╯' => ("M0 8Q4 8 4 4V0", false),
        '┌' => ("M4 16V8H8", false),
        '┐' => ("M0 8H4V16", false),
        '└' => ("M4 0V8H8", false),
        '┘' => ("M0 8H4V0", false),
        '├' => ("M4 0V16M4 8H8", false),
        '┤' => ("M4 0V16M0 8H4", false),
        '┬' => ("M0 8H8M4 8V16", false),
        '┴' => ("M0 8H8M4 0V8", false),
        '┼' => ("M0 8H8M4 0V16", false),
        '┈' => ("M.5 8H1.5M2.5 8H3.5M4.5 8H5.5M6.5 8H7.5", false),
        '┊' => ("M4 1V3M4 5V7M4 9V11M4 13V15", false),
        '━' => ("M0 8H8", true),
        '┃' => ("M4 0V16", true),
        '┏' => ("M4 16V8H8", true),
        '┓' => ("M0 8H4V16", true),
        '┗' => ("M4 0V8H8", true),
        '┛' => ("M0 8H4V0", true),
        _ => return None,
    })
}

/// A part of a stroke, which begins where the last one ended.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(in crate::record) enum PathPart {
    /// Begins elsewhere.
    Move((f64, f64)),
    /// A line to a point.
    Line((f64, f64)),
    /// A quadratic Bézier curve: its control point and its end.
    Curve((f64, f64), (f64, f64)),
}

/// The parts of SVG path data with the commands `M`, `H`, `V` and `Q`, which is all that strokes have.
pub(in crate::record) fn path_parts(data: &str) -> Vec<PathPart> {
    let (mut parts, mut at) = (Vec::new(), (0.0, 0.0));
    let mut rest = data;
    while let Some(command) = rest.chars().next() {
        let tail = &rest[1..];
        let end = tail.find(|c: char| c.is_ascii_alphabetic()).unwrap_or(tail.len());
        let numbers: Vec<f64> = tail[..end].split(' ').filter_map(|n| n.parse().ok()).collect();
        let part = match (command, numbers.as_slice()) {
            ('M', &[x, y]) => PathPart::Move((x, y)),
            ('H', &[x]) => PathPart::Line((x, at.1)),
            ('V', &[y]) => PathPart::Line((at.0, y)),
            ('Q', &[a, b, x, y]) => PathPart::Curve((a, b), (x, y)),
            _ => break,
        };
        at = match part {
            PathPart::Move(to) | PathPart::Line(to) | PathPart::Curve(_, to) => to,
        };
        parts.push(part);
        rest = &tail[end..];
    }
    parts
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_braille_pattern_has_as_many_dots_as_bits() {
        for bits in 0..256_u32 {
            let character = char::from_u32(0x2800 + bits).expect("braille");
            let Some(GlyphShape::Dots(dots)) = GlyphShape::of(character) else { panic!("no dots") };
            assert_eq!(dots.len() as u32, bits.count_ones(), "{character}");
        }
        assert_eq!(GlyphShape::of('⠁'), Some(GlyphShape::Dots(vec![(2.0, 2.0)])));
        assert_eq!(GlyphShape::of('⢀'), Some(GlyphShape::Dots(vec![(6.0, 14.0)])));
    }

    #[test]
    fn every_stroke_is_read_to_its_end() {
        let strokes: Vec<&str> = ('─'..='╿').filter_map(stroke).map(|(data, _)| data).collect();
        assert!(strokes.len() > 20, "{strokes:?}");
        for data in strokes {
            let commands = data.chars().filter(char::is_ascii_alphabetic).count();
            assert_eq!(path_parts(data).len(), commands, "{data}");
        }
        let corner = [
            PathPart::Move((4.0, 16.0)),
            PathPart::Line((4.0, 12.0)),
            PathPart::Curve((4.0, 8.0), (8.0, 8.0)),
        ];
        assert_eq!(path_parts("M4 16V12Q4 8 8 8"), corner);
    }

    /// Octants are numbered row by row in their Unicode names: U+1CD00 is octant 3, U+1CD02 octant 123, the last one 2345678.
    #[test]
    fn octants_are_where_their_names_say() {
        let check = |character: char, numbers: &[u32]| {
            let place =
                |n: &u32| [f64::from((n - 1) % 2) * 4.0, f64::from((n - 1) / 2) * 4.0, 4.0, 4.0];
            let expected: Vec<[f64; 4]> = numbers.iter().map(place).collect();
            let shape = GlyphShape::of(character);
            assert_eq!(shape, Some(GlyphShape::Blocks(expected, 1.0)), "{character}");
        };
        check('\u{1cd00}', &[3]);
        check('\u{1cd01}', &[2, 3]);
        check('\u{1cd02}', &[1, 2, 3]);
        check('\u{1cde5}', &[2, 3, 4, 5, 6, 7, 8]);
        for (bits, octant) in OCTANTS.into_iter().enumerate().skip(1) {
            let Some(GlyphShape::Blocks(blocks, _)) = GlyphShape::of(octant) else {
                panic!("{octant} has no shape");
            };
            let area: f64 = blocks.iter().map(|[.., w, h]| w * h).sum();
            assert!((area - 16.0 * f64::from(bits.count_ones())).abs() < 1e-9, "{octant}");
        }
    }

    #[test]
    fn blocks_cover_what_they_should() {
        let area = |character: char| match GlyphShape::of(character) {
            Some(GlyphShape::Blocks(blocks, _)) => {
                blocks.iter().map(|[.., w, h]| w * h).sum::<f64>()
            }
            other => panic!("{character}: {other:?}"),
        };
        let check = |character, eighths: f64| {
            assert!((area(character) - eighths * 16.0).abs() < 1e-9, "{character}");
        };
        check('█', 8.0);
        check('▁', 1.0);
        check('▄', 4.0);
        check('▀', 4.0);
        check('▏', 1.0);
        check('▌', 4.0);
        check('▟', 6.0);
        check('\u{1fb00}', 8.0 / 6.0);
        check('\u{1fb3b}', 5.0 * 8.0 / 6.0);
        assert_eq!(GlyphShape::of('a'), None);
    }
}
