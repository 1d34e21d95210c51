//! The surface of a section, typed or turned by a key while one looks: written into the file's text.
//!
//! In: what is typed: `x = 0, rising`. Out: the text with the surface, which is checked and run as any change of the text,
//! so that the motion continues; the plot with it, as soon as that runs. Never here: how crossings are located.

use super::field::{InputField, Purpose};
use super::{App, Effect, Lab, Loaded, Notification, Overlay, Pane};
use crate::instrument::Plot;
use crate::model::{Allowed, Direction, Model, Scope, View};
use crate::preset::{NewSurface, NewZero, SurfaceView};
use crate::system::ChannelKind;

/// The words for directions besides those of files.
const DIRECTIONS: [(&str, Direction); 6] = [
    ("up", Direction::Rising),
    ("down", Direction::Falling),
    ("both", Direction::Either),
    ("upwards", Direction::Rising),
    ("downwards", Direction::Falling),
    ("+-", Direction::Either),
];

impl App {
    /// Asks for the surface of the focused section, or for one to be shown in place of the focused plot.
    pub(super) fn open_surface(&mut self) -> Vec<Effect> {
        let Some(lab) = &self.lab else { return Vec::new() };
        let Some((plot, shown)) = lab.focused_plot() else { return Vec::new() };
        let now = surface_of(shown, &lab.loaded.model).map_or_else(String::new, |(view, now)| {
            let on = view.axes.last().and_then(|axis| axis.first());
            let on = on.map_or("", |on| on.written.as_str());
            let of_angle = turn(&lab.loaded, on).is_some();
            format!("{on} = 0, {}", if of_angle { Direction::Either } else { now }.word())
        });
        self.overlay = Some(Overlay::Field(InputField::new(Purpose::Surface(plot), now)));
        Vec::new()
    }

    /// Counts the crossings of the focused section in the next direction.
    pub(super) fn turn_direction(&mut self) -> Vec<Effect> {
        let Some(lab) = &self.lab else { return Vec::new() };
        let focused = lab.focused_plot();
        let known = focused.and_then(|(plot, shown)| {
            let (_, now) = surface_of(shown, &lab.loaded.model)?;
            Some((plot, shown.view?, now))
        });
        let Some((plot, view, now)) = known else {
            return self.notify("Only a section has a direction; L shows one here.");
        };
        let next = match now {
            Direction::Rising => Direction::Falling,
            Direction::Falling => Direction::Either,
            Direction::Either => Direction::Rising,
        };
        let next = next.word();
        let surface = NewSurface { on: None, axes: None, direction: Some(next) };
        let sentence = format!("Crossings: {next}; E shows it in the text.");
        self.write_surface((plot, &SurfaceView::Known(view)), &surface, sentence)
    }

    /// Writes the surface that was typed into the text of the system.
    pub(super) fn accept_surface(&mut self, mut field: InputField, plot: usize) -> Vec<Effect> {
        let Some(lab) = &self.lab else { return Vec::new() };
        let Some(shown) = lab.plots.get(plot) else { return Vec::new() };
        let typed = field.input.value().trim().to_owned();
        let view = match (shown.kind.properties().is_section, shown.view) {
            (true, Some(view)) => Ok(SurfaceView::Known(view)),
            _ => lab.axes_of_section(shown, &typed).map(SurfaceView::New),
        };
        // a coordinate that the surface holds is no axis of its points
        let axes = match view {
            Ok(SurfaceView::Known(_)) if lab.holds_an_axis(shown, &typed) => {
                lab.free_axes(&typed).map(Some)
            }
            _ => Ok(None),
        };
        let found = view.and_then(|view| Ok((read(&lab.loaded, &typed)?, view, axes?)));
        match found {
            Ok((surface, view, axes)) => {
                let surface = NewSurface { axes, ..surface };
                let sentence = format!("Section at {typed}; E shows it in the text.");
                self.write_surface((plot, &view), &surface, sentence)
            }
            Err(sentence) => {
                field.diagnostic = Some(sentence);
                self.overlay = Some(Overlay::Field(field));
                Vec::new()
            }
        }
    }

