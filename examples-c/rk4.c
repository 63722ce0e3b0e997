/* The right-hand side in your own integrator: the Runge–Kutta method with a fixed step. */
#include <math.h>
#include <stdio.h>

#include "pc.h"

enum { DIM = 6 };

/* Writes ydot = f(t, y); returns nonzero where it cannot be evaluated. GSL's odeiv2 takes the same
 * type. */
typedef int (*rhs)(double t, const double *y, double *ydot, void *context);

static int rk4_step(rhs f, void *context, double t, double h, double y[DIM])
{
    static const double NODE[4] = {0.0, 0.5, 0.5, 1.0}, WEIGHT[4] = {1.0, 2.0, 2.0, 1.0};
    double k[DIM] = {0.0}, stage[DIM], sum[DIM] = {0.0};
    int i, s;
    for (s = 0; s < 4; s++) {
        for (i = 0; i < DIM; i++) {
            stage[i] = y[i] + NODE[s] * h * k[i];
        }
        if (f(t + NODE[s] * h, stage, k, context) != 0) {
            return 1;
        }
        for (i = 0; i < DIM; i++) {
            sum[i] += WEIGHT[s] * k[i];
        }
    }
    for (i = 0; i < DIM; i++) {
        y[i] += h * sum[i] / 6.0;
    }
    return 0;
}

int main(void)
{
    /* The state at t = 10, from an integration with 34 digits. */
    static const double REFERENCE[DIM] = {-0.5983375993973925,   -0.1486439622069561, 0.7873354365496211,
                                          -0.06583376642272503, -0.2664489483922874, 3.0};
    const int steps = 20000;
    const double h = 10.0 / steps;
    pc_model *model = NULL;
    pc_system *top = NULL;
    pc_kernel *kernel = NULL;
    pc_error *error = NULL;
    double y[DIM], worst = 0.0;
    int i, failed = 0;

    if (pc_model_builtin("heavy-top-lagrange", &model, &error) != PC_OK ||
        pc_system_new(model, NULL, &top, &error) != PC_OK || pc_kernel_new(top, &kernel, &error) != PC_OK ||
        pc_system_start(top, NULL, y, DIM, &error) != PC_OK) {
        fprintf(stderr, "%s\n", pc_error_message(error));
        failed = 1;
    }
    for (i = 0; i < steps && !failed; i++) {
        failed = rk4_step(pc_kernel_rhs, kernel, i * h, h, y);
    }
    for (i = 0; i < DIM && !failed; i++) {
        worst = fmax(worst, fabs(y[i] - REFERENCE[i]));
    }
    printf("%d steps of Runge and Kutta: off the reference by %.1e\n", steps, worst);
    /* The program pc with tight tolerances agrees within the errors of both methods. */
    printf("pc run heavy-top-lagrange --rtol 1e-13 --atol 1e-15\nt = 10:");
    for (i = 0; i < DIM; i++) {
        printf(" %.17g", y[i]);
    }
    printf("\n");

    pc_error_free(error);
    pc_kernel_free(kernel);
    pc_system_free(top);
    pc_model_free(model);
    /* Order 4 with h = 5e-4: h^4 = 6e-14, times derivatives of order 100, and the rounding of 20000 steps. */
    return failed || worst > 1e-10 ? 1 : 0;
}
