//! The notation of a plain ASCII name: Greek letters for their names, and subscripts for trailing
//! digits and for whatever follows an underscore (`theta1` → θ₁, `omega_0` → ω₀; `p_x` only
//! in LaTeX).

const GREEK: [(&str, &str); 34] = [
    ("alpha", "α"),
    ("beta", "β"),
    ("gamma", "γ"),
    ("delta", "δ"),
    ("epsilon", "ε"),
    ("zeta", "ζ"),
    ("eta", "η"),
    ("theta", "θ"),
    ("iota", "ι"),
    ("kappa", "κ"),
    ("lambda", "λ"),
    ("mu", "μ"),
    ("nu", "ν"),
    ("xi", "ξ"),
    ("rho", "ρ"),
    ("sigma", "σ"),
    ("tau", "τ"),
    ("upsilon", "υ"),
    ("phi", "φ"),
    ("chi", "χ"),
    ("psi", "ψ"),
    ("omega", "ω"),
    ("Gamma", "Γ"),
    ("Delta", "Δ"),
    ("Theta", "Θ"),
    ("Lambda", "Λ"),
    ("Xi", "Ξ"),
    ("Pi", "Π"),
    ("Sigma", "Σ"),
    ("Upsilon", "Υ"),
    ("Phi", "Φ"),
    ("Psi", "Ψ"),
    ("Omega", "Ω"),
    ("ell", "ℓ"),
];

/// The Unicode notation of a name: `omega0` → `ω₀`, `x1` → `x₁`.
pub fn unicode_name(name: &str) -> String {
    let (stem, subscript) = split(name);
    let stem = GREEK.iter().find(|(n, _)| *n == stem).map_or(stem, |(_, g)| g);
    let lowered: Option<String> = subscript.chars().map(subscript_character).collect();
    match lowered {
        Some(lowered) => format!("{stem}{lowered}"),
        None => format!("{stem}_{}", unicode_name(subscript)),
    }
}

/// A text with the digits behind a single letter below the line: `by F1` → `by F₁`.
pub fn with_subscripts(text: &str) -> String {
    let is_of_word = |c: char| c.is_alphanumeric() || c == '_';
    let lowered = |word: &str| {
        let mut letters = word.chars();
        let is_letter = letters.next().is_some_and(|c| c.is_ascii_alphabetic());
        let digits = letters.as_str();
        let is_number = !digits.is_empty() && digits.chars().all(|c| c.is_ascii_digit());
        if is_letter && is_number { unicode_name(word) } else { word.to_owned() }
    };
    let mut shown = String::new();
    for word in text.split_inclusive(|c| !is_of_word(c)) {
        let letters = word.trim_end_matches(|c| !is_of_word(c));
        shown.push_str(&lowered(letters));
        shown.push_str(&word[letters.len()..]);
    }
    shown
}

/// The LaTeX notation of a name: `omega0` → `\omega_{0}`.
pub fn latex_name(name: &str) -> String {
    let (stem, subscript) = split(name);
    let stem = if GREEK.iter().any(|(n, _)| *n == stem) {
        format!("\\{stem}")
    } else if stem.chars().count() > 1 {
        format!("\\mathrm{{{}}}", stem.replace('_', "\\_"))
    } else {
        stem.to_owned()
    };
    if subscript.is_empty() { stem } else { format!("{stem}_{{{}}}", latex_name(subscript)) }
}

/// The plain name of which this is the notation, with its index below the line or on it: `θ₁` and `θ1` → `theta1`. `None` if a
/// character has none.
pub fn plain_name(shown: &str) -> Option<String> {
    let mut name = String::new();
    for c in shown.chars() {
        if let Some((letter, _)) = GREEK.iter().find(|(_, g)| g.chars().eq([c])) {
            name.push_str(letter);
        } else if let Some(digit) = ('0'..='9').find(|&d| subscript_character(d) == Some(c)) {
            name.push(digit);
        } else if c.is_ascii_alphanumeric() || c == '_' {
            name.push(c);
        } else {
            return None;
        }
    }
    Some(name).filter(|name| [shown, &subscripts(shown)].contains(&unicode_name(name).as_str()))
}

/// LaTeX for a Unicode symbol from a file (`θ`, `I₁`), with letters by their names. What would be a command of LaTeX is written out;
/// a single `_` before a letter remains an index.
pub fn latex_of_unicode(shown: &str) -> String {
    let mut latex = String::new();
    let mut below = String::new();
    let has_index =
        shown.matches('_').count() == 1 && !shown.starts_with('_') && !shown.ends_with('_');
    for c in shown.chars() {
        if let Some(digit) = ('0'..='9').find(|&d| subscript_character(d) == Some(c)) {
            below.push(digit);
        } else if let Some((name, _)) = GREEK.iter().find(|(_, g)| g.chars().eq([c])) {
            latex.push('\\');
            latex.push_str(name);
            latex.push(' ');
        } else if "&%$#{}".contains(c) || c == '_' && !has_index {
            latex.extend(['\\', c]);
        } else {
            match c {
                '\\' => latex.push_str("\\backslash "),
                '^' => latex.push_str("\\wedge "),
                '~' => latex.push_str("\\sim "),
                _ => latex.push(c),
            }
        }
    }
    let latex = latex.trim_end().to_owned();
    if below.is_empty() { latex } else { format!("{latex}_{{{below}}}") }
}

