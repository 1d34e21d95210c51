//! The effect of each action.
//!
//! In: an [`Action`]. Out: the changed state and the effects. Never here: keys; the contents of pop-up lists.

use super::earlier_window::EarlierWindow;
use super::speed::{faster, slower};
use super::{Action, App, Effect, Notification, Overlay, Page, Pane, Purpose, SourceBuffer};
use crate::experiment::{Command, Status};
use crate::instrument::{Plot, Sight, Viewport};

impl App {
    /// Carries out an action. It does nothing if the action does not apply.
    pub(super) fn handle_action(&mut self, action: Action) -> Vec<Effect> {
        if action != Action::Back && self.asked_to_leave() {
            self.notifications.dismiss();
        }
        match action {
            Action::Quit if self.closes_with_quit() => {
                if let Some(Overlay::Help { search, .. }) = &mut self.overlay {
                    *search = None;
                }
                self.back()
            }
            Action::Quit | Action::QuitAll => self.quit(),
            Action::Suspend => vec![Effect::Suspend],
            Action::Repaint => vec![Effect::Repaint],
            Action::Help => self.help(),
            Action::Palette => self.open_palette(),
            Action::ReadAnew | Action::ReadOn => self.read_by(action),
            Action::ChooseTheme => self.open_themes(),
            Action::Mouse => self.switch_mouse(),
            Action::FewerFrames => self.change_frames(false),
            Action::MoreFrames => self.change_frames(true),
            Action::Back => self.back(),
            Action::Show(page) => {
                // What was said of the page before does not cover another.
                self.notifications.shown.take_if(|notice| page != self.page && !notice.is_error());
                self.go(page);
                Vec::new()
            }
            Action::Move(way) => self.shift(way),
            Action::First => self.jump(isize::MIN),
            Action::Last => self.jump(isize::MAX),
            Action::PageUp => self.jump(-self.screenful()),
            Action::PageDown => self.jump(self.screenful()),
            Action::Search => {
                if let Some(Overlay::Help { search, typing, .. }) = &mut self.overlay {
                    search.get_or_insert_default();
                    *typing = true;
                } else if self.page != Page::Picker || self.overlay.is_some() {
                    return self.search_page();
                } else {
                    self.picker.search(|_| ());
                }
                Vec::new()
            }
            Action::NextMatch | Action::PreviousMatch => {
                self.next_match(action == Action::NextMatch)
            }
            Action::Open => self.open_selected(),
            Action::Accept => self.accept(),
            Action::Mark => {
                if let Some(Overlay::Menu(menu)) = &mut self.overlay {
                    menu.mark();
                }
                Vec::new()
            }
            Action::EditCommand(work) => self.work(work),
            Action::NewSystem => self.new_system(),
            Action::Guides => self.open_guides(),
            Action::Edit if matches!(self.overlay, Some(Overlay::Message(_))) => self.mend_file(),
            other => self.handle_lab_action(other),
        }
    }

