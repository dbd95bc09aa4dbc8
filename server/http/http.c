#include "server/http/http.h"

#include "base/mem.h"
#include "server/http/http_buffer.h"
#include "server/http/http_handle.h"
#include "server/http/http_recv.h"
#include "server/http/http_request.h"
#include "server/http/limits.h"
#include "system/memory.h"

#include <errno.h>
#include <stdio.h>
#include <string.h>
#include <sys/socket.h>

_Static_assert(
    SRV_MAX_POOLED + 4 * 1024 <= SRV_BUFFER_BYTES,
    "the buffer of a connection must have space beside headers of the largest allowed size");

/* --- callbacks of libmicrohttpd --- */

static void *request_begin(void *context, const char *uri, struct MHD_Connection *connection)
{
    return srv_request_begin(context, uri, connection);
}

static enum MHD_Result handle(void *context, struct MHD_Connection *connection, const char *url,
                              const char *method, const char *version, const char *upload,
                              size_t *upload_size, void **slot)
{
    (void)context;
    (void)connection;
    (void)url;
    srv_request *r = *slot;
    bool goes_on = r != NULL && srv_request_handle(r, method, version, upload, upload_size);
    return goes_on ? MHD_YES : MHD_NO;
}

static void request_completed(void *context, struct MHD_Connection *connection, void **slot,
                              enum MHD_RequestTerminationCode how)
{
    (void)context;
    (void)connection;
    (void)how;
    srv_request *r = *slot;
    *slot = NULL;
    if (r != NULL) {
        srv_request_end(r);
    }
}

/* Leaves percent-escapes in a path as they are, because they must be decoded after the path was
 * split into segments. */
static size_t keep_escapes(void *context, struct MHD_Connection *connection, char *text)
{
    (void)context;
    (void)connection;
    return strlen(text);
}

/* Counts a new connection of its client's address. If that address has too many connections, the
 * connection gets one answer, which says so, and is closed. Connections of a trusted proxy are not
 * counted, because the proxy uses them for all its clients. */
static void count_peer(srv_http *http, srv_connection *c)
{
    size_t count;
    if (http->peers != NULL && !c->is_proxy) {
        c->of_peer = srv_peers_enter(http->peers, &c->client, &count);
        atomic_store(&c->beyond, count > http->options.address_connections);
    }
}

static void connection_changed(void *context, struct MHD_Connection *connection, void **slot,
                               enum MHD_ConnectionNotificationCode what)
{
    srv_http *http = context;
    if (what == MHD_CONNECTION_NOTIFY_STARTED) {
        int fd = MHD_get_connection_info(connection, MHD_CONNECTION_INFO_CONNECTION_FD)->connect_fd;
        const int most = SRV_FIRST_SEND_BUFFER;
        setsockopt(fd, SOL_SOCKET, SO_SNDBUF, &most, sizeof most);
        const struct sockaddr *peer =
            MHD_get_connection_info(connection, MHD_CONNECTION_INFO_CLIENT_ADDRESS)->client_addr;
        gnutls_session_t session = NULL;
        if (http->options.certificates != NULL) {
            session = MHD_get_connection_info(connection, MHD_CONNECTION_INFO_GNUTLS_SESSION)
                          ->tls_session;
        }
        srv_connection *c =
            srv_deadlines_add(http->deadlines, fd, peer, session, srv_buffer_taken());
        *slot = c;
        if (c != NULL) {
            c->certificates = http->options.certificates;
            c->is_proxy = srv_proxies_has(&http->options.policy->proxies, c->peer);
            count_peer(http, c);
        }
        api_count(api_metrics_of(http->options.service), API_COUNT_OPENED);
        if (c == NULL || !srv_recv_watch(c)) {
            /* The bytes of this connection cannot be checked (http_recv.h), so the connection is
             * not served: its socket is shut down, and libmicrohttpd sees the end of the stream at
             * once. */
            shutdown(fd, SHUT_RDWR);
        }
    } else {
        srv_connection *c = *slot;
        api_metrics *metrics = api_metrics_of(http->options.service);
        if (c != NULL && atomic_load(&c->stage) == SRV_STAGE_HANDSHAKE) {
            api_count(metrics, API_COUNT_HANDSHAKES_FAILED);
        }
        if (c != NULL) {
            srv_recv_forget(c->socket);
            srv_peers_leave(http->peers, c->of_peer);
            srv_certificate_release(c->certificate);
        }
        srv_deadlines_remove(http->deadlines, c);
        api_count(metrics, API_COUNT_CLOSED);
        *slot = NULL;
    }
}

