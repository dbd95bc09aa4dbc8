/* daemon.h - a real hedged for a test, as a process of its own that listens on a free port and is
 * stopped by a signal. */
#ifndef TESTS_E2E_DAEMON_H
#define TESTS_E2E_DAEMON_H

#include <stddef.h>

typedef struct daemon_process daemon_process;

/* Starts $HEDGED (build/hedged if unset) with --store memory and with a free port, or a path as
 * transport.h says, and waits until it says where it listens. Further arguments, ended by NULL,
 * override these; the pointer may be NULL. Fails the test if the daemon does not start. */
daemon_process *daemon_start(const char *const *arguments);
/* Starts a daemon whose standard error is a terminal, so that its log has the format for people. */
daemon_process *daemon_start_on_terminal(const char *const *arguments);
/* Sends SIGTERM, waits and frees. Returns the exit status, or 128 + the signal that ended the
 * process. */
int daemon_stop(daemon_process *d);
/* Sends SIGKILL, waits and frees: as in a crash of the machine, only the disk is left. */
void daemon_kill(daemon_process *d);
/* Stops the daemon as daemon_stop does and requires status 0; returns all that it has written to
 * standard error, ended by NUL, which the caller must free. */
char *daemon_stop_and_tell(daemon_process *d);

const char *
daemon_url(const daemon_process *d); /* "http://127.0.0.1:43121", "https://...", "unix:PATH" */
int daemon_port(const daemon_process *d);
int daemon_pid(const daemon_process *d);
/* Return the most memory that the daemon ever held, in bytes, and the seconds of processor time
 * that it has used. */
size_t daemon_peak(const daemon_process *d);
double daemon_cpu(const daemon_process *d);
/* Waits until the daemon has written `text` to standard error this many times; returns all it has
 * written so far, ended by NUL, which the caller must free. Fails the test if the daemon ends
 * before. */
char *daemon_wait_log(daemon_process *d, const char *text, int times);

/* Runs $HEDGED until it ends; returns its exit status. `output` becomes what it wrote to standard
 * output and standard error together, ended by NUL. */
int daemon_run(const char *const *arguments, char *output, size_t size);

#endif
