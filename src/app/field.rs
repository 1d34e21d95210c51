//! A field in which a value is typed.
//!
//! In: characters. Out: the text, the number it denotes, or a sentence on why it denotes none.
//! Never here: where the field is drawn.

use crossterm::event::{Event, KeyCode, KeyEvent, KeyModifiers};
use tui_input::Input;
use tui_input::backend::crossterm::EventHandler;

use super::ValueId;
use crate::expr::Pool;
use crate::model::{Allowed, Model, Scope};

/// The maximum number of characters in a field; it limits what a paste can insert.
const MOST: usize = 4096;

const CTRL_ALT: KeyModifiers = KeyModifiers::CONTROL.union(KeyModifiers::ALT);

/// What a typed value is for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Purpose {
    /// A parameter or an initial value.
    Value(ValueId),
    /// The step of a fixed-step method.
    Step,
    /// The tolerance of an adaptive method.
    Tolerance,
    /// How far the state is carried along the flow of the constant of this index.
    Flow(usize),
    /// How far it is carried along the flow of the symmetry of this index.
    SymmetryFlow(usize),
    /// How far it is carried along the flow of the generator of this index of the file.
    GeneratorFlow(usize),
    /// A generator that is typed, and how far the state is carried along its flow.
    TypedFlow,
    /// Where the parameter of this index goes, and in which time.
    Ramp(usize),
    /// The surface of section of the plot of this index.
    Surface(usize),
}

/// A field being typed in.
#[derive(Clone, Debug)]
pub struct InputField {
    /// What the value is for.
    pub purpose: Purpose,
    /// What is typed so far, with the cursor.
    pub input: Input,
    /// Whether the text is still the initial one, selected as a whole: typing replaces it.
    pub whole: bool,
    /// What was wrong with the text when it was last submitted.
    pub diagnostic: Option<String>,
}

impl InputField {
    /// Creates a field with an initial text.
    pub fn new(purpose: Purpose, text: String) -> Self {
        let whole = !text.is_empty();
        Self { purpose, input: Input::new(text), whole, diagnostic: None }
    }

    /// Handles an editing key and clears the last error message.
    pub fn press(&mut self, key: KeyEvent) {
        if edit_selected(&mut self.input, &mut self.whole, key) {
            self.diagnostic = None;
        }
    }

    /// Inserts pasted text as if it were typed. Returns whether all of it fitted.
    pub(super) fn paste(&mut self, text: &str) -> bool {
        self.diagnostic = None;
        paste_selected(&mut self.input, &mut self.whole, text)
    }

    /// Parses the typed number, which must be positive if the purpose requires it.
    ///
    /// # Errors
    /// Returns a sentence that says what is wrong with the text.
    pub fn read(&self, model: &Model, parameters: &[f64]) -> Result<f64, String> {
        let value = number(model, parameters, self.input.value())?;
        let sentence = match self.purpose {
            Purpose::Value(_)
            | Purpose::Flow(_)
            | Purpose::SymmetryFlow(_)
            | Purpose::GeneratorFlow(_)
            | Purpose::TypedFlow
            | Purpose::Ramp(_)
            | Purpose::Surface(_) => return Ok(value),
            Purpose::Step => "The step must be above zero.",
            Purpose::Tolerance => "The tolerance must be between zero and one.",
        };
        let fits = value > 0.0 && (self.purpose == Purpose::Step || value < 1.0);
        if fits { Ok(value) } else { Err(sentence.to_owned()) }
    }
}

