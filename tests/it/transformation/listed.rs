//! The list of views: every transformation of a file, by names of its own.

use phaselab::instrument::Plot;

use super::{Course, shown};

/// Every transformation of a file is in the list of views, also where nothing of the file uses its new variables: one that can be
/// written down, as the inverse of a turn by 0.7, and one that is solved numerically, P + 0.1 P³ + 0.01 P⁵ = p.
#[test]
fn every_transformation_of_the_file_can_be_shown() {
    let text = crate::fixtures::catalog().find("four-generators").unwrap().text.clone();
    let more = "\n[[transformations]]\nname = \"solved\"\nkind = \"F2\"\nF = \"q*(P8 + 0.1*P8^3 + 0.01*P8^5)\"\n\
                new = [\"Q8\", \"P8\"]\n";
    let text = text + more;
    let mut course = Course::with(&text);
    course.go(1.0);
    let lab = course.app.lab.as_ref().expect("a lab");
    let physics = lab.loaded.physics();
    let all = phaselab::instrument::offers(physics);
    for law in &lab.loaded.model.transformations {
        let about = format!("the transformation {}, with the grid of (q, p)", law.name);
        let found = all.iter().find(|(_, offer)| offer.about == about);
        let (kind, offer) = found.unwrap_or_else(|| panic!("{} is not there", law.name));
        assert_eq!(kind.name(), "transformation");
        assert_eq!(offer.columns.len(), 2);
    }
    let (sin, cos) = 0.7_f64.sin_cos();
    let (q, p) = (1.0_f64.cos(), -1.0_f64.sin());
    assert!((course.value("Q6") - (q * cos - p * sin)).abs() < 1e-13);
    let new = course.value("P8");
    assert!((new + 0.1 * new.powi(3) + 0.01 * new.powi(5) - p).abs() < 1e-13, "{new}");
    let image = q * (1.0 + 0.3 * new.powi(2) + 0.05 * new.powi(4));
    assert!((course.value("Q8") - image).abs() < 1e-13);
}

/// Two transformations of a file may call their new variables alike: each is shown by its own name, the turn by 0.3 and the one by 0.8.
#[test]
fn transformations_that_share_the_names_of_their_variables_are_both_shown() {
    let turn = |name: &str, angle: f64| {
        format!(
            "[[transformations]]\nname = \"{name}\"\nkind = \"explicit\"\n\
             Q = {{ Q = \"q*cos({angle}) + p_q*sin({angle})\" }}\nP = {{ P = \"p_q*cos({angle}) - q*sin({angle})\" }}\n"
        )
    };
    let text = format!(
        "title = \"t\"\n[coordinates]\nq = {{ initial = 1.0, momentum = 0.0 }}\n[hamiltonian]\nH = \"p_q^2/2 + q^2/2\"\n{}{}",
        turn("a", 0.3),
        turn("b", 0.8)
    );
    let mut course = Course::with(&text);
    course.go(1.0);
    for (law, angle) in [("a", 0.3_f64), ("b", 0.8)] {
        let lab = course.app.lab.as_mut().expect("a lab");
        let offers = phaselab::instrument::offers(lab.loaded.physics());
        let label = format!("P of {law} against Q of {law}");
        let (kind, offer) =
            offers.into_iter().find(|(_, offer)| offer.label == label).expect(&label);
        let physics = lab.loaded.physics();
        let plot = Plot::new(kind, (offer.columns, None), physics.model).opened(physics);
        assert_eq!(plot.kind.words(&plot, physics), format!("{law}, {label}"));
        lab.plots[0] = plot;
        // q = cos t and p = −sin t
        let time = 1.0 + angle;
        course.go(time);
        assert!((course.value(&format!("Q of {law}")) - (time + angle).cos()).abs() < 1e-13);
        let (grid, words) = shown(&course.app, &course.app.lab.as_ref().unwrap().plots[0]);
        assert_eq!(words[0], "canonical, proved", "{words:?}");
        assert!(grid.len() >= 14, "{}", grid.len());
    }
}
