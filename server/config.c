#include "server/config.h"

#include "api/limit/limit.h"
#include "base/mem.h"
#include "server/config_file.h"
#include "server/config_option.h"
#include "server/net/address.h"

#include <inttypes.h>
#include <stddef.h>
#include <string.h>

#define MEMBER(m)           offsetof(srv_config, m)
#define LIMIT(whose, limit) (MEMBER(whose) + offsetof(api_limits, most[API_LIMIT_##limit]))
#define KIB                 (UINT64_C(1) << 10)
#define TIB                 (UINT64_C(1) << 40)

const srv_option srv_options[] = {
    {"config", SRV_SOURCE, MEMBER(config), "", "FILE", 0, 0,
     "configuration file with one option on each line, in the format of --print-config"},
    {"listen", SRV_TEXT, MEMBER(listen), "127.0.0.1:8080", "HOST:PORT|unix:PATH", 0, 0,
     "address to listen on. With port 0 the system chooses a free port. unix:PATH: a Unix socket "
     "with the permissions 0660, which the daemon creates and removes"},
    {"insecure", SRV_FLAG, MEMBER(insecure), "0", NULL, 0, 0,
     "allow --listen to use an address that other machines can reach, although requests need no "
     "token"},
    {"tokens", SRV_TEXT, MEMBER(tokens), "", "FILE", 0, 0,
     "file of tokens and their roles, one on each line, as --new-token prints them. Without this "
     "file every client may do everything. SIGHUP and POST /v1/admin/reload read it again"},
    {"token-requests", SRV_COUNT, LIMIT(token_limits, REQUESTS), "0", "N", 0, API_LIMIT_MOST,
     "requests per second for each token; 0: no limit. Further requests are answered 429. The "
     "setting requests=N in a token's line of the file of tokens overrides this"},
    {"token-bytes", SRV_BYTES, LIMIT(token_limits, BYTES), "0", "BYTES", 0, API_LIMIT_MOST_BYTES,
     "bytes per second for each token, of request bodies and answers together; 0: no limit. "
     "Requests that come when the bytes are used up are answered 429"},
    {"token-jobs", SRV_COUNT, LIMIT(token_limits, JOBS), "0", "N", 0, API_LIMIT_MOST,
     "waiting and running jobs of each token; 0: no limit. Further jobs are answered 429"},
    {"token-meshes", SRV_COUNT, LIMIT(token_limits, MESHES), "0", "N", 0, API_LIMIT_MOST,
     "existing meshes that each token has created; 0: no limit. Further meshes are answered 507"},
    {"token-mesh-bytes", SRV_BYTES, LIMIT(token_limits, MESH_BYTES), "0", "BYTES", 0,
     API_LIMIT_MOST_BYTES,
     "memory that the meshes created by each token may take together; 0: no limit. Changes that "
     "need more are answered 507"},
    {"address-requests", SRV_COUNT, LIMIT(address_limits, REQUESTS), "0", "N", 0, API_LIMIT_MOST,
     "requests per second from each IP address (IPv6: each /64 network); 0: no limit. Further "
     "requests are answered 429. Requests with a valid token do not count"},
    {"address-bytes", SRV_BYTES, LIMIT(address_limits, BYTES), "0", "BYTES", 0,
     API_LIMIT_MOST_BYTES,
     "bytes per second for each IP address (IPv6: each /64 network), of request bodies and answers "
     "together; 0: no limit. Requests that come when the bytes are used up are answered 429. "
     "Requests with a valid token do not count"},
    {"address-connections", SRV_COUNT, LIMIT(address_limits, CONNECTIONS), "0", "N", 0, 1000000,
     "open connections from each IP address (IPv6: each /64 network); 0: no limit. Further "
     "connections are answered 429 and closed"},
    {"limit-burst", SRV_COUNT, MEMBER(limit_burst), "10", "SECONDS", 1, API_BURST_MOST,
     "size of a burst: after a pause, a client may immediately use as many requests and bytes as "
     "its limits per second allow in this many seconds"},
    {"tls-cert", SRV_TEXT, MEMBER(tls_cert), "", "FILE", 0, 0,
     "accept only HTTPS, with the certificate in this PEM file, followed by its chain. SIGHUP and "
     "POST /v1/admin/reload read it again"},
    {"tls-key", SRV_TEXT, MEMBER(tls_key), "", "FILE", 0, 0,
     "private key of the certificate (PEM, not encrypted)"},
    {"allow-host", SRV_LIST, MEMBER(policy.hosts), "", "NAME", 0, 0,
     "further name that requests may have in the header Host; may be repeated, or be a list with "
     "commas"},
    {"allow-origin", SRV_LIST, MEMBER(policy.origins), "", "ORIGIN", 0, 0,
     "origin (https://name) whose web pages may read and change meshes; may be repeated, or be a "
     "list with commas"},
    {"allow-frame", SRV_LIST, MEMBER(frames), "", "ORIGIN", 0, 0,
     "origin (https://name) whose web pages may show the viewer in a frame; may be repeated, or be "
     "a list with commas"},
    {"trusted-proxy", SRV_LIST, MEMBER(trusted_proxies), "", "ADDRESS", 0, 0,
     "reverse proxy whose headers Forwarded, X-Forwarded-For and X-Forwarded-Proto are trusted: an "
     "IP address, a network (10.0.0.0/8), or unix for all clients of the Unix socket; may be "
     "repeated, or be a list with commas"},
    {"web", SRV_TEXT, MEMBER(web), "", "DIR", 0, 0,
     "folder of the built web page; if not given, the daemon looks for it relative to its "
     "executable"},
    {"store", SRV_TEXT, MEMBER(store), "sqlite:./hedge-data", "memory|sqlite:DIR", 0, 0,
     "where meshes are kept. memory: only in memory, until the daemon stops; sqlite:DIR: on the "
     "disk, in a folder that is created if it is missing"},
    {"samples", SRV_FLAG, MEMBER(samples), "0", NULL, 0, 0,
     "create a few sample meshes if the store is new"},
    {"log", SRV_CHOICE, MEMBER(log), "auto", "auto|access|off", 0, 0,
     "access: log a line for each request on stderr; off: log no requests; auto: log requests only "
     "if stderr is not a terminal"},
    {"log-format", SRV_CHOICE, MEMBER(log_format), "auto", "auto|text|json", 0, 0,
     "format of the log on stderr. auto: text on a terminal, else json. The line that says where "
     "hedged listens is always plain text"},
    {"log-level", SRV_CHOICE, MEMBER(log_level), "info", "error|warning|info|debug", 0, 0,
     "log only messages that are at least this severe; the lines of --log do not depend on it"},
    {"slow", SRV_COUNT, MEMBER(slow), "0", "MS", 0, 86400000,
     "log each request that takes longer than this many milliseconds, with the parts of its time; "
     "0: never"},
    {"max-upload", SRV_BYTES, MEMBER(max_upload), "1G", "BYTES", KIB, TIB,
     "largest mesh document or file that can be uploaded, compressed or decompressed"},
    {"memory-budget", SRV_BYTES, MEMBER(memory_budget), "0", "BYTES", 0, TIB,
     "memory that the daemon may use; 0: three quarters of the machine's memory or, if a control "
     "group of the daemon has a lower limit, of that limit"},
    {"undo-budget", SRV_BYTES, MEMBER(undo_budget), "256M", "BYTES", 0, TIB,
     "memory for the undo history of each mesh; when it is used up, the oldest edits are dropped; "
     "0: no edit can be undone"},
    {"no-compression", SRV_FLAG, MEMBER(no_compression), "0", NULL, 0, 0, "never compress answers"},
    {"max-meshes", SRV_COUNT, MEMBER(max_meshes), "10000000", "N", 1, 10000000,
     "meshes that the store may have; further meshes are answered 507"},
    {"workers", SRV_COUNT, MEMBER(workers), "0", "N", 0, 64,
     "threads that serve connections; 0: one for each core"},
    {"jobs", SRV_COUNT, MEMBER(jobs), "0", "N", 0, 64,
     "at most N jobs and at most N long reads (checks, queries, exports) run at the same time, but "
     "together at most N + 1 of them; 0: N is the number of cores, but at least 2. Another thread "
     "is reserved for imports and edits. A single job can use all cores"},
    {"job-queue", SRV_COUNT, MEMBER(job_queue), "256", "N", 1, 100000,
     "at most N jobs, at most N long reads, and at most N imports and edits wait for a thread; "
     "further requests are answered 503"},
    {"read-seconds", SRV_COUNT, MEMBER(read_seconds), "30", "SECONDS", 1, 86400,
     "longest time that a check, a query, a traversal or an export may compute while its client "
     "waits; after this time the request is answered 503. Jobs have no such limit"},
    {"max-connections", SRV_COUNT, MEMBER(max_connections), "10000", "N", 1, 1000000,
     "open connections of all clients; further connections are answered 503"},
    {"max-listeners", SRV_COUNT, MEMBER(max_listeners), "5000", "N", 0, 1000000,
     "open event streams of all meshes; further streams are answered 503. 0: none are allowed"},
    {"max-mesh-listeners", SRV_COUNT, MEMBER(max_mesh_listeners), "2000", "N", 0, 1000000,
     "open event streams of each mesh; further streams are answered 503. 0: none are allowed"},
    {"heartbeat", SRV_COUNT, MEMBER(heartbeat), "15", "SECONDS", 1, 3600,
     "an event stream sends a comment after this long without an event"},
    {"idle-timeout", SRV_COUNT, MEMBER(idle_timeout), "30", "SECONDS", 1, 86400,
     "a connection is closed after this long without a request"},
    {"header-timeout", SRV_COUNT, MEMBER(header_timeout), "10", "SECONDS", 1, 86400,
     "time in which the headers of a request, or a TLS handshake, must be complete"},
    {"body-grace", SRV_COUNT, MEMBER(body_grace), "10", "SECONDS", 1, 86400,
     "time after which --min-rate applies to the body of a request; for an answer, the time over "
     "which its rate is measured"},
    {"min-rate", SRV_BYTES, MEMBER(min_rate), "4K", "BYTES", 0, TIB,
     "bytes per second that a client must send or receive on average, else its connection is "
     "closed; 0: no minimum"},
    {"request-timeout", SRV_COUNT, MEMBER(request_timeout), "600", "SECONDS", 1, 86400,
     "time in which the whole body of a request must arrive"},
    {"backup", SRV_COMMAND, MEMBER(backup), "", "FILE", 0, 0,
     "write a backup of the store to FILE and exit; a daemon may be using the store"},
    {"restore", SRV_COMMAND, MEMBER(restore), "", "FILE", 0, 0,
     "replace the store by the backup FILE and exit; no daemon may be using the store"},
    {"verify", SRV_ACTION, MEMBER(verify), "0", "[FILE]", 0, 0,
     "read every mesh of the store, or of the backup FILE, print what is damaged, and exit with "
     "status 0 if nothing is damaged"},
    {"dump", SRV_COMMAND, MEMBER(dump), "", "DIR", 0, 0,
     "write every mesh of the store to a GLB file in DIR, a damaged mesh at its last undamaged "
     "revision, and exit"},
    {"new-token", SRV_ACTION, MEMBER(new_token), "0", "[NAME [ROLE]]", 0, 0,
     "print a new token, which is stored nowhere else, and its line for the file of --tokens, and "
     "exit. ROLE is read (if not given), write, admin or metrics"},
    {"healthcheck", SRV_ACTION, MEMBER(healthcheck), "0", "[URL]", 0, 0,
     "request /livez from a running daemon, at URL or at the address of --listen, and exit with "
     "status 0 if the daemon answers"},
    {"print-config", SRV_ACTION, MEMBER(print_config), "0", NULL, 0, 0,
     "print the options in effect and exit"},
    {"version", SRV_ACTION, MEMBER(version), "0", NULL, 0, 0,
     "print the version and the commit it was built from, and exit; short form: -V"},
    {"help", SRV_ACTION, MEMBER(help), "0", NULL, 0, 0, "print this help and exit; short form: -h"},
};

