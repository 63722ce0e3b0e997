/* Many pendulums at once, each with its own length and amplitude, one of them invalid, on one
 * thread and on all cores. */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "pc.h"

enum { MEMBERS = 64, TIMES = 3, DIM = 2 };

typedef struct {
    double states[MEMBERS][TIMES * DIM];
    size_t seen, failed;
} results;

/* Keeps the result of a member. Members come in order, on the thread of the call. */
static int keep(const pc_member *member, void *user)
{
    results *r = user;
    if (member->number != r->seen || member->dim != DIM) {
        return -1;
    }
    r->seen++;
    if (member->status != PC_OK) {
        printf("member %lu: %s\n", (unsigned long)member->number, member->message);
        r->failed++;
    } else {
        memcpy(r->states[member->number], member->states, sizeof r->states[0]);
    }
    return 0;
}

int main(void)
{
    static double states[MEMBERS][DIM], lengths[MEMBERS];
    static results alone, together;
    const double times[TIMES] = {1.0, 2.0, 5.0};
    pc_model *model = NULL;
    pc_system *pendulum = NULL;
    pc_error *error = NULL;
    pc_solver_options options;
    pc_status status = PC_INTERNAL;
    double worst = 0.0;
    size_t i, j;

    for (i = 0; i < MEMBERS; i++) {
        states[i][0] = 0.02 * (double)(i + 1);
        lengths[i] = 0.5 + 0.01 * (double)i;
    }
    states[7][0] = NAN;
    pc_solver_options_init(&options, sizeof options);
    options.stop_time = times[TIMES - 1]; /* so the program pc steps, too */
    if (pc_model_new("Pendulum", &model, &error) == PC_OK &&
        pc_model_add_parameter(model, "l", 1.0, &error) == PC_OK &&
        pc_model_add_coordinate(model, "theta", 0.5, &error) == PC_OK &&
        pc_model_set_kinetic(model, "l^2*theta'^2/2", &error) == PC_OK &&
        pc_model_set_potential(model, "-9.81*l*cos(theta)", &error) == PC_OK &&
        pc_system_new(model, NULL, &pendulum, &error) == PC_OK &&
        pc_ensemble_run(pendulum, &options, MEMBERS, 0.0, states[0], MEMBERS * DIM, lengths, MEMBERS, times, TIMES, 1,
                        keep, &alone, &error) == PC_OK) {
        status = pc_ensemble_run(pendulum, &options, MEMBERS, 0.0, states[0], MEMBERS * DIM, lengths, MEMBERS, times,
                                 TIMES, 0, keep, &together, &error);
    }
    if (error) {
        fprintf(stderr, "%s\n", pc_error_message(error));
    }
    for (i = 0; status == PC_OK && i < MEMBERS; i++) {
        /* The energy of each divided by m l, l θ'²/2 − g cos θ, is conserved. */
        for (j = 0; i != 7 && j < TIMES; j++) {
            const double *y = together.states[i] + j * DIM;
            worst = fmax(worst, fabs(lengths[i] * y[1] * y[1] / 2 + 9.81 * (cos(states[i][0]) - cos(y[0]))));
        }
    }
    if (status == PC_OK) {
        printf("%lu members, %lu failed, energy within %.1e\n", (unsigned long)together.seen,
               (unsigned long)together.failed, worst);
        for (i = 0; i < MEMBERS; i += MEMBERS - 1) {
            const double *y = together.states[i] + (TIMES - 1) * DIM;
            printf("pc run pendulum.toml --set l=%.17g --set theta0=%.17g\nt = 5: %.17g %.17g\n", lengths[i],
                   states[i][0], y[0], y[1]);
        }
    }
    pc_error_free(error);
    pc_system_free(pendulum);
    pc_model_free(model);
    /* A relative tolerance of 1e-9 over a few hundred steps, with energies of order 10; any number
     * of threads gives the same bits. */
    return status == PC_OK && together.seen == MEMBERS && together.failed == 1 && worst < 1e-5 &&
                   memcmp(&alone, &together, sizeof alone) == 0
               ? 0
               : 1;
}
