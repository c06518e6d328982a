//! Regressors as methods.

use crate::model::{Environment, Error, Model};
use crate::quantities as q;
use nalgebra::{DMatrix, RowDVector};

impl Model<f64> {
    /// Y(θ, θ̇, θ̈), n × p: see [`regressor`](crate::dynamics::regressor()). τ = Y π + JᵀF with π =
    /// [`parameters`](Model::parameters).
    ///
    /// ```
    /// use mozzi::{Description, HomeFrames, SE3, ScrewAxis, Screws, Solid, nalgebra::DVector};
    /// let rod = Solid::Box([1.0, 0.02, 0.02]).inertia(1.0);
    /// let home = [0.5, 1.5, 2.0].map(|x| SE3::translation([x, 0.0, 0.0]));
    /// let S = [0.0, 1.0].map(|x| ScrewAxis::from_line([0.0, -1.0, 0.0], [x, 0.0, 0.0], 0.0).expect("unit"));
    /// let arm = Description::from_screws("arm", HomeFrames::Base(&home), &[rod; 2], Screws::Space(&S))?.build()?;
    ///
    /// let (theta, dtheta, ddtheta) = ([0.3, -0.5], [1.0, 0.2], [0.0, 2.0]);
    /// let Y = arm.regressor(&theta, &dtheta, &ddtheta, &arm.environment())?;
    /// let tau = arm.inverse_dynamics(&theta, &dtheta, &ddtheta, &arm.environment())?;
    /// assert!((Y * DVector::from_vec(arm.parameters()) - tau).amax() < 1e-12);
    /// // of 2 · 10 + 2 · 5 parameters, fifteen combinations can be identified from forces and motions
    /// assert_eq!((arm.parameter_count(), arm.base_parameters().count()), (30, 15));
    /// # Ok::<(), mozzi::Error>(())
    /// ```
    ///
    /// # Errors
    /// [`Error::WrongLength`].
    pub fn regressor(
        &self,
        theta: &[f64],
        dtheta: &[f64],
        ddtheta: &[f64],
        environment: &Environment,
    ) -> Result<DMatrix<f64>, Error> {
        let Y = self.compute(q::Regressor, &[theta, dtheta, ddtheta], environment)?;
        Ok(DMatrix::from_row_slice(self.n(), self.parameter_count(), &Y[0]))
    }

    /// (y_𝒦, y_𝒫) with 𝒦 = y_𝒦 π and 𝒫 = y_𝒫 π + 𝒫₀, under the model's gravity and with {s} at rest: see
    /// [`energy_regressors`](crate::dynamics::energy_regressors).
    ///
    /// # Errors
    /// [`Error::WrongLength`].
    pub fn energy_regressors(
        &self,
        theta: &[f64],
        dtheta: &[f64],
    ) -> Result<(RowDVector<f64>, RowDVector<f64>), Error> {
        let found = self.compute(q::EnergyRegressors, &[theta, dtheta], &self.environment())?;
        let mut found = found.into_iter().map(RowDVector::from_vec);
        let mut next = || found.next().expect("two rows");
        Ok((next(), next()))
    }
}
