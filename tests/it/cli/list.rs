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

#[test]
fn presets_stand_below_their_topics() {
    let text = phaselab(&["list"]).success();
    let topics: Vec<&str> =
        text.lines().filter(|line| !line.is_empty() && !line.starts_with(' ')).collect();
    let mut once = topics.clone();
    once.sort_unstable();
    once.dedup();
    assert_eq!(once.len(), topics.len(), "every topic once: {topics:?}");
    assert!(topics.contains(&"rigid body"), "{topics:?}");
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
