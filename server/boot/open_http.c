#include "server/boot/parts.h"

#include "server/boot/resources.h"
#include "server/version.h"

#include <string.h>
#include <unistd.h>

/* Allows requests whose Host header names the address on which the daemon listens. */
static void allow_own_host(srv_parts *parts, const srv_address *address)
{
    srv_names *hosts = &parts->policy.hosts;
    srv_address_format(&address->socket.any, false, parts->own_host);
    if (srv_address_path(address) == NULL && hosts->count < SRV_MAX_NAMES &&
        strcmp(parts->own_host, "0.0.0.0") != 0 && strcmp(parts->own_host, "::") != 0) {
        hosts->items[hosts->count++] = parts->own_host;
    }
}

/* Prints that the daemon is ready. Programs wait for the first line. The second line is for a
 * person at a terminal: it names localhost if the daemon listens on all addresses, since a browser
 * would send 0.0.0.0 as the Host, which is refused. */
static void tell_ready(const srv_parts *parts)
{
    char port[SRV_URL_TEXT];
    const char *text = parts->url;
    srv_log_plain(parts->log, "hedged " SRV_VERSION ": listening on %s", parts->url);
    if (srv_log_get(parts->log).json || isatty(STDERR_FILENO) == 0) {
        return;
    }
    if (parts->socket.path[0] != '\0') {
        srv_log_plain(
            parts->log,
            "curl --unix-socket %s http://localhost/v1/meshes asks hedge; Ctrl-C stops it",
            parts->socket.path);
        return;
    }
    if (strcmp(parts->own_host, "0.0.0.0") == 0 || strcmp(parts->own_host, "::") == 0) {
        snprintf(port, sizeof port, "%s://localhost:%u",
                 parts->certificates == NULL ? "http" : "https", srv_http_port(parts->http));
        text = port;
    }
    srv_log_plain(parts->log, "hedge is at %s/ - open it in a browser; Ctrl-C stops it", text);
}

bool srv_open_certificates(srv_parts *parts)
{
    char message[640];
    const srv_config *config = parts->config;
    if (config->tls_cert[0] == '\0') {
        return true;
    }
    parts->certificates = srv_certificates_new();
    if (parts->certificates == NULL) {
        return srv_open_failed(parts, "no memory to start");
    }
    return srv_certificates_read(parts->certificates, config->tls_cert, config->tls_key, message,
                                 sizeof message) ||
           srv_open_failed(parts, message);
}

/* Stores the daemon's URL, with the port that is in use. */
static void name_url(srv_parts *parts, srv_address *address)
{
    char text[SRV_ADDRESS_TEXT];
    if (srv_address_path(address) == NULL) {
        srv_address_set_port(address, srv_http_port(parts->http));
    }
    srv_address_format(&address->socket.any, true, text);
    srv_config_url(parts->config, text, parts->url);
}

bool srv_open_http(srv_parts *parts)
{
    char message[256];
    srv_http_options options = {
        .service = parts->service,
        .store = parts->store,
        .pool = parts->pool,
        .makers = parts->makers,
        .log = parts->log,
        .policy = &parts->policy,
        .address_connections = (size_t)parts->config->address_limits.most[API_LIMIT_CONNECTIONS],
        .certificates = parts->certificates,
        .listening = -1,
        .read_seconds = parts->config->read_seconds,
        .heartbeat_micros = parts->config->heartbeat * 1000000,
    };
    if (!srv_address_parse(parts->config->listen, &options.address)) {
        return srv_open_failed(parts, "the address in --listen is not valid");
    }
    parts->policy = parts->config->policy;
    allow_own_host(parts, &options.address);
    srv_choose_connections(parts->config, &options);
    if (srv_address_path(&options.address) != NULL) {
        options.listening =
            srv_unix_listen(&options.address, SRV_BACKLOG, &parts->socket, message, sizeof message);
        if (options.listening < 0) {
            return srv_open_failed(parts, message);
        }
    }
    atomic_store(&parts->ready, true);
    parts->http = srv_http_start(&options, message, sizeof message);
    if (parts->http == NULL) {
        srv_unix_remove(&parts->socket);
        return srv_open_failed(parts, message);
    }
    name_url(parts, &options.address);
    tell_ready(parts);
    return true;
}
