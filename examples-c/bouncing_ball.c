/* Events: an observer that is called at each bounce, and an event of the program that ends the
 * integration. */
#include <math.h>
#include <stdio.h>

#include "pc.h"

typedef struct {
    size_t bounces;
    double t;     /* of the last bounce */
    double worst; /* deviation from the closed form */
} watch;

/* The ball lands first at t0 = sqrt(2h/g), h = 1; flight n takes 2 t0 e^n, e = 0.8. Returns 0 to
 * continue. */
static int bounce(size_t event, double t, const double *before, const double *after, size_t length, void *user)
{
    watch *w = user;
    const double t0 = sqrt(2.0 / 9.81);
    const double expected = w->bounces == 0 ? t0 : w->t + 2.0 * t0 * pow(0.8, (double)w->bounces);
    (void)length;
    if (event != 0) {
        return 0;
    }
    printf("bounce at t = %.12f, speed %.6f -> %.6f\n", t, before[1], after[1]);
    w->worst = fmax(w->worst, fabs(t - expected));
    w->bounces++;
    w->t = t;
    return 0;
}

/* Zero where the ball is at the height `user` points to. Returns 0. */
static int high(double t, const double *y, size_t length, double *value, void *user)
{
    const double *height = user;
    (void)t;
    (void)length;
    *value = y[0] - *height;
    return 0;
}

int main(void)
{
    pc_model *model = NULL;
    pc_system *ball = NULL;
    pc_solver *solver = NULL;
    pc_error *error = NULL;
    pc_solver_options options;
    pc_status status = PC_INTERNAL;
    watch w = {0, 0.0, 0.0};
    double height = 0.3, y[2] = {0.0, 0.0}, t = 0.0;
    size_t event = 9;

    pc_solver_options_init(&options, sizeof options);
    options.relative_tolerance = 1e-12;
    options.stop_time = 1.2; /* so the program pc steps, too */
    if (pc_model_new("Bouncing ball", &model, &error) == PC_OK &&
        pc_model_add_coordinate(model, "y", 1.0, &error) == PC_OK &&
        pc_model_set_kinetic(model, "y'^2/2", &error) == PC_OK &&
        pc_model_set_potential(model, "9.81*y", &error) == PC_OK &&
        pc_model_add_event(model, "bounce", "y", PC_FALLING, 0, &error) == PC_OK &&
        pc_model_add_event_reset(model, "bounce", "y'", "-0.8*y'", &error) == PC_OK &&
        pc_system_new(model, NULL, &ball, &error) == PC_OK &&
        pc_solver_new(ball, &options, 0.0, NULL, 0, &solver, &error) == PC_OK &&
        pc_solver_observe_events(solver, bounce, &w, &error) == PC_OK &&
        pc_solver_add_event(solver, "caught", PC_RISING, 1, high, NULL, &height, NULL, &error) == PC_OK) {
        /* The integration ends where the ball rises to 0.3 m after the first bounce. */
        status = pc_solver_advance(solver, 1.2, y, 2, &error);
    }
    if (status == PC_EVENT && pc_solver_time(solver, &t, &error) == PC_OK &&
        pc_solver_terminal_event(solver, &event, &error) == PC_OK) {
        printf("%s at t = %.12f, %.6f m high\n", pc_solver_event_name(solver, event), t, y[0]);
        printf("pc run ball.toml --rtol 1e-12 --t-end 1.2\nt = %.17g: %.17g %.17g\n", t, y[0], y[1]);
        /* Then it continues. */
        status = pc_solver_advance(solver, 1.2, y, 2, &error);
        printf("%lu bounces, off the closed form by %.1e\n", (unsigned long)w.bounces, w.worst);
        printf("pc run bouncing-ball --rtol 1e-12 --t-end 1.2\nt = 1.2: %.17g %.17g\n", y[0], y[1]);
    }
    if (error) {
        fprintf(stderr, "%s\n", pc_error_message(error));
    }
    pc_error_free(error);
    pc_solver_free(solver);
    pc_system_free(ball);
    pc_model_free(model);
    /* A tolerance of 1e-12, times the growth of errors in a few hundred steps. */
    return status == PC_OK && event == 1 && w.bounces == 2 && w.worst < 1e-9 ? 0 : 1;
}
