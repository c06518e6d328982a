//! A request for a quantity, by name.

use crate::drawn::{self, Drawn};
use mozzi::quantities::{Declaration, INPUTS, LIST, Query, Subject};
use mozzi::{FrameId, Model, TaskFrame, Vec3};
use serde_json::{Map, Value, json};

/// A prepared request and its last outputs.
#[derive(Debug)]
pub struct Request {
    pub text: String,
    pub kind: Kind,
    /// Places in [`INPUTS`].
    pub inputs: Vec<usize>,
    pub outputs: Vec<Output>,
    /// The outputs, one after the other.
    pub numbers: Vec<f64>,
}

#[derive(Debug)]
pub enum Kind {
    /// A quantity from [`LIST`].
    Quantity(Asked),
    /// A drawn quantity from [`drawn::LIST`].
    Drawn(&'static Drawn, Option<FrameId>),
}

/// A quantity with its frame, task or point.
#[derive(Debug)]
pub struct Asked {
    pub index: usize,
    frame: Option<FrameId>,
    coordinates: TaskFrame,
    rows: Vec<usize>,
    point: Vec3,
}

/// Its name, shape and unit.
#[derive(Debug)]
pub struct Output {
    pub name: &'static str,
    pub shape: Vec<usize>,
    pub unit: &'static str,
}

impl Output {
    pub fn length(&self) -> usize {
        self.shape.iter().product()
    }
}

impl Asked {
    pub fn subject(&self) -> Subject<'_> {
        Subject { frame: self.frame, coordinates: self.coordinates, rows: &self.rows, point: self.point }
    }
}

const KEYS: [&str; 5] = ["quantity", "frame", "coordinates", "rows", "about"];

impl Request {
    /// Reads `{"quantity": NAME}`, with `frame`, a task's `rows` and `coordinates` ("body" or "space"), and the point
    /// `about` if the quantity refers to them.
    pub fn parse(text: &str, model: &Model) -> Result<Self, String> {
        let value: Value = serde_json::from_str(text).map_err(|error| format!("the request is not JSON: {error}"))?;
        let Value::Object(entries) = value else { return Err("the request is not a JSON object".into()) };
        if let Some(key) = entries.keys().find(|key| !KEYS.contains(&key.as_str())) {
            return Err(format!("`{key}` is not an entry of a request, expected {}", KEYS.join(", ")));
        }
        let Some(name) = entries.get("quantity").and_then(Value::as_str) else {
            return Err("`quantity` is missing in the request".into());
        };
        let frame = match entries.get("frame") {
            None | Some(Value::Null) => None,
            Some(Value::String(name)) => Some(model.frame(name).map_err(|error| error.to_string())?),
            Some(other) => return Err(format!("`frame` is {other}, expected the name of a frame")),
        };
        let (kind, inputs, outputs) = match drawn::LIST.iter().find(|drawn| drawn.name == name) {
            Some(drawn) => {
                if drawn.of_frame && frame.is_none() {
                    return Err(format!("`frame` is missing in the request for {name}"));
                }
                (Kind::Drawn(drawn, frame), drawn.inputs.to_vec(), (drawn.outputs)(model))
            }
            None => of_list(name, frame, &entries, model)?,
        };
        let place = |name: &str| INPUTS.iter().position(|input| input.name == name);
        let inputs = inputs.into_iter().filter_map(place).collect();
        let numbers = vec![0.0; outputs.iter().map(Output::length).sum()];
        Ok(Request { text: text.into(), kind, inputs, outputs, numbers })
    }

    /// `{"inputs": [name, …], "outputs": [{"name", "shape", "unit"}, …]}`.
    pub fn about(&self) -> Value {
        let output = |output: &Output| json!({ "name": output.name, "shape": output.shape, "unit": output.unit });
        json!({
            "inputs": self.inputs.iter().map(|&place| INPUTS[place].name).collect::<Value>(),
            "outputs": self.outputs.iter().map(output).collect::<Value>(),
        })
    }
}

type Parts = (Kind, Vec<&'static str>, Vec<Output>);

fn of_list(name: &str, frame: Option<FrameId>, entries: &Map<String, Value>, model: &Model) -> Result<Parts, String> {
    let index = Query::named(name).map_err(|error| error.to_string())?.index();
    let declaration: &Declaration = &LIST[index];
    let coordinates = match entries.get("coordinates").map(Value::as_str) {
        None | Some(Some("body")) => TaskFrame::Body,
        Some(Some("space")) => TaskFrame::Space,
        Some(_) => return Err("`coordinates` is unknown, expected \"body\" or \"space\"".into()),
    };
    let rows: Vec<usize> = match entries.get("rows") {
        None => (0..6).collect(),
        Some(rows) => serde_json::from_value(rows.clone()).map_err(|error| format!("`rows`: {error}"))?,
    };
    let point: [f64; 3] = match entries.get("about") {
        None => [0.0; 3],
        Some(point) => serde_json::from_value(point.clone()).map_err(|error| format!("`about`: {error}"))?,
    };
    let asked = Asked { index, frame, coordinates, rows, point: Vec3(point) };
    let mut query: Query = Query::at(index);
    query.subject = asked.subject();
    if declaration.needs_frame() {
        query.check_subject(model).map_err(|error| error.to_string())?;
    }
    let shapes = declaration.outputs.iter().zip(query.shapes(model));
    let outputs = shapes.map(|(output, shape)| Output { name: output.name, shape, unit: output.unit }).collect();
    let inputs = declaration.inputs.iter().map(|input| input.name).collect();
    Ok((Kind::Quantity(asked), inputs, outputs))
}
