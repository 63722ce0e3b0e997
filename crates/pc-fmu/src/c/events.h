/* Events: on which side of zero their functions are, what happens where one passes through, and when that accumulates. */
#ifndef PC_EVENTS_H
#define PC_EVENTS_H

#include "state.h"

#if FMU_EVENTS > 0

/* A function is near zero after a reset within so many times what the tolerances of the state make of zero. */
static const double TOLERANCES = 10.0;

/* What an importer looks at: of the sign of the side where the function is, also just after it has passed through zero. */
static double indicator(const Motion *m, int i, double value)
{
    return value + m->side[i]*m->noise[i];
}

static int crossed(const Motion *m, int i, double value)
{
    const int side = m->side[i];
    const int leaves = event_directions[i] == 0 || event_directions[i] == -side;
    return side != 0 && leaves && indicator(m, i, value)*side <= 0.0;
}

/* Takes note of values at which nothing has occurred. */
static void pass(Motion *m, const double *values)
{
    for (int i = 0; i < FMU_EVENTS; i++)
        if (fabs(values[i]) > m->noise[i]) {
            m->side[i] = values[i] > 0.0 ? 1 : -1;
            m->noise[i] = 0.0;
        }
}

/* Takes note of values as `pass` does, but for functions that have passed in the direction of their event: at a touch they
   keep their sides. */
static void pass_touch(Motion *m, const double *values)
{
    double kept[FMU_EVENTS];
    for (int i = 0; i < FMU_EVENTS; i++)
        kept[i] = crossed(m, i, values[i]) ? 0.0 : values[i];
    pass(m, kept);
}

/* One step of the classical Runge-Kutta method: short ones say where a function at zero goes. */
static void short_step(Instance *instance, double h, double *z)
{
    const Motion *m = &instance->motion;
    double k[4][FMU_STATES + 1];
    static const double part[4] = {0.0, 0.5, 0.5, 1.0};
    for (int stage = 0; stage < 4; stage++) {
        for (int i = 0; i < FMU_STATES; i++)
            z[i] = m->y[i] + (stage > 0 ? part[stage]*h*k[stage - 1][i] : 0.0);
        rates_at(instance, m->t + part[stage]*h, z, k[stage]);
    }
    for (int i = 0; i < FMU_STATES; i++)
        z[i] = m->y[i] + h/6.0*(k[0][i] + 2.0*k[1][i] + 2.0*k[2][i] + k[3][i]);
}

/* The sides of functions that are at zero: those to which they move. They have not passed while they are still there. */
static void leave(Instance *instance, double length)
{
    static const double early[4] = {1e-12, 1e-9, 1e-6, 1e-3};
    Motion *m = &instance->motion;
    double z[FMU_STATES + 1], start[FMU_EVENTS], values[FMU_EVENTS];
    events_at(instance, m->t, m->y, start);
    for (int i = 0; i < FMU_EVENTS; i++)
        if (m->side[i] == 0)
            m->noise[i] = fmax(m->noise[i], DBL_MIN);
    for (int n = 0; n < 4; n++) {
        int open = 0;
        for (int i = 0; i < FMU_EVENTS; i++)
            open |= m->side[i] == 0;
        if (!open)
            return;
        const double h = fmax(early[n]*length, 4.0*DBL_EPSILON*fabs(m->t));
        short_step(instance, h, z);
        events_at(instance, m->t + h, z, values);
        for (int i = 0; i < FMU_EVENTS; i++)
            if (m->side[i] == 0 && fabs(values[i]) > m->noise[i])
                m->side[i] = values[i] > 0.0 ? 1 : -1;
    }
    for (int i = 0; i < FMU_EVENTS; i++)
        if (m->side[i] == 0 && values[i] != start[i])
            m->side[i] = values[i] > start[i] ? 1 : -1;
}

/* The sides at the start of a motion. */
static void begin_sides(Instance *instance)
{
    Motion *m = &instance->motion;
    double values[FMU_EVENTS];
    fmu_events(m->t, m->y, m->p, values);
    for (int i = 0; i < FMU_EVENTS; i++) {
        m->side[i] = 0;
        m->noise[i] = 0.0;
    }
    pass(m, values);
    leave(instance, m->horizon);
}

/* Notes an occurrence. Intervals that shrink like a geometric series which would end soon accumulate, and so do times that
   rounding barely separates: no integration passes that. */
static int note(Instance *instance, int i)
{
    Motion *m = &instance->motion;
    double *times = m->times[i], d[LAST_TIMES - 1];
    const int known = m->occurrences[i] < LAST_TIMES ? m->occurrences[i] : LAST_TIMES;
    if (known > 0) {
        const double last = times[known - 1];
        if (known == 1 || fabs(m->t - last) >= fabs(last - times[known - 2]))
            m->longest[i] = fabs(m->t - last);
    }
    if (known == LAST_TIMES)
        memmove(times, times + 1, (LAST_TIMES - 1)*sizeof *times);
    times[known == LAST_TIMES ? LAST_TIMES - 1 : known] = m->t;
    m->occurrences[i]++;
    if (m->occurrences[i] < LAST_TIMES)
        return 1;
    int shrink = 1;
    for (int n = 0; n < LAST_TIMES - 1; n++) {
        d[n] = times[n + 1] - times[n];
        shrink &= n == 0 || fabs(d[n]) < fabs(d[n - 1]);
    }
    const double last = d[LAST_TIMES - 2], rest = last*last/(d[LAST_TIMES - 3] - last);
    const int ends = shrink && fabs(rest) <= FMU_ACCUMULATION*m->longest[i];
    if (ends || fabs(m->t - times[0]) <= 1e-12*fabs(m->t))
        return wrong(instance, "the event %s accumulates at t = %.9g, after %d occurrences: no simulation passes that",
                     event_names[i], ends ? m->t + rest : m->t, m->occurrences[i]);
    return 1;
}