/// Splits a name into its stem and its subscript.
fn split(name: &str) -> (&str, &str) {
    if let Some((stem, subscript)) = name.split_once('_')
        && !stem.is_empty()
        && !subscript.is_empty()
    {
        return (stem, subscript);
    }
    let digits = name.bytes().rev().take_while(u8::is_ascii_digit).count();
    let (stem, subscript) = name.split_at(name.len() - digits);
    if stem.is_empty() { (name, "") } else { (stem, subscript) }
}

/// A text with its digits below the line.
pub fn subscripts(text: &str) -> String {
    text.chars().map(|c| subscript_character(c).unwrap_or(c)).collect()
}

/// Digits only: Unicode has x and r below the line but no y and no z, and `pₓ² + p_y²` would look like two kinds of
/// thing.
fn subscript_character(c: char) -> Option<char> {
    c.is_ascii_digit().then(|| char::from_u32('₀' as u32 + c as u32 - '0' as u32))?
}

/// A name with its letters below the line behind `_`, as names are shown: `p_x` for `pₓ`.
pub(super) fn on_the_line(name: &str) -> String {
    let mut line = String::new();
    let mut below = false;
    for c in name.chars() {
        let letter = match c {
            'ᵢ' => Some('i'),
            'ⱼ' => Some('j'),
            'ᵣ' => Some('r'),
            'ₓ' => Some('x'),
            _ => None,
        };
        if letter.is_some() && !below {
            line.push('_');
        }
        below = letter.is_some();
        line.push(letter.unwrap_or(c));
    }
    line
}

/// The digit of a digit below the line.
pub(super) fn plain_digit(c: char) -> Option<char> {
    ('0'..='9').find(|&digit| subscript_character(digit) == Some(c))
}

/// The letter n above the line, the only one that most fonts have there.
pub(super) const RAISED_N: char = 'ⁿ';

/// The digit or minus of one above the line.
pub(super) fn raised_digit(c: char) -> Option<char> {
    Some(match c {
        '⁻' => '-',
        '¹' => '1',
        '²' => '2',
        '³' => '3',
        '⁰' | '⁴'..='⁹' => char::from_u32(c as u32 - '⁰' as u32 + '0' as u32)?,
        _ => return None,
    })
}

/// The letter below one or two dots, for letters that Unicode has with their dots.
pub(super) fn dotted_letter(c: char) -> Option<(char, usize)> {
    Some(match c {
        'ẋ' => ('x', 1),
        'ẏ' => ('y', 1),
        'ż' => ('z', 1),
        'ṙ' => ('r', 1),
        'ṡ' => ('s', 1),
        'ȧ' => ('a', 1),
        'ṗ' => ('p', 1),
        'ẍ' => ('x', 2),
        'ÿ' => ('y', 2),
        _ => return None,
    })
}

pub(super) const FRACTIONS: [(i64, i64, char); 15] = [
    (1, 2, '½'),
    (1, 3, '⅓'),
    (2, 3, '⅔'),
    (1, 4, '¼'),
    (3, 4, '¾'),
    (1, 5, '⅕'),
    (2, 5, '⅖'),
    (3, 5, '⅗'),
    (4, 5, '⅘'),
    (1, 6, '⅙'),
    (5, 6, '⅚'),
    (1, 8, '⅛'),
    (3, 8, '⅜'),
    (5, 8, '⅝'),
    (7, 8, '⅞'),
];

/// The two numbers of a fraction that is one character.
pub(super) fn vulgar_fraction(c: char) -> Option<(i64, i64)> {
    FRACTIONS.iter().find(|f| f.2 == c).map(|f| (f.0, f.1))
}

/// A shown name without its dots and primes, and their number: `φ̇₀` is (`φ₀`, 1). Letters below the line are written
/// `_x`. A name that is typed is looked up by it.
pub fn without_dots(shown: &str) -> (String, usize) {
    let mut dots = 0;
    let mut name = String::new();
    for c in shown.chars() {
        match c {
            '\'' | '′' | '\u{307}' => dots += 1,
            '″' | '\u{308}' => dots += 2,
            c => {
                let (letter, above) = dotted_letter(c).unwrap_or((c, 0));
                name.push(letter);
                dots += above;
            }
        }
    }
    (on_the_line(&name), dots)
}

/// An integer in superscript digits.
pub(super) fn superscript(n: i64) -> String {
    n.to_string()
        .chars()
        .map(|c| match c {
            '-' => '⁻',
            '1' => '¹',
            '2' => '²',
            '3' => '³',
            digit => char::from_u32('⁰' as u32 + digit as u32 - '0' as u32).unwrap_or(digit),
        })
        .collect()
}
