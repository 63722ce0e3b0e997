/* One instance of the model: its state, its parameters, and what is computed from them. */
#ifndef PC_INSTANCE_H
#define PC_INSTANCE_H

#include "layout.h"

#include <float.h>
#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* The last times of an event that tell whether it accumulates. */
enum { LAST_TIMES = 6 };

/* A start that misses a constraint by more than this, absolute or relative whichever is larger, is off it. */
static const double OFF = 1e-8;

typedef enum { INSTANTIATED, INITIALIZING, EVENT_MODE, CONTINUOUS, STEPPING, TERMINATED } Phase;

/* What a saved state consists of: numbers only. Arrays have a place more than they need, since C has none without places. */
typedef struct {
    Phase phase;
    double t, t_start, horizon; /* horizon: the length of the experiment, the scale of small times */
    double y[FMU_STATES + 1], p[FMU_PARAMETERS + 1];
    int given[FMU_STATES + 1]; /* whether a start value was set */
    int fresh, seen;           /* whether the rates, and what is observed, belong to t, y and p */
    double rates[FMU_STATES + 1], observed[FMU_OBSERVED + 1];
    double relative, absolute; /* the relative tolerance, and the part of the absolute ones that counts */
    double next;               /* how long the next step is tried; 0 where nothing is known */
    /* On which side of zero the function of each event is, and what it has to exceed to have left zero. */
    int side[FMU_EVENTS + 1];
    double noise[FMU_EVENTS + 1];
    double times[FMU_EVENTS + 1][LAST_TIMES], longest[FMU_EVENTS + 1];
    int occurrences[FMU_EVENTS + 1];
    int terminal; /* whether a terminal event has occurred */
    double level[FMU_KEPT + 1];
    int guard[FMU_GUARDS + 1];
} Motion;

typedef struct Instance {
    Motion motion;
    void *environment;
    void (*log)(struct Instance *instance, const char *text);
    char *name;
    /* Room for a step of the integration. */
    double stages[16][FMU_STATES + 1], argument[FMU_STATES + 1], polynomial[8][FMU_STATES + 1];
    double step_start[FMU_STATES + 1], step_length;
#if FMU_SOLVER == FMU_RADAU5
    double jacobian[FMU_STATES * FMU_STATES], matrix[9 * FMU_STATES * FMU_STATES];
    double real_matrix[FMU_STATES * FMU_STATES];
    int pivots[3 * FMU_STATES], real_pivots[FMU_STATES];
#endif
} Instance;

/* Tells the user what is wrong; 0, for the caller to return. */
static int wrong(Instance *instance, const char *format, ...)
{
    char text[1024];
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(text, sizeof text, format, arguments);
    va_end(arguments);
    if (instance->log)
        instance->log(instance, text);
    return 0;
}

static int all_finite(const double *values, int count)
{
    for (int i = 0; i < count; i++)
        if (!isfinite(values[i]))
            return 0;
    return 1;
}

/* Makes what follows from parameters follow: other parameters, and the start until the motion has begun. */
static void follow(Motion *m)
{
#if FMU_CALCULATED > 0
    double values[FMU_CALCULATED];
    fmu_calculated(m->t, m->y, m->p, values);
    for (int i = 0; i < FMU_CALCULATED; i++)
        m->p[calculated_places[i]] = values[i];
#endif
    if (m->phase == INSTANTIATED || m->phase == INITIALIZING) {
        double start[FMU_STATES + 1];
        fmu_start(m->t, m->y, m->p, start);
        for (int i = 0; i < FMU_STATES; i++)
            if (!m->given[i])
                m->y[i] = start[i];
    }
    m->fresh = m->seen = 0;
}

static void set_defaults(Motion *m)
{
    memset(m, 0, sizeof *m);
    m->phase = INSTANTIATED;
    m->t = m->t_start = FMU_T_START;
    m->horizon = FMU_HORIZON;
    m->relative = FMU_RELATIVE;
    m->absolute = 1.0;
    for (int i = 0; i < FMU_PARAMETERS; i++)
        m->p[i] = default_parameters[i];
    follow(m);
}

/* The rates, which have to be finite. */
static int evaluate(Instance *instance)
{
    Motion *m = &instance->motion;
    if (m->fresh)
        return 1;
    fmu_rhs(m->t, m->y, m->p, m->rates);
    for (int i = 0; i < FMU_STATES; i++)
        if (!isfinite(m->rates[i]))
            return wrong(instance, "the rate of %s is %g at t = %.17g", state_names[i], m->rates[i], m->t);
    m->fresh = 1;
    return 1;
}

/* The motion is at another time or state. */
static void moved(Motion *m)
{
    m->fresh = m->seen = 0;
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
