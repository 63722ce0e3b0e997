/* What is computed at a state: its rates, what is observed, and the values at which the motion is kept. */
#ifndef PC_STATE_H
#define PC_STATE_H

#include "inputs.h"

/* The rates, which have to be finite. */
static int evaluate(Instance *instance)
{
    Motion *m = &instance->motion;
    if (m->fresh)
        return 1;
    rates_at(instance, m->t, m->y, m->rates);
    for (int i = 0; i < FMU_STATES; i++)
        if (!isfinite(m->rates[i]))
            return wrong(instance, "the rate of %s is %g at t = %.17g", state_names[i], m->rates[i], m->t);
    m->fresh = 1;
    return 1;
}

/* What is observed. */
static void observe(Motion *m)
{
#if FMU_OBSERVED > 0
    if (!m->seen)
        fmu_observed(m->t, m->y, m->p, m->observed);
#endif
    m->seen = 1;
}

#if FMU_KEPT > 0
/* Newton's method for the values that are kept, each step the shortest; 0 where it does not come near. */
static int project(Instance *instance, double t, double *y)
{
    Motion *m = &instance->motion;
    double value[FMU_KEPT], slope[FMU_KEPT * FMU_STATES], a[FMU_KEPT][FMU_KEPT + 1];
    double before = HUGE_VAL;
    inputs_at(instance, t);
    for (int iteration = 0; iteration < 50; iteration++) {
        fmu_kept(t, y, m->p, value);
        fmu_kept_slopes(t, y, m->p, slope);
        for (int r = 0; r < FMU_KEPT; r++) {
            for (int s = 0; s < FMU_KEPT; s++) {
                a[r][s] = 0.0;
                for (int i = 0; i < FMU_STATES; i++)
                    a[r][s] += slope[r*FMU_STATES + i]*slope[s*FMU_STATES + i];
            }
            a[r][FMU_KEPT] = value[r] - m->level[r];
        }
        for (int c = 0; c < FMU_KEPT; c++) {
            int pivot = c;
            for (int r = c + 1; r < FMU_KEPT; r++)
                if (fabs(a[r][c]) > fabs(a[pivot][c]))
                    pivot = r;
            for (int s = c; s <= FMU_KEPT; s++) {
                const double held = a[c][s];
                a[c][s] = a[pivot][s];
                a[pivot][s] = held;
            }
            if (!(fabs(a[c][c]) > 0.0))
                return 0;
            for (int r = 0; r < FMU_KEPT; r++)
                if (r != c) {
                    const double part = a[r][c]/a[c][c];
                    for (int s = c; s <= FMU_KEPT; s++)
                        a[r][s] -= part*a[c][s];
                }
        }
        double length = 0.0, size = 0.0;
        for (int i = 0; i < FMU_STATES; i++) {
            double change = 0.0;
            for (int r = 0; r < FMU_KEPT; r++)
                change += slope[r*FMU_STATES + i]*a[r][FMU_KEPT]/a[r][r];
            instance->argument[i] = change;
            length = fmax(length, fabs(change));
            size = fmax(size, fabs(y[i]));
        }
        if (!isfinite(length))
            return 0;
        const int is_short = length <= 1e-8*size;
        if (length >= before/2.0)
            return is_short;
        for (int i = 0; i < FMU_STATES; i++)
            y[i] -= instance->argument[i];
        if (is_short)
            return 1;
        before = length;
    }
    return 0;
}
#else
static int project(Instance *instance, double t, double *y)
{
    (void)instance;
    (void)t;
    (void)y;
    return 1;
}
#endif

/* Takes the values of integrals here for those to be kept; those of constraints are zero. */
static void take_levels(Motion *m)
{
#if FMU_KEPT > 0
    double value[FMU_KEPT];
    fmu_kept(m->t, m->y, m->p, value);
    for (int r = 0; r < FMU_KEPT; r++)
        m->level[r] = kept_constraint[r] ? 0.0 : value[r];
#else
    (void)m;
#endif
}

/* Whether the state satisfies the constraints on it. */
static int on_constraints(Instance *instance, const char *what)
{
#if FMU_KEPT > 0
    Motion *m = &instance->motion;
    double value[FMU_KEPT], slope[FMU_KEPT * FMU_STATES];
    fmu_kept(m->t, m->y, m->p, value);
    fmu_kept_slopes(m->t, m->y, m->p, slope);
    for (int r = 0; r < FMU_KEPT; r++) {
        double size = 1.0, length = 0.0;
        for (int i = 0; i < FMU_STATES; i++) {
            size = fmax(size, fabs(m->y[i]));
            length += slope[r*FMU_STATES + i]*slope[r*FMU_STATES + i];
        }
        if (kept_constraint[r] && !(fabs(value[r]) <= OFF*size*sqrt(length)))
            return wrong(instance, "%s is off the constraint %s: it is %.6g, not 0", what, kept_names[r], value[r]);
    }
#else
    (void)instance;
    (void)what;
#endif
    return 1;
}

/* Whether the state still determines velocities: a determinant that passes through zero between two states says no. */
static int within_chart(Instance *instance, double t, const double *y, int start)
{
#if FMU_GUARDS > 0
    Motion *m = &instance->motion;
    double value[FMU_GUARDS];
    inputs_at(instance, t);
    fmu_guards(t, y, m->p, value);
    for (int i = 0; i < FMU_GUARDS; i++) {
        const int sign = value[i] > 0.0 ? 1 : value[i] < 0.0 ? -1 : 0;
        if (start)
            m->guard[i] = sign;
        if (sign == 0 || sign != m->guard[i] || !isfinite(value[i]))
            return wrong(instance,
                         "near t = %.17g the quasi-velocities of this form do not determine the velocities, or these "
                         "not them: choose other independent velocities, or another form", t);
    }
#else
    (void)instance;
    (void)t;
    (void)y;
    (void)start;
#endif
    return 1;
}

#endif