    /// Carries out the actions that need a loaded system.
    fn handle_lab_action(&mut self, action: Action) -> Vec<Effect> {
        let Some(lab) = &mut self.lab else { return Vec::new() };
        match action {
            Action::PlayPause => match lab.snapshot.as_ref().map(|s| &s.status) {
                Some(Status::Running) => vec![Effect::Execute(Command::Pause)],
                Some(Status::Failed(_)) => self.fail("It cannot continue from here; r resets it."),
                Some(Status::Ended(_)) => self.notify("The motion has ended; r restarts it."),
                Some(Status::Paused) | None => vec![Effect::Execute(Command::Play)],
            },
            Action::Step => {
                vec![Effect::Execute(Command::Pause), Effect::Execute(Command::Step(1))]
            }
            Action::Reverse => self.reverse(),
            Action::ShowEarlier => self.scrub_by(-1.0),
            Action::ShowLater => self.scrub_by(1.0),
            Action::MarkTime => self.mark_time(),
            Action::GoToMark => self.go_to_mark(true),
            Action::GoToNextMark => self.go_to_mark(false),
            Action::StepBack => vec![Effect::Execute(Command::StepBack(1))],
            Action::Slower | Action::Faster => {
                let shown = lab.snapshot.as_ref().map_or(1.0, |s| s.speed);
                let speed = lab.pending.speed.unwrap_or(shown);
                let speed = if action == Action::Faster { faster(speed) } else { slower(speed) };
                lab.pending.speed = Some(speed);
                vec![Effect::Execute(Command::Speed(speed))]
            }
            Action::Reset => {
                lab.earlier_window = EarlierWindow::default();
                vec![Effect::Execute(Command::Reset)]
            }
            Action::FullReset => {
                lab.earlier_window = EarlierWindow::default();
                lab.full_reset()
            }
            Action::Reference => vec![Effect::Execute(Command::Reference)],
            Action::Undo => match lab.undo() {
                Some((effects, report)) => self.report(report, effects),
                None => self.nothing_to_undo(),
            },
            Action::Redo => match lab.redo() {
                Some((effects, report)) => self.report(report, effects),
                None => self.notify("Nothing to redo."),
            },
            Action::ApplyImpulse => self.apply_one_impulse(),
            Action::Export => vec![Effect::Export],
            Action::Ask => self.open_prompt(),
            Action::SearchFurther => self.search_further(),
            Action::Brackets => self.show_brackets(),
            Action::ApplyFlow => self.open_flows(),
            Action::Edit => self.edit_file(),
            Action::Still => vec![Effect::Still],
            Action::Data => vec![Effect::Data],
            Action::Share => self.share(),
            Action::CopyLatex => {
                let text = lab.loaded.latex();
                vec![Effect::Copy { what: "the equations", text, ending: "tex" }]
            }
            Action::Record => {
                self.recording = !self.recording;
                vec![Effect::Record(self.recording)]
            }
            Action::ChooseMethod => self.open_methods(),
            Action::TypeStep => self.open_field(Purpose::Step),
            Action::TypeTolerance => self.open_field(Purpose::Tolerance),
            Action::TypeValue => match lab.selected() {
                Some(target) => self.open_field(Purpose::Value(target)),
                None => self.notify("There is nothing to type here."),
            },
            Action::NextPane | Action::PreviousPane => {
                lab.focus.pane = lab.pane_beside(action == Action::NextPane);
                Vec::new()
            }
            Action::NextTab => match lab.next_tab() {
                Some(pane) => {
                    lab.focus.pane = pane;
                    Vec::new()
                }
                None => self.notify("There are no tabs here."),
            },
            Action::Zoom => {
                lab.focus.zoomed = !lab.focus.zoomed;
                Vec::new()
            }
            Action::ChooseAxes => self.open_axes(),
            Action::StartHere => self.start_here(),
            Action::AddStart => self.add_start_here(),
            Action::AddNeighbour => self.add_neighbour(),
            Action::Equilibria => self.find_equilibria(),
            Action::Exponents => self.show_picture("exponents"),
            Action::Ensemble => self.show_picture("ensemble"),
            Action::PeriodicOrbit => self.find_orbit(),
            Action::Spectrum => self.show_picture("spectrum"),
            Action::Diagram => self.show_diagram(),
            Action::Ramp => self.open_ramp(),
            Action::Pin => vec![Effect::Execute(Command::Pin)],
            Action::ClearCompanions => self.clear_companions(),
            Action::AddOrbits => self.add_orbits(),
            Action::TypeSurface => self.open_surface(),
            Action::TurnDirection => self.turn_direction(),
            Action::FillSection => self.fill_section(),
            Action::ClearOrbits => self.clear_orbits(),
            Action::Change { sign, coarse } => {
                let Some(target) = lab.selected() else { return Vec::new() };
                let to = lab.stepped(target, sign, coarse);
                to.map_or_else(Vec::new, |to| lab.change(target, to))
            }
            Action::Restore => {
                let Some(target) = lab.selected() else { return Vec::new() };
                lab.of_file(target).map_or_else(Vec::new, |to| lab.change(target, to))
            }
            Action::Closer(axes) => self.zoom(1.25, axes.chosen()),
            Action::Farther(axes) => self.zoom(0.8, axes.chosen()),
            Action::Log => self.with_viewport(|viewport| viewport.log = !viewport.log),
            Action::Equal => match lab.focused_plot() {
                Some((_, plot)) if plot.kind.properties().has_equal_axes => {
                    self.with_viewport(|viewport| viewport.equal = !viewport.equal)
                }
                _ => self.notify("Equal scales need a plot of one quantity against another."),
            },
            Action::Active => self.other_way(),
            Action::VectorField => self.toggle_field(),
            Action::ByChaos => match lab.focused_plot() {
                Some((_, plot)) if plot.kind.properties().classifies_orbits => {
                    self.with_viewport(|viewport| viewport.by_chaos = !viewport.by_chaos)
                }
                _ => self.notify("Only a section colours its orbits; v chooses one."),
            },
            Action::Cursor => self.toggle_cursor(),
            Action::NextFrame => self.next_frame(),
            Action::Home => self.with_plot(|plot, loaded| plot.home(&loaded.model)),
            _ => Vec::new(),
        }
    }

