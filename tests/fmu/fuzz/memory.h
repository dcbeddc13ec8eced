/* A platform of memory for the fuzz targets: the table is a text, and the worker is what it sends. */
#ifndef GW_FUZZ_MEMORY_H
#define GW_FUZZ_MEMORY_H

#include <stddef.h>
#include <stdint.h>

typedef struct {
    const uint8_t *data;
    size_t size;
} Piece;

/* What stands in the table's file, and what the worker will send; after its end the worker has ended, or is silent. */
extern Piece memory_table, memory_worker;
extern int memory_silent;

/* The table of a real FMU, which the environment variable GW_FUZZ_TABLE names, as memory_table; ends without. */
void memory_load_table(void);

/* A greeting of the version that the table wants, before `rest`; to be freed. */
uint8_t *memory_greeting(const char *version, Piece rest, size_t *size);

/* Drives an instance of FMI 2.0 or 3.0: each byte of `calls` is a call. Everything that can be read is read after it. */
void drive(int version, const char *token, Piece calls);

#endif
