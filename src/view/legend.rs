//! What an instrument writes into its plot: a few lines, beside the axes where they take a third of the pane at most,
//! above them else, so that they cover nothing; in their upper left corner where there is no room for both. A low plot has
//! two of them at most, a higher one a third of its rows; the last says what the zoomed pane shows.
//!
//! In: the lines, the area, whether the pane can be zoomed. Out: cells. Never here: what the lines say.

use ratatui::layout::{Constraint, Layout, Rect};
use unicode_width::UnicodeWidthStr;

use super::canvas::Canvas;
use super::clauses::clauses;
use super::theme::Role;
use super::wrap::shortened;
use super::{RenderStyle, number};
use crate::instrument::{Layer, Level};

/// An area this wide has room beside its axes, for lines in so many parts of it at most.
const WIDE: u16 = 64;
const PARTS: u16 = 3;

/// Axes have at least this height.
const LOW: u16 = 6;

/// An area of fewer rows leaves its lines so many above the axes.
const SMALL: u16 = 16;
const FEW: usize = 2;

/// At most one row in so many is above the axes, unless the pane is zoomed.
const SHARE: u16 = 3;

/// What is said of lines that have no room.
const MORE: &str = "z shows more";

/// Parts an area into one for the axes and one for the lines, so that these cover nothing.
pub(super) fn beside(
    area: Rect,
    (layers, zoomable): (&[(Level, Layer)], bool),
    style: &RenderStyle,
) -> (Rect, Option<Rect>) {
    let width = |line: &String| shown(line, style).width();
    let widest = layers.iter().filter_map(|(_, layer)| match layer {
        Layer::Legend(lines) => lines.iter().map(width).max(),
        _ => None,
    });
    let wanted = widest.max().map(|widest| u16::try_from(widest + 2).unwrap_or(u16::MAX));
    match wanted {
        Some(wanted) if area.width >= WIDE && wanted <= area.width / PARTS => {
            let parts = [Constraint::Min(0), Constraint::Length(wanted)];
            let [axes, lines] = Layout::horizontal(parts).areas(area);
            (axes, Some(lines))
        }
        Some(_) => {
            let wanted =
                u16::try_from(wrapped(area, (layers, zoomable), style)).unwrap_or(u16::MAX);
            let room = (area.height / 2).min(area.height.saturating_sub(LOW));
            let parts = [Constraint::Length(wanted.min(room)), Constraint::Min(0)];
            let [lines, axes] = Layout::vertical(parts).areas(area);
            if lines.height == 0 { (area, None) } else { (axes, Some(lines)) }
        }
        None => (area, None),
    }
}

/// How many rows at most the lines of an area have, which have a part of it or are in it: its zoomed pane has room for all.
pub(super) fn most(area: Rect, lines: Option<Rect>, zoomable: bool) -> usize {
    let above = lines.is_none_or(|lines| lines.height < area.height);
    if zoomable && above { most_above(area) } else { usize::MAX }
}

/// How many rows at most stand above the axes of an area.
fn most_above(area: Rect) -> usize {
    if area.height < SMALL { FEW } else { usize::from(area.height / SHARE) }
}

/// The number of rows of all lines.
fn wrapped(
    area: Rect,
    (layers, zoomable): (&[(Level, Layer)], bool),
    style: &RenderStyle,
) -> usize {
    let lines = layers.iter().map(|(_, layer)| match layer {
        Layer::Legend(lines) => {
            rows(area, (lines, if zoomable { most_above(area) } else { usize::MAX }), style).len()
        }
        _ => 0,
    });
    lines.sum()
}

/// The rows of some lines in the width of an area: all, or so many at most, the last of which says that there are more.
fn rows(area: Rect, (lines, most): (&[String], usize), style: &RenderStyle) -> Vec<String> {
    let room = usize::from(area.width).saturating_sub(2).max(1);
    let lines: Vec<String> = lines.iter().map(|line| shown(line, style)).collect();
    let all: Vec<String> = lines.iter().flat_map(|line| clauses(line, room)).collect();
    let [first, others @ ..] = &lines[..] else { return all };
    if all.len() <= most {
        return all;
    }
    let mut whole = Vec::new();
    for line in &lines {
        let own = clauses(line, room);
        if whole.len() + own.len() >= most {
            break;
        }
        whole.extend(own);
    }
    if whole.len() > 1 {
        whole.push(MORE.to_owned());
        return whole;
    }
    let mark = style.glyphs.pick("…", "...");
    let first = if first.width() <= room { first.clone() } else { beginning(first, room, mark) };
    let whole = first == lines[0];
    let beside = others.first().filter(|_| whole).map(|line| format!("{line}   z: more"));
    let second = beside.filter(|line| line.width() <= room && others.len() > 1);
    let second = second.unwrap_or_else(|| match others.first().and_then(|line| left_side(line)) {
        Some(name) if whole && others.len() == 1 => format!("z shows {name}"),
        Some(name) if whole => format!("z shows {name} and more"),
        _ => MORE.to_owned(),
    });
    vec![first, second]
}