enum { OPTIONS = sizeof srv_options / sizeof *srv_options };
_Static_assert((int)OPTIONS <= (int)SRV_MOST_OPTIONS,
               "SRV_MOST_OPTIONS must be at least the number of options");
const size_t srv_option_count = OPTIONS;

static void *member_of(srv_config *config, const srv_option *row)
{
    return (char *)config + row->member;
}

static bool read_list(srv_config *config, const srv_option_value *given, char *message, size_t size)
{
    srv_names *names = member_of(config, given->row);
    size_t length = strlen(given->text);
    char *copy = he_mem_alloc(length + 1);
    if (copy == NULL || config->owned_count == SRV_MAX_LISTS) {
        he_mem_free(copy);
        snprintf(message, size, "%s is given too often", given->source);
        return false;
    }
    memcpy(copy, given->text, length + 1);
    config->owned[config->owned_count++] = copy;
    for (char *item = copy; item != NULL;) {
        char *comma = strchr(item, ',');
        if (comma != NULL) {
            *comma = '\0';
        }
        item += strspn(item, " \t");
        for (size_t left = strlen(item); left > 0 && strchr(" \t", item[left - 1]) != NULL;) {
            item[--left] = '\0';
        }
        if (*item != '\0') {
            if (names->count == SRV_MAX_NAMES) {
                snprintf(message, size, "%s takes at most %d names", given->source, SRV_MAX_NAMES);
                return false;
            }
            names->items[names->count++] = item;
        }
        item = comma == NULL ? NULL : comma + 1;
    }
    return true;
}

