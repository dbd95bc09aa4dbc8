/* http_live.h - answers that wait in the middle (api/live.h), and what wakes them.
 *
 * A stream is the worker's while it is pulled. When its source has nothing, the worker suspends the
 * connection and puts the stream aside; from then on it is this module's, whose thread has the
 * connection resumed, exactly once, when the source calls wake, when nothing was sent for a whole
 * heartbeat, or when the server stops.
 *
 *     PULLED --srv_live_read gives API_READ_WAIT, srv_live_aside--> ASIDE
 *       ^                                                             | wake, heartbeat, stop
 *       +------------- resume, by the thread (also: client gone) -----+
 *
 * libmicrohttpd does not look at a suspended connection, so the thread does: when the client has
 * closed its side the stream fails at its next pull, and its descriptor is free. */
#ifndef HE_SERVER_HTTP_HTTP_LIVE_H
#define HE_SERVER_HTTP_HTTP_LIVE_H

#include "api/live.h"

#include <stdbool.h>

typedef struct srv_live srv_live;

/* In the storage of the request. */
typedef struct srv_stream {
    srv_live *live; /* NULL: not begun */
    const api_source *source;
    const char *idle; /* what to send for a heartbeat */
    void (*resume)(struct srv_stream *stream);
    bool aside;
    bool woken;    /* while it was pulled */
    bool due;      /* for a heartbeat */
    bool finished; /* the source knows that the server stops */
    bool gone;     /* the client has closed */
    int socket;
    uint64_t deadline;
    struct srv_stream *next, *previous;
} srv_stream;

/* NULL when memory, descriptors or threads are out. */
srv_live *srv_live_new(uint64_t heartbeat_micros);
/* No stream may be left. */
void srv_live_free(srv_live *live);

/* `resume` is called by the thread for each srv_live_aside. `socket` is the client's, -1: nobody
 * looks whether it has gone. */
void srv_live_begin(srv_live *live, srv_stream *stream, const api_source *source, const char *idle,
                    int socket, void (*resume)(srv_stream *stream));
/* Before the stream's storage and socket go away; it is not aside. Does nothing where none began.
 */
void srv_live_end(srv_stream *stream);
/* As api_source's read, and -1 when the client has gone. After API_READ_WAIT the caller suspends
 * the connection and then calls srv_live_aside, and may touch nothing of the request after that. */
int64_t srv_live_read(srv_stream *stream, char *buffer, size_t size);
void srv_live_aside(srv_stream *stream);

/* The server stops: every stream says goodbye and ends. */
void srv_live_stop(srv_live *live);

#endif
