/* reload.h - reading files again on SIGHUP and POST /v1/admin/reload; reload.c lists them. */
#ifndef HE_SERVER_BOOT_RELOAD_H
#define HE_SERVER_BOOT_RELOAD_H

#include <stdbool.h>
#include <stddef.h>

/* The `reload` of api_options; `context` is an srv_parts. Reads everything on the list again, and
 * reports the outcome to the log and systemd. What cannot be read stays as it was; then it returns
 * false with a sentence about the first failure in `message`. Two threads may call it at the same
 * time: the files read last stay in force. */
bool srv_reload(void *context, char *message, size_t size);

#endif
