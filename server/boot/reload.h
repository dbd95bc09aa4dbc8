/* reload.h - reads configuration, tokens and certificates again on SIGHUP and on POST
 * /v1/admin/reload. */
#ifndef HE_SERVER_BOOT_RELOAD_H
#define HE_SERVER_BOOT_RELOAD_H

#include <stdbool.h>
#include <stddef.h>

/* Reads the files again, and reports the outcome to the log and to systemd. The function is the
 * `reload` of api_options; `context` is an srv_parts. If a file cannot be read, what was read from
 * it before stays in force, and the function returns false with a sentence about the first such
 * file in `message`. Two threads may call it at the same time: one waits for the other, so the
 * files read last stay in force. */
bool srv_reload(void *context, char *message, size_t size);

#endif
