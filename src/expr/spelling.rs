//! Signs in the letters of a keyboard: θ is `theta`, x² is `x^2`, ½ is `1/2`.
//!
//! In: a text for the eye. Out: the same in ASCII, as a whole or character by character, so that a search finds what it
//! is typed for. Never here: what a screen can show.

use std::borrow::Cow;
use std::ops::Range;

/// Spells a text in ASCII. Characters without a spelling become `?`; combining dots become primes, as in `x'`; a partial
/// derivative ∂G/∂t, which `dG/dt` is not, is `d_t G`.
pub fn spell(text: &str) -> String {
    let mut out = String::with_capacity(text.len());
    spell_each(&with_indices(text), |_, caret, letters| {
        out.push_str(caret);
        out.push_str(letters);
    });
    out
}

/// A text whose partial derivatives are written with indices: ∂²S/∂q∂α as d_q d_α S. A ∂ that begins none stays.
fn with_indices(text: &str) -> Cow<'_, str> {
    if !text.contains('∂') {
        return Cow::Borrowed(text);
    }
    let mut out = String::with_capacity(text.len());
    let mut rest = text;
    while let Some(at) = rest.find('∂') {
        let (before, derivative) = rest.split_at(at);
        out.push_str(before);
        rest = match partial_derivative(derivative) {
            Some((function, variables, after)) => {
                let indices: Vec<String> =
                    variables.iter().map(|variable| format!("d_{variable}")).collect();
                out.push_str(&indices.join(" "));
                if !function.is_empty() {
                    out.push(' ');
                    out.push_str(function);
                }
                after
            }
            None => {
                out.push('∂');
                &derivative['∂'.len_utf8()..]
            }
        };
    }
    out.push_str(rest);
    Cow::Owned(out)
}

/// The partial derivatives of a text: the characters of each, counted from its first, and how it is spelt in ASCII.
pub fn spelt_derivatives(text: &str) -> Vec<(Range<usize>, String)> {
    let mut found = Vec::new();
    for (count, (at, _)) in text.char_indices().enumerate().filter(|(_, (_, c))| *c == '∂') {
        if let Some((.., after)) = partial_derivative(&text[at..]) {
            let whole = &text[at..text.len() - after.len()];
            found.push((count..count + whole.chars().count(), spell(whole)));
        }
    }
    found
}

/// The function and the variables of the partial derivative that a text begins with, and what follows it.
fn partial_derivative(text: &str) -> Option<(&str, Vec<&str>, &str)> {
    let name = |text: &str| {
        let of_name = |c: char| {
            c.is_alphanumeric() || matches!(c, '_' | '\'' | '′' | '″' | '\u{307}' | '\u{308}')
        };
        text.find(|c: char| !of_name(c)).unwrap_or(text.len())
    };
    let raised = |c: char| superscript(c).is_some();
    let text = text.strip_prefix('∂')?.trim_start_matches(raised);
    let end = if text.starts_with('(') { text.find(')')? + 1 } else { name(text) };
    let (function, mut rest) = text.split_at(end);
    rest = rest.strip_prefix('/')?;
    let mut variables = Vec::new();
    while let Some(variable) = rest.strip_prefix('∂') {
        let (variable, after) = variable.split_at(name(variable));
        if variable.is_empty() {
            return None;
        }
        variables.push(variable);
        rest = after;
    }
    (!variables.is_empty()).then_some((function, variables, rest))
}

/// The letters in which each character of a text is spelt in ASCII, or the character itself where it has no spelling.
pub fn spelt(text: &str) -> Vec<Vec<char>> {
    let mut out = Vec::with_capacity(text.len());
    spell_each(text, |character, caret, letters| {
        out.push(match letters {
            "?" => vec![character],
            letters => caret.chars().chain(letters.chars()).collect(),
        });
    });
    out
}

/// Gives each character of a text with its letters in ASCII, `?` where it has no spelling, and the caret in front of these
/// where an exponent begins.
fn spell_each(text: &str, mut give: impl FnMut(char, &str, &str)) {
    let mut raised = false;
    for character in text.chars() {
        let exponent = superscript(character);
        let caret = if exponent.is_some() && !raised { "^" } else { "" };
        raised = exponent.is_some();
        let ascii = Some(character).filter(char::is_ascii);
        match exponent.or_else(|| subscript(character)).or(ascii) {
            Some(plain) => give(character, caret, plain.encode_utf8(&mut [0; 4])),
            None => give(character, caret, spelling(character)),
        }
    }
}

fn superscript(character: char) -> Option<char> {
    Some(match character {
        '⁰' => '0',
        '¹' => '1',
        '²' => '2',
        '³' => '3',
        '⁴'..='⁹' => char::from(b'4' + (character as u32 - '⁴' as u32) as u8),
        '⁺' => '+',
        '⁻' => '-',
        'ⁿ' => 'n',
        _ => return None,
    })
}

