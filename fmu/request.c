#include "request.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

typedef struct {
    uint32_t kind, numbers, bytes, reserved;
} Head;

enum { MOST_BYTES = 1 << 30, MOST_AT_ONCE = 1 << 20 };

static const double HELLO_TIMEOUT = 60;

static double timeout_of(const Instance *instance) {
    const Table *table = &instance->table;
    if (table->timeout == table->n_variables) return 0;
    return instance->numbers[table->variables[table->timeout].slot];
}

/* The worker is lost: the instance is too, the host and other instances are not. */
static Status lost(Instance *instance, Channel how, double timeout) {
    char words[1500] = "";
    if (how == CHANNEL_SILENT) {
        worker_stop(instance->worker);
        instance->worker = NULL;
        instance->phase = PHASE_FATAL;
        return tell(instance, STATUS_FATAL,
                    "the worker gave no sign of life for %.6g s and was ended; make a new instance, and a larger "
                    "worker.timeout if the model needs longer for one solver step",
                    timeout);
    }
    worker_last_words(instance->worker, words, sizeof words);
    worker_stop(instance->worker);
    instance->worker = NULL;
    instance->phase = PHASE_FATAL;
    return tell(instance, STATUS_FATAL, "the worker process has ended%s%s; make a new instance to go on",
                *words == '\0' ? " without a word: it was killed, or crashed" : ", its last words: ", words);
}

static Status nonsense(Instance *instance) {
    worker_stop(instance->worker);
    instance->worker = NULL;
    instance->phase = PHASE_FATAL;
    return tell(instance, STATUS_FATAL, "the worker's reply is not understood; %s", instance->table.remedy);
}

static Status receive(Instance *instance, void *data, size_t size, double timeout) {
    Channel state = worker_receive(instance->worker, data, size, timeout);
    return state == CHANNEL_OK ? STATUS_OK : lost(instance, state, timeout);
}

/* Room is made for what comes, not for what a head that may be wrong announces. */
static Status receive_bytes(Instance *instance, size_t size, double timeout, Bytes *bytes) {
    do {
        size_t piece = size - bytes->size < MOST_AT_ONCE ? size - bytes->size : MOST_AT_ONCE;
        char *larger = realloc(bytes->data, bytes->size + piece + 1);
        if (larger == NULL) return nonsense(instance);
        bytes->data = larger;
        if (receive(instance, bytes->data + bytes->size, piece, timeout) != STATUS_OK) return STATUS_FATAL;
        bytes->size += piece;
        bytes->data[bytes->size] = '\0';
    } while (bytes->size < size);
    return STATUS_OK;
}

Status request_hello(Instance *instance) {
    Head head;
    Bytes version = {NULL, 0};
    Channel state = worker_receive(instance->worker, &head, sizeof head, HELLO_TIMEOUT);
    if (state == CHANNEL_CLOSED) {
        char words[1500] = "";
        worker_last_words(instance->worker, words, sizeof words);
        return tell(instance, STATUS_ERROR, "the worker could not be started (%s); %s",
                    *words == '\0' ? "it ended without a word" : words, instance->table.remedy);
    }
    if (state == CHANNEL_SILENT || head.kind != REPLY_HELLO || head.numbers != 0 || head.bytes > 1000)
        return tell(instance, STATUS_ERROR, "the worker did not answer as it should; %s", instance->table.remedy);
    if (receive_bytes(instance, head.bytes, HELLO_TIMEOUT, &version) != STATUS_OK) {
        free(version.data);
        return STATUS_ERROR;
    }
    if (strcmp(version.data, instance->table.version) != 0) {
        tell(instance, STATUS_ERROR, "the worker's package has version %.100s, this FMU was made by %.100s; %s",
             version.data, instance->table.version, instance->table.remedy);
        free(version.data);
        return STATUS_ERROR;
    }
    free(version.data);
    return STATUS_OK;
}

static size_t texts_size(const Instance *instance) {
    size_t size = 0;
    for (size_t i = 0; i < instance->table.n_set_texts; i++) size += sizeof(uint32_t) + strlen(instance->texts[i]);
    return size;
}

static void put_texts(const Instance *instance, char *place) {
    for (size_t i = 0; i < instance->table.n_set_texts; i++) {
        uint32_t length = (uint32_t)strlen(instance->texts[i]);
        memcpy(place, &length, sizeof length);
        memcpy(place + sizeof length, instance->texts[i], length);
        place += sizeof length + length;
    }
}