static bool read_switch(const char *text, bool *out)
{
    bool on = strcmp(text, "1") == 0 || strcmp(text, "true") == 0;
    if (!on && strcmp(text, "0") != 0 && strcmp(text, "false") != 0) {
        return false;
    }
    *out = on;
    return true;
}

static bool read_value(srv_config *config, const srv_option_value *given, char *message,
                       size_t size)
{
    const srv_option *row = given->row;
    const char *text = given->text, *source = given->source;
    void *member = member_of(config, row);
    uint64_t number = 0;
    bool on;
    switch (row->kind) {
    case SRV_COMMAND:
        if (text[0] == '\0') {
            snprintf(message, size, "%s needs a value, %s", source, row->argument);
            return false;
        }
        memcpy(member, &text, sizeof text);
        return true;
    case SRV_TEXT:
    case SRV_SOURCE:
        memcpy(member, &text, sizeof text);
        return true;
    case SRV_LIST:
        return read_list(config, given, message, size);
    case SRV_BYTES:
    case SRV_COUNT:
        if (!api_amount_parse(text, strlen(text), row->kind == SRV_BYTES, &number) ||
            number < row->low || number > row->high) {
            snprintf(message, size,
                     "%s takes a number from %" PRIu64 " to %" PRIu64 "%s, not \"%s\"", source,
                     row->low, row->high,
                     row->kind == SRV_BYTES ? " (K, M, G and T are units)" : "", text);
            return false;
        }
        memcpy(member, &number, sizeof number);
        return true;
    case SRV_FLAG:
    case SRV_ACTION:
        if (!read_switch(text, &on)) {
            snprintf(message, size, "%s takes 0 or 1, not \"%s\"", source, text);
            return false;
        }
        memcpy(member, &on, sizeof on);
        return true;
    case SRV_CHOICE:
        break;
    }
    if (srv_option_choice(row, text, &number)) {
        memcpy(member, &number, sizeof number);
        return true;
    }
    snprintf(message, size, "%s takes %s, not \"%s\"", source, row->argument, text);
    return false;
}

