//! A multi-line text being edited: cursor, selection, undo, search.
//!
//! In: keys and pasted text. Out: the text, and the position of the cursor. Never here: what the text means, where
//! it is stored, how it is drawn.
//!
//! Every change replaces one range by another text, so undoing it is a replacement too. (The editor widgets for
//! ratatui store what was last drawn and move the cursor by it; this editor does not depend on a screen.)

use crossterm::event::{KeyCode, KeyEvent, KeyModifiers};

use super::smart_case;

/// A position in the text; row and column are counted from 0.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord)]
pub struct Caret {
    /// The line.
    pub row: usize,
    /// The character within the line.
    pub column: usize,
}

/// A text being edited.
#[derive(Clone, Debug)]
pub struct Editor {
    lines: Vec<String>,
    /// Whether lines end with CR LF.
    carriage: bool,
    cursor: Caret,
    /// The other end of the selection.
    anchor: Option<Caret>,
    /// The column that vertical moves aim for.
    goal: Option<usize>,
    done: Vec<Replacement>,
    undone: Vec<Replacement>,
    /// Whether the next typed character joins the last change.
    typing: bool,
    /// The clipboard: what was cut or copied last.
    clipboard: String,
    /// The maximum size of the text in bytes.
    limit: usize,
}

/// The replacement of a range by another text.
#[derive(Clone, Debug)]
struct Replacement {
    at: Caret,
    old: String,
    new: String,
    /// The position of the cursor before the change.
    cursor: Caret,
}

/// The width of a tab in columns.
const TAB: usize = 4;

impl Editor {
    /// Creates an editor with the cursor at the start; the text may grow to `limit` bytes.
    pub fn new(text: &str, limit: usize) -> Self {
        let carriage = text.contains("\r\n") && !text.replace("\r\n", "").contains('\n');
        let ending = if carriage { "\r\n" } else { "\n" };
        Self {
            lines: text.split(ending).map(str::to_owned).collect(),
            carriage,
            cursor: Caret::default(),
            anchor: None,
            goal: None,
            done: Vec::new(),
            undone: Vec::new(),
            typing: false,
            clipboard: String::new(),
            limit,
        }
    }

    /// Returns the whole text. Unchanged parts keep their original bytes.
    pub fn text(&self) -> String {
        self.lines.join(if self.carriage { "\r\n" } else { "\n" })
    }

    /// Returns the lines, at least one.
    pub fn lines(&self) -> &[String] {
        &self.lines
    }

    /// Returns the position of the cursor.
    pub fn cursor(&self) -> Caret {
        self.cursor
    }

    /// Returns the selection, its start first.
    pub fn selection(&self) -> Option<(Caret, Caret)> {
        let anchor = self.anchor.filter(|anchor| *anchor != self.cursor)?;
        Some((anchor.min(self.cursor), anchor.max(self.cursor)))
    }

    /// Returns the position of a byte offset.
    pub fn caret_at(&self, byte: usize) -> Caret {
        let ending = if self.carriage { 2 } else { 1 };
        let mut left = byte;
        for (row, line) in self.lines.iter().enumerate() {
            if left <= line.len() || row + 1 == self.lines.len() {
                let column = line.char_indices().take_while(|(at, _)| *at < left).count();
                return Caret { row, column };
            }
            left = left.saturating_sub(line.len() + ending);
        }
        Caret::default()
    }

    /// Moves the cursor to a position, or to the nearest valid one.
    pub fn go(&mut self, caret: Caret) {
        let row = caret.row.min(self.lines.len() - 1);
        self.cursor = Caret { row, column: caret.column.min(self.length(row)) };
        (self.anchor, self.goal, self.typing) = (None, None, false);
    }

