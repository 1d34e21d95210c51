//! `phaselab plot`: tables drawn as text.

use super::{Done, with_file};

/// Draws a table with these options.
fn plotted(table: &str, options: &[&str]) -> Done {
    with_file(table, &[&["plot", "system.toml"], options].concat())
}

/// A table of two columns whose points are the ends of a diagonal and its middle.
const DIAGONAL: &str =
    "# phaselab 0.1.0: A diagonal\n# method: name=taylor\nx,y\n0,0\n5,5\n10,10\n";

fn rows(text: &str) -> Vec<Vec<char>> {
    text.lines().map(|line| line.chars().collect()).collect()
}

#[test]
fn two_columns_are_points_on_axes() {
    let text = plotted(DIAGONAL, &["--ascii", "--size", "60x20"]).success();
    let lines = rows(&text);
    assert_eq!(lines.len(), 20, "{text}");
    assert!(text.starts_with("A diagonal\n") && text.is_ascii(), "{text}");
    assert!(text.contains("10") && text.contains('x') && text.contains('y'), "{text}");
    // the points: one at the lower left, one in the middle, one at the upper right
    let dots = || {
        let inside = lines.iter().enumerate().skip(2).take(15);
        inside.filter_map(|(row, line)| {
            let found = line.iter().rposition(|c| ".'`,-_:\"*".contains(*c))?;
            (found > 8).then_some((row, found))
        })
    };
    let all: Vec<_> = dots().collect();
    assert!(all.len() >= 2 && all[0].1 > all[all.len() - 1].1, "{all:?}\n{text}");
}

/// A lattice of two columns has its third one shaded, from the least to the greatest.
#[test]
fn the_table_of_a_map_is_shaded() {
    let mut table = "a,b,value\n".to_owned();
    for i in 0..20 {
        for j in 0..20 {
            table.push_str(&format!("{i},{j},{}\n", i + j));
        }
    }
    let text = plotted(&table, &["--ascii", "--size", "50x24"]).success();
    assert!(text.starts_with("value: . 0 to # 38"), "{text}");
    let lines = rows(&text);
    let [above, below] = [3, 19].map(|row: usize| lines[row].iter().collect::<String>());
    assert!(above.trim_end().ends_with('#') && !above.contains(" ."), "{text}");
    assert!(below.contains('.') && !below.contains('#'), "{text}");
}

/// Rows of three numbers are points where they are no lattice, however few there are.
#[test]
fn a_table_of_two_rows_is_no_map() {
    for table in ["t,x,y\n0,1,2\n1,3,4\n", "t,x,y\n0,1,2\n1,1,4\n2,3,5\n3,3,5\n"] {
        let text = plotted(table, &["--ascii", "--size", "50x20"]).success();
        assert!(!text.contains(" to # "), "{text}");
    }
    let whole = plotted("a,b,c\n0,1,2\n1,1,4\n0,3,5\n1,3,6\n", &["--ascii"]).success();
    assert!(whole.starts_with("c: . 2 to # 6"), "{whole}");
}

/// The difference of the greatest and the least number may be infinite.
#[test]
fn the_largest_numbers_have_their_shades() {
    let table = "a,b,c\n0,0,-1e308\n0,1,1e308\n1,0,1.7e308\n1,1,-1.7e308\n";
    let text = plotted(table, &["--ascii", "--size", "40x12"]).success();
    let lines = rows(&text);
    // from the upper left: 1e308 and −1.7e308, below −1e308 and 1.7e308
    let shades = |line: &Vec<char>| -> String {
        line.iter().skip(5).filter(|c| ".:+#".contains(**c)).collect()
    };
    let drawn: Vec<String> =
        lines[1..10].iter().map(shades).filter(|line| !line.is_empty()).collect();
    let ends = |line: &String| [line.chars().next(), line.chars().last()].map(Option::unwrap);
    assert_eq!(ends(&drawn[0]), ['#', '.'], "{text}");
    assert_eq!(ends(drawn.last().unwrap()), ['.', '#'], "{text}");
}

