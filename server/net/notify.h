/* notify.h - sends notifications to systemd by the protocol of sd_notify(3), without its library.
 *
 * systemd gives a service of Type=notify a Unix datagram socket in NOTIFY_SOCKET, and with
 * WatchdogSec= the interval of the watchdog in WATCHDOG_USEC. Outside of such a service these
 * functions do nothing. */
#ifndef HE_SERVER_NET_NOTIFY_H
#define HE_SERVER_NET_NOTIFY_H

#include <stdbool.h>
#include <stdint.h>

/* Sends a message, such as "READY=1"; lines are separated by '\n'. It never waits: if systemd has
 * not read the messages before, and its queue is full, the message is lost. Returns false if the
 * message was lost for a reason that passes: the queue was full, or there was no free descriptor.
 * Other failures, and a missing socket, return true: sending again would not help. */
bool srv_notify(const char *message);

/* Returns the number of microseconds within which systemd's watchdog expects the message
 * "WATCHDOG=1"; 0 if there is no watchdog, or if it watches another process. */
uint64_t srv_notify_watchdog(void);

#endif