/// The digit that a subscript stands for.
pub fn subscript(character: char) -> Option<char> {
    match character {
        '₀'..='₉' => Some(char::from(b'0' + (character as u32 - '₀' as u32) as u8)),
        _ => None,
    }
}

fn spelling(character: char) -> &'static str {
    match character {
        'α' => "alpha",
        'β' => "beta",
        'γ' => "gamma",
        'δ' => "delta",
        'ε' | 'ϵ' => "epsilon",
        'ζ' => "zeta",
        'η' => "eta",
        'θ' | 'ϑ' => "theta",
        'ι' => "iota",
        'κ' => "kappa",
        'λ' => "lambda",
        'μ' | 'µ' => "mu",
        'ν' => "nu",
        'ξ' => "xi",
        'π' => "pi",
        'ρ' => "rho",
        'σ' | 'ς' => "sigma",
        'τ' => "tau",
        'υ' => "upsilon",
        'φ' | 'ϕ' => "phi",
        'χ' => "chi",
        'ψ' => "psi",
        'ω' => "omega",
        'Γ' => "Gamma",
        'Δ' => "Delta",
        'Θ' => "Theta",
        'Λ' => "Lambda",
        'Ξ' => "Xi",
        'Π' => "Pi",
        'Σ' => "Sigma",
        'Φ' => "Phi",
        'Ψ' => "Psi",
        'Ω' => "Omega",
        'Υ' => "Upsilon",
        '∂' | 'ẟ' => "d",
        '√' => "sqrt",
        '∞' => "inf",
        '∫' | '∮' => "int",
        '½' => "1/2",
        '⅓' => "1/3",
        '⅔' => "2/3",
        '⅕' => "1/5",
        '⅖' => "2/5",
        '⅗' => "3/5",
        '⅘' => "4/5",
        '⅙' => "1/6",
        '⅚' => "5/6",
        '⅛' => "1/8",
        '⅜' => "3/8",
        '⅝' => "5/8",
        '⅞' => "7/8",
        '¼' => "1/4",
        '¾' => "3/4",
        '°' => "deg",
        '⊕' => "_Earth",
        '☉' | '⊙' => "_Sun",
        '§' => "sec. ",
        'ₓ' => "_x",
        'ᵣ' => "_r",
        'ᵀ' => "^T",
        '𝕁' => "J",
        'ᵢ' => "_i",
        'ⱼ' => "_j",
        'ₖ' => "_k",
        'ₙ' => "_n",
        '·' | '⋅' | '∗' => "*",
        '×' | '✗' => "x",
        '−' | '–' | '‐' | '─' | '━' => "-",
        '—' => "--",
        '±' => "+-",
        '≈' => "~",
        '≤' => "<=",
        '≥' => ">=",
        '∝' => "~",
        'ᵏ' => "^k",
        '≠' => "!=",
        '→' => "->",
        '←' => "<-",
        '↑' | '∧' => "^",
        '↓' => "v",
        '↗' | '↙' => "/",
        '↖' | '↘' => "\\",
        '⇒' => "=>",
        '⇔' => "<=>",
        '…' => "...",
        '‘' | '’' | '′' | '\u{307}' => "'",
        '″' | '\u{308}' => "''",
        '‴' => "'''",
        '“' | '”' => "\"",
        'á' | 'à' | 'â' | 'å' | 'ã' => "a",
        'ç' | 'ć' | 'č' => "c",
        'é' | 'è' | 'ê' | 'ë' => "e",
        'í' | 'ì' | 'î' | 'ï' => "i",
        'ñ' | 'ń' => "n",
        'ú' | 'ù' | 'û' => "u",
        'ś' | 'š' => "s",
        'ž' => "z",
        'Å' => "A",
        'Ç' | 'Č' => "C",
        'É' => "E",
        'Š' => "S",
        'Ž' => "Z",
        'Ä' => "Ae",
        'Ö' => "Oe",
        'Ü' => "Ue",
        'ß' => "ss",
        'ä' => "ae",
        'ö' => "oe",
        'ü' => "ue",
        '│' | '┃' => "|",
        'ȧ' => "a'",
        'ṡ' => "s'",
        'ẋ' => "x'",
        'ẍ' => "x''",
        'ẏ' => "y'",
        'ÿ' => "y''",
        'ż' => "z'",
        'ṙ' => "r'",
        'ṗ' => "p'",
        'ℓ' => "l",
        '∇' => "grad",
        '∈' => " in ",
        '⊥' | '⟂' => "perp",
        '∥' => "par",
        '‖' => "||",
        '●' | '○' | '•' | 'ó' | 'ò' | 'ô' | 'ø' => "o",
        '✓' => "ok",
        '\u{a0}' | '\u{2009}' | '\u{202f}' => " ",
        _ => "?",
    }
}