/// The beginning of a line that is too long, up to an equals sign or a word and never inside a parenthesis. What it says that
/// a formula is not stays at its end: the beginning alone would read like a value.
fn beginning(line: &str, room: usize, mark: &str) -> String {
    let unequal = [" ≠ ", " != "].into_iter().filter_map(|sign| line.rfind(sign)).max();
    let (line, end) = line.split_at(unequal.unwrap_or(line.len()));
    match room.checked_sub(end.width()) {
        Some(left) if left > mark.width() => format!("{}{end}", whole_words(line, left, mark)),
        _ => whole_words(line, room, mark),
    }
}

fn whole_words(line: &str, room: usize, mark: &str) -> String {
    let (mut open, mut end) = (0_usize, 0);
    for (at, character) in line.char_indices() {
        match character {
            '(' | '[' => open += 1,
            ')' | ']' => open = open.saturating_sub(1),
            ' ' if open == 0 && line[..at].width() + 1 + mark.width() <= room => end = at,
            _ => {}
        }
    }
    let shown = line[..end].trim_end_matches(['+', '−', '-', '·', '*', '/', ',', ';', ' ']);
    // The beginning of a product is no value: where the value stands before it, it is left out.
    let is_product = line[shown.len()..].trim_start().starts_with(['·', '×', '*', '/']);
    let shown = match shown.rsplit_once(" = ") {
        Some((before, _)) if is_product && before.contains(" = ") => before,
        // nor is an equals sign behind a value
        _ => shown.strip_suffix(" =").filter(|before| before.contains(" = ")).unwrap_or(shown),
    };
    if shown.is_empty() { shortened(line, room, mark) } else { format!("{shown} {mark}") }
}

/// What a line gives the value of: the one word before its equals sign.
fn left_side(line: &str) -> Option<&str> {
    let (name, _) = line.split_once(" = ")?;
    (!name.contains(char::is_whitespace)).then_some(name)
}

/// A line in the characters of this terminal, its numbers written as elsewhere.
fn shown(line: &str, style: &RenderStyle) -> String {
    style.glyphs.text(&number::with_powers(line, style.glyphs)).into_owned()
}

