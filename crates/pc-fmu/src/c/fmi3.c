/* The functions of FMI 3.0, for Model Exchange and Co-Simulation [Modelica Association, Functional Mock-up Interface
   Specification, version 3.0.1 (2023)]. */
#include "advance.h"
#include "derivatives.h"

#include "fmi3_types.h"

/* Callbacks are kept beside the instance: C does not turn pointers to functions into others. */
typedef struct {
    Instance instance;
    fmi3LogMessageCallback logger;
    fmi3IntermediateUpdateCallback update;
    bool early_return; /* whether a step may end before its end */
} Component;

static void log_error(Instance *instance, const char *text)
{
    const Component *component = (const Component *)instance;
    if (component->logger)
        component->logger(instance->environment, fmi3Error, "logStatusError", text);
}

static fmi3Status status(int right)
{
    return right ? fmi3OK : fmi3Error;
}

/* What there is none of in this model. */
static fmi3Status refuse(fmi3Instance c, const char *what)
{
    return status(wrong(c, "there is no %s here", what));
}

static fmi3Status none(fmi3Instance c, size_t count, const char *what)
{
    return count == 0 ? fmi3OK : refuse(c, what);
}

#include "fmi3_none.h"

EXPORT const char *FMI(fmi3GetVersion)(void)
{
    return "3.0";
}

EXPORT fmi3Status FMI(fmi3SetDebugLogging)(fmi3Instance c, fmi3Boolean on, size_t count, const fmi3String categories[])
{
    (void)c;
    (void)on;
    (void)count;
    (void)categories;
    return fmi3OK; /* errors are always told, and there is nothing else */
}

static fmi3Instance instantiate(fmi3String name, fmi3String token, fmi3InstanceEnvironment environment,
                                fmi3LogMessageCallback logger)
{
    Component *component = calloc(1, sizeof *component);
    if (!component)
        return NULL;
    Instance *instance = &component->instance;
    (void)name;
    component->logger = logger;
    instance->environment = environment;
    instance->log = log_error;
    if (!token || strcmp(token, FMU_TOKEN) != 0) {
        wrong(instance, "the instantiation token %s is not that of this model, %s", token ? token : "(none)", FMU_TOKEN);
        free(component);
        return NULL;
    }
    set_defaults(&instance->motion);
    return component;
}

/* Intermediate update: the importer sets inputs at a time for which the integration needs them, ... */
static void ask(Instance *instance, double t)
{
    const Component *component = (const Component *)instance;
    fmi3Boolean wanted = false;
    fmi3Float64 when = t;
    instance->called = MAY_SET;
    component->update(instance->environment, t, true, false, false, false, &wanted, &when);
    instance->called = UNCALLED;
}

/* ... and looks at each step of the integration that was accepted, after which it may ask for an early return. */
static void tell(Instance *instance, double *to)
{
    const Component *component = (const Component *)instance;
    const double t = instance->motion.t;
    fmi3Boolean wanted = false;
    fmi3Float64 when = t;
    instance->called = MAY_GET;
    component->update(instance->environment, t, false, true, true, component->early_return, &wanted, &when);
    instance->called = UNCALLED;
    if (wanted && component->early_return && when < *to)
        *to = when;
}

/* Takes note of the variables that the importer accesses in the middle of steps. */
static int set_intermediate(Component *component, const fmi3ValueReference of[], size_t count,
                            fmi3IntermediateUpdateCallback update)
{
    Instance *instance = &component->instance;
    if (!update)
        return 1;
    component->update = update;
    instance->tell = tell;
    for (size_t i = 0; i < count; i++)
        if (is_input(of[i])) {
            instance->provided[of[i] - OF_PARAMETERS] = 1;
            instance->ask = ask;
        } else if (!is_continuous(of[i])) {
            return wrong(instance, "the variable of value reference %u is not accessible in intermediate updates", of[i]);
        }
    return 1;
}

