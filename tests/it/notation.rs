//! The notation of the screen can be typed: `½ m l² θ′²` is `1/2*m*l^2*theta'^2`.

use phaselab::experiment::Derived;
use phaselab::expr::{Expr, Pool, Zero, with_subscripts};
use phaselab::mechanics::Report;
use phaselab::model::{Allowed, Model, Ramped, Scope};
use phaselab::preset::{Catalog, read};

/// A system with the names that the tests use.
const FILE: &str = r#"
title = "Names"

[coordinates]
theta = { symbol = "θ", initial = 1.0 }
x1 = { initial = 0.5 }
x = { initial = 0.5 }

[parameters]
m = 1.0
l = 1.0
g = 9.81
omega0 = { symbol = "φ̇₀", value = 2.0 }

[definitions]
Vmax = "m*g*l*(1 - cos(theta))"

[lagrangian]
L = "1/2*m*l^2*theta'^2 + 1/2*m*x1'^2 + 1/2*m*x'^2 - Vmax - omega0*x1^2"
"#;

fn model() -> Model {
    read(FILE).unwrap().model
}

/// The expression of a text, or its errors with their corrections.
fn typed(model: &Model, pool: &mut Pool, text: &str) -> Result<Expr, Vec<String>> {
    let mut scope = Scope::new(model, Allowed::Observable, "an observable");
    scope.read(pool, text).ok_or_else(|| {
        let errors = scope.diagnostics.iter().map(|m| {
            assert!(text.get(m.span.start..m.span.end).is_some(), "{text}: {m:?}");
            format!("{m}; {}", m.help.clone().unwrap_or_default())
        });
        errors.collect()
    })
}

#[test]
fn the_notation_of_the_screen_means_the_plain_one() {
    let model = model();
    let check = |text: &str, plain: &str| {
        let mut pool = model.pool.clone();
        let e =
            typed(&model, &mut pool, text).unwrap_or_else(|errors| panic!("{text}: {errors:?}"));
        assert_eq!(e, typed(&model, &mut pool, plain).unwrap(), "{text} and {plain}");
        let mut scope = Scope::new(&model, Allowed::Observable, "an observable");
        scope.read(&mut pool, text);
        assert_eq!(scope.plain.as_deref(), Some(plain), "{text}");
        scope.read(&mut pool, plain);
        assert_eq!(scope.plain, None, "{plain} is plain");
    };
    check("ω0² x₁", "omega0^2*x1");
    check("½ m l² θ′²", "1/2*m*l^2*theta'^2");
    check("½ m l² θ̇² − m g l cos θ", "1/2*m*l^2*theta'^2 - m*g*l*cos(theta)");
    check("m g l(1 − cos θ)", "m*g*l*(1 - cos(theta))");
    check("m g l(1 − cos θ)²", "m*g*l*(1 - cos(theta))^2");
    check("2x", "2*x");
    check("3.5 x", "3.5*x");
    check("2sin(x)", "2*sin(x)");
    check("x' x1''", "x'*x1''");
    check("ẋ₁² + ẍ", "x1'^2 + x''");
    check("x₁′ x₁″", "x1'*x1''");
    check("pₓ p_θ", "p_x*p_theta");
    check("φ̇₀ x", "omega0*x");
    check("φ′₀ ω₀", "omega0*omega0");
    check("2(x + 1)", "2*(x + 1)");
    check("(x + 1)(x - 1)", "(x + 1)*(x - 1)");
    check("(x + 1) x1", "(x + 1)*x1");
    check("x (x + 1)", "x*(x + 1)");
    check("sin(2x)", "sin(2*x)");
    check("sin² θ cos θ", "sin(theta)^2*cos(theta)");
    check("sin^2(2 θ)", "sin(2*theta)^2");
    check("arcsin x", "asin(x)");
    check("−g sin θ/l", "-g*sin(theta)/l");
    check("√x m", "sqrt(x)*m");
    check("√(x + 1)/2", "sqrt(x + 1)/2");
    check("|x − 1| |x|", "abs(x - 1)*abs(x)");
    check("ln |x|", "ln(abs(x))");
    check("e^(−x) + e^x m", "exp(-x) + exp(x)*m");
    check("2 π x·m × g", "2*pi*x*m*g");
    check("x⁻² + m 2^x", "x^(-2) + m*2^x");
    check("6.67·10⁻¹¹ x", "6.67e-11*x");
    check("x^½", "x^(1/2)");
    check("m/½", "m/(1/2)");
    check("(m/l) x", "m/l*x");
    check("m/(l x)", "m/(l*x)");
    check("m g/l", "m*g/l");
}

