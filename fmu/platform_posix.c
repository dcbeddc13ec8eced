/* Linux and macOS: a socket pair to the worker, and a second one, the lifeline, whose end tells it that we are gone. */
#ifndef _WIN32

#define _GNU_SOURCE
#define _DARWIN_C_SOURCE

#include "platform.h"

#include <errno.h>
#include <fcntl.h>
#include <poll.h>
#include <sched.h>
#include <signal.h>
#include <spawn.h>
#include <stdlib.h>
#include <string.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/types.h>
#include <sys/wait.h>
#include <time.h>
#include <unistd.h>

#ifdef __GLIBC__
#include <gnu/libc-version.h>
#endif

#ifndef MSG_NOSIGNAL
#define MSG_NOSIGNAL 0 /* macOS: SO_NOSIGPIPE does it */
#endif
#ifndef SOCK_CLOEXEC
#define SOCK_CLOEXEC 0
#endif

extern char **environ;

/* Descriptors in the worker; gw_exudyn/fmi/channel.py knows them too. */
enum { WORKER_CHANNEL = 3, WORKER_LIFELINE = 4 };

/* A reply to a quick request is awaited without sleep, since a waking costs more than the request; not where the last
 * one took longer than QUICK, which a quick one does not even with a waking. Seconds. */
static const double SPIN = 100e-6, QUICK = 400e-6;

struct Worker {
    pid_t pid;
    int channel, lifeline, words;
    bool slow; /* so was the last reply that had to be awaited */
};

FILE *platform_open(const char *path) { return fopen(path, "rb"); }

static double now(void) {
    struct timespec time;
    clock_gettime(CLOCK_MONOTONIC, &time);
    return (double)time.tv_sec + 1e-9 * (double)time.tv_nsec;
}

static void close_all(int *descriptors, size_t count) {
    for (size_t i = 0; i < count; i++)
        if (descriptors[i] >= 0) close(descriptors[i]);
}

/* A pair of sockets, [0] ours and [1] the worker's, both above those that the worker gets its own under. */
static bool make_pair(int pair[2]) {
    int raw[2];
    if (socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, raw) != 0) return false;
    for (int i = 0; i < 2; i++) {
        pair[i] = fcntl(raw[i], F_DUPFD_CLOEXEC, 10);
        close(raw[i]);
    }
#ifdef SO_NOSIGPIPE
    {
        int on = 1;
        setsockopt(pair[0], SOL_SOCKET, SO_NOSIGPIPE, &on, sizeof on);
    }
#endif
    return pair[0] >= 0 && pair[1] >= 0;
}

static bool hidden(const char *variable) {
    return strncmp(variable, "PYTHON", 6) == 0 || strncmp(variable, "LD_", 3) == 0 ||
           strncmp(variable, "DYLD_", 5) == 0;
}

static bool same_name(const char *variable, const char *other) {
    size_t length = strcspn(other, "=");
    return strncmp(variable, other, length) == 0 && variable[length] == '=';
}

/* The host's environment without what would upset the worker, and with the table's; an own program finds its libraries
 * in the table's path. Free the array and its first. */
static char **worker_environment(const Table *table, bool recorded, const char *resources) {
    size_t count = 0, kept = 0, room = strlen(resources) + strlen(table->path) + sizeof "LD_LIBRARY_PATH=/";
    char **list, *path = malloc(room);
    while (environ != NULL && environ[count] != NULL) count++;
    list = calloc(count + table->n_environment + 2, sizeof *list);
    if (list == NULL || path == NULL) {
        free(list);
        free(path);
        return NULL;
    }
    if (*table->program != '\0') snprintf(path, room, "LD_LIBRARY_PATH=%s/%s", resources, table->path);
    else snprintf(path, room, "PYTHONPATH=%s", recorded ? table->path : "");
    list[kept++] = path;
    for (size_t i = 0; i < count; i++) {
        bool replaced = hidden(environ[i]);
        for (size_t j = 0; j < table->n_environment; j++)
            replaced = replaced || same_name(environ[i], table->environment[j]);
        if (!replaced) list[kept++] = environ[i];
    }
    for (size_t j = 0; j < table->n_environment; j++) list[kept++] = (char *)(size_t)table->environment[j];
    return list;
}

