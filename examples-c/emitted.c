/* A program with the source that emit.c has written, without the library: the Runge–Kutta method on
 * top_rhs. */
#include <math.h>
#include <stdio.h>

#include "top.h"

int main(void)
{
    /* The state at t = 10, from an integration with 34 digits. */
    static const double REFERENCE[TOP_DIM] = {-0.5983375993973925,   -0.1486439622069561, 0.7873354365496211,
                                              -0.06583376642272503, -0.2664489483922874, 3.0};
    static const double NODE[4] = {0.0, 0.5, 0.5, 1.0}, WEIGHT[4] = {1.0, 2.0, 2.0, 1.0};
    const double *p = top_default_parameters;
    const int steps = 20000;
    const double h = TOP_T_END / steps;
    double y[TOP_DIM], k[TOP_DIM] = {0.0}, stage[TOP_DIM], sum[TOP_DIM], worst = 0.0, drift;
    int i, n, s;

    for (i = 0; i < TOP_DIM; i++) {
        y[i] = top_start[i];
    }
    for (n = 0; n < steps; n++) {
        for (i = 0; i < TOP_DIM; i++) {
            sum[i] = 0.0;
        }
        for (s = 0; s < 4; s++) {
            for (i = 0; i < TOP_DIM; i++) {
                stage[i] = y[i] + NODE[s] * h * k[i];
            }
            top_rhs(n * h + NODE[s] * h, stage, p, k);
            for (i = 0; i < TOP_DIM; i++) {
                sum[i] += WEIGHT[s] * k[i];
            }
        }
        for (i = 0; i < TOP_DIM; i++) {
            y[i] += h * sum[i] / 6.0;
        }
    }
    for (i = 0; i < TOP_DIM; i++) {
        printf("%s = %.12f\n", top_names[i], y[i]);
        worst = fmax(worst, fabs(y[i] - REFERENCE[i]));
    }
    drift = fabs(top_energy(TOP_T_END, y, p) - top_energy(TOP_T_START, top_start, p));
    printf("off the reference by %.1e, energy drift %.1e\n", worst, drift);
    /* The program pc with tight tolerances agrees within the errors of both methods. */
    printf("pc run heavy-top-lagrange --rtol 1e-13 --atol 1e-15\nt = 10:");
    for (i = 0; i < TOP_DIM; i++) {
        printf(" %.17g", y[i]);
    }
    printf("\n");
    /* Order 4 with h = 5e-4: h^4 = 6e-14, times derivatives of order 100, and the rounding of 20000 steps. */
    return worst < 1e-10 && drift < 1e-10 ? 0 : 1;
}