/// What a name directly before a parenthesis means depends on the name.
#[test]
fn what_could_be_read_in_two_ways_is_refused_with_both() {
    let model = model();
    let check = |text: &str, errors: &[&str]| {
        let mut pool = model.pool.clone();
        let diagnostics = typed(&model, &mut pool, text).expect_err(text);
        assert_eq!(diagnostics, errors, "{text}");
    };
    check("m/l x", &["`m/l x` can be read in two ways; write `(m/l) x` or `m/(l x)`"]);
    check("1/2 m", &["`1/2 m` can be read in two ways; write `(1/2) m` or `1/(2 m)`"]);
    check("sin θ x", &["`sin θ x` can be read in two ways; write `sin(θ) x` or `sin(θ x)`"]);
    check("sin² θ x", &["`sin² θ x` can be read in two ways; write `sin²(θ) x` or `sin²(θ x)`"]);
    check("sin 2 x", &["`sin 2 x` can be read in two ways; write `sin(2) x` or `sin(2 x)`"]);
    check("sin x²", &["`sin x²` can be read in two ways; write `sin² x` or `sin(x²)`"]);
    check("sin x^2", &["`sin x^` can be read in two ways; write `(sin x)^...` or `sin(x^...)`"]);
    check("sin x/2", &["`sin x/2` can be read in two ways; write `sin(x)/2` or `sin(x/2)`"]);
    check("sin⁻¹ x", &["`sin⁻¹ x` can be read in two ways; write `1/sin(x)` or `asin(x)`"]);
    check("e^2x", &["`e^2x` can be read in two ways; write `e^2 x` or `e^(2 x)`"]);
    check("√2x", &["`2x` can be read in two ways; write `√(2) x` or `√(2 x)`"]);
    check("√x²", &["`x²` can be read in two ways; write `√(x)²` or `√(x²)`"]);
    check(
        "x 2",
        &[
            "a number comes after what it multiplies; write `2 x` for the product or `x^2` for the power",
        ],
    );
    check("2½", &["two numbers stand side by side; write `2*½` or `2 + ½`"]);
    let function = "; `x` is not a function: what it depends on is not written, `x` alone stands for its value";
    check(
        "x(m + 1)",
        &[&format!(
            "`x(...)` can be read as a product and as a function; write `x*(...)` for the product{function}"
        )],
    );
    check(
        "x(t)",
        &[&format!(
            "`x(...)` can be read as a product and as a function; write `x*(...)` for the product{function}"
        )],
    );
    check(
        "log(x)",
        &[
            "unknown function `log`; write ln(x), the natural logarithm, or ln(x)/ln(10), that to base 10",
        ],
    );
    check(
        "|m |x||",
        &["this `|` may open or close; write abs(...) for an absolute value inside another"],
    );
    check("mgl", &["unknown name `mgl`; names side by side are written apart: `m g l`"]);
    check("cosθ", &["unknown name `cosθ`; names side by side are written apart: `cos θ`"]);
    check("mlsin θ", &["unknown name `mlsin`; names side by side are written apart: `m l sin`"]);
    // several errors are reported at once, and then how the whole of it is written
    let apart = |name: &str, pieces: &str| {
        format!("unknown name `{name}`; names side by side are written apart: `{pieces}`")
    };
    check(
        "mgl*cosθ + 2*mlsin θ",
        &[
            &apart("mgl", "m g l"),
            &apart("cosθ", "cos θ"),
            &format!("{}; all of it: `m g l*cos θ + 2*m l sin θ`", apart("mlsin", "m l sin")),
        ],
    );
    // what could then be read in two ways is enclosed
    check(
        "x/ml + mgl",
        &[
            &apart("ml", "m l"),
            &format!("{}; all of it: `x/(m l) + (m g l)`", apart("mgl", "m g l")),
        ],
    );
    // with another error the whole is not known
    check(
        "mgl + qqq",
        &[
            &apart("mgl", "m g l"),
            "unknown name `qqq`; give it a value in [parameters], or define it in [definitions]",
        ],
    );
    check(
        "sincos",
        &["unknown name `sincos`; give it a value in [parameters], or define it in [definitions]"],
    );
}

