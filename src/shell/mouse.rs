//! The buttons of the mouse as terminals give them.
//!
//! In: an event of the mouse. Out: the event that is meant. Never here: what it hits.

use crossterm::event::{KeyModifiers, MouseButton, MouseEvent, MouseEventKind};

/// Shift makes the right button of the left one: many terminals keep one of the two for themselves.
pub(super) fn with_shift(mouse: MouseEvent) -> MouseEventKind {
    let shifted = mouse.modifiers.contains(KeyModifiers::SHIFT);
    match mouse.kind {
        MouseEventKind::Up(MouseButton::Left) if shifted => MouseEventKind::Up(MouseButton::Right),
        MouseEventKind::Down(MouseButton::Left) if shifted => {
            MouseEventKind::Down(MouseButton::Right)
        }
        kind => kind,
    }
}
