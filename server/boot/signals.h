/* signals.h - the signals of the daemon: three are waited for, the harmless ones are ignored. */
#ifndef HE_SERVER_BOOT_SIGNALS_H
#define HE_SERVER_BOOT_SIGNALS_H

#include <signal.h>

/* Ignores the signals that mean nothing to the daemon, and blocks SIGTERM, SIGINT and SIGHUP, which
 * *waited is set to, so that the main thread can wait for them. Threads inherit that: the caller
 * must not have started one. */
void srv_signals_begin(sigset_t *waited);

#endif
