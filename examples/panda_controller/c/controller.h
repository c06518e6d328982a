/* A computed-torque controller for a Panda: no allocation, no dependency but panda.h. */
#ifndef CONTROLLER_H
#define CONTROLLER_H

/* Where the arm should be, how fast, and how its speed should change: rad, rad/s, rad/s^2. */
typedef struct {
    double theta[7], dtheta[7], ddtheta[7];
} reference_t;

/* k_p in 1/s^2, k_d in 1/s; limits are what the motors give, in N m. */
typedef struct {
    double k_p, k_d, limits[7];
} computed_torque_t;

/* tau = ID(theta, dtheta, ddtheta_d + k_d e' + k_p e), within the limits. 0, or 1 where a measurement is no number or an angle beyond
   1e6 rad: stop the arm then. */
int computed_torque(const computed_torque_t *controller, const reference_t *reference, const double theta[7],
                    const double dtheta[7], double tau[7]);

#endif
