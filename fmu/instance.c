#include "instance.h"

#include "request.h"

#include <math.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>

/* Times closer than this, s, are one. */
static const double SAME_TIME = 1e-9;

/* By status, STATUS_OK first. */
static const char *const CATEGORIES[] = {"logEvents", "logStatusWarning", "logStatusDiscard", "logStatusError",
                                         "logStatusFatal"};
enum { ALL_CATEGORIES = (1 << (STATUS_FATAL + 1)) - 1 };

/* The length of the UTF-8 character that begins here; 0 if none does. */
static size_t character(const unsigned char *text) {
    static const struct { unsigned char mask, lead; uint32_t least; } FORMS[] = {
        {0x80, 0x00, 0}, {0xe0, 0xc0, 0x80}, {0xf0, 0xe0, 0x800}, {0xf8, 0xf0, 0x10000}};
    for (size_t length = 1; length <= 4; length++) {
        uint32_t code = text[0] & (unsigned char)~FORMS[length - 1].mask;
        if ((text[0] & FORMS[length - 1].mask) != FORMS[length - 1].lead) continue;
        for (size_t i = 1; i < length; i++) {
            if ((text[i] & 0xc0) != 0x80) return 0;
            code = code << 6 | (text[i] & 0x3f);
        }
        return code >= FORMS[length - 1].least && code <= 0x10ffff && (code & 0xfffff800) != 0xd800 ? length : 0;
    }
    return 0;
}

/* Hosts take a message for UTF-8: what is not, as a character that was cut off, becomes a question mark. */
static void make_utf8(char *text) {
    while (*text != '\0') {
        size_t length = character((const unsigned char *)text);
        if (length == 0) *text = '?';
        text += length == 0 ? 1 : length;
    }
}

Status tell(Instance *instance, Status status, const char *format, ...) {
    char message[LONGEST_MESSAGE];
    va_list values;
    if (instance->logger == NULL || !(instance->categories & 1u << status)) return status;
    va_start(values, format);
    vsnprintf(message, sizeof message, format, values);
    va_end(values);
    make_utf8(message);
    instance->logger(instance, status, CATEGORIES[status], message);
    return status;
}

void set_logging(Instance *instance, bool on, size_t count, const char *const *categories) {
    instance->categories = on ? ALL_CATEGORIES : ALL_CATEGORIES & ~(1u << STATUS_OK);
    if (!on || count == 0 || categories == NULL) return;
    instance->categories = 0;
    for (size_t i = 0; i < count; i++) {
        if (categories[i] == NULL) continue;
        if (strcmp(categories[i], "logAll") == 0) instance->categories = ALL_CATEGORIES;
        for (unsigned status = STATUS_OK; status <= STATUS_FATAL; status++)
            if (strcmp(categories[i], CATEGORIES[status]) == 0) instance->categories |= 1u << status;
    }
}

static char *copy(const char *text) {
    char *made = malloc(strlen(text) + 1);
    if (made != NULL) strcpy(made, text);
    return made;
}

static int hex(char digit) {
    if (digit >= '0' && digit <= '9') return digit - '0';
    if (digit >= 'a' && digit <= 'f') return digit - 'a' + 10;
    if (digit >= 'A' && digit <= 'F') return digit - 'A' + 10;
    return -1;
}

/* The folder that a path, or a URI `file:/...`, `file:///...`, `file://localhost/...`, names. */
static char *folder_of(const char *location) {
    bool uri = strncmp(location, "file:", 5) == 0;
    const char *rest = location;
    char *path, *place;
    if (uri) {
        rest += 5;
        if (strncmp(rest, "//", 2) == 0) {
            const char *slash = strchr(rest + 2, '/');
            rest = slash == NULL ? "" : slash;
        }
#ifdef _WIN32
        if (rest[0] == '/' && rest[1] != '\0' && rest[2] == ':') rest++;
#endif
    }
    path = place = malloc(strlen(rest) + 1);
    if (path == NULL) return NULL;
    for (; *rest != '\0'; rest++) {
        if (uri && *rest == '%' && hex(rest[1]) >= 0 && hex(rest[2]) >= 0) {
            *place++ = (char)(hex(rest[1]) * 16 + hex(rest[2]));
            rest += 2;
        } else {
            *place++ = *rest;
        }
    }
    while (place > path + 1 && (place[-1] == '/' || place[-1] == '\\')) place--;
    *place = '\0';
    return path;
}

/* Every value back to its start. */
static bool restart_values(Instance *instance) {
    const Table *table = &instance->table;
    memset(instance->numbers, 0, table_numbers(table) * sizeof(double));
    for (size_t i = 0; i < table->n_variables; i++) {
        const Variable *variable = &table->variables[i];
        if (variable->kind == KIND_TEXT) {
            if (set_text(instance, variable, variable->text) != STATUS_OK) return false;
        } else {
            for (size_t k = 0; k < variable->size; k++) instance->numbers[variable->slot + k] = variable->start;
        }
    }
    instance->stale = true;
    return true;
}