static int spawn(Worker *worker, const char *program, char *const *arguments, char *const *environment,
                 const int theirs[3]) {
    posix_spawn_file_actions_t actions;
    posix_spawnattr_t attributes;
    sigset_t none, all;
    int error;
    sigemptyset(&none);
    sigfillset(&all);
    if (posix_spawn_file_actions_init(&actions) != 0) return ENOMEM;
    if (posix_spawnattr_init(&attributes) != 0) {
        posix_spawn_file_actions_destroy(&actions);
        return ENOMEM;
    }
    /* Its own group, so that Ctrl-C in a terminal is the host's to handle; no signal blocked or ignored. */
    posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETPGROUP | POSIX_SPAWN_SETSIGMASK | POSIX_SPAWN_SETSIGDEF);
    posix_spawnattr_setpgroup(&attributes, 0);
    posix_spawnattr_setsigmask(&attributes, &none);
    posix_spawnattr_setsigdefault(&attributes, &all);
    error = posix_spawn_file_actions_addopen(&actions, 0, "/dev/null", O_RDONLY, 0);
    if (error == 0) error = posix_spawn_file_actions_addopen(&actions, 1, "/dev/null", O_WRONLY, 0);
    if (error == 0) error = posix_spawn_file_actions_adddup2(&actions, theirs[2], 2);
    if (error == 0) error = posix_spawn_file_actions_adddup2(&actions, theirs[0], WORKER_CHANNEL);
    if (error == 0) error = posix_spawn_file_actions_adddup2(&actions, theirs[1], WORKER_LIFELINE);
    if (error == 0) error = posix_spawnp(&worker->pid, program, &actions, &attributes, arguments, environment);
    posix_spawnattr_destroy(&attributes);
    posix_spawn_file_actions_destroy(&actions);
    return error;
}

/* The interpreter: the variable's, else the recorded one if it is there, else the first on the PATH. */
static const char *choose(const Table *table, bool *recorded) {
    const char *named = getenv(PYTHON_VARIABLE);
    *recorded = false;
    if (named != NULL && *named != '\0') return named;
    if (*table->python != '\0' && access(table->python, F_OK) == 0) {
        *recorded = true;
        return table->python;
    }
    return "python3";
}

/* What a version says of its first two numbers, as one to compare. */
static long version_number(const char *text) {
    char *rest;
    long major = strtol(text, &rest, 10);
    return major * 1000 + (*rest == '.' ? strtol(rest + 1, NULL, 10) : 0);
}

/* Whether the system's C library is as new as the program needs; says so if not. */
static bool new_enough(const Table *table, char *message, size_t size) {
#ifdef __GLIBC__
    const char *here = gnu_get_libc_version();
    if (*table->glibc == '\0' || version_number(here) >= version_number(table->glibc)) return true;
    snprintf(message, size, "this FMU's worker needs glibc %s or newer, and this system has %s; %s", table->glibc, here,
             table->remedy);
    return false;
#else
    (void)message;
    (void)size;
    return *table->glibc == '\0' || version_number(table->glibc) >= 0;
#endif
}

/* The path of the table's own program, made to be run; to be freed. */
static char *own_program(const Table *table, const char *resources) {
    size_t room = strlen(resources) + strlen(table->program) + 2;
    char *path = malloc(room);
    if (path == NULL) return NULL;
    snprintf(path, room, "%s/%s", resources, table->program);
    if (access(path, X_OK) != 0) {
        struct stat found;
        if (stat(path, &found) == 0) chmod(path, found.st_mode | S_IXUSR);
    }
    return path;
}

static Worker *failed(Worker *worker, const Table *table, const char *program, int error, char *message, size_t size) {
    const char *why = strerror(error);
    if (*table->program == '\0')
        snprintf(message, size, "the Python interpreter '%.1000s' can't be started (%s); %s", program, why,
                 table->remedy);
    else if (error == EACCES)
        snprintf(message, size, "the worker '%.1000s' may not be run there (%s): the folder forbids it (mount option "
                 "noexec) or belongs to another user; have the host unpack the FMU elsewhere, as by the environment "
                 "variable TMPDIR", program, why);
    else
        snprintf(message, size, "the worker '%.1000s' can't be started (%s); %s", program, why, table->remedy);
    free(worker);
    return NULL;
}

static Worker *start_program(const Table *table, const char *program, bool recorded, const char *resources,
                             char *message, size_t size) {
    int channel[2] = {-1, -1}, lifeline[2] = {-1, -1}, words[2] = {-1, -1}, theirs[3], error = 0;
    const char *arguments[20] = {program};
    char **environment = worker_environment(table, recorded, resources);
    Worker *worker = calloc(1, sizeof *worker);
    for (size_t i = 0; i < table->n_arguments; i++) arguments[i + 1] = table->arguments[i];
    arguments[table->n_arguments + 1] = resources;
    if (worker == NULL || environment == NULL) error = ENOMEM;
    else if (!make_pair(channel) || !make_pair(lifeline) || !make_pair(words)) error = errno;
    if (error == 0) {
        theirs[0] = channel[1];
        theirs[1] = lifeline[1];
        theirs[2] = words[1];
        error = spawn(worker, program, (char *const *)(size_t)arguments, environment, theirs);
    }
    if (environment != NULL) free(environment[0]);
    free(environment);
    if (channel[1] >= 0) close(channel[1]);
    if (lifeline[1] >= 0) close(lifeline[1]);
    if (words[1] >= 0) close(words[1]);
    if (error != 0) {
        int ours[3] = {channel[0], lifeline[0], words[0]};
        close_all(ours, 3);
        return failed(worker, table, program, error, message, size);
    }
    worker->channel = channel[0];
    worker->lifeline = lifeline[0];
    worker->words = words[0];
    return worker;
}

