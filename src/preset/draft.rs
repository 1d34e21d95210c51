//! The file as written: its tables and keys, the kinds of their values, and their ranges.
//!
//! In: TOML with spans. Out: a [`Draft`], in which every text and number has its range and no name
//! is resolved. An unknown key, a value of the wrong kind and a missing part of an entry are
//! errors. (serde would stop at the first of them, so the tables are walked here.) Never here:
//! expressions, the meaning of names, the validity of numbers.

mod body;
mod claims;
mod constraint;
mod equilibrium;
mod frame;
mod law;
mod occurrence;
mod picture;
mod run;
mod system;
mod table;
mod transformation;
mod value;
mod vector;

use toml::Spanned;
use toml::de::DeTable;

use super::schema::FILE;
use crate::diagnostic::Diagnostic;
use crate::diagnostic::Diagnostics;
use crate::model::Info;

pub(super) use body::{DraftAttitude, DraftBody, DraftComparison, DraftPiece, DraftTurn};
pub(super) use claims::{
    DraftBracketClaim, DraftCount, DraftExpect, DraftObservable, DraftOccurrence, DraftStep,
    DraftValue,
};
pub(super) use constraint::DraftConstraint;
pub(super) use equilibrium::DraftEquilibrium;
pub(super) use frame::DraftFrame;
pub(super) use law::{DraftBracket, DraftMechanics, LawTable};
pub(super) use occurrence::{DraftEvent, DraftImpulse};
pub(super) use picture::{
    DraftCamera, DraftFollow, DraftSection, DraftShape, DraftView, ShapeKind,
};
pub(super) use run::DraftRun;
pub(super) use system::{DraftCoordinate, DraftMoving, DraftParameter, DraftRamp, NamedFormula};
pub(super) use table::Table;
pub(super) use transformation::{DraftGenerator, DraftIntegral, DraftTransformation};
pub(super) use value::kind;
pub(super) use vector::Formulas;

/// An unparsed expression with its range, quotes included. A number of TOML is represented by its
/// digits.
pub(super) type Formula = Spanned<String>;

pub(super) struct Draft {
    /// The file's description of itself.
    pub(super) info: Info,
    /// The coordinates or variables.
    pub(super) moving: DraftMoving,
    /// The parameters in order.
    pub(super) parameters: Vec<DraftParameter>,
    /// The ramps in order.
    pub(super) ramps: Vec<DraftRamp>,
    /// The definitions in order, as name and expression.
    pub(super) definitions: Vec<NamedFormula>,
    /// Every law of motion given; exactly one is valid.
    pub(super) mechanics: Vec<DraftMechanics>,
    pub(super) constraints: Vec<DraftConstraint>,
    pub(super) impulses: Vec<DraftImpulse>,
    /// The events, crossings to be located.
    pub(super) events: Vec<DraftEvent>,
    pub(super) body: Option<DraftBody>,
    pub(super) attitude: Option<DraftAttitude>,
    pub(super) comparison: Option<DraftComparison>,
    pub(super) transformations: Vec<DraftTransformation>,
    pub(super) generators: Vec<DraftGenerator>,
    pub(super) equilibria: Vec<DraftEquilibrium>,
    pub(super) integral: Option<DraftIntegral>,
    pub(super) observables: Vec<DraftObservable>,
    pub(super) expect: DraftExpect,
    pub(super) frames: Vec<DraftFrame>,
    /// The views that the screen opens with.
    pub(super) views: Vec<DraftView>,
    pub(super) shapes: Vec<DraftShape>,
    pub(super) camera: DraftCamera,
    pub(super) run: DraftRun,
}

impl Draft {
    /// The law of motion, if one is given.
    pub(super) fn law(&self) -> Option<LawTable> {
        self.mechanics.first().map(|given| given.law)
    }
}

/// The top-level keys of the file, for suggesting where a stray key belongs.
const TOP_LEVEL: [&str; 6] = ["title", "summary", "source", "chapter", "topics", "notes"];

pub(super) fn read(file: &Spanned<DeTable<'_>>, diagnostics: &Diagnostics) -> Draft {
    let mut top = Table::new("the file", 0..0, file.get_ref(), diagnostics).with(&FILE);
    let info = read_info(&mut top);
    let (shapes, camera) = picture::space(&mut top);
    let draft = Draft {
        info,
        moving: system::moving(&mut top),
        parameters: system::parameters(&mut top),
        ramps: system::ramps(&mut top),
        definitions: system::definitions(&mut top),
        mechanics: law::mechanics(&mut top),
        constraints: constraint::constraints(&mut top),
        impulses: occurrence::impulses(&mut top),
        events: occurrence::events(&mut top),
        body: body::body(&mut top),
        attitude: body::attitude(&mut top),
        comparison: body::comparison(&mut top),
        transformations: transformation::transformations(&mut top),
        generators: transformation::generators(&mut top),
        equilibria: equilibrium::equilibria(&mut top),
        integral: transformation::integral(&mut top),
        observables: claims::observables(&mut top),
        expect: claims::expect(&mut top),
        frames: frame::frames(&mut top),
        views: picture::views(&mut top),
        shapes,
        camera,
        run: run::read(&mut top),
    };
    top.finish();
    draft
}

/// Reads only the head of the file, for a list of presets. Errors are ignored.
pub(super) fn read_head(file: &Spanned<DeTable<'_>>) -> Info {
    let ignored = Diagnostics::default();
    read_info(&mut Table::new("the file", 0..0, file.get_ref(), &ignored))
}

fn read_info(top: &mut Table<'_>) -> Info {
    let diagnostics = top.diagnostics;
    let title = top.text("title");
    if let Some(blank) = title.as_ref().filter(|t| t.get_ref().trim().is_empty()) {
        diagnostics.push(Diagnostic::error(blank.span(), "the title is empty"));
    }
    let notes = top.text("notes");
    Info {
        title: title.and_then(|text| value::one_line(&text, diagnostics)).unwrap_or_default(),
        summary: top.line("summary"),
        source: top.line("source"),
        chapter: top.line("chapter"),
        topics: top
            .list("topics")
            .iter()
            .filter_map(|item| {
                let topic = value::text(item, "a topic", diagnostics)?;
                value::one_line(&topic, diagnostics)
            })
            .collect(),
        notes: notes.and_then(|text| value::lines(&text, diagnostics)).unwrap_or_default(),
    }
}
