//! Sessions: taken from the lab, offered, resumed.
//!
//! In: the application, and sessions as stored. Out: [`Saved`] sessions, and the restored application. Never here: the
//! file in which a session is stored.
//!
//! A system rebuilt from a changed file is resumed in the same way: everything that has the same name in both is
//! kept.

use super::pending::AwaitedView;
use super::{
    App, BufferState, Effect, Lab, Loaded, Notification, Overlay, Page, Saved, SourceBuffer,
};
use crate::experiment::{Checkpoint, Command};
use crate::instrument::{Plot, SavedPlot};
use crate::preset::law_digest;

/// The name of a system that has no file yet.
pub(super) const NEW_SYSTEM: &str = "system";

impl Saved {
    /// Returns the session of a lab on a page, or `None` before the first snapshot.
    fn of(lab: &Lab, page: Page) -> Option<Self> {
        let Loaded { name, document, model, system, .. } = &lab.loaded;
        let law = lab.restoration.law().cloned();
        let checkpoint = match lab.restoration.checkpoint() {
            Some(checkpoint) => checkpoint.clone(),
            None => Checkpoint::of(model, system, lab.seen()?),
        };
        Some(Self {
            version: Self::VERSION,
            phaselab: env!("CARGO_PKG_VERSION").to_owned(),
            open: name.clone(),
            page,
            focus: lab.focus.pane,
            zoomed: lab.focus.zoomed,
            selection: lab.selection,
            edited: false,
            law: law.or_else(|| law_digest(&document.text)),
            plots: lab.saved_plots(),
            time_unit: model.time_unit().to_owned(),
            marks: lab.marks.clone(),
            typed: lab.typed.clone(),
            in_front: lab.focused_before().collect(),
            checkpoint,
        })
    }
}

impl Lab {
    fn saved_plots(&self) -> Vec<SavedPlot> {
        self.plots.iter().map(|plot| SavedPlot::of(plot, self.loaded.physics())).collect()
    }

    /// Restores the view of a session, as far as the systems agree.
    fn restore_view(&mut self, saved: &Saved) {
        let physics = self.loaded.physics();
        let plots: Vec<Plot> = saved.plots.iter().filter_map(|plot| plot.place(physics)).collect();
        // If the quantities differ, the default pictures are better.
        if plots.len() == saved.plots.len() {
            self.plots = plots;
            self.focus.recent.clone_from(&saved.in_front);
        }
        if self.panes().any(|pane| pane == saved.focus) {
            (self.focus.pane, self.focus.zoomed) = (saved.focus, saved.zoomed);
            self.focus.untouched = false;
        }
        self.marks = saved.marks.iter().copied().filter(|mark| mark.is_finite()).collect();
        self.selection = saved.selection;
        self.select(|place| place);
    }
}

impl App {
    /// Returns the session to be stored, once a system is running in the lab.
    pub fn saved(&self) -> Option<Saved> {
        if self.page == Page::Picker {
            return self.left.clone();
        }
        // A system without a file could not be found again; its text is kept among the unsaved ones.
        let Some(lab) = self.lab.as_ref().filter(|_| self.has_file()) else {
            return self.left.clone();
        };
        let mut saved = Saved { edited: self.is_edited(), ..Saved::of(lab, self.page)? };
        // a view that waits for its text is not lost with the session
        if let Some(view) = self.awaited.view.as_ref().and_then(|view| view.for_plots(&saved.plots))
        {
            saved.plots.clone_from(&view.plots);
            saved.in_front.clone_from(&view.in_front);
        }
        Some(saved)
    }

    /// Whether the system in the lab can be opened again by its name.
    pub(super) fn has_file(&self) -> bool {
        let is_new = |lab: &Lab| lab.loaded.name == NEW_SYSTEM && self.file().is_none();
        self.lab.as_ref().is_some_and(|lab| !is_new(lab))
    }

    /// Whether the text of the system in the lab is another one than that of its file.
    pub(super) fn is_edited(&self) -> bool {
        let runs =
            |buffer: &SourceBuffer| buffer.is_modified() && buffer.state != BufferState::Left;
        self.own_buffer().is_some_and(runs)
    }

    /// Resumes a session as soon as its system is loaded.
    pub fn resume(&mut self, saved: Saved) {
        self.awaited.session = Some(saved);
    }

    /// Begins a motion as soon as the system of this name is opened, unless another one is opened first.
    pub fn start_with(&mut self, system: &str, start: Checkpoint) {
        self.awaited.start = Some((system.to_owned(), start));
    }

    /// Offers a session in the list of systems, as its first row.
    pub fn offer_session(&mut self, saved: Saved) {
        self.picker.offer(saved, true);
    }

    /// Opens the system of a session, and resumes it.
    pub(super) fn continue_session(&mut self, session: Saved) -> Vec<Effect> {
        let name = session.open.clone();
        self.resume(session);
        vec![self.ask(name, true)]
    }

