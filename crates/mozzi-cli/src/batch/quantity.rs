//! What can be asked of many states: the methods of [`Batch`], by name.

use clap::ValueEnum;
use mozzi_batch::{Batch, BatchEnvironment, Error, InstructionSet, Number};

/// The shape of a result at one state.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Shape {
    Number,
    /// n
    Vector,
    /// n × n
    Matrix,
    /// 6 × n, angular rows first
    Jacobian,
    /// 4 × 4
    Pose,
}

impl Shape {
    pub fn of(self, n: usize) -> Vec<usize> {
        match self {
            Shape::Number => vec![],
            Shape::Vector => vec![n],
            Shape::Matrix => vec![n, n],
            Shape::Jacobian => vec![6, n],
            Shape::Pose => vec![4, 4],
        }
    }
}

/// A number that files hold and batches are of.
pub trait Precision: Number {
    /// "f64" or "f32".
    const NAME: &'static str;

    /// A batch of this quantity; a frame that it needs is the end effector. Each input is asked for by its name.
    fn evaluate<'a>(
        batch: &Batch<Self>,
        quantity: Quantity,
        input: &dyn Fn(&'static str) -> &'a [Self],
        surroundings: &BatchEnvironment<Self>,
        outputs: Vec<&mut [Self]>,
    ) -> Result<(), Error>;

    fn write(self, bytes: &mut Vec<u8>);
    fn column(values: Vec<Self>) -> arrow_array::ArrayRef;
    fn to_f64(self) -> f64;
}

/// The batch's methods: name, [frame], inputs, [surroundings], outputs.
macro_rules! methods {
    ($then:ident $($number:ty, $name:literal, $array:ty)?) => { $then! { $($number, $name, $array;)?
        /// τ of θ, θ̇, θ̈
        InverseDynamics inverse_dynamics [] (theta dtheta ddtheta) [surroundings] -> tau Vector;
        /// θ̈ of θ, θ̇, τ
        ForwardDynamics forward_dynamics [] (theta dtheta tau) [surroundings] -> ddtheta Vector;
        /// M of θ
        MassMatrix mass_matrix [] (theta) [] -> M Matrix;
        /// Ṁ of θ, θ̇
        MassMatrixRate mass_matrix_rate [] (theta dtheta) [] -> dM Matrix;
        /// C of θ, θ̇, by Christoffel's symbols
        CoriolisMatrix coriolis_matrix [] (theta dtheta) [] -> C Matrix;
        /// c = C θ̇ of θ, θ̇
        VelocityProduct velocity_product [] (theta dtheta) [] -> c Vector;
        /// g of θ
        GravityForces gravity_forces [] (theta) [surroundings] -> g Vector;
        /// h = c + g, and JᵀF of a wrench, of θ, θ̇
        BiasForces bias_forces [] (theta dtheta) [surroundings] -> h Vector;
        /// JᵀF of θ and the tip's wrench
        TipForces tip_forces [] (theta) [surroundings] -> tau Vector;
        /// ½ θ̇ᵀMθ̇ of θ, θ̇
        KineticEnergy kinetic_energy [] (theta dtheta) [surroundings] -> kinetic_energy Number;
        /// −Σ m gᵀp of θ
        PotentialEnergy potential_energy [] (theta) [surroundings] -> potential_energy Number;
        /// T_sb of θ
        ForwardKinematics forward_kinematics [frame] (theta) [] -> T Pose;
        /// J_s of θ
        SpaceJacobian space_jacobian [frame] (theta) [] -> J Jacobian;
        /// J_b of θ
        BodyJacobian body_jacobian [frame] (theta) [] -> J Jacobian;
        /// dJ_s/dt of θ, θ̇
        SpaceJacobianRate space_jacobian_rate [frame] (theta dtheta) [] -> dJ Jacobian;
        /// dJ_b/dt of θ, θ̇
        BodyJacobianRate body_jacobian_rate [frame] (theta dtheta) [] -> dJ Jacobian;
        /// ∂τ/∂θ, ∂τ/∂θ̇, ∂τ/∂θ̈ = M of θ, θ̇, θ̈
        InverseDynamicsDerivatives inverse_dynamics_derivatives [] (theta dtheta ddtheta) [surroundings]
            -> d_theta Matrix, d_dtheta Matrix, d_ddtheta Matrix;
        /// θ̈ and ∂θ̈/∂θ, ∂θ̈/∂θ̇, ∂θ̈/∂τ = M⁻¹ of θ, θ̇, τ
        ForwardDynamicsDerivatives forward_dynamics_derivatives [] (theta dtheta tau) [surroundings]
            -> ddtheta Vector, d_theta Matrix, d_dtheta Matrix, d_tau Matrix;
    } };
}