static bool prepare(Instance *instance, const char *token) {
    const Table *table = &instance->table;
    char message[2500];
    if (!table_read(&instance->table, instance->resources, message, sizeof message)) {
        tell(instance, STATUS_ERROR, "%s", message);
        return false;
    }
    if (token == NULL || strcmp(token, table->token) != 0) {
        tell(instance, STATUS_ERROR, "the host's token '%.100s' is not this FMU's; the host mixes two FMUs up",
             token == NULL ? "" : token);
        return false;
    }
    instance->numbers = calloc(table_numbers(table), sizeof(double));
    instance->texts = calloc(table_texts(table) + 1, sizeof(char *));
    if (instance->numbers == NULL || instance->texts == NULL || !restart_values(instance)) {
        tell(instance, STATUS_ERROR, "there is not enough memory");
        return false;
    }
    instance->worker = worker_start(table, instance->resources, message, sizeof message);
    if (instance->worker == NULL) {
        tell(instance, STATUS_ERROR, "%s", message);
        return false;
    }
    return request_hello(instance) == STATUS_OK;
}

Instance *instance_new(const char *name, const char *token, const char *resources, Logger logger, void *callback,
                       void *environment, bool logging) {
    Instance *instance = calloc(1, sizeof *instance);
    if (instance == NULL) return NULL;
    instance->logger = logger;
    instance->callback = callback;
    instance->environment = environment;
    set_logging(instance, logging, 0, NULL);
    instance->phase = PHASE_INSTANTIATED;
    instance->name = copy(name == NULL ? "" : name);
    instance->resources = resources == NULL ? NULL : folder_of(resources);
    if (instance->name == NULL || instance->resources == NULL) {
        tell(instance, STATUS_ERROR, "the host gave no folder of resources; it must unpack the FMU and name it");
        instance_free(instance);
        return NULL;
    }
    if (!prepare(instance, token)) {
        instance_free(instance);
        return NULL;
    }
    tell(instance, STATUS_OK, "the worker has started");
    return instance;
}

void instance_free(Instance *instance) {
    if (instance->worker != NULL) worker_stop(instance->worker);
    state_free_all(instance);
    if (instance->texts != NULL)
        for (size_t i = 0; i < table_texts(&instance->table); i++) free(instance->texts[i]);
    free(instance->texts);
    free(instance->numbers);
    table_free(&instance->table);
    free(instance->name);
    free(instance->resources);
    free(instance);
}

int32_t whole_value(double value) {
    if (isnan(value)) return 0;
    if (value >= INT32_MAX) return INT32_MAX;
    return value <= INT32_MIN ? INT32_MIN : (int32_t)value;
}

bool given(Instance *instance, const char *function, size_t count, const void *references, const void *values) {
    if (count == 0 || (references != NULL && values != NULL)) return true;
    tell(instance, STATUS_ERROR, "%s: the host gave no references or no values", function);
    return false;
}

bool may(Instance *instance, const char *function, unsigned phases) {
    static const char *const NAMES[] = {"Instantiated", "Initialization Mode", "Step Mode", "Step Mode (run ended)",
                                        "Terminated", "Error", "Fatal"};
    char allowed[200] = "";
    const char *present = "";
    if ((unsigned)instance->phase & phases) return true;
    for (unsigned i = 0; i < 7; i++) {
        if (instance->phase == (Phase)(1u << i)) present = NAMES[i];
        if (phases & 1u << i) {
            if (*allowed != '\0') strcat(allowed, ", ");
            strcat(allowed, NAMES[i]);
        }
    }
    tell(instance, STATUS_ERROR, "%s is not allowed in the state %s; allowed in: %s", function, present, allowed);
    if (instance->phase != PHASE_FATAL) instance->phase = PHASE_ERROR;
    return false;
}

static void set_time(Instance *instance, double time) {
    instance->time = time;
    instance->numbers[table_numbers(&instance->table) - 1] = time;
}

/* An error leaves nothing but reset, states and the end. */
static Status noted(Instance *instance, Status status) {
    if (status == STATUS_ERROR && instance->phase != PHASE_FATAL) instance->phase = PHASE_ERROR;
    return status;
}

/* Gives the worker the parameters, and gets the outputs at the start. */
static Status compute_start(Instance *instance) {
    Reply reply = REPLY_DONE;
    double time = 0;
    Status status;
    if (!instance->stale) return STATUS_OK;
    status = request(instance, REQUEST_START, 0, true, NULL, &reply, &time, NULL);
    if (status != STATUS_OK) return noted(instance, status);
    instance->stale = false;
    instance->begun = true;
    return STATUS_OK;
}

Status begin_initialization(Instance *instance, double start, bool stop_defined, double stop) {
    if (!isfinite(start) || (stop_defined && !(stop >= start)))
        return noted(instance, tell(instance, STATUS_ERROR, "the start time %.17g s or the stop time %.17g s is no time "
                                    "to begin or to end at", start, stop));
    instance->start = start;
    instance->stop = stop;
    instance->stop_defined = stop_defined;
    set_time(instance, start);
    instance->stale = true;
    instance->phase = PHASE_INITIALIZATION;
    return STATUS_OK;
}

