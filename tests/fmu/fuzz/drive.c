/* A host that calls what the fuzzer says, and then reads everything that can be read. */
#include "memory.h"

#include "fmi2Functions.h"
#include "fmi3Functions.h"
#include "instance.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static void use(const char *text) {
    volatile size_t length = strlen(text); /* a text must end */
    (void)length;
}

static void log2_(fmi2ComponentEnvironment e, fmi2String name, fmi2Status s, fmi2String category, fmi2String message,
                  ...) {
    (void)e, (void)s;
    use(name), use(category), use(message);
}

static void log3(fmi3InstanceEnvironment e, fmi3Status s, fmi3String category, fmi3String message) {
    (void)e, (void)s;
    use(category), use(message);
}

enum { MOST = 4096 };

/* A variable by the getter of its type, and by one of another: `kind` is one of KIND_... */
static void read2(fmi2Component c, fmi2ValueReference reference, char kind) {
    fmi2Real real;
    fmi2Integer integer;
    fmi2Boolean boolean;
    fmi2String text;
    if (kind == KIND_REAL) fmi2GetReal(c, &reference, 1, &real);
    if (kind == KIND_INTEGER) fmi2GetInteger(c, &reference, 1, &integer);
    if (kind == KIND_BOOLEAN) fmi2GetBoolean(c, &reference, 1, &boolean);
    if (kind == KIND_TEXT && fmi2GetString(c, &reference, 1, &text) == fmi2OK) use(text);
}

static void read3(fmi3Instance c, fmi3ValueReference reference, char kind, size_t size) {
    static fmi3Float64 reals[MOST];
    static fmi3Int32 integers[MOST];
    static bool booleans[MOST];
    fmi3String text;
    if (size > MOST) return;
    if (kind == KIND_REAL) fmi3GetFloat64(c, &reference, 1, reals, size);
    if (kind == KIND_INTEGER) fmi3GetInt32(c, &reference, 1, integers, size);
    if (kind == KIND_BOOLEAN) fmi3GetBoolean(c, &reference, 1, booleans, size);
    if (kind == KIND_TEXT && fmi3GetString(c, &reference, 1, &text, 1) == fmi3OK) use(text);
}

static void read_all(int version, const Instance *instance, void *c) {
    static const char KINDS[] = {KIND_REAL, KIND_INTEGER, KIND_BOOLEAN, KIND_TEXT};
    size_t count = instance->table.n_variables;
    for (size_t i = 0; i < count; i++) {
        const Variable *variable = &instance->table.variables[i];
        if (version == 2) read2(c, (fmi2ValueReference)i, (char)variable->kind);
        else read3(c, (fmi3ValueReference)i, (char)variable->kind, variable->size);
    }
    /* One that is of another type for all but one, and one that is not there. */
    for (size_t k = 0; k < sizeof KINDS; k++)
        for (size_t i = 0; i <= count; i += count > 0 ? count : 1) {
            if (version == 2) read2(c, (fmi2ValueReference)i, KINDS[k]);
            else read3(c, (fmi3ValueReference)i, KINDS[k], 1);
        }
}

static void write3(fmi3Instance c, fmi3ValueReference reference, size_t size) {
    static fmi3Float64 reals[MOST];
    static fmi3Int32 integers[MOST];
    static bool booleans[MOST];
    fmi3String text = "written";
    if (size > MOST) return;
    fmi3SetFloat64(c, &reference, 1, reals, size);
    fmi3SetInt32(c, &reference, 1, integers, size);
    fmi3SetBoolean(c, &reference, 1, booleans, size);
    fmi3SetString(c, &reference, 1, &text, 1);
}

/* What both versions have, by the functions that are below them: the same for either. */
static void call(int version, void *c, uint8_t which, void **state, double *time) {
    Instance *instance = c;
    fmi3Boolean event, end, early;
    fmi3Float64 last;
    size_t size = 0;
    switch (which % 10) {
    case 0:
        if (version == 2) fmi2EnterInitializationMode(c);
        else fmi3EnterInitializationMode(c, false, 0, 0, false, 0);
        *time = 0;
        break;
    case 1:
        if (version == 2) fmi2ExitInitializationMode(c);
        else fmi3ExitInitializationMode(c);
        break;
    case 2:
        if (version == 2) fmi2DoStep(c, *time, 0.5, fmi2True);
        else fmi3DoStep(c, *time, 0.5, true, &event, &end, &early, &last);
        *time = instance->time;
        break;
    case 3:
        if (version == 2) fmi2Reset(c);
        else fmi3Reset(c);
        break;
    case 4:
        if (version == 2) fmi2GetFMUstate(c, state);
        else fmi3GetFMUState(c, state);
        break;
    case 5:
        if (version == 2) fmi2SetFMUstate(c, *state);
        else fmi3SetFMUState(c, *state);
        *time = instance->time;
        break;
    case 6:
        if (version == 2) fmi2FreeFMUstate(c, state);
        else fmi3FreeFMUState(c, state);
        break;
    case 7:
        if (version == 2) fmi2Terminate(c);
        else fmi3Terminate(c);
        break;
    case 8:
        for (size_t i = 0; i < instance->table.n_variables; i++)
            write3(c, (fmi3ValueReference)i, instance->table.variables[i].size);
        break;
    default:
        if (*state != NULL && fmi3SerializedFMUStateSize(c, *state, &size) == fmi3OK) {
            fmi3Byte *bytes = malloc(size);
            if (bytes != NULL && fmi3SerializeFMUState(c, *state, bytes, size) == fmi3OK) {
                void *again = NULL;
                if (fmi3DeserializeFMUState(c, bytes, size, &again) != fmi3OK) abort(); /* its own state */
                fmi3FreeFMUState(c, &again);
            }
            free(bytes);
        }
    }
}

void drive(int version, const char *token, Piece calls) {
    fmi2CallbackFunctions functions = {log2_, NULL, NULL, NULL, NULL};
    void *state = NULL, *c;
    double time = 0;
    if (version == 2) c = fmi2Instantiate("f", fmi2CoSimulation, token, "file:///f", &functions, fmi2False, fmi2True);
    else c = fmi3InstantiateCoSimulation("f", token, "/f/", false, true, false, true, NULL, 0, NULL, log3, NULL);
    if (c == NULL) return;
    for (size_t i = 0; i < calls.size; i++) {
        const Instance *instance = c;
        call(version, c, calls.data[i], &state, &time);
        read_all(version, instance, c);
        if (!isfinite(instance->time)) abort();
    }
    if (version == 2) fmi2FreeInstance(c);
    else fmi3FreeInstance(c);
}
