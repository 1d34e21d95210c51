//! Lessons: what is right is what the motion says, and whoever takes one commits an answer first.

use crossterm::event::{KeyCode, KeyEvent, KeyModifiers};
use phaselab::diagnostic::Document;
use phaselab::preset::{lesson, lessons};
use phaselab::record::script::{LessonStep, ScriptStep};
use phaselab::record::{Lesson, Pressed, Script, check_lesson};
use phaselab::view::RenderStyle;
use phaselab::view::colour::ColourDepth;
use phaselab::view::glyphs::Glyphs;
use phaselab::view::theme::Theme;
use ratatui::buffer::Buffer;
use ratatui::layout::Rect;

use super::on_all_cores;
use crate::fixtures::{catalog, key};
use crate::nonempty;
use crate::screen::ascii;

fn system(name: &str) -> Document {
    catalog().find(name).expect("a preset")
}

/// What is wrong with a lesson about the planet.
fn diagnostics(text: &str) -> Vec<String> {
    let text = format!("Open planet\nSpeed 1/6\n{text}");
    let script = Script::read(&Document::new("my.lesson", &text)).expect("a script");
    let found = check_lesson(&script, &system("planet"), "planet").err().unwrap_or_default();
    found.into_iter().map(|diagnostic| diagnostic.message).collect()
}

fn taken(text: &str) -> Lesson {
    let text = format!("Open planet\nSpeed 1/6\n{text}");
    let script = Script::read(&Document::new("my.lesson", &text)).expect("a script");
    Lesson::watched(script, &system("planet"), "planet").expect("a lesson")
}

/// Lets time pass in frames of a twentieth of a second.
fn pass(lesson: &mut Lesson, seconds: f64) {
    for _ in 0..(seconds * 20.0) as u32 {
        lesson.advance(50_000).expect("it goes on");
    }
}

fn keys(lesson: &mut Lesson, text: &str) {
    for c in text.chars() {
        let code = if c == '\n' { KeyCode::Enter } else { KeyCode::Char(c) };
        assert_eq!(lesson.press(KeyEvent::from(code)), Pressed::Taken, "{c}");
    }
}

fn screen(lesson: &mut Lesson, size: (u16, u16), look: &RenderStyle) -> Vec<String> {
    let area = Rect::new(0, 0, size.0, size.1);
    let mut buffer = Buffer::empty(area);
    lesson.draw(look, area, &mut buffer);
    let row = |y| (0..size.0).map(|x| buffer[(x, y)].symbol()).collect::<String>();
    (0..size.1).map(row).collect()
}

fn shown(lesson: &mut Lesson) -> String {
    screen(lesson, (80, 24), &ascii()).join("\n")
}

/// On a low screen the motion has the rows that the text leaves, and where the text fits alone it is whole.
#[test]
fn a_lesson_on_a_low_screen_shows_the_motion_too() {
    for (size, picture) in [((60, 15), true), ((60, 17), true), ((40, 14), true), ((40, 10), true)]
    {
        let mut lesson = taken("Say \"This is a planet; it goes round its sun.\"\nWait 1s\n");
        pass(&mut lesson, 0.1);
        let rows = screen(&mut lesson, size, &ascii());
        let text = rows.join("\n");
        assert!(!text.contains("needs"), "{size:?}\n{text}");
        assert!(text.contains("its sun"), "{size:?}\n{text}");
        assert_eq!(text.contains("- Motion"), picture, "{size:?}\n{text}");
    }
    let long = "word ".repeat(80);
    let mut lesson = taken(&format!("Say \"{long}\"\nWait 1s\n"));
    pass(&mut lesson, 0.1);
    let text = screen(&mut lesson, (40, 10), &ascii()).join("\n");
    assert!(text.contains("rows in 40") && text.contains("the window has 10"), "{text}");
}

const HALF: &str = "Predict \"How far?\" r within 0.1\nWait 3s\nOutcome\nSay \"after\"\n";

/// It shows how to go about, asks little and predicts nothing.
const TOUR: &str = "tour";

