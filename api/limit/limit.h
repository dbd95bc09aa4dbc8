/* limit.h - the one list of the limits that apply to each client.
 *
 * A client is a token. A request without a valid token (because the route is open, the server has
 * no tokens, or the token is unknown) counts for the address that it comes from. Options of the
 * server set the limits of every token and of every address; a line of the token file may set other
 * limits for its token (token_file.h). 0 is no limit.
 *
 *     limit        of      counts                                         answered
 *     requests     both    requests a second: rate.h                      429 rate_limit
 *     bytes        both    bytes of bodies a second, both ways: rate.h    429 rate_limit
 *     connections  address open connections                               429 too_many_connections
 *     jobs         token   queued and running jobs          429 too_many_jobs_of_token
 *     meshes       token   existing meshes that it made     507 quota
 *     mesh_bytes   token   memory of these meshes           507 quota */
#ifndef HE_API_LIMIT_LIMIT_H
#define HE_API_LIMIT_LIMIT_H

#include <stdatomic.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/* Each row: X(constant, name in the token file, true if it counts bytes, true if tokens can have
 * it) */
#define API_LIMIT_MAP(X)                        \
    X(REQUESTS, "requests", false, true)        \
    X(BYTES, "bytes", true, true)               \
    X(CONNECTIONS, "connections", false, false) \
    X(JOBS, "jobs", false, true)                \
    X(MESHES, "meshes", false, true)            \
    X(MESH_BYTES, "mesh-bytes", true, true)

typedef enum api_limit {
#define API_LIMIT_ENUM(constant, word, bytes, token) API_LIMIT_##constant,
    API_LIMIT_MAP(API_LIMIT_ENUM)
#undef API_LIMIT_ENUM
        API_LIMIT_COUNT
} api_limit;

/* The largest value of a limit that counts things (requests, jobs ...), and of one that counts
 * bytes. */
#define API_LIMIT_MOST       UINT64_C(1000000000)
#define API_LIMIT_MOST_BYTES (UINT64_C(1) << 40)

/* The largest burst: how many seconds' worth of requests and bytes a bucket may hold. */
enum { API_BURST_MOST = 3600 };

/* The most tokens, and the most addresses, that can have a bucket for their rates of requests and
 * bytes (rate.h) at one time. */
enum { API_TOKEN_RATES = 8192, API_ADDRESS_RATES = 65536 };

/* The limits of one client, indexed by api_limit; 0 is no limit. */
typedef struct api_limits {
    uint64_t most[API_LIMIT_COUNT];
} api_limits;

/* Returns the name of a limit in the token file and in metrics, such as "requests". */
const char *api_limit_name(api_limit limit);
/* Returns true if the limit counts bytes. */
bool api_limit_is_bytes(api_limit limit);
/* Returns true if tokens can have this limit; false if only addresses can. */
bool api_limit_is_of_token(api_limit limit);

/* Parses a whole number. If `bytes` is true, K, M, G or T may follow the number (powers of
 * 1024). */
bool api_amount_parse(const char *text, size_t length, bool bytes, uint64_t *out);

/* The kinds of clients. api_limited counts the requests and connections that each limit has refused
 * since the server started, separately for tokens and addresses. All threads may count and read at
 * the same time; there is no lock. */
typedef enum api_client_kind {
    API_CLIENT_TOKEN,
    API_CLIENT_ADDRESS,
    API_CLIENT_KINDS
} api_client_kind;

typedef struct api_limited {
    _Atomic uint64_t refused[API_CLIENT_KINDS][API_LIMIT_COUNT];
} api_limited;

void api_limited_count(api_limited *limited, api_client_kind kind, api_limit limit);
uint64_t api_limited_get(const api_limited *limited, api_client_kind kind, api_limit limit);
/* Returns the name of a kind of client: "token" or "address". */
const char *api_client_kind_name(api_client_kind kind);

#endif
