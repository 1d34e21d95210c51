//! Casts as animated pictures: a GIF that shows what a terminal would, drawn without the fonts of the machine.
//!
//! In: a cast, the width of a cell. Out: a GIF with one palette for all of it, in which a picture holds only what
//! changed. Its delays are whole centiseconds that add up to the length of the cast. Everything is computed with
//! additions, products and roots, so the bytes are the same on every machine. Never here: files, or the format of a cast.

mod coverage;
mod font;
mod glyph;
mod inks;
mod pictures;
mod screen;

use std::io::{self, Write};

use gif::{DisposalMethod, Encoder, EncodingError, Frame, Repeat};

use self::glyph::GlyphAtlas;
use self::inks::{InkCounts, Inks, TRANSPARENT};
use self::pictures::{CastPictures, changed};
use self::screen::ScreenCell;
use super::cast_reader::RecordedCast;

/// The width of a cell in pixels, if nobody says it; its height is twice that.
pub const CELL_WIDTH: u16 = 10;

/// The least and the greatest width of a cell.
pub const CELL_WIDTHS: [u16; 2] = [4, 40];

/// The most pixels of a picture.
const MOST_PIXELS: u64 = 1 << 25;

/// The longest delay that a GIF can express, in centiseconds.
const LONGEST_DELAY: u64 = u16::MAX as u64;

/// Writes a cast as a GIF that begins again at its end.
///
/// # Errors
/// Returns an error if writing fails, or if the picture would be too large.
pub fn write<W: Write>(cast: &RecordedCast, cell_width: u16, mut out: W) -> io::Result<W> {
    let cell_width = cell_width.clamp(CELL_WIDTHS[0], CELL_WIDTHS[1]);
    let (columns, rows) = CastPictures::largest(cast);
    let (width, height) =
        (u64::from(columns * cell_width), u64::from(rows) * 2 * u64::from(cell_width));
    let fits = width * height <= MOST_PIXELS;
    let sides = u16::try_from(width).ok().zip(u16::try_from(height).ok()).filter(|_| fits);
    let Some((width, height)) = sides else {
        let what =
            format!("{width}×{height} pixels are too many for a GIF; make the cells narrower");
        return Err(io::Error::new(io::ErrorKind::InvalidInput, what));
    };
    let mut glyphs = GlyphAtlas::new(usize::from(cell_width));
    let inks = Inks::of(count_inks(cast, &mut glyphs));
    // the encoder keeps what it is given until its end
    let mut encoder = Encoder::new(&mut out, width, height, &inks.palette()).map_err(failed)?;
    encoder.set_repeat(Repeat::Infinite).map_err(failed)?;
    let mut canvas = GifCanvas::new((width, height), glyphs, inks);
    let mut pending: Option<(Frame<'static>, u64)> = None;
    let mut pictures = CastPictures::new(cast);
    while let Some(picture) = pictures.next() {
        let lasts = picture.lasts;
        match (canvas.draw(&picture.cells, usize::from(picture.columns)), &mut pending) {
            (None, Some((_, delay))) => *delay += lasts,
            (frame, _) => {
                let frame = frame.unwrap_or_else(GifCanvas::nothing);
                if let Some((frame, delay)) = pending.replace((frame, lasts)) {
                    put(&mut encoder, frame, delay)?;
                }
            }
        }
    }
    if let Some((frame, delay)) = pending {
        put(&mut encoder, frame, delay)?;
    }
    encoder.into_inner().map_err(failed)?.flush()?;
    Ok(out)
}

/// Counts the colours of the pixels that are drawn.
fn count_inks(cast: &RecordedCast, glyphs: &mut GlyphAtlas) -> InkCounts {
    let mut counts = InkCounts::default();
    let mut shown: Vec<ScreenCell> = Vec::new();
    let mut pictures = CastPictures::new(cast);
    while let Some(picture) = pictures.next() {
        for index in changed(&shown, &picture.cells) {
            let cell = &picture.cells[index];
            counts.add(cell.ink, cell.ground, glyphs.of(cell).histogram());
        }
        shown = picture.cells;
    }
    counts
}

/// Writes a picture that lasts a number of centiseconds.
fn put<W: Write>(
    encoder: &mut Encoder<W>,
    mut frame: Frame<'static>,
    delay: u64,
) -> io::Result<()> {
    let mut left = delay;
    loop {
        let part = left.min(LONGEST_DELAY);
        frame.delay = part as u16;
        encoder.write_frame(&frame).map_err(failed)?;
        left -= part;
        if left == 0 {
            return Ok(());
        }
        frame = GifCanvas::nothing();
    }
}

fn failed(error: EncodingError) -> io::Error {
    match error {
        EncodingError::Io(error) => error,
        other => io::Error::other(other.to_string()),
    }
}

/// The picture as it stands, in indices of the palette.
struct GifCanvas {
    width: usize,
    pixels: Vec<u8>,
    shown: Vec<ScreenCell>,
    glyphs: GlyphAtlas,
    inks: Inks,
}

impl GifCanvas {
    fn new((width, height): (u16, u16), glyphs: GlyphAtlas, inks: Inks) -> GifCanvas {
        let width = usize::from(width);
        let pixels = vec![TRANSPARENT; width * usize::from(height)];
        GifCanvas { width, pixels, shown: Vec::new(), glyphs, inks }
    }

    /// A picture that changes nothing.
    fn nothing() -> Frame<'static> {
        Frame {
            width: 1,
            height: 1,
            buffer: vec![TRANSPARENT].into(),
            transparent: Some(TRANSPARENT),
            dispose: DisposalMethod::Keep,
            ..Frame::default()
        }
    }

    /// Draws the cells that changed; returns the least rectangle around them, in which equal pixels are transparent.
    /// `None` if no cell changed.
    fn draw(&mut self, cells: &[ScreenCell], columns: usize) -> Option<Frame<'static>> {
        let (wide, high) = self.glyphs.cell();
        let places: Vec<(usize, usize)> =
            changed(&self.shown, cells).map(|index| (index % columns, index / columns)).collect();
        let left = places.iter().map(|place| place.0).min()? * wide;
        let right = (places.iter().map(|place| place.0).max()? + 1) * wide;
        let top = places.iter().map(|place| place.1).min()? * high;
        let bottom = (places.iter().map(|place| place.1).max()? + 1) * high;
        let width = right - left;
        let mut buffer = vec![TRANSPARENT; width * (bottom - top)];
        for (x, y) in places {
            let cell = &cells[y * columns + x];
            let ramp = self.inks.ramp(cell.ink, cell.ground);
            let glyph = self.glyphs.of(cell);
            for (row, levels) in glyph.rows().enumerate() {
                let (x, y) = (x * wide, y * high + row);
                let shown = &mut self.pixels[y * self.width + x..][..wide];
                let drawn = &mut buffer[(y - top) * width + x - left..][..wide];
                for ((shown, drawn), level) in shown.iter_mut().zip(drawn).zip(levels) {
                    let index = ramp[usize::from(*level)];
                    if *shown != index {
                        (*shown, *drawn) = (index, index);
                    }
                }
            }
        }
        self.shown = cells.to_vec();
        Some(Frame {
            left: left as u16,
            top: top as u16,
            width: width as u16,
            height: (bottom - top) as u16,
            buffer: buffer.into(),
            transparent: Some(TRANSPARENT),
            dispose: DisposalMethod::Keep,
            ..Frame::default()
        })
    }
}
