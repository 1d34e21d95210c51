//! The catalog: shipped presets, the user's own before them, and the lookup of a text by name.

use std::fs;
use std::path::Path;

use phaselab::model::Info;
use phaselab::preset::{self, Catalog, CatalogEntry, NotFound, PresetOrigin};
use tempfile::TempDir;

use super::GOOD;
use crate::nonempty;

/// A user's folder with these files.
fn folder(files: &[(&str, &[u8])]) -> TempDir {
    let folder = tempfile::tempdir().unwrap();
    for (path, content) in files {
        let path = folder.path().join(path);
        fs::create_dir_all(path.parent().unwrap()).unwrap();
        fs::write(path, content).unwrap();
    }
    folder
}

#[test]
fn shipped_presets_are_those_of_the_folder() {
    fn count(folder: &Path) -> usize {
        let entries = fs::read_dir(folder).unwrap().map(|e| e.unwrap().path());
        let is_preset = |p: &Path| p.extension().is_some_and(|extension| extension == "toml");
        entries.map(|p| if p.is_dir() { count(&p) } else { is_preset(&p).into() }).sum()
    }
    let catalog = Catalog::with_folder(None);
    let presets = Path::new(env!("CARGO_MANIFEST_DIR")).join("presets");
    assert_eq!(catalog.entries().len(), count(&presets));
    let pendulum = catalog.find("pendulum").unwrap();
    assert_eq!(pendulum.path, "presets/pendulums/pendulum.toml");
    let on_disk = fs::read_to_string(presets.join("pendulums/pendulum.toml")).unwrap();
    assert_eq!(pendulum.text, on_disk);
}

#[test]
fn the_index_says_what_the_files_say() {
    for entry in nonempty(Catalog::with_folder(None).entries()) {
        let document = entry.document().unwrap();
        let info =
            document.read().unwrap_or_else(|why| panic!("{}: {why:?}", entry.name)).model.info;
        assert_eq!(entry.info, Info { notes: String::new(), ..info }, "{}", entry.name);
        assert!(!entry.info.title.is_empty() && entry.info.notes.is_empty());
        assert!(document.path.ends_with(&format!("/{}.toml", entry.name)), "{}", document.path);
    }
}

#[test]
fn a_name_finds_the_same_with_and_without_the_list() {
    let user = folder(&[
        ("pendulum.toml", GOOD.as_bytes()),
        ("mine.toml", GOOD.as_bytes()),
        ("a/twice.toml", GOOD.as_bytes()),
        ("b/twice.toml", GOOD.replace("Oscillator", "Another").as_bytes()),
        ("broken.toml", b"title = "),
    ]);
    let listed = Catalog::with_folder(Some(user.path()));
    let shipped = Catalog::with_folder(None);
    let names =
        ["pendulum", "mine", "twice", "broken", "heavy-top", "heavy-topp", "nothing at all"];
    let path = user.path().join("mine.toml");
    for name in names.into_iter().chain([path.to_str().unwrap(), "no/such.toml"]) {
        for (catalog, folder) in [(&listed, Some(user.path())), (&shipped, None)] {
            let (found, expected) =
                (preset::find_beside(folder, name.as_ref()), catalog.find(name));
            match (found, expected) {
                (Ok(found), Ok(expected)) => {
                    assert_eq!((found.path, found.text), (expected.path, expected.text), "{name}");
                }
                (Err(found), Err(expected)) => {
                    assert_eq!(found.to_string(), expected.to_string(), "{name}");
                }
                (found, expected) => panic!("{name}: {found:?}, {expected:?}"),
            }
        }
    }
}

#[test]
fn the_list_goes_by_topic_and_chapter() {
    let preset = |topic: &str, chapter: &str, title: &str| {
        format!("chapter = \"{chapter}\"\ntopics = [\"{topic}\"]\n{GOOD}")
            .replace("Oscillator", title)
    };
    let user = folder(&[
        ("a.toml", preset("zeta", "0.0.10", "ten").as_bytes()),
        ("b.toml", preset("zeta", "0.0.9", "nine").as_bytes()),
        ("c.toml", preset("alpha", "", "last of all").as_bytes()),
        ("d.toml", preset("zeta", "", "unplaced").as_bytes()),
        ("e.toml", preset("zeta", "0.0.9", "another nine").as_bytes()),
    ]);
    let catalog = Catalog::with_folder(Some(user.path()));
    let titles: Vec<&str> = catalog
        .entries()
        .iter()
        .filter(|entry| entry.origin != PresetOrigin::Shipped)
        .map(|entry| entry.info.title.as_str())
        .collect();
    assert_eq!(titles, ["another nine", "nine", "ten", "unplaced", "last of all"]);
    let first = &catalog.entries()[0];
    assert_eq!((first.topic(), first.name.as_str()), ("zeta", "e"));
    // a topic is contiguous
    let mut topics: Vec<&str> = catalog.entries().iter().map(CatalogEntry::topic).collect();
    topics.dedup();
    let mut once = topics.clone();
    once.sort_unstable();
    once.dedup();
    assert_eq!(once.len(), topics.len(), "{topics:?}");
}

