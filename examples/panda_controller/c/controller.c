#include "controller.h"
#include "panda.h"

int computed_torque(const computed_torque_t *controller, const reference_t *reference, const double theta[7],
                    const double dtheta[7], double tau[7])
{
    double ddtheta[7];
    for (int j = 0; j < 7; j++)
        ddtheta[j] = reference->ddtheta[j] + controller->k_d * (reference->dtheta[j] - dtheta[j]) +
                     controller->k_p * (reference->theta[j] - theta[j]);
    panda_inverse_dynamics(theta, dtheta, ddtheta, tau);
    for (int j = 0; j < 7; j++) {
        const double limit = controller->limits[j];
        if (!(tau[j] - tau[j] == 0.0)) return 1; /* NaN, or infinite */
        if (tau[j] > limit) tau[j] = limit;
        if (tau[j] < -limit) tau[j] = -limit;
    }
    return 0;
}
