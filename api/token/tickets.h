/* tickets.h - a ticket authorizes one GET of one path without an Authorization header.
 *
 * A browser sends no Authorization header for an image or a download. So a page that has a token
 * requests a ticket and appends it to the URL. The URL works once and within API_TICKET_SECONDS, so
 * a copy in a browser history or a log is worthless. A ticket has the rights of the token that
 * requested it, while that token is valid. The server keeps only hashes of tickets and of their
 * targets. */
#ifndef HE_API_TOKEN_TICKETS_H
#define HE_API_TOKEN_TICKETS_H

#include "api/token/token.h"

enum {
    API_TICKET_SECONDS = 60,
    API_TICKETS = 1024,          /* the most tickets that are valid at one time */
    API_TICKETS_OF_A_TOKEN = 256 /* the most tickets of one token that are valid at one time */
};

typedef struct api_tickets api_tickets;

api_tickets *api_tickets_new(void); /* returns NULL when memory is out */
void api_tickets_free(api_tickets *tickets);

/* A new ticket, as it is sent to the client. */
typedef struct api_ticket {
    char text[API_TOKEN_TEXT + 1];
    double expires; /* the ticket is valid before this time (seconds since 1970) */
} api_ticket;

/* Makes a ticket of this token for one target (a path with its query). `token` is NULL if the
 * server requires no tokens.
 * Returns false if the maximum number of tickets is valid already. */
bool api_tickets_make(api_tickets *tickets, api_token *token, const char *target, double now,
                      api_ticket *out);
/* Returns true if this text is a ticket that is valid for the target; the ticket is then used up,
 * and `out` gets a reference to its token. A ticket that is presented for another target stays
 * valid. */
bool api_tickets_take(api_tickets *tickets, const char *text, const char *target, double now,
                      api_token **out);

#endif
