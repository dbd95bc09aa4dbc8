/* daemon.h - a real hedged for a test: its own process, a free port, stopped by signal. */
#ifndef TESTS_E2E_DAEMON_H
#define TESTS_E2E_DAEMON_H

#include <stddef.h>

typedef struct daemon_process daemon_process;

/* Start $HEDGED (build/hedged without) with --store memory, a free port or path as transport.h
 * says, and more arguments, which end in NULL (or are NULL) and win over these, and wait until it
 * says where it listens. Fails the test when it does not. */
daemon_process *daemon_start(const char *const *arguments);
/* Start it with a terminal of its own as stderr, whose lines end as they are written. */
daemon_process *daemon_start_on_terminal(const char *const *arguments);
/* SIGTERM, wait, free. Gives the exit status, or 128 + the signal that ended it. */
int daemon_stop(daemon_process *d);
/* SIGKILL, wait, free: as if the machine had gone, but for its disk. */
void daemon_kill(daemon_process *d);
/* Stop it as daemon_stop does, require status 0, and give all it has written to stderr, ended by
 * NUL; the caller's to free. */
char *daemon_stop_and_tell(daemon_process *d);

const char *
daemon_url(const daemon_process *d); /* "http://127.0.0.1:43121", "https://...", "unix:PATH" */
int daemon_port(const daemon_process *d);
int daemon_pid(const daemon_process *d);
/* The most memory it ever held, in bytes; seconds of processor time it has used. */
size_t daemon_peak(const daemon_process *d);
double daemon_cpu(const daemon_process *d);
/* Wait until it has written `text` to stderr this many times, and give all it has written so far,
 * ended by NUL; the caller's to free. Fails the test when it ends first. */
char *daemon_wait_log(daemon_process *d, const char *text, int times);

/* Run $HEDGED to its end and give its exit status; what it wrote to stdout and stderr together goes
 * to `output`, ended by NUL. */
int daemon_run(const char *const *arguments, char *output, size_t size);

#endif
