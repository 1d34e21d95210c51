//! The diagnosis: which capabilities the terminal is assumed to have, and which environment variables decide that.
//!
//! In: environment variables, the window's size. Out: findings. Never here: queries to the terminal; how the
//! findings are printed.

use super::request::Request;
use crate::view::colour::ColourDepth;
use crate::view::glyphs::Glyphs;

/// A line of what `doctor` reports.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct DoctorFinding {
    /// Its subject.
    pub what: &'static str,
    /// Its result.
    pub found: String,
    /// The evidence; empty if none is needed.
    pub why: String,
}

type Variables<'a> = &'a dyn Fn(&str) -> Option<String>;

/// The variables that determine the colours.
const OF_COLOUR: [&str; 6] = ["NO_COLOR", "COLORTERM", "TERM", "WT_SESSION", "STY", "TMUX"];

/// The variables that determine the characters.
const OF_GLYPHS: [&str; 5] = ["LC_ALL", "LC_CTYPE", "LANG", "TERM", "WT_SESSION"];

/// The variables that determine the theme.
const OF_THEME: [&str; 4] = ["COLORFGBG", "NO_COLOR", "TERM", "STY"];

/// The variables that indicate a remote connection.
const OF_LINE: [&str; 2] = ["SSH_CONNECTION", "SSH_TTY"];

/// Returns the findings about the environment, and about a window of this size (columns, rows) if there is one.
pub fn diagnosis(variables: Variables<'_>, size: Option<(u16, u16)>) -> Vec<DoctorFinding> {
    let set = |name: &str| variables(name).is_some_and(|value| !value.is_empty());
    let term = variables("TERM").filter(|term| !term.is_empty());
    let size = size.map_or_else(
        || "standard output is not a terminal".to_owned(),
        |(columns, rows)| format!("{columns}x{rows}"),
    );
    let terminal = term.as_deref().unwrap_or("TERM is not set");
    let depth = ColourDepth::from_environment(variables);
    let colours = match depth {
        ColourDepth::None => "none; bold and reversed text instead",
        ColourDepth::Ansi16 => "16",
        ColourDepth::Ansi256 => "256",
        ColourDepth::True => "24 bits",
    };
    let theme_of = |variables: Variables<'_>| {
        let request = Request::default();
        let name = request.render_style(variables).theme.palette().name;
        (name, request.pace(variables).asks.background)
    };
    let theme = match theme_of(variables) {
        (_, true) => "by the background",
        (name, false) => name,
    };
    let asked = if theme_of(variables).1 { "the terminal is asked, " } else { "" };
    let glyphs = Glyphs::from_environment(variables);
    let pace = Request::default().pace(variables);
    let line = |variables: Variables<'_>| Request::default().pace(variables).frames;
    let far = OF_LINE.iter().any(|name| set(name));
    let rate = pace.bytes.map_or("no limit".to_owned(), |b| format!("{} KiB a second", b / 1024));
    let multiplexer = match (set("TMUX"), set("STY")) {
        (true, _) => "tmux",
        (_, true) => "screen",
        _ => "none",
    };
    let finding = |what, found: &str, why| DoctorFinding { what, found: found.to_owned(), why };
    vec![
        finding("terminal", terminal, size),
        finding("color", colours, why(variables, &OF_COLOUR, &ColourDepth::from_environment)),
        finding("theme", theme, asked.to_owned() + &why(variables, &OF_THEME, &theme_of)),
        finding("glyphs", glyphs.name(), why(variables, &OF_GLYPHS, &Glyphs::from_environment)),
        finding("fps", &pace.frames.to_string(), why(variables, &OF_LINE, &line)),
        finding("bandwidth", &rate, why(variables, &OF_LINE, &line)),
        finding("link", if far { "ssh" } else { "near" }, why(variables, &OF_LINE, &line)),
        finding("multiplexer", multiplexer, String::new()),
    ]
}

/// Returns the variables without which the finding would differ.
fn why<T: PartialEq>(
    variables: Variables<'_>,
    names: &[&str],
    found: &dyn Fn(Variables<'_>) -> T,
) -> String {
    let set: Vec<&str> = names
        .iter()
        .copied()
        .filter(|name| variables(name).is_some_and(|value| !value.is_empty()))
        .collect();
    let whole = found(variables);
    let decides = |name: &&str| {
        let without = |other: &str| if other == *name { None } else { variables(other) };
        found(&without) != whole
    };
    let deciding: Vec<&str> = set.iter().copied().filter(decides).collect();
    // If several variables agree, none of them decides alone.
    let listed = if deciding.is_empty() { set } else { deciding };
    let listed = listed.iter().map(|name| match variables(name) {
        // The addresses of a connection are private and do not belong in a report.
        Some(value) if !OF_LINE.contains(name) => format!("{name}={value}"),
        _ => format!("{name} is set"),
    });
    let listed = listed.collect::<Vec<_>>().join(", ");
    if listed.is_empty() { format!("none of {} is set", names.join(", ")) } else { listed }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn found(environment: &[(&str, &str)], what: &str) -> (String, String) {
        let variables = |name: &str| {
            environment.iter().find(|(n, _)| *n == name).map(|(_, value)| (*value).to_owned())
        };
        let findings = diagnosis(&variables, Some((80, 24)));
        let finding = findings.into_iter().find(|f| f.what == what).expect("it is looked at");
        (finding.found, finding.why)
    }

    #[test]
    fn what_decides_is_reported() {
        let check = |environment: &[(&str, &str)], what: &str, expected: [&str; 2]| {
            let (is, why) = found(environment, what);
            assert_eq!([is.as_str(), why.as_str()], expected, "{environment:?}");
        };
        let rich = [("TERM", "xterm"), ("COLORTERM", "truecolor"), ("LANG", "C.UTF-8")];
        check(&rich, "color", ["24 bits", "COLORTERM=truecolor"]);
        check(&rich[..1], "color", ["256", "TERM=xterm"]);
        check(&rich, "glyphs", ["braille", "LANG=C.UTF-8"]);
        check(&rich, "terminal", ["xterm", "80x24"]);
        check(&[("LANG", "C.UTF-8"), ("LC_ALL", "C")], "glyphs", ["ascii", "LC_ALL=C"]);
        let asked = "the terminal is asked, TERM=xterm";
        check(&rich, "theme", ["by the background", asked]);
        check(&[("TERM", "linux"), ("COLORFGBG", "0;15")], "theme", ["light", "COLORFGBG=0;15"]);
        check(&[], "link", ["near", "none of SSH_CONNECTION, SSH_TTY is set"]);
        let ssh = [("SSH_CONNECTION", "10.0.0.1 1 10.0.0.2 2"), ("SSH_TTY", "/dev/pts/0")];
        check(&ssh, "fps", ["15", "SSH_CONNECTION is set, SSH_TTY is set"]);
        check(&ssh[1..], "bandwidth", ["64 KiB a second", "SSH_TTY is set"]);
        check(&[("TMUX", "/tmp/x")], "multiplexer", ["tmux", ""]);
    }
}
