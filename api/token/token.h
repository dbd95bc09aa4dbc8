/* token.h - a bearer token as the server knows it: its name and what it may do.
 *
 * A client sends the token itself in `Authorization: Bearer TOKEN`; the server keeps only its
 * SHA-256. A token consists of TOKEN_RANDOM characters chosen by getrandom, 256 bits, so no
 * attacker can find a token from its hash, however fast the hash function is. (Slow hash functions
 * are for passwords, which people choose.) The library Nettle computes and compares hashes. It is
 * installed with libmicrohttpd, which depends on it through GnuTLS.
 *
 * Fields of a token never change, except its limits. When the token file is read again
 * (token_set.h), tokens whose lines are unchanged stay, and new tokens are made for the other
 * lines. Removed tokens are `revoked`; requests that hold them may still read their fields. */
#ifndef HE_API_TOKEN_TOKEN_H
#define HE_API_TOKEN_TOKEN_H

#include "api/limit/rate.h"

#include <stdatomic.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/* A role: what a token may do, or, in the table of routes, the lowest role that a route requires.
 * API_ROLE_ADMIN is 0, so that a row of that table without a role is closed to all but admins. */
typedef enum api_role {
    API_ROLE_ADMIN,   /* everything, including requests to administer the server */
    API_ROLE_WRITE,   /* read, and change meshes */
    API_ROLE_READ,    /* read meshes and query them */
    API_ROLE_METRICS, /* read the metrics and nothing else */
    API_ROLE_OPEN     /* only routes have this role: no token is needed */
} api_role;

enum {
    API_TOKEN_NAME = 64,
    API_TOKEN_PREFIXES = 16,
    /* The most bytes of a prefix: fewer than a mesh id may have, so that the server can append
     * random characters. */
    API_TOKEN_PREFIX = 48,
    API_TOKEN_HASH = 32,
    API_TOKEN_RANDOM = 43, /* number of random characters, each one of 62: together 256 bits */
    API_TOKEN_TEXT = 6 + API_TOKEN_RANDOM, /* "hedge_" and the random characters */
    API_TOKEN_LONGEST = 256                /* a longer text cannot be a token and is not hashed */
};

typedef struct api_token {
    char name[API_TOKEN_NAME + 1];
    api_role role;
    /* The prefixes of mesh ids that the token can see, in the order in which its line in the token
     * file has them. A token without prefixes sees all meshes. */
    char prefixes[API_TOKEN_PREFIXES][API_TOKEN_PREFIX + 1];
    size_t prefix_count;
    double expires; /* time in seconds since 1970; HUGE_VAL: never */
    unsigned char hash[API_TOKEN_HASH];
    size_t line; /* number of the token's line in the token file */
    /* The limits of the token, set by its line in the file or by the server's options; 0 is no
     * limit (limit.h). They change when the file is read again, also for requests that hold the
     * token. */
    _Atomic uint64_t limits[API_LIMIT_COUNT];
    /* Set of bits: the limits that the token's line sets; the others come from the server's
     * options. */
    unsigned own_limits;
    api_rate_key rate_key; /* key of the rate bucket, made from the token's name */
    _Atomic uint32_t uses;
    _Atomic bool revoked;
} api_token;

api_token *api_token_hold(api_token *token); /* adds a reference; takes NULL */
void api_token_release(api_token *token);    /* takes NULL */

/* Returns the name of a role: "read", "write", "admin", "metrics", or "open" for routes that
 * require no token. */
const char *api_role_name(api_role role);
/* Returns true if the role `has` includes the rights of the role `needs`. */
bool api_role_allows(api_role has, api_role needs);

/* Returns a limit of the token, or 0 if it has no such limit. A NULL token has no limits. */
uint64_t api_token_limit(const api_token *token, api_limit limit);

/* Returns true if the token is neither revoked nor expired. `now` is in seconds since 1970. */
bool api_token_is_current(const api_token *token, double now);
/* Returns true if two byte strings are equal; takes constant time, so that it reveals nothing about
 * secrets. */
bool api_token_is_equal(const unsigned char *a, const unsigned char *b, size_t length);
/* Returns true if `hash` is the hash of the token. Compares in constant time. */
bool api_token_matches(const api_token *token, const unsigned char hash[API_TOKEN_HASH]);
/* Returns true if the token can see the mesh with this id. A NULL token, which stands for a server
 * without tokens, sees all meshes. */
bool api_token_sees(const api_token *token, const char *mesh);
/* Returns true if the token may see a job that the token named `holder` started on the mesh with
 * this id ("" for none). Admins and a NULL token may see all jobs. */
bool api_token_owns(const api_token *token, const char *holder, const char *mesh);
/* Lists the token's prefixes in ascending order, without those that begin with another of its
 * prefixes. Returns the number of prefixes listed. */
size_t api_token_ranges(const api_token *token, const char *out[API_TOKEN_PREFIXES]);

void api_token_hash(const char *text, size_t length, unsigned char out[API_TOKEN_HASH]);
/* Makes a new random token, terminated by NUL. */
void api_token_make(char out[API_TOKEN_TEXT + 1]);

#endif
