//! Keys as they are written: in a row, with the number of times each was pressed.
//!
//! In: keys. Out: their names, those shown beside a caption for a while. Never here: what they do.

use crossterm::event::KeyEvent;

use super::clock::Micros;
use crate::app::key;

/// How long a key is shown beside the caption.
const KEY_SHOWN: Micros = 1_200_000;

const KEYS_SHOWN: usize = 6;

/// The keys pressed last.
#[derive(Default)]
pub(super) struct ShownKeys(Vec<ShownKey>);

/// A key: its name, its number of presses (0 for typed text), and the time it disappears.
struct ShownKey {
    name: String,
    count: usize,
    until: Micros,
}

impl ShownKeys {
    pub(super) fn of(keys: &[KeyEvent]) -> ShownKeys {
        let mut shown = ShownKeys::default();
        for key in keys {
            shown.press(key, false, 0);
        }
        shown
    }

    /// A key is pressed; typed characters are grouped.
    pub(super) fn press(&mut self, key: &KeyEvent, typing: bool, now: Micros) {
        let until = now.saturating_add(KEY_SHOWN);
        let name = key::name(key);
        match self.0.last_mut() {
            Some(last) if last.name == name && !typing => {
                last.count += 1;
                last.until = until;
            }
            Some(last) if typing && last.count == 0 => {
                last.name.push_str(&name);
                last.until = until;
            }
            _ => self.0.push(ShownKey { name, count: usize::from(!typing), until }),
        }
    }

    /// Removes the keys that were shown long enough, and those for which there is no room.
    pub(super) fn pass(&mut self, now: Micros) {
        self.0.retain(|key| key.until > now);
        let surplus = self.0.len().saturating_sub(KEYS_SHOWN);
        self.0.drain(..surplus);
    }

    pub(super) fn clear(&mut self) {
        self.0.clear();
    }

    pub(super) fn written(&self) -> Vec<String> {
        let written = |key: &ShownKey| match key.count {
            0 | 1 => key.name.clone(),
            count => format!("{} x{count}", key.name),
        };
        self.0.iter().map(written).collect()
    }
}
