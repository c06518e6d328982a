/* The same as src/main.rs, in C: cc -O2 -I OUT_DIR main.c controller.c OUT_DIR/panda.c OUT_DIR/panda_loaded.c -lm */
#include "controller.h"
#include "panda.h"
#include "panda_loaded.h"
#include <math.h>
#include <stdio.h>
#include <string.h>

typedef void plant_t(const double *theta, const double *dtheta, const double *tau, double *ddtheta, double *pivots);

static const double STEP = 1e-3;
static const double HOME[7] = {0.0, -0.4, 0.0, -2.0, 0.0, 1.6, 0.8};

static reference_t reference(double t)
{
    const double w = 3.14159265358979323846, s = sin(w * t), c = cos(w * t);
    reference_t r;
    for (int j = 0; j < 7; j++) {
        r.theta[j] = HOME[j] + 0.3 * s;
        r.dtheta[j] = 0.3 * w * c;
        r.ddtheta[j] = -0.3 * w * w * s;
    }
    return r;
}

/* One step of Runge and Kutta, the torque held. */
static void step(plant_t *plant, double theta[7], double dtheta[7], const double tau[7])
{
    const double h[4] = {0.0, STEP / 2, STEP / 2, STEP};
    double v[4][7] = {{0}}, a[4][7] = {{0}}, q[7], pivots[7];
    for (int k = 0; k < 4; k++) {
        const int before = k > 0 ? k - 1 : 0;
        double dq[7];
        for (int j = 0; j < 7; j++) {
            q[j] = theta[j] + h[k] * v[before][j];
            dq[j] = dtheta[j] + h[k] * a[before][j];
        }
        plant(q, dq, tau, a[k], pivots);
        memcpy(v[k], dq, sizeof dq);
    }
    for (int j = 0; j < 7; j++) {
        theta[j] += STEP * (v[0][j] + 2 * v[1][j] + 2 * v[2][j] + v[3][j]) / 6;
        dtheta[j] += STEP * (a[0][j] + 2 * a[1][j] + 2 * a[2][j] + a[3][j]) / 6;
    }
}

int main(void)
{
    const computed_torque_t controller = {400.0, 40.0, {87, 87, 87, 87, 12, 12, 12}};
    const char *names[2] = {"known arm", "0.5 kg more"};
    plant_t *plants[2] = {panda_forward_dynamics, panda_loaded_forward_dynamics};
    for (int p = 0; p < 2; p++) {
        double theta[7], dtheta[7] = {0}, tau[7], squares = 0.0;
        for (int j = 0; j < 7; j++) theta[j] = HOME[j] + 0.05; /* 0.05 rad beside the reference, at rest */
        for (int k = 0; k < 4000; k++) {
            const reference_t now = reference(k * STEP);
            if (computed_torque(&controller, &now, theta, dtheta, tau)) {
                printf("%s: stopped at %g s\n", names[p], k * STEP);
                return 1;
            }
            for (int j = 0; j < 7 && k >= 2000; j++)
                squares += (theta[j] - now.theta[j]) * (theta[j] - now.theta[j]);
            step(plants[p], theta, dtheta, tau);
        }
        printf("%s: %.6e rad from the reference in the last two seconds (rms)\n", names[p], sqrt(squares / (2000 * 7.0)));
    }
    return 0;
}
