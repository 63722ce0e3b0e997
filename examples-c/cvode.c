/* Your own CVODE with the equations of this library, beside the library's CVODE: a pendulum in
 * Cartesian coordinates, kept on its rod by projection, and its passages of the lowest point. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include <cvode/cvode.h>
#include <nvector/nvector_serial.h>
#include <sundials/sundials_version.h>
#include <sunlinsol/sunlinsol_dense.h>

#include <pc/cvode.h>

enum { DIM = 4, PASSAGES = 5 };

static pc_error *error = NULL;

static void must(pc_status status)
{
    if (status != PC_OK) {
        fprintf(stderr, "%s: %s\n", pc_status_name(status), error ? pc_error_message(error) : "");
        exit(1);
    }
}

static void done(int flag, const char *what)
{
    if (flag < 0) {
        fprintf(stderr, "%s: %d\n", what, flag);
        exit(1);
    }
}

static pc_system *pendulum(void)
{
    pc_model *model;
    pc_system *system;
    must(pc_model_new("Pendulum", &model, &error));
    must(pc_model_add_coordinate(model, "x", 1.0, &error)); /* released at 90 degrees */
    must(pc_model_add_coordinate(model, "y", 0.0, &error));
    must(pc_model_set_kinetic(model, "(x'^2 + y'^2)/2", &error));
    must(pc_model_set_potential(model, "y", &error));
    must(pc_model_add_constraint(model, "rod", "(x^2 + y^2 - 1)/2", &error));
    must(pc_model_add_output(model, "across", "x", &error));
    must(pc_system_new(model, NULL, &system, &error));
    pc_model_free(model);
    return system;
}

int main(void)
{
    /* A quarter of the period is K(sin 45 degrees), the complete elliptic integral of the first kind. */
    static const double QUARTER = 1.85407467730137191843;
    const double tolerance = 1e-10, end = 20.0;
    pc_system *system = pendulum();
    pc_solver *solver;
    pc_solver_options options;
    pc_cvode equations;
    pc_cvode_root bottom = {0, 0.0};
    SUNContext context;
    char version[32];
    double t, start[DIM], inner[DIM], late = 0.0, apart = 0.0, off = 0.0;
    int i, n;

    /* Your CVODE with BDF, Newton's iteration, the Jacobian, projection, a root. */
    must(pc_cvode_init(&equations, system, &error));
    must(pc_system_start(system, &t, start, DIM, &error));
    bottom.observable = pc_system_conserved_count(system); /* the first of the outputs */
    equations.roots = &bottom;
    equations.roots_length = 1;
    done(SUNContext_Create(0, &context), "SUNContext_Create");
    N_Vector y = N_VMake_Serial(DIM, start, context);
    SUNMatrix matrix = SUNDenseMatrix(DIM, DIM, context);
    SUNLinearSolver linear = SUNLinSol_Dense(y, matrix, context);
    void *cvode = CVodeCreate(CV_BDF, context);
    done(CVodeInit(cvode, pc_cvode_rhs, t, y), "CVodeInit");
    done(CVodeSetUserData(cvode, &equations), "CVodeSetUserData");
    done(CVodeSStolerances(cvode, tolerance, tolerance), "CVodeSStolerances");
    done(CVodeSetMaxNumSteps(cvode, 100000), "CVodeSetMaxNumSteps");
    done(CVodeSetLinearSolver(cvode, linear, matrix), "CVodeSetLinearSolver");
    done(CVodeSetJacFn(cvode, pc_cvode_jac), "CVodeSetJacFn");
    done(CVodeSetProjFn(cvode, pc_cvode_proj), "CVodeSetProjFn");
    done(CVodeRootInit(cvode, pc_cvode_root_count(&equations), pc_cvode_roots), "CVodeRootInit");

    /* The library's CVODE, with the same method and tolerance. */
    pc_solver_options_init(&options, sizeof options);
    options.method = PC_BDF;
    options.relative_tolerance = options.absolute_tolerance = tolerance;
    options.stop_time = end; /* so the program pc steps, too */
    must(pc_solver_new(system, &options, 0.0, NULL, 0, &solver, &error));

    done(SUNDIALSGetVersion(version, sizeof version), "SUNDIALSGetVersion");
    printf("SUNDIALS %s here, pc %s with its own\n", version, pc_version());
    for (n = 0; n < PASSAGES; n++) {
        done(CVode(cvode, end, y, &t, CV_NORMAL), "CVode");
        must(pc_solver_advance(solver, t, inner, DIM, &error));
        printf("passage %d at t = %.9f, there x = %.1e by CVODE, %.1e by pc\n", n + 1, t, start[0], inner[0]);
        late = fmax(late, fabs(t - (2 * n + 1) * QUARTER));
        for (i = 0; i < DIM; i++) {
            apart = fmax(apart, fabs(start[i] - inner[i]));
        }
        off = fmax(off, fabs(start[0] * start[0] + start[1] * start[1] - 1.0));
    }
    printf("late by %.1e, apart by %.1e, off the rod by %.1e\n", late, apart, off);
    must(pc_solver_advance(solver, end, inner, DIM, &error));
    printf("pc run rod.toml --method bdf --rtol 1e-10 --atol 1e-10\nt = %.17g: %.17g %.17g %.17g %.17g\n", end,
           inner[0], inner[1], inner[2], inner[3]);

    CVodeFree(&cvode);
    SUNLinSolFree(linear);
    SUNMatDestroy(matrix);
    N_VDestroy(y);
    SUNContext_Free(&context);
    pc_cvode_free(&equations);
    pc_solver_free(solver);
    pc_system_free(system);
    /* A few thousand steps with local errors of 1e-10, which grow; roots have one such error. */
    return late < 1e-6 && apart < 1e-6 && off < 1e-7 ? 0 : 1;
}
