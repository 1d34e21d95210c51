//! The recorder: records what the laboratory shows into a cast.
//!
//! In: drawn screens. Out: a cast of version 3 in the current folder, written as it grows, so that it takes no
//! memory. Never here: what is drawn, or the format of a cast.

use std::io;
use std::path::Path;
use std::time::Instant;

use ratatui::buffer::Buffer;
use ratatui::layout::Size;

use super::new_file::{NOTHING, NewFile};
use crate::record::cast_writer::{Cast, Version};
use crate::record::plain;
use crate::view::frame::Frames;
use crate::view::theme::Palette;

#[derive(Debug)]
pub(super) struct CastRecorder {
    cast: Cast<NewFile>,
    frames: Frames,
    began: Instant,
    size: Size,
}

impl CastRecorder {
    /// Begins a cast named after a system.
    pub(super) fn begin(
        stem: &str,
        title: &str,
        size: Size,
        palette: &Palette,
    ) -> io::Result<Self> {
        let file = NewFile::begin(Path::new(""), stem, "cast")?;
        let cast = Cast::begin(file, Version::Three, (size.width, size.height), title, palette)?;
        Ok(Self { cast, frames: Frames::new(false)?, began: Instant::now(), size })
    }

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
        })?;
        if bytes.is_empty() {
            return Ok(());
        }
        self.cast.output(now, &String::from_utf8_lossy(&bytes))
    }

    /// Ends the cast and returns its name. A write error ends it early, and names the file that was kept. With
    /// `on_disk` the call waits until the disk has all of it.
    pub(super) fn end(mut self, on_disk: bool) -> io::Result<String> {
        let (now, size) = (self.now(), (self.size.width, self.size.height));
        // If writing fails here, finishing the file fails too, unless everything has been written already.
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

    /// Ends a cast that cannot be continued for this reason. Returns the sentence to report.
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
