//! A session as it can be kept and gone on with: which system, how it is looked at, and where its motion is.
//!
//! In: the application. Out: plain data by names, and the application as it was. Never here: the file it is kept in.
//!
//! A system that was rebuilt from a changed file is taken up the same way: what has a name here and there stays.

use serde::{Deserialize, Serialize};

use super::{
    App, CameraPose, Effect, Lab, Loaded, Overlay, Page, Pane, Plot, Selection, SheetState,
    SourceBuffer, Viewport,
};
use crate::experiment::{Checkpoint, Command};

/// A session.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Saved {
    /// The version of this form, [`Saved::VERSION`].
    pub version: u32,
    /// The program that wrote it.
    pub phaselab: String,
    /// The preset's name or the file's path.
    pub open: String,
    /// The page that was shown.
    pub page: Page,
    /// The pane that keys went to.
    pub focus: Pane,
    /// Whether it filled the page.
    pub zoomed: bool,
    /// The selected lines.
    pub selection: Selection,
    /// Whether the system was not the file's but that of a text that is not saved.
    #[serde(default)]
    pub edited: bool,
    /// The pictures.
    pub plots: Vec<SavedPlot>,
    /// The motion.
    pub moment: Checkpoint,
}

/// A picture by the names of what it shows.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(tag = "kind", rename_all = "lowercase")]
pub enum SavedPlot {
    /// The motion in space.
    Space {
        /// Where it is seen from.
        eye: CameraPose,
    },
    /// One quantity against another.
    Phase {
        /// Across.
        x: Quantity,
        /// Upwards.
        y: Quantity,
        /// How it is looked at.
        viewport: Viewport,
    },
    /// The potential of a view of the file.
    Potential {
        /// Its place among the views.
        view: usize,
        /// How it is looked at.
        viewport: Viewport,
    },
    /// Quantities against time.
    Time {
        /// Upwards.
        y: Vec<Quantity>,
        /// How it is looked at.
        viewport: Viewport,
    },
}

/// A channel by its name, and by its place where it has none.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Quantity {
    name: String,
    place: usize,
}

impl Saved {
    /// The version of this form that this program writes and reads.
    pub const VERSION: u32 = 1;

    /// The session of a lab on a page; `None` before its motion was seen.
    fn of(lab: &Lab, page: Page) -> Option<Self> {
        let Loaded { name, model, system, .. } = &lab.loaded;
        let moment = match &lab.awaited {
            Some(moment) => moment.clone(),
            None => Checkpoint::of(model, system, lab.seen()?),
        };
        Some(Self {
            version: Self::VERSION,
            phaselab: env!("CARGO_PKG_VERSION").to_owned(),
            open: name.clone(),
            page,
            focus: lab.focus,
            zoomed: lab.zoomed,
            selection: lab.selection,
            edited: false,
            plots: lab.plots.iter().map(|plot| SavedPlot::of(plot, &lab.loaded)).collect(),
            moment,
        })
    }
}

impl SavedPlot {
    fn of(plot: &Plot, loaded: &Loaded) -> Self {
        let quantity = |&place: &usize| {
            let channel = loaded.system.channels().get(place);
            Quantity { name: channel.map_or_else(String::new, |c| c.name.clone()), place }
        };
        match plot {
            Plot::Space(eye) => Self::Space { eye: *eye },
            Plot::Phase { x, y, viewport } => {
                Self::Phase { x: quantity(x), y: quantity(y), viewport: *viewport }
            }
            Plot::Potential { view, viewport } => {
                Self::Potential { view: *view, viewport: *viewport }
            }
            Plot::Time { y, viewport } => {
                Self::Time { y: y.iter().map(quantity).collect(), viewport: *viewport }
            }
        }
    }

    /// The picture in a system, if that has all it shows.
    fn place(&self, loaded: &Loaded) -> Option<Plot> {
        let (model, channels) = (&loaded.model, loaded.system.channels());
        let channel = |quantity: &Quantity| {
            let named = |c: &crate::system::Channel| c.name == quantity.name;
            match quantity.name.as_str() {
                "" => Some(quantity.place).filter(|&i| channels.get(i).is_some_and(named)),
                _ => channels.iter().position(named),
            }
        };
        Some(match self {
            Self::Space { eye } => {
                let framed = eye.frame.is_none_or(|frame| frame < model.frames.len());
                let viewed = eye.view.is_none_or(|view| view < model.views.len());
                if !(framed && viewed) || eye.shapes(model).is_empty() {
                    return None;
                }
                Plot::Space(*eye)
            }
            Self::Phase { x, y, viewport } => {
                Plot::Phase { x: channel(x)?, y: channel(y)?, viewport: *viewport }
            }
            Self::Potential { view, viewport } => {
                let kind = model.views.get(*view)?.kind;
                let potential = kind == crate::model::ViewKind::Potential;
                potential.then_some(Plot::Potential { view: *view, viewport: *viewport })?
            }
            Self::Time { y, viewport } => {
                let y: Vec<usize> = y.iter().filter_map(channel).collect();
                (!y.is_empty()).then_some(Plot::Time { y, viewport: *viewport })?
            }
        })
    }
}

