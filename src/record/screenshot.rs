//! Stills: one screen as a drawing, as plain text, or as coloured text.
//!
//! In: a screen of cells. Out: SVG, text, or text with ANSI colours. Never here: when it is taken, or files.

mod ansi;
pub(super) mod shape;
mod svg;

use std::str::FromStr;

use ratatui::buffer::Buffer;

use super::recording::rows;
use crate::view::theme::Palette;

/// The format of a still.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ImageFormat {
    /// A drawing: dots and lines are shapes, words are text in any available font.
    Svg,
    /// Characters without colours.
    Text,
    /// Characters with colours, for `cat` in a terminal.
    Ansi,
}

impl FromStr for ImageFormat {
    type Err = String;

    /// Determines the format from a file name's extension.
    fn from_str(path: &str) -> Result<ImageFormat, String> {
        let ending = path.rsplit_once('.').map_or("", |(_, ending)| ending);
        match ending.to_ascii_lowercase().as_str() {
            "svg" => Ok(ImageFormat::Svg),
            "txt" => Ok(ImageFormat::Text),
            "ans" | "ansi" => Ok(ImageFormat::Ansi),
            _ => Err("a still ends in .svg, .txt or .ans".to_owned()),
        }
    }
}

/// Writes the screen in a format; `palette` gives the background.
pub fn write(screen: &Buffer, palette: &Palette, form: ImageFormat, title: &str) -> String {
    match form {
        ImageFormat::Svg => svg::write(screen, palette, title),
        ImageFormat::Text => rows(screen).join("\n") + "\n",
        ImageFormat::Ansi => ansi::write(screen),
    }
}
