/* The functions of FMI 3.0 for co-simulation; those of other interface types refuse. */
#include "fmi3Functions.h"

#include "instance.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define INSTANCE(c) ((Instance *)(c))
#define RUNNING (PHASE_STEPPING | PHASE_STOPPED)
/* After an error the standard has the state Terminated: what is there can be read. */
#define READABLE (PHASE_INSTANTIATED | PHASE_INITIALIZATION | RUNNING | PHASE_TERMINATED | PHASE_ERROR)

static fmi3Status as_fmi3(Status status) { return (fmi3Status)status; }

static fmi3Status refuse(fmi3Instance c, const char *function) {
    if (c == NULL) return fmi3Error;
    return as_fmi3(tell(INSTANCE(c), STATUS_ERROR, "%s is not provided: see the capabilities in modelDescription.xml",
                        function));
}

/* A function pointer does not fit into a pointer to data by the C standard; it is kept in one of its own. */
typedef struct {
    fmi3LogMessageCallback log;
} Callback;

/* In a message # begins a reference to a variable; it is to stand as it is. */
static void log_message(const Instance *instance, Status status, const char *category, const char *message) {
    const Callback *callback = instance->callback;
    char plain[2 * LONGEST_MESSAGE];
    size_t at = 0;
    if (callback == NULL || callback->log == NULL) return;
    for (; *message != '\0'; message++) {
        if (*message == '#') plain[at++] = *message;
        plain[at++] = *message;
    }
    plain[at] = '\0';
    callback->log(instance->environment, as_fmi3(status), category, plain);
}

const char *fmi3GetVersion(void) { return fmi3Version; }

fmi3Status fmi3SetDebugLogging(fmi3Instance c, fmi3Boolean on, size_t count, const fmi3String categories[]) {
    if (c == NULL) return fmi3Error;
    set_logging(INSTANCE(c), on, count, (const char *const *)categories);
    return fmi3OK;
}

static fmi3Instance none(fmi3InstanceEnvironment environment, fmi3LogMessageCallback log, const char *why) {
    if (log != NULL) log(environment, fmi3Error, "logStatusError", why);
    return NULL;
}

fmi3Instance fmi3InstantiateModelExchange(fmi3String name, fmi3String token, fmi3String resources, fmi3Boolean visible,
                                          fmi3Boolean logging, fmi3InstanceEnvironment environment,
                                          fmi3LogMessageCallback log) {
    (void)name, (void)token, (void)resources, (void)visible, (void)logging;
    return none(environment, log, "this FMU is for co-simulation only");
}

fmi3Instance fmi3InstantiateScheduledExecution(fmi3String name, fmi3String token, fmi3String resources,
                                               fmi3Boolean visible, fmi3Boolean logging,
                                               fmi3InstanceEnvironment environment, fmi3LogMessageCallback log,
                                               fmi3ClockUpdateCallback update, fmi3LockPreemptionCallback lock,
                                               fmi3UnlockPreemptionCallback unlock) {
    (void)name, (void)token, (void)resources, (void)visible, (void)logging, (void)update, (void)lock, (void)unlock;
    return none(environment, log, "this FMU is for co-simulation only");
}

fmi3Instance fmi3InstantiateCoSimulation(fmi3String name, fmi3String token, fmi3String resources, fmi3Boolean visible,
                                         fmi3Boolean logging, fmi3Boolean event_mode, fmi3Boolean early_return,
                                         const fmi3ValueReference intermediate[], size_t n_intermediate,
                                         fmi3InstanceEnvironment environment, fmi3LogMessageCallback log,
                                         fmi3IntermediateUpdateCallback update) {
    Callback *callback;
    Instance *instance;
    (void)visible, (void)intermediate, (void)n_intermediate, (void)update;
    if (event_mode) return none(environment, log, "this FMU has no event mode; instantiate it without");
    callback = malloc(sizeof *callback);
    if (callback == NULL) return NULL;
    callback->log = log;
    instance = instance_new(name, token, resources, log_message, callback, environment, logging);
    if (instance == NULL) free(callback);
    else instance->early_return_allowed = early_return;
    return instance;
}

void fmi3FreeInstance(fmi3Instance c) {
    void *callback;
    if (c == NULL) return;
    callback = INSTANCE(c)->callback;
    instance_free(c);
    free(callback);
}

fmi3Status fmi3EnterInitializationMode(fmi3Instance c, fmi3Boolean tolerance_defined, fmi3Float64 tolerance,
                                       fmi3Float64 start, fmi3Boolean stop_defined, fmi3Float64 stop) {
    (void)tolerance_defined, (void)tolerance;
    if (c == NULL || !may(INSTANCE(c), "fmi3EnterInitializationMode", PHASE_INSTANTIATED)) return fmi3Error;
    return as_fmi3(begin_initialization(INSTANCE(c), start, stop_defined, stop));
}