/* Decides whether a new connection is accepted. Refuses connections beyond the number that can
 * still be answered 503, connections for which there is no memory, and all connections when the
 * server is stopping. */
static enum MHD_Result accept_policy(void *context, const struct sockaddr *peer, socklen_t length)
{
    (void)peer;
    (void)length;
    const srv_http *http = context;
    api_metrics *metrics = api_metrics_of(http->options.service);
    if (atomic_load(&http->stopping)) {
        api_count(metrics, API_COUNT_REFUSED_STOPPING);
    } else if (srv_deadlines_count(http->deadlines) >= http->options.max_sockets) {
        api_count(metrics, API_COUNT_REFUSED_LIMIT);
    } else if (!st_memory_has(SRV_BUFFER_BYTES)) {
        api_count(metrics, API_COUNT_REFUSED_MEMORY);
    } else {
        return MHD_YES;
    }
    return MHD_NO;
}

/* Sets the outputs to the certificate and the key for a handshake; gnutls may call this twice for
 * one handshake. The connection keeps a reference to the pair. */
static int show_certificate(gnutls_session_t session, const struct gnutls_cert_retr_st *info,
                            gnutls_pcert_st **chain, unsigned int *length,
                            gnutls_ocsp_data_st **ocsp, unsigned int *ocsp_length,
                            gnutls_privkey_t *key, unsigned int *flags)
{
    (void)info;
    srv_connection *c = srv_recv_find(session);
    if (c == NULL) {
        return -1;
    }
    if (c->certificate == NULL) {
        c->certificate = srv_certificates_hold(c->certificates);
    }
    srv_certificate_show(c->certificate, chain, length, key);
    *ocsp = NULL;
    *ocsp_length = 0;
    *flags = 0;
    return 0;
}

/* --- the daemon --- */

static struct MHD_Daemon *start_daemon(srv_http *http)
{
    const srv_http_options *o = &http->options;
    unsigned flags = MHD_USE_EPOLL_INTERNAL_THREAD | MHD_ALLOW_SUSPEND_RESUME;
    if (o->address.socket.any.sa_family == AF_INET6) {
        flags |= MHD_USE_IPv6;
    }
    const bool tls = o->certificates != NULL;
    if (tls) {
        flags |= MHD_USE_TLS;
    }
    struct MHD_OptionItem numbers[] = {
        /* In strict mode libmicrohttpd would refuse some requests with answers of its own; faulty
         * requests are found before by http_syntax.h. */
        {MHD_OPTION_STRICT_FOR_CLIENT, 0, NULL},
        {MHD_OPTION_CONNECTION_MEMORY_LIMIT, SRV_BUFFER_BYTES, NULL},
        /* libmicrohttpd divides this limit by the number of worker threads, but one worker may get
         * all connections, so the limit is multiplied by that number. */
        {MHD_OPTION_CONNECTION_LIMIT, (intptr_t)(o->max_sockets * o->workers), NULL},
        {MHD_OPTION_CONNECTION_TIMEOUT, (intptr_t)o->deadlines.idle + 1, NULL},
        {MHD_OPTION_LISTEN_BACKLOG_SIZE, SRV_BACKLOG, NULL},
        {MHD_OPTION_END, 0, NULL},
        {MHD_OPTION_END, 0, NULL},
        {MHD_OPTION_END, 0, NULL},
    };
    struct MHD_OptionItem *last = numbers + sizeof numbers / sizeof *numbers - 3;
    if (o->workers > 1) { /* libmicrohttpd does not accept a pool of one thread */
        *last++ = (struct MHD_OptionItem){MHD_OPTION_THREAD_POOL_SIZE, (intptr_t)o->workers, NULL};
    }
    if (o->listening >= 0) {
        *last++ = (struct MHD_OptionItem){MHD_OPTION_LISTEN_SOCKET, o->listening, NULL};
    }
    return MHD_start_daemon(
        flags, 0, accept_policy, http, handle, http, MHD_OPTION_ARRAY, numbers,
        MHD_OPTION_SOCK_ADDR, &o->address.socket.any, MHD_OPTION_UNESCAPE_CALLBACK, keep_escapes,
        NULL, MHD_OPTION_URI_LOG_CALLBACK, request_begin, http, MHD_OPTION_NOTIFY_COMPLETED,
        request_completed, NULL, MHD_OPTION_NOTIFY_CONNECTION, connection_changed, http,
        /* The options for TLS come last, because without TLS the list ends here. */
        tls ? MHD_OPTION_HTTPS_CERT_CALLBACK2 : MHD_OPTION_END, show_certificate,
        MHD_OPTION_HTTPS_PRIORITIES, srv_tls_priorities, MHD_OPTION_END);
}

