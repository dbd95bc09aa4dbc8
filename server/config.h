/* config.h - what the daemon can be told: THE table of options.
 *
 * A flag wins over its environment variable, that over a line of the configuration file, that over
 * the default. --help, --print-config and the
 * parsing are made from one row an option; adding an option is adding a row and a member. */
#ifndef HE_SERVER_CONFIG_H
#define HE_SERVER_CONFIG_H

#include "api/limit/limit.h"
#include "server/http/http_policy.h"

#include <stdbool.h>
#include <stdint.h>
#include <stdio.h>

/* Times that an option which is a list may be given, all of them together. */
enum { SRV_MAX_LISTS = 3 * SRV_MAX_NAMES };

/* The words of choices, in the order in which their rows of the table name them.
 *
 * SRV_LOG_AUTO logs requests unless stderr is a terminal, where the lines would bury what its
 * reader wants to see. SRV_FORMAT_AUTO is text on a terminal and JSON elsewhere. */
typedef enum srv_log_kind { SRV_LOG_AUTO, SRV_LOG_ACCESS, SRV_LOG_OFF } srv_log_kind;
typedef enum srv_log_format { SRV_FORMAT_AUTO, SRV_FORMAT_TEXT, SRV_FORMAT_JSON } srv_log_format;

typedef struct srv_config {
    const char *config; /* a file; "": none */
    const char *listen;
    bool insecure;
    const char *tokens;             /* a file; "": nobody needs a token */
    const char *tls_cert, *tls_key; /* files; both "": plain HTTP */
    srv_policy policy;              /* its proxies are those of `trusted_proxies` */
    srv_names trusted_proxies;
    const char *web;   /* "": look beside the executable */
    const char *store; /* "memory", or "sqlite:" and a folder: srv_config_folder */
    bool samples;
    uint64_t log;        /* srv_log_kind */
    uint64_t log_format; /* srv_log_format */
    uint64_t log_level;  /* srv_level of server/log/line.h */
    uint64_t slow;       /* milliseconds; 0: no request is slow */

    uint64_t max_upload;    /* bytes */
    uint64_t memory_budget; /* bytes; 0: three quarters of st_memory_limit_find */
    uint64_t undo_budget;   /* bytes a mesh */
    uint64_t max_meshes;
    bool no_compression;

    uint64_t workers, jobs; /* threads; 0: one a core */
    uint64_t job_queue;
    uint64_t read_seconds;
    uint64_t max_connections;
    uint64_t max_listeners, max_mesh_listeners;

    api_limits token_limits, address_limits; /* by api/limit/limit.h */
    uint64_t limit_burst;                    /* seconds */

    uint64_t heartbeat;                                                 /* seconds */
    uint64_t idle_timeout, header_timeout, body_grace, request_timeout; /* seconds */
    uint64_t min_rate;                                                  /* bytes a second */

    const char *backup, *restore, *dump; /* files, a folder; NULL: not asked for */
    bool help, version, print_config, healthcheck, verify, new_token;
    const char *healthcheck_url;         /* NULL: /livez at `listen` */
    const char *verified;                /* a file; NULL: the store */
    const char *token_name, *token_role; /* of new_token; NULL: not given */

    /* The text that list members point into, and that of the configuration file. */
    char *owned[SRV_MAX_LISTS];
    unsigned owned_count;
    char *file_text;
} srv_config;

/* Fill `config` from arguments (without the program's name) and `environment` (getenv, or a test's
 * own). Texts are borrowed from both. False with a sentence in `message` otherwise; then `config`
 * is empty but for log_format, in which the sentence is to be written. */
bool srv_config_read(srv_config *config, int argc, char *const *argv,
                     char *(*environment)(const char *name), char *message, size_t size);
void srv_config_clear(srv_config *config);

/* The folder of the store; NULL where meshes are kept in memory alone. */
const char *srv_config_folder(const srv_config *config);

/* Where a daemon of these options is reached on this machine: "http://127.0.0.1:8080",
 * "https://...", "unix:/run/hedge/socket". `listen` is NULL, or the address with the port that was
 * taken. */
enum { SRV_URL_TEXT = 8 + SRV_ADDRESS_TEXT };
void srv_config_url(const srv_config *config, const char *listen, char out[SRV_URL_TEXT]);

/* The variables of `environment` ("NAME=value", the last NULL) whose names begin with HEDGE_ and
 * are no option's: how many there are, and their names with ", " between them, cut to `size`
 * bytes. A misspelt one would otherwise be ignored in silence; Kubernetes sets HEDGE_PORT for a
 * service that is called hedge. */
size_t srv_config_find_unknown(char *const *environment, char *names, size_t size);

void srv_config_help(FILE *out);
/* Each option as `name = value`, as a configuration would set it. */
void srv_config_print(const srv_config *config, FILE *out);

#endif
