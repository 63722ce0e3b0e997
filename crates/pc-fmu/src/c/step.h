/* One step of the integration, by the method that was chosen when this was written, and the states inside it. */
#ifndef PC_STEP_H
#define PC_STEP_H

#include "state.h"

static double weight(const Motion *m, int s, double y)
{
    return m->relative*fabs(y) + m->absolute*absolute_tolerances[s];
}

#if FMU_SOLVER == FMU_DOP853

#include "dop853.h"

static const double ORDER = 8.0;

static void stage(Instance *instance, int i, double t, const double *y, double h)
{
    double *z = instance->argument;
    for (int s = 0; s < FMU_STATES; s++) {
        double sum = 0.0;
        for (int j = 0; j < i; j++)
            if (dop853_a[i][j] != 0.0)
                sum += dop853_a[i][j]*instance->stages[j][s];
        z[s] = y[s] + h*sum;
    }
    rates_at(instance, t + dop853_c[i]*h, z, instance->stages[i]);
}

/* The state after a step of length h from (t, y), where the rates are f; its error against the tolerances, which is no number
   where something has no value. The rates at the end are left in the 13th stage. */
static double step(Instance *instance, double t, const double *y, const double *f, double h, double *end)
{
    memcpy(instance->step_start, y, FMU_STATES*sizeof *y);
    instance->step_length = h;
    memcpy(instance->stages[0], f, FMU_STATES*sizeof *f);
    for (int i = 1; i < 13; i++)
        stage(instance, i, t, instance->step_start, h);
    memcpy(end, instance->argument, FMU_STATES*sizeof *end);
    double fifth = 0.0, third = 0.0;
    for (int s = 0; s < FMU_STATES; s++) {
        double e5 = 0.0, e3 = 0.0;
        for (int j = 0; j < 12; j++) {
            e5 += dop853_e5[j]*instance->stages[j][s];
            e3 += (dop853_a[12][j] - dop853_b3[j])*instance->stages[j][s];
        }
        const double w = weight(&instance->motion, s, fmax(fabs(instance->step_start[s]), fabs(end[s])));
        fifth += e5/w*(e5/w);
        third += e3/w*(e3/w);
    }
    const double both = fifth + 0.01*third;
    const double error = fabs(h)*fifth/sqrt(FMU_STATES*(both > 0.0 ? both : 1.0));
    return all_finite(end, FMU_STATES) && all_finite(instance->stages[12], FMU_STATES) ? error : NAN;
}

#if FMU_EVENTS > 0
/* Prepares states inside the step from t that was made last, which ended at `end`. */
static void prepare_dense(Instance *instance, double t, const double *end)
{
    const double h = instance->step_length, *y = instance->step_start;
    for (int i = 13; i < 16; i++)
        stage(instance, i, t, y, h);
    for (int s = 0; s < FMU_STATES; s++) {
        const double rise = end[s] - y[s], bend = h*instance->stages[0][s] - rise;
        instance->polynomial[0][s] = y[s];
        instance->polynomial[1][s] = rise;
        instance->polynomial[2][s] = bend;
        instance->polynomial[3][s] = rise - h*instance->stages[12][s] - bend;
        for (int n = 0; n < 4; n++) {
            double sum = 0.0;
            for (int j = 0; j < 16; j++)
                sum += dop853_d[n][j]*instance->stages[j][s];
            instance->polynomial[4 + n][s] = h*sum;
        }
    }
}

/* The state at a part of the step, by the polynomial of degree 7. */
static void inside(const Instance *instance, double part, double *y)
{
    for (int s = 0; s < FMU_STATES; s++) {
        double value = instance->polynomial[7][s];
        for (int n = 6; n >= 0; n--)
            value = instance->polynomial[n][s] + (n % 2 == 0 ? part : 1.0 - part)*value;
        y[s] = value;
    }
}
#endif

#elif FMU_SOLVER == FMU_RADAU5

/* Radau's implicit Runge-Kutta method of order 5 with three stages [Hairer, Wanner, Solving Ordinary Differential Equations II
   (1996), IV.8]: z_i = h sum a_ij f(t + c_j h, y + z_j) by simplified Newton's method, and y(t + h) = y + z_3. */

static const double ORDER = 4.0; /* of the error that is estimated, and one */

enum { ALL = 3*FMU_STATES };