static int may_use_event_mode(Instance *instance, int event_mode)
{
    return !event_mode || FMU_EVENTS > 0 || wrong(instance, "there is no event mode: the model has no events");
}

EXPORT fmi3Instance FMI(fmi3InstantiateModelExchange)(fmi3String name, fmi3String token, fmi3String resources,
                                                      fmi3Boolean visible, fmi3Boolean logging,
                                                      fmi3InstanceEnvironment environment, fmi3LogMessageCallback logger)
{
    (void)resources;
    (void)visible;
    (void)logging;
    return instantiate(name, token, environment, logger);
}

EXPORT fmi3Instance FMI(fmi3InstantiateCoSimulation)(fmi3String name, fmi3String token, fmi3String resources,
                                                     fmi3Boolean visible, fmi3Boolean logging, fmi3Boolean event_mode,
                                                     fmi3Boolean early_return, const fmi3ValueReference intermediate[],
                                                     size_t intermediate_count, fmi3InstanceEnvironment environment,
                                                     fmi3LogMessageCallback logger, fmi3IntermediateUpdateCallback update)
{
    (void)resources;
    (void)visible;
    (void)logging;
    Component *component = instantiate(name, token, environment, logger);
    if (!component)
        return NULL;
    component->early_return = early_return;
    /* Where a step has to go to its end, its events occur on the way. */
    component->instance.leaves_events = event_mode && early_return;
    if (!may_use_event_mode(&component->instance, event_mode)
        || !set_intermediate(component, intermediate, intermediate_count, update)) {
        free(component);
        return NULL;
    }
    return component;
}

EXPORT fmi3Instance FMI(fmi3InstantiateScheduledExecution)(fmi3String name, fmi3String token, fmi3String resources,
                                                           fmi3Boolean visible, fmi3Boolean logging,
                                                           fmi3InstanceEnvironment environment,
                                                           fmi3LogMessageCallback logger, fmi3ClockUpdateCallback update,
                                                           fmi3LockPreemptionCallback lock,
                                                           fmi3UnlockPreemptionCallback unlock)
{
    (void)name;
    (void)token;
    (void)resources;
    (void)visible;
    (void)logging;
    (void)update;
    (void)lock;
    (void)unlock;
    if (logger)
        logger(environment, fmi3Error, "logStatusError", "there is no scheduled execution here");
    return NULL;
}

EXPORT void FMI(fmi3FreeInstance)(fmi3Instance c)
{
    free(c);
}

EXPORT fmi3Status FMI(fmi3EnterInitializationMode)(fmi3Instance c, fmi3Boolean with_tolerance, fmi3Float64 tolerance,
                                                   fmi3Float64 start, fmi3Boolean with_stop, fmi3Float64 stop)
{
    Motion *m = &((Instance *)c)->motion;
    set_experiment(m, with_tolerance, tolerance, start, with_stop, stop);
    m->phase = INITIALIZING;
    return fmi3OK;
}

EXPORT fmi3Status FMI(fmi3ExitInitializationMode)(fmi3Instance c)
{
    Instance *instance = c;
    if (!begin(instance))
        return fmi3Error;
    instance->motion.phase = EVENT_MODE;
    return fmi3OK;
}

EXPORT fmi3Status FMI(fmi3EnterEventMode)(fmi3Instance c)
{
    ((Instance *)c)->motion.phase = EVENT_MODE;
    return fmi3OK;
}

EXPORT fmi3Status FMI(fmi3Terminate)(fmi3Instance c)
{
    ((Instance *)c)->motion.phase = TERMINATED;
    return fmi3OK;
}

EXPORT fmi3Status FMI(fmi3Reset)(fmi3Instance c)
{
    set_defaults(&((Instance *)c)->motion);
    return fmi3OK;
}

EXPORT fmi3Status FMI(fmi3GetFloat64)(fmi3Instance c, const fmi3ValueReference of[], size_t count, fmi3Float64 values[],
                                      size_t value_count)
{
    if (count != value_count)
        return refuse(c, "array");
    for (size_t i = 0; i < count; i++)
        if (!get_variable(c, of[i], &values[i]))
            return fmi3Error;
    return fmi3OK;
}

