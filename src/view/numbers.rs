//! The page of numbers: all quantities of the current state, as text.
//!
//! In: the channels and their values. Out: a page of text. Never here: pictures.

use super::companions;
use super::gauges::{change, shown_value};
use super::number::{drift, readable};
use super::quantity::Quantities;
use super::text_page::TextPage;
use super::theme::Role;
use super::verdict::{in_full, is_residual, word};
use crate::experiment::EventCount;
use crate::instrument::{described, described_mode, displaced};
use crate::system::{Channel, ChannelKind};

/// A heading, and the test for the channels listed under it.
type ChannelGroup = (&'static str, fn(&ChannelKind) -> bool);

pub(super) fn document(q: &Quantities<'_>) -> TextPage {
    let mut page = TextPage::default();
    let glyphs = q.style.glyphs;
    page.heading("State");
    let unit = q.lab.loaded.model.time_unit();
    page.value("t", &readable(q.snapshot.time, 10, glyphs), unit, Vec::new());
    let groups: [ChannelGroup; 6] = [
        ("", |kind| matches!(kind, ChannelKind::Position(_))),
        ("Velocities", |kind| matches!(kind, ChannelKind::Velocity(_))),
        ("Momenta", |kind| matches!(kind, ChannelKind::Momentum(_))),
        ("Multipliers", |kind| matches!(kind, ChannelKind::Multiplier(_))),
        ("Casimirs", |kind| matches!(kind, ChannelKind::Casimir(_))),
        ("Observables", |kind| {
            matches!(
                kind,
                ChannelKind::Energy
                    | ChannelKind::EnergyBalance
                    | ChannelKind::Observable(_)
                    | ChannelKind::Extra(_)
            )
        }),
    ];
    let channels = q.lab.loaded.system.channels();
    for (title, belongs) in groups {
        let members: Vec<(usize, &Channel)> =
            channels.iter().enumerate().filter(|(_, c)| belongs(&c.kind)).collect();
        if !title.is_empty() && !members.is_empty() {
            page.heading(title);
        }
        for (index, channel) in members {
            let value = readable(q.value(index), 10, glyphs);
            page.value(&q.name(index), &value, &channel.unit, Vec::new());
        }
    }
    occurrences(&mut page, q);
    beside(&mut page, q);
    equilibria(&mut page, q);
    page.heading("Gauges");
    for gauge in q.snapshot.gauges.iter() {
        let name = glyphs.pick(&gauge.shown, &gauge.name);
        let residual = is_residual(q.lab, gauge);
        let (text, role) = if residual { word(&gauge.verdict) } else { in_full(&gauge.verdict) };
        let drifted = match change(gauge, 9, glyphs) {
            Some(by) => format!("  by {by:<12} "),
            None => format!("  drift {:<9} ", drift(gauge.drift, glyphs)),
        };
        let drifted = if residual { format!("{:<18}", "  residual") } else { drifted };
        let rest = vec![
            (Role::Dim, drifted),
            (role, format!("{text:<18}")),
            (Role::Dim, gauge.reason.clone()),
        ];
        let value = readable(shown_value(gauge, residual), 10, glyphs);
        page.value(&glyphs.text(name), &value, "", rest);
    }
    page
}

/// Lists the equilibria that were found: kind, place, energy, frequencies and modes.
fn equilibria(page: &mut TextPage, q: &Quantities<'_>) {
    let present = q.present();
    if present.equilibria.is_empty() {
        return;
    }
    page.heading("Equilibria");
    let glyphs = q.style.glyphs;
    for one in present.equilibria {
        let (what, about) = described(present.physics, one);
        page.line(&glyphs.text(&format!("{what}; {about}")));
        for work in &one.work {
            let coordinate = displaced(present.physics, work);
            let label = glyphs.text(&format!("δW/δ{coordinate}")).into_owned();
            page.formula(&label, glyphs.text(&work.balance()).into_owned(), "");
        }
        for mode in 0..one.modes.len() {
            let mode = described_mode(present.physics, one, mode);
            page.item("  mode", &glyphs.text(&mode));
        }
    }
}

/// Lists each motion beside the main one: what it is, its distance, and how fast that grows.
fn beside(page: &mut TextPage, q: &Quantities<'_>) {
    if q.snapshot.companions.is_empty() {
        return;
    }
    page.heading("Beside this motion");
    for (one, (_, separation)) in q.snapshot.companions.iter().zip(q.snapshot.separations.iter()) {
        let glyphs = q.style.glyphs;
        let (name, value, rest) = companions::words(one, separation, glyphs);
        page.value(&name, &value, "", vec![(Role::Dim, format!("  {rest}"))]);
    }
}

/// Lists each event and impulse: how often it has happened, and when it last did.
fn occurrences(page: &mut TextPage, q: &Quantities<'_>) {
    let event_log = &q.snapshot.occurrences;
    if event_log.is_empty() {
        return;
    }
    page.heading("Events and impulses");
    for EventCount { name, count, last } in event_log.counts() {
        let last = readable(*last, 10, q.style.glyphs);
        let rest = vec![(Role::Dim, format!(", last at t = {last}"))];
        let times = if *count == 1 { "time" } else { "times" };
        page.value(name, &count.to_string(), times, rest);
    }
}
