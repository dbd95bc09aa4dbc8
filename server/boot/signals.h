/* signals.h - sets how the daemon treats signals: it waits for SIGTERM, SIGINT and SIGHUP, and
 * ignores signals that have no meaning for it. */
#ifndef HE_SERVER_BOOT_SIGNALS_H
#define HE_SERVER_BOOT_SIGNALS_H

#include <signal.h>

/* Ignores signals that have no meaning for the daemon, and blocks SIGTERM, SIGINT and SIGHUP, so
 * that the main thread can wait for them; *waited is set to these three. Threads inherit what their
 * creator blocks, so this must be called before the first thread is started. */
void srv_signals_begin(sigset_t *waited);

#endif
