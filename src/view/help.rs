//! The help: every key, from the table of key bindings, and what the mouse does.
//!
//! In: the tables of key bindings and of gestures. Out: a page of text. Never here: a key that is not in the table.

use ratatui::layout::Rect;
use tui_input::Input;

use super::RenderStyle;
use super::canvas::{Canvas, columns, row};
use super::layout::split_rows;
use super::text_page::TextPage;
use super::theme::Role;
use crate::app::gestures::{GESTURES, MOUSE};
use crate::app::keymap::{Binding, KEYS, KeyContext};
use crate::app::{Action, Drawn, HitTarget, Page, synonyms};

/// What a newcomer looks for, in the order of the page.
const FIRST: [Action; 6] = [
    Action::PlayPause,
    Action::Reset,
    Action::NextPane,
    Action::Show(Page::Equations),
    Action::Undo,
    Action::Quit,
];

/// Draws the page from `scroll` on, and above it the search, if there is one.
pub(super) fn draw(
    canvas: &mut Canvas<'_>,
    area: Rect,
    active: &[KeyContext],
    (search, typing): (Option<&Input>, bool),
    scroll: u16,
) -> Drawn {
    let title = [canvas.span(Role::Title, "Keys")];
    let mut inner = canvas.pane(area, &title, true);
    canvas.target(area, HitTarget::Text);
    let pattern = search.map_or("", |input| input.value());
    if let Some(input) = search {
        let (above, below) = split_rows(inner, 1);
        let field = columns(above, 1, above.width.saturating_sub(2));
        let used = canvas.left(field, Role::Accent, "/ ");
        let place = columns(field, used, field.width);
        let room = usize::from(place.width.saturating_sub(1));
        let skipped = input.visual_scroll(room);
        let text: String = pattern.chars().skip(skipped).take(room).collect();
        canvas.left(place, Role::Text, &text);
        if typing {
            let cursor = input.visual_cursor().saturating_sub(skipped).min(room) as u16;
            canvas.point(columns(row(place, 0), cursor, 1).as_position());
        }
        inner = below;
    }
    let page = document(canvas.style, active, pattern);
    page.draw_in_columns(canvas, inner, scroll)
}

/// Builds the page: a few keys to begin with, then those of what has the focus, then those of the page around it, the mouse, then all
/// others. Of a search only what was found is left, by the words of the page or by other words for the same action.
fn document(style: &RenderStyle, active: &[KeyContext], pattern: &str) -> TextPage {
    let mut page = TextPage::default();
    let words: Vec<String> = pattern.split_whitespace().map(str::to_lowercase).collect();
    let has = |text: String| {
        let text = text.to_lowercase();
        words.iter().all(|word| text.contains(word))
    };
    let mut none = true;
    let mut section = |title: &str, rows: Vec<(String, &str)>| {
        if !rows.is_empty() {
            none = false;
            page.heading(title);
            for (keys, help) in rows {
                page.item(&keys, help);
            }
        }
    };
    let rows_of = |context: KeyContext| -> Vec<(String, &'static str)> {
        let fits = |row: &&Binding| {
            let others = synonyms(row.action).join(" ");
            has(format!("{} {} {} {others}", keys(row, style), row.help, context.title()))
        };
        let rows = KEYS.iter().filter(|row| row.context == context).filter(fits);
        rows.map(|row| (keys(row, style), row.help)).collect()
    };
    if pattern.is_empty() && active.contains(&KeyContext::Experiment) {
        let first = FIRST.iter().filter_map(|action| {
            let row = KEYS.iter().find(|row| row.action == *action)?;
            Some((keys(row, style), row.help))
        });
        section("To begin with", first.collect());
    }
    for (index, context) in active.iter().enumerate() {
        let title = context.title();
        let title = if index == 0 { format!("Here: {title}") } else { title.to_owned() };
        section(&title, rows_of(*context));
    }
    let gestures = GESTURES.iter().filter(|(what, does)| has(format!("{what} {does} {MOUSE}")));
    section(MOUSE, gestures.map(|(what, does)| ((*what).to_owned(), *does)).collect());
    for context in KeyContext::ALL.into_iter().filter(|context| !active.contains(context)) {
        section(context.title(), rows_of(context));
    }
    if none {
        page.words(Role::Dim, "No match; Esc shows all keys.");
    }
    page
}

/// The keys of a binding, as they are labelled on keyboards.
pub(super) fn keys(row: &Binding, style: &RenderStyle) -> String {
    named(&row.key_names().join(" "), style)
}

/// Names of keys, with words for the arrows if they cannot be drawn.
pub(super) fn named(keys: &str, style: &RenderStyle) -> String {
    const ARROWS: [(&str, &str); 4] = [("↑", "Up"), ("↓", "Down"), ("←", "Left"), ("→", "Right")];
    let spelt =
        || ARROWS.iter().fold(keys.to_owned(), |name, (sign, word)| name.replace(sign, word));
    if style.glyphs.is_ascii() { spelt() } else { keys.to_owned() }
}
