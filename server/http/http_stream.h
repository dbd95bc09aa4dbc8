/* http_stream.h - streams of events (api/live.h): suspends their connections while there is nothing
 * to send, and resumes them.
 *
 * A stream belongs to the worker thread (PULLED) while the worker reads events from its source and
 * sends them. When the source has nothing to send, the worker suspends the connection and puts the
 * stream aside (ASIDE). From then on the stream belongs to this module, whose thread has the
 * connection resumed, exactly once: when the source calls wake, when a heartbeat is due because
 * nothing was sent for some time, when the client has closed its side, or when the server stops.
 *
 *     PULLED --srv_stream_read returns API_READ_WAIT, then srv_stream_aside--> ASIDE
 *       ^                                                                    |
 *       +--- `resume`, called by the thread: wake, heartbeat, closed, stop --+
 *
 * libmicrohttpd does not notice that the client of a suspended connection has closed its side, so
 * the thread watches the socket. After it was resumed, srv_stream_read fails for such a stream, and
 * the connection is closed. */
#ifndef HE_SERVER_HTTP_HTTP_STREAM_H
#define HE_SERVER_HTTP_HTTP_STREAM_H

#include "api/live.h"

#include <stdbool.h>

typedef struct srv_streams srv_streams;

/* One stream of events. It is stored in its request. */
typedef struct srv_stream {
    srv_streams *streams; /* NULL before srv_stream_begin */
    const api_source *source;
    void (*resume)(struct srv_stream *stream);
    bool aside;
    bool woken;    /* true if the source has called wake while the worker thread owned the stream */
    bool due;      /* true if a heartbeat must be sent when there is nothing else to send */
    bool finished; /* whether the source was told that the server stops */
    bool gone;     /* whether the client has closed its side of the connection */
    int socket;
    uint64_t deadline; /* when a heartbeat is due */
    struct srv_stream *next, *previous;
} srv_stream;

/* Makes the object that all streams share, and starts its thread. Returns NULL when memory,
 * descriptors or threads are out. */
srv_streams *srv_streams_new(uint64_t heartbeat_micros);
/* Ends the thread and frees the object, which must have no streams any more. */
void srv_streams_free(srv_streams *streams);

/* Begins a stream that sends the events of `source`. The thread calls `resume` once after each call
 * of srv_stream_aside. `socket` is the socket of the connection, on which the thread notices that
 * the client closes its side, or -1. */
void srv_stream_begin(srv_streams *streams, srv_stream *stream, const api_source *source,
                      int socket, void (*resume)(srv_stream *stream));
/* Ends a stream, before its storage and its socket are freed. The stream must not be ASIDE
 * (srv_stream_aside). Does nothing if the stream was not begun. */
void srv_stream_end(srv_stream *stream);
/* Reads bytes to send, like the member `read` of api_source; returns -1 also if the client has
 * closed its side. After API_READ_WAIT the caller must suspend the connection, call
 * srv_stream_aside, and not touch the request afterwards. */
int64_t srv_stream_read(srv_stream *stream, char *buffer, size_t size);
void srv_stream_aside(srv_stream *stream);

/* Ends all streams because the server stops; each sends its closing message. */
void srv_streams_stop(srv_streams *streams);

#endif
