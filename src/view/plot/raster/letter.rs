//! Letters for dots: the ASCII character whose shape is nearest to the dots of a cell.
//!
//! In: 2×3 dots, or the age of a trail. Out: a character below 0x80. Never here: clouds.
//!
//! A slowly rising line reads `_.-'"`, a steep one `/` and `|`: the character shows the height at which the line
//! crosses its cell, so that a curve looks continuous and not like a row of steps.

/// The character for dots, row by row from the top, with the left dot of a row in the lower bit.
pub(super) fn letter(dots: u8) -> char {
    let [top, middle, bottom] = [0, 2, 4].map(|shift| dots >> shift & 3);
    match (top != 0, middle != 0, bottom != 0) {
        (false, false, false) => ' ',
        (true, false, false) => ['`', '\'', '"'][usize::from(top) - 1],
        (false, true, false) => '-',
        (false, false, true) => ['.', '.', '_'][usize::from(bottom) - 1],
        (true, true, false) => upper(top, middle),
        (false, true, true) => lower(middle, bottom),
        (true, false, true) if top == 3 && bottom == 3 => '=',
        (true, false, true) => ':',
        (true, true, true) => steep(top, middle, bottom),
    }
}

const LEFT: u8 = 1;
const RIGHT: u8 = 2;
const BOTH: u8 = 3;

/// The character for dots in the upper two thirds of the cell.
fn upper(top: u8, middle: u8) -> char {
    match (top, middle) {
        (BOTH, BOTH) => '*',
        (BOTH, _) => '"',
        (LEFT, LEFT) | (RIGHT, RIGHT) => '|',
        (LEFT, _) => '`',
        _ => '\'',
    }
}

/// The character for dots in the lower two thirds.
fn lower(middle: u8, bottom: u8) -> char {
    match (middle, bottom) {
        (BOTH, BOTH) => 'o',
        (_, BOTH) => '_',
        (LEFT, LEFT) | (RIGHT, RIGHT) => '|',
        (_, LEFT) => ',',
        _ => '.',
    }
}

fn steep(top: u8, middle: u8, bottom: u8) -> char {
    let falls = top & LEFT != 0 && bottom & RIGHT != 0;
    let rises = top & RIGHT != 0 && bottom & LEFT != 0;
    match (falls, rises) {
        (true, true) if middle == BOTH => '#',
        (true, true) => 'X',
        (true, false) => '\\',
        (false, true) => '/',
        (false, false) if middle == BOTH => '+',
        (false, false) => '|',
    }
}

/// The character for single points: the height of one, or that there are several.
pub(super) fn points(dots: u8) -> char {
    match [0, 2, 4].map(|shift| dots >> shift & 3 != 0) {
        [true, false, false] => '\'',
        [false, _, _] => '.',
        [true, _, _] => ':',
    }
}

/// The ASCII character for the age of a trail.
pub(super) fn faded(age: usize, ages: usize) -> char {
    const AGES: [char; 4] = ['.', ':', '+', 'o'];
    AGES[(age * AGES.len() / ages.max(1)).min(AGES.len() - 1)]
}

/// The slope, in rows by columns, from which on a line is slanted, and from which on it is upright.
const SLANTED: f64 = 0.5;
const UPRIGHT: f64 = 2.5;

/// The character for the direction of a line, in columns to the right and rows down, that ends at a height in rows.
pub(super) fn stroke([right, down]: [f64; 2], end: f64) -> char {
    match (down / right).abs() {
        slope if slope >= UPRIGHT => '|',
        slope if slope >= SLANTED => ['/', '\\'][usize::from((down > 0.0) == (right > 0.0))],
        _ if end - end.floor() > LOW => '_',
        _ => '-',
    }
}

/// The height in a cell, from its upper edge, below which a level line is at the bottom.
const LOW: f64 = 2.0 / 3.0;

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_stroke_has_the_direction_of_its_line() {
        let high = |along: [f64; 2]| stroke(along, 7.1);
        assert_eq!([[1.0, -1.0], [-1.0, 1.0], [1.0, -2.0]].map(high), ['/'; 3]);
        assert_eq!([[1.0, 1.0], [-1.0, -1.0]].map(high), ['\\'; 2]);
        assert_eq!([[0.0, 1.0], [0.1, -3.0]].map(high), ['|'; 2]);
        assert_eq!([[1.0, 0.0], [3.0, 1.0], [0.0, 0.0], [f64::NAN, 1.0]].map(high), ['-'; 4]);
        assert_eq!([0.5, 0.7, -0.1].map(|end| stroke([1.0, 0.1], end)), ['-', '_', '_']);
    }

    #[test]
    fn every_pattern_has_a_character_and_the_heights_differ() {
        let all: String = (0..64).map(letter).collect();
        assert!(all.chars().skip(1).all(|c| c.is_ascii_graphic()), "{all}");
        // Both dots of a row, and a step from each row to the next.
        let rising = [0b11_00_00, 0b01_10_00, 0b00_11_00, 0b00_01_10, 0b00_00_11];
        assert_eq!(rising.map(letter), ['_', ',', '-', '\'', '"']);
        let falling = [0b00_00_11, 0b00_10_01, 0b00_11_00, 0b10_01_00, 0b11_00_00];
        assert_eq!(falling.map(letter), ['"', '`', '-', '.', '_']);
        assert_eq!(
            [0b01_01_01, 0b10_10_10, 0b10_01_01, 0b01_10_10].map(letter),
            ['|', '|', '\\', '/']
        );
        assert_eq!(letter(0b11_11_11), '#');
    }
}
