/* The functions of FMI 2.0, for Model Exchange and Co-Simulation [Modelica Association, Functional Mock-up Interface for
   Model Exchange and Co-Simulation, version 2.0.4 (2022)]. */
#include "advance.h"
#include "derivatives.h"

#if defined _WIN32
#define EXPORT __declspec(dllexport)
#elif defined __GNUC__
#define EXPORT __attribute__((visibility("default")))
#else
#define EXPORT
#endif

/* Names begin with the name of the model where this is part of a larger program. */
#define JOINED(a, b) a##b
#define NAMED(a, b) JOINED(a, b)
#ifdef FMI2_FUNCTION_PREFIX
#define FMI(name) NAMED(FMI2_FUNCTION_PREFIX, name)
#else
#define FMI(name) name
#endif

typedef void *fmi2Component, *fmi2ComponentEnvironment, *fmi2FMUstate;
typedef unsigned fmi2ValueReference;
typedef double fmi2Real;
typedef int fmi2Integer, fmi2Boolean;
typedef char fmi2Byte;
typedef const char *fmi2String;
typedef enum { fmi2OK, fmi2Warning, fmi2Discard, fmi2Error, fmi2Fatal, fmi2Pending } fmi2Status;
typedef enum { fmi2ModelExchange, fmi2CoSimulation } fmi2Type;
typedef enum { fmi2DoStepStatus, fmi2PendingStatus, fmi2LastSuccessfulTime, fmi2Terminated } fmi2StatusKind;
typedef void (*fmi2CallbackLogger)(fmi2ComponentEnvironment, fmi2String, fmi2Status, fmi2String, fmi2String, ...);

typedef struct {
    fmi2CallbackLogger logger;
    void *(*allocateMemory)(size_t, size_t);
    void (*freeMemory)(void *);
    void (*stepFinished)(fmi2ComponentEnvironment, fmi2Status);
    fmi2ComponentEnvironment componentEnvironment;
} fmi2CallbackFunctions;

typedef struct {
    fmi2Boolean newDiscreteStatesNeeded, terminateSimulation, nominalsOfContinuousStatesChanged;
    fmi2Boolean valuesOfContinuousStatesChanged, nextEventTimeDefined;
    fmi2Real nextEventTime;
} fmi2EventInfo;

/* The logger is kept beside the instance: C does not turn pointers to functions into others. */
typedef struct {
    Instance instance;
    fmi2CallbackLogger logger;
} Component;

static void log_error(Instance *instance, const char *text)
{
    const Component *component = (const Component *)instance;
    if (component->logger)
        component->logger(instance->environment, instance->name, fmi2Error, "logStatusError", "%s", text);
}

static fmi2Status status(int right)
{
    return right ? fmi2OK : fmi2Error;
}

/* Whether there is nothing to get or set of a type that no variable has. */
static fmi2Status none(fmi2Component c, size_t count)
{
    return count == 0 ? fmi2OK : status(wrong(c, "all variables are real"));
}

EXPORT const char *FMI(fmi2GetTypesPlatform)(void)
{
    return "default";
}

EXPORT const char *FMI(fmi2GetVersion)(void)
{
    return "2.0";
}

EXPORT fmi2Status FMI(fmi2SetDebugLogging)(fmi2Component c, fmi2Boolean on, size_t count, const fmi2String categories[])
{
    (void)c;
    (void)on;
    (void)count;
    (void)categories;
    return fmi2OK; /* errors are always told, and there is nothing else */
}

EXPORT fmi2Component FMI(fmi2Instantiate)(fmi2String name, fmi2Type type, fmi2String guid, fmi2String resources,
                                          const fmi2CallbackFunctions *functions, fmi2Boolean visible, fmi2Boolean logging)
{
    (void)type;
    (void)resources;
    (void)visible;
    (void)logging;
    Component *component = calloc(1, sizeof *component);
    if (!component)
        return NULL;
    Instance *instance = &component->instance;
    component->logger = functions ? functions->logger : NULL;
    instance->environment = functions ? functions->componentEnvironment : NULL;
    instance->log = log_error;
    const size_t length = name ? strlen(name) : 0;
    instance->name = calloc(length + 1, 1);
    if (!instance->name) {
        free(component);
        return NULL;
    }
    memcpy(instance->name, name ? name : "", length);
    if (!guid || strcmp(guid, FMU_TOKEN) != 0) {
        wrong(instance, "the GUID %s is not that of this model, %s", guid ? guid : "(none)", FMU_TOKEN);
        free(instance->name);
        free(component);
        return NULL;
    }
    set_defaults(&instance->motion);
    return component;
}

EXPORT void FMI(fmi2FreeInstance)(fmi2Component c)
{
    if (c)
        free(((Instance *)c)->name);
    free(c);
}

EXPORT fmi2Status FMI(fmi2SetupExperiment)(fmi2Component c, fmi2Boolean with_tolerance, fmi2Real tolerance, fmi2Real start,
                                           fmi2Boolean with_stop, fmi2Real stop)
{
    set_experiment(&((Instance *)c)->motion, with_tolerance, tolerance, start, with_stop, stop);
    return fmi2OK;
}