#[test]
fn shipped_lessons_are_true_with_every_answer() {
    assert!(lessons().len() >= 8);
    on_all_cores(&lessons(), |name| {
        let source = lesson(name).expect("a lesson");
        let report = |diagnostics: &[_]| source.report(diagnostics, false);
        let script = Script::read(&source).unwrap_or_else(|why| panic!("{}", report(&why)));
        assert!(script.head.title.is_some(), "{name} has a title");
        let open = script.head.open.clone().expect("a system").text;
        let checked = check_lesson(&script, &system(&open), &open);
        let checked = checked.unwrap_or_else(|why| panic!("{}", report(&why)));
        let (questions, tasks) = if name == TOUR { (1, 2) } else { (3, 1) };
        assert!(checked.questions >= questions && checked.tasks >= tasks, "{name}: {checked:?}");
        assert!(checked.wrong >= 2 * checked.questions - 1, "{name}: {checked:?}");
    });
}

#[test]
fn shipped_lessons_ask_for_a_value_and_end_with_the_lab() {
    for name in nonempty(lessons().into_iter().filter(|name| *name != TOUR)) {
        let script = Script::read(&lesson(name).expect("a lesson")).expect("a script");
        let has = |wanted: fn(&LessonStep) -> bool| {
            let mut steps = script.steps.iter().map(|(_, step)| step);
            steps.any(|step| matches!(step, ScriptStep::Lesson(step) if wanted(step)))
        };
        assert!(has(|step| matches!(step, LessonStep::Predict { .. })), "{name}");
        assert!(has(|step| matches!(step, LessonStep::Ask(_))), "{name}");
        assert!(has(|step| matches!(step, LessonStep::Task { hint: Some(_), .. })), "{name}");
        let last = script.steps.iter().rev().find_map(|(_, step)| match step {
            ScriptStep::Lesson(LessonStep::Say(_)) => None,
            step => Some(matches!(step, ScriptStep::Lesson(LessonStep::Free(_)))),
        });
        assert_eq!(last, Some(true), "{name} ends with the lab");
    }
}

#[test]
fn an_answer_is_committed_before_the_outcome_and_shown_beside_it() {
    // at the aphelion r = a (1 + e) = 1.6
    for (typed, verdict) in [
        ("1.55", "+ Right: you predicted 1.55; the answer is 1.6"),
        ("2", "x Wrong: you predicted 2; the answer is 1.6"),
    ] {
        let mut lesson = taken(HALF);
        pass(&mut lesson, 9.0);
        assert!(shown(&mut lesson).contains("How far?"), "time stands still until it is answered");
        keys(&mut lesson, "about\n");
        assert!(shown(&mut lesson).contains("This is not a number"));
        lesson.press(KeyEvent::from(KeyCode::Backspace));
        assert!(shown(&mut lesson).contains("> abou_"));
        lesson.press(KeyEvent::new(KeyCode::Char('u'), KeyModifiers::CONTROL));
        assert!(shown(&mut lesson).contains("> _"));
        keys(&mut lesson, &format!("{typed}\n"));
        pass(&mut lesson, 1.0);
        let under_way = shown(&mut lesson);
        assert!(under_way.contains(&format!("Your prediction: {typed}")), "{under_way}");
        assert!(!under_way.contains("it is 1.6"), "{under_way}");
        pass(&mut lesson, 9.0);
        let outcome = shown(&mut lesson);
        assert!(outcome.contains(verdict), "{outcome}");
        assert_eq!(lesson.score(), (usize::from(typed == "1.55"), 1));
    }
}

#[test]
fn a_wrong_option_says_why_and_which_is_right() {
    let ask = "Ask \"Where?\"\nOption \"near\" why \"It moves away.\" if r < 1\n\
               Option \"far\" if r > 1\nWait 3s\nOutcome\n";
    let mut lesson = taken(ask);
    pass(&mut lesson, 1.0);
    keys(&mut lesson, "a\n");
    pass(&mut lesson, 4.0);
    let wrong = shown(&mut lesson);
    assert!(wrong.contains("Wrong: a) near. It moves away."), "{wrong}");
    assert!(
        wrong.contains("The answer is b) far") && wrong.contains("Measured: r is 1.6"),
        "{wrong}"
    );
    let mut lesson = taken(ask);
    pass(&mut lesson, 1.0);
    keys(&mut lesson, "b\n");
    pass(&mut lesson, 4.0);
    assert!(shown(&mut lesson).contains("Right: b) far"));
}