impl Lab {
    /// Looks at the system as a session did, as far as it is the same.
    fn look_as(&mut self, saved: &Saved) {
        let plots: Vec<Plot> =
            saved.plots.iter().filter_map(|plot| plot.place(&self.loaded)).collect();
        // pictures of a system with other quantities are better opened anew
        if plots.len() == saved.plots.len() {
            self.plots = plots;
        }
        if self.panes().any(|pane| pane == saved.focus) {
            (self.focus, self.zoomed) = (saved.focus, saved.zoomed);
        }
        self.selection = saved.selection;
        self.select(|place| place);
    }
}

impl App {
    /// The session to be kept, once a system moves in the lab.
    pub fn saved(&self) -> Option<Saved> {
        if self.page == Page::Picker {
            return self.left.clone();
        }
        let lab = self.lab.as_ref()?;
        let runs = |buffer: &SourceBuffer| buffer.is_modified() && buffer.state != SheetState::Left;
        let edited = self.own_buffer().is_some_and(runs);
        Some(Saved { edited, ..Saved::of(lab, self.page)? })
    }

    /// Goes on with a session as soon as its system is loaded.
    pub fn resume(&mut self, saved: Saved) {
        self.resuming = Some(saved);
    }

    /// The system that was asked for is there, to be opened or only previewed: goes on with the session that was left
    /// with it, or lets it move.
    pub(super) fn begin(&mut self, opened: bool) -> Vec<Effect> {
        let Some(lab) = &mut self.lab else { return Vec::new() };
        let saved = self.resuming.take().filter(|saved| saved.open == lab.loaded.name);
        let Some(saved) = saved else {
            if opened {
                self.remind();
            }
            return vec![Effect::Tell(Command::Play)];
        };
        lab.look_as(&saved);
        lab.awaited = Some(saved.moment);
        self.page = saved.page;
        self.remind();
        // the motion belongs to the text that is not saved, and waits until that is checked
        if saved.edited && self.wake() { Vec::new() } else { self.restore() }
    }

    /// Has the experiment take up the motion that is waited for, if there is one.
    pub(super) fn restore(&mut self) -> Vec<Effect> {
        let awaited = self.lab.as_ref().and_then(|lab| lab.awaited.clone());
        let command = |moment| Effect::Tell(Command::TakeUp(Box::new(moment)));
        awaited.map(command).into_iter().collect()
    }

    /// The system in the lab was built anew from a changed file: the motion goes on, and is looked at as before.
    pub(super) fn rebuilt(&mut self, loaded: Loaded) -> Vec<Effect> {
        let Some(old) = self.lab.take() else { return self.loaded(loaded) };
        let mut saved = Saved::of(&old, self.page);
        if let (Some(saved), None, Some(seen)) = (&mut saved, &old.awaited, old.seen()) {
            // what is drawn of the motion goes on too
            let moment = std::mem::take(&mut saved.moment);
            saved.moment = moment.with_past(&old.loaded.system, seen);
        }
        let mut lab = Lab::new(loaded);
        // A history speaks of values, channels, views and frames by their places.
        let places = |lab: &Lab| {
            let Loaded { model, system, .. } = &lab.loaded;
            let names = model.parameters.iter().map(|p| p.name.clone());
            let channels = system.channels().iter().map(|c| c.name.clone());
            let names: Vec<String> = names.chain(channels).collect();
            (names, model.views.len(), model.frames.len())
        };
        if places(&old) == places(&lab) {
            lab.history = old.history;
        }
        // What is open speaks of the old system's places.
        if matches!(self.overlay, Some(Overlay::Menu(_) | Overlay::Field(_))) {
            self.overlay = None;
        }
        self.meter.forget();
        let Some(saved) = saved else {
            self.lab = Some(lab);
            return vec![Effect::Tell(Command::Play)];
        };
        lab.look_as(&saved);
        lab.awaited = Some(saved.moment);
        self.lab = Some(lab);
        self.restore()
    }
}
