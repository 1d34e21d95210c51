//! The whole screen: which panes and pages there are, and which lie over which.
//!
//! In: an [`App`]. Out: cells. Never here: the contents of a pane.

use ratatui::buffer::Buffer;
use ratatui::layout::Rect;

use super::cache::FrameCache;
use super::canvas::{Canvas, row};
use super::constants;
use super::equations;
use super::help;
use super::lab_page;
use super::layout::{LEAST, ScreenLayout, split_rows};
use super::menu;
use super::notes;
use super::numbers;
use super::page_search;
use super::picker;
use super::plain;
use super::prompt;
use super::quantity::Quantities;
use super::render_style::RenderStyle;
use super::report;
use super::text_page::{TextPage, measure};
use super::theme::Role;
use super::workbench;
use super::wrap;
use super::{footer, header};
use crate::app::{App, Drawn, EquationsSection, HitTarget, KeyHints, Lab, Overlay, Page};

/// Draws the whole screen over a blank area, and returns how far its page of text can be scrolled.
pub fn draw(app: &App, style: &RenderStyle, area: Rect, buffer: &mut Buffer) -> Drawn {
    Painter::default().draw(app, style, area, buffer)
}

/// Draws one screen after the other, the same as [`draw`], and keeps what does not change between them.
#[derive(Debug, Default)]
pub struct Painter {
    cache: FrameCache,
}

impl Painter {
    /// How many recorded rows have been stroked into trails so far: those that are new in each frame, and all where a trail is
    /// begun anew.
    pub fn stroked(&self) -> u64 {
        self.cache.stroked()
    }

    /// Draws the whole screen over a blank area, and returns how far its page of text can be scrolled.
    pub fn draw(
        &mut self,
        app: &App,
        style: &RenderStyle,
        area: Rect,
        buffer: &mut Buffer,
    ) -> Drawn {
        let themed = style.chosen_by(app);
        let style = themed.as_ref().unwrap_or(style);
        let mut canvas = Canvas::over(buffer, style);
        canvas.cache = std::mem::take(&mut self.cache);
        canvas.cache.begin(style);
        let drawn = paint(&mut canvas, app, area);
        let cursor = canvas.cursor.map(|at| (at.x, at.y));
        self.cache = canvas.cache;
        self.cache.end();
        Drawn {
            cursor,
            reading: canvas.reading.map(|reading| reading.at),
            cursor_place: canvas.reading.map(|reading| reading.place),
            moving: canvas.moving,
            ..drawn
        }
    }
}

pub(super) fn paint(canvas: &mut Canvas<'_>, app: &App, area: Rect) -> Drawn {
    let area = area.intersection(canvas.buffer.area);
    // Above what a lesson says, the motion is shown in whatever rows there are, alone if they are few.
    let low = app.footer.hints != KeyHints::Lab && area.height < LEAST.1;
    if area.width < LEAST.0 || area.height < LEAST.1 && !low {
        too_small(canvas, area);
        return Drawn::default();
    }
    if low {
        let field = u16::from(matches!(app.overlay, Some(Overlay::Field(_))) && area.height > 1);
        let (above, below) = split_rows(area, area.height - field);
        let drawn = if above.height < LOWEST { Drawn::default() } else { body(canvas, above, app) };
        if field > 0 {
            footer::footer(canvas, below, (app, above));
        }
        return drawn;
    }
    // The plain page contains the status itself and must not change while it is read.
    let status = !matches!(app.page, Page::Picker | Page::Plain) && app.lab.is_some();
    // A value is typed in the footer.
    let footer = app.footer.shown || matches!(app.overlay, Some(Overlay::Field(_)));
    let screen = ScreenLayout::of(area, status && app.footer.shown, footer);
    header::header(canvas, screen.header, app);
    let drawn = body(canvas, screen.body, app);
    footer::notice(canvas, screen.body, app);
    header::status(canvas, screen.status, app);
    footer::footer(canvas, screen.footer, (app, screen.body));
    drawn
}

/// The least rows of a pane in which anything is seen, with its frame.
const LOWEST: u16 = 3;

