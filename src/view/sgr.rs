//! The parameters of select graphic rendition (SGR), the `m` sequence of ECMA-48.
//!
//! In: colours and modifiers. Out: numbers. Never here: the sequence around them, or what a terminal supports.

use ratatui::style::{Color, Modifier};

/// The first parameter of foreground colours.
pub const FOREGROUND: u16 = 30;
/// The first parameter of background colours.
pub const BACKGROUND: u16 = 40;

/// Each modifier with the parameters that turn it on and off. Bold and dim are turned off together.
pub const MODIFIERS: [(Modifier, u16, u16); 9] = [
    (Modifier::BOLD, 1, 22),
    (Modifier::DIM, 2, 22),
    (Modifier::ITALIC, 3, 23),
    (Modifier::UNDERLINED, 4, 24),
    (Modifier::SLOW_BLINK, 5, 25),
    (Modifier::RAPID_BLINK, 6, 25),
    (Modifier::REVERSED, 7, 27),
    (Modifier::HIDDEN, 8, 28),
    (Modifier::CROSSED_OUT, 9, 29),
];

/// The parameters that turn modifiers on.
pub fn weights(modifier: Modifier) -> impl Iterator<Item = u16> {
    MODIFIERS.into_iter().filter(move |(m, ..)| modifier.contains(*m)).map(|(_, on, _)| on)
}

/// The parameters that reset the style and set these modifiers and colours.
pub fn afresh(modifier: Modifier, fg: Color, bg: Color) -> Vec<u16> {
    let mut numbers = vec![0];
    numbers.extend(weights(modifier));
    for (colour, ground) in [(fg, FOREGROUND), (bg, BACKGROUND)] {
        if colour != Color::Reset {
            numbers.extend(self::colour(colour, ground));
        }
    }
    numbers
}

/// The parameters that select a colour for a ground, [`FOREGROUND`] or [`BACKGROUND`].
pub fn colour(colour: Color, ground: u16) -> Vec<u16> {
    let bright = ground + 60;
    match colour {
        Color::Reset => vec![ground + 9],
        Color::Black => vec![ground],
        Color::Red => vec![ground + 1],
        Color::Green => vec![ground + 2],
        Color::Yellow => vec![ground + 3],
        Color::Blue => vec![ground + 4],
        Color::Magenta => vec![ground + 5],
        Color::Cyan => vec![ground + 6],
        Color::Gray => vec![ground + 7],
        Color::DarkGray => vec![bright],
        Color::LightRed => vec![bright + 1],
        Color::LightGreen => vec![bright + 2],
        Color::LightYellow => vec![bright + 3],
        Color::LightBlue => vec![bright + 4],
        Color::LightMagenta => vec![bright + 5],
        Color::LightCyan => vec![bright + 6],
        Color::White => vec![bright + 7],
        Color::Indexed(index) => vec![ground + 8, 5, index.into()],
        Color::Rgb(r, g, b) => vec![ground + 8, 2, r.into(), g.into(), b.into()],
    }
}

/// The parameters as they are written in a sequence.
pub fn written(numbers: &[u16]) -> String {
    numbers.iter().map(u16::to_string).collect::<Vec<_>>().join(";")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_those_of_the_standard() {
        let check = |modifier, fg, bg, expected: &str| {
            assert_eq!(written(&afresh(modifier, fg, bg)), expected);
        };
        check(Modifier::empty(), Color::Reset, Color::Reset, "0");
        check(Modifier::BOLD | Modifier::REVERSED, Color::Red, Color::White, "0;1;7;31;107");
        check(Modifier::DIM, Color::DarkGray, Color::Gray, "0;2;90;47");
        check(Modifier::empty(), Color::Indexed(214), Color::Rgb(1, 2, 3), "0;38;5;214;48;2;1;2;3");
        assert_eq!(colour(Color::Reset, BACKGROUND), [49]);
    }
}
