/* Inputs in the middle of a step of Co-Simulation. They are held where the importer gives no more than their values; follow
   the polynomial of the derivatives that it gives at the start of the step,

       u(t) = u(t_0) + u'(t_0) (t - t_0) + u''(t_0) (t - t_0)^2/2 + ...;

   or are asked for at each time at which the equations are evaluated. */
#ifndef PC_INPUTS_H
#define PC_INPUTS_H

#include "instance.h"

/* Begins a way from a communication point, where the importer has set the inputs. */
static void begin_inputs(Instance *instance, double to)
{
    Motion *m = &instance->motion;
    instance->moving = m->order > 0 || instance->ask;
    instance->from = m->t;
    instance->to = to;
    memcpy(instance->base, m->p, FMU_PARAMETERS*sizeof *m->p);
    instance->inputs_time = m->t;
    if (instance->ask) {
        instance->inputs_time = NAN; /* the importer is asked here too */
        moved(m);
    }
}

/* Makes the inputs those at time t. */
static void inputs_at(Instance *instance, double t)
{
    Motion *m = &instance->motion;
    if (!instance->moving || t == instance->inputs_time)
        return;
    const double since = t - instance->from;
    for (int i = 0; i < FMU_PARAMETERS && m->order > 0; i++)
        if (parameter_kinds[i] == FMU_INPUT) {
            double change = 0.0;
            for (int n = m->order; n > 0; n--)
                change = since/n*(m->slopes[n - 1][i] + change);
            m->p[i] = instance->base[i] + change;
        }
    if (instance->ask)
        instance->ask(instance, fmin(fmax(t, m->t), instance->to));
    instance->inputs_time = t;
}

/* Ends the way: the inputs stay as they are here, and derivatives are forgotten. */
static void end_inputs(Instance *instance)
{
    Motion *m = &instance->motion;
    inputs_at(instance, m->t);
    instance->moving = 0;
    m->order = 0;
    memset(m->slopes, 0, sizeof m->slopes);
}

/* Takes a derivative of an input at the start of the coming step. */
static int set_slope(Instance *instance, int place, int order, double value)
{
    Motion *m = &instance->motion;
    if (order < 1 || order > ORDERS)
        return wrong(instance, "the derivative of order %d of the input %s: orders are 1 to %d", order,
                     parameter_names[place], ORDERS);
    if (!isfinite(value))
        return wrong(instance, "the derivative of order %d of the input %s is %g", order, parameter_names[place], value);
    m->slopes[order - 1][place] = value;
    m->order = order > m->order ? order : m->order;
    return 1;
}

/* The functions of the model, with the inputs at their time. */

static void rates_at(Instance *instance, double t, const double *y, double *rates)
{
    inputs_at(instance, t);
    fmu_rhs(t, y, instance->motion.p, rates);
}

#if FMU_EVENTS > 0
static void events_at(Instance *instance, double t, const double *y, double *values)
{
    inputs_at(instance, t);
    fmu_events(t, y, instance->motion.p, values);
}
#endif

#endif
