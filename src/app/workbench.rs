//! The workbench: the loaded system's file being edited while the system runs.
//!
//! In: keys, time, and what became of checks, of saving and of the file on disk. Out: the text, its mistakes in their
//! places, and what is to be checked or saved. Never here: files, threads, how it is drawn.
//!
//! A text is checked when typing rests, one check at a time, and where it is right the lab is built anew from it. A
//! file changed by another program takes the same way.

use std::path::PathBuf;
use std::time::Duration;

use tui_input::Input;

use super::editor::{Caret, Editor};
use super::field::{edit, paste};
use super::{App, Effect, Key, Lab, Loaded, Notice, Over, Page};
use crate::preset::{Mistake, Origin, Severity, TEXT_LIMIT, is_path};

/// For how long typing rests before the text is checked.
const REST: Duration = Duration::from_millis(150);

/// For how long a file found wrong is left to the program that is perhaps still writing it.
const PATIENCE: Duration = Duration::from_millis(700);

/// A file being edited.
#[derive(Clone, Debug)]
pub struct Workbench {
    /// What was asked for when the system was loaded.
    pub name: String,
    /// What reports call it.
    pub title: String,
    /// The file it is saved to; a shipped preset has none until its copy has a name.
    pub place: Option<PathBuf>,
    /// The text.
    pub editor: Editor,
    /// What was wrong with it when it was last checked, in order.
    pub flaws: Vec<Flaw>,
    /// What is known of the text.
    pub state: State,
    /// What is being asked for below the text.
    pub asking: Option<Asking>,
    /// The first row and column shown.
    pub scroll: (usize, usize),
    /// The text as the file has it.
    on_disk: String,
    /// Counts the texts.
    revision: u64,
    /// The text that is being checked.
    checking: Option<u64>,
    /// The time left until the text is checked.
    rest: Option<Duration>,
    /// A wrong text that just came from the file may be half of one, and is looked at once more.
    half: bool,
    /// Another program has changed the file, and the next saving writes over it all the same.
    overrule: bool,
    sought: String,
}

/// A mistake in its place in the text.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Flaw {
    /// Where it begins.
    pub from: Caret,
    /// Where it ends, on the same line.
    pub to: Caret,
    /// Whether the text can still be used.
    pub warning: bool,
    /// What is wrong.
    pub message: String,
    /// What would be right.
    pub help: Option<String>,
}

/// What is known of a text.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum State {
    /// It is the one that runs, and was built in so much time where that is known.
    Runs(Option<Duration>),
    /// It has changed and was not checked yet.
    Changed,
    /// It has mistakes; the last right one runs.
    Wrong,
}

/// Something asked for.
#[derive(Clone, Debug)]
pub enum Asking {
    /// Words to look for.
    Words(Input),
    /// The name of a copy.
    Name(Input),
}

/// A text that was asked to be checked: what became of it.
#[derive(Clone, Debug)]
pub struct Checked {
    /// Which text.
    pub revision: u64,
    /// The system it makes, running already, or its mistakes.
    pub outcome: Result<Loaded, Vec<Mistake>>,
    /// How long that took.
    pub took: Duration,
}

/// Why a text was not saved.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum NotSaved {
    /// The file is not what it was when it was read.
    Changed,
    /// There is a file of that name already.
    Exists(PathBuf),
    /// Anything else, a sentence.
    Refused(String),
}

impl Workbench {
    /// The file of a system, `place` being where it stands if that can be written to.
    fn new(loaded: &Loaded, place: Option<PathBuf>) -> Self {
        let text = &loaded.document.text;
        Self {
            name: loaded.name.clone(),
            title: loaded.document.path.clone(),
            place,
            editor: Editor::new(text, TEXT_LIMIT),
            flaws: Vec::new(),
            state: State::Runs(None),
            asking: None,
            scroll: (0, 0),
            on_disk: text.clone(),
            revision: 0,
            checking: None,
            rest: None,
            half: false,
            overrule: false,
            sought: String::new(),
        }
    }

    /// Whether the text is not the file's.
    pub fn is_modified(&self) -> bool {
        self.editor.text() != self.on_disk
    }

