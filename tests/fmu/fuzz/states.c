/* Serialised states: bytes that a host hands over as a state, set into an instance where they are taken. */
#include "memory.h"

#include "fmi3Functions.h"
#include "instance.h"

#include <stdlib.h>
#include <string.h>

static Table real;

int LLVMFuzzerInitialize(int *count, char ***arguments) {
    char message[2500];
    (void)count, (void)arguments;
    memory_load_table();
    return table_read(&real, "/f", message, sizeof message) ? 0 : 1;
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size) {
    uint8_t *greeting = memory_greeting(real.version, (Piece){NULL, 0}, &memory_worker.size);
    fmi3Instance c;
    fmi3FMUState state = NULL;
    fmi3ValueReference reference = 0;
    fmi3Float64 value;
    memory_worker.data = greeting;
    c = fmi3InstantiateCoSimulation("f", real.token, "/f/", false, true, false, true, NULL, 0, NULL, NULL, NULL);
    if (c == NULL) abort();
    if (fmi3DeserializeFMUState(c, data, size, &state) == fmi3OK) {
        fmi3Byte *again = malloc(size);
        if (again == NULL || fmi3SerializeFMUState(c, state, again, size) != fmi3OK) abort();
        if (memcmp(again, data, size) != 0) abort();
        free(again);
        fmi3SetFMUState(c, state);
        fmi3GetFloat64(c, &reference, 1, &value, 1);
        for (size_t i = 0; i < real.n_variables; i++) {
            fmi3String text;
            reference = (fmi3ValueReference)i;
            if (fmi3GetString(c, &reference, 1, &text, 1) == fmi3OK && strlen(text) > size) abort();
        }
        fmi3Reset(c);
    }
    fmi3FreeInstance(c);
    free(greeting);
    return 0;
}
