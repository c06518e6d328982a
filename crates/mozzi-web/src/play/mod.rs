//! The playground's own functions: robots from dropped files, simulation in real time, inverse kinematics, edits.
//!
//! A command is a JSON object whose `do` names it. Commands read θ and θ̇ from the robot's inputs and write the results
//! there; all other results are in the returned JSON.

mod close;
mod drag;
mod edit;
mod entry;
mod export;
mod files;
mod motors;
mod opened;
mod push;
mod reach;
mod settings;
mod shapes;
mod simulate;

pub(crate) use settings::Settings;

use crate::robot::Robot;
use entry::text;
use serde_json::Value;

impl Robot {
    /// Runs a command, and returns its result:
    ///
    /// | `do` | |
    /// |---|---|
    /// | `set` | `motors`, `omega`, `zeta`, `target`, `ground`, `limits`: how to simulate; `reset`, or `account`, from a result of `step` |
    /// | `step` | `step` (s), `steps`, and a push: simulates; the state goes to the inputs |
    /// | `reach` | `frame`, `goal` (m, in {s}), `keep` (the orientation): θ by inverse kinematics |
    /// | `drag` | `joint`, `frame`, `point` (in the frame), `goal` (in {s}): θ of that joint alone |
    /// | `close` | `hold`: θ that satisfies the constraints |
    /// | `within` | θ within the joints' limits |
    /// | `settle` | puts a floating base on the ground |
    /// | `inertias`, `edit` | the numbers of links and joints, and the description with others |
    /// | `urdf`, `json` | the robot's text |
    ///
    /// # Errors
    /// Text that is no command; the library's errors.
    pub fn play(&mut self, command: &str) -> Result<Value, String> {
        let command: Value =
            serde_json::from_str(command).map_err(|error| format!("the command is not JSON: {error}"))?;
        match text(&command, "do")? {
            "set" => settings::set(self, &command),
            "step" => simulate::step(self, &command),
            "reach" => reach::reach(self, &command),
            "drag" => drag::drag(self, &command),
            "close" => close::close(self, &command),
            "within" => Ok(close::put_within(self)),
            "settle" => close::settle(self),
            "inertias" => edit::numbers(self.model()),
            "edit" => edit::edit(self, &command),
            "urdf" => export::urdf(self.model()),
            "json" => Ok(export::json(self.model())),
            other => Err(format!("`{other}` is not a command")),
        }
    }
}

pub(crate) use opened::open;