fn body(canvas: &mut Canvas<'_>, area: Rect, app: &App) -> Drawn {
    let over = app.overlay.as_ref();
    if let Some(Overlay::Help { search, typing, .. }) = over {
        return help::draw(
            canvas,
            area,
            app.key_contexts_below(),
            (search.as_ref(), *typing),
            app.text.scroll,
        );
    }
    if let Some(Overlay::Message(error)) = over {
        let title = [canvas.span(Role::Title, format!("{} has errors", error.name))];
        let inner = canvas.pane(area, &title, true);
        let mut page = TextPage::default();
        let lines = error.message.lines();
        let width = measure(inner.width);
        for line in lines.flat_map(|line| wrap::report_line(line, width.into())) {
            page.row(report::coloured(&line));
        }
        canvas.target(area, HitTarget::Text);
        return page.draw(canvas, inner, app.text.scroll);
    }
    if let Some(buffer) = app.open_buffer() {
        return workbench::draw(canvas, area, app, buffer);
    }
    // what lies over a page has the focus, and so does a lesson that speaks
    let covered = matches!(over, Some(Overlay::Menu(_) | Overlay::Prompt(_)));
    canvas.beside = covered || app.footer.hints == KeyHints::Hidden;
    let drawn = match (app.page, &app.lab) {
        (Page::Picker, _) | (_, None) => {
            picker::draw(canvas, area, app);
            Drawn::default()
        }
        (Page::Lab, Some(lab)) => {
            let panes = lab_page::draw(canvas, area, app, lab);
            Drawn { panes: Some(panes), ..Drawn::default() }
        }
        (page, Some(lab)) => text_page(canvas, area, (app, lab), page),
    };
    canvas.beside = false;
    match (over, &app.lab) {
        (Some(Overlay::Menu(menu)), _) => menu::draw(canvas, area, menu),
        (Some(Overlay::Prompt(prompt)), Some(lab)) => prompt::draw(canvas, area, lab, prompt),
        _ => {}
    }
    drawn
}

fn text_page(canvas: &mut Canvas<'_>, area: Rect, (app, lab): (&App, &Lab), page: Page) -> Drawn {
    let style = canvas.style;
    if page == Page::Plain {
        canvas.target(area, HitTarget::Text);
        let snapshot = app.reading.snapshot.as_deref().or(lab.seen());
        let read = snapshot.and_then(|seen| Quantities::at(lab, seen, style));
        let document = read.map(|q| plain::document(&q)).unwrap_or_default();
        return document.read(canvas, area, app.reading.line);
    }
    let (title, document) = match page {
        Page::Equations => {
            let section = app.text.section.map(|section| match section {
                EquationsSection::Constants => constants::CONSTANTS,
                EquationsSection::Brackets => constants::BRACKETS,
            });
            ("Equations", equations::document(lab, style).from(section))
        }
        Page::Notes => ("Notes", notes::document(lab, style)),
        _ => {
            let numbers = Quantities::of(lab, style).map(|q| numbers::document(&q).balanced());
            ("Numbers", numbers.unwrap_or_default())
        }
    };
    text(canvas, area, title, document, app)
}

fn text(canvas: &mut Canvas<'_>, area: Rect, title: &str, page: TextPage, app: &App) -> Drawn {
    let title = [canvas.span(Role::Title, title)];
    let inner = canvas.pane(area, &title, true);
    canvas.target(area, HitTarget::Text);
    let Some(search) = app.search_of_page() else {
        return page.draw_in_columns(canvas, inner, app.text.scroll);
    };
    let (above, below) = split_rows(inner, 1);
    let words = page_search::line(canvas, above, search);
    let place = Some(search.place).filter(|_| search.seeks);
    let drawn = page.searched(words, place).draw_in_columns(canvas, below, app.text.scroll);
    page_search::count(canvas, above, (search.place, drawn.matches));
    drawn
}

/// Draws the message for a screen that is too small for anything else.
fn too_small(canvas: &mut Canvas<'_>, area: Rect) {
    let needed = format!(
        "phaselab needs {}x{} characters, this window has {}x{}; q quits",
        LEAST.0, LEAST.1, area.width, area.height
    );
    for (index, line) in wrap::words(&needed, area.width.into()).iter().enumerate() {
        canvas.left(row(area, index), Role::Text, line);
    }
}