    /// Shows a notification and passes the effects on.
    fn report(&mut self, sentence: String, effects: Vec<Effect>) -> Vec<Effect> {
        self.notifications.show(Notification::info(sentence));
        effects
    }

    /// Notifies the user why a key does nothing here.
    pub(super) fn notify(&mut self, text: impl Into<String>) -> Vec<Effect> {
        self.notifications.show(Notification::hint(text));
        Vec::new()
    }

    pub(super) fn fail(&mut self, text: impl Into<String>) -> Vec<Effect> {
        self.notifications.show(Notification::error(text));
        Vec::new()
    }

    /// Says that there is nothing to undo, or where a changed text is undone.
    fn nothing_to_undo(&mut self) -> Vec<Effect> {
        let is_edited = self.own_buffer().is_some_and(SourceBuffer::is_modified);
        self.notify(if is_edited {
            "Nothing to undo here; changes of the text are undone in the editor: E, then Ctrl-u."
        } else {
            "Nothing to undo."
        })
    }

    pub(super) fn with_plot(
        &mut self,
        change: impl FnOnce(&mut Plot, &super::Loaded),
    ) -> Vec<Effect> {
        if let Some(lab) = &mut self.lab
            && let Pane::Plot(index) = lab.focus.pane
        {
            lab.redraw(index, change);
        }
        Vec::new()
    }

    /// Zooms the focused picture about its cursor or the moving point.
    fn zoom(&mut self, factor: f64, axes: [bool; 2]) -> Vec<Effect> {
        let moving = self.drawn.moving;
        self.with_plot(|plot, _| {
            let place = plot.centre_of_zoom(moving);
            plot.zoom_about(factor, axes, place);
        })
    }

    /// Switches the focused picture, or else the first spatial view, to the next reference frame; the axes of the
    /// file follow the last frame.
    fn next_frame(&mut self) -> Vec<Effect> {
        let count = self.lab.as_ref().map_or(0, |lab| lab.loaded.model.frames.len());
        if count == 0 {
            return self.notify("This system has no frames to look from.");
        }
        let Some(lab) = &mut self.lab else { return Vec::new() };
        let pictures = lab.focused_plot().into_iter().chain(lab.plots.iter().enumerate());
        let picture = pictures.filter(|(_, plot)| plot.kind.properties().is_scene).map(|(i, _)| i);
        let Some(picture) = picture.min_by_key(|i| lab.focus.pane != Pane::Plot(*i)) else {
            return self
                .notify("No picture shows the motion in space; v chooses what a pane shows.");
        };
        lab.redraw(picture, |plot, _| {
            if let Sight::Camera(eye) = &mut plot.sight {
                eye.frame = Some(eye.frame.map_or(0, |frame| frame + 1)).filter(|f| *f < count);
            }
        });
        Vec::new()
    }

    pub(super) fn with_viewport(&mut self, change: impl FnOnce(&mut Viewport)) -> Vec<Effect> {
        self.with_plot(|plot, _| {
            if let Some(viewport) = plot.viewport_mut() {
                change(viewport);
            }
        })
    }

    fn change_frames(&mut self, more: bool) -> Vec<Effect> {
        let Some(rate) = self.meter.next_rate(more) else {
            let end = if more { "highest" } else { "lowest" };
            return self.notify(format!("The {end} rate is {} frames a second.", self.meter.asked));
        };
        self.meter.asked = rate;
        self.notifications.show(Notification::info(format!("At most {rate} frames a second.")));
        vec![Effect::Frames(rate)]
    }

    fn switch_mouse(&mut self) -> Vec<Effect> {
        self.mouse.is_reported = !self.mouse.is_reported;
        self.notifications.show(Notification::info(if self.mouse.is_reported {
            "Mouse on: click a phase portrait to start there, drag sliders; M to select text."
        } else {
            "Mouse off: the terminal selects text; M switches it on."
        }));
        vec![Effect::Mouse(self.mouse.is_reported)]
    }
}
