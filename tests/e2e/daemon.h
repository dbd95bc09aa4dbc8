/* daemon.h - a real hedged for a test, in a process of its own. It listens on a free port and is
 * stopped by a signal. */
#ifndef TESTS_E2E_DAEMON_H
#define TESTS_E2E_DAEMON_H

#include <stddef.h>

typedef struct daemon_process daemon_process;

/* Starts $HEDGED (build/hedged if unset) with --store memory and with the options of the present
 * transport (transport.h), such as a free port. Waits until the daemon says where it listens.
 * `arguments`, ended by NULL, are added after these options and override them; `arguments` may be
 * NULL. Fails the test if the daemon does not start. */
daemon_process *daemon_start(const char *const *arguments);
/* Starts a daemon whose standard error is a terminal, so that it writes its log in the format for
 * people. */
daemon_process *daemon_start_on_terminal(const char *const *arguments);
/* Sends SIGTERM, waits for the end of the daemon and frees `d`. Returns the exit status, or 128 +
 * the number of the signal that ended the process. */
int daemon_stop(daemon_process *d);
/* Sends SIGKILL, waits for the end of the daemon and frees `d`. What the daemon had only in memory
 * is lost, as in a crash. */
void daemon_kill(daemon_process *d);
/* Stops the daemon as daemon_stop does and requires status 0; returns all that it has written to
 * standard error, ended by NUL, which the caller must free. */
char *daemon_stop_and_tell(daemon_process *d);

const char *
daemon_url(const daemon_process *d); /* "http://127.0.0.1:43121", "https://...", "unix:PATH" */
int daemon_port(const daemon_process *d);
int daemon_pid(const daemon_process *d);
/* daemon_peak returns the peak of the daemon's resident memory in bytes; daemon_cpu returns the
 * seconds of processor time that it has used. */
size_t daemon_peak(const daemon_process *d);
double daemon_cpu(const daemon_process *d);
/* Waits until the daemon has written `text` to standard error `times` times. Returns all that it
 * has written so far, ended by NUL, which the caller must free. Fails the test if the daemon ends
 * before. */
char *daemon_wait_log(daemon_process *d, const char *text, int times);

/* Runs $HEDGED until it ends; returns its exit status. `output` becomes what it wrote to standard
 * output and standard error together, ended by NUL. */
int daemon_run(const char *const *arguments, char *output, size_t size);

#endif
