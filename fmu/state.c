/* Saved states: the values and the time of the wrapper, and the bytes of the worker. */
#include "request.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* What stands at the head of a serialised state. The token says whose it is. */
typedef struct {
    char magic[8];
    uint32_t phase, begun, stale, stop_defined;
    double start, stop, time;
    uint64_t numbers, texts, blob, token;
} Record;

struct State {
    State *next;
    size_t size;
    char *data; /* a Record, numbers, texts with their NUL, the worker's bytes */
};

static const char MAGIC[8] = "GWFMUS1";

static uint64_t token_number(const char *token) {
    uint64_t number = 14695981039346656037u; /* FNV-1a */
    for (; *token != '\0'; token++) number = (number ^ (unsigned char)*token) * 1099511628211u;
    return number;
}

static State *known(Instance *instance, const char *function, void *handle) {
    for (State *state = instance->states; state != NULL; state = state->next)
        if (state == handle) return state;
    tell(instance, STATUS_ERROR, "%s: this is no state of this instance, or it has been freed", function);
    return NULL;
}

static State *add(Instance *instance, size_t size) {
    State *state = calloc(1, sizeof *state);
    if (state == NULL) return NULL;
    state->data = malloc(size);
    if (state->data == NULL) {
        free(state);
        return NULL;
    }
    state->size = size;
    state->next = instance->states;
    instance->states = state;
    return state;
}

static void drop(Instance *instance, State *state) {
    State **link = &instance->states;
    while (*link != state) link = &(*link)->next;
    *link = state->next;
    free(state->data);
    free(state);
}

void state_free_all(Instance *instance) {
    while (instance->states != NULL) drop(instance, instance->states);
}

static size_t all_texts(const Instance *instance) {
    size_t size = 0;
    for (size_t i = 0; i < table_texts(&instance->table); i++) size += strlen(instance->texts[i]) + 1;
    return size;
}

static Record record_of(const Instance *instance, size_t blob) {
    Record record;
    memset(&record, 0, sizeof record);
    memcpy(record.magic, MAGIC, sizeof record.magic);
    record.phase = (uint32_t)instance->phase;
    record.begun = instance->begun;
    record.stale = instance->stale;
    record.stop_defined = instance->stop_defined;
    record.start = instance->start;
    record.stop = instance->stop;
    record.time = instance->time;
    record.numbers = table_numbers(&instance->table);
    record.texts = all_texts(instance);
    record.blob = blob;
    record.token = token_number(instance->table.token);
    return record;
}

static void fill(const Instance *instance, char *place, const Record *record, const Bytes *blob) {
    memcpy(place, record, sizeof *record);
    place += sizeof *record;
    memcpy(place, instance->numbers, (size_t)record->numbers * sizeof(double));
    place += (size_t)record->numbers * sizeof(double);
    for (size_t i = 0; i < table_texts(&instance->table); i++) {
        size_t length = strlen(instance->texts[i]) + 1;
        memcpy(place, instance->texts[i], length);
        place += length;
    }
    if (blob->size > 0) memcpy(place, blob->data, blob->size);
}

/* A run has begun, so that the worker has a state of its own. */
static bool running(const Instance *instance) {
    return (instance->phase & (PHASE_STEPPING | PHASE_STOPPED | PHASE_TERMINATED)) != 0 && instance->begun;
}

Status state_get(Instance *instance, const char *function, void **handle) {
    Bytes blob = {NULL, 0};
    Reply reply = REPLY_STATE;
    double time;
    Record record;
    State *state;
    if (handle == NULL) return tell(instance, STATUS_ERROR, "%s: no place for the state was given", function);
    if (running(instance)) {
        Status status = request(instance, REQUEST_GET_STATE, 0, false, NULL, &reply, &time, &blob);
        if (status != STATUS_OK) return status;
    }
    record = record_of(instance, blob.size);
    if (*handle != NULL) {
        State *old = known(instance, function, *handle);
        if (old == NULL) {
            free(blob.data);
            return STATUS_ERROR;
        }
        drop(instance, old);
        *handle = NULL;
    }
    state = add(instance, sizeof record + (size_t)record.numbers * sizeof(double) + (size_t)record.texts + blob.size);
    if (state != NULL) fill(instance, state->data, &record, &blob);
    free(blob.data);
    if (state == NULL) return tell(instance, STATUS_ERROR, "%s: there is not enough memory", function);
    *handle = state;
    return STATUS_OK;
}

