/* The right-hand side in GSL's odeiv2, which takes pc_kernel_rhs directly. */
#include <math.h>
#include <stdio.h>

#include <gsl/gsl_errno.h>
#include <gsl/gsl_odeiv2.h>

#include <pc.h>

enum { DIM = 6 };

int main(void)
{
    /* The state at t = 10, from an integration with 34 digits. */
    static const double REFERENCE[DIM] = {-0.5983375993973925,   -0.1486439622069561, 0.7873354365496211,
                                          -0.06583376642272503, -0.2664489483922874, 3.0};
    pc_model *model = NULL;
    pc_system *top = NULL;
    pc_kernel *kernel = NULL;
    pc_error *error = NULL;
    double t, y[DIM], worst = 0.0;
    int i, flag = GSL_FAILURE;

    if (pc_model_builtin("heavy-top-lagrange", &model, &error) == PC_OK &&
        pc_system_new(model, NULL, &top, &error) == PC_OK && pc_kernel_new(top, &kernel, &error) == PC_OK &&
        pc_system_start(top, &t, y, DIM, &error) == PC_OK) {
        gsl_odeiv2_system equations = {pc_kernel_rhs, NULL, DIM, kernel};
        /* Prince and Dormand's method of order 8; tolerances 1e-12, absolute and relative. */
        gsl_odeiv2_driver *driver =
            gsl_odeiv2_driver_alloc_y_new(&equations, gsl_odeiv2_step_rk8pd, 1e-3, 1e-12, 1e-12);
        flag = driver ? gsl_odeiv2_driver_apply(driver, &t, 10.0, y) : GSL_ENOMEM;
        if (driver) {
            printf("%lu steps of GSL's rk8pd: %s\n", driver->n, gsl_strerror(flag));
            gsl_odeiv2_driver_free(driver);
        }
    } else {
        fprintf(stderr, "%s\n", pc_error_message(error));
    }
    for (i = 0; i < DIM && flag == GSL_SUCCESS; i++) {
        printf("%s = %.12f\n", pc_system_name(top, (size_t)i), y[i]);
        worst = fmax(worst, fabs(y[i] - REFERENCE[i]));
    }
    printf("off the reference by %.1e\n", worst);
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
    /* A few hundred steps with local errors of 1e-12, which grow with time. */
    return flag != GSL_SUCCESS || worst > 1e-9 ? 1 : 0;
}
