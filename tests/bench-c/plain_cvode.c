/* CVODES as a C programmer uses it, right-hand sides by hand: what `bench solve` compares our runs with.
 *
 * plain_cvode SYSTEM RTOL ATOL integrates once for each number of standard input, from its start times that number, and
 * answers with the nanoseconds it took, from creation to destruction of the solver, the numbers of steps and
 * evaluations, and the state at the end. */
#define _POSIX_C_SOURCE 199309L

#include <cvodes/cvodes.h>
#include <math.h>
#include <nvector/nvector_serial.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sunlinsol/sunlinsol_dense.h>
#include <sunmatrix/sunmatrix_dense.h>
#include <sunnonlinsol/sunnonlinsol_fixedpoint.h>
#include <time.h>

enum { MOST = 32, LINKS = 16 };

struct system {
    const char *name;
    int size;
    double start[MOST];
    double end;
    CVRhsFn rhs;
    CVLsJacFn jacobian; /* of those that are stiff */
};

/* Lagrange's top, y = (γ, ω): γ̇ = γ × ω, I ω̇ = Iω × ω + γ × r, I = diag(1, 1, ½), mg r = (0, 0, 1). */
static int top(sunrealtype t, N_Vector state, N_Vector rate, void *user) {
    const double *y = NV_DATA_S(state);
    double *dy = NV_DATA_S(rate);
    (void)t;
    (void)user;
    dy[0] = y[1] * y[5] - y[2] * y[4];
    dy[1] = y[2] * y[3] - y[0] * y[5];
    dy[2] = y[0] * y[4] - y[1] * y[3];
    dy[3] = 0.5 * y[4] * y[5] + y[1];
    dy[4] = -0.5 * y[3] * y[5] - y[0];
    dy[5] = 0.0;
    return 0;
}

/* A disk that rolls tilted, y = (X, Y, ψ, θ, φ, ω1, ω2, ω3), m = r = 1, A = ¼, C = ½, g = 10. */
static int disk(sunrealtype t, N_Vector state, N_Vector rate, void *user) {
    const double *y = NV_DATA_S(state);
    double *dy = NV_DATA_S(rate);
    double sin_psi = sin(y[2]), cos_psi = cos(y[2]), sin_theta = sin(y[3]), cos_theta = cos(y[3]);
    double precession = y[6] / sin_theta, turn = precession * cos_theta, roll = turn - y[7];
    (void)t;
    (void)user;
    dy[0] = roll * cos_psi;
    dy[1] = roll * sin_psi;
    dy[2] = precession;
    dy[3] = y[5];
    dy[4] = -roll;
    dy[5] = (0.2 * turn - 1.2 * y[7]) * y[6] - 8.0 * cos_theta;
    dy[6] = y[5] * (2.0 * y[7] - turn);
    dy[7] = y[5] * y[6] * (2.0 / 3.0);
    return 0;
}

/* A pendulum of 16 unit links and masses, y = (θ, θ̇), g = 10: M = L D Lᵀ. */
static int pendulum(sunrealtype t, N_Vector state, N_Vector rate, void *user) {
    const double *angle = NV_DATA_S(state), *turn = angle + LINKS;
    double *velocity = NV_DATA_S(rate), *x = velocity + LINKS;
    double s[LINKS], c[LINKS], m[LINKS][LINKS], reciprocal[LINKS], below_s[LINKS], below_c[LINKS];
    double sum_s = 0.0, sum_c = 0.0, above_s = 0.0, above_c = 10.0;
    int i, j, k;
    (void)t;
    (void)user;
    for (i = 0; i < LINKS; i++) {
        velocity[i] = turn[i];
        s[i] = sin(angle[i]);
        c[i] = cos(angle[i]);
    }
    for (i = LINKS - 1; i >= 0; i--) {
        double pull = (LINKS - i) * turn[i] * turn[i];
        below_s[i] = sum_s;
        below_c[i] = sum_c;
        sum_s += pull * s[i];
        sum_c += pull * c[i];
    }
    for (i = 0; i < LINKS; i++) {
        double square = turn[i] * turn[i], weight = LINKS - i;
        above_s += square * s[i];
        above_c += square * c[i];
        x[i] = c[i] * (weight * above_s + below_s[i]) - s[i] * (weight * above_c + below_c[i]);
        for (j = i; j < LINKS; j++) m[i][j] = (LINKS - j) * (c[i] * c[j] + s[i] * s[j]);
    }
    for (j = 0; j < LINKS; j++) {
        reciprocal[j] = 1.0 / m[j][j];
        for (i = j + 1; i < LINKS; i++) {
            double factor = m[j][i] * reciprocal[j];
            m[i][j] = factor;
            for (k = i; k < LINKS; k++) m[i][k] -= factor * m[j][k];
            x[i] -= factor * x[j];
        }
    }
    for (i = 0; i < LINKS; i++) x[i] *= reciprocal[i];
    for (i = LINKS - 1; i > 0; i--)
        for (j = 0; j < i; j++) x[j] -= m[i][j] * x[i];
    return 0;
}

/* A sleigh steered by a stiff spring and damper, y = (X, Y, φ, v, ω), m = J = 1, a = ½, K = D = 1.25e6. */
static int sleigh(sunrealtype t, N_Vector state, N_Vector rate, void *user) {
    const double *y = NV_DATA_S(state);
    double *dy = NV_DATA_S(rate);
    double v = y[3], w = y[4];
    double drive = 2.0 * sin(2.0 * t) - 0.2 * v - (0.5 + 0.5 * exp(-4.0 * v * v)) * tanh(10.0 * v);
    (void)user;
    dy[0] = v * cos(y[2]);
    dy[1] = v * sin(y[2]);
    dy[2] = w;
    dy[3] = 0.5 * w * w + drive;
    dy[4] = -0.4 * v * w - 1e6 * (y[2] - 0.5 * sin(t)) - 1e6 * w;
    return 0;
}

