/* An importer of an FMU, for tests. It is told what to do by its arguments:
 *
 *     importer cs|me END STEP [set REFERENCE VALUE]... [get REFERENCE]... [derivative UNKNOWN KNOWN]...
 *              [sine REFERENCE ORDER]... [early TIME] [events 0|1|2] [initial]
 *              [jump REFERENCE VALUE TIME] [again]
 *
 * An input that is a sine has in Co-Simulation the value sin t at each communication point. With an ORDER above 0 it is sin t
 * between them too: up to its derivative of that order in FMI 2, by intermediate update in FMI 3. There the step over TIME
 * returns early, and the next one goes on from there. With `events 1` it deals with events in event mode, with `events 2` it
 * writes a line before and one after each of them too. With `initial` the first line is written in initialization mode.
 * An input jumps at the communication point TIME, in event mode where that is used. With `again` each step of Co-Simulation is
 * made twice, from the state that was saved before it, and each event is dealt with after its state was saved and set again.
 *
 * It writes what is asked for at the start and after each communication step, a line each. In Model Exchange it makes steps of
 * the classical Runge-Kutta method, a hundred between two lines, and bisects them at events. */
#if VERSION == 2
#include "fmi2.c"
#define CALL(name) fmi2##name
#define SET(c, r, v) fmi2SetReal(c, &(r), 1, &(v))
#define GET(c, r, v) fmi2GetReal(c, &(r), 1, &(v))
#define RATES fmi2GetDerivatives
#define OKAY fmi2OK
#else
#include "fmi3.c"
#define CALL(name) fmi3##name
#define SET(c, r, v) fmi3SetFloat64(c, &(r), 1, &(v), 1)
#define GET(c, r, v) fmi3GetFloat64(c, &(r), 1, &(v), 1)
#define RATES fmi3GetContinuousStateDerivatives
#define OKAY fmi3OK
#endif

enum { N = FMU_STATES, E = FMU_EVENTS };

static void need(int status, const char *what)
{
    if (status != OKAY) {
        fprintf(stderr, "%s: status %d\n", what, status);
        exit(1);
    }
}

#if VERSION == 2
static void told(void *environment, const char *name, fmi2Status status, const char *category, const char *text, ...)
{
    va_list arguments;
    (void)environment;
    (void)category;
    (void)status;
    va_start(arguments, text);
    fprintf(stderr, "%s: ", name);
    vfprintf(stderr, text, arguments);
    fprintf(stderr, "\n");
    va_end(arguments);
}
#else
static void told(void *environment, fmi3Status status, const char *category, const char *text)
{
    (void)environment;
    (void)status;
    (void)category;
    fprintf(stderr, "%s\n", text);
}
#endif

/* The inputs that are sines, those that are so between communication points too, and when to return early. */
enum { MOST = 8 };
static unsigned sines[MOST], smooth[MOST];
static int orders[MOST];
static size_t sine_count, smooth_count;
static double early = INFINITY;
static int events, again;
static void write(void *c, int count, char **arguments);
static int argument_count;
static char **all_arguments;

/* The derivative of sin t of an order. */
static double sine(double t, int order)
{
    return order % 4 == 0 ? sin(t) : order % 4 == 1 ? cos(t) : order % 4 == 2 ? -sin(t) : -cos(t);
}

static void put_sines(void *c, double t)
{
    for (size_t n = 0; n < sine_count; n++) {
        const double value = sin(t);
        need(SET(c, sines[n], value), "sine");
#if VERSION == 2
        for (int order = 1; order <= orders[n]; order++) {
            const double slope = sine(t, order);
            need(fmi2SetRealInputDerivatives(c, &sines[n], 1, &order, &slope), "slope");
        }
#endif
    }
}

#if VERSION == 3
static void *instance;
static double finished = -INFINITY;
static int tried;

/* Sets sines where they are asked for, and looks at the first of them at the end of each step of the integration. */
static void update(void *environment, double t, bool set, bool get, bool done, bool can_return, bool *wanted, double *when)
{
    (void)environment;
    double value = sin(t), found = value;
    if (t < finished || set == get || get != done)
        exit(3);
    for (size_t n = 0; n < smooth_count && set; n++)
        need(SET(instance, smooth[n], value), "sine");
    if (get && smooth_count > 0)
        need(GET(instance, smooth[0], found), "sine at the end of a step");
    if (set && !tried && fmi3GetFloat64(instance, smooth, 1, &found, 1) == fmi3OK)
        exit(4); /* there is no value yet */
    tried |= set;
    if (get && found != value)
        exit(5);
    if (done)
        finished = t;
    *wanted = done && can_return && t < early;
    *when = early;
}
#endif

