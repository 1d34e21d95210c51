//! The page of notes: the file's description of itself, and its expectations.
//!
//! In: the model. Out: a page of text. Never here: whether the expectations are met; `phaselab check` tests that.

use super::RenderStyle;
use super::number::brief;
use super::text_page::TextPage;
use super::theme::Role;
use crate::app::Lab;

pub(super) fn document(lab: &Lab, style: &RenderStyle) -> TextPage {
    let model = &lab.loaded.model;
    let mut page = TextPage::default();
    page.heading(&model.info.title);
    if !model.info.summary.is_empty() {
        page.words(Role::Text, model.info.summary.as_str());
    }
    for paragraph in model.info.notes.split("\n\n").map(str::trim).filter(|p| !p.is_empty()) {
        page.gap();
        page.notes(Role::Text, paragraph);
    }
    page.heading("Source");
    let source = if model.info.source.is_empty() { "not named" } else { &model.info.source };
    page.words(Role::Text, source);
    if !model.info.topics.is_empty() {
        page.words(Role::Dim, model.info.topics.join(" · "));
    }
    if !model.parameters.is_empty() {
        page.heading("Parameters");
        for p in &model.parameters {
            let name = style.glyphs.pick(&p.shown, &p.name);
            let unit = if p.unit.is_empty() { String::new() } else { format!(" {}", p.unit) };
            let value = brief(p.value, 6, style.glyphs);
            page.formula(name, format!("{value}{unit}"), &p.about);
        }
    }
    let values = &model.expect.values;
    if !values.is_empty() || !model.expect.conserves.is_empty() {
        page.heading("What is expected");
    }
    if !model.expect.conserves.is_empty() {
        let names: Vec<_> = model.expect.conserves.iter().map(|(name, ..)| name.as_str()).collect();
        page.words(Role::Text, format!("Conserved: {}.", names.join(", ")));
    }
    for value in values {
        page.gap();
        page.words(Role::Text, format!("{}:", value.name));
        let is = brief(value.is, 12, style.glyphs);
        let when = brief(value.at, 6, style.glyphs);
        let source =
            if value.source.is_empty() { String::new() } else { format!(" — {}", value.source) };
        page.words(Role::Dim, format!("{is} at t = {when}{source}"));
    }
    page.balanced()
}
