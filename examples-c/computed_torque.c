/* An arm whose tool follows a circle by computed torque, and then is held by a linear regulator. */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "pc.h"

enum { K = 3, DIM = 2 * K, HEIGHT = 1, RISE = 2, OBSERVABLES = 3 }; /* of energy, height, rise */

/* As in arm.toml. */
static const char ARM[] =
    "[parameters]\ng = 9.81\nl1 = 0.5\nl2 = 0.4\nm1 = 4.0\nm2 = 2.5\nc = 0.2\n"
    "[gravity]\nacceleration = [0, 0, \"-g\"]\n"
    "[coordinates]\nwaist = 0.3\nshoulder = -0.6\nelbow = 1.3\n"
    "[bodies.waist]\njoint = { kind = \"revolute\", axis = [0, 0, 1] }\ninertia = [0, 0, 0.2]\n"
    "[bodies.shoulder]\nparent = \"waist\"\n"
    "joint = { kind = \"revolute\", axis = [0, 1, 0], at = [0, 0, 0.6] }\n"
    "mass = \"m1\"\ncenter = [\"l1/2\", 0, 0]\ninertia = [0.01, \"m1*l1^2/12\", \"m1*l1^2/12\"]\n"
    "[bodies.elbow]\nparent = \"shoulder\"\n"
    "joint = { kind = \"revolute\", axis = [0, 1, 0], at = [\"l1\", 0, 0] }\n"
    "mass = \"m2\"\ncenter = [\"l2/2\", 0, 0]\ninertia = [0.005, \"m2*l2^2/12\", \"m2*l2^2/12\"]\n"
    "[points.tool]\nbody = \"elbow\"\nat = [\"l2\", 0, 0]\n"
    "[forces]\n\"waist'\" = \"-c*waist'\"\n\"shoulder'\" = \"-c*shoulder'\"\n\"elbow'\" = \"-c*elbow'\"\n"
    "[outputs]\nheight = \"tool_z\"\nrise = \"d(tool_z')\"\n";

static const double RATE = 5.0; /* both roots of ë + 2·5 ė + 25 e = 0 */

/* Where the tool has to be, with its velocity and acceleration. */
typedef struct {
    double centre[3], radius, turn;
} path;

static void wanted(const path *way, double t, double *x, double *v, double *a)
{
    const double w = way->turn, c = way->radius * cos(w * t), s = way->radius * sin(w * t);
    const double at[3] = {0.0, c, s}, rate[3] = {0.0, -w * s, w * c};
    int i;
    for (i = 0; i < 3; i++) {
        x[i] = way->centre[i] + at[i];
        v[i] = rate[i];
        a[i] = -w * w * at[i];
    }
}

/* The controller has equations of its own, without external forces. */
typedef struct {
    pc_system *arm;
    const path *way;
} controller;

/* Solves the 3 × 3 system A x = b, with A by its columns, by Cramer's rule. */
static void solve(const double *a, const double *b, double *x)
{
    const double *u = a, *v = a + 3, *w = a + 6;
    const double vw[3] = {v[1] * w[2] - v[2] * w[1], v[2] * w[0] - v[0] * w[2], v[0] * w[1] - v[1] * w[0]};
    const double wu[3] = {w[1] * u[2] - w[2] * u[1], w[2] * u[0] - w[0] * u[2], w[0] * u[1] - w[1] * u[0]};
    const double uv[3] = {u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]};
    const double det = u[0] * vw[0] + u[1] * vw[1] + u[2] * vw[2];
    x[0] = (b[0] * vw[0] + b[1] * vw[1] + b[2] * vw[2]) / det;
    x[1] = (b[0] * wu[0] + b[1] * wu[1] + b[2] * wu[2]) / det;
    x[2] = (b[0] * uv[0] + b[1] * uv[1] + b[2] * uv[2]) / det;
}

