/* Reading of the table: lines of a keyword and what belongs to it, parted by single spaces. */
#include "table.h"

#include "platform.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { LARGEST_FILE = 4 * 1024 * 1024, MOST_VALUES = 1000000 };

static bool complain(char *message, size_t size, const char *path, size_t line, const char *what) {
    snprintf(message, size, "%.1000s:%zu: %s; export the FMU again", path, line, what);
    return false;
}

static char *whole_file(const char *path, size_t *length) {
    FILE *file = platform_open(path);
    char *content = NULL;
    if (file == NULL) return NULL;
    content = malloc(LARGEST_FILE + 1);
    if (content != NULL) {
        *length = fread(content, 1, LARGEST_FILE, file);
        content[*length] = '\0';
    }
    fclose(file);
    return content;
}

/* The next word of a line, cut off at its space; empty at the line's end. */
static char *word(char **rest) {
    char *begin = *rest, *space = strchr(begin, ' ');
    if (space == NULL) {
        *rest = begin + strlen(begin);
    } else {
        *space = '\0';
        *rest = space + 1;
    }
    return begin;
}

static bool whole_number(const char *text, size_t most, size_t *value) {
    size_t number = 0;
    if (*text == '\0') return false;
    for (; *text != '\0'; text++) {
        if (*text < '0' || *text > '9') return false;
        number = number * 10 + (size_t)(*text - '0');
        if (number > most) return false;
    }
    *value = number;
    return true;
}

/* A double as the 16 hexadecimal digits of its bits: exact, and the same in every locale. */
static bool bits(const char *text, double *value) {
    uint64_t pattern = 0;
    if (strlen(text) != 16) return false;
    for (; *text != '\0'; text++) {
        unsigned digit;
        if (*text >= '0' && *text <= '9') digit = (unsigned)(*text - '0');
        else if (*text >= 'a' && *text <= 'f') digit = (unsigned)(*text - 'a') + 10;
        else return false;
        pattern = pattern << 4 | digit;
    }
    memcpy(value, &pattern, sizeof *value);
    return true;
}

/* variable KIND ROLE SIZE START NAME [TEXT] */
static bool read_variable(Variable *variable, char *rest) {
    const char *kind = word(&rest), *role = word(&rest), *size = word(&rest), *start = word(&rest);
    if (strlen(kind) != 1 || strchr("RIBS", *kind) == NULL) return false;
    if (strlen(role) != 1 || strchr("tifuo", *role) == NULL) return false;
    variable->kind = (Kind)*kind;
    variable->role = (Role)*role;
    if (!whole_number(size, MOST_VALUES, &variable->size) || variable->size == 0) return false;
    if (!bits(start, &variable->start)) return false;
    if (variable->kind == KIND_TEXT && variable->size != 1) return false;
    if (variable->role == ROLE_TIME && (variable->kind != KIND_REAL || variable->size != 1)) return false;
    variable->name = word(&rest);
    variable->text = rest;
    return *variable->name != '\0';
}

bool table_settable(const Variable *variable) {
    return variable->role == ROLE_INPUT || variable->role == ROLE_FIXED || variable->role == ROLE_TUNABLE;
}

/* Gives every variable its slot. */
static bool lay_out(Table *table) {
    for (size_t i = 0; i < table->n_variables; i++) {
        Variable *variable = &table->variables[i];
        bool text = variable->kind == KIND_TEXT;
        size_t *count;
        if (variable->role == ROLE_TIME) continue;
        if (table_settable(variable)) count = text ? &table->n_set_texts : &table->n_set_numbers;
        else count = text ? &table->n_output_texts : &table->n_output_numbers;
        variable->slot = *count;
        *count += variable->size;
        if (*count > MOST_VALUES) return false;
    }
    for (size_t i = 0; i < table->n_variables; i++) {
        Variable *variable = &table->variables[i];
        if (variable->role == ROLE_TIME) variable->slot = table->n_set_numbers + table->n_output_numbers;
        if (variable->role == ROLE_OUTPUT)
            variable->slot += variable->kind == KIND_TEXT ? table->n_set_texts : table->n_set_numbers;
    }
    return true;
}