    fn write_surface(
        &mut self,
        (plot, view): (usize, &SurfaceView),
        surface: &NewSurface,
        sentence: String,
    ) -> Vec<Effect> {
        if let Err(effects) = self.change_text(|text| surface.written_to(text, view)) {
            return effects;
        }
        if matches!(view, SurfaceView::New(_)) {
            self.awaited.plots.section = Some(plot);
        } else if let Some(lab) = &mut self.lab
            && let Some(shown) = lab.plots.get_mut(plot)
        {
            let channels = lab.loaded.system.channels();
            let column = |name: &String| channels.iter().position(|c| c.name == *name);
            let columns: Vec<usize> = surface.axes.iter().flatten().filter_map(column).collect();
            if let [x, y] = columns[..] {
                shown.columns = vec![vec![x], vec![y]];
            }
            // orbits were added to the surface before
            shown.seeds.clear();
            lab.answers.stale = true;
        }
        self.notifications.show(Notification::info(sentence));
        Vec::new()
    }

    /// Shows the section of a text that runs now where it was asked for.
    pub(super) fn take_new_section(&mut self) {
        let Some(plot) = self.awaited.plots.section.take() else { return };
        let Some(lab) = &mut self.lab else { return };
        let last = lab.loaded.model.views.len().saturating_sub(1);
        let Some(section) = Plot::of_view(lab.loaded.physics(), last) else { return };
        if let Some(shown) =
            lab.plots.get_mut(plot).filter(|_| section.kind.properties().is_section)
        {
            *shown = section;
            lab.focus.pane = Pane::Plot(plot);
            lab.answers.stale = true;
        }
    }
}

/// The view with the surface of a section, and the direction of its crossings.
fn surface_of<'a>(plot: &Plot, model: &'a Model) -> Option<(&'a View, Direction)> {
    let view = model.views.get(plot.view.filter(|_| plot.kind.properties().is_section)?)?;
    Some((view, model.sections.get(view.section?)?.direction))
}

/// Reads `EXPRESSION = VALUE`, `every PERIOD` or `event NAME`, and the direction behind a comma.
fn read(loaded: &Loaded, typed: &str) -> Result<NewSurface, String> {
    let model = &loaded.model;
    let (body, direction) = match typed.rsplit_once(',') {
        None => (typed, None),
        // the comma between two arguments
        Some((_, last)) if last.contains(')') => (typed, None),
        Some((body, last)) => {
            let of_files = Direction::ALL.map(|direction| (direction.word(), direction));
            let mut known = of_files.into_iter().chain(DIRECTIONS);
            let (_, direction) = known.find(|(word, _)| *word == last.trim()).ok_or_else(|| {
                format!("`{}` is not a direction: write rising, falling or either.", last.trim())
            })?;
            (body.trim(), Some(direction.word()))
        }
    };
    if let Some(name) = body.strip_prefix("event ").map(str::trim) {
        if !loaded.model.events.iter().any(|event| event.name == name) {
            let names: Vec<&str> = model.events.iter().map(|event| event.name.as_str()).collect();
            return Err(match &names[..] {
                [] => "The file has no events.".to_owned(),
                _ => format!("Unknown event `{name}`: the events are {}.", names.join(", ")),
            });
        }
        let on = Some(NewZero::OfEvent(name.to_owned()));
        return Ok(NewSurface { on, axes: None, direction });
    }
    let default = "rising";
    let (on, direction) = if let Some(period) = body.strip_prefix("every ") {
        (format!("sin(2*pi*t/({}))", period.trim()), direction.unwrap_or(default))
    } else {
        let Some((left, right)) = body.split_once('=') else {
            return Err("Write x = 0, rising; or every 2*pi/w; or event NAME.".to_owned());
        };
        let (left, right) = (left.trim(), right.trim());
        let difference = match right {
            "0" => left.to_owned(),
            _ if right.chars().all(|c| c.is_alphanumeric() || c == '.') => {
                format!("{left} - {right}")
            }
            _ => format!("{left} - ({right})"),
        };
        match turn(loaded, left) {
            None => (difference, direction.unwrap_or(default)),
            Some(_) if direction.is_some_and(|direction| direction != "either") => {
                return Err(format!(
                    "{left} is an angle, whose crossings count in either direction; cos(…) = 0 has one."
                ));
            }
            Some(turn) => (format!("sin(({difference})/{turn})"), "either"),
        }
    };
    let mut pool = loaded.equations.pool.clone();
    let mut scope = Scope::new(model, Allowed::Event, "a section");
    if scope.read(&mut pool, &on).is_none() {
        let what = scope.diagnostics.first().map(ToString::to_string);
        return Err(format!("{}.", what.unwrap_or_else(|| "it cannot be read".to_owned())));
    }
    Ok(NewSurface { on: Some(NewZero::Of(on)), axes: None, direction: Some(direction) })
}