    /// Handles a typing or movement key; `page` is the number of visible rows. Returns whether the text changed.
    pub fn press(&mut self, key: KeyEvent, page: usize) -> bool {
        let pressed = |modifier| key.modifiers.contains(modifier);
        match (key.code, pressed(KeyModifiers::CONTROL)) {
            (KeyCode::Char(c), false) if !pressed(KeyModifiers::ALT) && !c.is_control() => {
                self.type_in(&c.to_string(), self.typing && self.selection().is_none())
            }
            (KeyCode::Enter, _) => {
                let line = &self.lines[self.cursor.row];
                let before = line.chars().take(self.cursor.column);
                let indent: String = before.take_while(|c| matches!(c, ' ' | '\t')).collect();
                self.insert(&format!("\n{indent}"))
            }
            (KeyCode::Tab, false) => self.insert(&" ".repeat(TAB - self.cursor.column % TAB)),
            (KeyCode::Backspace, ctrl) => {
                self.erase(if ctrl { Self::word_left } else { Self::left })
            }
            (KeyCode::Char('w'), true) => self.erase(Self::word_left),
            (KeyCode::Delete, ctrl) => {
                self.erase(if ctrl { Self::word_right } else { Self::right })
            }
            _ => {
                self.shift(key, page);
                false
            }
        }
    }

    /// Inserts text at the cursor, replacing the selection. Returns whether it fitted.
    pub fn insert(&mut self, text: &str) -> bool {
        self.type_in(text, false)
    }

    /// Inserts pasted text, with line endings normalized and control characters removed. Returns whether all of it
    /// fitted.
    pub fn paste(&mut self, text: &str) -> bool {
        let text = text.replace("\r\n", "\n").replace('\r', "\n").replace('\t', "    ");
        let text: String = text.chars().filter(|c| *c == '\n' || !c.is_control()).collect();
        let room = self.limit.saturating_sub(self.size());
        let beginning = beginning(&text, room);
        self.insert(beginning);
        beginning.len() == text.len()
    }

    /// Cuts the selection, or else the line.
    pub fn cut(&mut self) -> bool {
        self.copy();
        let (from, to) = self.selected_or_line();
        let had = from != to;
        self.replace(from, to, "");
        had
    }

    /// Copies the selection, or else the line.
    pub fn copy(&mut self) {
        let (from, to) = self.selected_or_line();
        self.clipboard = self.between(from, to);
    }

    /// Pastes what was cut or copied last.
    pub fn put_back(&mut self) -> bool {
        let clipboard = self.clipboard.clone();
        !clipboard.is_empty() && self.insert(&clipboard)
    }

    /// Undoes the last change. Returns whether there was one.
    pub fn undo(&mut self) -> bool {
        let Some(change) = self.done.pop() else { return false };
        let end = end_of(change.at, &change.new);
        self.exchange(change.at, end, &change.old);
        self.go(change.cursor);
        self.undone.push(change);
        true
    }

    /// Redoes the change undone last. Returns whether there was one.
    pub fn redo(&mut self) -> bool {
        let Some(change) = self.undone.pop() else { return false };
        let end = end_of(change.at, &change.old);
        self.exchange(change.at, end, &change.new);
        self.go(end_of(change.at, &change.new));
        self.done.push(change);
        true
    }

    /// Selects the next match after the cursor, wrapping around at the end; a capital letter matches itself only, and makes small
    /// ones do so too. Returns whether there is one.
    pub fn find(&mut self, wanted: &str) -> bool {
        if wanted.is_empty() {
            return false;
        }
        let pattern = smart_case(wanted, wanted);
        let rows = self.lines.len();
        for step in 0..=rows {
            let row = (self.cursor.row + step) % rows;
            let line = smart_case(&self.lines[row], wanted);
            let from = if step == 0 { self.cursor.column } else { 0 };
            let found = (from..line.len()).find(|&at| line[at..].starts_with(&pattern));
            if let Some(column) = found {
                self.go(Caret { row, column: column + pattern.len() });
                self.anchor = Some(Caret { row, column });
                return true;
            }
        }
        false
    }

