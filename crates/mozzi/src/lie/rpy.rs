//! Roll, pitch and yaw of a rotation: the inverse of [`SO3::from_rpy`].

use super::SO3;
use crate::scalar::{Real, Scalar};

impl SO3<f64> {
    /// Roll, pitch and yaw in radians with Rot(z, yaw) Rot(y, pitch) Rot(x, roll) = R, pitch in −π/2 … π/2; accurate
    /// also if the pitch is ±π/2 and only roll ∓ yaw is defined.
    pub fn to_rpy(self) -> [f64; 3] {
        let [[xx, xy, xz], [yx, yy, yz], [zx, ..]] = self.matrix().rows();
        let yaw = Real::atan2(yx, xx);
        let (s, c) = Scalar::sin_cos(yaw);
        // Rot(z, yaw)ᵀ R = Rot(y, pitch) Rot(x, roll)
        [Real::atan2(s * xz - c * yz, c * yy - s * xy), Real::atan2(-zx, c * xx + s * yx), yaw]
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::testing::Random;
    use core::f64::consts::FRAC_PI_2;

    #[test]
    fn the_angles_give_the_rotation_back() {
        let mut random = Random(5);
        for k in 0..200 {
            let [roll, pitch, yaw]: [f64; 3] = random.array();
            let pitch = [pitch, FRAC_PI_2, -FRAC_PI_2, FRAC_PI_2 - 1e-9][k % 4];
            let R = SO3::from_rpy(roll * 3.0, pitch, yaw * 3.0);
            let [roll, pitch, yaw] = R.to_rpy();
            let d = SO3::from_rpy(roll, pitch, yaw).matrix() - R.matrix();
            assert!(d.max_abs() < 1e-15, "{k}");
        }
        assert_eq!(SO3::<f64>::identity().to_rpy(), [0.0; 3]);
    }
}