/* What each function has to exceed after a reset to be told from zero: of those that caused it what the tolerances of the
   state make of zero, if they are that near. */
static void noise_after_reset(Motion *m, const int *due, const double *values)
{
    double perturbation[FMU_EVENTS] = {0.0}, at[FMU_EVENTS];
    for (int s = 0; s < FMU_STATES; s++) {
        const double held = m->y[s];
        m->y[s] += m->relative*fabs(held) + m->absolute*absolute_tolerances[s];
        fmu_events(m->t, m->y, m->p, at);
        m->y[s] = held;
        for (int i = 0; i < FMU_EVENTS; i++)
            if (isfinite(at[i]))
                perturbation[i] += fabs(at[i] - values[i]);
    }
    for (int i = 0; i < FMU_EVENTS; i++) {
        const double value = fabs(values[i]);
        if (due[i] && value > m->noise[i] && value <= TOLERANCES*perturbation[i])
            m->noise[i] = 2.0*value;
    }
}

/* Deals with the events that are due, in the order of the model. All new values of one come of the state before it. `noise`
   is what the functions have to exceed to be told from zero, `beyond` the side of each a little later. */
static int occur(Instance *instance, const int *due, const double *noise, const int *beyond, double length)
{
    Motion *m = &instance->motion;
    double values[FMU_EVENTS];
    int reset = 0;
    inputs_at(instance, m->t);
    for (int i = 0; i < FMU_EVENTS; i++) {
        if (!due[i])
            continue;
#if FMU_RESETS > 0
        if (event_resets[i]) {
            double after[FMU_EVENTS*FMU_STATES + 1];
            fmu_resets(m->t, m->y, m->p, after);
            for (int s = 0; s < FMU_STATES; s++) {
                m->y[s] = after[i*FMU_STATES + s];
                if (!isfinite(m->y[s]))
                    return wrong(instance, "the event %s resets %s to %g at t = %.17g", event_names[i], state_names[s],
                                 m->y[s], m->t);
            }
            reset = 1;
        }
#endif
        m->terminal |= event_terminal[i];
    }
    for (int i = 0; i < FMU_EVENTS; i++) {
        if (reset)
            m->side[i] = 0;
        if (due[i]) {
            m->side[i] = reset ? 0 : beyond[i];
            m->noise[i] = noise[i];
        } else if (reset) {
            m->noise[i] = 0.0;
        }
    }
    moved(m);
    fmu_events(m->t, m->y, m->p, values);
    if (reset) {
        noise_after_reset(m, due, values);
        take_levels(m);
        m->next = 0.0;
    }
    pass(m, values);
    if (reset)
        leave(instance, length);
    for (int i = 0; i < FMU_EVENTS; i++)
        if (due[i] && !note(instance, i) && !m->terminal)
            return 0;
    return 1;
}

/* Rounding of the functions, by that of the state. */
static void rounding(Motion *m, const double *values, double *sums)
{
    static const double PART = 1e-8, ROUNDINGS = 8.0;
    double at[FMU_EVENTS];
    memset(sums, 0, FMU_EVENTS*sizeof *sums);
    for (int s = 0; s < FMU_STATES; s++) {
        const double held = m->y[s];
        m->y[s] += PART*held;
        fmu_events(m->t, m->y, m->p, at);
        m->y[s] = held;
        for (int i = 0; i < FMU_EVENTS; i++)
            if (isfinite(at[i]))
                sums[i] += ROUNDINGS*DBL_EPSILON/PART*fabs(at[i] - values[i]);
    }
}

/* Leaves an event to the importer. */
static void leave_event(Motion *m, const int *due, const double *noise, const int *beyond, double length)
{
    m->waiting = 1;
    m->due_length = length;
    memcpy(m->due, due, FMU_EVENTS*sizeof *due);
    memcpy(m->beyond, beyond, FMU_EVENTS*sizeof *beyond);
    memcpy(m->due_noise, noise, FMU_EVENTS*sizeof *noise);
}

/* Deals with the event that was left. */
static int take_event(Instance *instance, int *changed)
{
    Motion *m = &instance->motion;
    *changed = 0;
    for (int i = 0; i < FMU_EVENTS; i++)
        *changed |= m->due[i] && event_resets[i];
    m->waiting = 0;
    return occur(instance, m->due, m->due_noise, m->beyond, m->due_length);
}

/* At an event that an importer has found, or that was left to it: what is due, if anything. Whether states were reset is left in
   `changed`. */
static int discrete_update(Instance *instance, int *changed)
{
    Motion *m = &instance->motion;
    if (m->waiting)
        return take_event(instance, changed);
    double values[FMU_EVENTS], noise[FMU_EVENTS];
    int due[FMU_EVENTS], beyond[FMU_EVENTS], any = 0;
    fmu_events(m->t, m->y, m->p, values);
    rounding(m, values, noise);
    *changed = 0;
    for (int i = 0; i < FMU_EVENTS; i++) {
        due[i] = crossed(m, i, values[i]);
        beyond[i] = -m->side[i];
        /* So much the importer has gone too far, and no more the next time. */
        noise[i] += (1.0 + 1e-9)*fabs(values[i]);
        any |= due[i];
        *changed |= due[i] && event_resets[i];
    }
    if (any)
        return occur(instance, due, noise, beyond, m->horizon);
    pass(m, values);
    return 1;
}

#endif /* FMU_EVENTS */

#endif