EXPORT fmi3Status FMI(fmi3SetFloat64)(fmi3Instance c, const fmi3ValueReference of[], size_t count,
                                      const fmi3Float64 values[], size_t value_count)
{
    if (count != value_count)
        return refuse(c, "array");
    for (size_t i = 0; i < count; i++)
        if (!set_variable(c, of[i], values[i]))
            return fmi3Error;
    return fmi3OK;
}

EXPORT fmi3Status FMI(fmi3GetFMUState)(fmi3Instance c, fmi3FMUState *state)
{
    if (!*state)
        *state = malloc(sizeof(Motion));
    if (!*state)
        return status(wrong(c, "there is no memory for a state"));
    memcpy(*state, &((Instance *)c)->motion, sizeof(Motion));
    return fmi3OK;
}

EXPORT fmi3Status FMI(fmi3SetFMUState)(fmi3Instance c, fmi3FMUState state)
{
    memcpy(&((Instance *)c)->motion, state, sizeof(Motion));
    return fmi3OK;
}

EXPORT fmi3Status FMI(fmi3FreeFMUState)(fmi3Instance c, fmi3FMUState *state)
{
    (void)c;
    free(*state);
    *state = NULL;
    return fmi3OK;
}

EXPORT fmi3Status FMI(fmi3SerializedFMUStateSize)(fmi3Instance c, fmi3FMUState state, size_t *size)
{
    (void)state;
    (void)c;
    *size = sizeof(Motion);
    return fmi3OK;
}

EXPORT fmi3Status FMI(fmi3SerializeFMUState)(fmi3Instance c, fmi3FMUState state, fmi3Byte bytes[], size_t size)
{
    if (size < sizeof(Motion))
        return status(wrong(c, "a state takes %zu bytes, not %zu", sizeof(Motion), size));
    memcpy(bytes, state, sizeof(Motion));
    return fmi3OK;
}

EXPORT fmi3Status FMI(fmi3DeserializeFMUState)(fmi3Instance c, const fmi3Byte bytes[], size_t size, fmi3FMUState *state)
{
    if (size != sizeof(Motion))
        return status(wrong(c, "a state takes %zu bytes, not %zu", sizeof(Motion), size));
    if (!*state)
        *state = malloc(sizeof(Motion));
    if (!*state)
        return status(wrong(c, "there is no memory for a state"));
    memcpy(*state, bytes, size);
    return fmi3OK;
}

EXPORT fmi3Status FMI(fmi3GetDirectionalDerivative)(fmi3Instance c, const fmi3ValueReference unknowns[],
                                                    size_t unknown_count, const fmi3ValueReference knowns[],
                                                    size_t known_count, const fmi3Float64 seed[], size_t seed_count,
                                                    fmi3Float64 sensitivity[], size_t sensitivity_count)
{
    if (seed_count != known_count || sensitivity_count != unknown_count)
        return refuse(c, "array");
    return status(directional(c, unknowns, unknown_count, knowns, known_count, seed, sensitivity));
}

EXPORT fmi3Status FMI(fmi3GetAdjointDerivative)(fmi3Instance c, const fmi3ValueReference unknowns[],
                                                size_t unknown_count, const fmi3ValueReference knowns[],
                                                size_t known_count, const fmi3Float64 seed[], size_t seed_count,
                                                fmi3Float64 sensitivity[], size_t sensitivity_count)
{
    if (seed_count != unknown_count || sensitivity_count != known_count)
        return refuse(c, "array");
    return status(adjoint(c, unknowns, unknown_count, knowns, known_count, seed, sensitivity));
}

EXPORT fmi3Status FMI(fmi3EvaluateDiscreteStates)(fmi3Instance c)
{
    (void)c;
    return fmi3OK; /* there are none */
}

