//! Clauses: remarks with formulas in them, in lines of a given width.
//!
//! In: text. Out: its lines. Never here: paragraphs, and formulas that stand alone.

use unicode_width::UnicodeWidthStr;

use super::wrap::{TextPiece, break_up, fill};

/// The lines of a remark with formulas in it: products and what is in parentheses stay whole, an operator stays with what
/// follows it and `=` with both its sides, as far as there is room.
pub(super) fn clauses(text: &str, width: usize) -> Vec<String> {
    const OPERATORS: [&str; 11] = ["=", "+", "−", "-", "·", "*", "/", "×", "≈", "∝", "∫"];
    let mut whole: Vec<String> = Vec::new();
    let (mut open, mut before) = (0_usize, "");
    let ends = |word: &str| word.ends_with([',', ';', ':']);
    for word in text.split_whitespace() {
        let joined = open > 0 || word == "=" || OPERATORS.contains(&before);
        let product = is_factor(before) && is_factor(word) && !ends(before);
        match whole.last_mut() {
            Some(last) if joined || product && !OPERATORS.contains(&word) => {
                last.push(' ');
                last.push_str(word);
            }
            _ => whole.push(word.to_owned()),
        }
        open += word.matches(['(', '[']).count();
        open = open.saturating_sub(word.matches([')', ']']).count());
        before = word;
    }
    let mut pieces = Vec::new();
    for clause in whole {
        if clause.width() <= width {
            pieces.push(TextPiece { text: clause, spaced: true, nested: 0 });
        } else {
            break_up(&clause, width.max(1), [0, 0], &mut pieces);
        }
    }
    fill(pieces.into_iter(), width, 0, 0)
}

/// Whether a word may be a factor of a formula: no three letters of it follow each other, and it is no short word.
fn is_factor(word: &str) -> bool {
    const SHORT: [&str; 12] =
        ["a", "an", "as", "at", "by", "in", "is", "of", "on", "or", "to", "up"];
    !word.is_empty()
        && !SHORT.contains(&word)
        && word.split(|c: char| !c.is_alphabetic()).all(|run| run.chars().count() < 3)
}

#[cfg(test)]
mod tests {
    use super::clauses;

    #[test]
    fn a_formula_in_a_remark_is_whole_where_there_is_room() {
        let text = "K = ½ k X² + ½ k Y² + (PX² + PY²)/(2 m) − Ω X PY + Ω Y PX";
        for width in 20..60 {
            let lines = clauses(text, width);
            assert_eq!(lines.join(" "), text, "{width}");
            assert!(lines.iter().all(|line| line.chars().count() <= width), "{lines:?}");
            let whole = lines.iter().any(|line| line.contains("(PX² + PY²)/(2 m)"));
            let ends = |line: &String| line.ends_with([' ', '=', '+', '−']);
            assert!(whole && !lines.iter().any(ends), "{lines:?}");
            assert!(lines.iter().any(|line| line.contains("+ Ω Y PX")), "{lines:?}");
        }
        let lines = clauses("from t = 16·2ⁿ to t = 24·2ⁿ", 15);
        assert_eq!(lines, ["from t = 16·2ⁿ", "to t = 24·2ⁿ"]);
        // One that is too long is broken as formulas are, and nothing of it is lost.
        let long = "not 1: (√(p_q² + m² ω² q²)/c)^(1/s − 1)/(c s √(p_q² + m² ω² q²))";
        let lines = clauses(long, 24);
        let letters = |text: &str| text.replace(' ', "");
        assert_eq!(letters(&lines.concat()), letters(long));
        assert!(lines.iter().all(|line| line.chars().count() <= 24), "{lines:?}");
        // An exponent is part of its factor.
        assert!(lines.iter().any(|line| line.contains("^(1/s − 1)")), "{lines:?}");
    }
}