/* Finds the index of a word that an option allows. The words are those of the option's placeholder
 * in --help, separated by '|'. */
bool srv_option_choice(const srv_option *row, const char *text, uint64_t *out)
{
    const size_t length = strlen(text);
    uint64_t number = 0;
    for (const char *word = row->argument; word != NULL; number++) {
        const size_t size = strcspn(word, "|");
        if (size == length && memcmp(word, text, size) == 0) {
            *out = number;
            return true;
        }
        word = word[size] == '|' ? word + size + 1 : NULL;
    }
    return false;
}

void srv_option_variable(const srv_option *row, char out[SRV_VARIABLE_TEXT])
{
    size_t at = (size_t)snprintf(out, 64, "HEDGE_");
    for (const char *c = row->name; *c != '\0'; c++) {
        out[at++] = *c == '-' ? '_' : (char)(*c - 'a' + 'A');
    }
    out[at] = '\0';
}

const srv_option *srv_option_find(const char *name, size_t length)
{
    for (size_t i = 0; i < OPTIONS; i++) {
        if (strlen(srv_options[i].name) == length &&
            memcmp(srv_options[i].name, name, length) == 0) {
            return &srv_options[i];
        }
    }
    return NULL;
}

bool srv_option_is_setting(const srv_option *row)
{
    return row->kind != SRV_ACTION && row->kind != SRV_COMMAND && row->kind != SRV_SOURCE;
}