#[test]
fn all_doubts_are_reported_at_once_with_the_line() {
    let model = model();
    let mut pool = model.pool.clone();
    let errors = typed(&model, &mut pool, "1/2 m x'^2 + sin θ x - 1/2 q").unwrap_err();
    assert_eq!(errors.len(), 4, "{errors:?}");
    assert!(errors[0].contains("`(1/2) m`"), "{errors:?}");
    assert!(errors[1].contains("`sin(θ) x`"), "{errors:?}");
    let line = "read from left to right, all of it is `1/2*m*x'^2 + sin(θ)*x - 1/2*q`";
    assert!(errors[2].ends_with(line), "{errors:?}");
    assert!(errors[3].starts_with("unknown name `q`"), "{errors:?}");
}

/// The line has to be right as it is printed: what is run together stands apart in it, too.
#[test]
fn the_line_of_doubts_has_what_is_run_together_apart() {
    let model = model();
    let mut pool = model.pool.clone();
    let errors =
        typed(&model, &mut pool, "1/2 (m + l)x'^2 + 1/2 ml^2 theta'^2 + mgl x").unwrap_err();
    assert_eq!(errors.len(), 4, "{errors:?}");
    let line = "1/2*(m + l)*x'^2 + 1/2*m*l^2*theta'^2 + m*g*l*x";
    let reported = format!("read from left to right, all of it is `{line}`");
    assert!(errors[3].ends_with(&reported), "{errors:?}");
    assert_eq!(errors.iter().filter(|error| error.contains("all of it")).count(), 1, "{errors:?}");
    assert!(typed(&model, &mut pool, line).is_ok());
}

/// `T` is an energy or a period, and not a slip for the time.
#[test]
fn an_energy_is_not_taken_for_the_time() {
    let model = model();
    let mut pool = model.pool.clone();
    let errors = typed(&model, &mut pool, "T + x").unwrap_err();
    let help = "give it a value in [parameters], or define it in [definitions]";
    assert_eq!(errors, [format!("unknown name `T`; {help}")]);
}

/// One letter for two names is an error, unless only one of them may stand there.
#[test]
fn a_letter_shown_for_two_names_is_refused() {
    let file = FILE.replace(
        "g = 9.81",
        "g = { value = 1.0, symbol = \"q\" }\na = { value = 1.0, symbol = \"q\" }\ne = 2.0",
    );
    let file = file.replace("- Vmax", "- Vmax - a*x - e*x");
    let model = read(&file).unwrap().model;
    let mut pool = model.pool.clone();
    let errors = typed(&model, &mut pool, "q x").unwrap_err();
    assert_eq!(errors, ["`q` is shown for more than one name; write `a` or `g`"]);
    // `e` of the file is not Euler's number, and what is printed says so
    let own = typed(&model, &mut pool, "e^x").unwrap();
    let euler = typed(&model, &mut pool, "exp(x)").unwrap();
    assert_ne!(own, euler);
    assert_eq!(pool.unicode(euler), "exp x");
    assert_eq!(typed(&model, &mut pool, "exp x"), Ok(euler));
}

