/* A heavy top from its text: derived, integrated, checked. */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "pc.h"

static const char TEXT[] =
    "[parameters]\n"
    "A = 1.0\n"
    "C = 0.5\n"
    "mgl = 1.0\n"
    "[coordinates]                  # the vertical, in body axes\n"
    "g1 = 0.6\n"
    "g2 = 0.0\n"
    "g3 = 0.8\n"
    "[quasi_velocities]             # the angular velocity, in body axes\n"
    "w1 = 0.1\n"
    "w2 = -0.2\n"
    "w3 = 3.0\n"
    "[kinematics]\n"
    "g1 = 'g2*w3 - g3*w2'\n"
    "g2 = 'g3*w1 - g1*w3'\n"
    "g3 = 'g1*w2 - g2*w1'\n"
    "[algebra]\n"
    "name = 'so3'\n"
    "[lagrangian]\n"
    "kinetic = '(A*(w1^2 + w2^2) + C*w3^2)/2'\n"
    "potential = 'mgl*g3'\n";

/* The state at t = 10, from an integration with 34 digits. */
static const double REFERENCE[6] = {-0.5983375993973925,   -0.1486439622069561, 0.7873354365496211,
                                    -0.06583376642272503, -0.2664489483922874, 3.0};

static pc_error *error = NULL;

static int check(pc_status status)
{
    if (status != PC_OK) {
        fprintf(stderr, "%s: %s\n", pc_status_name(status), pc_error_message(error));
        pc_error_free(error);
    }
    return status == PC_OK;
}

int main(void)
{
    pc_model *model = NULL;
    pc_system *top = NULL;
    pc_solver *solver = NULL;
    char *equations = NULL;
    pc_solver_options options;
    double y[6], worst = HUGE_VAL;
    size_t i;

    /* Closer than the default 1e-9, to be compared with the reference. */
    pc_solver_options_init(&options, sizeof options);
    options.relative_tolerance = 1e-12;
    options.absolute_tolerance = 1e-14;
    options.stop_time = 10.0; /* so the program pc steps, too */

    if (check(pc_model_parse(TEXT, strlen(TEXT), "top", &model, &error)) &&
        check(pc_system_new(model, NULL, &top, &error)) &&
        check(pc_system_print(top, PC_TEXT, &equations, &error)) &&
        check(pc_solver_new(top, &options, 0.0, NULL, 0, &solver, &error)) &&
        check(pc_solver_advance(solver, 10.0, y, 6, &error))) {
        printf("%s\n", equations);
        worst = 0.0;
        for (i = 0; i < 6; i++) {
            printf("%s = %.12f\n", pc_system_name(top, i), y[i]);
            worst = fmax(worst, fabs(y[i] - REFERENCE[i]));
        }
        printf("off the reference by %.1e\n", worst);
        /* The program pc gives the same to the last bit; top.toml has the same text. */
        printf("pc run top.toml --rtol 1e-12 --atol 1e-14\nt = 10:");
        for (i = 0; i < 6; i++) {
            printf(" %.17g", y[i]);
        }
        printf("\n");
    }
    pc_string_free(equations);
    pc_solver_free(solver);
    pc_system_free(top);
    pc_model_free(model);
    /* A few thousand steps with local errors of 1e-12, which grow linearly with time. */
    return worst < 1e-9 ? 0 : 1;
}
