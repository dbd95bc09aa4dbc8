/* signals.h - the signals of the daemon: it waits for three and ignores the harmless ones. */
#ifndef HE_SERVER_BOOT_SIGNALS_H
#define HE_SERVER_BOOT_SIGNALS_H

#include <signal.h>

/* Ignores signals that have no meaning for the daemon, and blocks SIGTERM, SIGINT and SIGHUP, so
 * that the main thread can wait for them; *waited is set to these. Threads inherit that, so the
 * caller must not have started one. */
void srv_signals_begin(sigset_t *waited);

#endif