/// What the lab prints for the law of every preset, in the letters that the screen shows, is that law when typed.
#[test]
fn what_the_lab_prints_of_every_preset_can_be_typed() {
    let catalog = Catalog::with_folder(None);
    let mut seen = 0;
    for entry in catalog.entries() {
        let model = catalog.find(&entry.name).unwrap().read().unwrap().model;
        let Derived { mut model, mut equations } = Derived::of(model).unwrap();
        equations.find_closed_forms();
        // what is printed has the ramps written out, and the names of their parameters for the values before them
        model.ramped = Ramped::default();
        let report = Report::of(&model, &equations);
        let mut printed = vec![report.law.right, report.energy.right];
        printed.extend(report.hamiltonian.as_ref().ok().map(|line| line.right));
        printed.extend(report.dissipation.iter().map(|line| line.right));
        let mut pool = equations.pool.clone();
        for e in printed.into_iter().filter(|&e| pool.weight(e) < 4_000).collect::<Vec<_>>() {
            let dotted = pool.unicode(e);
            let primed: String = dotted
                .chars()
                .map(|c| match c {
                    '\u{307}' => '′',
                    '\u{308}' => '″',
                    c => c,
                })
                .collect();
            for text in [dotted, primed, pool.text(e)] {
                let again = typed(&model, &mut pool, &text)
                    .unwrap_or_else(|errors| panic!("{}: {text}: {errors:?}", entry.name));
                let difference = pool.sub(again, e);
                let zero = pool.is_zero(difference);
                assert_eq!(zero, Zero::Proved, "{}: {text}", entry.name);
                seen += 1;
            }
        }
    }
    assert!(seen >= 3 * 2 * catalog.entries().len(), "{seen}");
}