#[test]
fn what_is_false_is_an_error() {
    let ask = |one: &str, two: &str| {
        format!("Ask \"?\"\nOption \"a\" {one}\nOption \"b\" {two}\nWait 3s\nOutcome\n")
    };
    let check = |text: &str, message: &str| {
        let found = diagnostics(text);
        assert!(found.iter().any(|found| found.contains(message)), "{text}: {found:?}");
    };
    assert_eq!(diagnostics(&ask("if r > 1", "why \"no\" if r < 1")), Vec::<String>::new());
    check(&ask("if r > 2", "why \"no\" if r < 1"), "none of the options is right");
    check(&ask("if r > 1", "why \"no\" if r < 2"), "2 of the options are right");
    check(&ask("if r > 1", "if r < 1"), "does not say why");
    check(&ask("if r > 1", "why \"no\" if rr < 1"), "rr");
    check("Say \"x\"\nWait 3s\nAssert r < 1\n", "this is false: r is 1.6");
    check("Predict \"?\" r within 0\nWait 3s\nOutcome\n", "nobody predicts a number exactly");
    check("Predict \"?\" r within 1\nWait 3s\n", "is never shown");
    check("Wait 1s\nOutcome\n", "no question waits");
    check("Task \"t\" until e < 0.5\nWait 1s\n", "nothing shows");
    check("Task \"t\" until e < 0.7\nSolution r\nWait 1s\n", "done before it begins");
    check("Task \"t\" until e < 0.5\nSolution r\nWait 1s\n", "the solution does not do this");
    check("Wait 1s\n", "this is a demo");
    check(&format!("Say \"{}\"\nWait 1s\n", "word ".repeat(150)), "rows on a screen of 80");
}

/// A task is to change something: where there is room for one pane the parameters are shown, and the motion otherwise.
#[test]
fn a_task_in_a_low_window_shows_the_parameters() {
    for (size, is_low) in [((60, 15), true), ((80, 24), false)] {
        let mut lesson = taken(
            "Say \"first\"\nTask \"do\" hint \"so\" until e < 0.5\nSolution Down x3 Enter 0 Enter\nWait 1s\n",
        );
        pass(&mut lesson, 0.1);
        assert!(screen(&mut lesson, size, &ascii()).join("\n").contains("- Motion"), "{size:?}");
        keys(&mut lesson, "\n");
        pass(&mut lesson, 0.1);
        let text = screen(&mut lesson, size, &ascii()).join("\n");
        assert!(text.contains("Parameters"), "{size:?}\n{text}");
        assert_eq!(text.contains("- Motion"), !is_low, "{size:?}\n{text}");
    }
}

#[test]
fn a_task_ends_when_the_claim_holds_and_the_system_begins_anew() {
    let text = "Task \"do\" hint \"like this\" until e < 0.5\nSolution Down x3 Enter 0 Enter\n\
                Predict \"e?\" e within 0.01\nWait 1s\nOutcome\n";
    assert_eq!(diagnostics(text), Vec::<String>::new());
    let mut lesson = taken(text);
    pass(&mut lesson, 1.0);
    assert!(!shown(&mut lesson).contains("like this"));
    lesson.press(KeyEvent::from(KeyCode::F(9)));
    assert!(shown(&mut lesson).contains("like this"));
    for _ in 0..3 {
        lesson.press(KeyEvent::from(KeyCode::Down));
    }
    keys(&mut lesson, "\n0\n");
    let done = shown(&mut lesson);
    assert!(done.contains("Done: e is 0"), "{done}");
    keys(&mut lesson, "\n");
    pass(&mut lesson, 1.0);
    // the person's e = 0 is gone: the answer is that of the file
    keys(&mut lesson, "0.6\n");
    pass(&mut lesson, 2.0);
    assert_eq!(lesson.score(), (1, 1));
}

