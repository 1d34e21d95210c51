//! `doctor`: the detected abilities of the terminal, and the card of glyphs.

use super::{done, phaselab, program};

#[test]
fn the_doctor_says_what_was_found_and_why() {
    let home = tempfile::tempdir().expect("a temporary folder");
    let text = done(program(home.path()).args(["doctor"]).envs([
        ("TERM", "xterm-256color"),
        ("SSH_TTY", "/dev/pts/7"),
        ("TMUX", "/tmp/x"),
    ]))
    .success();
    for (what, found) in [
        ("terminal", "standard output is not a terminal"),
        ("color", "TERM=xterm-256color"),
        ("glyphs", "LANG=C.UTF-8"),
        ("fps", "15"),
        ("bandwidth", "64 KiB a second"),
        ("link", "SSH_TTY is set"),
        ("multiplexer", "tmux"),
    ] {
        let line = text.lines().find(|line| line.starts_with(what)).unwrap_or_default();
        assert!(line.contains(found), "no {found:?} in {line:?} of {text}");
    }
    assert!(text.is_ascii() && !text.contains("/dev/pts/7"), "{text}");
}

/// What was found and its evidence stay in their columns, and in 80 of them, however long a value is.
#[test]
fn the_columns_of_the_doctor_hold() {
    let long = "0123456789".repeat(9);
    let ground = "15;".repeat(30) + "0";
    let plain: [&[(&str, &str)]; 4] = [
        &[("TERM", "xterm-256color")],
        &[("TERM", "dumb"), ("NO_COLOR", "1")],
        &[("TERM", "xterm-kitty"), ("COLORTERM", "truecolor"), ("SSH_TTY", "x")],
        &[("TERM", &long), ("WT_SESSION", &long), ("COLORFGBG", &ground)],
    ];
    for environment in plain {
        let home = tempfile::tempdir().expect("a temporary folder");
        let environment = environment.iter().copied();
        let text = done(program(home.path()).arg("doctor").envs(environment)).success();
        let table: Vec<&str> = text.lines().take_while(|line| !line.is_empty()).collect();
        assert!(table.len() >= 8, "{text}");
        for line in table {
            let blank = |range: std::ops::Range<usize>| {
                range.filter_map(|at| line.as_bytes().get(at)).all(|byte| *byte == b' ')
            };
            assert!(line.len() <= 80 && blank(12..13) && blank(33..35), "{line:?} of {text}");
        }
    }
}

#[test]
fn the_card_shows_every_set_of_glyphs_also_in_a_pipe() {
    let card = phaselab(&["doctor", "--glyphs"]).success();
    assert!(card.starts_with("This is not a terminal"), "{card}");
    assert!(!card.contains('\u{1b}'), "{card}");
    for (name, sign) in [
        ("braille   |", '⣿'),
        ("half      |", '▀'),
        ("quadrant  |", '▚'),
        ("sextant   |", '🬞'),
        ("octant    |", '\u{1cd00}'),
        ("ascii     |", '/'),
        ("signs", '◆'),
    ] {
        assert!(card.contains(name), "no {name} in {card}");
        let sign_near = |c: char| {
            c == sign
                || (sign == '\u{1cd00}' && ('\u{1cd00}'..='\u{1cde5}').contains(&c))
                || (sign == '🬞' && ('\u{1fb00}'..='\u{1fb3b}').contains(&c))
                || (sign == '▚' && ('▖'..='▟').contains(&c))
        };
        assert!(card.contains(sign_near), "no {sign} in {card}");
    }
    let home = tempfile::tempdir().expect("a temporary folder");
    let plain = done(program(home.path()).args(["doctor", "--glyphs"]).env("LANG", "C")).success();
    assert!(plain.contains("The locale is not UTF-8"), "{plain}");
    assert!(plain.contains("The default here is ascii"), "{plain}");
}
