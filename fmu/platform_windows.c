/* Windows: three pipes to the worker (its standard streams), and a job that ends it when this process ends. */
#ifdef _WIN32

#define WIN32_LEAN_AND_MEAN
#ifndef _WIN32_WINNT
#define _WIN32_WINNT 0x0601
#endif

#include "platform.h"

#include <stdlib.h>
#include <string.h>
#include <wchar.h>
#include <windows.h>

/* A reply to a quick request is awaited without sleep: a waking costs more than the request. */
static const double SPIN = 2e-3;

struct Worker {
    HANDLE process, job, to_worker, from_worker, words;
};

static wchar_t *wide(const char *text) {
    int length = MultiByteToWideChar(CP_UTF8, 0, text, -1, NULL, 0);
    wchar_t *made = length > 0 ? malloc((size_t)length * sizeof(wchar_t)) : NULL;
    if (made != NULL) MultiByteToWideChar(CP_UTF8, 0, text, -1, made, length);
    return made;
}

FILE *platform_open(const char *path) {
    wchar_t *name = wide(path);
    FILE *file = name == NULL ? NULL : _wfopen(name, L"rb");
    free(name);
    return file;
}

static double now(void) {
    LARGE_INTEGER count, frequency;
    QueryPerformanceFrequency(&frequency);
    QueryPerformanceCounter(&count);
    return (double)count.QuadPart / (double)frequency.QuadPart;
}

/* Text that grows; `failed` once there was not enough memory. */
typedef struct {
    wchar_t *text;
    size_t length, room;
    bool failed;
} Buffer;

static void put(Buffer *buffer, wchar_t letter) {
    if (buffer->length + 1 >= buffer->room && !buffer->failed) {
        size_t room = buffer->room * 2 + 256;
        wchar_t *larger = realloc(buffer->text, room * sizeof(wchar_t));
        if (larger == NULL) {
            buffer->failed = true;
        } else {
            buffer->text = larger;
            buffer->room = room;
        }
    }
    if (buffer->failed) return;
    buffer->text[buffer->length++] = letter;
    buffer->text[buffer->length] = L'\0';
}

static void put_all(Buffer *buffer, const wchar_t *text) {
    for (; text != NULL && *text != L'\0'; text++) put(buffer, *text);
}

/* An argument in quotes, as the C library of the other side takes it apart. */
static void put_argument(Buffer *buffer, const wchar_t *text) {
    size_t slashes = 0;
    if (buffer->length > 0) put(buffer, L' ');
    put(buffer, L'"');
    for (; text != NULL && *text != L'\0'; text++) {
        if (*text == L'"')
            for (size_t i = 0; i < slashes + 1; i++) put(buffer, L'\\');
        slashes = *text == L'\\' ? slashes + 1 : 0;
        put(buffer, *text);
    }
    for (size_t i = 0; i < slashes; i++) put(buffer, L'\\');
    put(buffer, L'"');
}

static void put_utf8(Buffer *buffer, const char *text, bool argument) {
    wchar_t *made = wide(text);
    if (made == NULL) buffer->failed = true;
    else if (argument) put_argument(buffer, made);
    else put_all(buffer, made);
    free(made);
}

static bool hidden(const Table *table, const wchar_t *variable) {
    bool found = _wcsnicmp(variable, L"PYTHON", 6) == 0;
    for (size_t i = 0; i < table->n_environment && !found; i++) {
        wchar_t *other = wide(table->environment[i]);
        size_t length = other == NULL ? 0 : wcscspn(other, L"=");
        found = length > 0 && _wcsnicmp(variable, other, length) == 0 && variable[length] == L'=';
        free(other);
    }
    return found;
}