/// What an angle is divided by so that its sine vanishes once in a turn, in the syntax of files; nothing if this is not a
/// coordinate with a period.
fn turn(loaded: &Loaded, name: &str) -> Option<String> {
    let model = &loaded.model;
    let named = |c: &&crate::model::Coordinate| c.name == name || c.shown == name;
    let period = model.coordinates.iter().find(named)?.period?;
    let text = model.pool.text(period);
    Some(if text == "2*pi" { "2".to_owned() } else { format!("({text}/pi)") })
}

impl Lab {
    /// The quantities of a new section: those of the plot that it replaces, or a coordinate that the surface does not hold and
    /// its rate.
    fn axes_of_section(&self, shown: &Plot, typed: &str) -> Result<[String; 2], String> {
        let channels = self.loaded.system.channels();
        let is_own = |kind: ChannelKind| {
            matches!(
                kind,
                ChannelKind::Position(_) | ChannelKind::Velocity(_) | ChannelKind::Momentum(_)
            )
        };
        let named = |axis: usize| {
            let channel = channels.get(shown.column(axis)?)?;
            is_own(channel.kind).then(|| channel.name.clone())
        };
        if let (Some(x), Some(y)) = (named(0), named(1))
            && x != y
            && !self.holds_an_axis(shown, typed)
        {
            return Ok([x, y]);
        }
        self.free_axes(typed)
    }

    /// The coordinate that a surface holds, if it is typed as one.
    fn fixed(&self, typed: &str) -> Option<usize> {
        let (left, _) = typed.split_once('=')?;
        let coordinates = &self.loaded.model.coordinates;
        coordinates.iter().position(|c| [&c.name[..], &c.shown[..]].contains(&left.trim()))
    }

    /// Whether a surface holds the coordinate of an axis.
    fn holds_an_axis(&self, shown: &Plot, typed: &str) -> bool {
        let channels = self.loaded.system.channels();
        let fixed = self.fixed(typed).map(ChannelKind::Position);
        let kind = |axis: usize| Some(channels.get(shown.column(axis)?)?.kind);
        fixed.is_some() && (kind(0) == fixed || kind(1) == fixed)
    }

    /// A coordinate that a surface does not hold, and its rate.
    fn free_axes(&self, typed: &str) -> Result<[String; 2], String> {
        let channels = self.loaded.system.channels();
        let coordinates = &self.loaded.model.coordinates;
        let fixed = self.fixed(typed);
        let free = (0..coordinates.len()).find(|&i| Some(i) != fixed).unwrap_or(0);
        let of = |kind| channels.iter().find(|c| c.kind == kind).map(|c| c.name.clone());
        let rate = of(ChannelKind::Momentum(free)).or_else(|| of(ChannelKind::Velocity(free)));
        // the variables of a Poisson system have no rates of their own
        let other = (0..coordinates.len()).find(|&i| i != free);
        let rate = rate.or_else(|| of(ChannelKind::Position(other?)));
        let pair = of(ChannelKind::Position(free)).zip(rate);
        pair.map(|(x, y)| [x, y]).ok_or_else(|| "There are no two quantities to show.".to_owned())
    }
}
