//! `list` and `methods`.

use super::phaselab;
use phaselab::integrate::METHODS;
use phaselab::preset::Catalog;

#[test]
fn every_preset_stands_in_the_list() {
    let text = phaselab(&["list"]).success();
    let object = phaselab(&["list", "--format", "json"]).json();
    let listed = object["presets"].as_array().expect("a list of presets");
    let catalog = Catalog::with_folder(None);
    assert_eq!(listed.len(), catalog.entries().len());
    for (entry, object) in catalog.entries().iter().zip(listed) {
        assert!(text.contains(&format!("  {} ", entry.name)), "{}", entry.name);
        assert_eq!(object["name"], entry.name.as_str());
        assert_eq!(object["title"], entry.info.title.as_str());
        assert_eq!(object["topics"][0], entry.topic());
        assert!(object["mistake"].is_null());
    }
}

/// Every chapter appears once, in the order of the notes; every topic appears once in a chapter; every preset is below
/// the chapter of its section.
#[test]
fn presets_stand_below_their_chapters_and_topics() {
    let text = phaselab(&["list"]).success();
    let (mut chapters, mut topics) = (Vec::new(), Vec::new());
    for line in text.lines().filter(|line| !line.is_empty()) {
        if !line.starts_with(' ') {
            chapters.push(line);
            topics.clear();
        } else if !line.starts_with("   ") {
            assert!(!topics.contains(&line), "{line} stands twice in {chapters:?}");
            topics.push(line);
        } else {
            let section = line.split_whitespace().next().expect("a section or a name");
            let number = section.split('.').next().and_then(|first| first.parse::<usize>().ok());
            let chapter = chapters.last().expect("a chapter above");
            match number {
                Some(number) => assert!(chapter.contains(&format!(" {number}:")), "{line}"),
                None => assert_eq!(*chapter, "Further systems", "{line}"),
            }
        }
    }
    let begin: Vec<&str> = chapters.iter().map(|line| line.split(':').next().unwrap()).collect();
    let meant = ["Chapter 1", "Chapter 2", "Chapter 3", "Chapter 4", "Further systems"];
    assert_eq!(begin, meant);
    assert!(text.contains("\n  rigid body\n"), "{text}");
}

#[test]
fn methods_are_the_rows_of_the_table() {
    let text = phaselab(&["methods"]).success();
    let object = phaselab(&["methods", "--format", "json"]).json();
    let listed = object["methods"].as_array().expect("a list of methods");
    assert_eq!(listed.len(), METHODS.len());
    assert!(!METHODS.is_empty());
    for (method, object) in METHODS.iter().zip(listed) {
        assert!(text.contains(&format!("{}: {}\n", method.name, method.title)), "{}", method.name);
        assert_eq!(object["name"], method.name);
        assert_eq!(object["order"].as_u64(), method.order.map(u64::from));
        assert!(object["symplectic"].is_boolean() && object["adaptive"].is_boolean());
    }
}