bool srv_option_is_switch(const srv_option *row)
{
    return row->kind == SRV_FLAG || row->kind == SRV_ACTION;
}

/* Prepares an option for a value from one source (the file, the environment or the flags): if the
 * value is the source's first item of a list, removes the items that came from other sources. */
static void begin_list(srv_config *config, const srv_option *row, bool *seen)
{
    size_t i = (size_t)(row - srv_options);
    if (row->kind == SRV_LIST && !seen[i]) {
        srv_names *names = member_of(config, row);
        names->count = 0;
    }
    seen[i] = true;
}

bool srv_option_set(srv_config *config, const srv_option_value *given, bool *seen, char *message,
                    size_t size)
{
    begin_list(config, given->row, seen);
    return read_value(config, given, message, size);
}

static bool read_environment(srv_config *config, char *(*environment)(const char *name),
                             char *message, size_t size)
{
    bool seen[OPTIONS] = {false};
    for (size_t i = 0; i < OPTIONS; i++) {
        const srv_option *row = &srv_options[i];
        if (!srv_option_is_setting(row) && row->kind != SRV_SOURCE) {
            continue;
        }
        char variable[SRV_VARIABLE_TEXT];
        srv_option_variable(row, variable);
        const srv_option_value given = {row, environment(variable), variable};
        if (given.text != NULL && *given.text != '\0' &&
            !srv_option_set(config, &given, seen, message, size)) {
            return false;
        }
    }
    return true;
}

/* Returns the long form of "-h" and "-V", which are the only short options, and any other argument
 * unchanged. */
static const char *spelled_out(const char *argument)
{
    return strcmp(argument, "-h") == 0   ? "--help"
           : strcmp(argument, "-V") == 0 ? "--version"
                                         : argument;
}

