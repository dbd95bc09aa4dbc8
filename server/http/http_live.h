/* http_live.h - streams (api/live.h): suspending their connections and resuming them.
 *
 * A stream belongs to the worker while it is pulled. When its source has nothing to send, the
 * worker suspends the connection and puts the stream aside. From then on it belongs to this module,
 * whose thread has the connection resumed, exactly once: when the source calls wake, when nothing
 * was sent for a whole heartbeat, or when the server stops.
 *
 *     PULLED --srv_live_read gives API_READ_WAIT, srv_live_aside--> ASIDE
 *       ^                                                             | wake, heartbeat, stop
 *       +------------- resume, by the thread (also: client gone) -----+
 *
 * libmicrohttpd does not watch a suspended connection, so the thread does: when the client has
 * closed its side, the stream fails at its next pull, which frees its descriptor. */
#ifndef HE_SERVER_HTTP_HTTP_LIVE_H
#define HE_SERVER_HTTP_HTTP_LIVE_H

#include "api/live.h"

#include <stdbool.h>

typedef struct srv_live srv_live;

/* Stored in the request. */
typedef struct srv_stream {
    srv_live *live; /* NULL: not begun */
    const api_source *source;
    void (*resume)(struct srv_stream *stream);
    bool aside;
    bool woken;    /* woken while it was pulled */
    bool due;      /* a heartbeat is due */
    bool finished; /* the source was told that the server stops */
    bool gone;     /* the client has closed its side */
    int socket;
    uint64_t deadline;
    struct srv_stream *next, *previous;
} srv_stream;

/* Makes the object that streams share, with its thread. Returns NULL when memory, descriptors or
 * threads are out. */
srv_live *srv_live_new(uint64_t heartbeat_micros);
/* No stream may be left. */
void srv_live_free(srv_live *live);

/* Begins a stream. The thread calls `resume` once for each srv_live_aside. `socket` is the client's
 * socket, which is watched for the end of the connection; -1 means that it is not watched. */
void srv_live_begin(srv_live *live, srv_stream *stream, const api_source *source, int socket,
                    void (*resume)(srv_stream *stream));
/* Ends a stream, before its storage and its socket are freed; it must not be aside. Does nothing if
 * the stream was not begun. */
void srv_live_end(srv_stream *stream);
/* Reads like the read of api_source; returns -1 also when the client is gone. After API_READ_WAIT
 * the caller suspends the connection, calls srv_live_aside, and must not touch the request
 * afterwards. */
int64_t srv_live_read(srv_stream *stream, char *buffer, size_t size);
void srv_live_aside(srv_stream *stream);

/* Ends all streams because the server stops; each sends its closing message. */
void srv_live_stop(srv_live *live);

#endif
