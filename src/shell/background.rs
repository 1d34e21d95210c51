//! The terminal's background as it answers, so that a light one gets the light theme.
//!
//! In: the terminal's answer. Out: a colour. Never here: asking (`question`), or what is done with it.

use crate::view::colour::Rgb;

/// Returns the colour of an answer, as `XParseColor` reads it: `rgb:` or `rgba:` with one to four hexadecimal digits for
/// each channel, or `#` with as many digits for each of the three.
pub(super) fn colour(answer: &[u8]) -> Option<Rgb> {
    let text = str::from_utf8(answer).ok()?.trim();
    let [r, g, b] = if let Some(digits) = text.strip_prefix('#') {
        let each = digits.len() / 3;
        let whole = digits.is_ascii() && digits.len() == 3 * each;
        let part = |n: usize| digits.get(n * each..(n + 1) * each).and_then(|d| channel(d, false));
        if !whole {
            return None;
        }
        [part(0)?, part(1)?, part(2)?]
    } else {
        let (parts, count) = match text.strip_prefix("rgba:") {
            Some(parts) => (parts, 4),
            None => (text.strip_prefix("rgb:")?, 3),
        };
        let parts: Option<Vec<u8>> = parts.split('/').map(|digits| channel(digits, true)).collect();
        let parts = parts.filter(|parts| parts.len() == count)?;
        [parts[0], parts[1], parts[2]]
    };
    Some(Rgb(r, g, b))
}

/// Returns a channel of one to four hexadecimal digits in 8 bits. With `scaled`, all digits at their highest are full
/// intensity; otherwise the digits are the most significant of four.
fn channel(digits: &str, scaled: bool) -> Option<u8> {
    let known = (1..=4).contains(&digits.len()) && digits.bytes().all(|d| d.is_ascii_hexdigit());
    let value = u32::from_str_radix(digits, 16).ok().filter(|_| known)?;
    let bits = 4 * digits.len() as u32;
    let eight = if scaled {
        (value * 255 + ((1 << bits) - 1) / 2) / ((1 << bits) - 1)
    } else {
        (value << (16 - bits)) >> 8
    };
    u8::try_from(eight).ok()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn answers_of_every_form_are_read() {
        let check = |answer: &str, expected: Option<[u8; 3]>| {
            let expected = expected.map(|[r, g, b]| Rgb(r, g, b));
            assert_eq!(colour(answer.as_bytes()), expected, "{answer:?}");
        };
        check("rgb:ffff/ffff/ffff", Some([255, 255, 255]));
        check("rgb:1e1e/1e1e/2e2e", Some([0x1e, 0x1e, 0x2e]));
        check("rgb:fd/f6/e3", Some([0xfd, 0xf6, 0xe3]));
        check("rgb:f/0/8", Some([255, 0, 136]));
        check("rgb:fff/000/7ff", Some([255, 0, 127]));
        check("rgba:0000/8080/ffff/ffff", Some([0, 128, 255]));
        check("#fff", Some([0xf0, 0xf0, 0xf0]));
        check("#fdf6e3", Some([0xfd, 0xf6, 0xe3]));
        check("#ffff80800000", Some([255, 128, 0]));
        for noise in [
            "",
            "?",
            "rgb:",
            "rgb:1/2",
            "rgb:1/2/3/4",
            "rgba:1/2/3",
            "rgb:12345/0/0",
            "rgb:g/0/0",
            "rgb:+1/0/0",
            "#",
            "#ffff",
            "#1234567890abcde",
            "#é0",
            "white",
            "rgb:-1/0/0",
            "rgb://",
        ] {
            check(noise, None);
        }
        assert_eq!(colour(b"rgb:\xff/0/0"), None);
    }
}
