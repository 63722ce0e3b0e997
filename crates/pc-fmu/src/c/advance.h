/* The integration of Co-Simulation: from one communication point to the next, over all events between. */
#ifndef PC_ADVANCE_H
#define PC_ADVANCE_H

#include "step.h"
#include "variables.h"

/* A step that would leave less than this part of itself to the end goes there. */
static const double LEFT = 0.01;

#if FMU_SOLVER != FMU_RK4
/* The length of a first step by the sizes of y, its rates and their change [Hairer, Norsett, Wanner 1993, II.4]. */
static double first_length(Instance *instance, double farthest)
{
    const Motion *m = &instance->motion;
    double state = 0.0, rates = 0.0, second = 0.0, later[FMU_STATES + 1];
    for (int s = 0; s < FMU_STATES; s++) {
        const double w = weight(m, s, m->y[s]);
        state += m->y[s]/w*(m->y[s]/w);
        rates += m->rates[s]/w*(m->rates[s]/w);
    }
    state = sqrt(state);
    rates = sqrt(rates);
    const double h = fmin(state <= 1e-5 || rates <= 1e-5 ? 1e-6 : 0.01*state/rates, farthest);
    for (int s = 0; s < FMU_STATES; s++)
        instance->argument[s] = m->y[s] + h*m->rates[s];
    rates_at(instance, m->t + h, instance->argument, later);
    if (!all_finite(later, FMU_STATES))
        return h;
    for (int s = 0; s < FMU_STATES; s++) {
        const double change = (later[s] - m->rates[s])/weight(m, s, m->y[s]);
        second += change*change;
    }
    const double largest = fmax(sqrt(second)/h, rates);
    const double by_rates = largest <= 1e-15 ? fmax(1e-6, h*1e-3) : pow(0.01/largest, 1.0/ORDER);
    return fmin(fmin(100.0*h, by_rates), farthest);
}
#endif

#if FMU_EVENTS > 0

/* A state of the step that is looked at: how far it is from the start, and the functions of the events. */
typedef struct {
    double length, y[FMU_STATES + 1], values[FMU_EVENTS];
} Sample;

static int any_crossed(const Motion *m, const double *values)
{
    for (int i = 0; i < FMU_EVENTS; i++)
        if (crossed(m, i, values[i]))
            return 1;
    return 0;
}

/* The state after a step of this length, made for itself. */
static int look(Instance *instance, double length, Sample *sample)
{
    Motion *m = &instance->motion;
    sample->length = length;
    if (isnan(step(instance, m->t, m->y, m->rates, length, sample->y))
        || !project(instance, m->t + length, sample->y))
        return wrong(instance, "a step to an event after t = %.17g fails", m->t);
    events_at(instance, m->t + length, sample->y, sample->values);
    return 1;
}

typedef enum { FAILED = -1, CLEAR = 0, OCCURRED = 1 } Found;

/* Locates the first passage between `a`, where there has been none, and `b`: by secants with Illinois' weights, and by
   bisection where these are slow. */
