//! A surface of section written into a file: that of a view which is there, or of a new view.
//!
//! In: a text, a surface, the place of a view. Out: a text, everything else as its author wrote it. Never here: whether the
//! surface is valid.

use toml_edit::{DocumentMut, Item, Table, TableLike, Value, value};

use super::rewrite::push;

/// A surface of section to be written into a text.
#[derive(Clone, Debug, PartialEq)]
pub struct NewSurface {
    /// What vanishes on it; nothing leaves that of the view.
    pub on: Option<NewZero>,
    /// The quantities of the axes, if others than those of the view.
    pub axes: Option<[String; 2]>,
    /// Which crossings count: `rising`, `falling` or `either`; nothing leaves those of the event.
    pub direction: Option<&'static str>,
}

/// What vanishes on a surface.
#[derive(Clone, Debug, PartialEq)]
pub enum NewZero {
    /// This expression.
    Of(String),
    /// That of the event of this name.
    OfEvent(String),
}

/// The view that a surface belongs to.
#[derive(Clone, Debug, PartialEq)]
pub enum SurfaceView {
    /// The view of this index.
    Known(usize),
    /// A new one, with these quantities on its axes.
    New([String; 2]),
}

impl NewSurface {
    /// A text in which the view has the surface. Its title and the ranges of its axes were those of the one before.
    ///
    /// # Errors
    /// Returns a sentence if the text is not valid TOML, or has no such view or event.
    pub fn written_to(&self, text: &str, view: &SurfaceView) -> Result<String, String> {
        let mut file: DocumentMut = text.parse().map_err(|why| format!("{why}"))?;
        let (on, own) = match &self.on {
            None => (None, None),
            Some(NewZero::Of(on)) => (Some(on.clone()), None),
            Some(NewZero::OfEvent(name)) => {
                let event = event(&file, name);
                let (on, own) = event.ok_or_else(|| format!("unknown event `{name}`"))?;
                (Some(on), own)
            }
        };
        let direction = self.direction.map(str::to_owned).or(own);
        match view {
            SurfaceView::New([x, y]) => {
                let mut table = Table::new();
                table.insert("kind", value("section"));
                table.insert("on", value(on.unwrap_or_default()));
                table.insert("direction", value(direction.unwrap_or_else(|| "rising".to_owned())));
                table.insert("x", value(x.as_str()));
                table.insert("y", value(y.as_str()));
                push(&mut file, "views", table);
            }
            SurfaceView::Known(index) => {
                let views = file.get_mut("views");
                let table: Option<&mut dyn TableLike> = match views {
                    Some(Item::ArrayOfTables(all)) => all.get_mut(*index).map(|table| table as _),
                    Some(Item::Value(Value::Array(all))) => {
                        let table = all.get_mut(*index).and_then(Value::as_inline_table_mut);
                        table.map(|table| table as _)
                    }
                    _ => None,
                };
                let table = table.ok_or_else(|| "the text has no such view".to_owned())?;
                if let Some(on) = on {
                    for key in ["title", "x_range", "y_range"] {
                        table.remove(key);
                    }
                    table.insert("on", value(on));
                    table.remove("direction");
                }
                if let Some(direction) = direction {
                    table.insert("direction", value(direction));
                }
                for (key, quantity) in ["x", "y"].into_iter().zip(self.axes.iter().flatten()) {
                    table.insert(key, value(quantity.as_str()));
                }
            }
        }
        Ok(file.to_string())
    }
}

/// What vanishes at an event, and the direction that the file gives it.
fn event(file: &DocumentMut, name: &str) -> Option<(String, Option<String>)> {
    let read = |table: &dyn TableLike| {
        let text = |key: &str| table.get(key).and_then(Item::as_str).map(str::to_owned);
        (text("name")? == name).then(|| Some((text("when")?, text("direction"))))?
    };
    match file.get("events")? {
        Item::ArrayOfTables(all) => all.iter().find_map(|table| read(table)),
        Item::Value(Value::Array(all)) => {
            all.iter().filter_map(Value::as_inline_table).find_map(|table| read(table))
        }
        _ => None,
    }
}
