/* An instance of the FMU, the same for FMI 2.0 and 3.0. */
#ifndef GW_INSTANCE_H
#define GW_INSTANCE_H

#include "platform.h"
#include "table.h"

/* The numbers are those of fmi2Status and fmi3Status. */
typedef enum { STATUS_OK, STATUS_WARNING, STATUS_DISCARD, STATUS_ERROR, STATUS_FATAL } Status;

typedef enum {
    PHASE_INSTANTIATED = 1,
    PHASE_INITIALIZATION = 2,
    PHASE_STEPPING = 4,   /* a step can be taken */
    PHASE_STOPPED = 8,    /* the run has come to its end before the host's */
    PHASE_TERMINATED = 16,
    PHASE_ERROR = 32,
    PHASE_FATAL = 64,
    PHASE_ANY = 63
} Phase;

/* Of a message, with its end. */
enum { LONGEST_MESSAGE = 4096 };

typedef struct State State;
typedef struct Instance Instance;
typedef void (*Logger)(const Instance *instance, Status status, const char *category, const char *message);

struct Instance {
    Phase phase;
    Table table;
    double *numbers; /* all values but texts; a variable's begin at its slot */
    char **texts;
    Worker *worker;
    State *states;   /* those handed out and not yet freed */
    char *name, *resources;
    bool stale;      /* a value was set after the outputs were computed */
    bool begun;      /* the worker has a model */
    bool stop_defined, early_return_allowed;
    double start, stop, time;
    Logger logger;
    void *callback, *environment; /* the host's */
    unsigned categories; /* of the messages that the host gets: bit 1 << status */
};

/* NULL if the FMU can't be used; the reason goes to the logger. */
Instance *instance_new(const char *name, const char *token, const char *resources, Logger logger, void *callback,
                       void *environment, bool logging);
void instance_free(Instance *instance);

/* Logs a message for a status and returns it. */
Status tell(Instance *instance, Status status, const char *format, ...)
#if defined(__GNUC__)
    __attribute__((format(printf, 3, 4)))
#endif
    ;
/* Debug logging on: every message or, with a list, those of its categories alone. Off: none of events, so that faults
   stay visible to a host that never asked for a log. */
void set_logging(Instance *instance, bool on, size_t count, const char *const *categories);

/* The nearest whole number that fits into 32 bits; 0 for what is no number. */
int32_t whole_value(double value);

/* Whether the host gave `count` references and values; tells if not. */
bool given(Instance *instance, const char *function, size_t count, const void *references, const void *values);

/* Whether `function` may be called in this phase; tells if not. */
bool may(Instance *instance, const char *function, unsigned phases);

Status begin_initialization(Instance *instance, double start, bool stop_defined, double stop);
Status end_initialization(Instance *instance);
Status reset(Instance *instance);

/* What a step came to. stopped : the run has ended; failed : because it can't go on or can't be trusted. */
typedef struct {
    bool stopped, failed;
    double reached;
} Step;
Status take_step(Instance *instance, double point, double step, Step *taken);
/* Why the run has ended: the first text among the outputs, by agreement with the worker. */
const char *ending(const Instance *instance);

/* The variable of a value reference, if it is of this kind; else NULL, told. */
const Variable *find(Instance *instance, const char *function, uint32_t reference, Kind kind);
/* Checks that a variable may be set now; outputs are computed anew before they are read. */
Status before_set(Instance *instance, const char *function, const Variable *variable);
Status before_get(Instance *instance, const char *function, const Variable *variable);
Status set_text(Instance *instance, const Variable *variable, const char *text);
/* Puts a Real at its `place` among the numbers. */
Status set_real(Instance *instance, const Variable *variable, double *place, double value);

/* Saved states. A handle that is none of this instance's is told, never followed. */
Status state_get(Instance *instance, const char *function, void **handle);
Status state_set(Instance *instance, const char *function, void *handle);
Status state_free(Instance *instance, const char *function, void **handle);
Status state_size(Instance *instance, const char *function, void *handle, size_t *size);
Status state_write(Instance *instance, const char *function, void *handle, void *data, size_t size);
Status state_read(Instance *instance, const char *function, const void *data, size_t size, void **handle);
void state_free_all(Instance *instance);

#endif
