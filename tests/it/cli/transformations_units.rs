//! What is said of a transformation is the same in all units: of an atom in kilograms and metres as of a system of size 1.

use serde_json::Value;

use super::with_file;

/// An oscillator with a force, begun at some place, in units of its own.
struct Oscillator {
    start: [&'static str; 2],
    parameters: [&'static str; 3],
}

const ATOM: Oscillator =
    Oscillator { start: ["1e-11", "1e-24"], parameters: ["1e-27", "1e14", "3e-10"] };
const GRAIN: Oscillator = Oscillator { start: ["1", "1e-6"], parameters: ["1e-6", "1", "1e-7"] };
const UNIT: Oscillator = Oscillator { start: ["1", "0.9"], parameters: ["1.1", "0.8", "0.1"] };

impl Oscillator {
    fn with(&self, position: &str, momentum: &str) -> String {
        let ([x, p], [m, w, f]) = (self.start, self.parameters);
        format!(
            "[coordinates]\nx = {{ initial = {x}, momentum = {p} }}\n[parameters]\nm = {m}\nw = {w}\nF = {f}\n\
             l = {x}\nb = {p}\n[hamiltonian]\nH = \"p_x^2/(2*m) + m*w^2*x^2/2 + F*x\"\n\
             [[transformations]]\nname = \"m\"\nkind = \"explicit\"\nQ = {{ Q = \"{position}\" }}\n\
             P = {{ P = \"{momentum}\" }}\n"
        )
    }
}

fn derived(text: &str) -> Value {
    let words = ["derive", "system.toml", "--format=json"];
    with_file(text, &words).json()["transformations"][0].clone()
}

/// [Q, P] is 2, and 1 with 0.3, 0.01, 0.001 of its terms beside it: none of these is canonical, however small ∂(Q, P)/∂(q, p) is
/// in the units of the file.
#[test]
fn a_map_that_is_not_canonical_is_so_in_no_units() {
    let angle = "atan2(m*w*x, p_x)";
    let action = "p_x^2/(2*m*w) + m*w*x^2/2";
    let cases = [
        (angle.to_owned(), format!("2*({action})"), 0.9),
        (angle.to_owned(), "p_x^2/(2*m*w) + m*w*x^2*1.3/2".to_owned(), 0.1),
        (angle.to_owned(), format!("{action} + 1e-3*m*w*x^2*sin(x/l)"), 1e-4),
        (format!("1.01*{angle}"), action.to_owned(), 0.99e-2),
        ("x + 1e-3*l*sin(p_x/b)*sin(x/l)".to_owned(), "p_x".to_owned(), 1e-4),
    ];
    for system in [ATOM, GRAIN, UNIT] {
        for (position, momentum, least) in &cases {
            let found = derived(&system.with(position, momentum));
            assert_eq!(found["canonical"], false, "{found}");
            assert!(found["residual"].as_f64().expect("a residual") > *least, "{found}");
        }
        let found = derived(&system.with(angle, action));
        assert_eq!((&found["canonical"], &found["proved"]), (&true.into(), &true.into()));
    }
}

/// [Q1, Q2] = −a, which in units of metres and kilograms is small: what it is beside what Q1 and Q2 change is looked at, and
/// nothing is scaled away.
#[test]
fn brackets_of_two_positions_are_judged_in_units_of_their_own() {
    for (place, momentum, a) in [(1.0, 0.7, 1e-3), (5e-11, 1e-25, 5e11), (3e8, 2e20, 1e-15)] {
        let text = format!(
            "[coordinates]\nx = {{ initial = {place:?}, momentum = {momentum:?} }}\n\
             y = {{ initial = {place:?}, momentum = {momentum:?} }}\n[parameters]\na = {a:?}\n\
             [hamiltonian]\nH = \"p_x^2 + p_y^2\"\n[[transformations]]\nname = \"m\"\nkind = \"explicit\"\n\
             Q = {{ Q1 = \"x + a*p_y\", Q2 = \"y\" }}\nP = {{ P1 = \"p_x\", P2 = \"p_y\" }}\n"
        );
        let found = derived(&text);
        assert_eq!(found["canonical"], false, "{found}");
        assert!(found["residual"].as_f64().expect("a residual") > 1e-4, "{found}");
        let symmetric = text.replace("Q2 = \"y\"", "Q2 = \"y + a*p_x\"");
        assert_eq!(derived(&symmetric)["canonical"], true);
    }
}

/// K at the start is H there, which the wrong branch of a root in it, or of the inverse, does not give.
#[test]
fn the_branch_of_k_is_that_of_the_start_in_all_units() {
    let polar = |r: &str, p: &str, angle: &str, m: &str, f: &str| {
        format!(
            "[coordinates]\nr = {{ initial = {r}, momentum = {p} }}\nph = {{ initial = 0.3, momentum = {angle} }}\n\
             [parameters]\nm = {m}\nF = {f}\n[hamiltonian]\nH = \"(p_r^2 + p_ph^2/r^2)/(2*m) + F*r\"\n\
             [[transformations]]\nname = \"c\"\nkind = \"explicit\"\n\
             Q = {{ Q1 = \"r*cos(ph)\", Q2 = \"r*sin(ph)\" }}\n\
             P = {{ P1 = \"p_r*cos(ph) - p_ph*sin(ph)/r\", P2 = \"p_r*sin(ph) + p_ph*cos(ph)/r\" }}\n"
        )
    };
    let left = |system: Oscillator| {
        let text = system.with("x^2/l", "p_x*l/(2*x)");
        text.replacen("initial = ", "initial = -", 1)
    };
    let cases = [
        polar("1.5", "0.2", "0.7", "1", "1"),
        polar("5e-11", "1e-25", "1e-34", "9.1e-31", "1e-8"),
        left(UNIT),
        left(GRAIN),
        left(ATOM),
    ];
    for text in cases {
        let found = derived(&text);
        let k = format!("K={}", found["K"].as_str().unwrap_or_else(|| panic!("no K: {found}")));
        let words = ["run", "system.toml", "--format=json", "--at=0", "--observe", &k];
        let run = with_file(&text, &words).json();
        let columns = run["columns"].as_array().expect("columns");
        let value = |name: &str| {
            let place = columns.iter().position(|c| c == name).expect(name);
            run["rows"][0][place].as_f64().expect("a number")
        };
        let (k, energy) = (value("K"), value("energy"));
        assert!((k - energy).abs() < 1e-12 * energy.abs(), "{k:e} is not {energy:e}: {found}");
        // q of F3 is −∂F3/∂p: −√(l Q) here
        if text.contains("x^2/l") {
            let function = found["generating_functions"]["F3"]["F"].as_str().expect("F3");
            assert!(!function.starts_with('-'), "{function}");
        }
        assert_eq!(found["near_start"], false, "{found}");
    }
}

/// x + 1000 max(0, x − 50) and x + ½(|x − 2| + x − 2) are undone by Q where they begin, and not beyond the kink: that is reported, K in
/// the old variables holds everywhere, and the inverse as a map of its own is solved for.
#[test]
fn an_inverse_that_holds_near_the_start_alone_says_so() {
    let file = |position: &str, momentum: &str, more: &str| {
        format!(
            "[coordinates]\nx = {{ initial = 1, momentum = 0.5 }}\n[hamiltonian]\nH = \"p_x^2/2 + x^2/2\"\n\
             [[transformations]]\nname = \"m\"\nkind = \"explicit\"\nQ = {{ Q = \"{position}\" }}\n\
             P = {{ P = \"{momentum}\" }}\n{more}"
        )
    };
    for (position, momentum) in [
        ("x + 1e3*max(0, x - 50)", "p_x"),
        ("x + 1/2*(abs(x - 2) + x - 2)", "p_x"),
        ("x + max(0, x - 50)", "2*p_x/(3 + sign(x - 50))"),
    ] {
        let found = derived(&file(position, momentum, ""));
        assert_eq!((&found["near_start"], &found["old"]["x"]), (&true.into(), &"Q".into()));
    }
    let canonical = file("x + max(0, x - 50)", "2*p_x/(3 + sign(x - 50))", "");
    let text = with_file(&canonical, &["derive", "system.toml"]).success();
    let says =
        |end: &str| text.lines().any(|line| line.starts_with("  K = ") && line.ends_with(end));
    assert!(says("   (near the start)") && says("   (in the old variables)"), "{text}");
    for (position, momentum) in
        [("2*x + 1", "p_x/2"), ("x^2", "p_x/(2*x)"), ("sinh(x)", "p_x/cosh(x)")]
    {
        let found = derived(&file(position, momentum, ""));
        assert_eq!(found["near_start"], false, "{found}");
    }
    // the image of 90 is 20 beyond the kink at 50
    let back = "[[transformations]]\nname = \"back\"\nkind = \"inverse\"\nof = [\"m\"]\nnew = [\"X\", \"Y\"]\n";
    let text = file("x + max(0, x - 50)", "2*p_x/(3 + sign(x - 50))", back);
    let text = text.replace("initial = 1,", "initial = 40,");
    let words = ["run", "system.toml", "--format=json", "--init=x=90", "--at=0", "--observe=X"];
    let run = with_file(&text, &words).json();
    let last = run["rows"][0].as_array().expect("a row").last().expect("X").as_f64();
    assert!((last.expect("a number") - 70.0).abs() < 1e-9, "{run}");
}

/// H + ∂S/∂t of S = a x − ½ a² t (1 + δ) is −½ δ a², which is δ/2 of its terms, a²/2 and another, in all units.
#[test]
fn what_is_left_of_the_hamilton_jacobi_equation_is_a_part_of_its_terms() {
    for (start, m, wrong, percent) in [
        (["0.3", "0.5"], "1", "1e-9", "5e-8 %"),
        (["0.3", "0.5"], "1", "1e-2", "0.498 %"),
        (["3e-11", "5e-25"], "9e-31", "1e-2", "0.498 %"),
    ] {
        let [x, p] = start;
        let text = format!(
            "[coordinates]\nx = {{ initial = {x}, momentum = {p} }}\n[parameters]\nm = {m}\n[hamiltonian]\n\
             H = \"p_x^2/(2*m)\"\n[hamilton_jacobi]\nconstants = [\"a\"]\nS = \"a*x - a^2/(2*m)*t*(1 + {wrong})\"\n"
        );
        let found = with_file(&text, &["derive", "system.toml", "--format=json"]).json();
        let why = found["hamilton_jacobi"]["why"].as_str().expect("why");
        assert!(why.contains(&format!("up to {percent}")), "{why}");
    }
}