    /// Replaces the whole text in one undoable change.
    pub fn become_text(&mut self, text: &str) {
        let cursor = self.cursor;
        let last = self.lines.len() - 1;
        let end = Caret { row: last, column: self.length(last) };
        let other = Self::new(text, self.limit);
        self.carriage = other.carriage;
        self.replace(Caret::default(), end, &other.lines.join("\n"));
        self.go(cursor);
    }

    /// Returns an upper bound on the size of the text in bytes.
    fn size(&self) -> usize {
        self.lines.iter().map(|line| line.len() + 2).sum()
    }

    fn length(&self, row: usize) -> usize {
        self.lines[row].chars().count()
    }

    fn type_in(&mut self, text: &str, together: bool) -> bool {
        if text.is_empty() || self.size() + text.len() > self.limit {
            return false;
        }
        let (from, to) = self.selection().unwrap_or((self.cursor, self.cursor));
        let blank = |text: &str| text.chars().all(char::is_whitespace);
        if together
            && let Some(last) = self.done.last_mut()
            && end_of(last.at, &last.new) == from
            && (blank(text) || !last.new.ends_with(' '))
        {
            last.new.push_str(text);
            self.undone.clear();
            self.exchange(from, to, text);
            let end = end_of(from, text);
            self.go(end);
        } else {
            self.replace(from, to, text);
        }
        self.typing = true;
        true
    }

    /// Deletes the selection, or the range between the cursor and another position.
    fn erase(&mut self, to: fn(&Self) -> Caret) -> bool {
        let other = to(self);
        let (from, to) =
            self.selection().unwrap_or((self.cursor.min(other), self.cursor.max(other)));
        if from == to {
            return false;
        }
        self.replace(from, to, "");
        true
    }

    fn replace(&mut self, from: Caret, to: Caret, text: &str) {
        let cursor = self.cursor;
        let old = self.exchange(from, to, text);
        if !(old.is_empty() && text.is_empty()) {
            self.done.push(Replacement { at: from, old, new: text.to_owned(), cursor });
            self.undone.clear();
        }
        self.go(end_of(from, text));
    }

    /// Replaces a range by a text, and returns the replaced text.
    fn exchange(&mut self, from: Caret, to: Caret, text: &str) -> String {
        let old = self.between(from, to);
        let byte = |line: &str, column: usize| {
            line.char_indices().nth(column).map_or(line.len(), |(at, _)| at)
        };
        let head = self.lines[from.row][..byte(&self.lines[from.row], from.column)].to_owned();
        let tail = self.lines[to.row][byte(&self.lines[to.row], to.column)..].to_owned();
        let whole = head + text + &tail;
        self.lines.splice(from.row..=to.row, whole.split('\n').map(str::to_owned));
        old
    }

    fn between(&self, from: Caret, to: Caret) -> String {
        let mut text = String::new();
        for row in from.row..=to.row {
            let line = self.lines[row].chars();
            let first = if row == from.row { from.column } else { 0 };
            let count = if row == to.row { to.column.saturating_sub(first) } else { usize::MAX };
            if row > from.row {
                text.push('\n');
            }
            text.extend(line.skip(first).take(count));
        }
        text
    }

    fn selected_or_line(&self) -> (Caret, Caret) {
        let row = self.cursor.row;
        self.selection().unwrap_or_else(|| {
            let start = Caret { row, column: 0 };
            if row + 1 < self.lines.len() {
                (start, Caret { row: row + 1, column: 0 })
            } else {
                (start, Caret { row, column: self.length(row) })
            }
        })
    }