static void *make(int exchange)
{
#if VERSION == 2
    static const fmi2CallbackFunctions callbacks = {told, NULL, NULL, NULL, NULL};
    return fmi2Instantiate("it", exchange ? fmi2ModelExchange : fmi2CoSimulation, FMU_TOKEN, NULL, &callbacks, 0, 1);
#else
    if (exchange)
        return fmi3InstantiateModelExchange("it", FMU_TOKEN, NULL, false, true, NULL, told);
    return fmi3InstantiateCoSimulation("it", FMU_TOKEN, NULL, false, true, events > 0, events > 0 || isfinite(early), smooth,
                                       smooth_count, NULL, told, smooth_count > 0 || isfinite(early) ? update : NULL);
#endif
}

static void initialize(void *c, double end, int is_initial)
{
#if VERSION == 2
    need(fmi2SetupExperiment(c, 0, 0.0, FMU_T_START, 1, end), "setup");
    need(fmi2EnterInitializationMode(c), "enter");
#else
    need(fmi3EnterInitializationMode(c, false, 0.0, FMU_T_START, true, end), "enter");
#endif
    if (is_initial)
        write(c, argument_count, all_arguments);
    need(CALL(ExitInitializationMode)(c), "initialization");
}

/* Event mode; whether the simulation ends. */
static int event(void *c, double *y)
{
#if VERSION == 2
    fmi2EventInfo info;
    need(fmi2NewDiscreteStates(c, &info), "event");
    const int end = info.terminateSimulation;
#else
    bool more, end, nominals, values, with_next;
    double next;
    need(fmi3UpdateDiscreteStates(c, &more, &end, &nominals, &values, &with_next, &next), "event");
#endif
    need(CALL(EnterContinuousTimeMode)(c), "continuous time");
    need(CALL(GetContinuousStates)(c, y, N), "states");
    return end;
}

static void put(void *c, double t, const double *y)
{
    need(CALL(SetTime)(c, t), "time");
    need(CALL(SetContinuousStates)(c, y, N), "states");
}

static void rk4(void *c, double t, const double *y, double h, double *end)
{
    static const double part[4] = {0.0, 0.5, 0.5, 1.0};
    double k[4][N], z[N];
    for (int n = 0; n < 4; n++) {
        for (int i = 0; i < N; i++)
            z[i] = y[i] + (n > 0 ? part[n]*h*k[n - 1][i] : 0.0);
        put(c, t + part[n]*h, z);
        need(RATES(c, k[n], N), "rates");
    }
    for (int i = 0; i < N; i++)
        end[i] = y[i] + h/6.0*(k[0][i] + 2.0*k[1][i] + 2.0*k[2][i] + k[3][i]);
    put(c, t + h, end);
}

static int passed(void *c, const double *before)
{
    double after[E + 1];
    need(CALL(GetEventIndicators)(c, after, E), "indicators");
    for (int i = 0; i < E; i++)
        if ((before[i] > 0.0) != (after[i] > 0.0))
            return 1;
    return 0;
}

/* Model Exchange from t to `to`; whether the simulation ends. */
static int exchange_to(void *c, double t, double to, double *y)
{
    const double length = (to - t)/100.0;
    while (t < to) {
        double h = to - t < 1.5*length ? to - t : length, z[E + 1], end[N];
        int found = 0;
        need(CALL(GetEventIndicators)(c, z, E), "indicators");
        rk4(c, t, y, h, end);
        if (passed(c, z)) {
            double without = 0.0, with = h;
            for (int n = 0; n < 60; n++) {
                const double middle = 0.5*(without + with);
                rk4(c, t, y, middle, end);
                *(passed(c, z) ? &with : &without) = middle;
            }
            rk4(c, t, y, with, end);
            h = with;
            found = 1;
        }
        t = h == to - t ? to : t + h;
        memcpy(y, end, sizeof end);
#if VERSION == 2
        int mode, ends;
        need(fmi2CompletedIntegratorStep(c, 1, &mode, &ends), "step");
#else
        bool mode, ends;
        need(fmi3CompletedIntegratorStep(c, true, &mode, &ends), "step");
#endif
        if (found || mode) {
            need(CALL(EnterEventMode)(c), "event mode");
            if (event(c, y))
                return 1;
        }
    }
    return 0;
}

