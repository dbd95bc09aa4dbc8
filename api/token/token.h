/* token.h - a bearer token as the server knows it: whose it is and what it may do.
 *
 * A client sends the token itself in `Authorization: Bearer TOKEN`; the server keeps its SHA-256
 * alone. A token is TOKEN_RANDOM characters that getrandom chose, 256 bits, so that nobody finds
 * one from its hash however fast that is to compute: a slow hash is for passwords, which people
 * choose. Nettle hashes and compares; libmicrohttpd brings it along with GnuTLS, so that nothing
 * more is installed for it.
 *
 * Facts of a token never change, but for its limits. A file that is read again (token_set.h) keeps
 * the tokens whose lines say the same and makes new ones for all others; those that are gone are
 * `revoked`, but requests that hold them may still read their facts. */
#ifndef HE_API_TOKEN_TOKEN_H
#define HE_API_TOKEN_TOKEN_H

#include "api/limit/rate.h"

#include <stdatomic.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/* What a token may do, and the least that a route asks for. The first one is what a row of the
 * table of routes has that says nothing: forgetting it shuts the route. */
typedef enum api_role {
    API_ROLE_ADMIN,   /* everything */
    API_ROLE_WRITE,   /* what READ may, and change meshes */
    API_ROLE_READ,    /* look at meshes and question them */
    API_ROLE_METRICS, /* read the metrics, and nothing else */
    API_ROLE_OPEN     /* of a route: no token is needed. No token has it */
} api_role;

enum {
    API_TOKEN_NAME = 64,
    API_TOKEN_PREFIXES = 16,
    API_TOKEN_PREFIX = 48, /* so that the rest of a mesh id, which the server makes, has room */
    API_TOKEN_HASH = 32,
    API_TOKEN_RANDOM = 43,                 /* characters of 62 kinds: 256 bits */
    API_TOKEN_TEXT = 6 + API_TOKEN_RANDOM, /* "hedge_" before them */
    API_TOKEN_LONGEST = 256                /* of what is looked at as a token */
};

typedef struct api_token {
    char name[API_TOKEN_NAME + 1];
    api_role role;
    /* Of the ids of meshes that exist for it, in the order of its line; none: all meshes do. */
    char prefixes[API_TOKEN_PREFIXES][API_TOKEN_PREFIX + 1];
    size_t prefix_count;
    double expires; /* seconds since 1970; HUGE_VAL: never */
    unsigned char hash[API_TOKEN_HASH];
    size_t line; /* of its file */
    /* What its line and the server's options let it have, 0 for all (limit.h). A file that is read
     * again changes them for requests that hold the token. */
    _Atomic uint64_t limits[API_LIMIT_COUNT];
    unsigned own_limits;   /* of its line, a bit each: the options' are not its */
    api_rate_key rate_key; /* of its name, whose bucket it uses */
    _Atomic uint32_t uses;
    _Atomic bool revoked;
} api_token;

api_token *api_token_hold(api_token *token); /* takes NULL, the token of nobody */
void api_token_release(api_token *token);    /* likewise */

/* "read", "write", "admin", "metrics"; "open" for that of a route. */
const char *api_role_name(api_role role);
/* Does `has` include `needs`? */
bool api_role_allows(api_role has, api_role needs);

/* What it may have of this. NULL is the token of nobody, which may have all. */
uint64_t api_token_limit(const api_token *token, api_limit limit);

/* Is it neither revoked nor expired? `now` is in seconds since 1970. */
bool api_token_is_current(const api_token *token, double now);
/* Are the bytes the same? Takes the same time whichever of them differ. */
bool api_token_is_equal(const unsigned char *a, const unsigned char *b, size_t length);
/* Is the hash its own? Takes the same time whichever bytes differ. */
bool api_token_matches(const api_token *token, const unsigned char hash[API_TOKEN_HASH]);
/* Does a mesh of this id exist for it? NULL is the token of nobody, where no tokens are asked for:
 * all do. */
bool api_token_sees(const api_token *token, const char *mesh);
/* May it look at a job that the token of this name began, about a mesh of this id ("": none)? An
 * admin may look at all. NULL may too. */
bool api_token_owns(const api_token *token, const char *holder, const char *mesh);
/* The prefixes in the order of ids, without those that another one covers. Their number. */
size_t api_token_ranges(const api_token *token, const char *out[API_TOKEN_PREFIXES]);

void api_token_hash(const char *text, size_t length, unsigned char out[API_TOKEN_HASH]);
/* A new token, ended by a null. */
void api_token_make(char out[API_TOKEN_TEXT + 1]);

#endif