/// The picture keeps its scale while the orbit grows, and after the lab was the person's; without the line it does not.
#[test]
fn an_extent_holds_the_scale_of_the_picture() {
    let steps = "Say \"a\"\nSet k = 0.9*k\nSay \"b\"\n\
                 Task \"do\" until e < 0.5\nSolution Down x3 Enter 0 Enter\nSet k = 0.9*k\nSay \"c\"\nWait 1s\n";
    let extent = "Extent X from -3.4 to 1 and Y from -1.5 to 1.5\n";
    // the planet is to the right of the sun
    let sun = |rows: &[String]| rows.iter().find_map(|row| row[..40].find('@'));
    for (text, holds) in [(format!("{extent}{steps}"), true), (steps.to_owned(), false)] {
        let mut lesson = taken(&text);
        let mut suns = Vec::new();
        for answer in ["\n", "\n", "", ""] {
            pass(&mut lesson, 0.2);
            let rows = screen(&mut lesson, (80, 24), &ascii());
            suns.extend(sun(&rows).filter(|_| !answer.is_empty()));
            keys(&mut lesson, answer);
        }
        for _ in 0..3 {
            lesson.press(KeyEvent::from(KeyCode::Down));
        }
        keys(&mut lesson, "\n0\n\n");
        pass(&mut lesson, 0.2);
        let rows = screen(&mut lesson, (80, 24), &ascii());
        assert!(rows.iter().any(|row| row.contains("c  ")), "{rows:?}");
        suns.extend(sun(&rows));
        assert_eq!(suns.len(), 3, "{suns:?}");
        assert_eq!(suns.iter().all(|at| *at == suns[0]), holds, "{suns:?}");
    }
}

#[test]
fn an_extent_names_what_a_picture_shows_from_less_to_more() {
    let check = |line: &str, message: &str| {
        let found = diagnostics(&format!("Say \"a\"\n{line}\nWait 1s\n"));
        assert!(found.iter().any(|found| found.contains(message)), "{line}: {found:?}");
    };
    check("Extent rr from 0 to 1", "rr");
    check("Extent r^7 from 0 to 1", "no picture shows `r^7`");
    check("Extent r from 2 to a", "this range would go from 2 to 1");
    // one quantity, written in two ways
    check(
        "Extent X from 0 to 1 and r from 0 to 1 and r*cos(theta) from 5 to 6",
        "`r*cos(theta)` has two ranges",
    );
    assert_eq!(
        diagnostics(
            "Extent r from 0 to 2 and r*cos(theta) from -2 to 2\nPredict \"?\" r within 1\nWait 1s\nExtent\nOutcome\n"
        ),
        Vec::<String>::new()
    );
}

#[test]
fn it_can_be_left_at_any_time_and_goes_on_there() {
    for leave in [KeyCode::Esc, KeyCode::Char('q')] {
        let mut lesson = taken(HALF);
        pass(&mut lesson, 1.0);
        if leave == KeyCode::Esc {
            // one Esc too many does not leave, and says so
            assert_eq!(lesson.press(KeyEvent::from(leave)), Pressed::Taken);
            assert!(shown(&mut lesson).contains("Esc again leaves"));
        }
        assert_eq!(
            (lesson.press(KeyEvent::from(leave)), lesson.is_finished()),
            (Pressed::Leave, false)
        );
    }
    let text = format!("Say \"first\"\n{HALF}");
    let mut first = taken(&text);
    pass(&mut first, 1.0);
    keys(&mut first, "\n");
    pass(&mut first, 1.0);
    keys(&mut first, "1\n");
    pass(&mut first, 4.0);
    keys(&mut first, "\n");
    pass(&mut first, 1.0);
    assert!(shown(&mut first).contains("after"));
    let mut second = taken(&text);
    second.resume(first.place()).expect("it goes on");
    pass(&mut second, 1.0);
    assert_eq!(shown(&mut second).lines().last(), shown(&mut first).lines().last());
    assert!(shown(&mut second).contains("after"));
    keys(&mut second, "\n");
    pass(&mut second, 1.0);
    assert!(second.is_finished());
    assert_eq!(second.press(KeyEvent::from(KeyCode::Enter)), Pressed::Leave);
    // a place that an older version of the lesson had
    let mut beyond = taken(&text);
    beyond.resume(1000).expect("it ends");
    assert!(beyond.is_finished());
}