/* Factorises a matrix of n columns, column after column, with pivots; 0 if it is singular. */
static int factorise(double *a, int n, int *pivots)
{
    for (int c = 0; c < n; c++) {
        int pivot = c;
        for (int r = c + 1; r < n; r++)
            if (fabs(a[r + n*c]) > fabs(a[pivot + n*c]))
                pivot = r;
        pivots[c] = pivot;
        if (!(fabs(a[pivot + n*c]) > 0.0) || !isfinite(a[pivot + n*c]))
            return 0;
        for (int j = 0; j < n && pivot != c; j++) {
            const double held = a[c + n*j];
            a[c + n*j] = a[pivot + n*j];
            a[pivot + n*j] = held;
        }
        for (int r = c + 1; r < n; r++)
            a[r + n*c] /= a[c + n*c];
        for (int j = c + 1; j < n; j++) {
            const double upper = a[c + n*j];
            if (upper != 0.0)
                for (int r = c + 1; r < n; r++)
                    a[r + n*j] -= a[r + n*c]*upper;
        }
    }
    return 1;
}

static void solve(const double *a, int n, const int *pivots, double *x)
{
    for (int c = 0; c < n; c++) {
        const double held = x[c];
        x[c] = x[pivots[c]];
        x[pivots[c]] = held;
    }
    for (int c = 0; c < n; c++)
        for (int r = c + 1; r < n; r++)
            x[r] -= a[r + n*c]*x[c];
    for (int c = n - 1; c >= 0; c--) {
        x[c] /= a[c + n*c];
        for (int r = 0; r < c; r++)
            x[r] -= a[r + n*c]*x[c];
    }
}

static double size_of(const Motion *m, const double *v, const double *y, int parts)
{
    double sum = 0.0;
    for (int n = 0; n < parts; n++)
        for (int s = 0; s < FMU_STATES; s++) {
            const double e = v[n*FMU_STATES + s]/weight(m, s, y[s]);
            sum += e*e;
        }
    return sqrt(sum/(parts*FMU_STATES));
}

static double step(Instance *instance, double t, const double *y, const double *f, double h, double *end)
{
    const Motion *m = &instance->motion;
    const double root = sqrt(6.0);
    const double a[3][3] = {
        {(88.0 - 7.0*root)/360.0, (296.0 - 169.0*root)/1800.0, (-2.0 + 3.0*root)/225.0},
        {(296.0 + 169.0*root)/1800.0, (88.0 + 7.0*root)/360.0, (-2.0 - 3.0*root)/225.0},
        {(16.0 - root)/36.0, (16.0 + root)/36.0, 1.0/9.0},
    };
    const double c[3] = {(4.0 - root)/10.0, (4.0 + root)/10.0, 1.0};
    const double real = (6.0 + cbrt(81.0) - cbrt(9.0))/30.0; /* the real eigenvalue of a */
    double z[ALL + 1] = {0.0}, change[ALL + 1], *z_of[3] = {z, z + FMU_STATES, z + 2*FMU_STATES};
    double start[FMU_STATES + 1], rates[FMU_STATES + 1];
    memcpy(start, y, FMU_STATES*sizeof *y);
    memcpy(rates, f, FMU_STATES*sizeof *f);
    memcpy(instance->step_start, start, sizeof start);
    instance->step_length = h;

    inputs_at(instance, t);
    fmu_jacobian(t, start, m->p, instance->jacobian);
    for (int i = 0; i < ALL; i++)
        for (int j = 0; j < ALL; j++) {
            const int r = i % FMU_STATES, s = j % FMU_STATES;
            const double entry = -h*a[i/FMU_STATES][j/FMU_STATES]*instance->jacobian[r + FMU_STATES*s];
            instance->matrix[i + ALL*j] = entry + (i == j ? 1.0 : 0.0);
        }
    if (!factorise(instance->matrix, ALL, instance->pivots))
        return NAN;
    const double enough = fmax(10.0*DBL_EPSILON/m->relative, fmin(0.03, sqrt(m->relative)));
    double before = HUGE_VAL, rate = 0.0;
    int solved = 0;
    for (int iteration = 0; iteration < 12 && !solved; iteration++) {
        for (int n = 0; n < 3; n++) {
            for (int s = 0; s < FMU_STATES; s++)
                instance->argument[s] = start[s] + z_of[n][s];
            rates_at(instance, t + c[n]*h, instance->argument, instance->stages[n]);
            if (!all_finite(instance->stages[n], FMU_STATES))
                return NAN;
        }
        for (int n = 0; n < 3; n++)
            for (int s = 0; s < FMU_STATES; s++) {
                double sum = 0.0;
                for (int j = 0; j < 3; j++)
                    sum += a[n][j]*instance->stages[j][s];
                change[n*FMU_STATES + s] = h*sum - z_of[n][s];
            }
        solve(instance->matrix, ALL, instance->pivots, change);
        for (int i = 0; i < ALL; i++)
            z[i] += change[i];
        const double length = size_of(m, change, start, 3);
        if (!isfinite(length))
            return NAN;
        if (iteration > 0) {
            rate = length/before;
            if (rate >= 0.99 && length > enough)
                return NAN;
        }
        const double left = iteration == 0 ? HUGE_VAL : length*rate/(1.0 - fmin(rate, 0.99));
        solved = length == 0.0 || left <= enough;
        before = length;
    }
    if (!solved)
        return NAN;
    for (int s = 0; s < FMU_STATES; s++)
        end[s] = start[s] + z_of[2][s];
#if FMU_EVENTS > 0
    for (int n = 0; n < 3; n++)
        memcpy(instance->polynomial[n], z_of[n], FMU_STATES*sizeof *z);
#endif

    /* (1 - h real J) error = h real (f + (d, z)/h) */
    const double d[3] = {-(13.0 + 7.0*root)/3.0, (-13.0 + 7.0*root)/3.0, -1.0/3.0};
    for (int i = 0; i < FMU_STATES; i++)
        for (int j = 0; j < FMU_STATES; j++)
            instance->real_matrix[i + FMU_STATES*j] =
                (i == j ? 1.0 : 0.0) - h*real*instance->jacobian[i + FMU_STATES*j];
    if (!factorise(instance->real_matrix, FMU_STATES, instance->real_pivots))
        return NAN;
    double error = NAN;
    for (int pass = 0; pass < 2; pass++) {
        for (int s = 0; s < FMU_STATES; s++)
            change[s] = real*(h*rates[s] + d[0]*z_of[0][s] + d[1]*z_of[1][s] + d[2]*z_of[2][s]);
        solve(instance->real_matrix, FMU_STATES, instance->real_pivots, change);
        error = size_of(m, change, start, 1);
        if (!(error > 1.0))
            break;
        for (int s = 0; s < FMU_STATES; s++)
            instance->argument[s] = start[s] + change[s];
        rates_at(instance, t, instance->argument, rates);
    }
    return all_finite(end, FMU_STATES) ? error : NAN;
}

