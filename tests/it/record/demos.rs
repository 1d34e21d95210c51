//! The demos that are part of the program: their claims are true, and they are the same every time.

use phaselab::diagnostic::Document;
use phaselab::preset::{Catalog, demo, demos};
use phaselab::record::ScriptHeader;
use phaselab::record::play;
use phaselab::record::script::ScriptStep;

use super::{on_all_cores, replay, script, shipped};

/// What a caption may have on a screen of 80 columns.
const CAPTION: usize = 76;

#[test]
fn every_demo_is_of_a_preset_and_about_it() {
    let catalog = Catalog::with_folder(None);
    for name in demos() {
        let script = script(&demo(name).expect("listed").text);
        assert_eq!(script.head.open.expect("a system").text, name);
        assert!(catalog.find(name).is_ok(), "{name}");
        assert!(script.head.size.is_some(), "{name} says its size");
        assert!(!script.head.footer, "{name} leaves the room of the footer to the picture");
        for (_, step) in &script.steps {
            if let ScriptStep::Caption(text) = step {
                let long = text.chars().count();
                assert!(long <= CAPTION, "{name}: {long} characters in `{text}`");
            }
        }
        let count = |wanted: fn(&ScriptStep) -> bool| {
            script.steps.iter().filter(|(_, step)| wanted(step)).count()
        };
        assert!(
            count(|step| matches!(step, ScriptStep::Assert(_))) >= 3,
            "{name} claims something"
        );
        assert!(count(|step| matches!(step, ScriptStep::Marker(_))) >= 2, "{name} has chapters");
        assert!(
            count(|step| matches!(step, ScriptStep::Caption(_))) >= 3,
            "{name} says what is seen"
        );
    }
    assert!(catalog.entries().iter().all(|entry| entry.folder != "demos"));
}

#[test]
fn settings_of_a_script_are_read_without_its_steps() {
    for name in demos() {
        let source = demo(name).expect("listed");
        let whole = script(&source.text).head;
        assert_eq!(ScriptHeader::read(&source).expect("it is right"), whole, "{name}");
    }
    let read = |text: &str| ScriptHeader::read(&Document::new("d.demo", text.to_owned()));
    assert!(read("Fps 10\nWait 1s\nNonsense\n").is_ok(), "steps are not read");
    assert!(read("Fps 10\nFps 20\nWait 1s\n").is_err());
}

#[test]
fn demos_show_what_they_claim() {
    let catalog = Catalog::with_folder(None);
    assert!(demos().len() >= 30);
    on_all_cores(&demos(), |name| {
        let recording = shipped(name);
        let source = demo(name).expect("listed");
        let reported = source.report(&recording.false_claims, false);
        assert!(recording.false_claims.is_empty(), "{reported}");
        let seconds = recording.end / 1_000_000;
        assert!((15..=45).contains(&seconds), "{name} lasts {seconds} s");
        replay::check(&recording);
        // the first half again, in a process that has done other work meanwhile
        let mut half = script(&source.text);
        half.steps.truncate(half.steps.len() / 2);
        let system = catalog.find(name).expect("a preset");
        let again = play(&half, &system, name, (80, 24)).expect("it is right").events;
        assert!(again.len() > 50, "{name}");
        assert!(again == recording.events[..again.len()], "{name} is another every time");
    });
}

#[test]
fn the_tour_is_short_and_true() {
    let script = script(include_str!("../../../src/cli/tour.demo"));
    let name = script.head.open.as_ref().expect("a system").text.clone();
    let system = Catalog::with_folder(None).find(&name).expect("a preset");
    let recording = play(&script, &system, &name, (80, 24)).expect("it can be played");
    assert_eq!(recording.false_claims, []);
    assert!((8..=15).contains(&(recording.end / 1_000_000)), "{}", recording.end);
}