static Found locate(Instance *instance, Sample *a, Sample *b)
{
    Motion *m = &instance->motion;
    const double scale = fmax(fmax(fabs(m->t), fabs(m->t + b->length)), 1e-3*b->length);
    const double tolerance = 4.0*DBL_EPSILON*scale;
    double weight_a = 1.0, weight_b = 1.0, goal = (b->length - a->length)/8.0;
    int moved_b = -1, tries = 0;
    static const int most = 400;
    for (int n = 0; n < most && b->length - a->length > tolerance; n++) {
        const double width = b->length - a->length;
        double fraction = 1.0;
        Sample middle;
        if (width <= goal) {
            goal = width/8.0;
            tries = 0;
        }
        if (++tries > 4)
            fraction = 0.5;
        else
            for (int i = 0; i < FMU_EVENTS; i++)
                if (crossed(m, i, b->values[i])) {
                    const double u = weight_a*a->values[i], v = weight_b*b->values[i];
                    fraction = fmin(fraction, u/(u - v));
                }
        const double edge = fmin(0.5*tolerance/width, 0.5);
        fraction = isfinite(fraction) ? fmin(fmax(fraction, edge), 1.0 - edge) : 0.5;
        const double length = a->length + fraction*width;
        if (length <= a->length || length >= b->length)
            break;
        if (!look(instance, length, &middle))
            return FAILED;
        const int moves_b = any_crossed(m, middle.values), repeated = moved_b == moves_b;
        if (moves_b) {
            weight_a = repeated ? 0.5*weight_a : 1.0;
            weight_b = 1.0;
            *b = middle;
        } else {
            weight_b = repeated ? 0.5*weight_b : 1.0;
            weight_a = 1.0;
            pass(m, middle.values);
            *a = middle;
        }
        moved_b = moves_b;
    }

    /* A little later: what passes through zero at the same time, and what only touches it. */
    double rates[FMU_STATES + 1], later[FMU_STATES + 1], values[FMU_EVENTS], noise[FMU_EVENTS];
    int due[FMU_EVENTS], beyond[FMU_EVENTS], any = 0;
    const double t = m->t + b->length, moment = 64.0*DBL_EPSILON*scale;
    rates_at(instance, t, b->y, rates);
    for (int s = 0; s < FMU_STATES; s++)
        later[s] = b->y[s] + moment*rates[s];
    events_at(instance, t + moment, later, values);
    for (int i = 0; i < FMU_EVENTS; i++) {
        const int seen = crossed(m, i, b->values[i]) || crossed(m, i, values[i]);
        due[i] = seen && !(values[i]*m->side[i] > m->noise[i]);
        beyond[i] = values[i] > 0.0 ? 1 : values[i] < 0.0 ? -1 : 0;
        noise[i] = 16.0*fmax(fmax(fabs(a->values[i]), fabs(b->values[i])), fabs(values[i]));
        any |= due[i];
    }
    if (!any) {
        pass_touch(m, values);
        return CLEAR;
    }
    const double length = b->length;
    m->t = t;
    memcpy(m->y, b->y, FMU_STATES*sizeof *b->y);
    moved(m);
    if (!evaluate(instance))
        return FAILED;
    if (instance->leaves_events) {
        leave_event(m, due, noise, beyond, length);
        return OCCURRED;
    }
    return occur(instance, due, noise, beyond, length) ? OCCURRED : FAILED;
}

/* Looks along a step of length h, which ends at `end`, for the first event; the motion is there then. */
static Found search(Instance *instance, double h, const double *end)
{
    Motion *m = &instance->motion;
    enum { PARTS = 4*FMU_SAMPLES };
    Sample left, right;
    left.length = 0.0;
    memcpy(left.y, m->y, FMU_STATES*sizeof *m->y);
    events_at(instance, m->t, left.y, left.values);
    for (int i = 0; i < FMU_EVENTS; i++)
        if (m->side[i] == 0) {
            leave(instance, h);
            break;
        }
    prepare_dense(instance, m->t, end);
    for (int n = 1; n <= PARTS; n++) {
        right.length = n == PARTS ? h : h*n/PARTS;
        if (n == PARTS)
            memcpy(right.y, end, FMU_STATES*sizeof *end);
        else
            inside(instance, (double)n/PARTS, right.y);
        events_at(instance, m->t + right.length, right.y, right.values);
        if (any_crossed(m, right.values)) {
            double whole[FMU_STATES + 1];
            /* The polynomial is good enough to look; a step of its own says where it is. */
            if (n < PARTS && !look(instance, right.length, &right))
                return FAILED;
            if (any_crossed(m, right.values)) {
                Sample from = left, to = right;
                const Found found = locate(instance, &from, &to);
                if (found != CLEAR)
                    return found;
            }
            step(instance, m->t, m->y, m->rates, h, whole);
            prepare_dense(instance, m->t, whole);
            pass_touch(m, right.values);
        } else {
            pass(m, right.values);
        }
        left = right;
    }
    return CLEAR;
}

