/* What the wrapper knows of its model: the table that stands in the FMU's resources. */
#ifndef GW_TABLE_H
#define GW_TABLE_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#define TABLE_FILE "wrapper.txt"
#define TABLE_HEAD "gw-fmu-wrapper 1"

typedef enum { KIND_REAL = 'R', KIND_INTEGER = 'I', KIND_BOOLEAN = 'B', KIND_TEXT = 'S' } Kind;
typedef enum { ROLE_TIME = 't', ROLE_INPUT = 'i', ROLE_FIXED = 'f', ROLE_TUNABLE = 'u', ROLE_OUTPUT = 'o' } Role;

/* A variable; its value reference is its place in the table. Numbers of all kinds are kept as doubles. */
typedef struct {
    Kind kind;
    Role role;
    size_t size;    /* values; more than one for an array */
    size_t slot;    /* of the first value, among the numbers or among the texts */
    double start;
    char *name;
    char *text;     /* start of a text */
} Variable;

/* Of the numbers, and of the texts, those that can be set stand first, then the outputs; time is the last number. */
typedef struct {
    char *content;
    const char *token, *version, *python, *path, *program, *glibc, *remedy;
    const char *arguments[16], *environment[16];
    size_t n_arguments, n_environment;
    Variable *variables;
    size_t n_variables;
    size_t n_set_numbers, n_output_numbers, n_set_texts, n_output_texts;
    size_t timeout; /* value reference of the time-out; n_variables if there is none */
} Table;

/* Reads the table of a resources folder; false, with a sentence, if it is missing or not understood. */
bool table_read(Table *table, const char *resources, char *message, size_t size);
void table_free(Table *table);

size_t table_numbers(const Table *table);
size_t table_texts(const Table *table);
bool table_settable(const Variable *variable);

#endif