/* Whether the bytes are a whole state of this FMU. */
static bool whole(const Instance *instance, const char *data, size_t size, Record *record) {
    size_t rest, numbers = table_numbers(&instance->table), ends = 0;
    const char *texts;
    if (size < sizeof *record) return false;
    memcpy(record, data, sizeof *record);
    rest = size - sizeof *record;
    if (memcmp(record->magic, MAGIC, sizeof record->magic) != 0) return false;
    if (record->token != token_number(instance->table.token) || record->numbers != numbers) return false;
    if (rest < numbers * sizeof(double)) return false;
    rest -= numbers * sizeof(double);
    if (record->texts > rest || record->blob != rest - record->texts) return false;
    texts = data + sizeof *record + numbers * sizeof(double);
    for (size_t i = 0; i < record->texts; i++) ends += texts[i] == '\0';
    if (ends != table_texts(&instance->table)) return false;
    if (record->texts > 0 && texts[record->texts - 1] != '\0') return false;
    if (!isfinite(record->time) || !isfinite(record->start) || isnan(record->stop)) return false;
    switch (record->phase) {
    case PHASE_INSTANTIATED: case PHASE_INITIALIZATION: case PHASE_ERROR: return record->blob == 0;
    case PHASE_STEPPING: case PHASE_STOPPED: case PHASE_TERMINATED: return true;
    default: return false;
    }
}

static Status take_values(Instance *instance, const Record *record, const char *data) {
    const char *texts = data + sizeof *record + (size_t)record->numbers * sizeof(double);
    memcpy(instance->numbers, data + sizeof *record, (size_t)record->numbers * sizeof(double));
    for (size_t i = 0; i < table_texts(&instance->table); i++) {
        size_t length = strlen(texts) + 1;
        char *text = malloc(length);
        if (text == NULL) return tell(instance, STATUS_ERROR, "there is not enough memory");
        memcpy(text, texts, length);
        free(instance->texts[i]);
        instance->texts[i] = text;
        texts += length;
    }
    return STATUS_OK;
}

Status state_set(Instance *instance, const char *function, void *handle) {
    State *state = known(instance, function, handle);
    Record record;
    Reply reply = REPLY_DONE;
    double time;
    Status status;
    if (state == NULL) return STATUS_ERROR;
    memcpy(&record, state->data, sizeof record);
    status = take_values(instance, &record, state->data);
    if (status == STATUS_OK && record.blob > 0) {
        /* The parameters go first: they may be others than those of the worker's present model. */
        Bytes blob = {state->data + (state->size - (size_t)record.blob), (size_t)record.blob};
        status = request(instance, REQUEST_START, 1, true, NULL, &reply, &time, NULL);
        if (status == STATUS_OK)
            status = request(instance, REQUEST_SET_STATE, 0, false, &blob, &reply, &time, NULL);
        if (status == STATUS_OK) status = take_values(instance, &record, state->data);
    }
    if (status != STATUS_OK) {
        if (instance->phase != PHASE_FATAL) instance->phase = PHASE_ERROR;
        return status;
    }
    instance->phase = (Phase)record.phase;
    instance->begun = record.begun != 0;
    instance->stale = record.stale != 0 || record.blob == 0;
    instance->stop_defined = record.stop_defined != 0;
    instance->start = record.start;
    instance->stop = record.stop;
    instance->time = record.time;
    return STATUS_OK;
}

Status state_free(Instance *instance, const char *function, void **handle) {
    State *state;
    if (handle == NULL || *handle == NULL) return STATUS_OK;
    state = known(instance, function, *handle);
    if (state == NULL) return STATUS_ERROR;
    drop(instance, state);
    *handle = NULL;
    return STATUS_OK;
}

Status state_size(Instance *instance, const char *function, void *handle, size_t *size) {
    State *state = known(instance, function, handle);
    if (state == NULL) return STATUS_ERROR;
    if (size == NULL) return tell(instance, STATUS_ERROR, "%s: no place for the size was given", function);
    *size = state->size;
    return STATUS_OK;
}

Status state_write(Instance *instance, const char *function, void *handle, void *data, size_t size) {
    State *state = known(instance, function, handle);
    if (state == NULL) return STATUS_ERROR;
    if (data == NULL || size < state->size)
        return tell(instance, STATUS_ERROR, "%s: the state needs %zu bytes, %zu were given", function, state->size,
                    size);
    memcpy(data, state->data, state->size);
    return STATUS_OK;
}

Status state_read(Instance *instance, const char *function, const void *data, size_t size, void **handle) {
    Record record;
    State *state;
    if (handle == NULL) return tell(instance, STATUS_ERROR, "%s: no place for the state was given", function);
    if (data == NULL || !whole(instance, data, size, &record))
        return tell(instance, STATUS_ERROR, "%s: these bytes are no state of this FMU, or are damaged", function);
    state = add(instance, size);
    if (state == NULL) return tell(instance, STATUS_ERROR, "%s: there is not enough memory", function);
    memcpy(state->data, data, size);
    *handle = state;
    return STATUS_OK;
}