EXPORT fmi2Status FMI(fmi2EnterInitializationMode)(fmi2Component c)
{
    ((Instance *)c)->motion.phase = INITIALIZING;
    return fmi2OK;
}

EXPORT fmi2Status FMI(fmi2ExitInitializationMode)(fmi2Component c)
{
    Instance *instance = c;
    if (!begin(instance))
        return fmi2Error;
    instance->motion.phase = EVENT_MODE;
    return fmi2OK;
}

EXPORT fmi2Status FMI(fmi2Terminate)(fmi2Component c)
{
    ((Instance *)c)->motion.phase = TERMINATED;
    return fmi2OK;
}

EXPORT fmi2Status FMI(fmi2Reset)(fmi2Component c)
{
    set_defaults(&((Instance *)c)->motion);
    return fmi2OK;
}

EXPORT fmi2Status FMI(fmi2GetReal)(fmi2Component c, const fmi2ValueReference of[], size_t count, fmi2Real values[])
{
    for (size_t i = 0; i < count; i++)
        if (!get_variable(c, of[i], &values[i]))
            return fmi2Error;
    return fmi2OK;
}

EXPORT fmi2Status FMI(fmi2SetReal)(fmi2Component c, const fmi2ValueReference of[], size_t count, const fmi2Real values[])
{
    for (size_t i = 0; i < count; i++)
        if (!set_variable(c, of[i], values[i]))
            return fmi2Error;
    return fmi2OK;
}