static int sleigh_jacobian(sunrealtype t, N_Vector state, N_Vector rate, SUNMatrix matrix, void *user, N_Vector a,
                           N_Vector b, N_Vector c) {
    const double *y = NV_DATA_S(state);
    double v = y[3], w = y[4], e = exp(-4.0 * v * v), h = tanh(10.0 * v);
    (void)t;
    (void)rate;
    (void)user;
    (void)a;
    (void)b;
    (void)c;
    SUNMatZero(matrix);
    SM_ELEMENT_D(matrix, 0, 2) = -v * sin(y[2]);
    SM_ELEMENT_D(matrix, 0, 3) = cos(y[2]);
    SM_ELEMENT_D(matrix, 1, 2) = v * cos(y[2]);
    SM_ELEMENT_D(matrix, 1, 3) = sin(y[2]);
    SM_ELEMENT_D(matrix, 2, 4) = 1.0;
    SM_ELEMENT_D(matrix, 3, 3) = -0.2 + 4.0 * v * e * h - (5.0 + 5.0 * e) * (1.0 - h * h);
    SM_ELEMENT_D(matrix, 3, 4) = w;
    SM_ELEMENT_D(matrix, 4, 2) = -1e6;
    SM_ELEMENT_D(matrix, 4, 3) = -0.4 * w;
    SM_ELEMENT_D(matrix, 4, 4) = -0.4 * v - 1e6;
    return 0;
}

static const struct system systems[] = {
    {"top", 6, {0.6, 0.0, 0.8, 0.1, -0.2, 3.0}, 100.0, top, NULL},
    {"disk", 8, {0.0, 0.0, 0.0, 1.2, 0.0, 0.2, 0.5, 4.0}, 100.0, disk, NULL},
    {"pendulum", 32, {0.2, 0.2, 0.2, 0.2, 0.2, 0.2, 0.2, 0.2, 0.2, 0.2, 0.2, 0.2, 0.2, 0.2, 0.2, 0.2}, 10.0, pendulum, NULL},
    {"sleigh", 5, {0.0, 0.0, 0.3, 1.0, 1.0}, 5.0, sleigh, sleigh_jacobian},
};

static double now(void) {
    struct timespec time;
    clock_gettime(CLOCK_MONOTONIC, &time);
    return 1e9 * (double)time.tv_sec + (double)time.tv_nsec;
}

static void check(int code, const char *what) {
    if (code < 0) {
        fprintf(stderr, "%s: %d\n", what, code);
        exit(1);
    }
}

static void integrate(const struct system *system, double rtol, double atol, double scale) {
    SUNContext context;
    SUNMatrix matrix = NULL;
    SUNLinearSolver linear = NULL;
    SUNNonlinearSolver fixed_point = NULL;
    N_Vector y;
    void *memory;
    double t = 0.0, start = now(), duration, end[MOST];
    long steps, evaluations;
    int i;

    check(SUNContext_Create(SUN_COMM_NULL, &context), "context");
    y = N_VNew_Serial(system->size, context);
    for (i = 0; i < system->size; i++) NV_DATA_S(y)[i] = scale * system->start[i];
    memory = CVodeCreate(system->jacobian ? CV_BDF : CV_ADAMS, context);
    check(CVodeInit(memory, system->rhs, 0.0, y), "CVodeInit");
    check(CVodeSStolerances(memory, rtol, atol), "tolerances");
    check(CVodeSetMaxNumSteps(memory, 10000000), "steps");
    check(CVodeSetStopTime(memory, system->end), "stop time");
    if (system->jacobian) {
        matrix = SUNDenseMatrix(system->size, system->size, context);
        linear = SUNLinSol_Dense(y, matrix, context);
        check(CVodeSetLinearSolver(memory, linear, matrix), "linear solver");
        check(CVodeSetJacFn(memory, system->jacobian), "Jacobian");
    } else {
        fixed_point = SUNNonlinSol_FixedPoint(y, 0, context);
        check(CVodeSetNonlinearSolver(memory, fixed_point), "nonlinear solver");
    }
    check(CVode(memory, system->end, y, &t, CV_NORMAL), "CVode");
    CVodeGetNumSteps(memory, &steps);
    CVodeGetNumRhsEvals(memory, &evaluations);
    memcpy(end, NV_DATA_S(y), sizeof(double) * (size_t)system->size);
    CVodeFree(&memory);
    SUNLinSolFree(linear);
    SUNMatDestroy(matrix);
    SUNNonlinSolFree(fixed_point);
    N_VDestroy(y);
    SUNContext_Free(&context);
    duration = now() - start;

    printf("%.0f %ld %ld", duration, steps, evaluations);
    for (i = 0; i < system->size; i++) printf(" %.17g", end[i]);
    printf("\n");
    fflush(stdout);
}

int main(int count, char **arguments) {
    size_t i;
    double scale;
    if (count != 4) return 2;
    for (i = 0; i < sizeof systems / sizeof *systems; i++) {
        if (strcmp(arguments[1], systems[i].name) == 0) {
            while (scanf("%lf", &scale) == 1) integrate(&systems[i], atof(arguments[2]), atof(arguments[3]), scale);
            return 0;
        }
    }
    return 2;
}
