/* A force computed by the program: a steering torque keeps a slowly rolling disk upright. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "pc.h"

enum { DIM = 8, THETA = 3, W1 = 5, W2 = 6, W3 = 7 }; /* of X, Y, ψ, θ, φ, ω1, ω2, ω3 */

typedef struct {
    double lean, lean_rate, turn; /* gains */
} controller;

static const controller GAINS = {70.0 / 1.5, 25.0 / 1.5, 6.0};
static const double HALF_PI = 1.5707963267948966;
static int freed = 0;

/* Near upright, (A + mr²) δ'' = mgr δ − (C + mr²) ω3 ω2 and A ω2' = C ω3 δ' + Q for the lean δ = θ
 * − π/2. This Q gives ω2' = p δ + q δ' − s ω2, and for ω3 = 1 the three roots −2. */
static int steer(double t, const double *y, size_t y_length, double *q, size_t q_length, void *user)
{
    const controller *c = user;
    const double A = 0.25, C = 0.5;
    (void)t;
    if (y_length != DIM || q_length != 1) {
        return -1; /* ends the integration */
    }
    q[0] = A * (c->lean * (y[THETA] - HALF_PI) + c->lean_rate * y[W1] - c->turn * y[W2]) - C * y[W3] * y[W1];
    return 0;
}

static void forget(void *user)
{
    free(user);
    freed++;
}

/* The disk with ω3 = 1, leaning by 0.1, with or without the controller. */
static pc_system *disk(int steered, pc_error **error)
{
    pc_model *model = NULL;
    pc_system *system = NULL;
    controller *c = malloc(sizeof *c);
    int ok = c && pc_model_builtin("tilted-disk", &model, error) == PC_OK &&
             pc_model_set_start(model, "θ", 1.6707963267948966, error) == PC_OK &&
             pc_model_set_start(model, "ω1", 0.0, error) == PC_OK &&
             pc_model_set_start(model, "ω2", 0.0, error) == PC_OK &&
             pc_model_set_start(model, "ω3", 1.0, error) == PC_OK &&
             (!steered || pc_model_add_external_force(model, "ω2", error) == PC_OK) &&
             pc_system_new(model, NULL, &system, error) == PC_OK;
    pc_model_free(model);
    if (ok && steered) {
        *c = GAINS;
        ok = pc_system_set_force(system, steer, NULL, c, forget, error) == PC_OK; /* frees c from now on */
    } else {
        free(c);
    }
    if (!ok) {
        pc_system_free(system);
        system = NULL;
    }
    return system;
}

/* Integrates to t_end; writes the state there, and E − E(0) − ∫ Q ω2 dt by Simpson's rule. */
static int follow(pc_system *system, double t_end, int steps, int steered, double *y, double *off, pc_error **error)
{
    pc_solver *solver = NULL;
    pc_solver_options options;
    controller same = GAINS;
    double start = 0.0, end = 0.0, work = 0.0, q = 0.0, h = t_end / steps;
    int i, j, ok;
    pc_solver_options_init(&options, sizeof options);
    options.relative_tolerance = 1e-11;
    options.stop_time = t_end; /* so the program pc steps, too */
    ok = pc_system_start(system, NULL, y, DIM, error) == PC_OK &&
         pc_system_energy(system, 0.0, y, DIM, &start, error) == PC_OK &&
         pc_solver_new(system, &options, 0.0, NULL, 0, &solver, error) == PC_OK;
    for (i = 0; ok && i <= steps; i++) {
        ok = i == 0 || pc_solver_advance(solver, i * h, y, DIM, error) == PC_OK;
        if (ok && steered && steer(i * h, y, DIM, &q, 1, &same) == 0) {
            work += (i == 0 || i == steps ? 1.0 : i % 2 ? 4.0 : 2.0) * h / 3.0 * q * y[W2];
        }
        if (ok && i == 800) { /* disk.toml has the torque as an expression */
            printf("pc run disk.toml --set steered=%d --rtol 1e-11 --t-end %g --rows 11\n", steered, t_end);
            for (printf("t = %.17g:", i * h), j = 0; j < DIM; j++) {
                printf(" %.17g%s", y[j], j + 1 < DIM ? "" : "\n");
            }
        }
    }
    ok = ok && pc_system_energy(system, t_end, y, DIM, &end, error) == PC_OK;
    *off = end - start - work;
    pc_solver_free(solver);
    return ok;
}

int main(void)
{
    pc_error *error = NULL;
    double y[DIM], fallen[DIM], off = 1.0, off_free = 1.0;
    pc_system *steered = disk(1, &error), *left_alone = error ? NULL : disk(0, &error);
    int ok = steered && left_alone && follow(steered, 20.0, 8000, 1, y, &off, &error) &&
             follow(left_alone, 0.8, 800, 0, fallen, &off_free, &error);
    if (error) {
        fprintf(stderr, "%s\n", pc_error_message(error));
    } else if (ok) {
        printf("left alone it leans by %.3f after 0.8; steered by %.1e after 20, where energy less work changed by %.1e\n",
               fallen[THETA] - HALF_PI, y[THETA] - HALF_PI, off);
    }
    pc_error_free(error);
    pc_system_free(steered);
    pc_system_free(left_alone);
    /* ω3 tends to 0.978, where the slowest root is −1.09: e^(−21) of the lean remains. The balance
     * has the errors of the tolerance in a few thousand steps, and of Simpson's rule, h = 1/400. */
    return ok && freed == 1 && fabs(y[THETA] - HALF_PI) < 1e-8 && fabs(y[W1]) + fabs(y[W2]) < 1e-7 &&
                   fallen[THETA] - HALF_PI > 0.4 && fabs(off) < 1e-8 && fabs(off_free) < 1e-8
               ? 0
               : 1;
}