#[test]
fn the_footer_of_the_lab_shows_keys_only_where_they_do_what_it_says() {
    let text = "Say \"first\"\nPredict \"How far?\" r within 0.1\nWait 2s\nOutcome\n\
                Task \"do\" hint \"like this\" until e < 0.5\nSolution Down x3 Enter 0 Enter\n";
    let mut lesson = taken(text);
    let without = |lesson: &mut Lesson, stage: &str| {
        pass(lesson, 0.5);
        let shown = shown(lesson);
        assert!(shown.contains(stage), "{stage}: {shown}");
        for hint in ["? help", "choose", "change", "pause", "quit"] {
            assert!(!shown.contains(hint), "{stage}: {hint}\n{shown}");
        }
    };
    without(&mut lesson, "Enter continues");
    keys(&mut lesson, "\n");
    without(&mut lesson, "type a number");
    keys(&mut lesson, "1\n");
    without(&mut lesson, "watch what happens");
    pass(&mut lesson, 4.0);
    without(&mut lesson, "Enter continues");
    keys(&mut lesson, "\n");
    pass(&mut lesson, 0.5);
    let task = shown(&mut lesson);
    assert!(task.contains("? help   q leave"), "{task}");
}

#[test]
fn in_a_task_q_and_esc_close_what_lies_on_top_before_they_leave() {
    let text = "Wait 1s\nTask \"do\" hint \"like this\" until e < 0.5\n\
                Solution Down x3 Enter 0 Enter\n";
    let press = |lesson: &mut Lesson, code| lesson.press(KeyEvent::from(code));
    let (q, esc) = (KeyCode::Char('q'), KeyCode::Esc);
    for close in [q, esc] {
        let mut lesson = taken(text);
        pass(&mut lesson, 2.0);
        keys(&mut lesson, "?");
        assert!(shown(&mut lesson).contains("q close"));
        assert_eq!(press(&mut lesson, close), Pressed::Taken);
        assert!(shown(&mut lesson).contains("q leave"));
        assert_eq!(press(&mut lesson, q), Pressed::Leave);
    }
    // one Esc too many does not leave, and says so
    let mut lesson = taken(text);
    pass(&mut lesson, 2.0);
    assert_eq!(press(&mut lesson, esc), Pressed::Taken);
    assert!(shown(&mut lesson).contains("Esc again to leave the lesson."));
    assert_eq!(press(&mut lesson, esc), Pressed::Leave);
}

#[test]
fn the_pane_lies_below_the_lab_and_is_readable_without_colour_and_in_ascii() {
    for name in nonempty(lessons()) {
        let source = lesson(name).expect("a lesson");
        let script = Script::read(&source).expect("a script");
        let open = script.head.open.clone().expect("a system").text;
        for size in [(80, 24), (120, 40), (40, 12)] {
            let mut lesson =
                Lesson::watched(script.clone(), &system(&open), &open).expect("a lesson");
            pass(&mut lesson, 0.5);
            let rows = screen(&mut lesson, size, &ascii());
            let title = script.head.title.clone().expect("a title");
            let pane = rows.iter().position(|row| row.contains(&title[..20])).expect("a pane");
            // on a low screen what is said is whole, and a picture of three rows at least is above it if there is one
            let fits =
                if size.1 < 20 { pane == 0 || pane >= 3 } else { pane >= usize::from(size.1) / 2 };
            assert!(fits, "{size:?}: {pane}\n{}", rows.join("\n"));
            assert!(rows.join("").is_ascii(), "{}", rows.join("\n"));
            assert!(rows.last().is_some_and(|row| row.contains("Enter continues")));
        }
    }
}

#[test]
fn a_lesson_is_not_recorded_as_a_demo() {
    let document = Document::new("my.lesson", format!("Open planet\n{HALF}"));
    let script = Script::read(&document).expect("a script");
    let refused = phaselab::record::play(&script, &system("planet"), "planet", (80, 24));
    assert!(refused.expect_err("nobody answers")[0].message.contains("waits for a person"));
}