static wchar_t *worker_environment(const Table *table, bool recorded) {
    Buffer buffer = {NULL, 0, 0, false};
    wchar_t *host = GetEnvironmentStringsW();
    for (const wchar_t *variable = host; host != NULL && *variable != L'\0'; variable += wcslen(variable) + 1) {
        if (hidden(table, variable)) continue;
        put_all(&buffer, variable);
        put(&buffer, L'\0');
    }
    if (host != NULL) FreeEnvironmentStringsW(host);
    if (recorded && *table->path != '\0') {
        put_all(&buffer, L"PYTHONPATH=");
        put_utf8(&buffer, table->path, false);
        put(&buffer, L'\0');
    }
    for (size_t i = 0; i < table->n_environment; i++) {
        put_utf8(&buffer, table->environment[i], false);
        put(&buffer, L'\0');
    }
    put(&buffer, L'\0');
    if (!buffer.failed) return buffer.text;
    free(buffer.text);
    return NULL;
}

/* The interpreter: the variable's, else the recorded one if it is there, else the first on the PATH. */
static wchar_t *choose(const Table *table, bool *recorded) {
    DWORD length = GetEnvironmentVariableW(L"" PYTHON_VARIABLE, NULL, 0);
    wchar_t *program = length > 1 ? malloc(length * sizeof(wchar_t)) : NULL;
    *recorded = false;
    if (program != NULL && GetEnvironmentVariableW(L"" PYTHON_VARIABLE, program, length) > 0) return program;
    free(program);
    program = wide(table->python);
    if (program != NULL && *program != L'\0' && GetFileAttributesW(program) != INVALID_FILE_ATTRIBUTES) {
        *recorded = true;
        return program;
    }
    free(program);
    return wide("python.exe");
}

/* A pipe of which only the worker's end can be inherited. */
static bool make_pipe(HANDLE *ours, HANDLE *theirs, bool to_worker) {
    HANDLE reading, writing;
    if (!CreatePipe(&reading, &writing, NULL, 1 << 16)) return false;
    *ours = to_worker ? writing : reading;
    *theirs = to_worker ? reading : writing;
    return SetHandleInformation(*theirs, HANDLE_FLAG_INHERIT, HANDLE_FLAG_INHERIT) != 0;
}

static void shut(HANDLE handle) {
    if (handle != NULL) CloseHandle(handle);
}

/* Starts the process with these three streams and nothing else of ours, in the job before it runs. */
static bool spawn(Worker *worker, wchar_t *program, wchar_t *line, wchar_t *environment, HANDLE theirs[3]) {
    STARTUPINFOEXW start;
    PROCESS_INFORMATION made;
    SIZE_T size = 0;
    bool started = false;
    memset(&start, 0, sizeof start);
    InitializeProcThreadAttributeList(NULL, 1, 0, &size);
    start.lpAttributeList = malloc(size);
    if (start.lpAttributeList == NULL) return false;
    start.StartupInfo.cb = sizeof start;
    start.StartupInfo.dwFlags = STARTF_USESTDHANDLES;
    start.StartupInfo.hStdInput = theirs[0];
    start.StartupInfo.hStdOutput = theirs[1];
    start.StartupInfo.hStdError = theirs[2];
    if (InitializeProcThreadAttributeList(start.lpAttributeList, 1, 0, &size)) {
        DWORD flags = CREATE_NO_WINDOW | CREATE_SUSPENDED | CREATE_UNICODE_ENVIRONMENT | EXTENDED_STARTUPINFO_PRESENT;
        bool absolute = wcspbrk(program, L"\\/") != NULL;
        UpdateProcThreadAttribute(start.lpAttributeList, 0, PROC_THREAD_ATTRIBUTE_HANDLE_LIST, theirs,
                                  3 * sizeof theirs[0], NULL, NULL);
        started = CreateProcessW(absolute ? program : NULL, line, NULL, NULL, TRUE, flags, environment, NULL,
                                 &start.StartupInfo, &made) != 0;
        DeleteProcThreadAttributeList(start.lpAttributeList);
    }
    free(start.lpAttributeList);
    if (!started) return false;
    worker->process = made.hProcess;
    if (!AssignProcessToJobObject(worker->job, made.hProcess) || ResumeThread(made.hThread) == (DWORD)-1) {
        TerminateProcess(made.hProcess, 1);
        started = false;
    }
    CloseHandle(made.hThread);
    return started;
}

