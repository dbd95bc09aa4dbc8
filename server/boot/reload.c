#include "server/boot/reload.h"

#include "server/boot/parts.h"
#include "server/boot/start.h"
#include "server/boot/watch.h"
#include "server/config_option.h"
#include "server/net/notify.h"
#include "server/tokens.h"
#include "system/clock.h"

#include <inttypes.h>
#include <stdlib.h>
#include <string.h>

static bool reload_tokens(srv_parts *parts, char *message, size_t size)
{
    if (parts->tokens == NULL) {
        return true;
    }
    if (!srv_tokens_read(parts->tokens, parts->config->tokens, message, size)) {
        return false;
    }
    if (parts->service != NULL && !api_service_apply_quotas(parts->service)) {
        snprintf(message, size, "no memory for the quotas of the tokens");
        return false;
    }
    srv_log_tell(parts->log, SRV_LEVEL_INFO, "%zu tokens are accepted, read again from %s",
                 api_tokens_count(parts->tokens), parts->config->tokens);
    return true;
}

/* Returns true if a running daemon can change this setting. */
static bool is_reloaded(const srv_option *row)
{
    static const char *const names[] = {"log", "log-format", "log-level", "slow"};
    bool found = false;
    for (size_t i = 0; i < sizeof names / sizeof *names; i++) {
        found = found || strcmp(names[i], row->name) == 0;
    }
    return found;
}

static bool differs(const srv_option *row, const srv_config *one, const srv_config *other)
{
    api_text a = {0}, b = {0};
    srv_option_write(row, one, &a);
    srv_option_write(row, other, &b);
    const bool differ =
        a.length != b.length || (a.length > 0 && memcmp(a.bytes, b.bytes, a.length) != 0);
    api_text_clear(&a);
    api_text_clear(&b);
    return differ;
}

/* Reads the configuration file again, which flags and variables still override, and applies the
 * settings of the log. Other settings that have changed are reported: they need a restart. */
static bool reload_settings(srv_parts *parts, char *message, size_t size)
{
    const srv_started *started = parts->started;
    const char *file = parts->config->config;
    srv_config fresh;
    if (file[0] == '\0') {
        return true;
    }
    const srv_config_sources from = {started->argc, started->argv, getenv};
    if (!srv_config_read(&fresh, &from, message, size)) {
        return false;
    }
    for (size_t i = 0; i < srv_option_count; i++) {
        const srv_option *row = &srv_options[i];
        if (srv_option_is_setting(row) && !is_reloaded(row) &&
            differs(row, parts->config, &fresh)) {
            srv_log_tell(parts->log, SRV_LEVEL_WARNING,
                         "%s has a new value of %s, which takes effect only after a restart", file,
                         row->name);
        }
    }
    const srv_log_settings settings = srv_start_log_settings(&fresh);
    srv_log_set(parts->log, &settings);
    srv_log_tell(parts->log, SRV_LEVEL_INFO, "the settings of the log were read again from %s",
                 file);
    srv_config_clear(&fresh);
    return true;
}

static bool reload_certificates(srv_parts *parts, char *message, size_t size)
{
    const srv_config *config = parts->config;
    if (parts->certificates == NULL) {
        return true;
    }
    if (!srv_certificates_read(parts->certificates, config->tls_cert, config->tls_key, message,
                               size)) {
        return false;
    }
    srv_log_tell(parts->log, SRV_LEVEL_INFO,
                 "new connections use the certificate that was read again from %s",
                 config->tls_cert);
    return true;
}

/* The functions that srv_reload calls, in this order; each reads one file again. */
static bool (*const reloads[])(srv_parts *parts, char *message, size_t size) = {
    reload_settings,
    reload_tokens,
    reload_certificates,
};

/* Notifies systemd that a reload has begun. The message contains the time, by which systemd
 * distinguishes this reload from an earlier one. */
static void tell_systemd_begun(void)
{
    char text[64];
    snprintf(text, sizeof text, "RELOADING=1\nMONOTONIC_USEC=%" PRIu64, st_clock_micros());
    srv_notify(text);
}

static bool reload_all(srv_parts *parts, char *message, size_t size)
{
    char why[320], state[512];
    bool ok = true;
    tell_systemd_begun();
    for (size_t i = 0; i < sizeof reloads / sizeof *reloads; i++) {
        if (!reloads[i](parts, why, sizeof why)) {
            srv_log_tell(parts->log, SRV_LEVEL_ERROR, "%s; the previous settings stay in effect",
                         why);
            /* `message` reports only the first of the files that could not be read again. */
            if (ok) {
                snprintf(message, size, "%s", why);
            }
            ok = false;
        }
    }
    if (ok) {
        srv_watch_announce(parts);
    } else {
        snprintf(state, sizeof state, "READY=1\nSTATUS=not reloaded: %s", why);
        if (!srv_notify(state)) {
            atomic_store(&parts->unannounced, true);
        }
    }
    return ok;
}

bool srv_reload(void *context, char *message, size_t size)
{
    srv_parts *parts = context;
    pthread_mutex_lock(&parts->reload_lock);
    const bool ok = reload_all(parts, message, size);
    pthread_mutex_unlock(&parts->reload_lock);
    return ok;
}
