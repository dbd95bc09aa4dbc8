#include "journal/journal.h"

#include <stdatomic.h>

/* Positions of all memory journals of the process, which need no order among each other. */
static _Atomic uint64_t newest;

static uint64_t append(void *self, const st_record *records, size_t count)
{
    (void)self;
    (void)records;
    return atomic_fetch_add(&newest, count) + count;
}

static void listen_to(void *self, const st_journal_listener *listener)
{
    (void)self;
    if (listener != NULL) {
        listener->moved(listener->context, UINT64_MAX);
    }
}

static void close_journal(void *self)
{
    (void)self;
}

st_journal st_journal_memory(void)
{
    return (st_journal){NULL, append, listen_to, close_journal};
}