    /// The file's text as it was last read or written.
    pub(super) fn on_disk(&self) -> &str {
        &self.on_disk
    }

    /// The mistake that the cursor stands on or before, else the first.
    pub fn flaw(&self) -> Option<&Flaw> {
        let cursor = self.editor.cursor();
        let on_line = self.flaws.iter().find(|flaw| flaw.from.row == cursor.row);
        let after = self.flaws.iter().find(|flaw| flaw.to >= cursor);
        let at = self.flaws.iter().find(|flaw| flaw.from <= cursor && cursor <= flaw.to);
        at.or(on_line).or(after).or(self.flaws.first())
    }

    /// The first row and column to show, so that the cursor is among so many of them.
    pub fn follow(&self, rows: usize, columns: usize) -> (usize, usize) {
        let cursor = self.editor.cursor();
        let within = |first: usize, at: usize, count: usize| {
            let last = first + count.saturating_sub(1);
            if count == 0 || (first..=last).contains(&at) {
                first
            } else if at < first {
                at.saturating_sub(count / 4)
            } else {
                (at + 1 + count / 4).saturating_sub(count)
            }
        };
        // the line as far as the cursor need not be moved where it fits from its beginning
        let start = if cursor.column < columns { 0 } else { self.scroll.1 };
        (within(self.scroll.0, cursor.row, rows), within(start, cursor.column, columns))
    }

    /// The text has changed.
    fn touch(&mut self) {
        self.revision += 1;
        self.rest = Some(REST);
        self.half = false;
        self.state = State::Changed;
    }

    /// Time has passed: the text to be checked now, if there is one.
    fn tick(&mut self, elapsed: Duration) -> Option<Effect> {
        self.rest = self.rest.map(|rest| rest.saturating_sub(elapsed));
        if self.checking.is_some() || self.rest != Some(Duration::ZERO) {
            return None;
        }
        (self.rest, self.checking) = (None, Some(self.revision));
        let (title, text) = (self.title.clone(), self.editor.text());
        Some(Effect::Check { revision: self.revision, title, text })
    }

    fn press(&mut self, key: Key, page: usize) {
        match &mut self.asking {
            Some(Asking::Words(input) | Asking::Name(input)) => {
                edit(input, key);
            }
            None => {
                if self.editor.press(key, page) {
                    self.touch();
                }
            }
        }
    }

    /// Takes mistakes in, each where it stands.
    fn note(&mut self, mistakes: &[Mistake]) {
        let flaw = |mistake: &Mistake| {
            let from = self.editor.spot(mistake.place.start);
            let end = self.editor.spot(mistake.place.end);
            let length = self.editor.lines()[from.row].chars().count();
            let column = if end.row == from.row { end.column } else { length };
            Flaw {
                from,
                to: Caret { row: from.row, column: column.max(from.column) },
                warning: mistake.severity == Severity::Warning,
                message: mistake.message.clone(),
                help: mistake.help.clone(),
            }
        };
        self.flaws = mistakes.iter().map(flaw).collect();
    }

    /// To the next mistake (+1) or the one before (−1); whether there is one.
    fn step(&mut self, sign: i8) -> bool {
        let cursor = self.editor.cursor();
        let mut places = self.flaws.iter().map(|flaw| flaw.from);
        let to = if sign > 0 {
            places.clone().find(|place| *place > cursor).or(places.next())
        } else {
            places.clone().rfind(|place| *place < cursor).or(places.next_back())
        };
        to.inspect(|to| self.editor.go(*to)).is_some()
    }
}

impl App {
    /// The workbench, if it lies open.
    pub fn open_workbench(&self) -> Option<&Workbench> {
        self.workbench.as_deref().filter(|_| matches!(self.over, Some(Over::Workbench)))
    }

    fn bench(&mut self) -> Option<&mut Workbench> {
        self.workbench.as_deref_mut()
    }

    /// The file of the loaded system, where it has one of its own.
    pub fn file(&self) -> Option<PathBuf> {
        let name = &self.lab.as_ref()?.loaded.name;
        if is_path(name) {
            return Some(PathBuf::from(name));
        }
        let entry = self.picker.entries.iter().find(|entry| entry.name == *name)?;
        match &entry.origin {
            Origin::User(path) => Some(path.clone()),
            Origin::Shipped => None,
        }
    }

