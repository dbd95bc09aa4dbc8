/* tickets.h - a ticket lets one GET of one path in without a header.
 *
 * A browser sends no Authorization for an image or a download. So a page that has a token asks for
 * a ticket, puts it at the end of the URL, and the URL is good once and for API_TICKET_SECONDS: in
 * a history or a log it is worth nothing. A ticket does what its token may, as long as that is
 * good. The server keeps hashes of tickets and of what they are for. */
#ifndef HE_API_TOKEN_TICKETS_H
#define HE_API_TOKEN_TICKETS_H

#include "api/token/token.h"

enum {
    API_TICKET_SECONDS = 60,
    API_TICKETS = 1024,          /* that are good at one time */
    API_TICKETS_OF_A_TOKEN = 256 /* of them */
};

typedef struct api_tickets api_tickets;

api_tickets *api_tickets_new(void); /* NULL when memory is out */
void api_tickets_free(api_tickets *tickets);

/* A ticket of this token (NULL: of nobody, where none are asked for) for a path with its query, as
 * long as `now` is less than *expires. False where as many are good as may be. */
bool api_tickets_make(api_tickets *tickets, api_token *token, const char *target, double now,
                      char out[API_TOKEN_TEXT + 1], double *expires);
/* Takes the ticket of this text if it is good for the target, and gives its token, held. A ticket
 * that is asked for another target stays good. */
bool api_tickets_take(api_tickets *tickets, const char *text, const char *target, double now,
                      api_token **out);

#endif
