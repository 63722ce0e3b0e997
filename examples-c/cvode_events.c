/* The events of a model in your own CVODE: a bouncing ball, restarted by CVodeReInit after each
 * bounce. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include <cvode/cvode.h>
#include <nvector/nvector_serial.h>
#include <sunnonlinsol/sunnonlinsol_fixedpoint.h>

#include <pc/cvode.h>

enum { DIM = 2, BOUNCES = 6 };

static void must(int right, const char *what, const pc_error *error)
{
    if (!right) {
        fprintf(stderr, "%s: %s\n", what, error ? pc_error_message(error) : "refused");
        exit(1);
    }
}

int main(void)
{
    pc_model *model = NULL;
    pc_system *ball = NULL;
    pc_error *error = NULL;
    pc_cvode equations;
    SUNContext context = NULL;
    double t = 0.0, state[DIM], t0 = sqrt(2.0 / 9.81), expected = t0, worst = 0.0;
    int bounce, found, direction;

    must(pc_model_builtin("bouncing-ball", &model, &error) == PC_OK &&
             pc_system_new(model, NULL, &ball, &error) == PC_OK &&
             pc_system_start(ball, &t, state, DIM, &error) == PC_OK &&
             pc_cvode_init(&equations, ball, &error) == PC_OK && SUNContext_Create(0, &context) == 0,
         "the ball", error);
    N_Vector y = N_VMake_Serial(DIM, state, context);
    void *cvode = CVodeCreate(CV_ADAMS, context);
    SUNNonlinearSolver iteration = SUNNonlinSol_FixedPoint(y, 0, context);
    must(CVodeInit(cvode, pc_cvode_rhs, t, y) == 0 && CVodeSetUserData(cvode, &equations) == 0 &&
             CVodeSetNonlinearSolver(cvode, iteration) == 0 && CVodeSStolerances(cvode, 1e-12, 1e-12) == 0,
         "CVODE", NULL);

    /* The model has one root, a falling one. */
    direction = pc_system_event_direction(ball, 0);
    must(CVodeRootInit(cvode, pc_cvode_root_count(&equations), pc_cvode_roots) == 0 &&
             CVodeSetRootDirection(cvode, &direction) == 0,
         "its roots", NULL);

    for (bounce = 0; bounce < BOUNCES; bounce++) {
        must(CVode(cvode, 10.0, y, &t, CV_NORMAL) == CV_ROOT_RETURN && CVodeGetRootInfo(cvode, &found) == 0 && found != 0,
             "a bounce", equations.error);
        printf("%s at t = %.12f, speed %.6f", pc_system_event_name(ball, 0), t, state[1]);
        must(pc_cvode_reset(t, y, 0, &equations) == 0 && CVodeReInit(cvode, t, y) == 0, "the reset", equations.error);
        printf(" -> %.6f\n", state[1]);
        worst = fmax(worst, fabs(t - expected));
        expected += 2.0 * t0 * pow(0.8, bounce + 1); /* flight n takes 2 t0 e^n */
    }
    printf("off the closed form by %.1e\n", worst);

    CVodeFree(&cvode);
    SUNNonlinSolFree(iteration);
    N_VDestroy(y);
    SUNContext_Free(&context);
    pc_cvode_free(&equations);
    pc_system_free(ball);
    pc_model_free(model);
    /* Local errors of 1e-12, times the number of steps and the growth at bounces. */
    return worst < 1e-9 ? 0 : 1;
}
