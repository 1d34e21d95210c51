//! The file as written: which tables and keys it has, what kind of value stands at each, and where.
//!
//! In: TOML with spans. Out: a [`Draft`], in which every text and number keeps its place and no
//! name has been looked up; an unknown key, a value of the wrong kind and a missing part of an
//! entry are mistakes. (serde would stop at the first of them; so the tables are walked here.)
//! Never here: expressions, what names mean, whether numbers make sense.

mod body;
mod claims;
mod constraint;
mod frame;
mod law;
mod occurrence;
mod picture;
mod run;
mod system;
mod table;
mod value;
mod vector;

use toml::Spanned;
use toml::de::DeTable;

use crate::diagnostic::Diagnostic;
use crate::diagnostic::Diagnostics;
use crate::diagnostic::SourceRange;
use crate::model::Info;

pub(super) use body::{DraftAttitude, DraftBody, DraftComparison, DraftPiece, DraftTurn};
pub(super) use claims::{
    DraftBracketClaim, DraftCount, DraftExpect, DraftObservable, DraftOccurrence, DraftValue,
};
pub(super) use constraint::DraftConstraint;
pub(super) use frame::DraftFrame;
pub(super) use law::{DraftBracket, DraftMechanics, Law};
pub(super) use occurrence::{DraftEvent, DraftImpulse};
pub(super) use picture::{DraftShape, DraftShapeKind, DraftView, DraftViewKind};
pub(super) use run::DraftRun;
pub(super) use system::{DraftCoordinate, DraftMoving, DraftParameter, NamedFormula};
pub(super) use table::Table;
pub(super) use value::kind;
pub(super) use vector::Formulas;

/// A text with its place, quotes included: an expression still to be read. A number of TOML is
/// kept as its digits.
pub(super) type Formula = Spanned<String>;

/// The file as written.
pub(super) struct Draft {
    /// What the file says of itself in words.
    pub(super) info: Info,
    /// The coordinates or variables.
    pub(super) moving: DraftMoving,
    /// The parameters in order.
    pub(super) parameters: Vec<DraftParameter>,
    /// The definitions in order, name and expression.
    pub(super) definitions: Vec<NamedFormula>,
    /// Every law of motion given; one is right.
    pub(super) mechanics: Vec<DraftMechanics>,
    /// What the motion is held to.
    pub(super) constraints: Vec<DraftConstraint>,
    /// Impulses.
    pub(super) impulses: Vec<DraftImpulse>,
    /// Crossings to be located.
    pub(super) events: Vec<DraftEvent>,
    /// A body put together from pieces.
    pub(super) body: Option<DraftBody>,
    /// How it stands.
    pub(super) attitude: Option<DraftAttitude>,
    /// The wrong mechanics beside the right.
    pub(super) comparison: Option<DraftComparison>,
    /// What is to be watched.
    pub(super) observables: Vec<DraftObservable>,
    /// What the file claims.
    pub(super) expect: DraftExpect,
    /// Frames a picture may be seen from.
    pub(super) frames: Vec<DraftFrame>,
    /// What the screen opens with.
    pub(super) views: Vec<DraftView>,
    /// The picture in space.
    pub(super) shapes: Vec<DraftShape>,
    /// How it is run.
    pub(super) run: DraftRun,
}

impl Draft {
    /// The law of motion, as far as it is given.
    pub(super) fn law(&self) -> Option<Law> {
        self.mechanics.first().map(|given| given.law)
    }
}

/// What the format has and this version does not.
const NOT_YET: [&str; 3] = ["transformations", "generators", "hamilton_jacobi"];

/// The keys of the file's first level: where a stray key may have been meant to stand.
const TOP_LEVEL: [&str; 6] = ["title", "summary", "source", "chapter", "topics", "notes"];

/// Walks the whole file.
pub(super) fn read(file: &Spanned<DeTable<'_>>, mistakes: &mut Diagnostics) -> Draft {
    let mut top = Table::new("the file", 0..0, file.get_ref());
    let info = read_info(&mut top, mistakes);
    for table in NOT_YET {
        if let Some((key, _)) = top.take(table) {
            let message = format!("the table `{table}` is not supported yet by this version");
            mistakes.push(Diagnostic::error(key, message));
        }
    }
    let draft = Draft {
        info,
        moving: system::moving(&mut top, mistakes),
        parameters: system::parameters(&mut top, mistakes),
        definitions: system::definitions(&mut top, mistakes),
        mechanics: law::mechanics(&mut top, mistakes),
        constraints: constraint::constraints(&mut top, mistakes),
        impulses: occurrence::impulses(&mut top, mistakes),
        events: occurrence::events(&mut top, mistakes),
        body: body::body(&mut top, mistakes),
        attitude: body::attitude(&mut top, mistakes),
        comparison: body::comparison(&mut top, mistakes),
        observables: claims::observables(&mut top, mistakes),
        expect: claims::expect(&mut top, mistakes),
        frames: frame::frames(&mut top, mistakes),
        views: picture::views(&mut top, mistakes),
        shapes: picture::shapes(&mut top, mistakes),
        run: run::read(&mut top, mistakes),
    };
    top.finish(mistakes);
    draft
}

/// The words at the head of the file alone: what a list of presets shows. Mistakes are passed over.
pub(super) fn read_head(file: &Spanned<DeTable<'_>>) -> Info {
    let mut top = Table::new("the file", 0..0, file.get_ref());
    read_info(&mut top, &mut Diagnostics::default())
}

fn read_info(top: &mut Table<'_>, mistakes: &mut Diagnostics) -> Info {
    let line = |found: Option<Spanned<String>>, mistakes: &mut Diagnostics| match found {
        Some(text) => value::one_line(&text, mistakes).unwrap_or_default(),
        None => String::new(),
    };
    let title = top.text("title", mistakes);
    if let Some(blank) = title.as_ref().filter(|t| t.get_ref().trim().is_empty()) {
        mistakes.push(Diagnostic::error(blank.span(), "the title is empty"));
    }
    if title.is_none() && !top.has("title") {
        let missing = Diagnostic::error(0..0, "the file has no title");
        top.lacks("title", missing.with_help("begin it with title = \"...\""));
    }
    let notes = top.text("notes", mistakes);
    Info {
        title: line(title, mistakes),
        summary: line(top.text("summary", mistakes), mistakes),
        source: line(top.text("source", mistakes), mistakes),
        chapter: line(top.text("chapter", mistakes), mistakes),
        topics: top
            .list("topics", mistakes)
            .iter()
            .filter_map(|item| {
                let topic = value::text(item, "a topic", mistakes)?;
                value::one_line(&topic, mistakes)
            })
            .collect(),
        notes: notes.and_then(|text| value::lines(&text, mistakes)).unwrap_or_default(),
    }
}
