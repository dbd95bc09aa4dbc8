/* notify.h - what systemd is told: the protocol of sd_notify(3), without its library.
 *
 * systemd gives a service of Type=notify a Unix datagram socket in NOTIFY_SOCKET, and with
 * WatchdogSec= the time within which it wants to hear of it in WATCHDOG_USEC. Outside of such a
 * service nothing here does anything. */
#ifndef HE_SERVER_NET_NOTIFY_H
#define HE_SERVER_NET_NOTIFY_H

#include <stdbool.h>
#include <stdint.h>

/* Send a message, such as "READY=1"; lines are parted by '\n'. False when there is nobody to tell,
 * or the message did not get there, which is no reason to stop. */
bool srv_notify(const char *message);

/* Microseconds within which "WATCHDOG=1" is waited for; 0 when nobody waits, or for another
 * process than this one. */
uint64_t srv_notify_watchdog(void);

#endif
