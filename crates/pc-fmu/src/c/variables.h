/* The variables of the FMU by their value references: time, states, their rates, parameters and inputs, what is observed,
   event indicators. */
#ifndef PC_VARIABLES_H
#define PC_VARIABLES_H

#include "events.h"

enum {
    OF_TIME = 0,
    OF_STATES = 1,
    OF_RATES = OF_STATES + FMU_STATES,
    OF_PARAMETERS = OF_RATES + FMU_STATES,
    OF_OBSERVED = OF_PARAMETERS + FMU_PARAMETERS,
    OF_INDICATORS = OF_OBSERVED + FMU_OBSERVED,
    OF_NOTHING = OF_INDICATORS + FMU_EVENTS
};

/* Whether a variable is computed and continuous. */
static int is_continuous(unsigned reference)
{
    return (reference >= OF_STATES && reference < OF_PARAMETERS) || (reference >= OF_OBSERVED && reference < OF_INDICATORS);
}

static int is_input(unsigned reference)
{
    return reference >= OF_PARAMETERS && reference < OF_OBSERVED
           && parameter_kinds[reference - OF_PARAMETERS] == FMU_INPUT;
}

static int get_variable(Instance *instance, unsigned reference, double *value)
{
    Motion *m = &instance->motion;
    if (instance->called == MAY_SET)
        return wrong(instance, "no variable has a value yet at this time: inputs are asked for");
    if (reference == OF_TIME)
        *value = m->t;
    else if (reference < OF_RATES)
        *value = m->y[reference - OF_STATES];
    else if (reference >= OF_PARAMETERS && reference < OF_OBSERVED)
        *value = m->p[reference - OF_PARAMETERS];
    else if (reference >= OF_NOTHING)
        return wrong(instance, "there is no variable of value reference %u", reference);
#if FMU_EVENTS > 0
    else if (reference >= OF_INDICATORS) {
        double values[FMU_EVENTS];
        fmu_events(m->t, m->y, m->p, values);
        *value = indicator(m, (int)(reference - OF_INDICATORS), values[reference - OF_INDICATORS]);
    }
#endif
    else if (reference >= OF_OBSERVED) {
        observe(m);
        *value = m->observed[reference - OF_OBSERVED];
    } else {
        if (!evaluate(instance))
            return 0;
        *value = m->rates[reference - OF_RATES];
    }
    return 1;
}

/* Sets an input in the middle of a step. */
static int provide(Instance *instance, unsigned reference, double value)
{
    if (instance->called != MAY_SET)
        return wrong(instance, "no variable can be set at the end of a step of the integration");
    if (!is_input(reference) || !instance->provided[reference - OF_PARAMETERS])
        return wrong(instance, "the variable of value reference %u is no input that was named as an intermediate variable",
                     reference);
    if (!isfinite(value))
        return wrong(instance, "the input %s is set to %g", parameter_names[reference - OF_PARAMETERS], value);
    instance->motion.p[reference - OF_PARAMETERS] = value;
    return 1;
}

static int set_variable(Instance *instance, unsigned reference, double value)
{
    if (instance->called != UNCALLED)
        return provide(instance, reference, value);
    Motion *m = &instance->motion;
    const int begins = m->phase == INSTANTIATED || m->phase == INITIALIZING;
    if (!isfinite(value))
        return wrong(instance, "the variable of value reference %u is set to %g", reference, value);
    if (reference >= OF_STATES && reference < OF_RATES) {
        const int i = (int)(reference - OF_STATES);
        if (!start_is_exact[i])
            return wrong(instance, "the start of %s follows from the parameters: it cannot be set", state_names[i]);
        if (!begins)
            return wrong(instance, "%s is set after the start", state_names[i]);
        m->y[i] = value;
        m->given[i] = 1;
    } else if (reference >= OF_PARAMETERS && reference < OF_OBSERVED) {
        const int i = (int)(reference - OF_PARAMETERS);
        if (parameter_kinds[i] == FMU_FOLLOWS)
            return wrong(instance, "the parameter %s follows from others: it cannot be set", parameter_names[i]);
        if (parameter_kinds[i] == FMU_PARAMETER && FMU_FIXED && !begins)
            return wrong(instance, "the parameter %s is set after the start", parameter_names[i]);
        m->p[i] = value;
    } else {
        return wrong(instance, "the variable of value reference %u cannot be set", reference);
    }
    follow(m);
    return 1;
}

/* The end of the initialization. */
static int begin(Instance *instance)
{
    Motion *m = &instance->motion;
    follow(m);
    if (!evaluate(instance) || !on_constraints(instance, "the start") || !within_chart(instance, m->t, m->y, 1))
        return 0;
    take_levels(m);
#if FMU_EVENTS > 0
    begin_sides(instance);
#endif
    return 1;
}

static void set_experiment(Motion *m, int with_tolerance, double tolerance, double start, int with_stop, double stop)
{
    m->t = m->t_start = start;
    if (with_tolerance && tolerance > 0.0) {
        m->relative = fmax(tolerance, 10.0*DBL_EPSILON);
        m->absolute = fmin(1.0, m->relative/FMU_RELATIVE);
    }
    if (with_stop && stop > start)
        m->horizon = stop - start;
    follow(m);
}

static int of_states(Instance *instance, size_t count)
{
    return count == FMU_STATES || wrong(instance, "there are %d states, not %zu", FMU_STATES, count);
}

static int set_states(Instance *instance, const double *y, size_t count)
{
    if (!of_states(instance, count))
        return 0;
    memcpy(instance->motion.y, y, count*sizeof *y);
    moved(&instance->motion);
    return 1;
}

static int get_states(Instance *instance, double *y, size_t count)
{
    if (!of_states(instance, count))
        return 0;
    memcpy(y, instance->motion.y, count*sizeof *y);
    return 1;
}

static int get_rates(Instance *instance, double *rates, size_t count)
{
    if (!of_states(instance, count) || !evaluate(instance))
        return 0;
    memcpy(rates, instance->motion.rates, count*sizeof *rates);
    return 1;
}

static int get_indicators(Instance *instance, double *values, size_t count)
{
    if (count != FMU_EVENTS)
        return wrong(instance, "there are %d event indicators, not %zu", FMU_EVENTS, count);
#if FMU_EVENTS > 0
    const Motion *m = &instance->motion;
    fmu_events(m->t, m->y, m->p, values);
    for (int i = 0; i < FMU_EVENTS; i++)
        values[i] = indicator(m, i, values[i]);
#else
    (void)values;
#endif
    return 1;
}

/* After a step of the importer: whether something has occurred that it has not seen. */
static int completed_step(Instance *instance, int *event)
{
    Motion *m = &instance->motion;
    *event = 0;
    if (!within_chart(instance, m->t, m->y, 0))
        return 0;
#if FMU_EVENTS > 0
    double values[FMU_EVENTS];
    fmu_events(m->t, m->y, m->p, values);
    for (int i = 0; i < FMU_EVENTS; i++)
        *event |= crossed(m, i, values[i]);
    if (!*event)
        pass(m, values);
#endif
    return 1;
}

#endif