/// Writes lines from the top, wrapped, as far as there is room for them; where there is not, the last row says so.
pub(super) fn draw(canvas: &mut Canvas<'_>, area: Rect, (lines, most): (&[String], usize)) {
    let style = canvas.style;
    let room = usize::from(area.width).saturating_sub(2);
    let mut rows = rows(area, (lines, most), style).into_iter().peekable();
    for y in area.y..area.bottom() {
        let Some(mut line) = rows.next() else { break };
        if y + 1 == area.bottom() && rows.peek().is_some() {
            let short: String = line.chars().take(room.saturating_sub(2)).collect();
            line = style.glyphs.text(&format!("{short} …")).into_owned();
        }
        let line = format!("{line} ");
        canvas.buffer.set_stringn(area.x + 1, y, line, room, style.theme[Role::Text]);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::view::colour::ColourDepth;
    use crate::view::glyphs::Glyphs;
    use crate::view::theme::Theme;

    /// Lines beside the axes take a third of a plot at most; longer ones stand above, and the axes have its whole width.
    #[test]
    fn words_leave_the_axes_two_thirds() {
        let style = RenderStyle { theme: Theme::dark(ColourDepth::True), glyphs: Glyphs::Braille };
        for width in [30, 64, 90, 120] {
            for long in [10, 20, 29, 39, 60] {
                let area = Rect::new(5, 3, width, 20);
                let lines = vec!["a".repeat(long), "b".to_owned()];
                let layers = [(0, Layer::Legend(lines))];
                let (axes, words) = beside(area, (&layers, true), &style);
                let words = words.expect("words");
                assert!(axes.width >= width - width / 3, "{width} {long}: {axes:?}");
                assert_eq!(axes.intersection(words).area(), 0, "{width} {long}");
                let is_beside = words.height == area.height;
                assert_eq!(is_beside, width >= WIDE && long as u16 + 2 <= width / 3);
                assert!(is_beside || axes.width == width && axes.height >= 15, "{axes:?}");
            }
        }
    }

    /// A plot of a terminal of 24 rows keeps its height: the verdict, and what the zoomed pane shows besides. A zoomed one
    /// has all, and nothing is cut inside a factor.
    #[test]
    fn a_low_plot_has_two_lines_at_most() {
        let style = RenderStyle { theme: Theme::dark(ColourDepth::True), glyphs: Glyphs::Braille };
        let written = |lines: &[&str], few| {
            let lines: Vec<String> = lines.iter().map(|&line| line.to_owned()).collect();
            let most = if few { FEW } else { usize::MAX };
            rows(Rect::new(0, 0, 38, 12), (&lines, most), &style)
        };
        let k = "K = ½ k X² + ½ k Y² + (PX² + PY²)/(2 m) − Ω X PY + Ω Y PX";
        let down = "no F₁, F₄: det ∂Q/∂p = det ∂P/∂q = 0";
        let lines = ["canonical, proved", k, down];
        assert_eq!(written(&lines, true), ["canonical, proved", "z shows K and more"]);
        assert_eq!(written(&lines[..2], true), ["canonical, proved", "z shows K"]);
        assert_eq!(written(&lines[..1], true), ["canonical, proved"]);
        assert_eq!(
            written(&["canonical, proved", "K = ω P"], true),
            lines_of("canonical, proved|K = ω P")
        );
        assert!(written(&lines, false).len() > 4);
        let least = ["S = 1.7555", "least of all paths nearby", "∂S/∂θ = 0.732 = p"];
        assert_eq!(
            written(&least, true),
            lines_of("S = 1.7555|least of all paths nearby   z: more")
        );
        let long =
            "not canonical: [Q, P] = (√(p_q² + m² ω² q²)/c)^(1/s − 1)/(c s √(p_q² + m² ω² q²)) ≠ 1";
        let cut = "not canonical: [Q, P] = … ≠ 1|z shows more";
        assert_eq!(written(&[long, k], true), lines_of(cut));
        // a formula whose beginning is a value by itself
        let long = "not canonical: [Q, P] = m ω + (p_q² + m² ω² q²)/c ≠ 1";
        let cut = "not canonical: [Q, P] = m ω … ≠ 1|z shows more";
        assert_eq!(written(&[long, k], true), lines_of(cut));
        // a second way to write a value, cut inside its product
        let long = "libration: J = 0.27817 = 2π · 0.044272";
        assert_eq!(written(&[long, k], true)[0], "libration: J = 0.27817 …");
        let long = "libration: period J = 0.27817 = 0.2781 + 1e-4";
        assert_eq!(written(&[long, k], true)[0], "libration: period J = 0.27817 …");
        let layers = [(0, Layer::Legend(lines.map(str::to_owned).to_vec()))];
        let heights = |height, zoomable| {
            let (axes, words) = beside(Rect::new(0, 0, 38, height), (&layers, zoomable), &style);
            [axes.height, words.expect("words").height]
        };
        assert_eq!(heights(12, true), [10, 2]);
        let whole = written(&lines, false).len() as u16;
        assert_eq!(heights(12, false), [12 - whole, whole]);
        assert_eq!(heights(20, true), [20 - whole, whole]);
        // in a higher one they take a third at most, none of them cut
        let many: Vec<String> = [lines, lines].concat().into_iter().map(str::to_owned).collect();
        let shown = rows(Rect::new(0, 0, 38, 20), (&many, 6), &style);
        assert!(shown.len() <= 6 && shown.len() > 2, "{shown:?}");
        assert_eq!(shown[..shown.len() - 1], written(&lines, false)[..shown.len() - 1]);
        assert_eq!(shown.last().map(String::as_str), Some(MORE));
        let many = [(0, Layer::Legend(many))];
        let (axes, words) = beside(Rect::new(0, 0, 38, 20), (&many, true), &style);
        let words = words.expect("words").height;
        assert_eq!([axes.height, words], [20 - shown.len() as u16, shown.len() as u16]);
    }

    fn lines_of(text: &str) -> Vec<&str> {
        text.split('|').collect()
    }
}