/// Evaluates an expression of numbers and parameters with these parameter values.
pub(super) fn number(model: &Model, parameters: &[f64], text: &str) -> Result<f64, String> {
    let mut pool: Pool = model.pool.clone();
    let mut scope = Scope::new(model, Allowed::Parameters, "a typed value");
    let Some(expression) = scope.read(&mut pool, text) else {
        let diagnostic = scope.diagnostics.first();
        let what = diagnostic.map_or("it cannot be read".to_owned(), ToString::to_string);
        let help = diagnostic.and_then(|m| m.help.clone());
        let help = help.map_or(String::new(), |help| format!("; {help}"));
        let sentence = format!("`{}` is not a number: {what}{help}", text.trim());
        let end = if sentence.ends_with('?') { "" } else { "." };
        return Err(sentence + end);
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

fn types(key: KeyEvent) -> bool {
    matches!(key.code, KeyCode::Char(c) if !c.is_control()) && !key.modifiers.intersects(CTRL_ALT)
}

/// Handles an editing key. Returns whether the text or the cursor changed.
pub(super) fn edit(input: &mut Input, key: KeyEvent) -> bool {
    let key = match key.code {
        // The input library would insert Ctrl-Alt with a letter, since Windows reports AltGr that way.
        KeyCode::Char(c) if c.is_control() || key.modifiers.contains(CTRL_ALT) => return false,
        // A character, or a yank (Ctrl-y) of what was cut from the line.
        KeyCode::Char(c) if types(key) || c == 'y' => {
            if input.value().len() >= MOST {
                return false;
            }
            key
        }
        KeyCode::Char(_) => key,
        KeyCode::Backspace if key.modifiers.contains(KeyModifiers::CONTROL) => {
            KeyEvent::new(key.code, KeyModifiers::ALT)
        }
        code => KeyEvent::new(code, key.modifiers - KeyModifiers::SHIFT),
    };
    input.handle_event(&Event::Key(key)).is_some()
}

/// Handles an editing key where the text may be selected as a whole: what is typed replaces it, a cursor key keeps it.
/// Returns whether the text or the cursor changed.
pub(super) fn edit_selected(input: &mut Input, whole: &mut bool, key: KeyEvent) -> bool {
    let replaces = types(key) || matches!(key.code, KeyCode::Backspace | KeyCode::Delete);
    let emptied = std::mem::take(whole) && replaces;
    if emptied {
        input.reset();
    }
    edit(input, key) || emptied
}

/// Inserts pasted text, in place of the text where that is selected as a whole. Returns whether all of it fitted.
pub(super) fn paste_selected(input: &mut Input, whole: &mut bool, text: &str) -> bool {
    if std::mem::take(whole) {
        input.reset();
    }
    paste(input, text)
}

/// Inserts pasted text as if it were typed. Returns whether all of it fitted.
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

    fn typed(text: &str, keys: &[KeyEvent]) -> String {
        let mut field = InputField::new(Purpose::Step, text.to_owned());
        for key in keys {
            field.press(*key);
        }
        field.input.value().to_owned()
    }

    /// The initial text is selected as a whole, as in any form field.
    #[test]
    fn what_is_typed_takes_the_place_of_the_old_value() {
        let [three, dot] = ['3', '.'].map(|c| KeyEvent::from(KeyCode::Char(c)));
        assert_eq!(typed("1.06", &[three, dot]), "3.");
        assert_eq!(typed("1.06", &[KeyCode::Backspace.into(), three]), "3");
        assert_eq!(typed("1.06", &[KeyCode::Delete.into()]), "");
        assert_eq!(typed("1.06", &[]), "1.06");
        let [left, end] = [KeyCode::Left, KeyCode::End].map(KeyEvent::from);
        assert_eq!(typed("1.06", &[left, three]), "1.036");
        assert_eq!(typed("1.06", &[end, three]), "1.063");
        let mut field = InputField::new(Purpose::Step, "1.06".to_owned());
        assert!(field.paste("0.5") && field.paste("1"));
        assert_eq!(field.input.value(), "0.51");
    }

    #[test]
    fn a_line_is_edited_as_lines_are() {
        let typed = |keys: &str| {
            let mut input = Input::new("2*sin(theta) + 1".to_owned());
            for name in keys.split(' ') {
                edit(&mut input, super::super::key::named(name).expect("a key"));
            }
            input.value().to_owned()
        };
        assert_eq!(typed("Ctrl-u Ctrl-y x"), "2*sin(theta) + 1x");
        assert_eq!(typed("Home Right Ctrl-k"), "2");
        assert_eq!(typed("Ctrl-w Ctrl-Backspace"), "2*sin(");
        assert_eq!(typed("Alt-Backspace Ctrl-h"), "2*sin(theta) +");
        assert_eq!(typed("Shift-Left Θ Ctrl-a Shift-z"), "Z2*sin(theta) + Θ1");
        assert_eq!(typed("Ctrl-Alt-x Alt-x Ctrl-x Tab F1"), "2*sin(theta) + 1");
    }

    #[test]
    fn a_line_has_an_end() {
        let mut input = Input::new("x".repeat(MOST));
        for name in ["x", "Ctrl-u", "Ctrl-y", "Ctrl-y"] {
            edit(&mut input, super::super::key::named(name).expect("a key"));
        }
        assert_eq!(input.value().len(), MOST);
    }
}