/// Equations as a textbook prints them, term by term and factor by factor.
#[test]
fn expressions_are_printed_as_in_a_textbook() {
    let file = r#"
title = "Letters"
[coordinates]
x1 = { initial = 0.5 }
x2 = { initial = 0.5 }
theta = { symbol = "θ", initial = 1.0 }
[parameters]
l = 1.0
m = 1.0
M = 1.0
g = 9.81
a = 1.0
[lagrangian]
L = "1/2*(m + M)*(x1'^2 + x2'^2 + l^2*theta'^2) - m*g*a*cos(theta)"
"#;
    let model = read(file).unwrap().model;
    let mut pool = model.pool.clone();
    let mut differ: Vec<String> = Vec::new();
    let mut check = |plain: &str, unicode: &str, latex: &str| {
        let e = typed(&model, &mut pool, plain).unwrap();
        let written = [pool.unicode(e), pool.latex(e)];
        if written != [unicode, latex] {
            differ.push(format!("{plain}: {written:?}, not {:?}", [unicode, latex]));
        }
        for text in [pool.unicode(e), pool.ascii(e), pool.text(e)] {
            let again = typed(&model, &mut pool, &text).unwrap();
            let difference = pool.sub(again, e);
            assert_eq!(pool.is_zero(difference), Zero::Proved, "{plain}: {text}");
        }
        let text = pool.text(e);
        assert_eq!(typed(&model, &mut pool, &text), Ok(e), "{plain}");
    };
    // quotients of constants stand before functions, masses and g before lengths
    check("-g*sin(theta)/l", "−(g/l) sin θ", r"-\frac{g}{l} \sin \theta");
    check("sin(theta)/x1", "sin θ/x₁", r"\frac{\sin \theta}{x_{1}}");
    check("x1*sin(theta)/l", "x₁ sin θ/l", r"\frac{x_{1} \sin \theta}{l}");
    check(
        "-(g + a*cos(theta))*sin(theta)/l",
        "−(g + a cos θ) sin θ/l",
        r"-\frac{\left(g + a \cos \theta\right) \sin \theta}{l}",
    );
    check("5/7*sin(theta)*g", "(5/7) g sin θ", r"\frac{5}{7} g \sin \theta");
    check("5/7*sin(a)*g", "(5/7) g sin a", r"\frac{5}{7} g \sin a");
    check("l*m*cos(2*theta)*g", "m g l cos(2 θ)", r"m g l \cos\left(2 \theta\right)");
    check("x1'*(m + M)/2", "½ (m + M) x₁′", r"\frac{1}{2} \left(m + M\right) \dot{x_{1}}");
    // the numbers of a sum and before it are as short as they can be
    check(
        "1/2*(x1' - 0.3*x1)^2",
        "½ (x₁′ − 0.3 x₁)²",
        r"\frac{1}{2} {\left(\dot{x_{1}} - \frac{3}{10} x_{1}\right)}^{2}",
    );
    check(
        "m*(1/2*x1'^2 + 1/5*l^2*theta'^2)",
        "½ m (x₁′² + ⅖ l² θ′²)",
        r"\frac{1}{2} m \left({\dot{x_{1}}}^{2} + \frac{2}{5} {l}^{2} {\dot{\theta}}^{2}\right)",
    );
    check(
        "m*(1/2*x1'^2 + 1/4*l^2*theta'^2)",
        "½ m (x₁′² + ½ l² θ′²)",
        r"\frac{1}{2} m \left({\dot{x_{1}}}^{2} + \frac{1}{2} {l}^{2} {\dot{\theta}}^{2}\right)",
    );
    check(
        "(l/2*x1'^2 + 3/4*g*cos(theta))*sin(theta)",
        "¼ (2 l x₁′² + 3 g cos θ) sin θ",
        r"\frac{1}{4} \left(2 l {\dot{x_{1}}}^{2} + 3 g \cos \theta\right) \sin \theta",
    );
    check(
        "m*(3/2*x1'^2 + x2'^2)",
        "½ m (3 x₁′² + 2 x₂′²)",
        r"\frac{1}{2} m \left(3 {\dot{x_{1}}}^{2} + 2 {\dot{x_{2}}}^{2}\right)",
    );
    // halves go below a line that is there
    check("1/2*x1^2/m", "x₁²/(2 m)", r"\frac{{x_{1}}^{2}}{2 m}");
    // common denominators
    check(
        "x1'^2/m + x2'^2/m",
        "(x₁′² + x₂′²)/m",
        r"\frac{{\dot{x_{1}}}^{2} + {\dot{x_{2}}}^{2}}{m}",
    );
    check("g - 2*g/(m*(1/m + 1/M))", "(m − M) g/(m + M)", r"\frac{\left(m - M\right) g}{m + M}");
    check(
        "(x1*cos(theta)/(m + M) + g/l)/(m*cos(theta)^2/(m + M) - 1)",
        "−((m + M) g + l x₁ cos θ)/(l (M + m sin² θ))",
        r"-\frac{\left(m + M\right) g + l x_{1} \cos \theta}{l \left(M + m \sin^{2} \theta\right)}",
    );
    check("m*x1*x2 + M*x1*x2 + a", "(m + M) x₁ x₂ + a", r"\left(m + M\right) x_{1} x_{2} + a");
    check("m*g*a + M*g*a", "(m + M) g a", r"\left(m + M\right) g a");
    // what cancels, or every term has, is not written
    check("x1*m/(m*x2^2 + m)", "x₁/(x₂² + 1)", r"\frac{x_{1}}{{x_{2}}^{2} + 1}");
    check(
        "(m*g*l*sin(theta) + M*l^2*x1)/(m*l^2)",
        "M x₁/m + (g/l) sin θ",
        r"\frac{M x_{1}}{m} + \frac{g}{l} \sin \theta",
    );
    check(
        "(m*x1*x2'^2 - M*x2)/m",
        r"x₁ x₂′² − M x₂/m",
        r"x_{1} {\dot{x_{2}}}^{2} - \frac{M x_{2}}{m}",
    );
    check(
        "x2'^2 - m*x1/l + m*a/l",
        "x₂′² + m (a − x₁)/l",
        r"{\dot{x_{2}}}^{2} + \frac{m \left(a - x_{1}\right)}{l}",
    );
    // terms that combine, and the sign of what is squared
    check(
        "x1'*(x1' - x2) - 1/2*(x1' - x2)^2",
        "½ x₁′² − ½ x₂²",
        r"\frac{1}{2} {\dot{x_{1}}}^{2} - \frac{1}{2} {x_{2}}^{2}",
    );
    check("(a - x1')^2/m", "(x₁′ − a)²/m", r"\frac{{\left(\dot{x_{1}} - a\right)}^{2}}{m}");
    // a quotient that goes without remainder
    check(
        "(x1^2*x2^2 - a^2*(x1^2 + x2^2 - a^2))/(x1^2 - a^2)",
        "x₂² − a²",
        "{x_{2}}^{2} - {a}^{2}",
    );
    check("(M*l + m*l + M*a + m*a)/(m + M)", "l + a", "l + a");
    check("cos(theta)/sin(theta)*x1", "x₁ cot θ", r"x_{1} \cot \theta");
    // what is added to a momentum, and an inverse sum that would only become longer, stay
    check("a/(m + M + g/l^2)", "a/(m + M + g/l²)", r"\frac{a}{m + M + \frac{g}{{l}^{2}}}");
    // squares before products, terms in the order of their variables, the constant last
    check("x2*x1 + x2^2 + x1^2", "x₁² + x₂² + x₁ x₂", "{x_{1}}^{2} + {x_{2}}^{2} + x_{1} x_{2}");
    check("-a - x2 - x1", "−x₁ − x₂ − a", "-x_{1} - x_{2} - a");
    check("a - x1", "a − x₁", "a - x_{1}");
    // one less a constant or a function; a variable stays before the number
    check("a*(1 - l)", "a (1 − l)", r"a \left(1 - l\right)");
    check("x1'^2 - a*(l - 1)", "x₁′² + a (1 − l)", r"{\dot{x_{1}}}^{2} + a \left(1 - l\right)");
    check("g/(1 - l)^3", "g/(1 − l)³", r"\frac{g}{{\left(1 - l\right)}^{3}}");
    check("a*(1 - cos(theta))", "a (1 − cos θ)", r"a \left(1 - \cos \theta\right)");
    check("-a*(x1 - 1)", "−a (x₁ − 1)", r"-a \left(x_{1} - 1\right)");
    check("a*(l - 1)", "a (l − 1)", r"a \left(l - 1\right)");
    check("sqrt(a*(l - 1))", "√(a (l − 1))", r"\sqrt{a \left(l - 1\right)}");
    check("m*sin(theta)^2 + M", "M + m sin² θ", r"M + m \sin^{2} \theta");
    check("-(-x1 - a)", "x₁ + a", "x_{1} + a");
    assert!(differ.is_empty(), "{}", differ.join("\n"));
    // in the letters of a keyboard, too
    let e = typed(&model, &mut pool, "-g*sin(theta)/l").unwrap();
    assert_eq!(pool.ascii(e), "-(g/l)*sin(theta)");
}