/* J of the tool, 3 × K, and its position and velocity. */
static int look(pc_system *arm, double t, const double *y, double *jacobian, double *x, double *v)
{
    double all[6 * (K + 2)], pose[12];
    int i, s;
    if (pc_system_body_jacobian(arm, t, y, DIM, "tool", NULL, 0, all, 6 * (K + 2), NULL) != PC_OK ||
        pc_system_body_pose(arm, t, y, DIM, "tool", NULL, 0, pose, 12, NULL) != PC_OK) {
        return 0;
    }
    for (i = 0; i < 3; i++) {
        x[i] = pose[i];
        for (v[i] = 0.0, s = 0; s < K; s++) {
            jacobian[i + 3 * s] = all[i + 6 * s];
            v[i] += all[i + 6 * s] * y[K + s];
        }
    }
    return 1;
}

/* The acceleration a of the tool needs η̇ = J⁻¹ (a − J̇ η), and these need τ = M η̇ + h. */
static int torque(double t, const double *y, size_t y_length, double *tau, size_t tau_length, void *user)
{
    const controller *c = user;
    double jacobian[9], bias[6], x[3], v[3], to[3], rate[3], a[3], eta[K], mass[K * K];
    int i, s;
    if (y_length != DIM || tau_length != K || !look(c->arm, t, y, jacobian, x, v) ||
        pc_system_body_bias(c->arm, t, y, DIM, "tool", NULL, 0, bias, 6, NULL) != PC_OK) {
        return -1; /* ends the integration */
    }
    wanted(c->way, t, to, rate, a);
    for (i = 0; i < 3; i++) {
        a[i] += 2.0 * RATE * (rate[i] - v[i]) + RATE * RATE * (to[i] - x[i]) - bias[i];
    }
    solve(jacobian, a, eta);
    if (pc_system_mass_matrix(c->arm, t, y, DIM, mass, K * K, NULL) != PC_OK ||
        pc_system_inverse_dynamics(c->arm, t, y, DIM, NULL, 0, tau, K, NULL) != PC_OK) { /* h − Q */
        return -1;
    }
    for (i = 0; i < K; i++) {
        for (s = 0; s < K; s++) {
            tau[i] += mass[i + K * s] * eta[s];
        }
    }
    return 0;
}

/* The regulator u = u_0 − G (y − y_0). */
typedef struct {
    double forces[K], gain[K * DIM], state[DIM];
} regulator;

static int regulate(double t, const double *y, size_t y_length, double *u, size_t u_length, void *user)
{
    const regulator *r = user;
    size_t i, j;
    (void)t;
    for (i = 0; i < u_length; i++) {
        for (u[i] = r->forces[i], j = 0; j < y_length; j++) {
            u[i] -= r->gain[i + K * j] * (y[j] - r->state[j]);
        }
    }
    return 0;
}

/* C += f A B or f Aᵀ B, for A with `rows` rows, and B with as many columns as C. */
static void add(double *c, double f, const double *a, int rows, int columns, int transposed, const double *b, int width)
{
    const int m = transposed ? columns : rows, n = transposed ? rows : columns;
    int i, j, l;
    for (i = 0; i < m; i++) {
        for (j = 0; j < width; j++) {
            for (l = 0; l < n; l++) {
                c[i + m * j] += f * (transposed ? a[l + rows * i] : a[i + rows * l]) * b[l + n * j];
            }
        }
    }
}

/* Rates of P by Riccati's equation, P' = Aᵀ P + P A − P B Bᵀ P + W, with G = Bᵀ P. */
static void riccati(const double *a, const double *b, const double *p, double *gain, double *rate)
{
    double half[DIM * DIM] = {0.0}; /* Aᵀ P */
    int i, j;
    memset(gain, 0, K * DIM * sizeof *gain);
    add(gain, 1.0, b, DIM, K, 1, p, DIM);
    add(half, 1.0, a, DIM, DIM, 1, p, DIM);
    for (i = 0; i < DIM; i++) {
        for (j = 0; j < DIM; j++) {
            rate[i + DIM * j] = half[i + DIM * j] + half[j + DIM * i] + (i == j ? (i < K ? 1e4 : 1e2) : 0.0);
        }
    }
    add(rate, -1.0, gain, K, DIM, 1, gain, DIM);
}

