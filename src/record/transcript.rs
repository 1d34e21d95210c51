//! The transcript of a recording: the actions and assertions with their times, and the screen at each chapter.
//!
//! In: a [`Recording`]. Out: text with lines no wider than the screen needs. Never here: files.

use super::clock::Micros;
use super::recording::{Recording, TranscriptEntry, rows, seconds};

/// Writes the transcript.
pub fn write(recording: &Recording) -> String {
    let Recording { title, size: (columns, height), fps, end, .. } = recording;
    let mut lines = vec![
        title.clone(),
        format!("{columns}x{height} characters, {fps} frames a second, {} s", seconds(*end)),
        String::new(),
    ];
    for (time, entry) in &recording.log {
        match entry {
            TranscriptEntry::Done(what, text) => lines.push(line(*time, what, text)),
            TranscriptEntry::Claimed(true, text) => lines.push(line(*time, "found", text)),
            TranscriptEntry::Claimed(false, text) => lines.push(line(*time, "FALSE", text)),
            TranscriptEntry::Marker(index) => {
                let marker = &recording.markers[*index];
                lines.push(line(*time, "chapter", &marker.name));
                lines.extend(rows(&marker.screen).iter().map(|row| framed(row)));
            }
        }
    }
    lines.push(line(*end, "end", ""));
    lines.extend(rows(&recording.last).iter().map(|row| framed(row)));
    lines.join("\n") + "\n"
}

fn line(time: Micros, what: &str, text: &str) -> String {
    format!("{:>8} s  {what:<8}  {text}", seconds(time)).trim_end().to_owned()
}

/// A row of the screen, set off from the transcript's own lines.
fn framed(row: &str) -> String {
    format!("    | {row}").trim_end().to_owned()
}