/* The state of an instance, as bytes and back; the bytes of the last one are kept. */
static void *save(void *c)
{
    void *state = NULL;
    static char *bytes;
    size_t size;
#if VERSION == 2
    need(fmi2GetFMUstate(c, &state), "state");
    need(fmi2SerializedFMUstateSize(c, state, &size), "size");
    bytes = realloc(bytes, size);
    need(fmi2SerializeFMUstate(c, state, bytes, size), "bytes");
    need(fmi2FreeFMUstate(c, &state), "free");
    need(fmi2DeSerializeFMUstate(c, bytes, size, &state), "state of bytes");
#else
    need(fmi3GetFMUState(c, &state), "state");
    need(fmi3SerializedFMUStateSize(c, state, &size), "size");
    bytes = realloc(bytes, size);
    need(fmi3SerializeFMUState(c, state, (fmi3Byte *)bytes, size), "bytes");
    need(fmi3FreeFMUState(c, &state), "free");
    need(fmi3DeserializeFMUState(c, (fmi3Byte *)bytes, size, &state), "state of bytes");
#endif
    return state;
}

static void set(void *c, void *state)
{
#if VERSION == 2
    need(fmi2SetFMUstate(c, state), "set state");
    need(fmi2FreeFMUstate(c, &state), "free");
#else
    need(fmi3SetFMUState(c, state), "set state");
    need(fmi3FreeFMUState(c, &state), "free");
    finished = -INFINITY;
#endif
}

/* An input jumps. */
static void jump(void *c, double t)
{
    for (int n = 4; n + 3 < argument_count; n++)
        if (!strcmp(all_arguments[n], "jump") && fabs(strtod(all_arguments[n + 3], NULL) - t) < 1e-9) {
            const unsigned reference = (unsigned)strtoul(all_arguments[n + 1], NULL, 10);
            const double value = strtod(all_arguments[n + 2], NULL);
#if VERSION == 3
            if (events) {
                bool more, ends, nominals, values, with_next;
                double next;
                need(fmi3EnterEventMode(c), "event mode");
                need(SET(c, reference, value), "jump");
                need(fmi3UpdateDiscreteStates(c, &more, &ends, &nominals, &values, &with_next, &next), "event");
                write(c, argument_count, all_arguments);
                need(fmi3EnterStepMode(c), "step mode");
                continue;
            }
#endif
            need(SET(c, reference, value), "jump");
        }
}

#if VERSION == 3
/* Event mode of Co-Simulation; whether the simulation ends. */
static int happen(void *c)
{
    bool more, ends, nominals, values, with_next, needed, is_early;
    double next, last;
    if (fmi3DoStep(c, FMU_T_START, 1.0, true, &needed, &ends, &is_early, &last) == fmi3OK)
        exit(9); /* before the event was dealt with */
    if (again)
        set(c, save(c));
    if (events > 1)
        write(c, argument_count, all_arguments);
    need(fmi3EnterEventMode(c), "event mode");
    do
        need(fmi3UpdateDiscreteStates(c, &more, &ends, &nominals, &values, &with_next, &next), "event");
    while (more);
    if (events > 1)
        write(c, argument_count, all_arguments);
    need(fmi3EnterStepMode(c), "step mode");
    return ends;
}
#endif

/* Co-Simulation; whether the simulation ends. */
static int simulate(void *c, double t, double length)
{
#if VERSION == 2
    int ends = 0;
    const int status = fmi2DoStep(c, t, length, 1);
    if (status == fmi2Discard)
        need(fmi2GetBooleanStatus(c, fmi2Terminated, &ends), "status");
    else
        need(status, "step");
    return ends;
#else
    const double to = t + length;
    bool needed, ends, is_early;
    for (double last = t;;) {
        need(fmi3DoStep(c, last, to - last, true, &needed, &ends, &is_early, &last), "step");
        if (is_early != (last < to) && (events || isfinite(early)))
            exit(8);
        if (needed && happen(c))
            return 1;
        if (ends || !is_early)
            return ends;
        if (!needed && last != early)
            exit(6);
        if (!needed)
            early = INFINITY;
    }
#endif
}