/* The gain of the linear quadratic regulator: P tends to a state of rest. Returns the last rate of P. */
static double regulator_gain(const double *a, const double *b, double *gain)
{
    double p[DIM * DIM] = {0.0}, rate[DIM * DIM], largest = 0.0;
    const double h = 1e-3;
    int i, step;
    for (step = 0; step < 20000; step++) {
        riccati(a, b, p, gain, rate);
        for (largest = 0.0, i = 0; i < DIM * DIM; i++) {
            p[i] += h * rate[i];
            largest = fmax(largest, fabs(rate[i]));
        }
    }
    return largest;
}

/* Follows the circle; the error of the tool is (e_0 + (ė_0 + 5 e_0) t) e^(−5 t). Writes the last state. */
static int follow(pc_system *plant, pc_system *arm, const path *way, double *y, pc_error **error)
{
    pc_solver *solver = NULL;
    pc_solver_options options;
    double jacobian[9], x[3], v[3], to[3], rate[3], a[3], e0[3], de0[3], worst = 0.0, off = 0.0;
    int i, n, ok;
    pc_solver_options_init(&options, sizeof options);
    options.relative_tolerance = 1e-11;
    ok = pc_system_start(plant, NULL, y, DIM, error) == PC_OK &&
         pc_solver_new(plant, &options, 0.0, NULL, 0, &solver, error) == PC_OK;
    printf("   t    off the path   predicted\n");
    for (n = 0; ok && n <= 6; n++) {
        const double t = 0.5 * n;
        double predicted = 0.0;
        ok = (n == 0 || pc_solver_advance(solver, t, y, DIM, error) == PC_OK) && look(arm, t, y, jacobian, x, v);
        wanted(way, t, to, rate, a);
        for (off = 0.0, i = 0; i < 3; i++) {
            const double e = to[i] - x[i];
            double foreseen;
            if (n == 0) {
                e0[i] = e;
                de0[i] = rate[i] - v[i];
            }
            foreseen = (e0[i] + (de0[i] + RATE * e0[i]) * t) * exp(-RATE * t);
            worst = fmax(worst, fabs(e - foreseen));
            off = hypot(off, e);
            predicted = hypot(predicted, foreseen);
        }
        printf("  %.1f   %.6e   %.6e\n", t, off, predicted);
    }
    pc_solver_free(solver);
    return ok && worst < 1e-8 && off < 1e-5;
}

/* Whether all eigenvalues of the closed loop near a place of rest are −5: (A + 5)² = 0. */
static int roots(pc_system *plant, const double *y, pc_error **error)
{
    double closed[DIM * DIM], square[DIM * DIM] = {0.0}, largest = 0.0;
    int i;
    if (pc_system_jacobian(plant, 0.0, y, DIM, closed, DIM * DIM, error) != PC_OK) {
        return 0;
    }
    for (i = 0; i < DIM; i++) {
        closed[i + DIM * i] += RATE;
    }
    add(square, 1.0, closed, DIM, DIM, 0, closed, DIM);
    for (i = 0; i < DIM * DIM; i++) {
        largest = fmax(largest, fabs(square[i]));
    }
    printf("closed loop at rest: (A + 5)^2 = 0 up to %.1e\n", largest);
    return largest < 1e-4; /* the derivatives of the torque are difference quotients */
}

/* Whether B is M⁻¹ and D is J M⁻¹, and C the rate of the height. */
static int agrees(pc_system *arm, const double *y, const double *b, const double *c, const double *d)
{
    double jacobian[9], x[3], v[3], mass[K * K], unit[K * K] = {0.0}, lower[K * K], off = 0.0;
    int i, s, m;
    if (!look(arm, 0.0, y, jacobian, x, v) || pc_system_mass_matrix(arm, 0.0, y, DIM, mass, K * K, NULL) != PC_OK) {
        return 0;
    }
    for (s = 0; s < K; s++) {
        for (i = 0; i < K; i++) {
            lower[i + K * s] = b[K + i + DIM * s];
        }
    }
    add(unit, 1.0, mass, K, K, 0, lower, K);
    for (s = 0; s < K; s++) {
        double rise = 0.0;
        for (m = 0; m < K; m++) {
            off = fmax(off, fabs(unit[m + K * s] - (m == s)));
            rise += jacobian[2 + 3 * m] * lower[m + K * s];
        }
        off = fmax(off, fabs(d[RISE + OBSERVABLES * s] - rise));
        off = fmax(off, fabs(c[HEIGHT + OBSERVABLES * s] - jacobian[2 + 3 * s]));
    }
    printf("M B = 1, C = J and D = J M^-1 up to %.1e\n", off);
    return off < 1e-12;
}