/// Between the places of a coarse lattice there are no gaps: each has its quarter.
#[test]
fn a_coarse_map_is_filled() {
    let table = "a,b,c\n0,0,1\n0,1,2\n1,0,3\n1,1,4\n";
    let text = plotted(table, &["--ascii", "--size", "47x20"]).success();
    let inside: Vec<String> =
        rows(&text)[2..17].iter().map(|line| line.iter().skip(6).collect()).collect();
    let shaded = |line: &String| line.trim().chars().all(|c| ".:+#".contains(c));
    assert!(inside.iter().all(|line| line.trim().len() >= 39 && shaded(line)), "{text}");
    let first = inside[1].trim();
    assert!(first.starts_with(":::::::::::::::") && first.ends_with("###############"), "{text}");
}

/// Each line of a spectrum stands on the axis, with its height.
#[test]
fn a_spectrum_is_drawn_as_lines() {
    let json = r#"{"title": "two", "lines": [{"frequency": 1.0, "amplitude": 1.0}, {"frequency": 3.0, "amplitude": 0.01}]}"#;
    let text = plotted(json, &["--size", "40x20"]).success();
    let dots = |line: &Vec<char>| {
        line.iter().skip(5).filter(|c| ('\u{2801}'..='\u{28ff}').contains(*c)).count()
    };
    let tall = rows(&text).iter().filter(|line| dots(line) > 0).count();
    assert!(tall >= 15, "{text}");
}

/// Of a section the columns after those of the crossing are drawn; of a sweep words and what is the same in all rows are not.
#[test]
fn the_columns_of_other_commands_are_found() {
    let axes = |table: &str| {
        let text = plotted(table, &["--ascii", "--size", "40x12"]).success();
        let across = text.lines().find(|line| line.trim_start().starts_with('+')).unwrap();
        // a power of ten stands behind the name
        let bare = |line: &str| line.split(" x1e").next().unwrap().trim().to_owned();
        let across = bare(across).rsplit(' ').next().unwrap().to_owned();
        [across, bare(text.lines().next().unwrap())]
    };
    assert_eq!(axes("orbit,n,t,y,p_y\n1,1,0.5,1,2\n1,2,0.7,1.5,3\n"), ["y", "p_y"]);
    let section = "# section: 2*x rising\norbit,n,t,x,y,p_y\n1,1,0.5,0,1,2\n1,2,0.7,1e-30,1.5,3\n";
    assert_eq!(axes(section), ["y", "p_y"]);
    let sweep = "x0,status,t,x,energy_drift\n0.1,completed,10,1,0\n0.2,completed,10,2,0\n";
    assert_eq!(axes(sweep), ["x0", "x"]);
    // whatever the units of a column are, and of the one beside it; the energy is the same
    let small =
        "orbit,n,t,energy,y,p_y\n1,1,0.5,7,1e-20,2e9\n1,2,0.7,7.000000000000001,1.5e-20,3e9\n";
    assert_eq!(axes(small), ["y", "p_y"]);
    // a coordinate against its momentum, though its rate and another coordinate stand before it
    let lagrangian = "orbit,n,t,y,z,y',z',p_y\n1,1,0.5,1,5,2,3,4\n1,2,0.7,1.5,6,3,4,5\n";
    assert_eq!(axes(lagrangian), ["y", "p_y"]);
    let rates = "orbit,n,t,y,z,y',z'\n1,1,0.5,1,5,2,3\n1,2,0.7,1.5,6,3,4\n";
    assert_eq!(axes(rates), ["y", "y'"]);
    // what was measured over what was set
    let measured = "g,status,t,x,energy_drift,period\n1,completed,10,1,0,4\n2,completed,10,2,0,5\n";
    assert_eq!(axes(measured), ["g", "period"]);
    // nothing but what is the same
    assert_eq!(axes("a,b\n1,2\n1,2\n"), ["a", "b"]);
}