    /// Starts a system that was just loaded, opened or only previewed: resumes the session left with it, or runs it
    /// from its initial values.
    pub(super) fn begin(&mut self, opened: bool) -> Vec<Effect> {
        let Some(lab) = &mut self.lab else { return Vec::new() };
        let start = if opened { self.awaited.start.take() } else { None };
        let saved = self.awaited.session.take();
        let saved = saved.filter(|saved| opened && saved.open == lab.loaded.name);
        let Some(saved) = saved else {
            if opened {
                self.remind();
                if let Some((name, start)) = start
                    && let Some(lab) = &mut self.lab
                    && lab.loaded.name == name
                {
                    lab.restoration.begin(start, law_digest(&lab.loaded.document.text));
                    return self.restore();
                }
            }
            return vec![Effect::Execute(Command::Play)];
        };
        lab.restore_view(&saved);
        lab.typed.clone_from(&saved.typed);
        lab.restoration.begin(saved.checkpoint.clone(), saved.law.clone());
        self.page = saved.page;
        if lab.restoration.is_of_another_law(&lab.loaded.document.text) && !saved.edited {
            let name = &lab.loaded.document.path;
            self.notifications.show(Notification::info(format!(
                "{name} has changed since: its law and its values hold from here on."
            )));
        }
        self.remind();
        // the motion belongs to the unsaved text, and waits until that is checked
        let has_typed = !saved.typed.is_empty();
        let waits = saved.edited && self.wake() || has_typed && self.check_again().is_ok();
        // pictures of what only that text has, or was typed for an axis, wait as well
        let until = self.lab.as_ref().filter(|_| waits).map(Lab::saved_plots);
        self.awaited.view = until.map(|until| AwaitedView { saved, until });
        if waits { Vec::new() } else { self.restore() }
    }

    /// Sends the awaited checkpoint to the experiment, if there is one.
    pub(super) fn restore(&mut self) -> Vec<Effect> {
        let Some(lab) = &mut self.lab else { return Vec::new() };
        lab.restoration.end_wait();
        let awaited = lab.restoration.under_the_law_of(&lab.loaded.document.text);
        let command = |checkpoint| Effect::Execute(Command::Restore(Box::new(checkpoint)));
        awaited.map(command).into_iter().collect()
    }

    /// Replaces the system in the lab by one rebuilt from a changed file; the motion and its view continue.
    pub(super) fn rebuilt(&mut self, loaded: Loaded) -> Vec<Effect> {
        let Some(mut old) = self.lab.take() else {
            let alone = matches!(self.overlay, Some(Overlay::Workbench));
            return if alone { self.mended(loaded) } else { self.loaded(loaded) };
        };
        let mut saved = Saved::of(&old, self.page);
        let awaited = old.restoration.checkpoint();
        if let (Some(saved), None, Some(seen)) = (&mut saved, awaited, old.seen()) {
            // The recorded trail continues too.
            let checkpoint = std::mem::take(&mut saved.checkpoint);
            saved.checkpoint = checkpoint.with_past(&old.loaded.system, seen);
        }
        let mut lab = Lab::new(loaded);
        lab.set_least_ranges(std::mem::take(&mut old.least_ranges));
        // A history refers to values, channels, views and frames by index.
        let places = |lab: &Lab| {
            let Loaded { model, system, .. } = &lab.loaded;
            let names = model.parameters.iter().map(|p| p.name.clone());
            let channels = system.channels().iter().map(|c| c.name.clone());
            let names: Vec<String> = names.chain(channels).collect();
            (names, model.views.len(), model.frames.len())
        };
        if places(&old) == places(&lab) {
            lab.history = old.history;
            let law = |lab: &Lab| law_digest(&lab.loaded.document.text);
            if law(&lab) != saved.as_ref().and_then(|saved| saved.law.clone()) {
                lab.history.forget_motions();
            }
        }
        // An open list or field refers to indices of the old system.
        if matches!(self.overlay, Some(Overlay::Menu(_) | Overlay::Field(_))) {
            self.overlay = None;
        }
        // The answer to a pending question would be about the old system.
        if let Some(Overlay::Prompt(prompt)) = &mut self.overlay {
            prompt.under_way = None;
        }
        self.meter.forget();
        let Some(saved) = saved else {
            self.lab = Some(lab);
            return vec![Effect::Execute(Command::Play)];
        };
        let awaited = self.awaited.view.take();
        let view = awaited.as_ref().and_then(|view| view.for_plots(&saved.plots));
        lab.restore_view(view.unwrap_or(&saved));
        lab.typed = old.typed;
        if lab.plots.len() == old.plots.len() {
            lab.focus.recent = old.focus.recent;
        }
        let (known, now) = (old.loaded.system.channels(), lab.loaded.system.channels());
        lab.answers.inherit(&old.answers, &|column| {
            let name = &known.get(column)?.name;
            now.iter().position(|channel| channel.name == *name)
        });
        lab.restoration.begin(saved.checkpoint, saved.law);
        self.lab = Some(lab);
        self.take_new_section();
        let mut effects = self.restore();
        effects.extend(self.take_typed_axis());
        effects
    }
}