/* Holds the arm at y_0 by a linear regulator, from a state beside it. */
static int hold(pc_system *plant, pc_system *arm, const double *y0, pc_error **error)
{
    regulator r;
    pc_solver *solver = NULL;
    double a[DIM * DIM], b[DIM * K], c[OBSERVABLES * DIM], d[OBSERVABLES * K], y[DIM], left, off = 0.0;
    int i, ok;
    memcpy(r.state, y0, sizeof r.state);
    ok = pc_system_gravity(arm, 0.0, y0, DIM, r.forces, K, error) == PC_OK &&
         pc_system_linearize(plant, 0.0, y0, DIM, r.forces, K, NULL, 0, a, DIM * DIM, b, DIM * K, c, OBSERVABLES * DIM,
                             d, OBSERVABLES * K, error) == PC_OK &&
         agrees(arm, y0, b, c, d);
    if (!ok) {
        return 0;
    }
    left = regulator_gain(a, b, r.gain);
    printf("gain of the regulator:\n");
    for (i = 0; i < K; i++) {
        printf("  %8.3f %8.3f %8.3f   %7.3f %7.3f %7.3f\n", r.gain[i], r.gain[i + K], r.gain[i + 2 * K],
               r.gain[i + 3 * K], r.gain[i + 4 * K], r.gain[i + 5 * K]);
    }
    for (i = 0; i < DIM; i++) {
        y[i] = y0[i] + (i < K ? 0.1 * (i - 1.2) : 0.2);
    }
    ok = left < 1e-6 && pc_system_set_force(plant, regulate, NULL, &r, NULL, error) == PC_OK &&
         pc_solver_new(plant, NULL, 0.0, y, DIM, &solver, error) == PC_OK &&
         pc_solver_advance(solver, 10.0, y, DIM, error) == PC_OK;
    for (i = 0; i < DIM; i++) {
        off = fmax(off, fabs(y[i] - y0[i]));
    }
    printf("held by the regulator, the arm is off by %.1e after 10 s\n", off);
    pc_solver_free(solver);
    return ok && off < 1e-6;
}

/* Equations of the arm, with or without torques of the program at its joints. */
static pc_system *equations(int driven, pc_error **error)
{
    pc_model *model = NULL;
    pc_system *system = NULL;
    if (pc_model_parse(ARM, strlen(ARM), "arm.toml", &model, error) == PC_OK &&
        (!driven || (pc_model_add_external_force(model, "waist", error) == PC_OK &&
                     pc_model_add_external_force(model, "shoulder", error) == PC_OK &&
                     pc_model_add_external_force(model, "elbow", error) == PC_OK))) {
        pc_system_new(model, NULL, &system, error);
    }
    pc_model_free(model);
    return system;
}

int main(void)
{
    const path circle = {{0.65, 0.12, 0.62}, 0.12, 1.5};
    pc_error *error = NULL;
    pc_system *arm = equations(0, &error), *plant = arm ? equations(1, &error) : NULL;
    controller c;
    path place = {{0.0, 0.0, 0.0}, 0.0, 0.0};
    double y[DIM], jacobian[9], v[3];
    int i, ok;
    c.arm = arm;
    c.way = &circle;
    ok = plant && pc_system_set_force(plant, torque, NULL, &c, NULL, &error) == PC_OK &&
         follow(plant, arm, &circle, y, &error);
    for (i = K; i < DIM; i++) {
        y[i] = 0.0;
    }
    c.way = &place; /* now the tool is to stay where it is */
    ok = ok && look(arm, 0.0, y, jacobian, place.centre, v) && roots(plant, y, &error) && hold(plant, arm, y, &error);
    if (error) {
        fprintf(stderr, "%s\n", pc_error_message(error));
    }
    pc_error_free(error);
    pc_system_free(plant);
    pc_system_free(arm);
    return ok ? 0 : 1;
}
