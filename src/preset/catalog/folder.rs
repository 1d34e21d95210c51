//! The user's folder: the preset files in it, within limits.
//!
//! In: a folder. Out: paths in a deterministic order. A link to a folder is followed only to its files, so that no
//! link leads into a cycle or across the whole disk. Never here: what is in the files.

use std::path::{Path, PathBuf};

use super::is_preset;

/// The greatest depth of folders; the notes have three levels of headings.
const DEEPEST: usize = 8;

/// The greatest number of names visited; a user has far fewer presets.
pub(super) const MOST: usize = 4096;

#[derive(Default)]
pub(super) struct FolderContents {
    pub(super) files: Vec<PathBuf>,
    /// Whether the limits were exceeded.
    pub(super) cut: bool,
    visited: usize,
}

/// The presets in a folder and its subfolders.
pub(super) fn presets(folder: &Path) -> FolderContents {
    let mut found = FolderContents::default();
    found.enter(folder, DEEPEST);
    found
}

impl FolderContents {
    fn enter(&mut self, folder: &Path, deep: usize) {
        let Ok(listing) = std::fs::read_dir(folder) else { return };
        let mut paths = Vec::new();
        for entry in listing.flatten() {
            self.visited += 1;
            if self.visited > MOST {
                self.cut = true;
                break;
            }
            paths.push(entry.path());
        }
        paths.sort();
        for path in paths {
            if path.is_dir() {
                match deep {
                    0 => self.cut = true,
                    _ if path.is_symlink() => self.enter(&path, 0),
                    _ => self.enter(&path, deep - 1),
                }
            } else if is_preset(&path) && path.is_file() {
                self.files.push(path);
            }
        }
    }
}

#[cfg(all(test, unix))]
mod tests {
    use std::fs;
    use std::os::unix::fs::symlink;

    use super::*;

    /// The names of the presets, relative to the folder.
    fn names(folder: &Path) -> (Vec<String>, bool) {
        let found = presets(folder);
        let name = |path: &PathBuf| {
            path.strip_prefix(folder).expect("inside").to_string_lossy().into_owned()
        };
        (found.files.iter().map(name).collect(), found.cut)
    }

    #[test]
    fn a_link_leads_into_one_folder_and_not_in_a_circle() {
        let folder = tempfile::tempdir().expect("a folder");
        let other = tempfile::tempdir().expect("a folder");
        let (folder, other) = (folder.path(), other.path());
        for path in [folder.join("a.toml"), folder.join("b.txt"), other.join("c.toml")] {
            fs::write(path, "").expect("written");
        }
        fs::create_dir(other.join("deep")).expect("made");
        fs::write(other.join("deep/d.toml"), "").expect("written");
        symlink(other, folder.join("linked")).expect("a link");
        symlink(folder, other.join("back")).expect("a link");
        symlink(other.join("c.toml"), folder.join("own.toml")).expect("a link");
        let (found, _) = names(folder);
        assert_eq!(found, ["a.toml", "linked/c.toml", "own.toml"]);
    }

    #[test]
    fn depth_and_number_have_limits() {
        let folder = tempfile::tempdir().expect("a folder");
        let mut deep = folder.path().to_owned();
        for level in 0..=DEEPEST + 1 {
            fs::write(deep.join(format!("{level}.toml")), "").expect("written");
            deep.push("x");
            fs::create_dir(&deep).expect("made");
        }
        let (found, cut) = names(folder.path());
        assert_eq!((found.len(), cut), (DEEPEST + 1, true));

        let folder = tempfile::tempdir().expect("a folder");
        for number in 0..MOST {
            fs::write(folder.path().join(number.to_string()), "").expect("written");
        }
        assert!(!presets(folder.path()).cut);
        fs::write(folder.path().join("more"), "").expect("written");
        assert!(presets(folder.path()).cut);
    }
}