#[test]
fn a_point_is_set_by_the_cursor_committed_and_kept_beside_the_outcome() {
    let point = "Predict \"Where is it in half a turn?\" point r from 0 to 2 and p_r within 0.1 and 1\n\
                 Wait 3s\nOutcome\nSay \"after\"\n";
    let curve = point.replace("point", "curve");
    // the right answer and wrong ones are taken by the check, which finds what is false
    assert_eq!(diagnostics(point), Vec::<String>::new());
    assert_eq!(diagnostics(&curve), Vec::<String>::new());
    assert!(!diagnostics(&point.replace("p_r", "nothing")).is_empty());
    let mut lesson = taken(point);
    pass(&mut lesson, 0.1);
    let wide = |lesson: &mut Lesson| screen(lesson, (120, 40), &ascii()).join("\n");
    let before = wide(&mut lesson);
    assert!(
        before.contains("Where is it in half a turn?") && !before.contains("measured"),
        "{before}"
    );
    for key in [KeyCode::Right, KeyCode::Up, KeyCode::Enter] {
        assert_eq!(lesson.press(KeyEvent::from(key)), Pressed::Taken, "{key:?}");
        wide(&mut lesson);
    }
    pass(&mut lesson, 4.0);
    let after = wide(&mut lesson);
    assert!(after.contains("predicted") && after.contains("measured"), "{after}");
}

/// Numbers of the cursor and of the selected option have the minus sign of all others; what is typed stays as it is.
#[test]
fn numbers_of_a_selected_line_have_the_minus_sign() {
    let rich = RenderStyle { theme: Theme::dark(ColourDepth::None), glyphs: Glyphs::Braille };
    for (ask, pressed, line) in [
        ("Predict \"p?\" p_r within 1", vec![KeyCode::Char('-'), KeyCode::Char('2')], "› -2_"),
        (
            "Predict \"Where?\" point r from 0 to 2 and p_r from -4 to 4 within 0.1 and 1",
            vec![KeyCode::Down, KeyCode::Down],
            "p_r = −",
        ),
        ("Ask \"p?\"\nOption \"-2\" if p_r < 0\nOption \"2\" if p_r > 0", vec![], "› a) −2"),
    ] {
        let mut lesson = taken(&format!("{ask}\nWait 3s\nOutcome\n"));
        pass(&mut lesson, 0.1);
        screen(&mut lesson, (80, 24), &rich);
        for code in pressed {
            assert_eq!(lesson.press(KeyEvent::from(code)), Pressed::Taken, "{code:?}");
        }
        let text = screen(&mut lesson, (80, 24), &rich).join("\n");
        assert!(text.contains(line), "{text}");
    }
}

#[test]
fn what_was_predicted_stays_in_view_where_there_is_room_for_one_picture() {
    let mut lesson = taken(
        "Predict \"Where?\" point r from 0 to 2 and p_r within 0.1 and 1\nWait 3s\nOutcome\nSay \"after\"\n",
    );
    pass(&mut lesson, 0.1);
    shown(&mut lesson);
    keys(&mut lesson, "\n");
    pass(&mut lesson, 1.0);
    let under_way = shown(&mut lesson);
    assert!(under_way.contains("Phase") && under_way.contains("p_r ["), "{under_way}");
    pass(&mut lesson, 3.0);
    let outcome = shown(&mut lesson);
    assert!(outcome.contains("predicted") && outcome.contains("measured"), "{outcome}");
}

#[test]
fn what_is_said_after_a_task_is_said_of_what_the_person_did() {
    let mut lesson = taken(
        "Task \"do\" until e < 0.5\nSolution Down x3 Enter 0 Enter\nSay \"so\"\nWait 1s\nSay \"then\"\n",
    );
    pass(&mut lesson, 1.0);
    let e = |lesson: &mut Lesson| {
        let shown = shown(lesson);
        let row =
            shown.lines().find(|row| row.contains("  e  ")).expect("the parameter e").to_owned();
        row.split("  e  ")
            .nth(1)
            .expect("its value")
            .split_whitespace()
            .next()
            .expect("a value")
            .to_owned()
    };
    for _ in 0..3 {
        lesson.press(KeyEvent::from(KeyCode::Down));
    }
    // whoever types is not interrupted
    keys(&mut lesson, "\n0.2");
    pass(&mut lesson, 1.0);
    assert!(!shown(&mut lesson).contains("Done"));
    keys(&mut lesson, "\n");
    assert!(shown(&mut lesson).contains("Done: e is 0.2, below 0.5."));
    keys(&mut lesson, "\n");
    pass(&mut lesson, 1.0);
    assert!(shown(&mut lesson).contains("so"));
    keys(&mut lesson, "\n");
    pass(&mut lesson, 2.0);
    assert!(shown(&mut lesson).contains("then"));
    assert_eq!(e(&mut lesson), "0.6");
}

