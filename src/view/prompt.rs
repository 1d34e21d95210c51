//! The prompt for brackets and conserved quantities, over the page.
//!
//! In: the prompt, the lab for current values. Out: cells. Never here: the computation of an answer.

use ratatui::layout::Rect;
use unicode_width::UnicodeWidthStr;

use super::canvas::{Canvas, StyledText, columns, row};
use super::number::readable;
use super::theme::Role;
use super::wrap::{formula, words};
use crate::analysis::{Inquiry, InquiryAnswer};
use crate::app::{Lab, Prompt};
use crate::expr::{Expr, Zero};
use crate::mechanics::{ChartBracket, Class};

/// Expressions with more nodes than this are not written out.
const MOST: u64 = 1_000;

/// The text shown before the first question.
const HELP: &str = "Two expressions with a comma between them give Poisson's bracket; one alone asks whether it is \
conserved. H is the energy, p_x a momentum, x' a velocity; observables of the file are written out.";

pub(super) fn draw(canvas: &mut Canvas<'_>, area: Rect, lab: &Lab, prompt: &Prompt) {
    let width = area.width.saturating_sub(2).min(100);
    let lines = lines(canvas, lab, prompt, usize::from(width.saturating_sub(4)));
    let height = (lines.len() as u16 + 4).min(area.height);
    let title = if lab.loaded.model.is_poisson() {
        "Bracket {f, g}, or is f conserved?"
    } else {
        "Bracket [f, g], or is f conserved?"
    };
    let title = canvas.span(Role::Title, title);
    let (_, inner) = canvas.dialog(area, (width, height), title);
    let field = row(inner, 0);
    let used = canvas.left(field, Role::Accent, "? ");
    let room = usize::from(field.width.saturating_sub(used + 1));
    let scroll = prompt.input.visual_scroll(room);
    let shown: String = prompt.input.value().chars().skip(scroll).collect();
    canvas.left(columns(field, used, field.width), Role::Text, &shown);
    let cursor = prompt.input.visual_cursor().saturating_sub(scroll) as u16;
    canvas.point(columns(field, used + cursor, 1).as_position());
    if let Some(diagnostic) = &prompt.diagnostic {
        // A caret under each character that is wrong.
        let text = prompt.input.value();
        let before = text.get(..diagnostic.span.start).unwrap_or(text).chars().count();
        let wrong =
            text.get(diagnostic.span.start..diagnostic.span.end).unwrap_or("").chars().count();
        let start = used + before.saturating_sub(scroll) as u16;
        let carets = "^".repeat(wrong.clamp(1, room.max(1)));
        canvas.left(columns(row(inner, 1), start, inner.width), Role::Bad, &carets);
    }
    for (index, line) in lines.iter().enumerate() {
        canvas.spans(row(inner, index + 2), line);
    }
}

fn lines(canvas: &Canvas<'_>, lab: &Lab, prompt: &Prompt, width: usize) -> Vec<Vec<StyledText>> {
    let mut page = PromptRows { canvas, width, lines: Vec::new() };
    if let Some(status) = prompt.under_way.as_ref().and_then(|(_, job)| job.status()) {
        page.words(Role::Dim, &status);
        return page.lines;
    }
    match (&prompt.diagnostic, &prompt.answered) {
        (Some(diagnostic), _) => {
            page.words(Role::Bad, &diagnostic.message);
            page.words(Role::Text, diagnostic.help.as_deref().unwrap_or_default());
        }
        (None, None) => page.words(Role::Dim, HELP),
        (None, Some((asked, inquiry))) => match &inquiry.answer {
            InquiryAnswer::Bracket { bracket, recognised, charts, .. } => {
                let (open, close) =
                    if lab.loaded.model.is_poisson() { ("{", "}") } else { ("[", "]") };
                let asked =
                    asked.trim().trim_start_matches(['[', '{']).trim_end_matches([']', '}']);
                let head = format!("{open}{asked}{close}");
                match bracket {
                    Ok(e) => page.formula(inquiry, &head, *e),
                    Err(why) => {
                        page.words(
                            Role::Dim,
                            &format!("{head} is not known in closed form: {why}"),
                        );
                    }
                }
                if let (Some(known), Ok(e)) = (recognised, bracket)
                    && known.expression != *e
                {
                    page.formula(inquiry, "", known.expression);
                }
                page.value("its value now", lab, inquiry);
                let (role, verdict) = match (inquiry.answer.vanishes(), recognised) {
                    (Zero::Proved, _) => (Role::Good, "It vanishes everywhere: proved."),
                    (Zero::Numerically, _) => (
                        Role::Warn,
                        "It vanishes to rounding at every point tried; there is no proof.",
                    ),
                    (Zero::Unknown, _) => {
                        (Role::Warn, "Whether it vanishes everywhere is not known.")
                    }
                    (Zero::No, Some(known)) if known.proof != Zero::Proved => (
                        Role::Text,
                        "It is not identically zero; the second form holds to rounding, without a proof.",
                    ),
                    (Zero::No, _) => (Role::Text, "It is not identically zero."),
                };
                page.words(role, verdict);
                for chart in charts {
                    page.chart(lab, inquiry, chart);
                }
                if !lab.loaded.model.constraints.is_empty() {
                    let what = "This is the bracket of the phase space without the constraints. Whether something is \
                        conserved along the motion is asked with one expression.";
                    page.words(Role::Dim, what);
                }
            }
            InquiryAnswer::Conservation { class, rate, .. } => {
                let head = rate_head(lab);
                match rate {
                    Ok(e) => page.formula(inquiry, head, *e),
                    Err(why) => {
                        page.words(
                            Role::Dim,
                            &format!("{head} is not known in closed form: {why}"),
                        );
                    }
                }
                page.value("its value now", lab, inquiry);
                let (role, verdict) = match class {
                    Class::Proved => (Role::Good, "Conserved: proved, dG/dt vanishes everywhere."),
                    Class::Numerically => (
                        Role::Warn,
                        "Conserved, to rounding: dG/dt vanishes at every point tried; there is no proof.",
                    ),
                    Class::AtTheseParameters => (
                        Role::Good,
                        "Conserved at the file's values of the parameters: proved; not at others.",
                    ),
                    Class::Changing => (Role::Bad, "Not conserved: it changes at this rate."),
                    Class::Unknown => {
                        (Role::Warn, "Not known: there is no proof, and values do not decide it.")
                    }
                };
                page.words(role, verdict);
            }
        },
    }
    page.lines
}

