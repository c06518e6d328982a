//! The force of an actuator: (g₀ + g₁l + g₂l̇)u + b₀ + b₁l + b₂l̇, with the length l of its transmission and its
//! control u. Every kind of actuator is a shortcut for the parameters g and b of `<general>`, also in a default class.

use crate::text::context::Context;
use crate::text::element::Element;
use crate::text::number::{NotNumbers, up_to};
use crate::urdf::vocabulary::{NOTHING, Vocabulary};

/// MuJoCo's number of parameters.
const COUNT: usize = 10;

/// The attributes of all kinds of actuators.
pub(crate) const ANY_ACTUATOR: Vocabulary = Vocabulary {
    attributes: &[
        "actdim",
        "actearly",
        "actlimited",
        "actrange",
        "area",
        "armature",
        "bias",
        "biasprm",
        "biastype",
        "body",
        "class",
        "cogging",
        "controller",
        "cranklength",
        "cranksite",
        "ctrllimited",
        "ctrlrange",
        "damping",
        "dampratio",
        "delay",
        "diameter",
        "dynprm",
        "dyntype",
        "ffrange",
        "force",
        "forcelimited",
        "forcerange",
        "fpmax",
        "fvmax",
        "gain",
        "gainprm",
        "gaintype",
        "gear",
        "group",
        "imax",
        "inductance",
        "inheritrange",
        "input",
        "instance",
        "interp",
        "joint",
        "jointinparent",
        "ki",
        "kp",
        "kv",
        "lengthrange",
        "lmax",
        "lmin",
        "lugre",
        "motorconst",
        "name",
        "nominal",
        "nsample",
        "plugin",
        "posrange",
        "range",
        "refsite",
        "resistance",
        "saturation",
        "scale",
        "site",
        "slewmax",
        "slidersite",
        "tausmooth",
        "tendon",
        "thermal",
        "timeconst",
        "user",
        "velrange",
        "vmax",
    ],
    ..NOTHING
};

/// The parameters of an actuator, or those of a default class.
#[derive(Clone, Debug)]
pub(crate) struct Law {
    pub gain: [f64; COUNT],
    pub bias: [f64; COUNT],
    gain_type: String,
    bias_type: String,
    dynamics: String,
    /// The kind whose parameters these are.
    kind: String,
    /// A kind that is no shortcut for these parameters.
    other: Option<String>,
}

impl Default for Law {
    fn default() -> Self {
        let [none, fixed] = ["none", "fixed"].map(str::to_string);
        let mut law = Law {
            gain: [0.0; COUNT],
            bias: [0.0; COUNT],
            gain_type: fixed,
            bias_type: none.clone(),
            dynamics: none,
            kind: "general".to_string(),
            other: None,
        };
        law.gain[0] = 1.0;
        law
    }
}

impl Law {
    /// Takes over the attributes of an element. A default of one kind does not apply to another, but for `general`.
    pub fn apply(&mut self, element: &Element, cx: &mut Context) {
        let mut number = |name| element.number(name, cx);
        if element.name() != "general" {
            if self.kind != "general" && self.kind != element.name() {
                *self = Law::default();
            }
            self.kind = element.name().to_string();
        }
        self.other = None;
        match element.name() {
            "general" => {
                let word = |name: &str| element.attribute(name).map(|value| value.text.to_string());
                let types = [
                    (&mut self.gain_type, "gaintype"),
                    (&mut self.bias_type, "biastype"),
                    (&mut self.dynamics, "dyntype"),
                ];
                for (kept, name) in types {
                    *kept = word(name).unwrap_or(std::mem::take(kept));
                }
                overlay(&mut self.gain, element, "gainprm", cx);
                overlay(&mut self.bias, element, "biasprm", cx);
            }
            "motor" => {
                *self = Law { kind: "motor".to_string(), ..Law::default() };
            }
            kind @ ("position" | "intvelocity") => {
                let kp = number("kp").unwrap_or(self.gain[0]);
                let (kv, ratio, constant) = (number("kv"), number("dampratio"), number("timeconst"));
                (self.gain[0], self.bias[0], self.bias[1]) = (kp, 0.0, -kp);
                // a positive number is a damping ratio
                self.bias[2] = kv.map(|kv| -kv).or(ratio).unwrap_or(self.bias[2]);
                self.types("fixed", "affine", if kind == "intvelocity" { "integrator" } else { "none" });
                if constant.is_some_and(|constant| constant > 0.0) {
                    self.dynamics = "filterexact".to_string();
                }
            }
            "velocity" => {
                let kv = number("kv").unwrap_or(self.gain[0]);
                (self.gain, self.bias) = ([0.0; COUNT], [0.0; COUNT]);
                (self.gain[0], self.bias[2]) = (kv, -kv);
                self.types("fixed", "affine", "none");
            }
            "damper" => {
                let kv = number("kv").unwrap_or(-self.gain[2]);
                self.gain = [0.0; COUNT];
                self.gain[2] = -kv;
                self.types("affine", "none", "none");
            }
            kind => self.other = Some(kind.to_string()),
        }
    }

    fn types(&mut self, gain: &str, bias: &str, dynamics: &str) {
        [self.gain_type, self.bias_type, self.dynamics] = [gain, bias, dynamics].map(str::to_string);
    }

    /// (g₀, g₁, g₂) and (b₀, b₁, b₂).
    ///
    /// # Errors
    /// The reason why the force is no such function.
    pub fn parameters(&self) -> Result<[[f64; 3]; 2], String> {
        if let Some(kind) = &self.other {
            return Err(format!("is of the kind `{kind}`"));
        }
        if self.dynamics != "none" {
            return Err(format!("has a state of its own, `{}`", self.dynamics));
        }
        let three = |list: &[f64; COUNT]| [list[0], list[1], list[2]];
        let gain = match &*self.gain_type {
            "fixed" => [self.gain[0], 0.0, 0.0],
            "affine" => three(&self.gain),
            other => return Err(format!("has a gain of the type `{other}`")),
        };
        match &*self.bias_type {
            "none" => Ok([gain, [0.0; 3]]),
            "affine" => Ok([gain, three(&self.bias)]),
            other => Err(format!("has a bias of the type `{other}`")),
        }
    }
}

/// The first numbers of a list; the rest stays.
fn overlay(list: &mut [f64; COUNT], element: &Element, name: &str, cx: &mut Context) {
    let Some(value) = element.attribute(name) else { return };
    let error = match up_to::<COUNT>(value.text) {
        Ok((numbers, found)) if found <= COUNT => return list[..found].copy_from_slice(&numbers[..found]),
        Ok((_, found)) => NotNumbers::Count { found, expected: COUNT },
        Err(error) => error,
    };
    element.report_numbers(name, &value, error, cx);
}