#[test]
fn what_is_no_table_is_refused() {
    let empty = "no row has numbers for all of `a`, `b` and `c`";
    plotted("a,b,c\n1,2,\n3,4,\n", &["--of", "c"]).fails(2, &[empty]);
    let unknown = "unknown column `z`; the columns are x, y";
    plotted(DIAGONAL, &["--x", "z"]).fails(2, &[unknown]);
    plotted(DIAGONAL, &["--size", "9x9"]).fails(2, &["COLUMNSxROWS"]);
    plotted("a,b\none,two\n", &[]).fails(2, &["no row has numbers for both `a` and `b`"]);
    plotted("a\n", &[]).fails(65, &["does not have two columns with rows"]);
}

/// A sweep over two numbers is a map of what was measured.
#[test]
fn a_sweep_over_two_numbers_is_shaded() {
    let table = "g,l,status,t,x,energy_drift,period\n1,1,completed,10,1,0,4\n2,1,completed,10,2,0,5\n\
                 1,2,completed,10,2,0,6\n2,2,completed,10,2,0,7\n";
    let text = plotted(table, &["--ascii"]).success();
    assert!(text.starts_with("period: . 4 to # 7"), "{text}");
    // other axes are points
    let text = plotted(table, &["--ascii", "--x", "period", "--y", "x"]).success();
    assert!(!text.contains(" to # "), "{text}");
}

/// What commands write as JSON is drawn where there is a table in it.
#[test]
fn what_commands_write_as_json_is_drawn() {
    let written = |arguments: &[&str]| {
        let all = [arguments, &["--format", "json"]].concat();
        super::phaselab(&all).success()
    };
    let axes = |json: &str| {
        let text = plotted(json, &["--ascii", "--size", "40x12"]).success();
        let across = text.lines().find(|line| line.trim_start().starts_with('+')).unwrap();
        let across = across.trim_end().rsplit(' ').next().unwrap().to_owned();
        let mut lines = text.lines();
        let title = lines.next().unwrap().trim().to_owned();
        [title, across, lines.next().unwrap().trim().to_owned()]
    };
    let section = written(&["section", "henon-heiles", "--on", "x", "--count", "3"]);
    assert_eq!(axes(&section), ["Henon-Heiles", "y", "p_y"]);
    let lyapunov = written(&["lyapunov", "pendulum", "--until", "10"]);
    assert_eq!(axes(&lyapunov), ["Simple pendulum", "t", "exponent"]);
    let spectrum = written(&["spectrum", "pendulum", "--lines", "3", "--count", "512"]);
    assert_eq!(axes(&spectrum), ["Simple pendulum", "frequency", "log10 amplitude"]);
    let family = written(&["orbit", "pendulum", "--along", "energy=-1:1:3"]);
    assert_eq!(axes(&family), ["Simple pendulum", "energy", "period"]);
    let sweep = written(&["sweep", "pendulum", "--grid", "g=1:2:3", "--until", "1"]);
    assert_eq!(axes(&sweep), ["Simple pendulum", "g", "theta"]);
    // line by line as in one object
    let [whole, lines] = ["json", "jsonl"].map(|format| {
        let run = ["run", "pendulum", "--until", "2", "--format", format];
        plotted(&super::phaselab(&run).success(), &["--ascii"]).success()
    });
    assert_eq!(whole, lines);
}

/// What has no table is refused with what does.
#[test]
fn what_has_no_table_says_what_has_one() {
    let advice = "`lyapunov`, `spectrum` and `orbit --along` with `--format json`";
    let orbit = super::phaselab(&["orbit", "pendulum", "--format", "json"]).success();
    plotted(&orbit, &[]).fails(65, &["it contains no table", advice]);
    for arguments in [&["orbit", "pendulum"], &["lyapunov", "pendulum"]] {
        let report = super::phaselab(arguments).success();
        plotted(&report, &[]).fails(65, &[advice]);
    }
    let text = ["sweep", "pendulum", "--grid", "g=1:2:2", "--until", "1", "--format", "text"];
    plotted(&super::phaselab(&text).success(), &[])
        .fails(65, &["does not have two columns", advice]);
    plotted("{\"columns\": [\"a\", \"b\"], \"rows\": [[1]]}", &[])
        .fails(65, &["one number for each column"]);
    plotted("{\"columns\": ", &[]).fails(65, &["it is not JSON"]);
}
