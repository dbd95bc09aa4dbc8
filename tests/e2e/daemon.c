#include "tests/e2e/daemon.h"

#include "tests/e2e/transport.h"

#include <errno.h>
#include <pthread.h>
#include <pty.h>
#include <signal.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/prctl.h>
#include <sys/types.h>
#include <sys/wait.h>
#include <termios.h>
#include <time.h>
#include <unistd.h>

#include <setjmp.h>
#include <stdarg.h>
#include <stdint.h>

#include <cmocka.h>

enum { MOST_ARGUMENTS = 32, URL_BYTES = 160 };

struct daemon_process {
    pid_t pid;
    int log_fd;
    pthread_t reader;
    pthread_mutex_t lock;
    pthread_cond_t changed;
    char *log;
    size_t length, capacity;
    bool ended; /* the daemon has closed its end of the pipe */
    char url[URL_BYTES];
    int port;
};

static const char *program(void)
{
    const char *path = getenv("HEDGED");
    return path != NULL ? path : "build/hedged";
}

/* Two ends of a pipe or terminal: the program writes to the descriptor `writes`, and the test reads
 * from the descriptor `reads`. */
typedef struct outlet {
    int reads, writes;
} outlet;

static outlet open_pipe(void)
{
    int ends[2];
    assert_int_equal(pipe(ends), 0);
    return (outlet){ends[0], ends[1]};
}

/* Opens a pseudo-terminal that does not add a carriage return to each line feed. */
static outlet open_terminal(void)
{
    outlet o;
    struct termios modes;
    assert_int_equal(openpty(&o.reads, &o.writes, NULL, NULL, NULL), 0);
    assert_int_equal(tcgetattr(o.writes, &modes), 0);
    cfmakeraw(&modes);
    assert_int_equal(tcsetattr(o.writes, TCSANOW, &modes), 0);
    return o;
}

/* Starts the program with its standard error connected to `to`, and also its standard output if
 * `with_stdout` is set. Returns the descriptor from which the test reads both. */
static int spawn(const char *const *head, const char *const *tail, outlet to, bool with_stdout,
                 pid_t *pid)
{
    const char *argv[MOST_ARGUMENTS];
    size_t count = 0;
    argv[count++] = program();
    for (size_t i = 0; head != NULL && head[i] != NULL; i++) {
        argv[count++] = head[i];
    }
    for (size_t i = 0; tail != NULL && tail[i] != NULL && count + 1 < MOST_ARGUMENTS; i++) {
        argv[count++] = tail[i];
    }
    argv[count] = NULL;
    *pid = fork();
    assert_true(*pid >= 0);
    if (*pid == 0) {
        /* A test that fails does not stop its daemons: the kernel kills them when the test program
         * ends. */
        prctl(PR_SET_PDEATHSIG, SIGKILL);
        dup2(to.writes, STDERR_FILENO);
        if (with_stdout) {
            dup2(to.writes, STDOUT_FILENO);
        }
        close(to.reads);
        close(to.writes);
        execv(argv[0], (char *const *)(uintptr_t)argv);
        fprintf(stderr, "%s: %s\n", argv[0], strerror(errno));
        _exit(127);
    }
    close(to.writes);
    return to.reads;
}

static void append(daemon_process *d, const char *bytes, size_t length)
{
    if (d->length + length + 1 > d->capacity) {
        d->capacity = 2 * (d->length + length + 1);
        d->log = realloc(d->log, d->capacity);
        if (d->log == NULL) {
            abort();
        }
    }
    memcpy(d->log + d->length, bytes, length);
    d->length += length;
    d->log[d->length] = '\0';
}

/* Reads the daemon's log continuously, so that the pipe never fills up and makes the daemon
 * wait. */
static void *read_log(void *context)
{
    daemon_process *d = context;
    char buffer[4096];
    for (;;) {
        ssize_t got = read(d->log_fd, buffer, sizeof buffer);
        if (got < 0 && errno == EINTR) {
            continue;
        }
        pthread_mutex_lock(&d->lock);
        if (got <= 0) {
            d->ended = true;
        } else {
            append(d, buffer, (size_t)got);
        }
        pthread_cond_broadcast(&d->changed);
        pthread_mutex_unlock(&d->lock);
        if (got <= 0) {
            return NULL;
        }
    }
}

/* Finds the line that says that the daemon is ready, which ends in "listening on URL". */
static bool find_url(daemon_process *d)
{
    static const char words[] = "listening on ";
    const char *at = d->log == NULL ? NULL : strstr(d->log, words);
    const char *end = at == NULL ? NULL : strchr(at, '\n');
    if (end == NULL) {
        return false;
    }
    at += sizeof words - 1;
    snprintf(d->url, sizeof d->url, "%.*s", (int)(end - at), at);
    const char *colon = strrchr(d->url, ':');
    d->port = colon == NULL ? 0 : (int)strtol(colon + 1, NULL, 10);
    return true;
}

