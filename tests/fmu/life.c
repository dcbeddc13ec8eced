/* A host in C that goes through everything that an instance can do: `life VERSION LIBRARY RESOURCES TOKEN ROUNDS`.
 *
 * With it valgrind and the leak checker see the wrapper alone. ROUNDS of 0 goes on until it is killed. The variables are
 * those of standin.py; with any other table the numbers are not looked at, so it drives a real worker too. */
#include "fmi2FunctionTypes.h"
#include "fmi3FunctionTypes.h"

#include <dlfcn.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static void *library;
static size_t messages;

static void *function(const char *name) {
    void *found = dlsym(library, name);
    if (found == NULL) exit(3);
    return found;
}

#define F2(NAME) ((fmi2##NAME##TYPE *)function("fmi2" #NAME))
#define F3(NAME) ((fmi3##NAME##TYPE *)function("fmi3" #NAME))

static void count2(fmi2ComponentEnvironment e, fmi2String name, fmi2Status s, fmi2String category, fmi2String text, ...) {
    (void)e, (void)s;
    messages += strlen(name) + strlen(category) + strlen(text) > 0;
}

static void count3(fmi3InstanceEnvironment e, fmi3Status s, fmi3String category, fmi3String text) {
    (void)e, (void)s;
    messages += strlen(category) + strlen(text) > 0;
}

/* By reference, as in standin.py. */
enum { BEHAVIOUR = 1, FIXED = 3, TEXT = 6, TWICE = 7, MESSAGE = 10 };

static int round2(const char *resources, const char *token, int behaviour) {
    fmi2CallbackFunctions functions = {count2, calloc, free, NULL, NULL};
    fmi2ValueReference input = BEHAVIOUR, fixed = FIXED, text = TEXT, twice = TWICE, message = MESSAGE, none = 999;
    fmi2FMUstate state = NULL, again = NULL;
    fmi2Real value = 2, time = 0;
    fmi2Boolean ended;
    fmi2String words = "a text of the host's";
    size_t size = 0;
    char location[4096];
    fmi2Byte *bytes;
    fmi2Component c;
    snprintf(location, sizeof location, "file://%s", resources);
    if (F2(Instantiate)("life", fmi2CoSimulation, "wrong", location, &functions, fmi2False, fmi2True) != NULL) return 1;
    c = F2(Instantiate)("life", fmi2CoSimulation, token, location, &functions, fmi2False, fmi2True);
    if (c == NULL) return 2;
    F2(SetReal)(c, &fixed, 1, &value);
    F2(SetString)(c, &text, 1, &words);
    F2(GetReal)(c, &none, 1, &value);
    if (F2(SetupExperiment)(c, fmi2False, 0, 0, fmi2True, 100) != fmi2OK) return 3;
    if (F2(EnterInitializationMode)(c) != fmi2OK || F2(ExitInitializationMode)(c) != fmi2OK) return 4;
    for (int i = 0; i < 3; i++, time += 0.05)
        if (F2(DoStep)(c, time, 0.05, fmi2True) != fmi2OK) return 5;
    if (F2(GetFMUstate)(c, &state) != fmi2OK || F2(SerializedFMUstateSize)(c, state, &size) != fmi2OK) return 6;
    bytes = malloc(size);
    if (F2(SerializeFMUstate)(c, state, bytes, size) != fmi2OK) return 7;
    if (F2(DeSerializeFMUstate)(c, bytes, size, &again) != fmi2OK) return 8;
    if (F2(SetFMUstate)(c, again) != fmi2OK || F2(DoStep)(c, time, 0.05, fmi2True) != fmi2OK) return 9;
    bytes[8] = 127;
    if (F2(DeSerializeFMUstate)(c, bytes, size, &again) != fmi2Error) return 10;
    free(bytes);
    F2(FreeFMUstate)(c, &state); /* the other state is left to the instance */
    F2(SetInteger)(c, &input, 1, &behaviour);
    F2(DoStep)(c, time + 0.05, 0.05, fmi2True);
    F2(GetBooleanStatus)(c, fmi2Terminated, &ended);
    F2(GetReal)(c, &twice, 1, &value);
    F2(GetString)(c, &message, 1, &words);
    F2(Terminate)(c);
    F2(DoStep)(c, 0, -1, fmi2True);
    if (F2(Reset)(c) == fmi2OK) F2(EnterInitializationMode)(c);
    F2(FreeInstance)(c);
    return 0;
}

