//! The screen: phaselab's pages and panes as cells of a ratatui buffer.
//!
//! In: the application's state and the newest snapshot. Out: cells. Never here: a clock, a terminal, the worker,
//! or a change to anything that is drawn.
//!
//! There is one file per pane or page. The lower half does not depend on the rest of phaselab and could serve any
//! program that draws curves in a terminal: [`card`], [`colour`], [`glyphs`], [`theme`], [`number`], [`sparkline`],
//! [`plot`] and [`frame`].

mod cache;
mod canvas;
pub mod caption;
pub mod card;
mod clauses;
pub mod colour;
mod companions;
mod constants;
mod cursor;
mod cursor_reading;
mod detail;
mod emphasis;
mod equations;
mod field;
mod footer;
pub mod frame;
mod further;
mod gauges;
pub mod glyphs;
mod header;
mod help;
mod highlight;
mod hit_test;
mod ink;
mod lab_page;
mod layout;
mod legend;
pub mod lesson;
mod level_curves;
mod list_tabs;
mod marks;
mod menu;
mod names;
mod notes;
pub mod number;
mod numbers;
mod page_search;
mod picker;
mod picture;
mod picture_title;
mod placeholder;
mod plain;
pub mod plot;
mod prediction;
mod primes;
mod prompt;
mod quantity;
mod region;
mod render_style;
mod report;
mod screen;
pub mod sgr;
mod space;
pub mod sparkline;
mod syntax;
pub mod table_plot;
mod tabs;
mod text_page;
pub mod theme;
mod time_window;
mod timeline;
mod values;
mod vector_field;
mod verdict;
mod workbench;
mod wrap;

pub use detail::Detail;
pub use hit_test::{HitMap, hit_targets, hit_test};
pub use render_style::RenderStyle;
pub use screen::{Painter, draw};
pub use wrap::words;
