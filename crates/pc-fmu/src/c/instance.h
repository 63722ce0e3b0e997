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

/* The highest derivative of an input that is taken. */
enum { ORDERS = 8 };

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
    /* An event that was found, and is left to the importer: whether there is one, which events are due, and what `occur` needs
       to know of them. */
    int waiting, due[FMU_EVENTS + 1], beyond[FMU_EVENTS + 1];
    double due_noise[FMU_EVENTS + 1], due_length;
    double level[FMU_KEPT + 1];
    int guard[FMU_GUARDS + 1];
    /* The derivatives of inputs at the start of the coming step, up to this order; 0 where the inputs are held. */
    int order;
    double slopes[ORDERS][FMU_PARAMETERS + 1];
} Motion;

/* What the importer may do while it is called in the middle of a step. */
typedef enum { UNCALLED, MAY_SET, MAY_GET } Called;

typedef struct Instance {
    Motion motion;
    void *environment;
    void (*log)(struct Instance *instance, const char *text);
    char *name;
    /* Calls the importer in the middle of a step: for the inputs at a time, those that are `provided`, and at the end of a step
       of the integration, after which it may shorten the way to `to`. None where it does not ask for that. */
    void (*ask)(struct Instance *instance, double t);
    void (*tell)(struct Instance *instance, double *to);
    Called called;
    int leaves_events; /* whether events are left to the importer, who deals with them in event mode */
    int provided[FMU_PARAMETERS + 1];
    /* Whether inputs move now, the time to which those among the parameters belong, where the way began and ends, and the
       inputs there. */
    int moving;
    double inputs_time, from, to, base[FMU_PARAMETERS + 1];
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

/* The motion is at another time or state. */
static void moved(Motion *m)
{
    m->fresh = m->seen = 0;
}

#endif
