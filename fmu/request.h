/* The language of wrapper and worker: a head, numbers as doubles, bytes. gw_exudyn/fmi/channel.py speaks it too. */
#ifndef GW_REQUEST_H
#define GW_REQUEST_H

#include "instance.h"

typedef enum { REQUEST_START = 1, REQUEST_STEP = 2, REQUEST_GET_STATE = 3, REQUEST_SET_STATE = 4 } Request;
typedef enum { REPLY_HELLO = 100, REPLY_DONE = 101, REPLY_STOPPED = 102, REPLY_FAILED = 103, REPLY_REFUSED = 104,
               REPLY_ALIVE = 105, REPLY_STATE = 106 } Reply;

/* The bytes of a reply; freed by the caller. */
typedef struct {
    char *data;
    size_t size;
} Bytes;

/* Waits for the worker's first word. */
Status request_hello(Instance *instance);

/* Sends `extra` numbers, then all values that can be set, then, with `texts`, the texts that can be set, or `bytes`.
 * A reply with outputs puts them into the instance, and its time, s, into *time. */
Status request(Instance *instance, Request kind, double extra, bool texts, const Bytes *bytes, Reply *reply,
               double *time, Bytes *answer);

#endif