    /// A line on what is wrong with the file while its editor is closed.
    pub fn banner(&self) -> Option<String> {
        let bench = self.workbench.as_deref().filter(|_| self.over.is_none())?;
        let here = self.lab.as_ref().is_some_and(|lab| lab.loaded.name == bench.name);
        let flaw = bench.flaws.first().filter(|_| here && bench.state == State::Wrong)?;
        let (row, column) = (flaw.from.row + 1, flaw.from.column + 1);
        Some(format!("{}:{row}:{column}: {}; what was right goes on", bench.title, flaw.message))
    }

    /// Whether the answer to a check is still wanted.
    pub fn awaits(&self, revision: u64) -> bool {
        let bench = self.workbench.as_deref().filter(|bench| bench.checking == Some(revision));
        let name = self.lab.as_ref().map(|lab| &lab.loaded.name);
        bench.is_some_and(|bench| Some(&bench.name) == name)
    }

    /// Opens the file of the loaded system.
    pub(super) fn edit_file(&mut self) -> Vec<Effect> {
        if self.ready_bench().is_some() {
            self.over = Some(Over::Workbench);
        }
        Vec::new()
    }

    /// The workbench with the file of the loaded system, as it was left.
    fn ready_bench(&mut self) -> Option<&mut Workbench> {
        let place = self.file();
        let loaded = &self.lab.as_ref()?.loaded;
        if self.workbench.as_ref().is_none_or(|bench| bench.name != loaded.name) {
            // what is not saved of another system is kept until that is edited again
            let other = self.workbench.take().filter(|bench| bench.is_modified());
            self.drafts.extend(other.map(|bench| *bench));
            let left = self.drafts.iter().position(|bench| bench.name == loaded.name);
            let bench = left.map(|at| self.drafts.swap_remove(at));
            let bench = bench.unwrap_or_else(|| Workbench::new(loaded, place));
            self.workbench = Some(Box::new(bench));
        }
        let bench = self.workbench.as_deref_mut()?;
        if bench.state != State::Wrong && bench.editor.text() != loaded.document.text {
            // the system was loaded since, or its check was overtaken
            bench.checking = None;
            bench.touch();
        }
        Some(bench)
    }

    /// The title of a text that is not saved and that no session would keep.
    fn unkept(&self) -> Option<&str> {
        let here = self.lab.as_ref().filter(|_| self.page != Page::Picker);
        let kept = |bench: &&Workbench| here.is_some_and(|lab| lab.loaded.name == bench.name);
        let benches = self.workbench.as_deref().into_iter().chain(&self.drafts);
        benches.filter(|b| !kept(b)).find(|b| b.is_modified()).map(|bench| bench.title.as_str())
    }

    /// Ends the program; where a text would be lost only when asked twice.
    pub(super) fn quit(&mut self) -> Vec<Effect> {
        let Some(title) = self.unkept() else { return vec![Effect::Quit] };
        let told = format!("{title} has changes that are not saved; quit again to lose them.");
        if self.notice.as_ref().is_some_and(|notice| notice.text == told) {
            return vec![Effect::Quit];
        }
        self.say(told)
    }

    /// A text that was not saved when the last session ended.
    pub(super) fn take_draft(&mut self, text: &str, of: Option<&str>) {
        if let Some(bench) = self.ready_bench() {
            if let Some(of) = of {
                // what the file became since is noticed before it is written over
                of.clone_into(&mut bench.on_disk);
            }
            bench.editor.become_text(text);
            bench.touch();
            let told = format!("{} has changes that are not saved; E goes to them.", bench.title);
            self.notice = Some(Notice::info(told));
        }
    }

    /// A key that stands for itself.
    pub(super) fn type_at_bench(&mut self, key: Key) {
        let page = usize::from(self.drawn.rows).saturating_sub(1);
        if let Some(bench) = self.bench() {
            bench.press(key, page);
        }
    }