static bool read_flags(srv_config *config, int argc, char *const *argv, char *message, size_t size)
{
    bool seen[OPTIONS] = {false};
    for (int i = 0; i < argc; i++) {
        const char *argument = spelled_out(argv[i]);
        if (strncmp(argument, "--", 2) != 0) {
            if (config->healthcheck && config->healthcheck_url == NULL) {
                config->healthcheck_url = argument;
                continue;
            }
            if (config->verify && config->verified == NULL) {
                config->verified = argument;
                continue;
            }
            if (config->new_token && config->token_role == NULL) {
                *(config->token_name == NULL ? &config->token_name : &config->token_role) =
                    argument;
                continue;
            }
            snprintf(message, size, "\"%s\" is not an option; --help lists them", argument);
            return false;
        }
        size_t length = strcspn(argument + 2, "=");
        const srv_option *row = srv_option_find(argument + 2, length);
        if (row == NULL) {
            snprintf(message, size, "there is no option %s; --help lists them", argument);
            return false;
        }
        char source[64];
        snprintf(source, sizeof source, "--%s", row->name);
        const char *value = argument[2 + length] == '=' ? argument + 3 + length : NULL;
        if (value == NULL && srv_option_is_switch(row)) {
            value = "1";
        } else if (value == NULL && i + 1 < argc) {
            value = argv[++i];
        }
        if (value == NULL) {
            snprintf(message, size, "%s needs a value, %s", source, row->argument);
            return false;
        }
        const srv_option_value given = {row, value, source};
        if (!srv_option_set(config, &given, seen, message, size)) {
            return false;
        }
    }
    return true;
}

const char *srv_config_folder(const srv_config *config)
{
    static const char scheme[] = "sqlite:";
    const size_t length = sizeof scheme - 1;
    return strncmp(config->store, scheme, length) == 0 ? config->store + length : NULL;
}

static bool find_proxies(srv_config *config, char *message, size_t size)
{
    for (size_t i = 0; i < config->trusted_proxies.count; i++) {
        const char *text = config->trusted_proxies.items[i];
        if (!srv_proxies_add(&config->policy.proxies, text)) {
            snprintf(message, size,
                     "--trusted-proxy takes an address, a network such as 10.0.0.0/8, or unix, not "
                     "\"%s\"",
                     text);
            return false;
        }
    }
    return true;
}

void srv_config_url(const srv_config *config, const char *listen, char out[SRV_URL_TEXT])
{
    listen = listen == NULL ? config->listen : listen;
    const char *scheme = strncmp(listen, "unix:", 5) == 0 ? ""
                         : config->tls_cert[0] != '\0'    ? "https://"
                                                          : "http://";
    snprintf(out, SRV_URL_TEXT, "%s%s", scheme, listen);
}

static bool check_listen(const srv_config *config, srv_address *address, char *message, size_t size)
{
    const bool tls = config->tls_cert[0] != '\0';
    if (!srv_address_parse(config->listen, address)) {
        snprintf(message, size,
                 "--listen takes an address and a port such as 127.0.0.1:8080 or [::1]:0, or unix: "
                 "and a path of 1 to %d bytes, not \"%s\"",
                 SRV_MAX_PATH, config->listen);
        return false;
    }
    if (tls != (config->tls_key[0] != '\0')) {
        snprintf(message, size, "%s needs %s: a certificate and its key belong together",
                 tls ? "--tls-cert" : "--tls-key", tls ? "--tls-key" : "--tls-cert");
        return false;
    }
    if (tls && srv_address_path(address) != NULL) {
        snprintf(message, size,
                 "--tls-cert needs a network address in --listen: connections over a Unix socket "
                 "are not encrypted");
        return false;
    }
    return true;
}

/* Returns true if the text is a name, an IPv4 address, or an IPv6 address in brackets, and perhaps
 * ':' and a port. */
static bool is_authority(const char *text)
{
    static const char letters[] =
        "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789.-";
    static const char digits[] = "0123456789";
    const bool bracketed = text[0] == '[';
    const char *name = text + bracketed;
    const size_t length = strspn(name, bracketed ? "0123456789abcdefABCDEF:." : letters);
    const char *end = name + length;
    if (length == 0 || (bracketed && *end++ != ']')) {
        return false;
    }
    const size_t port = end[0] == ':' ? strspn(end + 1, digits) : 0;
    return end[0] == '\0' || (port > 0 && end[1 + port] == '\0');
}

