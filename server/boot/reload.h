/* reload.h - what SIGHUP and POST /v1/admin/reload read again; reload.c lists it. */
#ifndef HE_SERVER_BOOT_RELOAD_H
#define HE_SERVER_BOOT_RELOAD_H

#include <stdbool.h>
#include <stddef.h>

/* api_options' `reload`; `context` is an srv_parts. Reads everything on the list again, and tells
 * the log and systemd how it went. Whatever cannot be read stays as it was before: then false, with
 * a sentence about the first such thing in `message`. Two threads may call it at one time: the
 * files read last stay in force. */
bool srv_reload(void *context, char *message, size_t size);

#endif