#[test]
fn the_users_own_win_over_shipped_ones() {
    let user = folder(&[("deep/er/pendulum.toml", GOOD.as_bytes()), ("notes.txt", b"no preset")]);
    let catalog = Catalog::with_folder(Some(user.path()));
    assert_eq!(catalog.entries().len(), Catalog::with_folder(None).entries().len());
    let document = catalog.find("pendulum").unwrap();
    assert_eq!(document.text, GOOD);
    let own = catalog.entries().iter().find(|entry| entry.name == "pendulum").unwrap();
    assert_eq!(own.origin, PresetOrigin::User(user.path().join("deep/er/pendulum.toml")));
    assert_eq!((own.folder.as_str(), own.diagnostic.as_deref()), ("deep/er", None));
    assert_eq!(own.topic(), "deep/er");
}

#[test]
fn a_broken_file_is_listed_with_its_error() {
    let user = folder(&[
        ("broken.toml", GOOD.replace("k*x", "kk*x").as_bytes()),
        ("latin.toml", b"title = \"caf\xe9\"\n"),
        ("empty.toml", b""),
    ]);
    let catalog = Catalog::with_folder(Some(user.path()));
    let diagnostic = |name: &str| {
        let entry = catalog.entries().iter().find(|entry| entry.name == name).unwrap();
        let diagnostic = entry.diagnostic.clone().unwrap();
        (entry.info.title.clone(), diagnostic.rsplit('/').next().unwrap().to_owned())
    };
    assert_eq!(
        diagnostic("broken"),
        ("Oscillator".to_owned(), "broken.toml:11:23: unknown name `kk`".to_owned())
    );
    assert_eq!(diagnostic("latin").1, "latin.toml:1:13: the byte 0xE9 here is not UTF-8");
    assert_eq!(
        diagnostic("empty"),
        ("empty".to_owned(), "empty.toml:1:1: the file has no coordinates".to_owned())
    );
}

#[test]
fn a_path_is_a_file_and_a_name_is_a_preset() {
    let user = folder(&[("mine.toml", GOOD.as_bytes())]);
    let catalog = Catalog::with_folder(None);
    let path = user.path().join("mine.toml");
    let document = catalog.find(path.to_str().unwrap()).unwrap();
    assert_eq!(document.text, GOOD);
    for missing in ["./nowhere", "nowhere.toml", "presets/"] {
        assert!(matches!(catalog.find(missing), Err(NotFound::File { .. })), "{missing}");
    }
    let error = catalog.find(user.path().to_str().unwrap()).unwrap_err();
    assert!(error.to_string().starts_with("cannot read "), "{error}");
}

#[test]
fn a_misspelt_name_gets_the_nearest() {
    let catalog = Catalog::with_folder(None);
    let error = catalog.find("pendulm").unwrap_err();
    assert_eq!(error.to_string(), "unknown preset `pendulm`; did you mean `pendulum`?");
    for (wanted, meant) in [
        ("Simple pendulum", "pendulum"),
        ("simple pendulun", "pendulum"),
        ("kepler", "kepler-brackets"),
        ("Foucault's pendulum", "foucault"),
        // a word of its summary alone
        ("racket", "free-rigid-body"),
    ] {
        let said = catalog.find(wanted).unwrap_err().to_string();
        assert_eq!(said, format!("unknown preset `{wanted}`; did you mean `{meant}`?"));
    }
    let error = catalog.find("zzzzzz").unwrap_err();
    assert_eq!(error.to_string(), "unknown preset `zzzzzz`; `phaselab list` lists the presets");
}

#[test]
fn a_folder_that_is_not_there_is_no_error() {
    let nowhere = tempfile::tempdir().unwrap().path().join("nowhere");
    let catalog = Catalog::with_folder(Some(&nowhere));
    assert_eq!(catalog.entries().len(), Catalog::with_folder(None).entries().len());
}

/// A link to its own folder causes no endless loop.
#[cfg(unix)]
#[test]
fn links_in_a_circle_are_followed_once() {
    let user = folder(&[("one/mine.toml", GOOD.as_bytes())]);
    std::os::unix::fs::symlink(user.path(), user.path().join("one/again")).unwrap();
    let catalog = Catalog::with_folder(Some(user.path()));
    assert_eq!(catalog.entries().iter().filter(|e| e.name == "mine").count(), 1);
}