#define OF_NO_VARIABLE(name, type)                                                                                            \
    EXPORT fmi2Status FMI(fmi2Get##name)(fmi2Component c, const fmi2ValueReference of[], size_t count, type values[])         \
    {                                                                                                                         \
        (void)of;                                                                                                             \
        (void)values;                                                                                                         \
        return none(c, count);                                                                                                \
    }                                                                                                                         \
    EXPORT fmi2Status FMI(fmi2Set##name)(fmi2Component c, const fmi2ValueReference of[], size_t count, const type values[])   \
    {                                                                                                                         \
        (void)of;                                                                                                             \
        (void)values;                                                                                                         \
        return none(c, count);                                                                                                \
    }

OF_NO_VARIABLE(Integer, fmi2Integer)
OF_NO_VARIABLE(Boolean, fmi2Boolean)
OF_NO_VARIABLE(String, fmi2String)

EXPORT fmi2Status FMI(fmi2GetFMUstate)(fmi2Component c, fmi2FMUstate *state)
{
    if (!*state)
        *state = malloc(sizeof(Motion));
    if (!*state)
        return status(wrong(c, "there is no memory for a state"));
    memcpy(*state, &((Instance *)c)->motion, sizeof(Motion));
    return fmi2OK;
}

EXPORT fmi2Status FMI(fmi2SetFMUstate)(fmi2Component c, fmi2FMUstate state)
{
    memcpy(&((Instance *)c)->motion, state, sizeof(Motion));
    return fmi2OK;
}

EXPORT fmi2Status FMI(fmi2FreeFMUstate)(fmi2Component c, fmi2FMUstate *state)
{
    (void)c;
    free(*state);
    *state = NULL;
    return fmi2OK;
}

EXPORT fmi2Status FMI(fmi2SerializedFMUstateSize)(fmi2Component c, fmi2FMUstate state, size_t *size)
{
    (void)c;
    (void)state;
    *size = sizeof(Motion);
    return fmi2OK;
}

EXPORT fmi2Status FMI(fmi2SerializeFMUstate)(fmi2Component c, fmi2FMUstate state, fmi2Byte bytes[], size_t size)
{
    if (size < sizeof(Motion))
        return status(wrong(c, "a state takes %zu bytes, not %zu", sizeof(Motion), size));
    memcpy(bytes, state, sizeof(Motion));
    return fmi2OK;
}

EXPORT fmi2Status FMI(fmi2DeSerializeFMUstate)(fmi2Component c, const fmi2Byte bytes[], size_t size, fmi2FMUstate *state)
{
    if (size != sizeof(Motion))
        return status(wrong(c, "a state takes %zu bytes, not %zu", sizeof(Motion), size));
    if (!*state)
        *state = malloc(sizeof(Motion));
    if (!*state)
        return status(wrong(c, "there is no memory for a state"));
    memcpy(*state, bytes, size);
    return fmi2OK;
}

EXPORT fmi2Status FMI(fmi2GetDirectionalDerivative)(fmi2Component c, const fmi2ValueReference unknowns[], size_t unknown_count,
                                                    const fmi2ValueReference knowns[], size_t known_count,
                                                    const fmi2Real seed[], fmi2Real sensitivity[])
{
    return status(directional(c, unknowns, unknown_count, knowns, known_count, seed, sensitivity));
}

/* Model Exchange */

EXPORT fmi2Status FMI(fmi2EnterEventMode)(fmi2Component c)
{
    ((Instance *)c)->motion.phase = EVENT_MODE;
    return fmi2OK;
}

EXPORT fmi2Status FMI(fmi2NewDiscreteStates)(fmi2Component c, fmi2EventInfo *info)
{
    Instance *instance = c;
    int changed = 0;
#if FMU_EVENTS > 0
    if (!discrete_update(instance, &changed))
        return fmi2Error;
#endif
    memset(info, 0, sizeof *info);
    info->terminateSimulation = instance->motion.terminal;
    info->valuesOfContinuousStatesChanged = changed;
    return fmi2OK;
}

EXPORT fmi2Status FMI(fmi2EnterContinuousTimeMode)(fmi2Component c)
{
    ((Instance *)c)->motion.phase = CONTINUOUS;
    return fmi2OK;
}

EXPORT fmi2Status FMI(fmi2CompletedIntegratorStep)(fmi2Component c, fmi2Boolean never_back, fmi2Boolean *event_mode,
                                                   fmi2Boolean *terminate)
{
    (void)never_back;
    int event = 0;
    if (!completed_step(c, &event))
        return fmi2Error;
    *event_mode = event;
    *terminate = 0;
    return fmi2OK;
}

EXPORT fmi2Status FMI(fmi2SetTime)(fmi2Component c, fmi2Real t)
{
    ((Instance *)c)->motion.t = t;
    moved(&((Instance *)c)->motion);
    return fmi2OK;
}

EXPORT fmi2Status FMI(fmi2SetContinuousStates)(fmi2Component c, const fmi2Real y[], size_t count)
{
    return status(set_states(c, y, count));
}

EXPORT fmi2Status FMI(fmi2GetDerivatives)(fmi2Component c, fmi2Real rates[], size_t count)
{
    return status(get_rates(c, rates, count));
}

EXPORT fmi2Status FMI(fmi2GetEventIndicators)(fmi2Component c, fmi2Real values[], size_t count)
{
    return status(get_indicators(c, values, count));
}

EXPORT fmi2Status FMI(fmi2GetContinuousStates)(fmi2Component c, fmi2Real y[], size_t count)
{
    return status(get_states(c, y, count));
}

EXPORT fmi2Status FMI(fmi2GetNominalsOfContinuousStates)(fmi2Component c, fmi2Real nominals[], size_t count)
{
    (void)c;
    for (size_t i = 0; i < count; i++)
        nominals[i] = i < FMU_STATES ? nominal_values[i] : 1.0;
    return fmi2OK;
}

/* Co-Simulation */

EXPORT fmi2Status FMI(fmi2SetRealInputDerivatives)(fmi2Component c, const fmi2ValueReference of[], size_t count,
                                                   const fmi2Integer order[], const fmi2Real values[])
{
    for (size_t i = 0; i < count; i++) {
        if (!is_input(of[i]))
            return status(wrong(c, "the variable of value reference %u is no input", of[i]));
        if (!set_slope(c, (int)(of[i] - OF_PARAMETERS), order[i], values[i]))
            return fmi2Error;
    }
    return fmi2OK;
}

EXPORT fmi2Status FMI(fmi2GetRealOutputDerivatives)(fmi2Component c, const fmi2ValueReference of[], size_t count,
                                                    const fmi2Integer order[], fmi2Real values[])
{
    (void)of;
    (void)order;
    (void)values;
    return count == 0 ? fmi2OK : status(wrong(c, "outputs have no derivatives"));
}

EXPORT fmi2Status FMI(fmi2DoStep)(fmi2Component c, fmi2Real t, fmi2Real length, fmi2Boolean never_back)
{
    (void)never_back;
    Instance *instance = c;
    if (!do_step(instance, t, length))
        return fmi2Error;
    return instance->motion.terminal ? fmi2Discard : fmi2OK;
}

EXPORT fmi2Status FMI(fmi2CancelStep)(fmi2Component c)
{
    return status(wrong(c, "steps are never left pending"));
}

EXPORT fmi2Status FMI(fmi2GetStatus)(fmi2Component c, const fmi2StatusKind kind, fmi2Status *value)
{
    (void)kind;
    (void)value;
    wrong(c, "steps are never left pending");
    return fmi2Discard;
}

EXPORT fmi2Status FMI(fmi2GetRealStatus)(fmi2Component c, const fmi2StatusKind kind, fmi2Real *value)
{
    if (kind != fmi2LastSuccessfulTime)
        return fmi2Discard;
    *value = ((Instance *)c)->motion.t;
    return fmi2OK;
}

EXPORT fmi2Status FMI(fmi2GetIntegerStatus)(fmi2Component c, const fmi2StatusKind kind, fmi2Integer *value)
{
    (void)c;
    (void)kind;
    (void)value;
    return fmi2Discard;
}

EXPORT fmi2Status FMI(fmi2GetBooleanStatus)(fmi2Component c, const fmi2StatusKind kind, fmi2Boolean *value)
{
    if (kind != fmi2Terminated)
        return fmi2Discard;
    *value = ((Instance *)c)->motion.terminal;
    return fmi2OK;
}

EXPORT fmi2Status FMI(fmi2GetStringStatus)(fmi2Component c, const fmi2StatusKind kind, fmi2String *value)
{
    (void)c;
    (void)kind;
    (void)value;
    return fmi2Discard;
}