    /// Moves the cursor; with Shift, extends the selection.
    fn shift(&mut self, key: KeyEvent, page: usize) {
        let Caret { row, column } = self.cursor;
        let last = self.lines.len() - 1;
        let goal = self.goal.unwrap_or(column);
        let upright = |row: usize| Caret { row, column: goal };
        let (to, keeps_goal) = match (key.code, key.modifiers.contains(KeyModifiers::CONTROL)) {
            (KeyCode::Left, false) => (self.left(), false),
            (KeyCode::Right, false) => (self.right(), false),
            (KeyCode::Left, true) => (self.word_left(), false),
            (KeyCode::Right, true) => (self.word_right(), false),
            (KeyCode::Up, _) if row == 0 => (Caret::default(), false),
            (KeyCode::Up, _) => (upright(row - 1), true),
            (KeyCode::Down, _) if row == last => (Caret { row, column: self.length(row) }, false),
            (KeyCode::Down, _) => (upright(row + 1), true),
            (KeyCode::PageUp, _) => (upright(row.saturating_sub(page.max(1))), true),
            (KeyCode::PageDown, _) => (upright((row + page.max(1)).min(last)), true),
            (KeyCode::Home, true) => (Caret::default(), false),
            (KeyCode::End, true) => (Caret { row: last, column: self.length(last) }, false),
            (KeyCode::Home, false) | (KeyCode::Char('a'), true) => {
                let blank = self.lines[row].chars().take_while(|c| c.is_whitespace()).count();
                (Caret { row, column: if column == blank { 0 } else { blank } }, false)
            }
            (KeyCode::End, false) | (KeyCode::Char('e'), true) => {
                (Caret { row, column: self.length(row) }, false)
            }
            _ => return,
        };
        let shift = key.modifiers.contains(KeyModifiers::SHIFT);
        let anchor = shift.then(|| self.anchor.unwrap_or(self.cursor));
        self.go(to);
        self.anchor = anchor;
        self.goal = keeps_goal.then_some(goal);
    }

    fn left(&self) -> Caret {
        let Caret { row, column } = self.cursor;
        match (row, column) {
            (0, 0) => self.cursor,
            (_, 0) => Caret { row: row - 1, column: self.length(row - 1) },
            _ => Caret { row, column: column - 1 },
        }
    }

    fn right(&self) -> Caret {
        let Caret { row, column } = self.cursor;
        if column < self.length(row) {
            Caret { row, column: column + 1 }
        } else if row + 1 < self.lines.len() {
            Caret { row: row + 1, column: 0 }
        } else {
            self.cursor
        }
    }

    /// Returns the start of the word to the left.
    fn word_left(&self) -> Caret {
        let Caret { row, column } = self.cursor;
        if column == 0 {
            return self.left();
        }
        let line: Vec<char> = self.lines[row].chars().collect();
        let mut at = column;
        while at > 0 && !is_word(line[at - 1]) {
            at -= 1;
        }
        while at > 0 && is_word(line[at - 1]) {
            at -= 1;
        }
        Caret { row, column: at }
    }

    /// Returns the end of the word to the right.
    fn word_right(&self) -> Caret {
        let Caret { row, column } = self.cursor;
        let line: Vec<char> = self.lines[row].chars().collect();
        if column == line.len() {
            return self.right();
        }
        let mut at = column;
        while at < line.len() && !is_word(line[at]) {
            at += 1;
        }
        while at < line.len() && is_word(line[at]) {
            at += 1;
        }
        Caret { row, column: at }
    }
}

/// Returns the longest prefix of whole characters that fits in this many bytes.
pub(super) fn beginning(text: &str, room: usize) -> &str {
    let mut ends = (0..=room.min(text.len())).rev();
    &text[..ends.find(|end| text.is_char_boundary(*end)).unwrap_or(0)]
}

fn is_word(c: char) -> bool {
    c.is_alphanumeric() || c == '_'
}

/// Returns the position at which a text ends if it starts at `at`.
fn end_of(at: Caret, text: &str) -> Caret {
    match text.rsplit_once('\n') {
        None => Caret { row: at.row, column: at.column + text.chars().count() },
        Some((above, last)) => {
            Caret { row: at.row + 1 + above.matches('\n').count(), column: last.chars().count() }
        }
    }
}