#if FMU_EVENTS > 0
static void prepare_dense(Instance *instance, double t, const double *end)
{
    (void)instance;
    (void)t;
    (void)end;
}

/* The state at a part of the step, by the polynomial of collocation. */
static void inside(const Instance *instance, double part, double *y)
{
    const double root = sqrt(6.0), c[3] = {(4.0 - root)/10.0, (4.0 + root)/10.0, 1.0};
    double l[3];
    for (int n = 0; n < 3; n++) {
        l[n] = part/c[n];
        for (int j = 0; j < 3; j++)
            if (j != n)
                l[n] *= (part - c[j])/(c[n] - c[j]);
    }
    for (int s = 0; s < FMU_STATES; s++)
        y[s] = instance->step_start[s] + l[0]*instance->polynomial[0][s] + l[1]*instance->polynomial[1][s]
               + l[2]*instance->polynomial[2][s];
}
#endif

#else /* FMU_RK4 */

static const double ORDER = 4.0;

/* The classical Runge-Kutta method with fixed steps: the error is not known. */
static double step(Instance *instance, double t, const double *y, const double *f, double h, double *end)
{
    static const double part[4] = {0.0, 0.5, 0.5, 1.0};
    memcpy(instance->step_start, y, FMU_STATES*sizeof *y);
    memcpy(instance->stages[0], f, FMU_STATES*sizeof *f);
    instance->step_length = h;
    for (int i = 1; i < 4; i++) {
        for (int s = 0; s < FMU_STATES; s++)
            instance->argument[s] = instance->step_start[s] + part[i]*h*instance->stages[i - 1][s];
        rates_at(instance, t + part[i]*h, instance->argument, instance->stages[i]);
    }
    for (int s = 0; s < FMU_STATES; s++)
        end[s] = instance->step_start[s] + h/6.0*(instance->stages[0][s] + 2.0*instance->stages[1][s]
                                                  + 2.0*instance->stages[2][s] + instance->stages[3][s]);
    return all_finite(end, FMU_STATES) ? 0.0 : NAN;
}

#if FMU_EVENTS > 0
static void prepare_dense(Instance *instance, double t, const double *end)
{
    const double h = instance->step_length, *y = instance->step_start;
    rates_at(instance, t + h, end, instance->stages[4]);
    for (int s = 0; s < FMU_STATES; s++) {
        const double rise = end[s] - y[s], bend = h*instance->stages[0][s] - rise;
        instance->polynomial[0][s] = rise;
        instance->polynomial[1][s] = bend;
        instance->polynomial[2][s] = rise - h*instance->stages[4][s] - bend;
    }
}

/* The state at a part of the step, by Hermite's cubic. */
static void inside(const Instance *instance, double part, double *y)
{
    for (int s = 0; s < FMU_STATES; s++)
        y[s] = instance->step_start[s] + part*(instance->polynomial[0][s] + (1.0 - part)*(instance->polynomial[1][s]
                                                                                    + part*instance->polynomial[2][s]));
}
#endif

#endif

#endif
