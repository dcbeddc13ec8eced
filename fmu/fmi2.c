/* The functions of FMI 2.0 for co-simulation; those of model exchange refuse. */
#include "fmi2Functions.h"

#include "instance.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define INSTANCE(c) ((Instance *)(c))
#define RUNNING (PHASE_STEPPING | PHASE_STOPPED)
#define READABLE (PHASE_INITIALIZATION | RUNNING | PHASE_TERMINATED | PHASE_ERROR)

static fmi2Status as_fmi2(Status status) { return (fmi2Status)status; }

static fmi2Status refuse(fmi2Component c, const char *function) {
    if (c == NULL) return fmi2Error;
    return as_fmi2(tell(INSTANCE(c), STATUS_ERROR, "%s is not provided: see the capabilities in modelDescription.xml",
                        function));
}

/* A message is a format to the host, and # begins a reference to a variable; both are to stand as they are. */
static void log_message(const Instance *instance, Status status, const char *category, const char *message) {
    const fmi2CallbackFunctions *functions = instance->callback;
    char plain[2 * LONGEST_MESSAGE];
    size_t at = 0;
    if (functions == NULL || functions->logger == NULL) return;
    for (; *message != '\0'; message++) {
        if (*message == '%' || *message == '#') plain[at++] = *message;
        plain[at++] = *message;
    }
    plain[at] = '\0';
    functions->logger(instance->environment, instance->name == NULL ? "" : instance->name, as_fmi2(status), category,
                      plain);
}

const char *fmi2GetTypesPlatform(void) { return fmi2TypesPlatform; }

const char *fmi2GetVersion(void) { return fmi2Version; }

fmi2Status fmi2SetDebugLogging(fmi2Component c, fmi2Boolean on, size_t count, const fmi2String categories[]) {
    if (c == NULL) return fmi2Error;
    set_logging(INSTANCE(c), on != fmi2False, count, (const char *const *)categories);
    return fmi2OK;
}

fmi2Component fmi2Instantiate(fmi2String name, fmi2Type type, fmi2String guid, fmi2String location,
                              const fmi2CallbackFunctions *functions, fmi2Boolean visible, fmi2Boolean logging) {
    fmi2CallbackFunctions *kept;
    Instance *instance;
    (void)visible;
    if (functions == NULL) return NULL;
    if (type != fmi2CoSimulation) {
        if (functions->logger != NULL)
            functions->logger(functions->componentEnvironment, name == NULL ? "" : name, fmi2Error, "logStatusError",
                              "this FMU is for co-simulation only");
        return NULL;
    }
    kept = malloc(sizeof *kept);
    if (kept == NULL) return NULL;
    memcpy(kept, functions, sizeof *kept);
    instance = instance_new(name, guid, location, log_message, kept, functions->componentEnvironment,
                            logging != fmi2False);
    if (instance == NULL) free(kept);
    return instance;
}

void fmi2FreeInstance(fmi2Component c) {
    void *callback;
    if (c == NULL) return;
    callback = INSTANCE(c)->callback;
    instance_free(c);
    free(callback);
}

fmi2Status fmi2SetupExperiment(fmi2Component c, fmi2Boolean tolerance_defined, fmi2Real tolerance, fmi2Real start,
                               fmi2Boolean stop_defined, fmi2Real stop) {
    Instance *instance = c;
    Status status;
    (void)tolerance_defined;
    (void)tolerance;
    if (c == NULL || !may(instance, "fmi2SetupExperiment", PHASE_INSTANTIATED)) return fmi2Error;
    status = begin_initialization(instance, start, stop_defined != fmi2False, stop);
    if (status == STATUS_OK) instance->phase = PHASE_INSTANTIATED;
    return as_fmi2(status);
}

fmi2Status fmi2EnterInitializationMode(fmi2Component c) {
    Instance *instance = c;
    if (c == NULL || !may(instance, "fmi2EnterInitializationMode", PHASE_INSTANTIATED)) return fmi2Error;
    return as_fmi2(begin_initialization(instance, instance->start, instance->stop_defined, instance->stop));
}

fmi2Status fmi2ExitInitializationMode(fmi2Component c) {
    if (c == NULL || !may(INSTANCE(c), "fmi2ExitInitializationMode", PHASE_INITIALIZATION)) return fmi2Error;
    return as_fmi2(end_initialization(INSTANCE(c)));
}

fmi2Status fmi2Terminate(fmi2Component c) {
    if (c == NULL || !may(INSTANCE(c), "fmi2Terminate", RUNNING)) return fmi2Error;
    INSTANCE(c)->phase = PHASE_TERMINATED;
    return fmi2OK;
}

fmi2Status fmi2Reset(fmi2Component c) {
    if (c == NULL || !may(INSTANCE(c), "fmi2Reset", PHASE_ANY)) return fmi2Error;
    return as_fmi2(reset(INSTANCE(c)));
}