static void http_free(srv_http *http)
{
    srv_streams_free(http->streams);
    srv_deadlines_free(http->deadlines);
    srv_peers_free(http->peers);
    srv_inflight_clear(&http->inflight);
    st_spares_clear(&http->requests);
    he_mem_free(http);
}

srv_http *srv_http_start(const srv_http_options *options, char *message, size_t size)
{
    srv_http *http = he_mem_zero(1, sizeof *http);
    if (http == NULL) {
        snprintf(message, size, "no memory to start the HTTP server");
        return NULL;
    }
    http->options = *options;
    srv_inflight_init(&http->inflight);
    srv_ids_init(&http->ids);
    srv_spans_init(&http->spans);
    http->options.deadlines.metrics = api_metrics_of(options->service);
    api_set_connection_limit(http->options.deadlines.metrics, options->deadlines.max_connections);
    http->deadlines = srv_deadlines_new(&http->options.deadlines);
    http->streams = srv_streams_new(options->heartbeat_micros);
    /* Each worker thread may have a buffer for one more connection, which is not counted yet or is
     * not counted any more. */
    const size_t most = options->max_sockets + options->workers;
    const bool counts = options->address_connections != 0;
    http->peers = counts ? srv_peers_new(most) : NULL;
    if (http->deadlines == NULL || http->streams == NULL || (counts && http->peers == NULL)) {
        snprintf(message, size,
                 "there is not enough memory, or there are not enough threads, to start");
        http_free(http);
        return NULL;
    }
    if (!srv_buffers_reserve(most)) {
        snprintf(message, size,
                 "the process has not enough address space for the buffers of %zu connections",
                 options->max_sockets);
        http_free(http);
        return NULL;
    }
    errno = 0;
    http->daemon = start_daemon(http);
    if (http->daemon == NULL) {
        char text[SRV_ADDRESS_TEXT];
        srv_address_format(&options->address.socket.any, true, text);
        snprintf(message, size, "cannot listen on %s: %s", text,
                 errno == 0 ? "the HTTP server could not be started" : strerror(errno));
        http_free(http);
        return NULL;
    }
    http->port = options->listening >= 0
                     ? 0
                     : MHD_get_daemon_info(http->daemon, MHD_DAEMON_INFO_BIND_PORT)->port;
    return http;
}

unsigned srv_http_port(const srv_http *http)
{
    return http->port;
}

bool srv_http_stop(srv_http *http, unsigned millis)
{
    if (http == NULL) {
        return true;
    }
    /* From now on accept_policy refuses all new connections. MHD_quiesce_daemon cannot be used to
     * stop accepting: it removes the listening socket from the workers' epoll sets while the
     * worker threads may do that, too, and the library aborts if both try. */
    atomic_store(&http->stopping, true);
    st_waits_stop(st_store_waits(http->options.store));
    srv_streams_stop(http->streams);
    /* Waits for running requests at most `millis`. After that time requests that are running but
     * not suspended do not prevent the stop. */
    if (!srv_inflight_close(&http->inflight, millis)) {
        return false;
    }
    MHD_stop_daemon(http->daemon);
    http_free(http);
    return true;
}

const char *srv_http_library(void)
{
    return MHD_get_version();
}
