//! The recorder: what the laboratory shows, into a cast, as it is shown.
//!
//! In: drawn screens. Out: a cast of version 3 beside them, written as it grows, so that it takes no memory. Never here:
//! what is drawn, or the form of a cast.

use std::io;
use std::time::Instant;

use ratatui::buffer::Buffer;
use ratatui::layout::Size;

use super::fresh::{Fresh, NOTHING};
use crate::record::cast_writer::{Cast, Version};
use crate::record::plain;
use crate::view::frame::Frames;
use crate::view::theme::Palette;

/// A cast being recorded.
#[derive(Debug)]
pub(super) struct Recorder {
    cast: Cast<Fresh>,
    frames: Frames,
    began: Instant,
    size: Size,
}

impl Recorder {
    /// Begins a cast named after a system.
    pub(super) fn begin(
        stem: &str,
        title: &str,
        size: Size,
        palette: &Palette,
    ) -> io::Result<Self> {
        let file = Fresh::begin(stem, "cast")?;
        let cast = Cast::begin(file, Version::Three, (size.width, size.height), title, palette)?;
        Ok(Self { cast, frames: Frames::new(false), began: Instant::now(), size })
    }

    /// Takes a screen down.
    pub(super) fn take(&mut self, screen: &Buffer) -> io::Result<()> {
        let now = self.now();
        let size = screen.area.as_size();
        if size != self.size {
            self.size = size;
            self.cast.resize(now, (size.width, size.height))?;
            self.frames.forget();
        }
        let bytes = self.frames.next(size, |_, buffer| {
            buffer.clone_from(screen);
            plain(buffer);
        });
        if bytes.is_empty() {
            return Ok(());
        }
        self.cast.output(now, &String::from_utf8_lossy(&bytes))
    }

    /// Ends the cast; its name. What cannot be written ends it before, and the error says under which name it is kept. `on_disk`
    /// waits until the disk has all of it.
    pub(super) fn end(mut self, on_disk: bool) -> io::Result<String> {
        let (now, size) = (self.now(), (self.size.width, self.size.height));
        // what goes wrong here goes wrong again when the file is finished, if that is not all there is of it
        let ended = self.cast.end(now, size);
        let mut file = self.cast.into_inner();
        let synced = if on_disk { file.sync() } else { Ok(()) };
        match (ended.and(synced), file.finish()) {
            (Err(why), Ok(name)) => {
                Err(io::Error::new(why.kind(), format!("{why}; {name} holds what came before")))
            }
            (_, finished) => finished,
        }
    }

    /// Ends a cast that cannot go on, for that reason; what is to be reported.
    pub(super) fn give_up(self, why: &io::Error) -> String {
        match self.cast.into_inner().finish() {
            Ok(name) if name == NOTHING => format!("nothing is recorded: {why}"),
            Ok(name) => format!("{why}; {name} holds what came before"),
            Err(why) => why.to_string(),
        }
    }

    fn now(&self) -> u64 {
        self.began.elapsed().as_micros() as u64
    }
}
