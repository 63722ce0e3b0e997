/* An observer that follows the drift of the integrals, and stops the run when the top has sunk far
 * enough. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "pc.h"

typedef struct {
    pc_system *top;
    size_t count;        /* of conserved quantities */
    size_t observables;  /* of these and the outputs */
    double *start, *now; /* their values */
    double drift;        /* the largest so far */
    double t;            /* of the last call */
    double sunk;         /* height at which to stop */
} watch;

/* Returns 0 to continue. */
static int observe(double t, const double *y, size_t length, void *user)
{
    watch *w = user;
    size_t i;
    if (pc_system_observe(w->top, t, y, length, w->now, w->observables, NULL) != PC_OK) {
        return -1;
    }
    for (i = 0; i < w->count; i++) {
        w->drift = fmax(w->drift, fabs(w->now[i] - w->start[i]));
    }
    w->t = t;
    return y[2] < w->sunk;
}

int main(void)
{
    enum { TIMES = 1000 };
    static double times[TIMES];
    pc_model *model = NULL;
    pc_system *top = NULL;
    pc_solver *solver = NULL;
    pc_error *error = NULL;
    pc_statistics work;
    pc_status status = PC_INTERNAL;
    watch w = {NULL, 0, 0, NULL, NULL, 0.0, 0.0, 0.5};
    double y[6];
    size_t i;

    for (i = 0; i < TIMES; i++) {
        times[i] = 10.0 * ((double)(i + 1) / TIMES);
    }
    if (pc_model_builtin("heavy-top-lagrange", &model, &error) == PC_OK &&
        pc_system_new(model, NULL, &top, &error) == PC_OK &&
        pc_solver_new(top, NULL, 0.0, NULL, 0, &solver, &error) == PC_OK &&
        pc_system_start(top, NULL, y, 6, &error) == PC_OK) {
        w.top = top;
        w.count = pc_system_conserved_count(top);
        w.observables = pc_system_observable_count(top);
        w.start = calloc(w.observables, sizeof *w.start);
        w.now = calloc(w.observables, sizeof *w.now);
        if (w.start && w.now && pc_system_observe(top, 0.0, y, 6, w.start, w.observables, &error) == PC_OK) {
            status = pc_solver_run(solver, times, TIMES, observe, &w, &error);
        }
    }
    if (error) {
        fprintf(stderr, "%s\n", pc_error_message(error));
    }
    if (status == PC_STOPPED && pc_solver_statistics(solver, &work, sizeof work, NULL) == PC_OK &&
        pc_solver_state(solver, y, 6, NULL) == PC_OK) {
        printf("sunk to %.4f at t = %.2f after %lu steps\n", y[2], w.t, (unsigned long)work.steps);
        for (i = 0; i < w.count; i++) {
            printf("  %s stays %.12f\n", pc_system_observable_name(top, i), w.now[i]);
        }
        printf("pc run heavy-top-lagrange --rows %d\nt = %.17g:", TIMES + 1, w.t);
        for (i = 0; i < 6; i++) {
            printf(" %.17g", y[i]);
        }
        for (i = 0; i < w.observables; i++) {
            printf(" %.17g", w.now[i]);
        }
        printf("\n");
    }
    free(w.start);
    free(w.now);
    pc_error_free(error);
    pc_solver_free(solver);
    pc_system_free(top);
    pc_model_free(model);
    /* The top sinks below 0.5 at an output before the end; the drift is that of a relative
     * tolerance of 1e-9. */
    return status == PC_STOPPED && y[2] < 0.5 && y[2] > 0.45 && w.drift < 1e-7 ? 0 : 1;
}
