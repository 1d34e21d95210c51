//! The buttons of the mouse as terminals give them.
//!
//! In: an event of the mouse. Out: the event that is meant. Never here: what it hits.

use crossterm::event::{KeyModifiers, MouseButton, MouseEvent, MouseEventKind};

/// Shift makes the right button of the left one: many terminals keep one of the two for themselves.
pub(super) fn with_shift(mouse: MouseEvent) -> MouseEventKind {
    match mouse.kind {
        MouseEventKind::Up(MouseButton::Left) if mouse.modifiers.contains(KeyModifiers::SHIFT) => {
            MouseEventKind::Up(MouseButton::Right)
        }
        MouseEventKind::Down(MouseButton::Left)
            if mouse.modifiers.contains(KeyModifiers::SHIFT) =>
        {
            MouseEventKind::Down(MouseButton::Right)
        }
        kind => kind,
    }
}