static Status send_request(Instance *instance, Request kind, double extra, bool texts, const Bytes *bytes) {
    const Table *table = &instance->table;
    size_t n_bytes = (texts ? texts_size(instance) : 0) + (bytes != NULL ? bytes->size : 0);
    size_t numbers = 1 + table->n_set_numbers, size = sizeof(Head) + numbers * sizeof(double) + n_bytes;
    Head head = {(uint32_t)kind, (uint32_t)numbers, (uint32_t)n_bytes, 0};
    char *message = malloc(size), *place = message;
    Channel state;
    if (message == NULL || n_bytes > MOST_BYTES) {
        free(message);
        return tell(instance, STATUS_ERROR, "there is not enough memory");
    }
    memcpy(place, &head, sizeof head);
    place += sizeof head;
    memcpy(place, &extra, sizeof extra);
    memcpy(place + sizeof extra, instance->numbers, table->n_set_numbers * sizeof(double));
    place += numbers * sizeof(double);
    if (texts) put_texts(instance, place);
    else if (bytes != NULL && bytes->size > 0) memcpy(place, bytes->data, bytes->size);
    state = worker_send(instance->worker, message, size, timeout_of(instance));
    free(message);
    return state == CHANNEL_OK ? STATUS_OK : lost(instance, state, timeout_of(instance));
}

/* Output texts: a length and bytes each. */
static bool take_texts(Instance *instance, const Bytes *bytes) {
    const Table *table = &instance->table;
    size_t place = 0;
    for (size_t i = table->n_set_texts; i < table_texts(table); i++) {
        uint32_t length;
        char *text;
        if (bytes->size - place < sizeof length) return false;
        memcpy(&length, bytes->data + place, sizeof length);
        place += sizeof length;
        if (bytes->size - place < length) return false;
        text = malloc((size_t)length + 1);
        if (text == NULL) return false;
        memcpy(text, bytes->data + place, length);
        text[length] = '\0';
        free(instance->texts[i]);
        instance->texts[i] = text;
        place += length;
    }
    return place == bytes->size;
}

static Status take_outputs(Instance *instance, const Head *head, double *time, Bytes *bytes) {
    const Table *table = &instance->table;
    double timeout = timeout_of(instance);
    if (head->numbers != 1 + table->n_output_numbers) return nonsense(instance);
    if (receive(instance, time, sizeof *time, timeout) != STATUS_OK ||
        receive(instance, instance->numbers + table->n_set_numbers, table->n_output_numbers * sizeof(double),
                timeout) != STATUS_OK ||
        receive_bytes(instance, head->bytes, timeout, bytes) != STATUS_OK)
        return STATUS_FATAL;
    if (!isfinite(*time)) return nonsense(instance);
    return take_texts(instance, bytes) ? STATUS_OK : nonsense(instance);
}

/* Whether this is an answer to that. */
static bool answers(uint32_t reply, Request kind) {
    if (reply == REPLY_REFUSED) return true;
    if (kind == REQUEST_GET_STATE) return reply == REPLY_STATE;
    return reply == REPLY_DONE || (kind == REQUEST_STEP && (reply == REPLY_STOPPED || reply == REPLY_FAILED));
}

static Status receive_reply(Instance *instance, Request kind, Reply *reply, double *time, Bytes *bytes) {
    double timeout = timeout_of(instance);
    Head head;
    do {
        if (receive(instance, &head, sizeof head, timeout) != STATUS_OK) return STATUS_FATAL;
    } while (head.kind == REPLY_ALIVE && head.numbers == 0 && head.bytes == 0);
    if (head.bytes > MOST_BYTES || !answers(head.kind, kind)) return nonsense(instance);
    *reply = (Reply)head.kind;
    if (head.kind != REPLY_REFUSED && head.kind != REPLY_STATE) return take_outputs(instance, &head, time, bytes);
    if (head.numbers != 0) return nonsense(instance);
    return receive_bytes(instance, head.bytes, timeout, bytes);
}

Status request(Instance *instance, Request kind, double extra, bool texts, const Bytes *bytes, Reply *reply,
               double *time, Bytes *answer) {
    Bytes received = {NULL, 0};
    Status status;
    if (instance->worker == NULL) return tell(instance, STATUS_FATAL, "the worker is gone; make a new instance");
    status = send_request(instance, kind, extra, texts, bytes);
    if (status == STATUS_OK) status = receive_reply(instance, kind, reply, time, &received);
    if (status == STATUS_OK && *reply == REPLY_REFUSED)
        status = tell(instance, STATUS_ERROR, "%s", received.data);
    if (status == STATUS_OK && answer != NULL) *answer = received;
    else free(received.data);
    return status;
}
