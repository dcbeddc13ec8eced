/* The table in an FMU's resources: whatever stands in it, an instance of it stays within its memory. */
#include "memory.h"

#include "request.h"

#include <stdlib.h>
#include <string.h>

/* Reset, initialize, step, write: with a worker that greets as the table wants, and sends nothing more. */
static const uint8_t CALLS[] = {8, 4, 9, 0, 5, 6, 3, 0, 1};

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size) {
    Table table;
    char message[2500];
    uint8_t *greeting;
    memory_table = (Piece){data, size};
    if (table_read(&table, "/f", message, sizeof message)) {
        memory_worker.data = greeting = memory_greeting(table.version, (Piece){NULL, 0}, &memory_worker.size);
        for (int version = 2; version <= 3; version++) drive(version, table.token, (Piece){CALLS, sizeof CALLS});
        free(greeting);
    } else if (memchr(message, '\0', sizeof message) == NULL || *message == '\0') {
        abort(); /* a refusal says why */
    }
    table_free(&table);
    return 0;
}