/* The getter and the setter of a type: NUMBER is what the host's value is made of, VALUE what the number is. */
#define ACCESS(TYPE, KIND, TO_HOST, TO_NUMBER)                                                                       \
    fmi2Status fmi2Get##TYPE(fmi2Component c, const fmi2ValueReference references[], size_t count,                   \
                             fmi2##TYPE values[]) {                                                                  \
        Instance *instance = c;                                                                                      \
        if (c == NULL || !given(instance, "fmi2Get" #TYPE, count, references, values)) return fmi2Error;             \
        if (!may(instance, "fmi2Get" #TYPE, PHASE_INSTANTIATED | READABLE)) return fmi2Error;                        \
        for (size_t i = 0; i < count; i++) {                                                                         \
            const Variable *variable = find(instance, "fmi2Get" #TYPE, references[i], KIND);                         \
            Status status = variable == NULL ? STATUS_ERROR : before_get(instance, "fmi2Get" #TYPE, variable);       \
            if (status != STATUS_OK) return as_fmi2(status);                                                         \
            values[i] = TO_HOST;                                                                                     \
        }                                                                                                            \
        return fmi2OK;                                                                                               \
    }                                                                                                                \
    fmi2Status fmi2Set##TYPE(fmi2Component c, const fmi2ValueReference references[], size_t count,                   \
                             const fmi2##TYPE values[]) {                                                            \
        Instance *instance = c;                                                                                      \
        if (c == NULL || !given(instance, "fmi2Set" #TYPE, count, references, values)) return fmi2Error;             \
        if (!may(instance, "fmi2Set" #TYPE, PHASE_INSTANTIATED | PHASE_INITIALIZATION | PHASE_STEPPING))             \
            return fmi2Error;                                                                                        \
        for (size_t i = 0; i < count; i++) {                                                                         \
            const Variable *variable = find(instance, "fmi2Set" #TYPE, references[i], KIND);                         \
            Status status = variable == NULL ? STATUS_ERROR : before_set(instance, "fmi2Set" #TYPE, variable);       \
            if (status != STATUS_OK) return as_fmi2(status);                                                         \
            TO_NUMBER;                                                                                               \
        }                                                                                                            \
        return fmi2OK;                                                                                               \
    }

#define NUMBER instance->numbers[variable->slot]

ACCESS(Real, KIND_REAL, NUMBER,
       if (set_real(instance, variable, &NUMBER, values[i]) != STATUS_OK) return fmi2Error)
ACCESS(Integer, KIND_INTEGER, whole_value(NUMBER), NUMBER = values[i])
ACCESS(Boolean, KIND_BOOLEAN, NUMBER != 0 ? fmi2True : fmi2False, NUMBER = values[i] != fmi2False)
ACCESS(String, KIND_TEXT, instance->texts[variable->slot],
       if (set_text(instance, variable, values[i]) != STATUS_OK) return fmi2Error)

fmi2Status fmi2DoStep(fmi2Component c, fmi2Real point, fmi2Real step, fmi2Boolean no_set_prior) {
    Step taken;
    Status status;
    (void)no_set_prior;
    if (c == NULL || !may(INSTANCE(c), "fmi2DoStep", PHASE_STEPPING)) return fmi2Error;
    status = take_step(INSTANCE(c), point, step, &taken);
    if (status != STATUS_OK || !taken.stopped) return as_fmi2(status);
    return as_fmi2(tell(INSTANCE(c), STATUS_DISCARD, "the run has ended at %.9g s: %s", taken.reached,
                        ending(INSTANCE(c))));
}

fmi2Status fmi2CancelStep(fmi2Component c) { return refuse(c, "fmi2CancelStep"); }

/* What is told of a step, and when. */
static bool may_tell(fmi2Component c, const char *function, bool known) {
    if (c == NULL || !may(INSTANCE(c), function, RUNNING | PHASE_TERMINATED)) return false;
    if (!known)
        tell(INSTANCE(c), STATUS_ERROR, "%s: nothing of this kind is known, or no place for it was given", function);
    return known;
}

fmi2Status fmi2GetStatus(fmi2Component c, const fmi2StatusKind kind, fmi2Status *value) {
    if (!may_tell(c, "fmi2GetStatus", kind == fmi2DoStepStatus && value != NULL)) return fmi2Error;
    *value = INSTANCE(c)->phase == PHASE_STOPPED ? fmi2Discard : fmi2OK;
    return fmi2OK;
}

fmi2Status fmi2GetRealStatus(fmi2Component c, const fmi2StatusKind kind, fmi2Real *value) {
    if (!may_tell(c, "fmi2GetRealStatus", kind == fmi2LastSuccessfulTime && value != NULL)) return fmi2Error;
    *value = INSTANCE(c)->time;
    return fmi2OK;
}

fmi2Status fmi2GetIntegerStatus(fmi2Component c, const fmi2StatusKind kind, fmi2Integer *value) {
    (void)kind, (void)value;
    may_tell(c, "fmi2GetIntegerStatus", false);
    return fmi2Error;
}

fmi2Status fmi2GetBooleanStatus(fmi2Component c, const fmi2StatusKind kind, fmi2Boolean *value) {
    if (!may_tell(c, "fmi2GetBooleanStatus", kind == fmi2Terminated && value != NULL)) return fmi2Error;
    *value = INSTANCE(c)->phase == PHASE_STOPPED ? fmi2True : fmi2False;
    return fmi2OK;
}

fmi2Status fmi2GetStringStatus(fmi2Component c, const fmi2StatusKind kind, fmi2String *value) {
    if (!may_tell(c, "fmi2GetStringStatus", kind == fmi2PendingStatus && value != NULL)) return fmi2Error;
    *value = "";
    return fmi2OK;
}

#define STATES (PHASE_INSTANTIATED | READABLE)

fmi2Status fmi2GetFMUstate(fmi2Component c, fmi2FMUstate *state) {
    if (c == NULL || !may(INSTANCE(c), "fmi2GetFMUstate", STATES)) return fmi2Error;
    return as_fmi2(state_get(INSTANCE(c), "fmi2GetFMUstate", state));
}

fmi2Status fmi2SetFMUstate(fmi2Component c, fmi2FMUstate state) {
    if (c == NULL || !may(INSTANCE(c), "fmi2SetFMUstate", STATES)) return fmi2Error;
    return as_fmi2(state_set(INSTANCE(c), "fmi2SetFMUstate", state));
}

fmi2Status fmi2FreeFMUstate(fmi2Component c, fmi2FMUstate *state) {
    return c == NULL ? fmi2Error : as_fmi2(state_free(INSTANCE(c), "fmi2FreeFMUstate", state));
}

fmi2Status fmi2SerializedFMUstateSize(fmi2Component c, fmi2FMUstate state, size_t *size) {
    return c == NULL ? fmi2Error : as_fmi2(state_size(INSTANCE(c), "fmi2SerializedFMUstateSize", state, size));
}

fmi2Status fmi2SerializeFMUstate(fmi2Component c, fmi2FMUstate state, fmi2Byte data[], size_t size) {
    return c == NULL ? fmi2Error : as_fmi2(state_write(INSTANCE(c), "fmi2SerializeFMUstate", state, data, size));
}

fmi2Status fmi2DeSerializeFMUstate(fmi2Component c, const fmi2Byte data[], size_t size, fmi2FMUstate *state) {
    return c == NULL ? fmi2Error : as_fmi2(state_read(INSTANCE(c), "fmi2DeSerializeFMUstate", data, size, state));
}

/* What this FMU does not have; the standard wants the functions all the same. */
#define REFUSED(NAME, ...) \
    fmi2Status NAME(fmi2Component c, __VA_ARGS__) { return refuse(c, #NAME); }

#if defined(__GNUC__)
#pragma GCC diagnostic ignored "-Wunused-parameter"
#endif

REFUSED(fmi2GetDirectionalDerivative, const fmi2ValueReference u[], size_t nu, const fmi2ValueReference k[], size_t nk,
        const fmi2Real dk[], fmi2Real du[])
REFUSED(fmi2SetRealInputDerivatives, const fmi2ValueReference r[], size_t n, const fmi2Integer o[], const fmi2Real v[])
REFUSED(fmi2GetRealOutputDerivatives, const fmi2ValueReference r[], size_t n, const fmi2Integer o[], fmi2Real v[])
REFUSED(fmi2NewDiscreteStates, fmi2EventInfo *info)
REFUSED(fmi2CompletedIntegratorStep, fmi2Boolean no_set, fmi2Boolean *enter, fmi2Boolean *end)
REFUSED(fmi2SetTime, fmi2Real time)
REFUSED(fmi2SetContinuousStates, const fmi2Real x[], size_t n)
REFUSED(fmi2GetDerivatives, fmi2Real d[], size_t n)
REFUSED(fmi2GetEventIndicators, fmi2Real e[], size_t n)
REFUSED(fmi2GetContinuousStates, fmi2Real x[], size_t n)
REFUSED(fmi2GetNominalsOfContinuousStates, fmi2Real x[], size_t n)

fmi2Status fmi2EnterEventMode(fmi2Component c) { return refuse(c, "fmi2EnterEventMode"); }

fmi2Status fmi2EnterContinuousTimeMode(fmi2Component c) { return refuse(c, "fmi2EnterContinuousTimeMode"); }
