//! What `check` and `run` say of motions that cannot start: the coordinate, the reason, and numbers of a length that can be read.

use super::with_file;

fn law(coordinates: &str, more: &str, l: &str) -> String {
    format!("title = \"Start\"\n[coordinates]\n{coordinates}\n{more}[lagrangian]\nL = \"{l}\"\n")
}

/// Both commands refuse with these words; `run` with this exit code.
fn refused(text: &str, words: &[&str]) -> String {
    let check = with_file(text, &["check", "system.toml"]);
    let run = with_file(text, &["run", "system.toml", "--until", "3"]);
    assert_eq!((check.code, run.code), (65, 1), "{}\n{}", check.stderr, run.stderr);
    for said in [&check.stderr, &run.stderr] {
        for word in words {
            assert!(said.contains(word), "no `{word}` in: {said}");
        }
        assert!(said.lines().all(|line| line.chars().count() < 250), "{said}");
    }
    check.stderr + &run.stderr
}

#[test]
fn a_constant_mass_that_is_singular_is_named_with_its_coordinates() {
    let massless = law("x = { initial = 1 }", "[parameters]\nm = 0.0\n", "1/2*m*x'^2 - x");
    refused(&massless, &["the mass of the coordinate `x` is 0: `m`"]);
    let two = "x = { initial = 1 }\ny = { initial = 1 }";
    let one_mass = law(two, "", "1/2*(x' + y')^2 - x^2 - y^2");
    refused(&one_mass, &["no mass in L resists the velocities `x'`, `y'` in the ratio 1 : -1"]);
    let two_masses = law(two, "", "1/2*(x' + y')^2 + 1/2*y'^2 - x^2 - y^2");
    with_file(&two_masses, &["check", "system.toml"]).success();
    // masses in units of their own are two, and the reason is another
    let two = "x = { initial = 1 }\ny = { initial = -1 }";
    refused(
        &law(two, "", "1/2*x'^2 + 1/2*1e-13*y'^2 - ln(y)"),
        &["`ln(y)` has no finite value at y = -1"],
    );
}

#[test]
fn a_pole_at_the_start_is_no_matter_of_the_clock() {
    let text = law("x = { initial = \"pi/2\" }", "", "1/2*x'^2 - tan(x)");
    let said = refused(&text, &["`tan(x)` has a pole at x = 1.5707963267948966, up to rounding"]);
    assert!(!said.contains("clock"), "{said}");
    // steps that are short for another reason are
    let fast = law("x = { initial = 1 }", "", "1/2*x'^2 - 1/2*1e40*x^2");
    let run = with_file(&fast, &["run", "system.toml", "--until", "3"]);
    assert_eq!(run.code, 2, "{}", run.stderr);
    assert!(run.stderr.contains("the clock cannot tell steps"), "{}", run.stderr);
}

#[test]
fn a_place_is_given_in_few_digits_and_a_term_without_infinities() {
    let far = law("x = { initial = 1e308, velocity = 1 }", "", "1/2*x'^2 - x^2");
    refused(&far, &["`x^2` has no finite value at x = 1e308"]);
    let edge = law("x = { initial = 1, velocity = 0.3 }", "", "1/2*x'^2 - asin(x/sqrt(x^2))");
    let said = refused(&edge, &["a part of the law has no finite value at x = 1"]);
    assert!(!said.contains("inf*") && !said.contains("NaN"), "{said}");
}

/// A barrier between two numbers is passed unseen, and one of the same width near the start is not: the particle comes back.
#[test]
fn a_barrier_between_two_numbers_is_reported() {
    let run = |from: f64, barrier: &str, method: &str| {
        let text = law(
            &format!("x = {{ initial = {from:?}, velocity = 1 }}"),
            "",
            &format!("1/2*x'^2 - {barrier}"),
        );
        with_file(&text, &["run", "system.toml", "--at", "20", "--method", method])
    };
    for method in ["taylor", "dop853", "leapfrog"] {
        for barrier in ["exp(-((x - 9)/1e-16)^2)", "1e-60/(x - 9)^2"] {
            let done = run(0.0, barrier, method);
            assert!(done.stderr.contains("the energy has a feature at x = 9"), "{}", done.stderr);
        }
        let done = run(0.0, "exp(-((x - 9)/1e-3)^2)", method);
        assert!(!done.stderr.contains("feature"), "{}", done.stderr);
    }
    let text = law("x = { initial = 0, velocity = 1 }", "", "1/2*x'^2 - exp(-((x - 9)/1e-16)^2)");
    let check = with_file(&text, &["check", "system.toml"]);
    assert_eq!(check.code, 0, "{}", check.stderr);
    assert!(
        check.stderr.contains("warning: the energy has a feature at x = 9"),
        "{}",
        check.stderr
    );
    // nearby, where numbers are closer to each other
    let done = run(-0.01, "exp(-(x/1e-16)^2)", "taylor");
    let row: Vec<&str> = done.stdout.lines().last().unwrap().split(',').collect();
    assert!((row[1].parse::<f64>().unwrap() + 19.99).abs() < 1e-12, "{}", done.stdout);
    assert_eq!((done.code, done.stderr.as_str()), (0, ""));
}

/// A constraint whose coefficient is infinite has no direction, and one that has a direction or none by its coordinates alone is singular.
#[test]
fn a_constraint_without_a_value_is_named_with_its_part_and_place() {
    let constraint = |expression: &str, x: &str| {
        let coordinates = format!("x = {{ initial = {x} }}\ny = {{ initial = 0.2 }}");
        let more = format!("[[constraints]]\nname = \"roll\"\nexpression = \"{expression}\"\n");
        law(&coordinates, &more, "1/2*(x'^2 + y'^2) - y")
    };
    for (expression, x, cause) in [
        ("x' - y'/t", "0.3", "`-1/t` has no finite value at t = 0"),
        ("x'*ln(x) - y'", "0", "`ln(x)` has no finite value at x = 0"),
        ("x'*x*ln(x) - y'", "0", "`ln(x)` has no finite value at x = 0"),
        ("y' - sqrt(x - 1)*x'", "0", "sqrt(x - 1)` has no finite value at x = 0"),
        ("y - 0.2 - sqrt(x)", "0", "has no finite value at x = 0"),
    ] {
        let said = refused(&constraint(expression, x), &[cause, "in the constraint `roll`"]);
        assert!(!said.contains("singular"), "{expression}: {said}");
        assert!(said.contains("| expression = "), "{expression}: {said}");
    }
    // a given coordinate counts for that of the file
    let file = constraint("x'*ln(x) - y'", "0.3");
    let run = with_file(&file, &["run", "system.toml", "--at", "1", "--init", "x=0"]);
    let cause = "`ln(x)` has no finite value at x = 0, in the constraint `roll`";
    assert!(run.code == 1 && run.stderr.contains(cause), "{}", run.stderr);
    let singular = refused(&constraint("x^2 - (y - 0.2)^2", "0"), &["singular configuration"]);
    assert!(!singular.contains("no finite value"), "{singular}");
}
