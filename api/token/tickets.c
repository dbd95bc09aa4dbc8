#include "api/token/tickets.h"

#include "base/mem.h"

#include <pthread.h>
#include <string.h>

/* A ticket that the server has issued. Its two hashes are adjacent in memory, so that one
 * comparison in constant time covers both hashes. */
typedef struct ticket {
    unsigned char hashes[2 * API_TOKEN_HASH]; /* hash of the ticket, then of its target */
    double expires;
    /* The token that requested the ticket, to which the ticket counts as one reference. */
    api_token *token;
} ticket;

struct api_tickets {
    pthread_mutex_t lock;
    ticket items[API_TICKETS]; /* the first `count` items are valid */
    size_t count;
};

api_tickets *api_tickets_new(void)
{
    api_tickets *tickets = he_mem_zero(1, sizeof *tickets);
    if (tickets != NULL) {
        pthread_mutex_init(&tickets->lock, NULL);
    }
    return tickets;
}

static void forget(api_tickets *tickets, size_t i)
{
    api_token_release(tickets->items[i].token);
    tickets->items[i] = tickets->items[--tickets->count];
}

void api_tickets_free(api_tickets *tickets)
{
    if (tickets != NULL) {
        while (tickets->count > 0) {
            forget(tickets, tickets->count - 1);
        }
        pthread_mutex_destroy(&tickets->lock);
        he_mem_free(tickets);
    }
}

static void forget_expired(api_tickets *tickets, double now)
{
    for (size_t i = tickets->count; i > 0; i--) {
        if (tickets->items[i - 1].expires <= now) {
            forget(tickets, i - 1);
        }
    }
}

static size_t count_of(const api_tickets *tickets, const api_token *token)
{
    size_t count = 0;
    for (size_t i = 0; i < tickets->count; i++) {
        count += tickets->items[i].token == token;
    }
    return count;
}

static void hash_both(const char *text, const char *target, unsigned char out[2 * API_TOKEN_HASH])
{
    api_token_hash(text, strlen(text), out);
    api_token_hash(target, strlen(target), out + API_TOKEN_HASH);
}

bool api_tickets_make(api_tickets *tickets, api_token *token, const char *target, double now,
                      api_ticket *out)
{
    ticket made = {.expires = now + API_TICKET_SECONDS, .token = token};
    api_token_make(out->text);
    hash_both(out->text, target, made.hashes);
    out->expires = made.expires;
    pthread_mutex_lock(&tickets->lock);
    forget_expired(tickets, now);
    bool fits = tickets->count < API_TICKETS &&
                (token == NULL || count_of(tickets, token) < API_TICKETS_OF_A_TOKEN);
    if (fits) {
        api_token_hold(token);
        tickets->items[tickets->count++] = made;
    }
    pthread_mutex_unlock(&tickets->lock);
    return fits;
}

bool api_tickets_take(api_tickets *tickets, const char *text, const char *target, double now,
                      api_token **out)
{
    unsigned char hashes[2 * API_TOKEN_HASH];
    hash_both(text, target, hashes);
    pthread_mutex_lock(&tickets->lock);
    forget_expired(tickets, now);
    size_t found = tickets->count;
    for (size_t i = 0; i < tickets->count; i++) {
        found = api_token_is_equal(tickets->items[i].hashes, hashes, sizeof hashes) ? i : found;
    }
    bool good = found < tickets->count;
    if (good) {
        *out = api_token_hold(tickets->items[found].token);
        forget(tickets, found);
    }
    pthread_mutex_unlock(&tickets->lock);
    if (good && *out != NULL && !api_token_is_current(*out, now)) {
        api_token_release(*out);
        *out = NULL;
        good = false;
    }
    return good;
}
