//! Lessons and demos among the systems: a row, a list, and back to it.

use phaselab::app::{Above, App, AppEvent, Choice, Effect, Guide, GuideKind, LessonTaken, Overlay};

use crate::fixtures::{catalog, in_lab, press};

fn guides(first: LessonTaken) -> Vec<Guide> {
    let guide = |kind, name: &str, title: &str| Guide {
        kind,
        name: name.to_owned(),
        title: title.to_owned(),
        system: "Simple pendulum".to_owned(),
    };
    vec![
        guide(GuideKind::Lesson(first), "tour", "A tour"),
        guide(GuideKind::Lesson(LessonTaken::NotYet), "kepler", "Why does Kepler's ellipse close?"),
        guide(GuideKind::Demo, "tour", "The pendulum"),
    ]
}

/// The choice of the selected line, and all notes.
fn listed(app: &App) -> (Choice, Vec<String>) {
    let Some(Overlay::Menu(menu)) = &app.overlay else { panic!("no list") };
    let notes = menu.items.iter().map(|item| item.about.clone()).collect();
    (menu.current().expect("a line").1.choice, notes)
}

#[test]
fn the_row_of_lessons_lists_them_and_each_leads_back_to_the_list() {
    let (mut app, _) = App::new(catalog(), None);
    app.picker.guides = guides(LessonTaken::NotYet);
    assert!(app.picker.is_selected(0));
    press(&mut app, "Up Up");
    assert_eq!(app.picker.selected_above(), Some(Above::Guides));
    press(&mut app, "Enter");
    assert_eq!(listed(&app).0, Choice::Guide(0));
    assert_eq!(listed(&app).1[2], "demo: Simple pendulum");
    let effects = press(&mut app, "Enter");
    assert_eq!(effects, [Effect::TakeGuide(guides(LessonTaken::NotYet)[0].clone())]);
    assert!(app.overlay.is_none());
    // a lesson that was finished leads to the next one
    app.update(AppEvent::GuideLeft { guides: guides(LessonTaken::Whole), wrong: None });
    assert_eq!(app.lessons_finished(), (1, 2));
    assert_eq!(listed(&app).0, Choice::Guide(1));
    assert_eq!(listed(&app).1[0], "lesson, finished: Simple pendulum");
    press(&mut app, "Esc");
    assert!(app.overlay.is_none());
}

#[test]
fn a_lesson_that_was_left_and_a_demo_are_selected_again() {
    let (mut app, _) = App::new(catalog(), None);
    app.picker.guides = guides(LessonTaken::NotYet);
    press(&mut app, "Up Up Enter Enter");
    let wrong = Some("the progress is not kept".to_owned());
    app.update(AppEvent::GuideLeft { guides: guides(LessonTaken::Partly), wrong });
    assert_eq!(listed(&app).0, Choice::Guide(0));
    assert!(
        app.notifications.shown.as_ref().is_some_and(|notice| notice.text.contains("not kept"))
    );
    press(&mut app, "Down Down Enter");
    app.update(AppEvent::GuideLeft { guides: guides(LessonTaken::Partly), wrong: None });
    assert_eq!(listed(&app).0, Choice::Guide(2));
}

/// They can be taken from the lab as well; where there are none, that is said.
#[test]
fn a_key_lists_them_from_anywhere() {
    let mut app = in_lab();
    press(&mut app, "F2");
    assert!(app.overlay.is_none() && app.notifications.shown.is_some());
    app.picker.guides = guides(LessonTaken::NotYet);
    press(&mut app, "F2 k e p");
    assert_eq!(listed(&app).0, Choice::Guide(1));
    // negative: a search in the list of systems is among the systems only
    let (mut app, _) = App::new(catalog(), None);
    app.picker.guides = guides(LessonTaken::NotYet);
    press(&mut app, "/ p e n d");
    assert_eq!(app.picker.above().count(), 0);
}
