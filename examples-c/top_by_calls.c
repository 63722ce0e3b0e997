/* The same heavy top built call by call, and the parts of its equations. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "pc.h"

static pc_error *error = NULL;

/* Ends the program with the message where a call fails. */
static void must(pc_status status)
{
    if (status != PC_OK) {
        fprintf(stderr, "%s: %s\n", pc_status_name(status), pc_error_message(error));
        exit(1);
    }
}

static int near(double a, double b)
{
    return fabs(a - b) < 1e-14; /* a few operations on numbers of order 1 */
}

int main(void)
{
    pc_model *model;
    pc_system *top;
    double t, energy, y[6], ydot[6], momenta[6], mass[9], c[48];
    int i, ok;

    must(pc_model_new("Heavy top", &model, &error));
    must(pc_model_add_parameter(model, "A", 1.0, &error));
    must(pc_model_add_parameter(model, "C", 0.25, &error));
    must(pc_model_add_parameter(model, "mgl", 1.0, &error));
    must(pc_model_add_coordinate(model, "g1", 0.6, &error));
    must(pc_model_add_coordinate(model, "g2", 0.0, &error));
    must(pc_model_add_coordinate(model, "g3", 0.8, &error));
    must(pc_model_add_quasi_velocity(model, "w1", NULL, 0.1, &error));
    must(pc_model_add_quasi_velocity(model, "w2", NULL, -0.2, &error));
    must(pc_model_add_quasi_velocity(model, "w3", NULL, 3.0, &error));
    must(pc_model_set_kinematics(model, "g1", "g2*w3 - g3*w2", &error));
    must(pc_model_set_kinematics(model, "g2", "g3*w1 - g1*w3", &error));
    must(pc_model_set_kinematics(model, "g3", "g1*w2 - g2*w1", &error));
    must(pc_model_set_algebra(model, "so3", &error));
    must(pc_model_set_kinetic(model, "(A*(w1^2 + w2^2) + C*w3^2)/2", &error));
    must(pc_model_set_potential(model, "mgl*g3", &error));
    must(pc_model_set(model, "C", 0.5, &error));

    /* An unknown name is an error, which leaves the model usable. */
    must(pc_model_add_output(model, "tilt", "acos(g3)", &error));
    if (pc_model_set(model, "D", 1.0, &error) != PC_NOT_FOUND) {
        return 1;
    }
    printf("%s\n", pc_error_message(error));
    pc_error_free(error);

    must(pc_system_new(model, NULL, &top, &error));
    pc_model_free(model); /* The system no longer needs it. */

    must(pc_system_start(top, &t, y, 6, &error));
    must(pc_system_rhs(top, t, y, 6, ydot, 6, &error));
    must(pc_system_energy(top, t, y, 6, &energy, &error));
    must(pc_system_mass_matrix(top, t, y, 6, mass, 9, &error));
    must(pc_system_structure_coefficients(top, t, y, 6, c, 48, &error));
    must(pc_system_to_momenta(top, t, y, 6, momenta, 6, &error));

    /* A w1' = (A - C) w2 w3 + mgl g2, A w2' = (C - A) w1 w3 - mgl g1, C w3' = 0 */
    ok = near(ydot[3], 0.5 * y[4] * y[5] + y[1]) && near(ydot[4], -0.5 * y[3] * y[5] - y[0]) &&
         near(ydot[5], 0.0);
    ok = ok && near(energy, 0.5 * (0.1 * 0.1 + 0.2 * 0.2 + 0.5 * 9.0) + 0.8);
    ok = ok && near(mass[0], 1.0) && near(mass[4], 1.0) && near(mass[8], 0.5) && near(mass[1], 0.0);
    /* [X_1, X_2] = X_3: r = 1, s = 2, m = 3 */
    ok = ok && near(c[(1 * 4 + 2) * 3 + 2], 1.0);
    ok = ok && near(momenta[5], 1.5);
    printf("energy %.6f, momentum about the axis %.6f: %s\n", energy, momenta[5], ok ? "right" : "wrong");
    printf("pc run top.toml\nt = %.17g:", t); /* its first row: the state, the energy */
    for (i = 0; i < 6; i++) {
        printf(" %.17g", y[i]);
    }
    printf(" %.17g\n", energy);
    pc_system_free(top);
    return ok ? 0 : 1;
}