/* Returns true if the text is the origin of a page: http:// or https://, a name or an address, and
 * perhaps a port. Anything else could add words to the policy of the viewer, where it is written.
 */
static bool is_origin(const char *text)
{
    const size_t scheme = strncmp(text, "https://", 8) == 0  ? 8
                          : strncmp(text, "http://", 7) == 0 ? 7
                                                             : 0;
    return scheme > 0 && strlen(text) <= SRV_MAX_ORIGIN && is_authority(text + scheme);
}

static bool check_frames(const srv_config *config, char *message, size_t size)
{
    for (size_t i = 0; i < config->frames.count; i++) {
        if (!is_origin(config->frames.items[i])) {
            snprintf(message, size,
                     "--allow-frame takes the origin of a page such as https://example.org, not "
                     "\"%.200s\"",
                     config->frames.items[i]);
            return false;
        }
    }
    return true;
}

static bool check(const srv_config *config, char *message, size_t size)
{
    srv_address address;
    const char *folder = srv_config_folder(config);
    if (folder == NULL ? strcmp(config->store, "memory") != 0 : folder[0] == '\0') {
        snprintf(message, size, "--store takes memory or sqlite:DIR, not \"%s\"", config->store);
        return false;
    }
    if (!check_listen(config, &address, message, size) || !check_frames(config, message, size)) {
        return false;
    }
    const bool serves = !config->healthcheck && !config->print_config && !config->verify &&
                        !config->new_token && config->backup == NULL && config->restore == NULL &&
                        config->dump == NULL;
    if (serves && !srv_address_is_local(&address) && config->tokens[0] == '\0' &&
        !config->insecure) {
        snprintf(message, size,
                 "%s can be reached from other machines and requests need no token: give a file "
                 "with --tokens, or set --insecure to listen on this address anyway",
                 config->listen);
        return false;
    }
    return true;
}

/* Sets the defaults, then reads the configuration file, the environment and the arguments, in this
 * order. `file` is NULL if there is no configuration file. */
static bool read_places(srv_config *config, const srv_config_sources *from, const char *file,
                        char *message, size_t size)
{
    *config = (srv_config){0};
    bool ok = true;
    for (size_t i = 0; i < OPTIONS && ok; i++) {
        const srv_option *row = &srv_options[i];
        const srv_option_value given = {row, row->fallback, row->name};
        ok = row->kind == SRV_COMMAND || read_value(config, &given, message, size);
    }
    return ok && (file == NULL || srv_config_read_file(config, file, message, size)) &&
           read_environment(config, from->environment, message, size) &&
           read_flags(config, from->argc, from->argv, message, size);
}

/* Reads the configuration. Flags and environment are read twice: once because they name the
 * configuration file, and once after the file, because they override it. */
bool srv_config_read(srv_config *config, const srv_config_sources *from, char *message, size_t size)
{
    bool ok = read_places(config, from, NULL, message, size);
    uint64_t format = config->log_format;
    if (ok && config->config[0] != '\0') {
        const char *file = config->config;
        srv_config_clear(config);
        ok = read_places(config, from, file, message, size);
        format = ok ? config->log_format : format;
    }
    ok = ok && (config->help || config->version ||
                (check(config, message, size) && find_proxies(config, message, size)));
    if (!ok) {
        srv_config_clear(config);
        config->log_format = format;
    }
    return ok;
}

void srv_config_clear(srv_config *config)
{
    for (unsigned i = 0; i < config->owned_count; i++) {
        he_mem_free(config->owned[i]);
    }
    he_mem_free(config->file_text);
    *config = (srv_config){0};
}