/// The label of the rate of change: the bracket if that is the whole rate, else the derivative along the motion.
fn rate_head(lab: &Lab) -> &'static str {
    let model = &lab.loaded.model;
    let forced = model.mechanics.forces().iter().any(|f| *f != Expr::ZERO)
        || model.mechanics.dissipation() != Expr::ZERO;
    match (forced || !model.constraints.is_empty(), model.is_poisson()) {
        (true, _) => "dG/dt along the motion",
        (false, true) => "dG/dt = {G, H} + ∂G/∂t",
        (false, false) => "dG/dt = [G, H] + ∂G/∂t",
    }
}

struct PromptRows<'a, 'b> {
    canvas: &'a Canvas<'b>,
    width: usize,
    lines: Vec<Vec<StyledText>>,
}

impl PromptRows<'_, '_> {
    fn words(&mut self, role: Role, text: &str) {
        let text = self.canvas.text(text);
        let wrapped = words(&text, self.width).into_iter().filter(|line| !line.is_empty());
        self.lines.extend(wrapped.map(|line| vec![(line, self.canvas.style(role))]));
    }

    /// Adds `head = e`, broken into lines if it is too long.
    fn formula(&mut self, inquiry: &Inquiry, head: &str, e: Expr) {
        let body = if inquiry.weight(e) > MOST {
            format!("… ({} pieces: phaselab bracket prints them)", inquiry.weight(e))
        } else {
            inquiry.written(e, !self.canvas.style.glyphs.is_ascii())
        };
        let (head, body) = (self.canvas.text(head), self.canvas.text(&body));
        let beside = head.width() <= self.width / 2;
        if !beside {
            self.words(Role::Accent, &head);
        }
        let margin = if beside { head.width().max(2) } else { 2 };
        let broken = formula(&body, self.width.saturating_sub(margin + 3), 2);
        for (index, line) in broken.into_iter().enumerate() {
            let head = if index == 0 && beside { head.clone() } else { String::new() };
            let sign = if index == 0 { " = " } else { "   " };
            self.lines.push(vec![
                (format!("{head:margin$}"), self.canvas.style(Role::Accent)),
                (sign.to_owned(), self.canvas.style(Role::Dim)),
                (line, self.canvas.style(Role::Text)),
            ]);
        }
    }

    fn value(&mut self, what: &str, lab: &Lab, inquiry: &Inquiry) {
        let now = lab.valuation();
        let value = inquiry.value(&|symbol| now.at(symbol));
        self.number(what, value);
    }

    /// The bracket in the new variables of a transformation: its value and, if it is known, its form.
    fn chart(&mut self, lab: &Lab, inquiry: &Inquiry, chart: &ChartBracket) {
        let variables = inquiry.variables(chart, !self.canvas.style.glyphs.is_ascii());
        let what = self.canvas.text(&format!("In {variables} of `{}`", chart.name));
        self.number(&what, inquiry.value_in(chart, &lab.valuation()));
        if let Ok(e) = chart.bracket {
            self.formula(inquiry, "", e);
        }
    }

    fn number(&mut self, what: &str, value: Option<f64>) {
        let text = value.map_or_else(
            || "not known here".to_owned(),
            |value| readable(value, 10, self.canvas.style.glyphs),
        );
        self.lines.push(vec![
            (format!("{what} "), self.canvas.style(Role::Dim)),
            (text, self.canvas.style(Role::Accent)),
        ]);
    }
}