    /// Pasted text; whether all of it found room.
    pub(super) fn paste_at_bench(&mut self, text: &str) -> bool {
        let Some(bench) = self.bench() else { return true };
        match &mut bench.asking {
            Some(Asking::Words(input) | Asking::Name(input)) => paste(input, text),
            None => {
                let whole = bench.editor.paste(text);
                bench.touch();
                whole
            }
        }
    }

    /// Something done to the text as a whole.
    pub(super) fn work(&mut self, work: Work) -> Vec<Effect> {
        let Some(bench) = self.bench() else { return Vec::new() };
        let changed = match work {
            Work::Save => return self.save_file(),
            Work::Find => {
                bench.asking = Some(Asking::Words(Input::new(bench.sought.clone())));
                false
            }
            Work::FindNext => return self.find(),
            Work::Mistake(sign) => {
                if !bench.step(sign) {
                    return self.say("There is no mistake.");
                }
                false
            }
            Work::Cut => bench.editor.cut(),
            Work::Copy => {
                bench.editor.copy();
                self.notice = Some(Notice::info("Copied; Ctrl-v puts it in."));
                return Vec::new();
            }
            Work::PutBack => bench.editor.put_back(),
            Work::Undo => {
                if !bench.editor.undo() {
                    return self.say("There is nothing to take back.");
                }
                true
            }
            Work::Redo => {
                if !bench.editor.redo() {
                    return self.say("There is nothing to do again.");
                }
                true
            }
            Work::Reread => {
                let Some(place) = &bench.place else {
                    return self.say("A copy without a name has no file to be read.");
                };
                return vec![Effect::Reread(place.clone())];
            }
        };
        if changed && let Some(bench) = self.bench() {
            bench.touch();
        }
        Vec::new()
    }

    /// Esc: leaves what is asked for, else the workbench; the text stays.
    pub(super) fn leave_bench(&mut self) {
        match self.bench() {
            Some(bench) if bench.asking.is_some() => bench.asking = None,
            _ => {
                self.over = None;
                if let Some(bench) = self.bench().filter(|bench| bench.is_modified()) {
                    let text = format!("{} is not saved; E goes back to it.", bench.title);
                    self.notice = Some(Notice::info(text));
                }
            }
        }
    }

    /// Enter, where something is asked for.
    pub(super) fn accept_at_bench(&mut self) -> Vec<Effect> {
        let Some(bench) = self.bench() else { return Vec::new() };
        match bench.asking.take() {
            None => Vec::new(),
            Some(Asking::Words(input)) => {
                input.value().clone_into(&mut bench.sought);
                if bench.sought.is_empty() { Vec::new() } else { self.find() }
            }
            Some(Asking::Name(input)) => {
                let name = input.value().trim().to_owned();
                if name.is_empty() || name.ends_with('/') {
                    bench.asking = Some(Asking::Name(input));
                    return self.say("Give the copy a name, as my-pendulum or ./pendulum.toml.");
                }
                let text = bench.editor.text();
                vec![Effect::SaveCopy { name, text }]
            }
        }
    }

    fn find(&mut self) -> Vec<Effect> {
        let Some(bench) = self.bench() else { return Vec::new() };
        let sought = bench.sought.clone();
        if sought.is_empty() {
            bench.asking = Some(Asking::Words(Input::default()));
            return Vec::new();
        }
        if bench.editor.find(&sought) {
            return Vec::new();
        }
        self.say(format!("`{sought}` stands nowhere."))
    }

    fn save_file(&mut self) -> Vec<Effect> {
        let Some(bench) = self.bench() else { return Vec::new() };
        let text = bench.editor.text();
        match &bench.place {
            Some(place) => {
                let known = (!bench.overrule).then(|| bench.on_disk.clone());
                vec![Effect::Save { place: place.clone(), text, known }]
            }
            None => {
                let copy = format!("my-{}", bench.name);
                bench.asking = Some(Asking::Name(Input::new(copy)));
                Vec::new()
            }
        }
    }