Worker *worker_start(const Table *table, const char *resources, char *message, size_t size) {
    bool recorded = false;
    Worker *worker;
    char *own;
    if (*table->program == '\0') {
        const char *program = choose(table, &recorded);
        return start_program(table, program, recorded, resources, message, size);
    }
    if (!new_enough(table, message, size)) return NULL;
    own = own_program(table, resources);
    if (own == NULL) {
        snprintf(message, size, "there is not enough memory");
        return NULL;
    }
    worker = start_program(table, own, false, resources, message, size);
    free(own);
    return worker;
}

/* Waits until the channel can be read or written, or `deadline` has passed (not positive: never). */
static Channel await(int descriptor, short event, double deadline) {
    struct pollfd watched = {descriptor, event, 0};
    double left = deadline > 0 ? deadline - now() : 3600;
    if (left <= 0) return CHANNEL_SILENT;
    /* Rounded up, so that the last fraction of a millisecond is no busy loop. */
    if (poll(&watched, 1, (int)((left > 3600 ? 3600 : left) * 1e3) + 1) < 0 && errno != EINTR) return CHANNEL_CLOSED;
    return CHANNEL_OK;
}

Channel worker_send(Worker *worker, const void *data, size_t size, double timeout) {
    double deadline = timeout > 0 ? now() + timeout : 0;
    const char *rest = data;
    while (size > 0) {
        ssize_t sent = send(worker->channel, rest, size, MSG_NOSIGNAL | MSG_DONTWAIT);
        if (sent > 0) {
            rest += sent;
            size -= (size_t)sent;
        } else if (errno == EAGAIN || errno == EWOULDBLOCK) {
            Channel state = await(worker->channel, POLLOUT, deadline);
            if (state != CHANNEL_OK) return state;
        } else if (errno != EINTR) {
            return CHANNEL_CLOSED;
        }
    }
    return CHANNEL_OK;
}

Channel worker_receive(Worker *worker, void *data, size_t size, double timeout) {
    double begin = now(), deadline = timeout > 0 ? begin + timeout : 0, spin = worker->slow ? 0 : SPIN;
    char *rest = data;
    bool awaited = false;
    while (size > 0) {
        ssize_t got = recv(worker->channel, rest, size, MSG_DONTWAIT);
        if (got > 0) {
            rest += got;
            size -= (size_t)got;
        } else if (got == 0) {
            return CHANNEL_CLOSED;
        } else if (errno == EAGAIN || errno == EWOULDBLOCK) {
            awaited = true;
            if (now() - begin < spin) {
                sched_yield();
            } else {
                Channel state = await(worker->channel, POLLIN, deadline);
                if (state != CHANNEL_OK) return state;
            }
        } else if (errno != EINTR) {
            return CHANNEL_CLOSED;
        }
    }
    if (awaited) worker->slow = now() - begin > QUICK;
    return CHANNEL_OK;
}

void worker_last_words(Worker *worker, char *text, size_t size) {
    size_t kept = 0;
    char block[4096];
    for (;;) {
        ssize_t got = recv(worker->words, block, sizeof block, MSG_DONTWAIT);
        if (got < 0 && errno == EINTR) continue;
        if (got <= 0) break;
        for (ssize_t i = 0; i < got; i++) {
            if (kept + 1 >= size) {
                memmove(text, text + size / 2, kept - size / 2);
                kept -= size / 2;
            }
            text[kept++] = block[i] == '\0' ? ' ' : block[i];
        }
    }
    text[kept] = '\0';
}

void worker_stop(Worker *worker) {
    int descriptors[3] = {worker->channel, worker->lifeline, worker->words};
    close_all(descriptors, 3);
    /* Only what nobody has waited for is ours to end; the number of another may be somebody else's by now. */
    if (waitpid(worker->pid, NULL, WNOHANG) == 0) {
        kill(worker->pid, SIGKILL);
        while (waitpid(worker->pid, NULL, 0) < 0 && errno == EINTR) {
        }
    }
    free(worker);
}

#else

typedef int not_for_windows; /* a C file must not be empty */

#endif
