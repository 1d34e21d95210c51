//! The presets that are part of the program: their heads by a table made at build time, their texts as they are
//! embedded.
//!
//! In: the folder `presets/` at build time. Out: heads and texts by path. Never here: parsing, which naming and
//! opening presets do without.

use include_dir::{Dir, include_dir};

static FOLDER: Dir<'static> = include_dir!("$CARGO_MANIFEST_DIR/presets");

#[derive(Clone, Copy, Debug)]
pub(super) struct Listed {
    /// Its path below `presets/`.
    pub(super) path: &'static str,
    pub(super) title: &'static str,
    pub(super) summary: &'static str,
    pub(super) source: &'static str,
    pub(super) chapter: &'static str,
    pub(super) topics: &'static [&'static str],
}

pub(super) const INDEX: &[Listed] = include!(concat!(env!("OUT_DIR"), "/catalog_index.rs"));

/// The text of an embedded file, by its path below `presets/`.
pub(super) fn text(path: &str) -> Option<&'static str> {
    FOLDER.get_file(path)?.contents_utf8()
}

/// The names of the files in a folder below `presets/`, without their extensions.
pub(super) fn names_in(folder: &str) -> impl Iterator<Item = &'static str> {
    let files = FOLDER.get_dir(folder).map(Dir::files).into_iter().flatten();
    files.filter_map(|file| file.path().file_stem()?.to_str())
}
