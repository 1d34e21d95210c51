//! The plain-text page: everything on the screen, in order, as lines of text without pictures, columns or bars.
//!
//! In: the lab and the snapshot to be read. Out: a page of text. Never here: anything that changes without input.

use super::companions;
use super::gauges::{change, finding};
use super::header::status_words;
use super::number::{brief, drift, readable};
use super::quantity::Quantities;
use super::text_page::TextPage;
use super::values::of_file;
use super::verdict::in_full;
use crate::app::keymap::{KEYS, KeyContext};
use crate::app::{Lab, Pane, ValueId, ValueInfo};
use crate::experiment::Snapshot;

const CONTEXTS: [KeyContext; 3] = [KeyContext::Plain, KeyContext::Experiment, KeyContext::Anywhere];

pub(super) fn document(q: &Quantities<'_>) -> TextPage {
    let mut page = TextPage::default();
    let mut write = |text: String| page.line(&q.style.glyphs.text(&text));
    let (lab, snapshot) = (q.lab, q.snapshot);
    let info = &lab.loaded.model.info;
    write(format!("{}.", info.title));
    if !info.summary.is_empty() {
        write(info.summary.clone());
    }
    write(status_words(q));
    let focus = lab.name_of(lab.focus.pane);
    let chosen = lab.selected().and_then(|target| lab.value_info(target));
    let selected = chosen.map_or_else(String::new, |f| format!(", {} selected", name(q, &f)));
    write(format!("Focus: {focus}{selected}."));
    for (title, kind) in [
        ("Parameters", ValueId::Parameter as fn(usize) -> ValueId),
        ("Initial values", ValueId::Initial),
    ] {
        let count = lab.count(kind);
        write(format!("{title}, {count}:"));
        for index in 0..count {
            write(value(q, kind(index)));
        }
    }
    write("State:".to_owned());
    let channels = lab.loaded.system.channels();
    for (index, channel) in channels.iter().enumerate() {
        if channel.name.is_empty() || channels[..index].iter().any(|c| c.name == channel.name) {
            continue;
        }
        let is = readable(q.value(index), 8, q.style.glyphs);
        write(format!("{} is {is}{}", q.name(index), after(&channel.unit)));
    }
    write(format!("Gauges, {}:", snapshot.gauges.len()));
    for gauge in snapshot.gauges.iter() {
        let shown = q.style.glyphs.pick(&gauge.shown, &gauge.name);
        let called =
            if *shown == gauge.name { String::new() } else { format!(" ({})", gauge.name) };
        let verdict = in_full(&gauge.verdict).0;
        let moved = match change(gauge, usize::MAX, q.style.glyphs) {
            Some(by) => format!("changed by {by}"),
            None => format!("drift {}", drift(gauge.drift, q.style.glyphs)),
        };
        write(format!(
            "{shown}{called} is {}; {moved} since t = {}; {verdict}: {}. Reason: {}.",
            readable(gauge.value, 8, q.style.glyphs),
            brief(gauge.reference_time, 6, q.style.glyphs),
            finding(gauge, q.style.glyphs),
            gauge.reason
        ));
    }
    if !snapshot.companions.is_empty() {
        write(format!("Beside this motion, {}:", snapshot.companions.len()));
    }
    for (one, (_, separation)) in snapshot.companions.iter().zip(snapshot.separations.iter()) {
        let (name, value, rest) = companions::words(one, separation, q.style.glyphs);
        write(format!("{name}: {value}; {rest}"));
    }
    notifications(snapshot, q, &mut write);
    write("Pictures:".to_owned());
    for pane in lab.panes().filter(|pane| matches!(pane, Pane::Plot(_))) {
        write(lab.name_of(pane));
    }
    write("Keys:".to_owned());
    for row in CONTEXTS.iter().flat_map(|context| KEYS.iter().filter(|row| row.context == *context))
    {
        let keys: Vec<String> = row.key_names().into_iter().map(spoken).collect();
        write(format!("{}: {}", keys.join(" or "), row.help));
    }
    page
}

/// Lists occurrences and notifications, newest first.
fn notifications(snapshot: &Snapshot, q: &Quantities<'_>, write: &mut impl FnMut(String)) {
    let notices: Vec<String> = snapshot.notices.iter().rev().cloned().collect();
    if !notices.is_empty() {
        write("Messages (newest first):".to_owned());
        notices.into_iter().for_each(&mut *write);
    }
    let happened = snapshot.occurrences.count();
    if happened > 0 {
        write(format!("Events, {happened} (newest first):"));
        for occurrence in snapshot.occurrences.iter().rev().take(MOST) {
            write(format!(
                "{} at t = {}",
                occurrence.name,
                brief(occurrence.time, 6, q.style.glyphs)
            ));
        }
    }
}

/// The most occurrences that are listed; the newest come first.
const MOST: usize = 10;

/// A value with its name, its meaning, its unit and its range.
fn value(q: &Quantities<'_>, target: ValueId) -> String {
    let lab: &Lab = q.lab;
    let Some(info) = lab.value_info(target) else { return String::new() };
    let number = match target {
        ValueId::Parameter(index) => {
            let (parameters, time) = (&q.snapshot.parameters, q.snapshot.time);
            let ramped = lab.ramped_value(index, time, parameters);
            ramped.or_else(|| parameters.get(index).copied())
        }
        ValueId::Initial(index) => q.snapshot.initial.get(index).copied(),
    };
    let is = number.map_or_else(|| "not known".to_owned(), |v| brief(v, 6, q.style.glyphs));
    let is = if info.ramped { format!("now {is}, ramped") } else { is };
    let mut about = String::new();
    let parts = of_file(q.lab, &info, q.style.glyphs).into_iter().chain([info.about.clone()]);
    for part in parts.filter(|part| !part.is_empty()) {
        about += ", ";
        about += &part;
    }
    let range = info.range.map_or_else(String::new, |(min, max, _)| {
        format!(", from {} to {}", brief(min, 4, q.style.glyphs), brief(max, 4, q.style.glyphs))
    });
    format!("{} is {is}{}{about}{range}", name(q, &info), after(&info.unit))
}

fn name(q: &Quantities<'_>, info: &ValueInfo) -> String {
    q.style.glyphs.pick(&info.shown, &info.name).clone()
}

fn after(unit: &str) -> String {
    if unit.is_empty() { String::new() } else { format!(" {unit}") }
}

fn spoken(name: String) -> String {
    let words = [
        ("↑", "Up"),
        ("↓", "Down"),
        ("←", "Left"),
        ("→", "Right"),
        ("?", "question mark"),
        (".", "full stop"),
        (":", "colon"),
        ("/", "slash"),
        ("[", "left bracket"),
        ("]", "right bracket"),
        ("{", "left brace"),
    ];
    words.into_iter().find(|(sign, _)| *sign == name).map_or(name, |(_, word)| word.to_owned())
}
