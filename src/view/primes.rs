//! Primes: a derivative in a sentence is written as it is everywhere else on the screen, `x′` and not `x'`.
//!
//! In: text in which a rate has apostrophes, as in files. Out: the same text with primes there. Never here: formulas,
//! which are printed with primes, and what is to be typed.

/// The text with a prime for every apostrophe after a symbol: a letter of its own, with an index or without. An
/// apostrophe within a word or after one stays, as in Kepler's and the bodies', and what is between two grave accents
/// stays as it is typed.
pub(super) fn with_primes(text: &str) -> String {
    let mut parts: Vec<String> = text.split('`').map(str::to_owned).collect();
    let typed = parts.len() % 2 == 1;
    for (index, part) in parts.iter_mut().enumerate() {
        if !(typed && index % 2 == 1) {
            *part = primed(part);
        }
    }
    parts.join("`")
}

fn primed(text: &str) -> String {
    let mut out = String::with_capacity(text.len());
    let mut word = String::new();
    let mut prime = false;
    let mut rest = text.chars().peekable();
    while let Some(c) = rest.next() {
        if c != '\'' {
            prime = false;
            if belongs(c) {
                word.push(c);
            } else {
                word.clear();
            }
            out.push(c);
            continue;
        }
        let within = rest.peek().is_some_and(|next| next.is_alphabetic());
        prime = !within && (prime || is_symbol(&word));
        out.push(if prime { '′' } else { c });
        if within {
            word.push(c);
        } else {
            word.clear();
        }
    }
    out
}

/// Whether a character may be part of a word or of a symbol with its index.
fn belongs(c: char) -> bool {
    c.is_alphanumeric() || c == '_' || is_index(c)
}

fn is_index(c: char) -> bool {
    matches!(c, '₀'..='₉')
}

/// Whether a word is a symbol: one letter, then perhaps an index.
fn is_symbol(word: &str) -> bool {
    let mut letters = word.trim_start_matches(char::is_numeric).chars();
    let first = letters.next().is_some_and(char::is_alphabetic);
    first && letters.next().is_none_or(|next| next == '_' || is_index(next) || next.is_numeric())
}

#[cfg(test)]
mod tests {
    use super::with_primes;

    #[test]
    fn rates_have_primes_and_words_keep_their_apostrophes() {
        let check = |text: &str, shown: &str| assert_eq!(with_primes(text), shown);
        check("x' sin φ = y' cos φ", "x′ sin φ = y′ cos φ");
        check("½ m r²θ'² and φ', v_x', θ₁' (x1')", "½ m r²θ′² and φ′, v_x′, θ₁′ (x1′)");
        check(
            "Kepler's ellipse, the bodies' masses, L's",
            "Kepler's ellipse, the bodies' masses, L's",
        );
        check("x'' = 0", "x′′ = 0");
        check("don't; p_φ', 2θ' and `theta'` or `x''`", "don't; p_φ′, 2θ′ and `theta'` or `x''`");
    }
}