static bool keep(const char **list, size_t *count, const char *text) {
    if (*count >= 15) return false;
    list[(*count)++] = text;
    return true;
}

static bool read_line(Table *table, char *line, size_t capacity) {
    char *rest = line;
    const char *keyword = word(&rest);
    if (strcmp(keyword, "token") == 0) table->token = rest;
    else if (strcmp(keyword, "version") == 0) table->version = rest;
    else if (strcmp(keyword, "python") == 0) table->python = rest;
    else if (strcmp(keyword, "path") == 0) table->path = rest;
    else if (strcmp(keyword, "program") == 0) table->program = rest;
    else if (strcmp(keyword, "glibc") == 0) table->glibc = rest;
    else if (strcmp(keyword, "remedy") == 0) table->remedy = rest;
    else if (strcmp(keyword, "argument") == 0) return keep(table->arguments, &table->n_arguments, rest);
    else if (strcmp(keyword, "environment") == 0) return keep(table->environment, &table->n_environment, rest);
    else if (strcmp(keyword, "timeout") == 0) return whole_number(rest, MOST_VALUES, &table->timeout);
    else if (strcmp(keyword, "variable") == 0)
        return table->n_variables < capacity && read_variable(&table->variables[table->n_variables++], rest);
    else return false;
    return true;
}

static size_t count_lines(const char *content) {
    size_t lines = 1;
    for (; *content != '\0'; content++) lines += *content == '\n';
    return lines;
}

static bool read_lines(Table *table, const char *path, char *message, size_t size) {
    size_t line = 0, capacity = count_lines(table->content);
    char *rest = table->content;
    table->variables = calloc(capacity, sizeof *table->variables);
    if (table->variables == NULL) return complain(message, size, path, 1, "there is not enough memory to read it");
    while (rest != NULL && *rest != '\0') {
        char *begin = rest, *end = strchr(begin, '\n');
        rest = NULL;
        if (end != NULL) {
            *end = '\0';
            rest = end + 1;
        }
        line++;
        if (line == 1 ? strcmp(begin, TABLE_HEAD) != 0 : !read_line(table, begin, capacity))
            return complain(message, size, path, line, "this line is not understood");
    }
    if (*table->token == '\0' || *table->version == '\0' || (table->n_arguments == 0 && *table->program == '\0'))
        return complain(message, size, path, line, "the table is cut short");
    if (!lay_out(table)) return complain(message, size, path, line, "there are too many values");
    if (table->timeout >= table->n_variables || table->variables[table->timeout].kind != KIND_REAL)
        table->timeout = table->n_variables;
    return true;
}

bool table_read(Table *table, const char *resources, char *message, size_t size) {
    char path[4096];
    size_t length = 0;
    int written = snprintf(path, sizeof path, "%s/%s", resources, TABLE_FILE);
    memset(table, 0, sizeof *table);
    table->token = table->version = table->python = table->path = table->remedy = "";
    table->program = table->glibc = "";
    table->timeout = MOST_VALUES;
    if (written < 0 || (size_t)written >= sizeof path) {
        snprintf(message, size, "the path of the FMU's resources is too long; unpack it into a shorter folder");
        return false;
    }
    table->content = whole_file(path, &length);
    if (table->content == NULL) {
        snprintf(message, size, "%.1000s can't be read; the host must give the folder of the FMU's resources, unpacked",
                 path);
        return false;
    }
    if (length >= LARGEST_FILE || strlen(table->content) != length)
        return complain(message, size, path, 1, "this is no table of variables");
    return read_lines(table, path, message, size);
}

void table_free(Table *table) {
    free(table->variables);
    free(table->content);
    memset(table, 0, sizeof *table);
}

size_t table_numbers(const Table *table) { return table->n_set_numbers + table->n_output_numbers + 1; }

size_t table_texts(const Table *table) { return table->n_set_texts + table->n_output_texts; }
