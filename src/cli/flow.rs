//! `phaselab flow`: the derivative of a motion by its initial values.

use serde_json::{Map, Value, json};

use super::assignment::number;
use super::decimal::magnitude;
use super::error::CommandError;
use super::interrupt::Interrupt;
use super::run::progress::Bar;
use super::study::{self, Study, StudyArguments, shown, table};
use crate::dynamics::{DynamicsError, FlowMap, PhaseSpace, flow_map};

/// Differentiate a motion with respect to its initial values.
///
/// The tangent map M = ∂η(T)/∂η(0) of the flow, η = (q…, p…), or the variables of brackets, by the
/// variational equations: its determinant beside the one that the divergence of the motion
/// predicts, and the largest entry of |MJMᵀ − J|, which is at rounding where the map is
/// canonical. With a method of fixed step it is the map of that method's own steps. Under constraints it
/// is the map of the displacements that they allow.
#[derive(Debug, clap::Args)]
#[command(after_help = "\
Examples:
  phaselab flow pendulum --until 20
  phaselab flow damped-pendulum --until 5 --format json
  phaselab flow henon-heiles --method rk4 --step 0.1 --until 50")]
pub(super) struct Arguments {
    #[command(flatten)]
    study: StudyArguments,
    /// When to end; by default as the file says, or 10 after the start.
    #[arg(long, value_name = "T", allow_hyphen_values = true, value_parser = number)]
    until: Option<f64>,
}

pub(super) fn execute(arguments: &Arguments, interrupt: &Interrupt) -> Result<(), CommandError> {
    let study = Study::open(&arguments.study, interrupt, PhaseSpace::on_constraints)?;
    let until = study.until(arguments.until);
    interrupt.ends_by_itself(|| ());
    let mut bar = Bar::new(study.start.time, until);
    let method = (study.method, study.settings);
    let found = flow_map(&study.space, method, &study.start, until, &mut |time| bar.show(time));
    drop(bar);
    let mut map = found.map_err(study::failed)?;
    let error = map.error.take().map(DynamicsError::Motion);
    let (object, text) = (object(&study, &map, error.as_ref()), text(&study, &map));
    study::write(&arguments.study, (object, text), error, interrupt)
}

fn object(study: &Study, map: &FlowMap, error: Option<&DynamicsError>) -> Map<String, Value> {
    let mut object = study.head(map.settings);
    let rows: Vec<Vec<f64>> =
        map.matrix.row_iter().map(|row| row.iter().copied().collect()).collect();
    let state = study.named(study.space.variables(&map.state));
    object.insert("variables".to_owned(), json!(study.space.names()));
    object.insert("t".to_owned(), json!(map.time));
    object.insert("state".to_owned(), state);
    object.insert("matrix".to_owned(), json!(rows));
    object.insert("dimension".to_owned(), json!(map.dimension));
    object.insert("determinant".to_owned(), json!(map.determinant));
    object.insert("determinant_expected".to_owned(), json!(map.determinant_expected));
    object.insert("symplectic_residual".to_owned(), json!(map.symplectic_residual));
    object.insert("symplectic_rounding".to_owned(), json!(map.symplectic_rounding));
    object.insert("status".to_owned(), study::status(error).into());
    object.insert("message".to_owned(), json!(error.map(DynamicsError::to_string)));
    object
}

fn text(study: &Study, map: &FlowMap) -> String {
    let names = study.space.names();
    let variables = study.space.variables(&map.state);
    let mut rows = vec![vec!["M".to_owned()]];
    rows[0].extend(names.iter().cloned());
    for (name, row) in names.iter().zip(map.matrix.row_iter()) {
        let mut cells = vec![name.clone()];
        cells.extend(row.iter().map(|&x| shown(x)));
        rows.push(cells);
    }
    let state: Vec<String> =
        names.iter().zip(variables).map(|(name, &x)| format!("{name} = {}", shown(x))).collect();
    let mut text = format!("t = {}: {}\n\n", shown(map.time), state.join(", "));
    text.push_str(&table(&rows));
    text.push('\n');
    if study.space.is_constrained() {
        let (dimension, all) = (map.dimension, names.len());
        text.push_str(&format!(
            "M of the {dimension} of {all} displacements that the constraints allow\n"
        ));
    }
    if let (Some(found), Some(expected)) = (map.determinant, map.determinant_expected) {
        text.push_str(&format!("det M = {}, expected {}\n", shown(found), shown(expected)));
    }
    if let Some(residual) = map.symplectic_residual {
        let form = if study.space.is_constrained() {
            "|MᵀJM − PᵀJP|, P the projection onto them"
        } else {
            "|MJMᵀ − J|"
        };
        let left = match map.symplectic_rounding {
            Some(rounding) => format!("of which rounding may be {rounding:.0e}"),
            None => "next to where M has no limit".to_owned(),
        };
        text.push_str(&format!("largest entry of {form}: {}, {left}\n", magnitude(residual)));
    }
    text
}
