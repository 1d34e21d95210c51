//! The screen, from constructed snapshots: text and styles, any size, any terminal.

mod bodies;
mod bytes;
mod cache;
mod cells;
mod fit;
mod focus;
mod footer;
mod golden;
mod hit_test;
mod labels;
mod legends;
mod motion;
mod names;
mod page_search;
mod panes;
mod plain;
mod purity;
mod room;
mod shading;
mod tabs;
mod workbench;

use phaselab::app::{App, Drawn};
use phaselab::view::colour::ColourDepth;
use phaselab::view::glyphs::Glyphs;
use phaselab::view::theme::Theme;
use phaselab::view::{RenderStyle, draw};
use ratatui::buffer::Buffer;
use ratatui::layout::Rect;

/// A terminal with 24-bit colour and all characters.
pub(crate) fn rich() -> RenderStyle {
    RenderStyle { theme: Theme::dark(ColourDepth::True), glyphs: Glyphs::Braille }
}

/// A terminal without colours, and with ASCII alone.
pub(crate) fn ascii() -> RenderStyle {
    RenderStyle { theme: Theme::dark(ColourDepth::None), glyphs: Glyphs::Ascii }
}

/// The screen of an application.
pub(crate) fn screen(app: &App, look: &RenderStyle, (width, height): (u16, u16)) -> Buffer {
    drawn(app, look, (width, height)).0
}

pub(crate) fn drawn(app: &App, look: &RenderStyle, (width, height): (u16, u16)) -> (Buffer, Drawn) {
    let area = Rect::new(0, 0, width, height);
    let mut buffer = Buffer::empty(area);
    let drawn = draw(app, look, area, &mut buffer);
    (buffer, drawn)
}

/// The text of each row.
pub(crate) fn rows(buffer: &Buffer) -> Vec<String> {
    let row = |y| (0..buffer.area.width).map(|x| buffer[(x, y)].symbol()).collect::<String>();
    (0..buffer.area.height).map(|y| row(y).trim_end().to_owned()).collect()
}

/// What is on the screen of a terminal with all colours and characters.
pub(crate) fn screen_text(app: &App, size: (u16, u16)) -> String {
    rows(&screen(app, &rich(), size)).join("\n")
}

/// The first position of a text on the screen: column and row.
fn find(buffer: &Buffer, text: &str) -> Option<(u16, u16)> {
    (0..buffer.area.height).find_map(|y| {
        let row: String = (0..buffer.area.width).map(|x| buffer[(x, y)].symbol()).collect();
        let mut starts = (0..buffer.area.width).scan(0, |end, x| {
            let start = *end;
            *end += buffer[(x, y)].symbol().len();
            Some((x, start))
        });
        let found = row.find(text)?;
        starts.find(|(_, start)| *start == found).map(|(x, _)| (x, y))
    })
}