Status end_initialization(Instance *instance) {
    Status status = compute_start(instance);
    if (status == STATUS_OK) instance->phase = PHASE_STEPPING;
    return status;
}

Status reset(Instance *instance) {
    if (instance->worker == NULL) {
        instance->phase = PHASE_FATAL;
        return tell(instance, STATUS_FATAL, "the worker is gone; make a new instance");
    }
    if (!restart_values(instance)) return noted(instance, tell(instance, STATUS_ERROR, "there is not enough memory"));
    set_time(instance, 0);
    instance->start = instance->stop = 0;
    instance->stop_defined = false;
    instance->phase = PHASE_INSTANTIATED;
    return STATUS_OK;
}

static Status check_step(Instance *instance, double point, double step) {
    double here = SAME_TIME * (1 + fabs(instance->time));
    if (!isfinite(point) || !isfinite(step) || !(step > 0))
        return tell(instance, STATUS_ERROR, "a communication step of %.17g s at %.17g s can't be taken; it must be "
                    "positive", step, point);
    if (fabs(point - instance->time) > here)
        return tell(instance, STATUS_ERROR, "the host steps from %.17g s, the FMU is at %.17g s; go on from there, or "
                    "restore a state", point, instance->time);
    if (instance->stop_defined && point + step > instance->stop + SAME_TIME * (1 + fabs(instance->stop)))
        return tell(instance, STATUS_ERROR, "a step to %.17g s goes beyond the stop time of %.17g s that the host set",
                    point + step, instance->stop);
    return STATUS_OK;
}

Status take_step(Instance *instance, double point, double step, Step *taken) {
    Reply reply = REPLY_DONE;
    double reached = instance->time - instance->start, target = point + step;
    Status status = check_step(instance, point, step);
    taken->stopped = taken->failed = false;
    taken->reached = instance->time;
    if (status != STATUS_OK) return noted(instance, status);
    status = request(instance, REQUEST_STEP, target - instance->start, false, NULL, &reply, &reached, NULL);
    if (status != STATUS_OK) return noted(instance, status);
    instance->stale = false;
    set_time(instance, reply == REPLY_DONE ? target : instance->start + reached);
    taken->reached = instance->time;
    taken->stopped = reply != REPLY_DONE;
    taken->failed = reply == REPLY_FAILED;
    if (taken->stopped) instance->phase = PHASE_STOPPED;
    return STATUS_OK;
}

const char *ending(const Instance *instance) {
    return instance->table.n_output_texts > 0 ? instance->texts[instance->table.n_set_texts] : "";
}

const Variable *find(Instance *instance, const char *function, uint32_t reference, Kind kind) {
    const Table *table = &instance->table;
    if (reference >= table->n_variables) {
        tell(instance, STATUS_ERROR, "%s: there is no variable with the value reference %lu; there are %zu", function,
             (unsigned long)reference, table->n_variables);
        return NULL;
    }
    if (table->variables[reference].kind != kind) {
        tell(instance, STATUS_ERROR, "%s: %s is of another type", function, table->variables[reference].name);
        return NULL;
    }
    return &table->variables[reference];
}

Status before_set(Instance *instance, const char *function, const Variable *variable) {
    unsigned phase = (unsigned)instance->phase;
    if (!table_settable(variable))
        return noted(instance, tell(instance, STATUS_ERROR, "%s: %s is computed and can't be set", function,
                                    variable->name));
    if (variable->role == ROLE_FIXED && !(phase & (PHASE_INSTANTIATED | PHASE_INITIALIZATION)))
        return noted(instance, tell(instance, STATUS_ERROR,
                                    "%s: %s is a fixed parameter; set it before the initialization ends, or reset",
                                    function, variable->name));
    instance->stale = true;
    return STATUS_OK;
}

Status before_get(Instance *instance, const char *function, const Variable *variable) {
    (void)function;
    if (variable->role == ROLE_OUTPUT && instance->phase == PHASE_INITIALIZATION) return compute_start(instance);
    return STATUS_OK;
}

Status set_text(Instance *instance, const Variable *variable, const char *text) {
    char *made;
    if (text == NULL) return tell(instance, STATUS_ERROR, "%s: the host gave no text", variable->name);
    made = copy(text);
    if (made == NULL) return tell(instance, STATUS_ERROR, "there is not enough memory");
    free(instance->texts[variable->slot]);
    instance->texts[variable->slot] = made;
    return STATUS_OK;
}

Status set_real(Instance *instance, const Variable *variable, double *place, double value) {
    const Table *table = &instance->table;
    if (table->timeout < table->n_variables && variable == &table->variables[table->timeout] && !(value >= 0))
        return noted(instance, tell(instance, STATUS_ERROR, "%s: %.17g s is no time to wait; allowed: 0, which waits for "
                                    "ever, and more", variable->name, value));
    *place = value;
    return STATUS_OK;
}
