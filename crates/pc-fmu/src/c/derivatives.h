/* Derivatives of what is computed by what is known: time, states, parameters and inputs. */
#ifndef PC_DERIVATIVES_H
#define PC_DERIVATIVES_H

#include "variables.h"

#if FMU_DERIVATIVES

/* A direction, in the order that `fmu_directional` reads: the parameters, then how the states and the parameters change; and
   how time does. */
typedef struct {
    double along[FMU_STATES + 2*FMU_PARAMETERS + 1];
    double of_time;
} Direction;

static double *state_changes(Direction *direction)
{
    return direction->along + FMU_PARAMETERS;
}

static double *parameter_changes(Direction *direction)
{
    return direction->along + FMU_PARAMETERS + FMU_STATES;
}

/* Adds a change of a known variable. */
static int change(Instance *instance, Direction *direction, unsigned known, double seed)
{
    if (known == OF_TIME)
        direction->of_time += seed;
    else if (known >= OF_STATES && known < OF_RATES)
        state_changes(direction)[known - OF_STATES] += seed;
    else if (known >= OF_PARAMETERS && known < OF_OBSERVED && parameter_kinds[known - OF_PARAMETERS] != FMU_FOLLOWS)
        parameter_changes(direction)[known - OF_PARAMETERS] += seed;
    else
        return wrong(instance, "derivatives are taken by time, states, parameters and inputs, not by value reference %u",
                     known);
    return 1;
}

/* Makes what follows from parameters change with them: other parameters, and the start until the motion has begun. */
static void follow_change(const Motion *m, Direction *direction)
{
    (void)m;
    (void)direction;
#if FMU_CALCULATED_SLOPES > 0
    double calculated[FMU_CALCULATED_SLOPES];
    fmu_calculated_slopes(m->t, m->y, m->p, calculated);
    for (int n = 0; n < FMU_CALCULATED_SLOPES; n++)
        parameter_changes(direction)[calculated_slope_of[n]] +=
            calculated[n]*parameter_changes(direction)[calculated_slope_by[n]];
#endif
#if FMU_START_SLOPES > 0
    double start[FMU_START_SLOPES];
    if (m->phase != INSTANTIATED && m->phase != INITIALIZING)
        return;
    fmu_start_slopes(m->t, m->y, m->p, start);
    for (int n = 0; n < FMU_START_SLOPES; n++)
        if (!m->given[start_slope_of[n]])
            state_changes(direction)[start_slope_of[n]] += start[n]*parameter_changes(direction)[start_slope_by[n]];
#endif
}

/* The derivatives of the rates, then of what is observed, along a direction of known variables. */
static int differentiate(Instance *instance, const unsigned *knowns, size_t count, const double *seed, Direction *direction,
                         double *values)
{
    const Motion *m = &instance->motion;
    memset(direction, 0, sizeof *direction);
    memcpy(direction->along, m->p, FMU_PARAMETERS*sizeof *m->p);
    for (size_t n = 0; n < count; n++)
        if (!change(instance, direction, knowns[n], seed[n]))
            return 0;
    follow_change(m, direction);
    fmu_directional(m->t, m->y, direction->along, values);
#if FMU_TIME_SLOPES > 0
    double by_time[FMU_STATES + FMU_OBSERVED + 1];
    fmu_time_slopes(m->t, m->y, m->p, by_time);
    for (int i = 0; i < FMU_STATES + FMU_OBSERVED; i++)
        values[i] += direction->of_time*by_time[i];
#endif
    return 1;
}

/* That of one variable. */
static int slope_of(Instance *instance, unsigned unknown, Direction *direction, const double *values, double *slope)
{
    if (unknown >= OF_STATES && unknown < OF_RATES)
        *slope = state_changes(direction)[unknown - OF_STATES];
    else if (unknown >= OF_RATES && unknown < OF_PARAMETERS)
        *slope = values[unknown - OF_RATES];
    else if (unknown >= OF_PARAMETERS && unknown < OF_OBSERVED)
        *slope = parameter_changes(direction)[unknown - OF_PARAMETERS];
    else if (unknown >= OF_OBSERVED && unknown < OF_INDICATORS)
        *slope = values[FMU_STATES + unknown - OF_OBSERVED];
    else
        return wrong(instance, "there are no derivatives of value reference %u", unknown);
    return 1;
}

/* The derivatives of some variables along a direction of known ones. */
static int directional(Instance *instance, const unsigned *unknowns, size_t m_unknowns, const unsigned *knowns,
                       size_t m_knowns, const double *seed, double *sensitivity)
{
    Direction direction;
    double values[FMU_STATES + FMU_OBSERVED + 1];
    if (!differentiate(instance, knowns, m_knowns, seed, &direction, values))
        return 0;
    for (size_t n = 0; n < m_unknowns; n++)
        if (!slope_of(instance, unknowns[n], &direction, values, &sensitivity[n]))
            return 0;
    return 1;
}

/* The derivatives of a linear combination of some variables by known ones, along one of these after the other. */
static int adjoint(Instance *instance, const unsigned *unknowns, size_t m_unknowns, const unsigned *knowns, size_t m_knowns,
                   const double *seed, double *sensitivity)
{
    static const double one = 1.0;
    for (size_t n = 0; n < m_knowns; n++) {
        Direction direction;
        double values[FMU_STATES + FMU_OBSERVED + 1], slope;
        if (!differentiate(instance, &knowns[n], 1, &one, &direction, values))
            return 0;
        sensitivity[n] = 0.0;
        for (size_t i = 0; i < m_unknowns; i++) {
            if (!slope_of(instance, unknowns[i], &direction, values, &slope))
                return 0;
            sensitivity[n] += seed[i]*slope;
        }
    }
    return 1;
}

#else

static int directional(Instance *instance, const unsigned *unknowns, size_t m_unknowns, const unsigned *knowns,
                       size_t m_knowns, const double *seed, double *sensitivity)
{
    (void)unknowns;
    (void)m_unknowns;
    (void)knowns;
    (void)m_knowns;
    (void)seed;
    (void)sensitivity;
    return wrong(instance, "the equations of this model are too long for their derivatives");
}

static int adjoint(Instance *instance, const unsigned *unknowns, size_t m_unknowns, const unsigned *knowns, size_t m_knowns,
                   const double *seed, double *sensitivity)
{
    return directional(instance, unknowns, m_unknowns, knowns, m_knowns, seed, sensitivity);
}

#endif

#endif
