//! Blocks at the edges of surfaces: the character that fills nearly the part of a cell that its covered dots stand for.
//!
//! In: covered dots, as braille has them. Out: a block. Never here: colours.

use std::sync::LazyLock;

use ratatui::symbols::pixel::QUADRANTS;

/// The dots of each quarter of a cell, as braille has them, in the order of [`QUADRANTS`].
const QUARTERS: [u8; 4] = [0x03, 0x18, 0x44, 0xa0];

/// The blocks of whole rows of dots: the lower and the upper half, the last of the four rows, the last three, and the first, for
/// which there is one of half its height.
const ROWS: [(u8, char); 5] = [(0xe4, '▄'), (0x1b, '▀'), (0xc0, '▂'), (0xf6, '▆'), (0x09, '▔')];

/// The dots of the left half of a cell.
const LEFT: u8 = 0x47;

/// The block that differs from these dots by the fewest of them; `None` if that is the whole cell. Of those that differ by as many, a
/// whole row comes first where both halves of the cell have dots: a flat edge is not notched.
pub(super) fn nearest(dots: u8) -> Option<char> {
    NEAREST[usize::from(dots)]
}

/// The block of each set of dots.
static NEAREST: LazyLock<Vec<Option<char>>> =
    LazyLock::new(|| (0..=u8::MAX).map(least_apart).collect());

fn least_apart(dots: u8) -> Option<char> {
    let quadrants = (1..15).map(|set: usize| {
        let filled = (0..4).filter(|k| set >> k & 1 == 1).fold(0, |dots, k| dots | QUARTERS[k]);
        (filled, QUADRANTS[set])
    });
    let apart = |filled: u8| (filled ^ dots).count_ones();
    let is_wide = dots & LEFT != 0 && dots & !LEFT != 0;
    let first = ROWS.into_iter().filter(|_| is_wide);
    let (filled, block) =
        first.chain(quadrants).chain(ROWS).min_by_key(|(filled, _)| apart(*filled))?;
    (apart(filled) < apart(u8::MAX)).then_some(block)
}

#[cfg(test)]
mod tests {
    use super::nearest;

    #[test]
    fn a_block_fills_what_the_dots_cover() {
        let rows = [0x09, 0x1b, 0x3f, 0xff, 0xf6, 0xe4, 0xc0];
        let expected = [Some('▔'), Some('▀'), None, None, Some('▆'), Some('▄'), Some('▂')];
        assert_eq!(rows.map(nearest), expected);
        assert_eq!([0x47, 0xb8, 0x03, 0xe7].map(nearest), ['▌', '▐', '▘', '▙'].map(Some));
        // of a quarter one dot is enough, and of the whole cell one may be missing
        assert_eq!([0x01, 0x80, 0x7f, 0xf7].map(nearest), [Some('▘'), Some('▗'), None, None]);
    }

    /// Each of these columns of cells is as high as the dots in it, or higher: ▂▗▄ would have a notch.
    #[test]
    fn a_flat_edge_has_no_notches() {
        let low = [0x40, 0x44, 0x46, 0x47];
        let right = [0x80, 0xa0, 0xb0, 0xb8];
        let of = |[left, on]: [usize; 2]| nearest(low[left - 1] | right[on - 1]);
        let rising = [[1, 1], [1, 2], [2, 2], [2, 3], [3, 3], [3, 4]].map(of);
        assert_eq!(rising, ['▂', '▄', '▄', '▄', '▆', ' '].map(|c| (c != ' ').then_some(c)));
        let falling = [[3, 2], [2, 1], [1, 1]].map(of);
        assert_eq!(falling, ['▄', '▄', '▂'].map(Some));
        // the upper edge of what hangs down, and a steep one
        assert_eq!([nearest(0x0b), nearest(0x19)], [Some('▀'), Some('▀')]);
        assert_eq!([of([1, 4]), of([2, 4])], ['▐', '▟'].map(Some));
    }
}
