//! The current state as a file: it starts at the state of the motion and lists the changes.

use phaselab::diagnostic::Document;
use phaselab::experiment::{Command, Experiment, Export, Prepared};
use phaselab::preset::Catalog;
use phaselab::system::ChannelKind;

use super::{PLENTY, run};
use crate::nonempty;

fn opened(document: &Document) -> Experiment {
    Prepared::of(document).unwrap_or_else(|why| panic!("{why}\n{}", document.text)).experiment
}

fn exported(document: &Document, experiment: &Experiment) -> Export {
    let parts = (&**experiment.model(), experiment.system());
    Export::of(document, parts, &experiment.snapshot())
        .unwrap_or_else(|why| panic!("{}: {why}", document.path))
}

fn shipped(name: &str) -> Document {
    Catalog::with_folder(None).find(name).expect("it is shipped")
}

#[test]
fn every_preset_goes_on_from_its_file() {
    for entry in nonempty(Catalog::with_folder(None).entries()) {
        let document = shipped(&entry.name);
        let mut left = opened(&document);
        left.advance(left.time() + 0.4 * left.speed(), 1_000);
        let export = exported(&document, &left);
        let written = opened(&Document::new("written.toml", export.text));
        if !left.snapshot().released.is_empty() {
            continue;
        }
        assert_eq!(written.time(), left.time(), "{}", entry.name);
        for (channel, (a, b)) in
            left.system().channels().iter().zip(left.values().iter().zip(written.values()))
        {
            let same = match channel.kind {
                // an initial state under constraints is projected on them to the last digit
                ChannelKind::Position(_) if left.system().constraints() > 0 => {
                    (a - b).abs() <= 1e-15 * a.abs().max(1.0)
                }
                ChannelKind::Position(_) => a.to_bits() == b.to_bits(),
                // in a Hamiltonian system the velocity follows from the momentum, and vice versa
                ChannelKind::Velocity(_) | ChannelKind::Momentum(_) | ChannelKind::Energy => {
                    (a - b).abs() <= 1e-12 * a.abs().max(1.0)
                }
                ChannelKind::Attitude(_) => (a - b).abs() <= 1e-12,
                _ => true,
            };
            assert!(same, "{}: {} was {a}, is {b}", entry.name, channel.name);
        }
    }
}

#[test]
fn every_changed_value_is_in_it_and_the_rest_is_as_it_was_written() {
    let document = shipped("pendulum");
    let mut pendulum = opened(&document);
    run(&mut pendulum, 1.25);
    let index = pendulum.model().parameter("g").expect("it is there");
    pendulum.execute(Command::Parameter { index, value: 1.62 });
    pendulum.execute(Command::Speed(2.0));
    pendulum.execute(Command::Method("dop853".to_owned()));
    pendulum.execute(Command::Tolerance(1e-9));
    let export = exported(&document, &pendulum);
    let written = Document::new("written.toml", export.text.as_str());
    let again = opened(&written).snapshot();
    assert_eq!(again.parameters[index], 1.62);
    assert_eq!((again.speed, again.method.name, again.time), (2.0, "dop853", 1.25));
    assert_eq!(again.method.tolerance, Some(1e-9));
    // unrelated lines are unchanged
    let about = document.text.lines().filter(|line| line.contains("about")).count();
    assert!(about > 0);
    let kept = document.text.lines().filter(|line| export.text.contains(*line)).count();
    assert!(kept + 8 >= document.text.lines().count(), "{}", export.text);
}

const FILE: &str = "# my own\ntitle = \"Oscillator\"\ncoordinates.x = { initial = 1 } # at rest\n\
                    parameters = { k = 4 }\n[lagrangian]\nL = \"x'^2/2 - k*x^2/2\"\n";

#[test]
fn a_file_written_otherwise_is_understood() {
    let document = Document::new("own.toml", FILE);
    let mut left = opened(&document);
    run(&mut left, 0.5);
    left.execute(Command::Parameter { index: 0, value: 9.0 });
    let text = exported(&document, &left).text;
    assert!(text.starts_with("# my own\n") && text.contains("# at rest"), "{text}");
    let again = opened(&Document::new("own.toml", text.as_str()));
    assert_eq!(again.values()[..2], left.values()[..2], "{text}");
    assert_eq!(again.snapshot().parameters[0], 9.0);
}

#[test]
fn what_a_file_cannot_say_is_reported() {
    let document = shipped("smooth-sphere");
    let mut sphere = opened(&document);
    while sphere.snapshot().released.is_empty() {
        sphere.advance(sphere.time() + 0.01, PLENTY);
    }
    let export = exported(&document, &sphere);
    assert_eq!(export.missing, ["A constraint was released, so the file begins at the start."]);
    assert_eq!(opened(&Document::new("sphere.toml", export.text)).time(), 0.0);
}

#[test]
fn what_is_expected_and_still_holds_is_kept() {
    let text = "title = \"Oscillator\"\ncoordinates.x = { initial = 1 }\nparameters = { k = 4 }\n\
                [lagrangian]\nL = \"x'^2/2 - k*x^2/2\"\n[expect]\nconserves = [\"energy\"] # always\n\
                values = [\n  { name = \"turn\", expression = \"x\", at = 0.7853981633974483, is = 0, within = 1e-9 },\n  \
                { name = \"stiffness\", expression = \"x''/x\", at = 0.7, is = -4, within = 1e-9 },\n]\n";
    let document = Document::new("own.toml", text);
    let mut left = opened(&document);
    run(&mut left, 0.5);
    let export = exported(&document, &left);
    assert_eq!(export.missing, Vec::<String>::new(), "as it is written nothing is wrong");
    let export = export.with_what_holds(&document).expect("it can be opened");
    let kept = &export.text;
    // the same system still passes the turning point, and its stiffness is unchanged
    assert!(kept.contains("turn") && kept.contains("stiffness"), "{kept}");
    left.execute(Command::Parameter { index: 0, value: 9.0 });
    let export = exported(&document, &left);
    let export = export.with_what_holds(&document).expect("it can be opened");
    let kept = &export.text;
    assert!(kept.contains("conserves = [\"energy\"] # always"), "{kept}");
    assert!(!kept.contains("turn") && !kept.contains("stiffness"), "{kept}");
    assert_eq!(export.missing.len(), 1);
    // times before the new start can no longer be queried
    run(&mut left, 0.75);
    let export = exported(&document, &left);
    assert!(!export.text.contains("stiffness"), "{}", export.text);
    assert!(export.text.contains("conserves"), "{}", export.text);
}
