//! Colours and glyphs chosen from the environment.

use phaselab::view::colour::ColourDepth::{self, Ansi16, Ansi256, None as Colourless, True};
use phaselab::view::glyphs::Glyphs::{self, Ascii, Braille, HalfBlock};

/// Looks up a variable in `NAME=value` words.
fn environment(words: &str) -> impl Fn(&str) -> Option<String> {
    let pairs: Vec<(String, String)> = words
        .split_whitespace()
        .filter_map(|word| word.split_once('='))
        .map(|(name, value)| (name.to_owned(), value.to_owned()))
        .collect();
    move |name| pairs.iter().find(|(n, _)| n == name).map(|(_, value)| value.clone())
}

#[test]
fn colour_depth() {
    let table: [(&str, ColourDepth); 33] = [
        ("", Colourless),
        ("TERM=dumb", Colourless),
        ("TERM=dumb COLORTERM=truecolor", Colourless),
        ("TERM=unknown", Colourless),
        ("TERM=vt100", Colourless),
        ("TERM=vt220", Colourless),
        ("TERM=xterm-mono", Colourless),
        ("TERM=xterm-256color NO_COLOR=1", Colourless),
        ("TERM=xterm-256color NO_COLOR=0 COLORTERM=truecolor", Colourless),
        ("TERM=xterm-256color NO_COLOR=", Ansi256),
        ("TERM=xterm", Ansi256),
        ("TERM=XTERM", Ansi256),
        ("TERM=xterm-256color", Ansi256),
        ("TERM=xterm-256color COLORTERM=truecolor", True),
        ("TERM=xterm COLORTERM=24bit", True),
        ("TERM=xterm COLORTERM=gnome-terminal", Ansi256),
        ("TERM=xterm-color", Ansi16),
        ("TERM=xterm-16color", Ansi16),
        ("TERM=xterm-direct", True),
        ("TERM=xterm-kitty", True),
        ("TERM=alacritty", True),
        ("TERM=foot-extra", True),
        ("TERM=rxvt-unicode-256color", Ansi256),
        ("TERM=putty", Ansi256),
        ("TERM=st-256color", Ansi256),
        ("TERM=linux", Ansi16),
        ("TERM=ansi", Ansi16),
        ("TERM=stuff", Ansi16),
        // GNU screen inherits COLORTERM but garbles 24-bit colour; tmux translates it.
        ("TERM=screen COLORTERM=truecolor", Ansi16),
        ("TERM=screen-256color STY=1.pts COLORTERM=truecolor", Ansi256),
        ("TERM=screen-256color TMUX=/tmp/t COLORTERM=truecolor", True),
        ("TERM=tmux-256color TMUX=/tmp/t", Ansi256),
        ("WT_SESSION=1", True),
    ];
    for (words, depth) in table {
        assert_eq!(ColourDepth::from_environment(&environment(words)), depth, "{words}");
    }
}

#[test]
fn glyphs() {
    let table: [(&str, Glyphs); 15] = [
        ("", Ascii),
        ("LANG=C", Ascii),
        ("LANG=POSIX", Ascii),
        ("LANG=C.UTF-8", Braille),
        ("LANG=en_GB.utf8", Braille),
        ("LANG=de_DE.ISO-8859-1", Ascii),
        ("LANG=C LC_CTYPE=en_GB.UTF-8", Braille),
        ("LANG=en_GB.UTF-8 LC_CTYPE=C", Ascii),
        ("LANG=en_GB.UTF-8 LC_CTYPE=en_GB.UTF-8 LC_ALL=C", Ascii),
        ("LANG=C LC_ALL=en_GB.UTF-8", Braille),
        ("LC_ALL= LANG=en_GB.UTF-8", Braille),
        ("LANG=C.UTF-8 TERM=linux", HalfBlock),
        ("LANG=C.UTF-8 TERM=vt220", Ascii),
        ("LANG=C.UTF-8 NO_COLOR=1 TERM=xterm", Braille),
        ("WT_SESSION=1", Braille),
    ];
    for (words, expected) in table {
        assert_eq!(Glyphs::from_environment(&environment(words)), expected, "{words}");
    }
}

#[test]
fn names_people_give() {
    assert_eq!(
        ["never", "16", "256", "true"].map(ColourDepth::named),
        [Some(Colourless), Some(Ansi16), Some(Ansi256), Some(True)]
    );
    assert_eq!(ColourDepth::named("auto"), None);
    assert_eq!(
        ["braille", "half", "ascii", "auto"].map(Glyphs::named),
        [Some(Braille), Some(HalfBlock), Some(Ascii), None]
    );
    assert!(Glyphs::ALL.iter().all(|glyphs| Glyphs::named(glyphs.name()) == Some(*glyphs)));
}

#[test]
fn ascii_spells_what_it_cannot_show() {
    let check = |text: &str, expected: &str| assert_eq!(Ascii.text(text), expected);
    check("θ̇₁ [rad/s]", "theta1' [rad/s]");
    check("½ m l² θ̇² + m g l cos θ", "1/2 m l^2 theta'^2 + m g l cos theta");
    check("kg m² s⁻¹⁰", "kg m^2 s^-10");
    check("∂L/∂φ = 0 ⇒ p_φ − const", "d_phi L = 0 => p_phi - const");
    // a partial derivative is no total one
    check("dG/dt = [G, H] + ∂G/∂t", "dG/dt = [G, H] + d_t G");
    check("d/dt(∂L/∂q̇₁) − ∂L/∂q₁", "d/dt(d_q1' L) - d_q1 L");
    check("det ∂²S/∂q∂α, ∂²H/∂p²", "det d_q d_alpha S, d_p^2 H");
    check("∂(Q, P)/∂t, ∂/∂x, ∂φ", "d_t (Q, P), d_x, dphi");
    check("日", "?");
    assert_eq!(Braille.text("θ₁²"), "θ₁²");
}