static void write(void *c, int count, char **arguments)
{
    const unsigned of_time = 0;
    double value;
    need(GET(c, of_time, value), "time");
    printf("%.17g", value);
    for (int n = 4; n < count; n++) {
        const unsigned first = (unsigned)strtoul(n + 1 < count ? arguments[n + 1] : "0", NULL, 10);
        if (!strcmp(arguments[n], "get")) {
            need(GET(c, first, value), "get");
            printf(" %.17g", value);
        } else if (!strcmp(arguments[n], "derivative")) {
            const unsigned known = (unsigned)strtoul(arguments[n + 2], NULL, 10);
            const double seed = 1.0;
#if VERSION == 2
            need(fmi2GetDirectionalDerivative(c, &first, 1, &known, 1, &seed, &value), "derivative");
#else
            const unsigned twice[2] = {first, first};
            const double seeds[2] = {2.0, 3.0};
            double adjoint;
            need(fmi3GetDirectionalDerivative(c, &first, 1, &known, 1, &seed, 1, &value, 1), "derivative");
            need(fmi3GetAdjointDerivative(c, twice, 2, &known, 1, seeds, 2, &adjoint, 1), "adjoint derivative");
            if (fabs(adjoint - 5.0*value) > 4.0*DBL_EPSILON*fabs(adjoint))
                exit(10);
#endif
            printf(" %.17g", value);
        }
    }
    printf("\n");
}

int main(int count, char **arguments)
{
    const int exchange = !strcmp(arguments[1], "me");
    const double end = strtod(arguments[2], NULL), step = strtod(arguments[3], NULL);
    double y[N];
    for (int n = 4; n + 2 < count; n++)
        if (!strcmp(arguments[n], "sine")) {
            sines[sine_count] = (unsigned)strtoul(arguments[n + 1], NULL, 10);
            orders[sine_count] = (int)strtol(arguments[n + 2], NULL, 10);
            if (VERSION == 3 && orders[sine_count] > 0)
                smooth[smooth_count++] = sines[sine_count];
            sine_count++;
        }
    for (int n = 4; n + 1 < count; n++)
        if (!strcmp(arguments[n], "early"))
            early = strtod(arguments[n + 1], NULL);
        else if (!strcmp(arguments[n], "events"))
            events = atoi(arguments[n + 1]);
    int is_initial = 0;
    for (int n = 4; n < count; n++)
        is_initial |= !strcmp(arguments[n], "initial");
    for (int n = 4; n < count; n++)
        again |= !strcmp(arguments[n], "again");
    argument_count = count;
    all_arguments = arguments;
    void *c = make(exchange);
#if VERSION == 3
    instance = c;
#endif
    if (!c)
        return 1;
    for (int n = 4; n + 2 < count; n++)
        if (!strcmp(arguments[n], "set")) {
            const unsigned reference = (unsigned)strtoul(arguments[n + 1], NULL, 10);
            const double value = strtod(arguments[n + 2], NULL);
            need(SET(c, reference, value), "set");
        }
    initialize(c, end, is_initial);
    int ends = exchange && event(c, y);
#if VERSION == 3
    if (events)
        need(fmi3EnterStepMode(c), "step mode");
#endif
    if (!is_initial)
        write(c, count, arguments);
    const int steps = (int)floor((end - FMU_T_START)/step + 0.5);
    for (int n = 0; n < steps && !ends; n++) {
        const double t = FMU_T_START + n*step, to = FMU_T_START + (n + 1)*step;
        if (!exchange) {
            jump(c, t);
            put_sines(c, t);
        }
        if (again && !exchange) {
            void *state = save(c);
            simulate(c, t, to - t);
            set(c, state);
        }
        ends = exchange ? exchange_to(c, t, to, y) : simulate(c, t, to - t);
        write(c, count, arguments);
    }
    if (early < end)
        exit(7);
    CALL(Terminate)(c);
    CALL(FreeInstance)(c);
    return 0;
}
