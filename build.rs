//! Lists the presets that the program embeds, so that no file has to be parsed to name them.
//!
//! In: the folder `presets`. Out: `catalog_index.rs`, a table of the head of every file. The program is rebuilt if a
//! preset is added or changed.

use std::error::Error;
use std::fmt::Write as _;
use std::path::{Path, PathBuf};
use std::{env, fs};

fn main() -> Result<(), Box<dyn Error>> {
    println!("cargo::rerun-if-changed=presets");
    println!("cargo::rerun-if-changed=build.rs");
    let root = Path::new(&env::var("CARGO_MANIFEST_DIR")?).join("presets");
    let mut files = Vec::new();
    presets(&root, &mut files)?;
    files.sort();
    let mut table = String::from("&[\n");
    for file in files {
        let head: toml::Table = fs::read_to_string(&file)?.parse()?;
        let text = |key: &str| head.get(key).and_then(toml::Value::as_str).unwrap_or_default();
        let topics = head.get("topics").and_then(toml::Value::as_array).into_iter().flatten();
        let topics: Vec<&str> = topics.filter_map(toml::Value::as_str).collect();
        let path = file.strip_prefix(&root)?.to_str().ok_or("a preset has an unusual name")?;
        writeln!(
            table,
            "Listed {{ path: {:?}, title: {:?}, summary: {:?}, source: {:?}, chapter: {:?}, topics: &{topics:?} }},",
            path.replace('\\', "/"),
            text("title"),
            text("summary"),
            text("source"),
            text("chapter"),
        )?;
    }
    table.push_str("]\n");
    fs::write(Path::new(&env::var("OUT_DIR")?).join("catalog_index.rs"), table)?;
    Ok(())
}

/// All presets in a folder and its subfolders.
fn presets(folder: &Path, files: &mut Vec<PathBuf>) -> Result<(), Box<dyn Error>> {
    for entry in fs::read_dir(folder)? {
        let path = entry?.path();
        if path.is_dir() {
            presets(&path, files)?;
        } else if path.extension().is_some_and(|extension| extension == "toml") {
            files.push(path);
        }
    }
    Ok(())
}