static daemon_process *start(const char *const *arguments, outlet to)
{
    const char *own[2 + TRANSPORT_OPTIONS] = {"--store", "memory"};
    memcpy(own + 2, transport_options(), TRANSPORT_OPTIONS * sizeof *own);
    daemon_process *d = calloc(1, sizeof *d);
    assert_non_null(d);
    pthread_mutex_init(&d->lock, NULL);
    pthread_cond_init(&d->changed, NULL);
    d->log_fd = spawn(own, arguments, to, false, &d->pid);
    assert_int_equal(pthread_create(&d->reader, NULL, read_log, d), 0);
    pthread_mutex_lock(&d->lock);
    while (!find_url(d) && !d->ended) {
        pthread_cond_wait(&d->changed, &d->lock);
    }
    bool listening = d->port > 0 || strncmp(d->url, "unix:", 5) == 0;
    if (!listening) {
        print_error("%s did not start:\n%s\n", program(), d->log == NULL ? "" : d->log);
    }
    pthread_mutex_unlock(&d->lock);
    assert_true(listening);
    return d;
}

daemon_process *daemon_start(const char *const *arguments)
{
    return start(arguments, open_pipe());
}

daemon_process *daemon_start_on_terminal(const char *const *arguments)
{
    return start(arguments, open_terminal());
}

static int status_of(int waited)
{
    return WIFEXITED(waited) ? WEXITSTATUS(waited) : 128 + WTERMSIG(waited);
}

/* Sends a signal to the daemon and waits until it has ended; the daemon's log is then complete. */
static int end(daemon_process *d, int signal)
{
    int waited = 0;
    kill(d->pid, signal);
    while (waitpid(d->pid, &waited, 0) < 0 && errno == EINTR) {
    }
    pthread_join(d->reader, NULL);
    return status_of(waited);
}

static void release(daemon_process *d)
{
    close(d->log_fd);
    pthread_mutex_destroy(&d->lock);
    pthread_cond_destroy(&d->changed);
    free(d->log);
    free(d);
}

int daemon_stop(daemon_process *d)
{
    int status = end(d, SIGTERM);
    if (status != 0) {
        print_error("hedged ended with %d:\n%s\n", status, d->log);
    }
    release(d);
    return status;
}

void daemon_kill(daemon_process *d)
{
    int status = end(d, SIGKILL);
    if (status != 128 + SIGKILL) {
        print_error("hedged ended by itself with %d:\n%s\n", status, d->log);
    }
    assert_int_equal(status, 128 + SIGKILL);
    release(d);
}

char *daemon_stop_and_tell(daemon_process *d)
{
    assert_int_equal(end(d, SIGTERM), 0);
    char *log = d->log;
    d->log = NULL;
    release(d);
    return log;
}

const char *daemon_url(const daemon_process *d)
{
    return d->url;
}

int daemon_port(const daemon_process *d)
{
    return d->port;
}

int daemon_pid(const daemon_process *d)
{
    return (int)d->pid;
}

static int count(const char *log, const char *text)
{
    int times = 0;
    for (const char *at = log; at != NULL && (at = strstr(at, text)) != NULL; at++) {
        times++;
    }
    return times;
}

char *daemon_wait_log(daemon_process *d, const char *text, int times)
{
    pthread_mutex_lock(&d->lock);
    while (count(d->log, text) < times && !d->ended) {
        pthread_cond_wait(&d->changed, &d->lock);
    }
    char *copy = strdup(d->log == NULL ? "" : d->log);
    pthread_mutex_unlock(&d->lock);
    assert_true(count(copy, text) >= times);
    return copy;
}

int daemon_run(const char *const *arguments, char *output, size_t size)
{
    pid_t pid;
    int waited = 0, fd = spawn(NULL, arguments, open_pipe(), true, &pid);
    size_t length = 0;
    ssize_t got;
    char rest[512];
    while ((got = length + 1 < size ? read(fd, output + length, size - 1 - length)
                                    : read(fd, rest, sizeof rest)) != 0) {
        if (got > 0 && length + 1 < size) {
            length += (size_t)got;
        } else if (got < 0 && errno != EINTR) {
            break;
        }
    }
    output[length] = '\0';
    close(fd);
    while (waitpid(pid, &waited, 0) < 0 && errno == EINTR) {
    }
    return status_of(waited);
}

size_t daemon_peak(const daemon_process *d)
{
    char path[64], line[128];
    unsigned long kib = 0;
    snprintf(path, sizeof path, "/proc/%d/status", (int)d->pid);
    FILE *file = fopen(path, "r");
    assert_non_null(file);
    while (fgets(line, sizeof line, file) != NULL) {
        if (sscanf(line, "VmHWM: %lu", &kib) == 1) {
            break;
        }
    }
    fclose(file);
    return kib * 1024;
}

double daemon_cpu(const daemon_process *d)
{
    clockid_t clock;
    struct timespec t;
    assert_int_equal(clock_getcpuclockid(d->pid, &clock), 0);
    assert_int_equal(clock_gettime(clock, &t), 0);
    return (double)t.tv_sec + (double)t.tv_nsec * 1e-9;
}
