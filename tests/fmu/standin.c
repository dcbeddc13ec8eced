/* A stand-in for the worker: it speaks the channel's language, and its model is nothing. It starts in a millisecond, so
 * that tests can start thousands. `standin VERSION RESOURCES`; the variables are those of standin.py. The number of the
 * input `behaviour` says how it answers a step. */
#include <poll.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>
#include <unistd.h>

enum { CHANNEL = 3, LIFELINE = 4, SETTABLE = 6, OUTPUTS = 5 };
enum { START = 1, STEP = 2, GET_STATE = 3, SET_STATE = 4 };
enum { HELLO = 100, DONE = 101, STOPPED = 102, FAILED = 103, REFUSED = 104, ALIVE = 105, STATE = 106 };
enum { WELL, STOP, FAIL, REFUSE, END, HANG, TALK, WRONG_KIND, WRONG_COUNT, NO_TIME, LONG_WORDS };

static void must(int condition) {
    if (!condition) _exit(0); /* the host is gone */
}

static void take(void *data, size_t size) {
    for (char *place = data; size > 0;) {
        struct pollfd watched[2] = {{CHANNEL, POLLIN, 0}, {LIFELINE, POLLIN, 0}};
        ssize_t got;
        poll(watched, 2, -1);
        must((watched[1].revents & (POLLIN | POLLHUP)) == 0);
        got = read(CHANNEL, place, size);
        must(got > 0);
        place += got, size -= (size_t)got;
    }
}

static void give(const void *data, size_t size) {
    for (const char *place = data; size > 0;) {
        ssize_t put = write(CHANNEL, place, size);
        must(put > 0);
        place += put, size -= (size_t)put;
    }
}

static void say(uint32_t kind, const double *numbers, uint32_t count, const void *bytes, uint32_t size) {
    uint32_t head[4] = {kind, count, size, 0};
    give(head, sizeof head);
    give(numbers, count * sizeof *numbers);
    give(bytes, size);
}

static void outputs(uint32_t kind, double time, const double *set, uint32_t count) {
    /* The text of the input as the only output text, after its length. */
    const char text[] = "\x05\0\0\0ended";
    double numbers[1 + OUTPUTS] = {time, 2 * time, set[1] + 1, time, time, time};
    say(kind, numbers, count, text, sizeof text - 1);
}

int main(int count, char **arguments) {
    double time = 0;
    const char *version = count > 1 ? arguments[1] : "";
    say(HELLO, NULL, 0, version, (uint32_t)strlen(version));
    for (;;) {
        uint32_t head[4];
        double numbers[1 + SETTABLE], old = time;
        char *bytes;
        take(head, sizeof head);
        must(head[1] == 1 + SETTABLE);
        take(numbers, sizeof numbers);
        bytes = malloc(head[2] + 1);
        must(bytes != NULL);
        take(bytes, head[2]);
        switch (head[0]) {
        case START: time = 0; break;
        case STEP: time = numbers[0]; break;
        case SET_STATE: memcpy(&time, bytes, sizeof time);
        }
        free(bytes);
        if (head[0] == GET_STATE) {
            say(STATE, NULL, 0, &time, sizeof time);
            continue;
        }
        switch (head[0] == STEP ? (int)numbers[1] : WELL) {
        case STOP: time = (time + old) / 2; outputs(STOPPED, time, numbers, 1 + OUTPUTS); break;
        case FAIL: time = (time + old) / 2; outputs(FAILED, time, numbers, 1 + OUTPUTS); break;
        case REFUSE: time = old; say(REFUSED, NULL, 0, "no\xff\xc3", 4); break;
        case END: must(write(2, "last words \xc3(", 13) == 13); _exit(3);
        case HANG: must(poll(&(struct pollfd){LIFELINE, POLLIN, 0}, 1, -1) < 0); break;
        case TALK:
            for (int i = 0; i < 10; i++) {
                struct timespec rest = {0, 20000000};
                nanosleep(&rest, NULL);
                say(ALIVE, NULL, 0, NULL, 0);
            }
            outputs(DONE, time, numbers, 1 + OUTPUTS);
            break;
        case WRONG_KIND: say(STATE, NULL, 0, &time, sizeof time); break;
        case WRONG_COUNT: outputs(DONE, time, numbers, OUTPUTS); break;
        case NO_TIME: outputs(DONE, 0.0 / 0.0 * time, numbers, 1 + OUTPUTS); break;
        case LONG_WORDS:
            bytes = calloc(12001, 1);
            for (int i = 0; bytes != NULL && i < 2000; i++) memcpy(bytes + 6 * i, "word, ", 6);
            must(write(2, bytes, 12000) == 12000);
            _exit(3);
        default: outputs(DONE, time, numbers, 1 + OUTPUTS);
        }
    }
}
