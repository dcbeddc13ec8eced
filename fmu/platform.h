/* What differs from system to system: files, and the worker process with its private channel. */
#ifndef GW_PLATFORM_H
#define GW_PLATFORM_H

#include "table.h"

#include <stdio.h>

typedef struct Worker Worker;
typedef enum { CHANNEL_OK, CHANNEL_CLOSED, CHANNEL_SILENT } Channel;

FILE *platform_open(const char *path);

/* Starts `PYTHON arguments... resources`, or the table's own program with `arguments... resources`, which the host may
 * have unpacked without its permission to run; NULL, with a sentence, if it can't. The worker ends when this process ends,
 * however busy either is, and gets none of the host's variables PYTHON*, LD_* and DYLD_*. */
Worker *worker_start(const Table *table, const char *resources, char *message, size_t size);

/* Both wait for at most `timeout` seconds without progress; not positive: for ever. */
Channel worker_send(Worker *worker, const void *data, size_t size, double timeout);
Channel worker_receive(Worker *worker, void *data, size_t size, double timeout);

/* What the worker, which has ended, wrote to stderr, the last of it. */
void worker_last_words(Worker *worker, char *text, size_t size);

/* Ends the worker, whatever it does, and frees it. */
void worker_stop(Worker *worker);

#define PYTHON_VARIABLE "GW_EXUDYN_PYTHON"

#endif
