/* What a worker sends: the first byte says which version and how many calls (15 at most), then come the calls, then the
 * frames. */
#include "memory.h"

#include "table.h"

static Table real;

int LLVMFuzzerInitialize(int *count, char ***arguments) {
    char message[2500];
    (void)count, (void)arguments;
    memory_load_table();
    return table_read(&real, "/f", message, sizeof message) ? 0 : 1;
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size) {
    size_t calls;
    if (size < 1) return 0;
    calls = data[0] >> 2 & 15;
    if (calls > size - 1) calls = size - 1;
    memory_silent = data[0] >> 1 & 1;
    memory_worker = (Piece){data + 1 + calls, size - 1 - calls};
    drive(2 + (data[0] & 1), real.token, (Piece){data + 1, calls});
    return 0;
}