EXPORT fmi3Status FMI(fmi3UpdateDiscreteStates)(fmi3Instance c, fmi3Boolean *again, fmi3Boolean *terminate,
                                                fmi3Boolean *nominals_changed, fmi3Boolean *values_changed,
                                                fmi3Boolean *with_next, fmi3Float64 *next)
{
    Instance *instance = c;
    int changed = 0;
#if FMU_EVENTS > 0
    if (!discrete_update(instance, &changed))
        return fmi3Error;
#endif
    *again = *nominals_changed = *with_next = false;
    *next = 0.0;
    *terminate = instance->motion.terminal;
    *values_changed = changed;
    return fmi3OK;
}

/* Model Exchange */

EXPORT fmi3Status FMI(fmi3EnterContinuousTimeMode)(fmi3Instance c)
{
    ((Instance *)c)->motion.phase = CONTINUOUS;
    return fmi3OK;
}

EXPORT fmi3Status FMI(fmi3CompletedIntegratorStep)(fmi3Instance c, fmi3Boolean never_back, fmi3Boolean *event_mode,
                                                   fmi3Boolean *terminate)
{
    (void)never_back;
    int event = 0;
    if (!completed_step(c, &event))
        return fmi3Error;
    *event_mode = event;
    *terminate = false;
    return fmi3OK;
}

EXPORT fmi3Status FMI(fmi3SetTime)(fmi3Instance c, fmi3Float64 t)
{
    ((Instance *)c)->motion.t = t;
    moved(&((Instance *)c)->motion);
    return fmi3OK;
}

EXPORT fmi3Status FMI(fmi3SetContinuousStates)(fmi3Instance c, const fmi3Float64 y[], size_t count)
{
    return status(set_states(c, y, count));
}

EXPORT fmi3Status FMI(fmi3GetContinuousStateDerivatives)(fmi3Instance c, fmi3Float64 y[], size_t count)
{
    return status(get_rates(c, y, count));
}

EXPORT fmi3Status FMI(fmi3GetEventIndicators)(fmi3Instance c, fmi3Float64 y[], size_t count)
{
    return status(get_indicators(c, y, count));
}

EXPORT fmi3Status FMI(fmi3GetContinuousStates)(fmi3Instance c, fmi3Float64 y[], size_t count)
{
    return status(get_states(c, y, count));
}

EXPORT fmi3Status FMI(fmi3GetNominalsOfContinuousStates)(fmi3Instance c, fmi3Float64 nominals[], size_t count)
{
    (void)c;
    for (size_t i = 0; i < count; i++)
        nominals[i] = i < FMU_STATES ? nominal_values[i] : 1.0;
    return fmi3OK;
}

EXPORT fmi3Status FMI(fmi3GetNumberOfEventIndicators)(fmi3Instance c, size_t *count)
{
    (void)c;
    *count = FMU_EVENTS;
    return fmi3OK;
}

EXPORT fmi3Status FMI(fmi3GetNumberOfContinuousStates)(fmi3Instance c, size_t *count)
{
    (void)c;
    *count = FMU_STATES;
    return fmi3OK;
}

/* Co-Simulation */

EXPORT fmi3Status FMI(fmi3EnterStepMode)(fmi3Instance c)
{
    ((Instance *)c)->motion.phase = STEPPING;
    return fmi3OK;
}

EXPORT fmi3Status FMI(fmi3DoStep)(fmi3Instance c, fmi3Float64 t, fmi3Float64 length, fmi3Boolean never_back,
                                  fmi3Boolean *event, fmi3Boolean *terminate, fmi3Boolean *early, fmi3Float64 *last)
{
    (void)never_back;
    Instance *instance = c;
    const Component *component = c;
    const int right = do_step(instance, t, length);
    *event = instance->motion.waiting;
    *terminate = instance->motion.terminal;
    *last = instance->motion.t;
    *early = right && component->early_return && *last < t + length;
    return status(right);
}