#endif

/* After a step of the integration: the importer, where it asks for that, looks at the motion, and may shorten the way. */
static void finish_step(Instance *instance, double *to)
{
    if (!instance->tell)
        return;
    inputs_at(instance, instance->motion.t);
    instance->tell(instance, to);
    *to = fmax(*to, instance->motion.t);
}

/* Goes to time `to`, or to a terminal event before it, or to one that is left to the importer, or less far where the importer
   asks for that; 0 where that fails. */
static int advance(Instance *instance, double to)
{
    Motion *m = &instance->motion;
    double end[FMU_STATES + 1];
    while (m->t < to && !m->terminal && !m->waiting) {
        if (!evaluate(instance))
            return 0;
        const double left = to - m->t;
#if FMU_SOLVER == FMU_RK4
        double planned = left/ceil(left/FMU_FIXED_STEP*(1.0 - 1e-12));
#else
        double planned = m->next > 0.0 ? m->next : first_length(instance, fmin(left, FMU_MAX_STEP));
        planned = fmin(planned, FMU_MAX_STEP);
#endif
        double h = planned, error;
        int refused = 0, ends;
        for (;;) {
            ends = h*(1.0 + LEFT) >= left;
            if (ends)
                h = left;
            error = step(instance, m->t, m->y, m->rates, h, end);
            if (error <= 1.0 && project(instance, m->t + h, end))
                break;
#if FMU_SOLVER == FMU_RK4
            return wrong(instance, "a step of length %g fails at t = %.17g", h, m->t);
#else
            const double factor = isfinite(error) && error > 1.0 ? 0.9*pow(error, -1.0/ORDER) : 0.5;
            h *= fmax(factor, 1.0/3.0);
            refused = 1;
            if (h <= 4.0*DBL_EPSILON*fabs(m->t) || m->t + h == m->t)
                return wrong(instance, "no step is short enough at t = %.17g for the tolerance %g", m->t, m->relative);
#endif
        }
        if (!within_chart(instance, m->t + h, end, 0))
            return 0;
#if FMU_EVENTS > 0
        switch (search(instance, h, end)) {
        case FAILED:
            return 0;
        case OCCURRED:
            finish_step(instance, &to);
            continue;
        case CLEAR:
            break;
        }
#endif
        m->t = ends ? to : m->t + h;
        memcpy(m->y, end, FMU_STATES*sizeof *end);
        moved(m);
        double factor = error > 0.0 ? fmin(6.0, 0.9*pow(error, -1.0/ORDER)) : 6.0;
        factor = refused ? fmin(factor, 1.0) : factor;
        /* A step that had to end here says little of how long one may be. */
        m->next = ends && !refused ? fmax(h*factor, planned) : h*factor;
        finish_step(instance, &to);
    }
    return 1;
}

/* A step of Co-Simulation from the communication point t. */
static int do_step(Instance *instance, double t, double length)
{
    Motion *m = &instance->motion;
    if (m->terminal)
        return wrong(instance, "a terminal event has ended the simulation at t = %.17g", m->t);
    if (m->waiting)
        return wrong(instance, "an event has occurred at t = %.17g: it is dealt with in event mode", m->t);
    if (!(length >= 0.0) || !isfinite(t + length))
        return wrong(instance, "a step of length %g", length);
    if (fabs(t - m->t) > 1e-9*fmax(fmax(fabs(t), fabs(m->t)), length))
        return wrong(instance, "a step from t = %.17g, but the instance is at t = %.17g", t, m->t);
    m->phase = STEPPING;
    m->t = t;
    begin_inputs(instance, t + length);
    const int right = advance(instance, t + length);
    end_inputs(instance);
    return right;
}

#endif