#[test]
fn whoever_reads_may_look_around_and_comes_back() {
    let mut lesson = taken("Say \"first\"\nSay \"second\"\nWait 1s\n");
    pass(&mut lesson, 0.5);
    let before = shown(&mut lesson);
    lesson.press(KeyEvent::from(KeyCode::BackTab));
    keys(&mut lesson, "2");
    let equations = shown(&mut lesson);
    assert!(
        equations.contains("Equations of motion") || equations.contains("Lagrangian"),
        "{equations}"
    );
    keys(&mut lesson, "x");
    assert!(shown(&mut lesson).contains("x does nothing here"));
    keys(&mut lesson, "\n");
    pass(&mut lesson, 0.5);
    let picture = |shown: &str| shown.lines().take(15).map(str::to_owned).collect::<Vec<_>>();
    assert_eq!(picture(&shown(&mut lesson)), picture(&before));
}

/// What is said of a key while time passes is no longer there when the lesson waits for that very key.
#[test]
fn a_key_that_did_nothing_is_forgotten_when_the_lesson_waits_again() {
    let mut lesson = taken("Say \"first\"\nWait 1s\nSay \"second\"\n");
    pass(&mut lesson, 0.1);
    keys(&mut lesson, "\n\n");
    assert!(shown(&mut lesson).contains("Enter does nothing here"));
    pass(&mut lesson, 1.5);
    let now = shown(&mut lesson);
    assert!(now.contains("second") && now.contains("Enter continues"), "{now}");
    assert!(!now.contains("does nothing"), "{now}");
}

/// The lesson of the tour, answered with its first option, up to the text that contains these words.
fn tour_until(words: &str) -> Lesson {
    let source = lesson(TOUR).expect("a lesson");
    let script = Script::read(&source).expect("a script");
    let mut tour = Lesson::watched(script, &system("pendulum"), "pendulum").expect("a lesson");
    for _ in 0..40 {
        pass(&mut tour, 1.0);
        if shown(&mut tour).contains(words) {
            return tour;
        }
        // a task is left to its hint, and then skipped
        let task = tour.is_moving() && shown(&mut tour).contains("Double the gravity");
        if task || !tour.is_moving() {
            tour.press(KeyEvent::from(if task { KeyCode::F(9) } else { KeyCode::Enter }));
        }
    }
    panic!("never {words}: {}", shown(&mut tour));
}

#[test]
fn the_tour_shows_what_it_speaks_of() {
    for size in [(80, 24), (120, 40), (200, 60)] {
        for (words, title) in [("the plot Phase", "p_theta"), ("The energy gauge", "verdict")] {
            let mut tour = tour_until(words);
            let drawn = screen(&mut tour, size, &ascii());
            assert!(drawn.join("\n").contains(title), "{words} at {size:?}: {drawn:#?}");
        }
    }
}

#[test]
fn what_was_said_of_the_motion_expires_while_the_lesson_waits() {
    let text = "Wait 1s\nSet m = 2\nSay \"A heavier planet.\"\n";
    let mut lesson = taken(text);
    pass(&mut lesson, 2.0);
    let waits = shown(&mut lesson);
    assert!(waits.contains("A heavier planet") && waits.contains("energy jumped"), "{waits}");
    pass(&mut lesson, 6.0);
    let later = shown(&mut lesson);
    assert!(later.contains("A heavier planet") && !later.contains("energy jumped"), "{later}");
    assert!(!lesson.advance(50_000).expect("it waits"), "then nothing changes");
}

/// Where no clock is meant, no time is reported.
#[test]
fn a_text_that_a_lesson_rebuilds_tells_no_milliseconds() {
    let mut tour = tour_until("And now a Lagrangian of your own");
    for name in ["E", "End", "Left"] {
        tour.press(key(name));
    }
    keys(&mut tour, " - 2*theta^2");
    pass(&mut tour, 1.0);
    let rebuilt = shown(&mut tour);
    assert!(rebuilt.contains("No errors: this version runs"), "{rebuilt}");
    assert!(!rebuilt.contains(" ms"), "{rebuilt}");
}