    /// A text was saved, or was not.
    pub(super) fn saved_file(&mut self, outcome: Result<(PathBuf, String), NotSaved>) {
        let Some(bench) = self.workbench.as_deref_mut() else { return };
        bench.overrule = outcome == Err(NotSaved::Changed);
        self.notice = Some(match outcome {
            Ok((place, text)) => {
                let shown = place.display().to_string();
                bench.on_disk = text;
                if bench.place.as_ref() != Some(&place) {
                    // from now on the copy is what is open
                    let here = |lab: &&mut Lab| lab.loaded.name == bench.name;
                    let name = if is_path(&shown) { shown.clone() } else { format!("./{shown}") };
                    if let Some(lab) = self.lab.as_mut().filter(here) {
                        lab.loaded.name.clone_from(&name);
                    }
                    (bench.name, bench.title) = (name, shown.clone());
                    bench.place = Some(place);
                }
                Notice::info(format!("Saved: {shown}"))
            }
            Err(NotSaved::Changed) => Notice::error(format!(
                "{} was changed by another program: Ctrl-s again writes over it, Ctrl-o reads it.",
                bench.title
            )),
            Err(NotSaved::Exists(place)) => {
                bench.asking = Some(Asking::Name(Input::new(place.display().to_string())));
                Notice::error(format!("{} exists already; give another name.", place.display()))
            }
            Err(NotSaved::Refused(why)) => Notice::error(why),
        });
    }

    /// Another program has changed the file; `asked` says that it was read because the user wanted it.
    pub(super) fn changed_on_disk(&mut self, text: &str, asked: bool) {
        if asked && self.workbench.is_none() {
            return;
        }
        let Some(bench) = self.ready_bench() else { return };
        if bench.on_disk == text && !asked {
            return;
        }
        if bench.is_modified() && !asked {
            let told = format!(
                "{} was changed by another program; what stands here is not saved.",
                bench.title
            );
            self.notice = Some(Notice::error(told));
            return;
        }
        text.clone_into(&mut bench.on_disk);
        if bench.editor.text() != text {
            bench.editor.become_text(text);
            bench.touch();
            (bench.rest, bench.half) = (Some(Duration::ZERO), !asked);
        }
        bench.overrule = false;
    }

    /// Time has passed.
    pub(super) fn tick_bench(&mut self, elapsed: Duration) -> Option<Effect> {
        let name = self.lab.as_ref().map(|lab| lab.loaded.name.clone())?;
        self.bench().filter(|bench| bench.name == name)?.tick(elapsed)
    }

    /// The screen was drawn: the cursor is kept on it.
    pub(super) fn follow_cursor(&mut self) {
        let (rows, columns) = (self.drawn.rows.into(), self.drawn.columns.into());
        if matches!(self.over, Some(Over::Workbench))
            && let Some(bench) = self.bench()
        {
            bench.scroll = bench.follow(rows, columns);
        }
    }

    /// A text was checked, and where it was right its system runs already.
    pub(super) fn checked(&mut self, checked: Checked) -> Vec<Effect> {
        let Checked { revision, outcome, took } = checked;
        let Some(bench) = self.bench() else { return Vec::new() };
        bench.checking = None;
        let newest = bench.revision == revision;
        match outcome {
            Ok(loaded) => {
                if newest {
                    bench.flaws.clear();
                    bench.state = State::Runs(Some(took));
                }
                self.rebuilt(loaded)
            }
            // what was wrong with a text that has changed since is no longer so
            Err(_) if !newest => Vec::new(),
            Err(_) if bench.half => {
                (bench.half, bench.rest) = (false, Some(PATIENCE));
                Vec::new()
            }
            Err(mistakes) => {
                bench.note(&mistakes);
                bench.state = State::Wrong;
                Vec::new()
            }
        }
    }
}

/// What can be done to the text beside typing.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Work {
    /// Save it.
    Save,
    /// Look for words.
    Find,
    /// Look for them again.
    FindNext,
    /// To the next mistake (+1) or the one before (−1).
    Mistake(i8),
    /// Cut what is selected, or the line.
    Cut,
    /// Keep it without cutting it.
    Copy,
    /// Put in what was cut.
    PutBack,
    /// Take back the last change.
    Undo,
    /// Make it again.
    Redo,
    /// Read the file anew.
    Reread,
}
