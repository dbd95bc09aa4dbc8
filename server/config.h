/* config.h - the settings of the daemon, which are read by the one table of all options.
 *
 * A flag overrides its environment variable, which overrides a line of the configuration file,
 * which overrides the default. --help, --print-config and parsing are driven by one row per option;
 * to add an option, add a row and a member. */
#ifndef HE_SERVER_CONFIG_H
#define HE_SERVER_CONFIG_H

#include "api/limit/limit.h"
#include "server/http/http_policy.h"

#include <stdbool.h>
#include <stdint.h>
#include <stdio.h>

/* The largest number of values that all options of the kind list may get together. */
enum { SRV_MAX_ORIGIN = 255 }; /* characters of an origin of --allow-frame */
enum { SRV_MAX_LISTS = 4 * SRV_MAX_NAMES };

/* The values of the options --log and --log-format, in the order in which the table of options
 * lists the words that these options allow. SRV_LOG_AUTO logs requests unless stderr is a terminal,
 * where their lines would bury more important lines. SRV_FORMAT_AUTO is text on a terminal and JSON
 * elsewhere. */
typedef enum srv_log_kind { SRV_LOG_AUTO, SRV_LOG_ACCESS, SRV_LOG_OFF } srv_log_kind;
typedef enum srv_log_format { SRV_FORMAT_AUTO, SRV_FORMAT_TEXT, SRV_FORMAT_JSON } srv_log_format;

typedef struct srv_config {
    const char *config; /* path of the configuration file; "" if there is none */
    const char *listen;
    bool insecure;
    const char *tokens; /* path of the file of tokens; "" if requests need no token */
    /* Paths of the certificate and the key; both are "" if the daemon uses no TLS. */
    const char *tls_cert, *tls_key;
    /* Rules for the requests that browsers send; its list of proxies is made from
     * `trusted_proxies`. */
    srv_policy policy;
    srv_names frames; /* origins whose pages may show the viewer in a frame */
    srv_names trusted_proxies;
    const char *web; /* folder of the page; "": the folder is searched beside the executable */
    /* Where meshes are kept: "memory", or "sqlite:" and a folder; see srv_config_folder. */
    const char *store;
    bool samples;
    uint64_t log;        /* srv_log_kind */
    uint64_t log_format; /* srv_log_format */
    uint64_t log_level;  /* srv_level of server/log/line.h */
    /* A request that takes at least this many milliseconds is logged as slow; 0: no request is. */
    uint64_t slow;

    uint64_t max_upload; /* bytes */
    /* Limit of the daemon's memory in bytes; 0: three quarters of st_memory_limit_find. */
    uint64_t memory_budget;
    uint64_t undo_budget; /* bytes per mesh */
    uint64_t max_meshes;
    bool no_compression;

    uint64_t workers, jobs; /* threads; 0: one per core */
    uint64_t job_queue;
    uint64_t read_seconds;
    uint64_t max_connections;
    uint64_t max_listeners, max_mesh_listeners;

    /* Limits of each token and of each address: api/limit/limit.h. */
    api_limits token_limits, address_limits;
    uint64_t limit_burst; /* seconds */

    uint64_t heartbeat;                                                 /* seconds */
    uint64_t idle_timeout, header_timeout, body_grace, request_timeout; /* seconds */
    uint64_t min_rate;                                                  /* bytes a second */

    /* Paths given with --backup, --restore (files) and --dump (a folder); NULL if not given. */
    const char *backup, *restore, *dump;
    bool help, version, print_config, healthcheck, verify, new_token;
    /* The URL to which --healthcheck sends its request; NULL: /livez at the address of `listen`. */
    const char *healthcheck_url;
    /* Path of the file that --verify reads; NULL: the store is verified. */
    const char *verified;
    /* The arguments of --new-token; NULL if the option is not given. */
    const char *token_name, *token_role;

    /* Texts that the configuration owns: copies of lists, into which the items of srv_names point,
     * and the contents of the configuration file. */
    char *owned[SRV_MAX_LISTS];
    unsigned owned_count;
    char *file_text;
} srv_config;

/* The sources of settings, except the configuration file, which one of these sources may name. */
typedef struct srv_config_sources {
    int argc;
    char *const *argv;                      /* the arguments, without the program's name */
    char *(*environment)(const char *name); /* getenv, or a test's function */
} srv_config_sources;

/* Fills `config` from its sources and borrows their texts. Returns false with a sentence in
 * `message` if a value is wrong; then `config` is empty except for log_format, the format in which
 * the caller is to print the sentence. */
bool srv_config_read(srv_config *config, const srv_config_sources *from, char *message,
                     size_t size);
void srv_config_clear(srv_config *config);

/* Returns the folder of the store, or NULL if meshes are kept in memory only. */
const char *srv_config_folder(const srv_config *config);

/* Writes the URL of a daemon with this configuration on this machine: "http://127.0.0.1:8080",
 * "https://...", "unix:/run/hedge/socket". `listen` is the address with the port that is in use, or
 * NULL. */
enum { SRV_URL_TEXT = 8 + SRV_ADDRESS_TEXT };
void srv_config_url(const srv_config *config, const char *listen, char out[SRV_URL_TEXT]);

/* Finds variables in `environment` ("NAME=value", the last NULL) that begin with HEDGE_ and belong
 * to no option. Returns their number and writes their names, separated by ", " and cut to `size`
 * bytes. Without this a misspelt variable would be ignored silently. Kubernetes sets such
 * variables, too: HEDGE_PORT for a service called hedge. */
size_t srv_config_find_unknown(char *const *environment, char *names, size_t size);

void srv_config_help(FILE *out);
/* Prints each option as `name = value`, as a configuration file would have it. */
void srv_config_print(const srv_config *config, FILE *out);

#endif
