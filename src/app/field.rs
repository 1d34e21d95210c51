//! A field in which a value is typed.
//!
//! In: characters. Out: the text, the number it stands for, or a sentence on why it stands for none.
//! Never here: where the field is drawn.

use tui_input::{Input, InputRequest};

use super::{Code, Key, ValueId};
use crate::expr::Pool;
use crate::model::{Allowed, Model, Scope};

/// The most characters a field takes, so that a paste can do no harm.
const MOST: usize = 4096;

/// What a typed value is for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Purpose {
    /// A parameter or an initial value.
    Value(ValueId),
    /// The step of a method of fixed step.
    Step,
    /// The tolerance of an adaptive method.
    Tolerance,
}

/// A field being typed in.
#[derive(Clone, Debug)]
pub struct Field {
    /// What the value is for.
    pub purpose: Purpose,
    /// What is typed so far, with the cursor.
    pub input: Input,
    /// Whether the text is still the one it began with, marked as a whole: what is typed takes its place.
    pub whole: bool,
    /// What is wrong with what was typed when it was last to be accepted.
    pub mistake: Option<String>,
}

impl Field {
    /// A field that holds a text to begin with.
    pub fn new(purpose: Purpose, text: String) -> Self {
        let whole = !text.is_empty();
        Self { purpose, input: Input::new(text), whole, mistake: None }
    }

    /// Handles a key of editing; whatever it was, the last complaint is answered.
    pub fn press(&mut self, key: Key) {
        let replaces = match key.code {
            Code::Char(c) => !key.ctrl && !key.alt && !c.is_control(),
            code => matches!(code, Code::Backspace | Code::Delete),
        };
        let emptied = std::mem::take(&mut self.whole) && replaces;
        if emptied {
            self.input.reset();
        }
        if edit(&mut self.input, key) || emptied {
            self.mistake = None;
        }
    }

    /// Takes pasted text in as if it were typed; whether all of it found room.
    pub(super) fn paste(&mut self, text: &str) -> bool {
        if std::mem::take(&mut self.whole) {
            self.input.reset();
        }
        self.mistake = None;
        paste(&mut self.input, text)
    }

    /// The number typed, positive where the purpose asks for it.
    ///
    /// # Errors
    /// A sentence that says what is wrong with the text.
    pub fn read(&self, model: &Model, parameters: &[f64]) -> Result<f64, String> {
        let value = number(model, parameters, self.input.value())?;
        let sentence = match self.purpose {
            Purpose::Value(_) => return Ok(value),
            Purpose::Step => "The step must be more than zero.",
            Purpose::Tolerance => "The tolerance must be more than zero and less than one.",
        };
        let fits = value > 0.0 && (self.purpose == Purpose::Step || value < 1.0);
        if fits { Ok(value) } else { Err(sentence.to_owned()) }
    }
}

/// The value of a typed expression in numbers and parameters, which have these values.
fn number(model: &Model, parameters: &[f64], text: &str) -> Result<f64, String> {
    let mut pool: Pool = model.pool.clone();
    let mut scope = Scope::new(model, Allowed::Parameters, "a typed value");
    let Some(expression) = scope.read(&mut pool, text) else {
        let mistake = scope.mistakes.first();
        let what = mistake.map_or("it cannot be read".to_owned(), ToString::to_string);
        let help = mistake.and_then(|m| m.help.clone());
        let help = help.map_or(String::new(), |help| format!(": {help}"));
        return Err(format!("`{}` is no number: {what}{help}.", text.trim()));
    };
    let value = pool.evaluate(expression, &|symbol| {
        let index = model.parameters.iter().position(|p| p.symbol == symbol);
        index.and_then(|index| parameters.get(index)).copied().unwrap_or(f64::NAN)
    });
    if value.is_finite() {
        Ok(value)
    } else {
        Err(format!("`{}` has no finite value.", text.trim()))
    }
}

/// Handles a key of editing; whether the text or the cursor changed.
pub(super) fn edit(input: &mut Input, key: Key) -> bool {
    let request = match (key.code, key.ctrl) {
        (Code::Char(c), false) if !key.alt && !c.is_control() => InputRequest::InsertChar(c),
        (Code::Backspace, false) => InputRequest::DeletePrevChar,
        (Code::Delete, false) => InputRequest::DeleteNextChar,
        (Code::Left, false) => InputRequest::GoToPrevChar,
        (Code::Right, false) => InputRequest::GoToNextChar,
        (Code::Home, false) | (Code::Char('a'), true) => InputRequest::GoToStart,
        (Code::End, false) | (Code::Char('e'), true) => InputRequest::GoToEnd,
        (Code::Char('u'), true) => InputRequest::DeleteLine,
        (Code::Char('w') | Code::Backspace, true) => InputRequest::DeletePrevWord,
        (Code::Left, true) => InputRequest::GoToPrevWord,
        (Code::Right, true) => InputRequest::GoToNextWord,
        _ => return false,
    };
    let full = matches!(request, InputRequest::InsertChar(_)) && input.value().len() >= MOST;
    !full && input.handle(request).is_some()
}

/// Takes pasted text in as if it were typed; whether all of it found room.
pub(super) fn paste(input: &mut Input, text: &str) -> bool {
    let mut characters = text.chars().filter(|c| !c.is_control());
    let room = MOST.saturating_sub(input.value().len());
    let typed: String = characters.by_ref().take(room).collect();
    // One change of the whole text: inserting letter by letter takes quadratic time.
    let at = input.cursor();
    let before: String = input.value().chars().take(at).collect();
    let after: String = input.value().chars().skip(at).collect();
    let cursor = at + typed.chars().count();
    *input = Input::new(before + &typed + &after).with_cursor(cursor);
    characters.next().is_none()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn typed(text: &str, keys: &[Key]) -> String {
        let mut field = Field::new(Purpose::Step, text.to_owned());
        for key in keys {
            field.press(*key);
        }
        field.input.value().to_owned()
    }

    /// What a field begins with is marked as a whole, as in any other field of a form.
    #[test]
    fn what_is_typed_takes_the_place_of_the_old_value() {
        let [three, dot] = ['3', '.'].map(|c| Key::plain(Code::Char(c)));
        assert_eq!(typed("1.06", &[three, dot]), "3.");
        assert_eq!(typed("1.06", &[Key::plain(Code::Backspace), three]), "3");
        assert_eq!(typed("1.06", &[Key::plain(Code::Delete)]), "");
        assert_eq!(typed("1.06", &[]), "1.06");
        let [left, end] = [Code::Left, Code::End].map(Key::plain);
        assert_eq!(typed("1.06", &[left, three]), "1.036");
        assert_eq!(typed("1.06", &[end, three]), "1.063");
        let mut field = Field::new(Purpose::Step, "1.06".to_owned());
        assert!(field.paste("0.5") && field.paste("1"));
        assert_eq!(field.input.value(), "0.51");
    }
}