#[test]
fn digits_of_single_letters_stand_below_the_line() {
    for (text, shown) in [
        ("F1", "F₁"),
        ("by F1 and F12", "by F₁ and F₁₂"),
        ("Explorer 1", "Explorer 1"),
        ("x1/2", "x₁/2"),
        ("step1", "step1"),
        ("½m v'² − p_x1", "½m v'² − p_x1"),
        ("", ""),
    ] {
        assert_eq!(with_subscripts(text), shown, "{text}");
    }
}

#[test]
fn a_text_of_a_file_is_shown_with_the_names_of_the_screen() {
    let model = model();
    for (text, shown) in [
        ("theta - x1", "θ − x₁"),
        ("omega0/m", "φ̇₀/m"),
        ("theta'*x1'", "θ′·x₁′"),
        ("1e-3*x1", "1e-3·x₁"),
        ("x1e-3", "x1e−3"),
        ("Vmax - sin(theta)", "Vmax − sin(θ)"),
        ("energy of rotation", "energy of rotation"),
        ("theta^2 - x1^-12", "θ² − x₁⁻¹²"),
        ("2^n", "2ⁿ"),
        ("x1^2^3", "x₁^2³"),
        ("x^(1/2)*2^nu*x^2.5", "x^(1/2)·2^nu·x^2.5"),
        ("ψ'", "ψ'"),
        ("", ""),
    ] {
        assert_eq!(model.pool.with_shown_names(text), shown, "{text}");
    }
}

/// A power n stands above the line, and a number before another has a dot between them; both can be typed.
#[test]
fn powers_of_numbers_are_written_as_they_are_typed() {
    let file = FILE.replace("m = 1.0", "m = 1.0\nn = 3.0");
    let model = read(&file).unwrap().model;
    for (plain, shown) in [
        ("40*2^n", "40·2ⁿ"),
        ("x^n", "xⁿ"),
        ("m*2^n", "m·2ⁿ"),
        ("2^(-n)", "2^(−n)"),
        ("x^(n + 1)", "x^(n + 1)"),
    ] {
        let mut pool = model.pool.clone();
        let e = typed(&model, &mut pool, plain).unwrap();
        assert_eq!(pool.unicode(e), shown);
        assert_eq!(typed(&model, &mut pool, shown).unwrap(), e, "{shown}");
    }
}