static bool prepare(Worker *worker, HANDLE theirs[3]) {
    JOBOBJECT_EXTENDED_LIMIT_INFORMATION limits;
    memset(&limits, 0, sizeof limits);
    limits.BasicLimitInformation.LimitFlags = JOB_OBJECT_LIMIT_KILL_ON_JOB_CLOSE;
    worker->job = CreateJobObjectW(NULL, NULL);
    return worker->job != NULL &&
           SetInformationJobObject(worker->job, JobObjectExtendedLimitInformation, &limits, sizeof limits) &&
           make_pipe(&worker->to_worker, &theirs[0], true) && make_pipe(&worker->from_worker, &theirs[1], false) &&
           make_pipe(&worker->words, &theirs[2], false);
}

Worker *worker_start(const Table *table, const char *resources, char *message, size_t size) {
    HANDLE theirs[3] = {NULL, NULL, NULL};
    Buffer line = {NULL, 0, 0, false};
    bool recorded, started = false;
    wchar_t *program = choose(table, &recorded), *environment = worker_environment(table, recorded);
    Worker *worker = calloc(1, sizeof *worker);
    DWORD error;
    put_argument(&line, program);
    for (size_t i = 0; i < table->n_arguments; i++) put_utf8(&line, table->arguments[i], true);
    put_utf8(&line, resources, true);
    if (worker != NULL && program != NULL && environment != NULL && !line.failed && prepare(worker, theirs))
        started = spawn(worker, program, line.text, environment, theirs);
    error = GetLastError();
    for (int i = 0; i < 3; i++) shut(theirs[i]);
    free(environment);
    free(line.text);
    if (!started) {
        char name[1000] = "";
        if (program != NULL) WideCharToMultiByte(CP_UTF8, 0, program, -1, name, sizeof name - 1, NULL, NULL);
        snprintf(message, size, "the Python interpreter '%s' can't be started (Windows error %lu); %s", name,
                 (unsigned long)error, table->remedy);
        if (worker != NULL) worker_stop(worker);
        worker = NULL;
    }
    free(program);
    return worker;
}

Channel worker_send(Worker *worker, const void *data, size_t size, double timeout) {
    const char *rest = data;
    (void)timeout; /* the worker reads a request whole before it works on it */
    while (size > 0) {
        DWORD written = 0, piece = size > 1 << 15 ? 1 << 15 : (DWORD)size;
        if (!WriteFile(worker->to_worker, rest, piece, &written, NULL)) return CHANNEL_CLOSED;
        rest += written;
        size -= written;
    }
    return CHANNEL_OK;
}

Channel worker_receive(Worker *worker, void *data, size_t size, double timeout) {
    double begin = now();
    char *rest = data;
    while (size > 0) {
        DWORD there = 0, got = 0;
        if (!PeekNamedPipe(worker->from_worker, NULL, 0, NULL, &there, NULL)) return CHANNEL_CLOSED;
        if (there > 0) {
            DWORD piece = there < size ? there : (DWORD)size;
            if (!ReadFile(worker->from_worker, rest, piece, &got, NULL)) return CHANNEL_CLOSED;
            rest += got;
            size -= got;
        } else if (timeout > 0 && now() - begin > timeout) {
            return CHANNEL_SILENT;
        } else if (now() - begin < SPIN) {
            SwitchToThread();
        } else {
            Sleep(1);
        }
    }
    return CHANNEL_OK;
}

void worker_last_words(Worker *worker, char *text, size_t size) {
    DWORD there = 0, got = 0;
    *text = '\0';
    if (!PeekNamedPipe(worker->words, NULL, 0, NULL, &there, NULL)) there = 0;
    while (there > 0) {
        DWORD piece = there < size - 1 ? there : (DWORD)(size - 1);
        if (!ReadFile(worker->words, text, piece, &got, NULL)) break;
        text[got] = '\0';
        there -= got < there ? got : there;
    }
}

void worker_stop(Worker *worker) {
    shut(worker->to_worker);
    shut(worker->from_worker);
    shut(worker->words);
    if (worker->process != NULL) TerminateProcess(worker->process, 1);
    shut(worker->process);
    shut(worker->job);
    free(worker);
}

#else

typedef int only_for_windows; /* a C file must not be empty */

#endif