fmi3Status fmi3ExitInitializationMode(fmi3Instance c) {
    if (c == NULL || !may(INSTANCE(c), "fmi3ExitInitializationMode", PHASE_INITIALIZATION)) return fmi3Error;
    return as_fmi3(end_initialization(INSTANCE(c)));
}

fmi3Status fmi3Terminate(fmi3Instance c) {
    if (c == NULL || !may(INSTANCE(c), "fmi3Terminate", RUNNING)) return fmi3Error;
    INSTANCE(c)->phase = PHASE_TERMINATED;
    return fmi3OK;
}

fmi3Status fmi3Reset(fmi3Instance c) {
    if (c == NULL || !may(INSTANCE(c), "fmi3Reset", PHASE_ANY)) return fmi3Error;
    return as_fmi3(reset(INSTANCE(c)));
}

/* The getter and the setter of a type; `k` counts within an array, `at` among the host's values. */
#define ACCESS(TYPE, KIND, TO_HOST, TO_NUMBER)                                                                       \
    fmi3Status fmi3Get##TYPE(fmi3Instance c, const fmi3ValueReference references[], size_t count,                    \
                             fmi3##TYPE values[], size_t n_values) {                                                 \
        Instance *instance = c;                                                                                      \
        size_t at = 0;                                                                                               \
        if (c == NULL || !given(instance, "fmi3Get" #TYPE, count, references, values)) return fmi3Error;             \
        if (!may(instance, "fmi3Get" #TYPE, READABLE)) return fmi3Error;                                             \
        for (size_t i = 0; i < count; i++) {                                                                         \
            const Variable *variable = find(instance, "fmi3Get" #TYPE, references[i], KIND);                         \
            Status status = variable == NULL ? STATUS_ERROR : before_get(instance, "fmi3Get" #TYPE, variable);       \
            if (status != STATUS_OK) return as_fmi3(status);                                                         \
            if (n_values - at < variable->size) return miscounted(instance, "fmi3Get" #TYPE);                        \
            for (size_t k = 0; k < variable->size; k++, at++) values[at] = TO_HOST;                                  \
        }                                                                                                            \
        return at == n_values ? fmi3OK : miscounted(instance, "fmi3Get" #TYPE);                                      \
    }                                                                                                                \
    fmi3Status fmi3Set##TYPE(fmi3Instance c, const fmi3ValueReference references[], size_t count,                    \
                             const fmi3##TYPE values[], size_t n_values) {                                           \
        Instance *instance = c;                                                                                      \
        size_t at = 0;                                                                                               \
        if (c == NULL || !given(instance, "fmi3Set" #TYPE, count, references, values)) return fmi3Error;             \
        if (!may(instance, "fmi3Set" #TYPE, PHASE_INSTANTIATED | PHASE_INITIALIZATION | PHASE_STEPPING))             \
            return fmi3Error;                                                                                        \
        for (size_t i = 0; i < count; i++) {                                                                         \
            const Variable *variable = find(instance, "fmi3Set" #TYPE, references[i], KIND);                         \
            Status status = variable == NULL ? STATUS_ERROR : before_set(instance, "fmi3Set" #TYPE, variable);       \
            if (status != STATUS_OK) return as_fmi3(status);                                                         \
            if (n_values - at < variable->size) return miscounted(instance, "fmi3Set" #TYPE);                        \
            for (size_t k = 0; k < variable->size; k++, at++) { TO_NUMBER; }                                         \
        }                                                                                                            \
        return at == n_values ? fmi3OK : miscounted(instance, "fmi3Set" #TYPE);                                      \
    }

#define NUMBER instance->numbers[variable->slot + k]

static fmi3Status miscounted(Instance *instance, const char *function) {
    return as_fmi3(tell(instance, STATUS_ERROR, "%s: the number of values is not that of the variables", function));
}

ACCESS(Float64, KIND_REAL, NUMBER,
       if (set_real(instance, variable, &NUMBER, values[at]) != STATUS_OK) return fmi3Error)
ACCESS(Int32, KIND_INTEGER, whole_value(NUMBER), NUMBER = values[at])
ACCESS(Boolean, KIND_BOOLEAN, NUMBER != 0, NUMBER = values[at])
ACCESS(String, KIND_TEXT, instance->texts[variable->slot + k],
       if (set_text(instance, variable, values[at]) != STATUS_OK) return fmi3Error)

fmi3Status fmi3DoStep(fmi3Instance c, fmi3Float64 point, fmi3Float64 step, fmi3Boolean no_set_prior,
                      fmi3Boolean *event, fmi3Boolean *terminate, fmi3Boolean *early, fmi3Float64 *last) {
    Instance *instance = c;
    Step taken;
    Status status;
    (void)no_set_prior;
    if (c == NULL || event == NULL || terminate == NULL || early == NULL || last == NULL) return fmi3Error;
    *event = *terminate = *early = false;
    *last = instance->time;
    if (!may(instance, "fmi3DoStep", PHASE_STEPPING)) return fmi3Error;
    status = take_step(instance, point, step, &taken);
    *last = taken.reached;
    if (status != STATUS_OK || !taken.stopped) return as_fmi3(status);
    *terminate = true;
    *early = instance->early_return_allowed && taken.reached < point + step - 1e-9;
    return as_fmi3(tell(instance, taken.failed ? STATUS_WARNING : STATUS_OK, "the run has ended at %.9g s: %s",
                        taken.reached, ending(instance)));
}

fmi3Status fmi3GetFMUState(fmi3Instance c, fmi3FMUState *state) {
    if (c == NULL || !may(INSTANCE(c), "fmi3GetFMUState", READABLE)) return fmi3Error;
    return as_fmi3(state_get(INSTANCE(c), "fmi3GetFMUState", state));
}

fmi3Status fmi3SetFMUState(fmi3Instance c, fmi3FMUState state) {
    if (c == NULL || !may(INSTANCE(c), "fmi3SetFMUState", READABLE)) return fmi3Error;
    return as_fmi3(state_set(INSTANCE(c), "fmi3SetFMUState", state));
}

fmi3Status fmi3FreeFMUState(fmi3Instance c, fmi3FMUState *state) {
    return c == NULL ? fmi3Error : as_fmi3(state_free(INSTANCE(c), "fmi3FreeFMUState", state));
}

fmi3Status fmi3SerializedFMUStateSize(fmi3Instance c, fmi3FMUState state, size_t *size) {
    return c == NULL ? fmi3Error : as_fmi3(state_size(INSTANCE(c), "fmi3SerializedFMUStateSize", state, size));
}

fmi3Status fmi3SerializeFMUState(fmi3Instance c, fmi3FMUState state, fmi3Byte data[], size_t size) {
    return c == NULL ? fmi3Error : as_fmi3(state_write(INSTANCE(c), "fmi3SerializeFMUState", state, data, size));
}

fmi3Status fmi3DeserializeFMUState(fmi3Instance c, const fmi3Byte data[], size_t size, fmi3FMUState *state) {
    return c == NULL ? fmi3Error : as_fmi3(state_read(INSTANCE(c), "fmi3DeserializeFMUState", data, size, state));
}

/* What this FMU does not have; the standard wants the functions all the same. */
#if defined(__GNUC__)
#pragma GCC diagnostic ignored "-Wunused-parameter"
#endif

#define REFUSED(NAME, ...) \
    fmi3Status NAME(fmi3Instance c, __VA_ARGS__) { return refuse(c, #NAME); }
#define REFUSED_PLAIN(NAME) \
    fmi3Status NAME(fmi3Instance c) { return refuse(c, #NAME); }
#define REFUSED_TYPE(TYPE)                                                                                           \
    REFUSED(fmi3Get##TYPE, const fmi3ValueReference r[], size_t n, fmi3##TYPE v[], size_t m)                         \
    REFUSED(fmi3Set##TYPE, const fmi3ValueReference r[], size_t n, const fmi3##TYPE v[], size_t m)

REFUSED_TYPE(Float32)
REFUSED_TYPE(Int8)
REFUSED_TYPE(UInt8)
REFUSED_TYPE(Int16)
REFUSED_TYPE(UInt16)
REFUSED_TYPE(UInt32)
REFUSED_TYPE(Int64)
REFUSED_TYPE(UInt64)

REFUSED_PLAIN(fmi3EnterEventMode)
REFUSED_PLAIN(fmi3EnterConfigurationMode)
REFUSED_PLAIN(fmi3ExitConfigurationMode)
REFUSED_PLAIN(fmi3EvaluateDiscreteStates)
REFUSED_PLAIN(fmi3EnterContinuousTimeMode)
REFUSED_PLAIN(fmi3EnterStepMode)

REFUSED(fmi3GetBinary, const fmi3ValueReference valueReferences[], size_t nValueReferences, size_t valueSizes[],
        fmi3Binary values[], size_t nValues)
REFUSED(fmi3GetClock, const fmi3ValueReference valueReferences[], size_t nValueReferences, fmi3Clock values[])
REFUSED(fmi3SetBinary, const fmi3ValueReference valueReferences[], size_t nValueReferences, const size_t
        valueSizes[], const fmi3Binary values[], size_t nValues)
REFUSED(fmi3SetClock, const fmi3ValueReference valueReferences[], size_t nValueReferences, const fmi3Clock values[])
REFUSED(fmi3GetNumberOfVariableDependencies, fmi3ValueReference valueReference, size_t* nDependencies)
REFUSED(fmi3GetVariableDependencies, fmi3ValueReference dependent, size_t elementIndicesOfDependent[],
        fmi3ValueReference independents[], size_t elementIndicesOfIndependents[], fmi3DependencyKind
        dependencyKinds[], size_t nDependencies)
REFUSED(fmi3GetDirectionalDerivative, const fmi3ValueReference unknowns[], size_t nUnknowns, const
        fmi3ValueReference knowns[], size_t nKnowns, const fmi3Float64 seed[], size_t nSeed, fmi3Float64
        sensitivity[], size_t nSensitivity)
REFUSED(fmi3GetAdjointDerivative, const fmi3ValueReference unknowns[], size_t nUnknowns, const fmi3ValueReference
        knowns[], size_t nKnowns, const fmi3Float64 seed[], size_t nSeed, fmi3Float64 sensitivity[], size_t
        nSensitivity)
REFUSED(fmi3GetIntervalDecimal, const fmi3ValueReference valueReferences[], size_t nValueReferences, fmi3Float64
        intervals[], fmi3IntervalQualifier qualifiers[])
REFUSED(fmi3GetIntervalFraction, const fmi3ValueReference valueReferences[], size_t nValueReferences, fmi3UInt64
        counters[], fmi3UInt64 resolutions[], fmi3IntervalQualifier qualifiers[])
REFUSED(fmi3GetShiftDecimal, const fmi3ValueReference valueReferences[], size_t nValueReferences, fmi3Float64
        shifts[])
REFUSED(fmi3GetShiftFraction, const fmi3ValueReference valueReferences[], size_t nValueReferences, fmi3UInt64
        counters[], fmi3UInt64 resolutions[])
REFUSED(fmi3SetIntervalDecimal, const fmi3ValueReference valueReferences[], size_t nValueReferences, const
        fmi3Float64 intervals[])
REFUSED(fmi3SetIntervalFraction, const fmi3ValueReference valueReferences[], size_t nValueReferences, const
        fmi3UInt64 counters[], const fmi3UInt64 resolutions[])
REFUSED(fmi3SetShiftDecimal, const fmi3ValueReference valueReferences[], size_t nValueReferences, const fmi3Float64
        shifts[])
REFUSED(fmi3SetShiftFraction, const fmi3ValueReference valueReferences[], size_t nValueReferences, const fmi3UInt64
        counters[], const fmi3UInt64 resolutions[])
REFUSED(fmi3UpdateDiscreteStates, fmi3Boolean* discreteStatesNeedUpdate, fmi3Boolean* terminateSimulation,
        fmi3Boolean* nominalsOfContinuousStatesChanged, fmi3Boolean* valuesOfContinuousStatesChanged, fmi3Boolean*
        nextEventTimeDefined, fmi3Float64* nextEventTime)
REFUSED(fmi3CompletedIntegratorStep, fmi3Boolean noSetFMUStatePriorToCurrentPoint, fmi3Boolean* enterEventMode,
        fmi3Boolean* terminateSimulation)
REFUSED(fmi3SetTime, fmi3Float64 time)
REFUSED(fmi3SetContinuousStates, const fmi3Float64 continuousStates[], size_t nContinuousStates)
REFUSED(fmi3GetContinuousStateDerivatives, fmi3Float64 derivatives[], size_t nContinuousStates)
REFUSED(fmi3GetEventIndicators, fmi3Float64 eventIndicators[], size_t nEventIndicators)
REFUSED(fmi3GetContinuousStates, fmi3Float64 continuousStates[], size_t nContinuousStates)
REFUSED(fmi3GetNominalsOfContinuousStates, fmi3Float64 nominals[], size_t nContinuousStates)
REFUSED(fmi3GetNumberOfEventIndicators, size_t* nEventIndicators)
REFUSED(fmi3GetNumberOfContinuousStates, size_t* nContinuousStates)
REFUSED(fmi3GetOutputDerivatives, const fmi3ValueReference valueReferences[], size_t nValueReferences, const
        fmi3Int32 orders[], fmi3Float64 values[], size_t nValues)
REFUSED(fmi3ActivateModelPartition, fmi3ValueReference clockReference, fmi3Float64 activationTime)