macro_rules! declare {
    ($($(#[$doc:meta])* $Name:ident $method:ident [$($frame:ident)?] ($($input:ident)*) [$($surroundings:ident)?] -> $($output:ident $shape:ident),*;)*) => {
        #[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
        pub enum Quantity { $($(#[$doc])* $Name,)* }

        impl Quantity {
            /// Tables of states, in the batch's order.
            pub fn inputs(self) -> &'static [&'static str] {
                match self { $(Quantity::$Name => &[$(stringify!($input)),*],)* }
            }

            pub fn outputs(self) -> &'static [(&'static str, Shape)] {
                match self { $(Quantity::$Name => &[$((stringify!($output), Shape::$shape)),*],)* }
            }

            /// Is it of a frame?
            pub fn is_of_a_frame(self) -> bool {
                match self { $(Quantity::$Name => !stringify!($($frame)?).is_empty(),)* }
            }
        }
    };
}
methods!(declare);

macro_rules! precision {
    ($T:ty, $name:literal, $array:ty; $($(#[$doc:meta])* $Name:ident $method:ident [$($frame:ident)?] ($($input:ident)*) [$($surroundings:ident)?] -> $($output:ident $shape:ident),*;)*) => {
        impl Precision for $T {
            const NAME: &'static str = $name;

            fn evaluate<'a>(
                batch: &Batch<Self>,
                quantity: Quantity,
                input: &dyn Fn(&'static str) -> &'a [Self],
                all: &BatchEnvironment<Self>,
                outputs: Vec<&mut [Self]>,
            ) -> Result<(), Error> {
                let mut outputs = outputs.into_iter();
                match quantity { $(Quantity::$Name => {
                    $(let $output = outputs.next().unwrap_or_default();)*
                    $(let $frame = batch.model().end_effector()?;)?
                    $(let $surroundings = all;)?
                    batch.$method($($frame,)? $(input(stringify!($input)),)* $($surroundings,)? $($output),*)
                })* }
            }

            fn write(self, bytes: &mut Vec<u8>) {
                bytes.extend(self.to_le_bytes());
            }

            fn column(values: Vec<Self>) -> arrow_array::ArrayRef {
                std::sync::Arc::new(<$array>::from(values))
            }

            fn to_f64(self) -> f64 {
                self.into()
            }
        }
    };
}
methods!(precision f64, "f64", arrow_array::Float64Array);
methods!(precision f32, "f32", arrow_array::Float32Array);

impl Quantity {
    /// As on the command line.
    pub fn name(self) -> String {
        self.to_possible_value().map_or(String::new(), |value| value.get_name().to_string())
    }

    /// Does the tip's wrench change it?
    pub fn takes_a_wrench(self) -> bool {
        use Quantity::*;
        let own = [InverseDynamics, ForwardDynamics, BiasForces, TipForces];
        own.contains(&self) || [InverseDynamicsDerivatives, ForwardDynamicsDerivatives].contains(&self)
    }
}

/// Registers by the names that the command line gives them.
pub fn instruction_set(name: &str) -> Result<InstructionSet, String> {
    use InstructionSet::*;
    let all = [Portable, Avx2, Avx512];
    let names = all.map(InstructionSet::name).join(", ");
    all.into_iter().find(|set| set.name() == name).ok_or(format!("expected one of {names}"))
}