static int round3(const char *resources, const char *token, int behaviour) {
    fmi3ValueReference input = BEHAVIOUR, fixed = FIXED, text = TEXT, twice = TWICE, message = MESSAGE, none = 999;
    fmi3FMUState state = NULL, again = NULL;
    fmi3Float64 value = 2, time = 0, last;
    fmi3Boolean event, end, early;
    fmi3String words = "a text of the host's";
    size_t size = 0;
    fmi3Byte *bytes;
    fmi3Instance c;
    fmi3InstantiateCoSimulationTYPE *make = F3(InstantiateCoSimulation);
    if (make("life", "wrong", resources, false, true, false, true, NULL, 0, NULL, count3, NULL) != NULL) return 1;
    c = make("life", token, resources, false, true, false, true, NULL, 0, NULL, count3, NULL);
    if (c == NULL) return 2;
    F3(SetFloat64)(c, &fixed, 1, &value, 1);
    F3(SetString)(c, &text, 1, &words, 1);
    F3(GetFloat64)(c, &none, 1, &value, 1);
    if (F3(EnterInitializationMode)(c, false, 0, 0, true, 100) != fmi3OK) return 3;
    if (F3(ExitInitializationMode)(c) != fmi3OK) return 4;
    for (int i = 0; i < 3; i++, time += 0.05)
        if (F3(DoStep)(c, time, 0.05, true, &event, &end, &early, &last) != fmi3OK) return 5;
    if (F3(GetFMUState)(c, &state) != fmi3OK || F3(SerializedFMUStateSize)(c, state, &size) != fmi3OK) return 6;
    bytes = malloc(size);
    if (F3(SerializeFMUState)(c, state, bytes, size) != fmi3OK) return 7;
    if (F3(DeserializeFMUState)(c, bytes, size, &again) != fmi3OK) return 8;
    if (F3(SetFMUState)(c, again) != fmi3OK) return 9;
    if (F3(DoStep)(c, time, 0.05, true, &event, &end, &early, &last) != fmi3OK) return 9;
    bytes[8] = 127;
    if (F3(DeserializeFMUState)(c, bytes, size, &again) != fmi3Error) return 10;
    free(bytes);
    F3(FreeFMUState)(c, &state);
    F3(SetInt32)(c, &input, 1, &behaviour, 1);
    F3(DoStep)(c, time + 0.05, 0.05, true, &event, &end, &early, &last);
    F3(GetFloat64)(c, &twice, 1, &value, 1);
    F3(GetString)(c, &message, 1, &words, 1);
    F3(Terminate)(c);
    F3(DoStep)(c, 0, -1, true, &event, &end, &early, &last);
    if (F3(Reset)(c) == fmi3OK) F3(EnterInitializationMode)(c, false, 0, 0, false, 0);
    F3(FreeInstance)(c);
    return 0;
}

int main(int count, char **arguments) {
    int rounds, version, wrong = 0;
    if (count != 6 || (library = dlopen(arguments[2], RTLD_NOW)) == NULL) return 2;
    version = atoi(arguments[1]);
    rounds = atoi(arguments[5]);
    for (int i = 0; (rounds == 0 || i < rounds) && wrong == 0; i++) {
        /* Every way in which the stand-in ends a step but the one that hangs (5) and the slow one (6). */
        int behaviour = i % 9 < 5 ? i % 9 : i % 9 + 2;
        wrong = (version == 2 ? round2 : round3)(arguments[3], arguments[4], behaviour);
    }
    if (wrong != 0) fprintf(stderr, "round: %d\n", wrong);
    if (messages == 0) wrong = 99;
    dlclose(library);
    return wrong == 0 ? 0 : 1;
}
